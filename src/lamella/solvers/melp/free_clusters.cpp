#include "lamella/solvers/melp/free_clusters.h"

#include "lamella/linalg/dense.h"
#include "lamella/solvers/melp/loops.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

namespace lamella::melp {
namespace {

constexpr std::size_t kRigid = std::tuple_size_v<Rigid>;

std::size_t region_of(const CoarseParticles& coarse, std::size_t i) {
    return static_cast<std::size_t>(coarse.region[i]);
}

/// Directions of forces and moments.
std::vector<Rigid> all_directions() {
    std::vector<Rigid> all(kRigid);
    for (std::size_t a = 0; a < kRigid; ++a) all[a][a] = 1.0;
    return all;
}

/// Those in which half a bubble on a plate can slide and turn; those in which its gas does not push it, too: only along
/// the plate's normal does the plate take part of the push.
enum class OnPlate { kSlides, kGas };
std::vector<Rigid> directions_on(const Vec3& plate_normal, OnPlate what) {
    const Frame f = frame_of(plate_normal);
    std::vector<Rigid> directions;
    const auto add = [&](const Vec3& e, std::size_t at) {
        Rigid d{};
        for (std::size_t k = 0; k < 3; ++k) d[at + k] = e[k];
        directions.push_back(d);
    };
    add(f.e1, 0);
    add(f.e2, 0);
    add(f.normal, 3);
    if (what == OnPlate::kSlides) return directions;
    add(f.e1, 3);
    add(f.e2, 3);
    return directions;
}

/// What holds a region; nothing for one that flies.
const RimPiece* rim_of(std::span<const RimPiece> rims, std::size_t region) {
    for (const RimPiece& rim : rims)
        if (static_cast<std::size_t>(rim.region) == region) return &rim;
    return nullptr;
}

/// The middle of the plate's part that a film closes in: of the triangles between o, the mean of the film next to the
/// plate, and the rim, areas and centroids are as (x - o) . n and o + 2/3 (x - o). Sums along the rim are those over
/// the film near it, with weights that only depend on the height.
Vec3 middle_on_plate(const CoarseParticles& coarse,
                     const Geometry& geometry,
                     const RimPiece& rim,
                     const std::vector<std::size_t>& members) {
    if (rim.kind != RimKind::kPlate) return rim.a;
    const double reach = geometry.neighbors.same.kernel.support_radius;
    const auto weight = [&](std::size_t i) {
        const double q = dot(coarse.position[i] - rim.a, rim.b) / reach;
        return geometry.area[i] * std::pow(std::max(1.0 - q * q, 0.0), 2.0);
    };
    const auto on_plate = [&](const Vec3& x) { return x - dot(x - rim.a, rim.b) * rim.b; };
    Vec3 middle, moment;
    double all = 0.0, area = 0.0;
    for (const std::size_t i : members) {
        middle += weight(i) * on_plate(coarse.position[i]);
        all += weight(i);
    }
    if (!(all > 0.0)) return rim.a;
    middle = middle / all;
    for (const std::size_t i : members) {
        const Vec3 arm = on_plate(coarse.position[i]) - middle;
        const double share = weight(i) * dot(arm, geometry.normal[i]);
        area += share;
        moment += share * arm;
    }
    return area > 0.0 ? middle + 2.0 / 3.0 * moment / area : middle;
}

/// How much the film turns within the kernel's reach of a particle, squared: the mean of 1 - n . n'. The same all over
/// a sphere, large on folds.
double fold(const Geometry& geometry, std::size_t i) {
    const Neighbors& same = geometry.neighbors.same;
    double sum = 0.0;
    for (std::size_t k = same.begin(i); k < same.end(i); ++k) {
        const std::uint32_t j = same.index[k];
        sum += geometry.area[j] * same.weight[k] * (1.0 - dot(geometry.normal[i], geometry.normal[j]));
    }
    return sum * sum;
}

}  // namespace

std::vector<std::size_t> clusters(const Geometry& geometry, std::size_t regions) {
    std::vector<std::size_t> cluster(regions);
    std::iota(cluster.begin(), cluster.end(), std::size_t{0});
    const auto root = [&](std::size_t r) {
        while (cluster[r] != r) r = cluster[r];
        return r;
    };
    for (const auto& [p, q] : geometry.neighbors.touching) {
        const std::size_t a = root(static_cast<std::size_t>(p)), b = root(static_cast<std::size_t>(q));
        cluster[std::max(a, b)] = std::min(a, b);
    }
    for (std::size_t& r : cluster) r = root(r);
    return cluster;
}

FreeCluster::FreeCluster(const CoarseParticles& coarse,
                         const Geometry& geometry,
                         std::vector<std::size_t> members,
                         std::vector<Rigid> directions,
                         std::span<const Tensor> flight)
    : coarse_(coarse),
      geometry_(geometry),
      members_(std::move(members)),
      directions_(std::move(directions)),
      flight_(flight) {
    for (const std::size_t i : members_) {
        center_ += geometry.area[i] * coarse.position[i];
        length_ += geometry.area[i];
    }
    center_ = center_ / length_;
    length_ = std::sqrt(length_);
}

void FreeCluster::remove_resultant(std::vector<double>& values,
                                   std::span<const Vec3> beside,
                                   std::span<const double> share) const {
    const std::size_t count = directions_.size();
    struct Sums {
        std::array<double, kRigid * kRigid> matrix{};
        std::array<double, kRigid> resultant{};
    };
    const auto of_members = [&](std::size_t begin, std::size_t end) {
        Sums sums;
        for (std::size_t m = begin; m < end; ++m) {
            const std::size_t i = members_[m];
            const Rigid e = rigid(i, geometry_.normal[i]);
            const Rigid f = rigid(i, values[i] * geometry_.normal[i] + beside[i]);
            for (std::size_t a = 0; a < count; ++a) {
                sums.resultant[a] += f[a];
                for (std::size_t b = 0; b < count; ++b) sums.matrix[a * count + b] += share[i] * e[a] * e[b];
            }
        }
        return sums;
    };
    const auto both = [](Sums a, const Sums& b) {
        for (std::size_t k = 0; k < a.matrix.size(); ++k) a.matrix[k] += b.matrix[k];
        for (std::size_t k = 0; k < a.resultant.size(); ++k) a.resultant[k] += b.resultant[k];
        return a;
    };
    const Sums sums = parallel_reduce(members_.size(), Sums{}, of_members, both);
    const std::vector<double> matrix(sums.matrix.begin(),
                                     sums.matrix.begin() + static_cast<std::ptrdiff_t>(count * count));
    const std::vector<double> resultant(sums.resultant.begin(),
                                        sums.resultant.begin() + static_cast<std::ptrdiff_t>(count));
    // A sphere cannot be twisted by forces along its normals: such directions stay as they are.
    constexpr double kCannot = 1e-4;
    const auto z = linalg::solve_symmetric(count, matrix, resultant, kCannot).x;
    for_each_particle(members_.size(), [&](std::size_t m) {
        const std::size_t i = members_[m];
        const Rigid e = rigid(i, geometry_.normal[i]);
        for (std::size_t a = 0; a < count; ++a) values[i] -= share[i] * e[a] * z[a];
    });
}

/// A vector at a particle, as its region flies after it, and its moment about the center, over the cluster's size, in
/// the cluster's directions.
Rigid FreeCluster::rigid(std::size_t i, const Vec3& f) const {
    const Vec3 moment = cross(coarse_.position[i] - center_, f) / length_;
    const Vec3 push = flight_.empty() ? f : flight_[region_of(coarse_, i)] * f;
    const Rigid all{push[0], push[1], push[2], moment[0], moment[1], moment[2]};
    Rigid along{};
    for (std::size_t d = 0; d < directions_.size(); ++d)
        for (std::size_t a = 0; a < kRigid; ++a) along[d] += directions_[d][a] * all[a];
    return along;
}

std::vector<FreeCluster> free_clusters(const CoarseParticles& coarse,
                                       const Geometry& geometry,
                                       std::span<const Gas> gas,
                                       std::span<const RimPiece> rims,
                                       std::span<const Tensor> flight) {
    const std::vector<std::size_t> cluster_of = clusters(geometry, gas.size());
    std::vector<std::vector<std::size_t>> members(gas.size());
    for (std::size_t i = 0; i < coarse.size(); ++i) members[cluster_of[region_of(coarse, i)]].push_back(i);
    std::vector<FreeCluster> free;
    for (std::vector<std::size_t>& group : members) {
        if (group.empty()) continue;
        const RimPiece* rim = nullptr;
        for (const std::size_t i : group)
            if (gas[region_of(coarse, i)].held) rim = rim_of(rims, region_of(coarse, i));
        const bool torn =
            std::any_of(group.begin(), group.end(), [&](std::size_t i) { return gas[region_of(coarse, i)].burst; });
        if (torn) continue;
        if (rim == nullptr)
            free.emplace_back(coarse, geometry, std::move(group), all_directions(), flight);
        else if (rim->kind == RimKind::kPlate)
            free.emplace_back(coarse, geometry, std::move(group), directions_on(rim->b, OnPlate::kSlides));
    }
    return free;
}

std::vector<double> gas_areas(const CoarseParticles& coarse,
                              const Geometry& geometry,
                              std::span<const Gas> gas,
                              std::span<const RimPiece> rims) {
    std::vector<double> area(geometry.size()), share(geometry.size());
    for_each_particle(area.size(), [&](std::size_t i) {
        const Neighbors& other = geometry.neighbors.other;
        area[i] = other.begin(i) == other.end(i) ? geometry.area[i] : geometry.star[i].cell_area;
        share[i] = area[i] * fold(geometry, i);
    });
    const std::vector<Vec3> nothing(area.size());
    std::vector<std::vector<std::size_t>> members(gas.size());
    for (std::size_t i = 0; i < area.size(); ++i) members[region_of(coarse, i)].push_back(i);
    for (std::size_t r = 0; r < members.size(); ++r) {
        if (!gas[r].closed || gas[r].burst || members[r].empty()) continue;
        const RimPiece* rim = rim_of(rims, r);
        auto directions = rim == nullptr ? all_directions() : directions_on(rim->b, OnPlate::kGas);
        // Gas pushes the plate in its middle, and half a bubble the other way there.
        const Vec3 middle = rim == nullptr ? Vec3{} : middle_on_plate(coarse, geometry, *rim, members[r]);
        FreeCluster whole(coarse, geometry, std::move(members[r]), std::move(directions));
        if (rim != nullptr) whole.turn_about(middle);
        whole.remove_resultant(area, nothing, share);
    }
    return area;
}

}  // namespace lamella::melp
