#include "lamella/solvers/vortex_sheet/transfer.h"

#include <algorithm>
#include <map>
#include <optional>

namespace lamella::vortex_sheet {
namespace {

using mesh::FoamMesh;
using mesh::RegionId;
using mesh::TopologyEvent;
using mesh::VertexId;

std::optional<double> value_of(const RegionValues& values, RegionId r) {
    for (const auto& [region, value] : values)
        if (region == r) return value;
    return std::nullopt;
}

/// Mean over the given regions, all of which are there.
double mean_over(const RegionValues& values, std::span<const RegionId> regions) {
    double sum = 0.0;
    for (const RegionId r : regions) sum += value_of(values, r).value_or(0.0);
    return regions.empty() ? 0.0 : sum / static_cast<double>(regions.size());
}

/// Which regions a region came from, those it was split off and those that it took in.
using Origins = std::map<RegionId, std::vector<RegionId>>;

Origins origins_of(std::span<const TopologyEvent> events) {
    Origins origins;
    for (const TopologyEvent& event : events)
        if (event.kind == TopologyEvent::Kind::kSplit || event.kind == TopologyEvent::Kind::kAbsorb ||
            event.kind == TopologyEvent::Kind::kPop)
            origins[event.b].push_back(event.a);
    return origins;
}

/// The value of a region at a vertex: its own, or that of a region it came from; the mean where several are there.
std::optional<double> inherited(const RegionValues& values, RegionId r, const Origins& origins, int depth = 0) {
    constexpr int kDeepest = 8;
    double sum = 0.0;
    int count = 0;
    const auto add = [&](std::optional<double> value) {
        if (!value) return;
        sum += *value;
        ++count;
    };
    add(value_of(values, r));
    const auto from = origins.find(r);
    if (from != origins.end() && depth < kDeepest)
        for (const RegionId origin : from->second) add(inherited(values, origin, origins, depth + 1));
    if (count == 0) return std::nullopt;
    return sum / count;
}

}  // namespace

RegionValues blend(std::span<const RegionValues> parents, std::span<const double> weights) {
    SmallVector<RegionId, 8> shared;
    for (const auto& [region, value] : parents[0])
        if (std::all_of(parents.begin(), parents.end(), [&](const auto& p) { return value_of(p, region).has_value(); }))
            shared.push_back(region);
    const std::span<const RegionId> common(shared.begin(), shared.size());
    RegionValues result;
    for (const RegionId r : common) result.push_back({r, 0.0});
    for (std::size_t k = 0; k < parents.size(); ++k) {
        const double mean = mean_over(parents[k], common);
        for (const auto& [region, value] : parents[k]) {
            auto* at = std::find_if(result.begin(), result.end(), [r = region](const RegionValue& v) { return v.region == r; });
            const bool is_common = std::find(common.begin(), common.end(), region) != common.end();
            if (is_common) at->value += weights[k] * (value - mean);
            else if (at == result.end()) result.push_back({region, value - mean});
        }
    }
    return result;
}

Transfer::Transfer(const SheetTopology& topology, const Circulation& phi, const IdVector<VertexId, Vec3>& velocity)
    : values_(topology.hold.size()), velocity_(velocity) {
    for (const VertexId v : values_.ids())
        for (std::size_t i = topology.first(v); i < topology.last(v); ++i)
            values_[v].push_back({topology.entries.region[i], phi[i]});
}

std::function<void(const mesh::Resampling&)> Transfer::resampler() {
    return [this](const mesh::Resampling& edit) {
        std::vector<RegionValues> parents;
        Vec3 velocity;
        for (std::size_t k = 0; k < edit.parents.size(); ++k) {
            parents.push_back(values_[edit.parents[k]]);
            velocity += edit.weights[k] * velocity_[edit.parents[k]];
        }
        if (index(edit.vertex) >= values_.size()) {
            values_.resize(index(edit.vertex) + 1);
            velocity_.resize(index(edit.vertex) + 1);
        }
        values_[edit.vertex] = blend(parents, edit.weights);
        velocity_[edit.vertex] = velocity;
        edited_.push_back(edit.vertex);
    };
}

Transfer::Result Transfer::finish(const FoamMesh& mesh,
                                  const mesh::CompactionMaps& maps,
                                  std::span<const TopologyEvent> events) const {
    const Origins origins = origins_of(events);
    Result result{sheet_topology(mesh), {}, IdVector<VertexId, Vec3>(mesh.position.size()), {}};
    const SheetTopology& topology = result.topology;
    result.phi.assign(topology.size(), 0.0);
    std::vector<std::uint8_t> known(topology.size(), 0);
    for (const VertexId old : values_.ids()) {
        if (index(old) >= maps.vertex.size()) break;
        const VertexId v = maps.vertex[old];
        if (v == mesh::kNoVertex) continue;
        result.velocity[v] = velocity_[old];
        for (std::size_t i = topology.first(v); i < topology.last(v); ++i) {
            const auto value = inherited(values_[old], topology.entries.region[i], origins);
            if (!value) continue;
            result.phi[i] = *value;
            known[i] = 1;
        }
    }
    // A region that is new at a vertex (a T1 brought it there): the mean jump to it at the vertices around, relative to
    // the regions that both know.
    for (const VertexId v : mesh.position.ids())
        for (std::size_t i = topology.first(v); i < topology.last(v); ++i) {
            if (known[i] != 0) continue;
            const RegionId r = topology.entries.region[i];
            double sum = 0.0;
            int count = 0;
            for (const mesh::Corner& corner : topology.corners.of(v))
                for (const VertexId w : mesh.faces[corner.face].vertices) {
                    const auto there = topology.entries.find(w, r);
                    if (w == v || !there || known[*there] == 0) continue;
                    double offset = 0.0;
                    int common = 0;
                    for (std::size_t j = topology.first(v); j < topology.last(v); ++j) {
                        const auto other = topology.entries.find(w, topology.entries.region[j]);
                        if (known[j] == 0 || !other || known[*other] == 0) continue;
                        offset += result.phi[j] - result.phi[*other];
                        ++common;
                    }
                    if (common == 0) continue;
                    sum += result.phi[*there] + offset / common;
                    ++count;
                }
            if (count > 0) result.phi[i] = sum / count;
        }
    for (const VertexId old : edited_)
        if (maps.vertex[old] != mesh::kNoVertex) result.edited.push_back(maps.vertex[old]);
    std::sort(result.edited.begin(), result.edited.end());
    result.edited.erase(std::unique(result.edited.begin(), result.edited.end()), result.edited.end());
    fix_gauge(topology, result.phi);
    return result;
}

}  // namespace lamella::vortex_sheet
