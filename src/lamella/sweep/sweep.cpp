#include "lamella/sweep/sweep.h"

#include "lamella/core/error.h"
#include "lamella/core/nearest_word.h"
#include "lamella/scene/shipped.h"
#include "lamella/scene/toml_file.h"
#include "lamella/sim/read_options.h"
#include "lamella/sweep/axes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <utility>

namespace lamella::sweep {
namespace {

constexpr double kMostTasks = 1e6;

using Setting = std::pair<std::string, std::string>;  // key and value

void refuse_unknown(const sim::Node& root) {
    static const std::vector<std::string> known{"scene", "set", "axes", "zip", "repeat", "task"};
    for (const auto& [key, node] : *root.table()) {
        if (std::find(known.begin(), known.end(), key) != known.end()) continue;
        const auto near = nearest_word(key, known);
        throw InputError(node.where, fmt::format("{} is no part of a sweep; {}", key,
                                                 near ? fmt::format("did you mean {}?", *near)
                                                      : fmt::format("known are {}", fmt::join(known, ", "))));
    }
}

/// The scene that a sweep names: a file beside it, or a shipped one.
std::filesystem::path scene_of(const sim::Node& root, const std::filesystem::path& sweep_file) {
    const sim::Node* node = root.find("scene");
    const auto* name = node != nullptr ? std::get_if<std::string>(&node->value) : nullptr;
    if (name == nullptr)
        throw InputError(
            node != nullptr ? node->where : SourceLocation{sweep_file.string(), 0, 0},
            "scene is missing; name the scene that all runs start from: scene = \"bubble/coarsening-2d-small\"");
    const std::filesystem::path beside = sweep_file.parent_path() / *name;
    if (std::filesystem::is_regular_file(beside)) return std::filesystem::absolute(beside).lexically_normal();
    try {
        return std::filesystem::absolute(scene::resolve_scene_path(*name));
    } catch (const InputError& error) {
        throw InputError(node->where, error.what());
    }
}

/// [repeat] seeds = 3 (which are 1, 2, 3) or a list.
std::vector<std::string> seeds_of(const sim::Node& repeat) {
    if (repeat.table() == nullptr)
        throw InputError(repeat.where, "repeat is no table; write [repeat] and below it seeds = 3");
    for (const auto& [key, node] : *repeat.table())
        if (key != "seeds")
            throw InputError(node.where, fmt::format("{} is no part of [repeat]; known is seeds", node.path));
    const sim::Node* seeds = repeat.find("seeds");
    if (seeds == nullptr) return {};
    std::vector<std::string> found;
    if (const auto* count = std::get_if<std::int64_t>(&seeds->value);
        count != nullptr && *count >= 1 && *count <= static_cast<std::int64_t>(kMostTasks))
        for (std::int64_t seed = 1; seed <= *count; ++seed) found.push_back(fmt::format("{}", seed));
    else if (seeds->array() != nullptr)
        for (const sim::Node& seed : *seeds->array()) found.push_back(scene::toml_value(seed));
    if (found.empty())
        throw InputError(seeds->where,
                         fmt::format("repeat.seeds = {}; how many, at least 1, or a list of seeds is needed",
                                     sim::found_text(*seeds)));
    return found;
}

std::vector<Axis> axes_of(const sim::Node& root) {
    std::vector<Axis> axes;
    if (const sim::Node* table = root.find("axes")) axes = read_axes(*table);
    if (const sim::Node* zips = root.find("zip")) {
        if (zips->array() == nullptr) throw InputError(zips->where, "zip is no list of tables; write [[zip]]");
        for (const sim::Node& zip : *zips->array()) axes.push_back(read_zip(zip));
    }
    if (const sim::Node* repeat = root.find("repeat")) {
        Axis axis{{"seed"}, {}};
        for (std::string& seed : seeds_of(*repeat)) axis.values.push_back({std::move(seed)});
        if (!axis.values.empty()) axes.push_back(std::move(axis));
    }
    return axes;
}

/// Every key once, so that no setting hides another.
void refuse_twice(const std::vector<Axis>& axes, const std::vector<Setting>& set, const std::string& file) {
    std::set<std::string> seen;
    const auto add = [&](const std::string& key) {
        if (!seen.insert(key).second) throw InputError({file, 0, 0}, fmt::format("{} is given twice", key));
    };
    for (const Setting& setting : set) add(setting.first);
    for (const Axis& axis : axes)
        for (const std::string& key : axis.keys) add(key);
}

/// FNV-1a of the settings sorted by key.
std::string name_of(std::vector<Setting> settings) {
    std::sort(settings.begin(), settings.end());
    std::uint64_t hash = 0xcbf29ce484222325U;
    const auto mix = [&](const std::string& text) {
        for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
        hash = (hash ^ 0xffU) * 0x100000001b3U;  // no byte of UTF-8: an end
    };
    for (const auto& [key, value] : settings) {
        mix(key);
        mix(value);
    }
    return fmt::format("{:016x}", hash);
}

Task make_task(const std::vector<Axis>& axes, const std::vector<Setting>& set, std::size_t number) {
    Task task;
    std::vector<Setting> settings = set;
    std::vector<std::vector<Setting>> of_axis(axes.size());
    for (std::size_t a = axes.size(); a-- > 0;) {  // the last varies fastest
        const auto& step = axes[a].values[number % axes[a].values.size()];
        number /= axes[a].values.size();
        for (std::size_t k = 0; k < step.size(); ++k) of_axis[a].emplace_back(axes[a].keys[k], step[k]);
    }
    for (const auto& some : of_axis)
        for (const Setting& setting : some) {
            task.values.push_back(setting.second);
            settings.push_back(setting);
        }
    for (const auto& [key, value] : settings) task.overrides.push_back(key + "=" + value);
    task.name = name_of(std::move(settings));
    return task;
}

}  // namespace

Sweep load_sweep(const std::filesystem::path& path) {
    const sim::Node root = scene::read_toml_file(path);
    refuse_unknown(root);
    Sweep sweep;
    sweep.scene = scene_of(root, path);
    if (const sim::Node* task = root.find("task")) sweep.task = sim::read_options<TaskOptions>(*task);
    if (sweep.task.ranks > 1 && sweep.task.launcher.find_first_not_of(' ') == std::string::npos)
        throw InputError({path.string()}, "task.launcher is empty, and something has to start the ranks of a task");
    std::vector<Setting> set;
    if (const sim::Node* table = root.find("set")) set = read_set(*table);
    const std::vector<Axis> axes = axes_of(root);
    refuse_twice(axes, set, path.string());

    double count = 1.0;
    for (const Axis& axis : axes) {
        count *= static_cast<double>(axis.values.size());
        sweep.keys.insert(sweep.keys.end(), axis.keys.begin(), axis.keys.end());
    }
    if (count > kMostTasks)
        throw InputError({path.string(), 0, 0},
                         fmt::format("this makes {:.4g} runs; at most {:.0e} are allowed", count, kMostTasks));
    std::set<std::string> names;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
        sweep.tasks.push_back(make_task(axes, set, i));
        if (!names.insert(sweep.tasks.back().name).second)
            throw InputError({path.string(), 0, 0},
                             fmt::format("two runs are the same, with {}; a value is listed twice",
                                         fmt::join(sweep.tasks.back().overrides, ", ")));
    }
    return sweep;
}

}  // namespace lamella::sweep
