// Films that burst: when the scene says so, and where they are too thin to last.

#include "lamella/film/bursting.h"

#include "lamella/solvers/vortex_particle/moving.h"

#include <fmt/format.h>

#include <algorithm>

namespace lamella::vortex_particle {

using mesh::RegionId;

void VortexParticleSolver::apply_events() {
    const auto& events = input_.films->events;
    constexpr double kNow = 1e-12;
    while (moving_->next_event < events.size() && events[moving_->next_event].time <= time_ * (1.0 + kNow))
        apply(events[moving_->next_event++]);
}

void VortexParticleSolver::apply(const film::Event& event) {
    const mesh::FoamMesh& mesh = moving_->tracker->mesh();
    const RegionId region =
        event.region == film::kRandomBubble
            ? film::random_outer_bubble(mesh, input_.seed, moving_->next_event).value_or(mesh::kOutside)
            : event.region;
    const auto skip = [&](std::string why) { events_.push_back({time_, "skipped", {}, std::move(why)}); };
    if (index(region) >= mesh.regions.size() || mesh.regions[region].kind != mesh::RegionKind::kClosed)
        return skip(fmt::format("bubble {} is gone already", index(region)));
    const RegionId into = event.into == film::kLargestNeighbor
                              ? film::largest_neighbor(mesh, region).value_or(mesh::kOutside)
                              : event.into;
    if (!film::share_film(mesh, region, into))
        return skip(fmt::format("regions {} and {} share no film", index(region), index(into)));
    burst(region, into);
}

/// The run ends where no other film is left.
void VortexParticleSolver::burst(RegionId region, RegionId into) {
    const auto between = [&](const mesh::Face& face) {
        return (face.back == region && face.front == into) || (face.back == into && face.front == region);
    };
    const auto& faces = moving_->films.faces;
    if (std::all_of(faces.begin(), faces.end(), between)) {
        end_ = End::kNoFilm;
        events_.push_back({time_, "burst", {}, "the last film"});
        return;
    }
    edit_films([&] { moving_->tracker->pop(region, into); });
}

/// The liquid's own attraction tears a film that is thin enough: where it is thinnest. A film that bounds a bubble goes
/// as a whole; the others, and films at rest, end the run.
void VortexParticleSolver::look_for_rupture() {
    if (options_.rupture_thickness == 0.0 || end_ != End::kNone) return;
    const std::vector<double> thickness = whole_thickness(surface_, particles_to_mesh().thickness);
    const auto thinnest = std::min_element(thickness.begin(), thickness.end());
    if (*thinnest > options_.rupture_thickness) return;
    const auto v = static_cast<std::size_t>(thinnest - thickness.begin());
    events_.push_back({time_, "burst", surface_.position[v], fmt::format("the film is {:.3g} m thick", *thinnest)});
    const std::uint32_t t = surface_.around(v)[0].triangle;
    if (!moving_ || surface_.region[t] == kNoRegion) {
        end_ = End::kRupture;
        return;
    }
    const mesh::Face& face = moving_->films.faces[static_cast<mesh::FaceId>(surface_.film[t])];
    const bool behind = surface_.side[t] == 0;
    burst(behind ? face.back : face.front, behind ? face.front : face.back);
}

std::optional<std::string> VortexParticleSolver::stop_reason() const {
    switch (end_) {
        case End::kNone:
            break;
        case End::kRupture:
            return "the film is as thin as rupture_thickness and bursts";
        case End::kNoFilm:
            return "the last film has burst";
    }
    return std::nullopt;
}

}  // namespace lamella::vortex_particle
