// How triangles follow films that move, and what an edit of them must leave as it was.

#include "lamella/core/error.h"
#include "lamella/mesh/quality.h"
#include "lamella/mesh/staged_move.h"
#include "lamella/solvers/vortex_particle/moving.h"
#include "lamella/solvers/vortex_particle/rebin.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lamella::vortex_particle {

using mesh::VertexId;

/// The tracker moves the films to where the step has brought them, as far as none of them cross, and keeps their
/// triangles even.
/// @throws NumericalError  fixed triangles cannot follow the films
void VortexParticleSolver::settle_films() {
    Moving& m = *moving_;
    Vectors displacement = m.films.position;
    for (const VertexId v : displacement.ids()) displacement[v] -= m.tracker->mesh().position[v];
    mesh::staged_move(*m.tracker, displacement);
    if (!(m.tracker->mesh().position == m.films.position)) place_films(m.tracker->mesh().position, {});
    if (options_.motion.remeshing) {
        if (triangles_are_due()) edit_films([&] { m.tracker->remesh(); });
    } else {
        constexpr double kSharpest = 1.0;  // degrees
        const double degrees = mesh::min_angle(m.films) * 180.0 / std::numbers::pi;
        if (degrees < kSharpest)
            throw NumericalError(
                fmt::format("t = {:.6g} s, step {}: a triangle has an angle of {:.2g} degrees; set "
                            "vortex_particle.motion.remeshing = true",
                            time_, steps_, degrees));
    }
    apply_events();
}

/// Whether films have gone half an edge, or an edge has become longer or shorter by a twentieth, since the tracker
/// looked: an edit costs all factors.
bool VortexParticleSolver::triangles_are_due() const {
    constexpr double kWay = 0.5, kStretch = 0.05;
    const Moving& m = *moving_;
    const double way = kWay * surface_.mean_edge;
    for (const VertexId v : m.films.position.ids())
        if (squared_norm(m.films.position[v] - m.looked_at[v]) > way * way) return true;
    const auto stretched = [&](VertexId a, VertexId b) {
        const double ratio = norm(m.films.position[b] - m.films.position[a]) / norm(m.looked_at[b] - m.looked_at[a]);
        return !(std::abs(ratio - 1.0) < kStretch);
    };
    return std::any_of(m.films.faces.begin(), m.films.faces.end(), [&](const mesh::Face& face) {
        const auto& [a, b, c] = face.vertices;
        return stretched(a, b) || stretched(b, c) || stretched(c, a);
    });
}

void VortexParticleSolver::edit_films(const std::function<void()>& edit) {
    Vectors velocity = moving_->velocity, carry = moving_->carry;
    moving_->tracker->set_resampler([&](const mesh::Resampling& step) {
        for (Vectors* values : {&velocity, &carry}) {
            Vec3 mean;
            for (std::size_t k = 0; k < step.parents.size(); ++k) mean += step.weights[k] * (*values)[step.parents[k]];
            if (index(step.vertex) >= values->size()) values->resize(index(step.vertex) + 1);
            (*values)[step.vertex] = mean;
        }
    });
    edit();
    moving_->tracker->set_resampler({});
    const std::vector<mesh::TopologyEvent> events = moving_->tracker->take_events();
    for (const mesh::TopologyEvent& event : events)
        events_.push_back({time_, std::string(mesh::name(event.kind)), event.position,
                           fmt::format("regions {} {}", index(event.a), index(event.b))});
    moving_->looked_at = moving_->films.position;
    if (moving_->tracker->mesh() == moving_->films) return;
    const Surface before = surface_;
    const mesh::FoamMesh films_before = moving_->films;
    const mesh::CompactionMaps maps = moving_->tracker->maps();
    take_films(moving_->tracker->mesh());
    Moving& m = *moving_;
    m.pressure.resize(m.films.regions.size(), 0.0);
    for (Vectors* values : {&velocity, &carry}) {
        Vectors now(m.films.position.size());
        for (const VertexId old : values->ids())
            if (index(old) < maps.vertex.size() && maps.vertex[old] != mesh::kNoVertex)
                now[maps.vertex[old]] = (*values)[old];
        *values = std::move(now);
    }
    m.velocity = std::move(velocity);
    m.carry = std::move(carry);
    const Laid old{before, films_before}, now{surface_, m.films};
    const Relaid change = relaid(old, now, maps, events);
    bins_ = rebin(old, now, change, particles_);
    fill_empty_triangles(surface_, particles_, bins_);
    merge_crowds(surface_, most_per_triangle(), particles_, bins_);
    const bool bursts = std::any_of(events.begin(), events.end(), [](const mesh::TopologyEvent& event) {
        return event.kind == mesh::TopologyEvent::Kind::kPop;
    });
    if (!bursts) fit_areas(surface_, transfer_, bins_, change.touched, particles_);
    balance_circulation(surface_, bins_, particles_);
    follow_velocities(before, change);
    follow_holes(before, maps);
    join_clusters();
}

/// Triangles that stay keep the velocity that the last step found, new ones have that of their particles.
void VortexParticleSolver::follow_velocities(const Surface& before, const Relaid& change) {
    std::vector<Vec3> velocity =
        triangle_velocity(surface_, particles_, bins_, std::vector<Vec3>(surface_.triangles()));
    for (std::size_t t = 0; t < before.triangles(); ++t)
        if (change.kept[t] != Relaid::kNoTriangle) velocity[change.kept[t]] = velocity_[t];
    velocity_ = std::move(velocity);
}

/// Walls have their loops' circulations under whatever numbers they have now.
void VortexParticleSolver::follow_holes(const Surface& before, const mesh::CompactionMaps& maps) {
    std::vector<double> circulation(surface_.loops.size(), 0.0);
    std::vector<std::int32_t> loop_at(moving_->films.position.size(), -1);
    for (std::size_t v = 0; v < surface_.vertices(); ++v)
        if (surface_.loop[v] >= 0) loop_at[surface_.site[v]] = surface_.loop[v];
    std::vector<std::uint8_t> met(before.loops.size(), 0);
    for (std::size_t v = 0; v < before.vertices(); ++v) {
        const VertexId now = maps.vertex[static_cast<VertexId>(before.site[v])];
        if (before.loop[v] < 0 || now == mesh::kNoVertex || loop_at[index(now)] < 0) continue;
        const auto from = static_cast<std::size_t>(before.loop[v]);
        if (met[from] != 0) continue;
        met[from] = 1;
        circulation[static_cast<std::size_t>(loop_at[index(now)])] = hole_circulation_[from];
    }
    hole_circulation_ = std::move(circulation);
}

/// Films that have come to hang together go on as one: the steady motion of their cluster is the mean of theirs, by
/// area, and what differs from it is motion along normals and flow along the films.
void VortexParticleSolver::join_clusters() {
    Moving& m = *moving_;
    std::vector<Vec3> mean(m.membrane.clusters());
    std::vector<double> area(m.membrane.clusters(), 0.0);
    for (std::size_t v = 0; v < surface_.vertices(); ++v) {
        const std::uint32_t site = surface_.site[v], c = m.membrane.cluster()[site];
        const double a = surface_.vertex_share[v] * surface_.vertex_area[v];
        mean[c] += a * m.carry.values()[site];
        area[c] += a;
    }
    Vectors change(m.carry.size());
    double largest = 0.0;
    for (const VertexId v : m.carry.ids()) {
        const std::uint32_t c = m.membrane.cluster()[index(v)];
        const Vec3 carry = m.membrane.held(c) || !(area[c] > 0.0) ? Vec3{} : mean[c] / area[c];
        change[v] = m.carry[v] - carry;
        largest = std::max(largest, norm(change[v]));
        m.carry[v] = carry;
    }
    if (largest == 0.0) return;
    const std::vector<double> more = m.membrane.components(change), speed = m.membrane.speeds(m.velocity);
    std::vector<double> sum(speed);
    for (std::size_t u = 0; u < sum.size(); ++u) sum[u] += more[u];
    m.velocity = m.membrane.velocities(sum);
    const auto along = [&](std::size_t t) {
        Vec3 u;
        for (const std::uint32_t v : surface_.corner[t]) u += change.values()[surface_.site[v]] / 3.0;
        return u - dot(u, surface_.normal[t]) * surface_.normal[t];
    };
    for (std::size_t p = 0; p < particles_.size(); ++p) particles_.velocity[p] += along(particles_.triangle[p]);
    for (std::size_t t = 0; t < velocity_.size(); ++t) velocity_[t] += along(t);
}

}  // namespace lamella::vortex_particle
