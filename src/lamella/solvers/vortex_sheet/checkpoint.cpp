// What a run of films in air is continued from.

#include "lamella/core/error.h"
#include "lamella/sim/mesh_archive.h"
#include "lamella/solvers/vortex_sheet/vortex_sheet_solver.h"

#include <fmt/format.h>

namespace lamella::vortex_sheet {

void VortexSheetSolver::save(sim::StateWriter& out) const {
    sim::save_mesh(out, "mesh", mesh());
    out.write("circulation", std::span<const double>(phi_));
    std::vector<double> velocity;
    for (const Vec3& u : velocity_) velocity.insert(velocity.end(), u.v, u.v + 3);
    out.write("velocity", std::span<const double>(velocity));
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
    std::vector<double> values;
    in.read("velocity", 3 * vertices, values);
    velocity_.resize(vertices);
    for (std::size_t v = 0; v < vertices; ++v)
        velocity_[static_cast<mesh::VertexId>(v)] = {{values[3 * v], values[3 * v + 1], values[3 * v + 2]}};
    in.read("wire_of", vertices, wire_of_.values());
    for (const std::int32_t wire : wire_of_)
        if (wire < -1 || wire >= static_cast<std::int32_t>(input_.films->wires.size()))
            throw InputError(fmt::format("wire_of = {} is no wire of this scene", wire));
    time_ = in.read_double("time");
    steps_ = in.read_integer("steps");
    step_ = in.read_double("step");
    evaluations_ = in.read_integer("evaluations");
    in.read("impulse", 3, values);
    impulse_ = {{values[0], values[1], values[2]}};
    wire_residual_ = in.read_double("wire_residual");
    const std::int64_t next = in.read_integer("next_event");
    if (next < 0 || next > static_cast<std::int64_t>(input_.films->events.size()))
        throw InputError(fmt::format("next_event = {} is no event of this scene", next));
    next_event_ = static_cast<std::size_t>(next);
    const std::int64_t count = in.read_integer("inflations");
    if (count < 0 || count > static_cast<std::int64_t>(input_.films->events.size()))
        throw InputError(fmt::format("inflations = {} are more than this scene has", count));
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
