#include "lamella/mesh/tracker.h"

#include "lamella/core/error.h"
#include "lamella/mesh/detail/motion.h"
#include "lamella/mesh/detail/workbench.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <utility>

namespace lamella::mesh {

std::string_view name(TopologyEvent::Kind kind) {
    switch (kind) {
        case TopologyEvent::Kind::kT1:
            return "t1";
        case TopologyEvent::Kind::kPinch:
            return "pinch";
        case TopologyEvent::Kind::kMerge:
            return "merge";
        case TopologyEvent::Kind::kSplit:
            return "split";
        case TopologyEvent::Kind::kAbsorb:
            return "absorb";
        case TopologyEvent::Kind::kPop:
            return "pop";
    }
    return "";
}

struct Tracker::Impl {
    TrackerOptions options;
    detail::EditMesh mesh;
    std::function<void(const Resampling&)> resampler;
    std::vector<Crossing> held;
    std::vector<TopologyEvent> events;
    CompactionMaps maps;
    detail::MotionLimit limit;

    void compact() {
        limit.forget();
        auto compacted = mesh.compact();
        maps = {std::move(compacted.vertex), std::move(compacted.face)};
    }
    /// What follows any change of topology, until nothing is left to do.
    void settle(detail::Workbench& bench) {
        constexpr int kMostRounds = 10;
        for (int round = 0; bench.topology_changed && round < kMostRounds; ++round) {
            bench.topology_changed = false;
            relabel(bench);
            absorb_small_regions(bench);
            if (bench.topology_changed && options.separating) separate_vertices(bench);
        }
    }
};

Tracker::Tracker(FoamMesh mesh, const TrackerOptions& options) {
    if (!(options.edge_length > 0.0) || !std::isfinite(options.edge_length))
        throw InputError(fmt::format("the edge length must be positive (got {})", options.edge_length));
    if (mesh.periodic()) throw InputError("a mesh in a periodic box cannot change its triangles yet");
    constexpr double kCell = 1.5;  // of the grid, in edges
    impl_ = std::make_unique<Impl>(
        Impl{options, detail::EditMesh(std::move(mesh), kCell * options.edge_length), {}, {}, {}, {}});
}

Tracker::~Tracker() = default;
Tracker::Tracker(Tracker&&) noexcept = default;
Tracker& Tracker::operator=(Tracker&&) noexcept = default;

const FoamMesh& Tracker::mesh() const { return impl_->mesh.mesh(); }
const TrackerOptions& Tracker::options() const { return impl_->options; }
const CompactionMaps& Tracker::maps() const { return impl_->maps; }
std::vector<TopologyEvent> Tracker::take_events() { return std::exchange(impl_->events, {}); }
void Tracker::set_resampler(std::function<void(const Resampling&)> resampler) {
    impl_->resampler = std::move(resampler);
}
void Tracker::set_target_volume(RegionId region, double volume) {
    impl_->mesh.regions()[region].target_volume = volume;
}

void Tracker::hold(std::vector<Crossing> crossings) { impl_->held = std::move(crossings); }

Tracker::MoveReport Tracker::move(const IdVector<VertexId, Vec3>& displacement,
                                  const IdVector<VertexId, double>& later) {
    detail::EditMesh& mesh = impl_->mesh;
    IdVector<VertexId, Vec3> step = displacement;
    const double longest = impl_->options.longest_step * impl_->options.edge_length;
    const std::size_t limited = impl_->limit.apply(mesh, longest, later, step);
    for (const VertexId v : step.ids()) step[v] += mesh.at(v);
    mesh.set_positions(step);
    return {limited};
}

RemeshReport Tracker::remesh() {
    RemeshReport report;
    const TrackerOptions& options = impl_->options;
    impl_->mesh.index_faces();
    detail::Workbench bench{impl_->mesh, options, impl_->resampler, impl_->held, report, impl_->events};
    if (options.merging) merge_close_faces(bench);
    split_long_edges(bench);
    collapse_short_edges(bench);
    flip_edges(bench);
    if (options.separating) separate_vertices(bench);
    impl_->settle(bench);
    impl_->compact();
    return report;
}

void Tracker::pop(RegionId region, RegionId into) {
    detail::EditMesh& mesh = impl_->mesh;
    const auto& regions = mesh.regions();
    for (const RegionId r : {region, into})
        if (index(r) >= regions.size() || regions[r].kind == RegionKind::kGone)
            throw InputError(fmt::format("there is no region {}", index(r)));
    std::optional<Vec3> where;
    for (const Face& face : mesh.mesh().faces)
        if ((face.back == region && face.front == into) || (face.front == region && face.back == into))
            where = mesh.at(face.vertices[0]);
    if (region == into || !where)
        throw InputError(fmt::format("regions {} and {} share no film that could burst", index(region), index(into)));
    RemeshReport report;
    mesh.index_faces();
    detail::Workbench bench{mesh, impl_->options, impl_->resampler, impl_->held, report, impl_->events};
    absorb(bench, region, into);
    impl_->events.push_back({TopologyEvent::Kind::kPop, *where, region, into});
    if (impl_->options.separating) separate_vertices(bench);
    impl_->settle(bench);
    impl_->compact();
}

}  // namespace lamella::mesh
