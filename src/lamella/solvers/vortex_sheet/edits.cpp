// How the triangles follow the films, and what an edit of them must leave as it was.

#include "lamella/core/error.h"
#include "lamella/mesh/quality.h"
#include "lamella/mesh/staged_move.h"
#include "lamella/mesh/volume.h"
#include "lamella/mesh/volume_projection.h"
#include "lamella/solvers/vortex_sheet/film_laplacian.h"
#include "lamella/solvers/vortex_sheet/transfer.h"
#include "lamella/solvers/vortex_sheet/vortex_sheet_solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace lamella::vortex_sheet {

using mesh::FoamMesh;
using mesh::RegionId;
using mesh::VertexId;

/// Clusters of balls begin as cells of up to twice the volume that their gas has, with uneven triangles. They are
/// shrunk before the air is there: in the course of the run it would be stirred up by that.
void VortexSheetSolver::settle_volumes() {
    constexpr double kSettled = 1e-6;  // relative
    constexpr int kMostRounds = 200;
    for (int round = 0; round < kMostRounds; ++round) {
        const mesh::VolumeProjection projection = mesh::volume_projection(mesh());
        if (projection.error < kSettled) break;
        mesh::staged_move(*tracker_, projection.displacement);
        edit_mesh([&] { tracker_->remesh(); });
    }
    events_.clear();
}

/// Triangles that collapse cannot move any more: films hang on them, and what tension asks for turns into circulation
/// without end.
/// @throws NumericalError  fixed triangles cannot follow the films
void VortexSheetSolver::check_triangles() const {
    constexpr double kSharpest = 1.0;  // degrees
    const double degrees = mesh::min_angle(mesh()) * 180.0 / std::numbers::pi;
    if (degrees < kSharpest)
        throw NumericalError(
            fmt::format("t = {:.6g} s, step {}: a triangle has an angle of {:.2g} degrees; triangles that "
                        "stay as they are cannot follow these films: set vortex_sheet.remeshing = true",
                        time_, steps_, degrees));
}

void VortexSheetSolver::restore_volumes() {
    if (!options_.volume_projection) return;
    constexpr int kRounds = 2;
    tracker_->move(mesh::volume_projection(mesh(), kRounds).displacement);
}

/// Without projection volumes are what the motion makes of them: an edit gives back what it took. Regions that came or
/// went have no volume to go back to.
void VortexSheetSolver::restore_volumes(const IdVector<RegionId, double>& before,
                                        const std::vector<mesh::TopologyEvent>& events) {
    using Kind = mesh::TopologyEvent::Kind;
    for (const mesh::TopologyEvent& event : events)
        if (event.kind == Kind::kSplit || event.kind == Kind::kAbsorb || event.kind == Kind::kPop) return;
    FoamMesh films = mesh();
    for (const RegionId r : films.regions.ids()) films.regions[r].target_volume = before[r];
    tracker_->move(mesh::volume_projection(films).displacement);
}

void VortexSheetSolver::edit_mesh(const std::function<void()>& edit) {
    Transfer transfer(topology_, phi_, velocity_);
    const IdVector<RegionId, double> volume = mesh::region_volumes(mesh());
    tracker_->set_resampler(transfer.resampler());
    edit();
    tracker_->set_resampler({});
    const std::vector<mesh::TopologyEvent> events = tracker_->take_events();
    Transfer::Result result = transfer.finish(mesh(), tracker_->maps(), events);
    topology_ = std::move(result.topology);
    phi_ = std::move(result.phi);
    velocity_ = std::move(result.velocity);
    IdVector<VertexId, std::int32_t> wire_of(mesh().position.size(), -1);
    for (const VertexId old : wire_of_.ids())
        if (tracker_->maps().vertex[old] != mesh::kNoVertex) wire_of[tracker_->maps().vertex[old]] = wire_of_[old];
    wire_of_ = std::move(wire_of);
    for (const VertexId v : wire_of_.ids())  // circulation ends where a film does
        if (topology_.hold[v] == Hold::kRim)
            for (std::size_t i = topology_.first(v); i < topology_.last(v); ++i) phi_[i] = 0.0;
    heal(result.edited);
    if (!options_.volume_projection) restore_volumes(volume, events);
    for (const mesh::TopologyEvent& event : events)
        events_.push_back({time_, std::string(mesh::name(event.kind)), event.position,
                           fmt::format("regions {} {}", index(event.a), index(event.b))});
}

/// In narrow wedges of air, as between films that have just met, large circulations of two films cancel in all but
/// name: the flow does not see them. An edit of one film alone would set that energy free, so the jumps around it are
/// evened out. Such jumps are large beside the velocities; those of a swing are about twice the velocities and left as
/// they are.
void VortexSheetSolver::heal(const std::vector<VertexId>& edited) {
    if (edited.empty() || options_.healing == 0) return;
    constexpr double kHidden = 4.0;  // jump over mean speed: more than any swing of low order has
    const double most = kHidden * mean_speed();
    const std::vector<Vec3> strength = face_strengths(mesh(), topology_, phi_);
    const auto hides_flow = [&](VertexId v) {
        for (const mesh::Corner& corner : topology_.corners.of(v)) {
            const auto& [a, b, c] = mesh().faces[corner.face].vertices;
            const double area =
                0.5 * norm(cross(mesh().position[b] - mesh().position[a], mesh().position[c] - mesh().position[a]));
            if (norm(strength[index(corner.face)]) > most * area) return true;
        }
        return false;
    };
    std::vector<std::uint8_t> near(mesh().position.size(), 0);
    for (const VertexId v : edited) near[index(v)] = hides_flow(v) ? 1 : 0;
    if (std::find(near.begin(), near.end(), 1) == near.end()) return;
    const std::vector<std::uint8_t> inside = near;
    for (const mesh::Face& face : mesh().faces)
        for (const VertexId v : face.vertices)
            if (inside[index(v)] != 0)
                for (const VertexId w : face.vertices) near[index(w)] = 1;
    std::vector<std::uint32_t> entries;
    for (const VertexId v : mesh().position.ids())
        if (near[index(v)] != 0)
            for (std::size_t i = topology_.first(v); i < topology_.last(v); ++i)
                entries.push_back(static_cast<std::uint32_t>(i));
    const FilmLaplacian around(mesh(), topology_, [&](VertexId v) { return near[index(v)] != 0; });
    even_out(around, entries, options_.healing, phi_);
}

/// Root of the mean square velocity of the vertices.
double VortexSheetSolver::mean_speed() const {
    double sum = 0.0;
    for (const Vec3& u : velocity_) sum += squared_norm(u);
    return std::sqrt(sum / static_cast<double>(velocity_.size()));
}

}  // namespace lamella::vortex_sheet
