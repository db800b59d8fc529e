// What a run of films in air is continued from.

#include "lamella/core/error.h"
#include "lamella/sim/mesh_archive.h"
#include "lamella/solvers/vortex_sheet/vortex_sheet_solver.h"

#include <fmt/format.h>

namespace lamella::vortex_sheet {
namespace {

std::vector<double> flat(std::span<const Vec3> vectors) {
    std::vector<double> values;
    for (const Vec3& x : vectors) values.insert(values.end(), x.v, x.v + 3);
    return values;
}

std::vector<Vec3> read_vectors(sim::StateReader& in, const char* name, std::size_t count) {
    std::vector<double> values;
    in.read(name, 3 * count, values);
    std::vector<Vec3> vectors(count);
    for (std::size_t i = 0; i < count; ++i) vectors[i] = {{values[3 * i], values[3 * i + 1], values[3 * i + 2]}};
    return vectors;
}

std::size_t read_count(sim::StateReader& in, const char* name) {
    const std::int64_t count = in.read_integer(name);
    constexpr std::int64_t kMost = std::int64_t{1} << 31;
    if (count < 0 || count > kMost) throw InputError(fmt::format("{} = {} is no number of items", name, count));
    return static_cast<std::size_t>(count);
}

void save_loose(sim::StateWriter& out, const LooseSheets& loose) {
    out.write_value("loose_vertices", static_cast<std::int64_t>(loose.position.size()));
    out.write_value("loose_triangles", static_cast<std::int64_t>(loose.triangles.size()));
    out.write_value("loose_most", static_cast<std::int64_t>(loose.most));
    out.write("loose_position", std::span<const double>(flat(loose.position)));
    out.write("loose_velocity", std::span<const double>(flat(loose.velocity)));
    std::vector<std::int64_t> corners;
    for (const auto& t : loose.triangles) corners.insert(corners.end(), t.begin(), t.end());
    std::vector<double> circulation;
    for (const auto& jumps : loose.circulation) circulation.insert(circulation.end(), jumps.begin(), jumps.end());
    out.write("loose_circulation", std::span<const double>(circulation));
    out.write("loose_corners", std::span<const std::int64_t>(corners));
}

LooseSheets load_loose(sim::StateReader& in) {
    LooseSheets loose;
    const std::size_t vertices = read_count(in, "loose_vertices"), triangles = read_count(in, "loose_triangles");
    loose.most = read_count(in, "loose_most");
    loose.position = read_vectors(in, "loose_position", vertices);
    loose.velocity = read_vectors(in, "loose_velocity", vertices);
    std::vector<double> circulation;
    in.read("loose_circulation", 3 * triangles, circulation);
    std::vector<std::int64_t> corners;
    in.read("loose_corners", 3 * triangles, corners);
    for (const std::int64_t v : corners)
        if (v < 0 || v >= static_cast<std::int64_t>(vertices))
            throw InputError(fmt::format("loose_corners: {} is no vertex", v));
    for (std::size_t i = 0; i < corners.size(); i += 3) {
        loose.triangles.push_back({static_cast<std::uint32_t>(corners[i]), static_cast<std::uint32_t>(corners[i + 1]),
                                   static_cast<std::uint32_t>(corners[i + 2])});
        loose.circulation.push_back({circulation[i], circulation[i + 1], circulation[i + 2]});
    }
    return loose;
}

}  // namespace

void VortexSheetSolver::save(sim::StateWriter& out) const {
    sim::save_mesh(out, "mesh", mesh());
    out.write("circulation", std::span<const double>(phi_));
    out.write("velocity", std::span<const double>(flat(velocity_.values())));
    save_loose(out, loose_);
    out.write("wire_of", std::span<const std::int32_t>(wire_of_.values()));
    out.write_value("time", time_);
    out.write_value("steps", steps_);
    out.write_value("step", step_);
    out.write_value("evaluations", static_cast<std::int64_t>(evaluations_));
    out.write("impulse", std::span<const double>(impulse_.v, 3));
    out.write_value("wire_residual", wire_residual_);
    out.write_value("next_event", static_cast<std::int64_t>(next_event_));
    out.write_value("inflations", static_cast<std::int64_t>(inflations_.size()));
    std::vector<double> inflations;
    for (const Inflation& i : inflations_)
        inflations.insert(inflations.end(), {static_cast<double>(index(i.region)), i.from, i.to, i.start, i.end});
    out.write("inflation", std::span<const double>(inflations));
}

void VortexSheetSolver::load(sim::StateReader& in) {
    take(sim::load_mesh(in, "mesh"));
    const std::size_t vertices = mesh().position.size();
    in.read("circulation", topology_.size(), phi_);
    velocity_ = IdVector<mesh::VertexId, Vec3>(read_vectors(in, "velocity", vertices));
    loose_ = load_loose(in);
    in.read("wire_of", vertices, wire_of_.values());
    for (const std::int32_t wire : wire_of_)
        if (wire < -1 || wire >= static_cast<std::int32_t>(input_.films->wires.size()))
            throw InputError(fmt::format("wire_of = {} is no wire of this scene", wire));
    time_ = in.read_double("time");
    steps_ = in.read_integer("steps");
    step_ = in.read_double("step");
    evaluations_ = in.read_integer("evaluations");
    impulse_ = read_vectors(in, "impulse", 1)[0];
    wire_residual_ = in.read_double("wire_residual");
    const std::int64_t next = in.read_integer("next_event");
    if (next < 0 || next > static_cast<std::int64_t>(input_.films->events.size()))
        throw InputError(fmt::format("next_event = {} is no event of this scene", next));
    next_event_ = static_cast<std::size_t>(next);
    const std::int64_t count = in.read_integer("inflations");
    if (count < 0 || count > static_cast<std::int64_t>(input_.films->events.size()))
        throw InputError(fmt::format("inflations = {} are more than this scene has", count));
    std::vector<double> values;
    in.read("inflation", 5 * static_cast<std::size_t>(count), values);
    inflations_.clear();
    for (std::size_t i = 0; i < values.size(); i += 5) {
        if (!(values[i] >= 0.0) || values[i] >= static_cast<double>(mesh().regions.size()))
            throw InputError(fmt::format("inflation of region {} refers to no region", values[i]));
        inflations_.push_back({static_cast<mesh::RegionId>(static_cast<std::uint32_t>(values[i])), values[i + 1],
                               values[i + 2], values[i + 3], values[i + 4]});
    }
    observed_.reset();
}

}  // namespace lamella::vortex_sheet
