#include "lamella/scene/import.h"

#include "lamella/core/error.h"
#include "lamella/scene/detail/lenient_json.h"
#include "lamella/scene/detail/scene_file.h"
#include "lamella/scene/detail/toml_reader.h"
#include "lamella/scene/detail/toml_writer.h"
#include "lamella/scene/scene.h"
#include "lamella/sim/read_options.h"
#include "lamella/solvers/bubble/options.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>
#include <vector>

namespace lamella::scene {
namespace {

/// What the other programs ask for and [bubble] has no place for. A seed, and numbers whose meaning differs.
struct OtherOptions {
    std::int64_t seed = 1;
    double frame_rate = 1.0;
    double tolerance = 1e-5;
    double relaxation_steps = 1e4;
    double energy_change = 1e-5;
    double bubbles_per_cell = 32.0;
    std::string file_prefix;

    template <class Visitor>
    void visit(Visitor&& option) {
        option("seed", seed, sim::at_least(0), {"seed of all random numbers"});
        option("frame_rate", frame_rate, sim::at_least(0.0), {"snapshots per unit of scaled time"});
        option("tolerance", tolerance, sim::more_than(0.0), {"largest predictor-corrector difference"});
        option("relaxation_steps", relaxation_steps, sim::at_least(0.0), {"steps per round of relaxation"});
        option("energy_change", energy_change, sim::at_least(0.0), {"energy change at which relaxation stops"});
        option("bubbles_per_cell", bubbles_per_cell, sim::more_than(0.0), {"bubbles per search cell"});
        option("file_prefix", file_prefix, {"beginning of the names of snapshots"});
    }
};

enum class Kind { kBubble, kOther, kWall, kImpose };

/// Where a value of the other file goes: a dotted name in [bubble] or in OtherOptions, or an axis of `walls`.
struct Target {
    Kind kind;
    std::string_view name;
};

/// Names of both programs (method sheet, section 11).
constexpr std::pair<std::string_view, Target> kTargets[] = {
    {"avgRad", {Kind::kBubble, "mean_radius"}},
    {"stdDevRad", {Kind::kBubble, "start.radius_std"}},
    {"numBubblesIn", {Kind::kBubble, "count"}},
    {"minNumBubbles", {Kind::kBubble, "end_count"}},
    {"boxRelDim", {Kind::kBubble, "box_shape"}},
    {"wallDragStrength", {Kind::kBubble, "wall_drag"}},
    {"flowVel", {Kind::kBubble, "flow.velocity"}},
    {"flowLbb", {Kind::kBubble, "flow.region_low"}},
    {"flowTfr", {Kind::kBubble, "flow.region_high"}},
    {"phiTarget", {Kind::kBubble, "gas_fraction"}},
    {"muZero", {Kind::kBubble, "viscosity"}},
    {"sigmaZero", {Kind::kBubble, "surface_tension"}},
    {"kappa", {Kind::kBubble, "gas.medium_ratio"}},
    {"kParameter", {Kind::kBubble, "gas.exchange_rate"}},
    {"timeStepIn", {Kind::kBubble, "integrator.initial_step"}},
    {"errorTolerance", {Kind::kOther, "tolerance"}},
    {"numStepsToRelax", {Kind::kOther, "relaxation_steps"}},
    {"maxDeltaEnergy", {Kind::kOther, "energy_change"}},
    {"numBubblesPerCell", {Kind::kOther, "bubbles_per_cell"}},
    {"rngSeed", {Kind::kOther, "seed"}},
    {"snapshotFrequency", {Kind::kOther, "frame_rate"}},
    {"bubbles.radius.mean", {Kind::kBubble, "mean_radius"}},
    {"bubbles.radius.std", {Kind::kBubble, "start.radius_std"}},
    {"bubbles.numStart", {Kind::kBubble, "count"}},
    {"bubbles.numEnd", {Kind::kBubble, "end_count"}},
    {"box.relativeDimensions", {Kind::kBubble, "box_shape"}},
    {"box.dimensionality", {Kind::kBubble, "dimension"}},
    {"box.wall.x", {Kind::kWall, "0"}},
    {"box.wall.y", {Kind::kWall, "1"}},
    {"box.wall.z", {Kind::kWall, "2"}},
    {"box.wall.drag", {Kind::kBubble, "wall_drag"}},
    {"flow.impose", {Kind::kImpose, "flow.kind"}},
    {"flow.velocity", {Kind::kBubble, "flow.velocity"}},
    {"flow.lbb", {Kind::kBubble, "flow.region_low"}},
    {"flow.tfr", {Kind::kBubble, "flow.region_high"}},
    {"constants.phi", {Kind::kBubble, "gas_fraction"}},
    {"constants.mu", {Kind::kBubble, "viscosity"}},
    {"constants.sigma", {Kind::kBubble, "surface_tension"}},
    {"constants.kappa", {Kind::kBubble, "gas.medium_ratio"}},
    {"constants.K", {Kind::kBubble, "gas.exchange_rate"}},
    {"stabilization.steps", {Kind::kOther, "relaxation_steps"}},
    {"stabilization.maxDeltaEnergy", {Kind::kOther, "energy_change"}},
    {"snapShot.frequency", {Kind::kOther, "frame_rate"}},
    {"snapShot.filename", {Kind::kOther, "file_prefix"}},
};

const Target* find_target(std::string_view name) {
    for (const auto& [known, target] : kTargets)
        if (known == name) return &target;
    return nullptr;
}

bool is_switched_on(const sim::Node& node) {
    if (const bool* flag = std::get_if<bool>(&node.value)) return *flag;
    const auto* number = std::get_if<std::int64_t>(&node.value);
    if (number != nullptr && (*number == 0 || *number == 1)) return *number == 1;
    throw InputError(node.where, fmt::format("{} = {} is neither 0 nor 1", node.path, sim::found_text(node)));
}

/// {"x": 1, "y": 2, "z": 3} as [1, 2, 3]; everything else as it is.
sim::Node vector_from(const sim::Node& node) {
    const sim::Node::Table* entries = node.table();
    if (entries == nullptr) return node;
    sim::Node::Array items;
    for (const char* axis : {"x", "y", "z"}) {
        const sim::Node* entry = node.find(axis);
        if (entry == nullptr || entries->size() != 3)
            throw InputError(node.where, fmt::format("{} must have x, y and z and nothing else", node.path));
        items.push_back(*entry);
    }
    return {std::move(items), node.where, node.path};
}

/// Sets "flow.velocity" in a table; where the value came from stays for messages.
void set_dotted(sim::Node& table, std::string_view name, sim::Node value) {
    const std::size_t dot = name.find('.');
    if (dot == std::string_view::npos) {
        table.set(name, std::move(value));
        return;
    }
    sim::Node* inner = table.find(name.substr(0, dot));
    if (inner == nullptr) inner = &table.set(name.substr(0, dot), {sim::Node::Table{}, value.where, value.path});
    inner->set(name.substr(dot + 1), std::move(value));
}

/// What was found in the other file, sorted by where it goes.
struct Found {
    sim::Node bubble;
    sim::Node other;
    std::array<bool, 3> walls{};
    bool flow = false;
    bool nested = false;                                    ///< cubble's names
    std::map<std::string, sim::Node, std::less<>> sources;  ///< target -> the value it came from
    std::vector<std::string> unknown;                       ///< "line 12: foo"
};

void take(Found& found, const Target& target, const sim::Node& node) {
    const std::string key =
        target.kind == Kind::kWall ? fmt::format("walls {}", target.name) : std::string(target.name);
    const auto [earlier, added] = found.sources.emplace(key, node);
    if (!added)
        throw InputError(node.where, fmt::format("{} says again what {} said on line {}", node.path,
                                                 earlier->second.path, earlier->second.where.line));
    if (target.kind == Kind::kWall)
        found.walls[static_cast<std::size_t>(target.name[0] - '0')] = is_switched_on(node);
    else if (target.kind == Kind::kImpose)
        found.flow = is_switched_on(node);
    else
        set_dotted(target.kind == Kind::kBubble ? found.bubble : found.other, target.name, vector_from(node));
}

/// The thesis explains every key in a member of its own: "kappaExpl".
bool is_explanation(const std::string& key, const sim::Node& node) {
    return key.ends_with("Expl") && std::holds_alternative<std::string>(node.value);
}

void collect(Found& found, const sim::Node& table, const std::string& prefix) {
    for (const auto& [key, node] : *table.table()) {
        const std::string name = prefix + key;
        if (const Target* target = find_target(name)) {
            found.nested = found.nested || !prefix.empty();
            take(found, *target, node);
        } else if (node.table() != nullptr && !node.table()->empty()) {
            collect(found, node, name + ".");
        } else if (!is_explanation(key, node)) {
            found.unknown.push_back(fmt::format("line {}: {}", node.where.line, node.path));
        }
    }
}

/// The options that the other file asks for, checked.
bubble::Options bubble_options(const Found& found) {
    auto options = sim::read_options<bubble::Options>(found.bubble);
    options.walls = found.walls;
    if (!found.flow) return options;
    options.flow.kind = bubble::FlowKind::kRegion;
    // cubble multiplies the velocity that it is given by sigma <R_in> / mu; here it is a plain velocity.
    if (found.nested) options.flow.velocity *= options.surface_tension * options.mean_radius / options.viscosity;
    return options;
}

/// [bubble] with what the other file says and nothing else, in the order of `lamella explain bubble`.
sim::Node bubble_table(const Found& found) {
    const sim::Node all = sim::resolve_options(bubble_options(found));
    sim::Node table;
    for (const sim::OptionInfo& info : sim::describe_options<bubble::Options>()) {
        const bool said = found.sources.contains(info.name) || info.name == "flow.kind" ||
                          info.name == "integrator.method" || info.name == "walls";
        if (!said || info.type == "group") continue;
        const std::size_t dot = info.name.find('.');
        const sim::Node* from = dot == std::string::npos ? &all : all.find(info.name.substr(0, dot));
        set_dotted(table, info.name, *from->find(info.name.substr(dot == std::string::npos ? 0 : dot + 1)));
    }
    return table;
}

std::string header(const Found& found, const OtherOptions& other, const std::string& name) {
    const bubble::IntegratorOptions defaults;
    std::string text = fmt::format("# Imported from {}, an input of {}.\n#\n", name,
                                   found.nested ? "cubble" : "the program of [Lankinen20] (its Listing A.1)");
    text += fmt::format(
        "# The problem is the same; the method is lamella's: rkc2, its errors below {} ({} = {}\n"
        "# bounds another quantity, the predictor-corrector difference of abm2). To repeat the published program, with "
        "a\n"
        "# clock that runs ahead of the time it stands for, set\n"
        "#     bubble.integrator.method = \"abm2\"      bubble.integrator.tolerance = {}\n"
        "#     bubble.compat.clock = true             bubble.compat.step_control = \"{}\"\n"
        "#     bubble.compat.energy = true\n",
        defaults.tolerance, found.sources.contains("tolerance") ? "errorTolerance" : "that program's default tolerance",
        other.tolerance, other.tolerance, found.nested ? "cubble" : "thesis");
    if (found.flow)
        text +=
            "# With a flow, that program also let each bubble drift with the mean velocity its neighbors had one step\n"
            "# before: bubble.drag = \"neighbor_lagged\". Here the liquid alone drags.\n";
    if (!found.nested)
        text +=
            "# Dimension, walls and flow were chosen when that program was compiled; two dimensions, no walls and no "
            "flow\n"
            "# are assumed. flow.kind = \"region\" turns the flow on.\n";
    std::string unused;
    for (const auto& [target, why] :
         {std::pair{"relaxation_steps", "relaxation ends when the forces balance: start.force_tolerance"},
          std::pair{"energy_change", "likewise"}, std::pair{"bubbles_per_cell", "cells follow from the largest bubble"},
          std::pair{"file_prefix", "frames are named by their number"}})
        if (const auto it = found.sources.find(target); it != found.sources.end())
            unused += fmt::format("#     {} = {} ({})\n", it->second.path, sim::found_text(it->second), why);
    if (!unused.empty()) text += "# Not used:\n" + unused;
    constexpr std::size_t kMostListed = 50;
    if (!found.unknown.empty()) text += "# WARNING: keys that are unknown and were left out:\n";
    for (std::size_t i = 0; i < std::min(found.unknown.size(), kMostListed); ++i)
        text += fmt::format("#     {}\n", found.unknown[i]);
    if (found.unknown.size() > kMostListed)
        text += fmt::format("#     and {} more\n", found.unknown.size() - kMostListed);
    return text;
}

}  // namespace

std::string import_foam_json(const std::filesystem::path& path) {
    return import_foam_json_text(detail::read_scene_file(path), path.string());
}

std::string import_foam_json_text(std::string_view text, const std::string& name) {
    if (text.size() > detail::kLargestScene)
        throw InputError({name, 0, 0},
                         fmt::format("is larger than {} MiB; that is no input file", detail::kLargestScene >> 20));
    const sim::Node root = detail::read_lenient_json(text, name);
    Found found;
    collect(found, root, "");
    if (found.sources.empty())
        throw InputError({name, 0, 0},
                         "has none of the keys of the thesis's program (phiTarget ...) or cubble"
                         " (constants.phi ...)");
    const auto other = sim::read_options<OtherOptions>(found.other);
    const sim::Node bubble = bubble_table(found);

    const std::string file = std::filesystem::path(name).filename().string();
    const std::string shown = detail::is_utf8(file) ? file : "a file";
    sim::Node head;
    head.set("title", {"Imported from " + shown});
    head.set("solver", {std::string("bubble")});
    head.set("seed", {other.seed});
    sim::Node time;
    time.set("end", {0.0});
    time.set("frame_rate", {other.frame_rate});
    const auto source = [&](std::string_view target) {
        const auto it = found.sources.find(target);
        return it == found.sources.end() ? std::string() : it->second.path;
    };
    return header(found, other, sim::quoted_text(shown)) + "\n" +  //
           detail::toml_text("", head, source) + "\n" +            //
           detail::toml_text("time", time, source) + "\n" +        //
           detail::toml_text("bubble", bubble, source);
}

}  // namespace lamella::scene
