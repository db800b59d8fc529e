#include "lamella/solvers/equilibrium/rest_system.h"

#include "lamella/core/parallel.h"
#include "lamella/linalg/dense.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lamella::equilibrium {
namespace {

constexpr std::size_t kPatchBlock = 128;  // patches that one task handles

double smallest_size(const mesh::FoamMesh& mesh, const std::vector<double>& targets) {
    double volume = std::numeric_limits<double>::infinity();
    for (const double v : targets) volume = std::min(volume, v);
    if (!targets.empty() && volume > 0.0) return std::cbrt(volume * 3.0 / (4.0 * 3.14159265358979));
    // Films on wires: half the size of the box around them.
    Vec3 low = mesh.position.empty() ? Vec3{} : mesh.position.values()[0], high = low;
    for (const Vec3& x : mesh.position)
        for (std::size_t k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], x[k]);
            high[k] = std::max(high[k], x[k]);
        }
    return std::max(0.25 * norm(high - low), std::numeric_limits<double>::min());
}

}  // namespace

RestSystem::RestSystem(const mesh::FoamMesh& mesh, const mesh::EdgeFaces& edges, Patches patches)
    : patches_(std::move(patches)), space_(mesh, edges, patches_), row_(mesh.regions.size(), -1),
      origin_(mesh.regions.size()) {
    IdVector<mesh::RegionId, int> sides(mesh.regions.size(), 0);
    for (std::size_t p = 0; p < patches_.size(); ++p)
        for (const mesh::RegionId r : {patches_.back[p], patches_.front[p]}) {
            ++sides[r];
            origin_[r] += patches_.corners(p)[0];
        }
    bool fills_space = mesh.periodic();
    for (const mesh::RegionId r : mesh.regions.ids()) {
        if (sides[r] == 0) continue;
        origin_[r] *= mesh.periodic() ? 0.0 : 1.0 / sides[r];
        if (mesh.regions[r].kind != mesh::RegionKind::kClosed) {
            fills_space = false;
            continue;
        }
        constrained_.push_back(r);
        target_.push_back(mesh.regions[r].target_volume);
    }
    length_ = smallest_size(mesh, target_);
    if (fills_space && !constrained_.empty()) {  // the volumes add up to that of the box: one follows from the others
        constrained_.erase(constrained_.begin());
        target_.erase(target_.begin());
    }
    for (std::size_t c = 0; c < constrained_.size(); ++c) row_[constrained_[c]] = static_cast<int>(c);
    auto shifts = region_shifts(mesh, edges);
    back_shift_ = std::move(shifts.back);
    front_shift_ = std::move(shifts.front);
    add_patch_couplings();
}

void RestSystem::add_patch_couplings() {
    linalg::Groups groups;
    const auto per_patch = static_cast<std::size_t>(patches_.nodes_per_patch);
    for (const auto& nodes : patches_.nodes) {
        for (std::size_t k = 0; k < per_patch; ++k)
            for (std::size_t i = 0; i < space_.dimension(nodes[k]); ++i)
                groups.member.push_back(static_cast<int>(space_.first(nodes[k]) + i));
        groups.close_group();
    }
    matrix_ = linalg::coupled(space_.size(), groups);
    slot_start_.assign(1, 0);
    for (std::size_t p = 0; p < patches_.size(); ++p) {
        const auto unknowns = groups.of(p);
        for (std::size_t i = 0; i < unknowns.size(); ++i)
            for (std::size_t j = 0; j <= i; ++j)
                slot_.push_back(static_cast<int>(matrix_.slot(unknowns[i], unknowns[j])));
        slot_start_.push_back(slot_.size());
    }
    entry_.resize(slot_.size());
}

Balance RestSystem::balance(bool with_slopes) const {
    const auto per_patch = static_cast<std::size_t>(patches_.nodes_per_patch);
    std::vector<PatchMeasures> measures(patches_.size());
    parallel_blocks(patches_.size(), kPatchBlock, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p)
            measures[p] = measure_patch(patches_.nodes_per_patch, patches_.corners(p));
    });

    Balance balance;
    balance.missing = target_;
    std::vector<Vec3> slope(patches_.position.size());
    std::vector<double> mass(patches_.position.size(), 0.0);
    if (with_slopes) balance.volume_slope.assign(constrained_.size(), std::vector<double>(space_.size(), 0.0));
    for (std::size_t p = 0; p < patches_.size(); ++p) {
        const PatchMeasures& m = measures[p];
        balance.area += patches_.tension[p] * m.area;
        const auto add_side = [&](mesh::RegionId region, double sign, const std::vector<Vec3>& shift) {
            if (row_[region] < 0) return;
            const auto c = static_cast<std::size_t>(row_[region]);
            const Vec3 from = shift.empty() ? -origin_[region] : shift[p];
            balance.missing[c] -= sign * (m.volume + dot(from, m.area_vector) / 3.0);
            if (!with_slopes) return;
            for (std::size_t k = 0; k < per_patch; ++k) {
                const std::uint32_t node = patches_.nodes[p][k];
                const auto basis = space_.at(node);
                for (std::size_t i = 0; i < basis.size(); ++i)
                    balance.volume_slope[c][space_.first(node) + i] += sign * dot(basis[i], m.flux[k]);
            }
        };
        add_side(patches_.back[p], 1.0, back_shift_);
        add_side(patches_.front[p], -1.0, front_shift_);
        for (std::size_t k = 0; k < per_patch; ++k) {
            const std::uint32_t node = patches_.nodes[p][k];
            slope[node] += patches_.tension[p] * m.area_slope[k];
            mass[node] += m.area / static_cast<double>(per_patch);
            balance.scale += patches_.tension[p] * patches_.tension[p] * squared_norm(m.area_slope[k]);
        }
    }
    balance.scale = std::sqrt(balance.scale);
    if (!with_slopes) return balance;
    balance.slope = space_.restrict(slope);
    balance.mass.resize(space_.size());
    for (std::size_t node = 0; node < mass.size(); ++node)
        for (std::size_t i = 0; i < space_.dimension(node); ++i) balance.mass[space_.first(node) + i] = mass[node];
    return balance;
}

std::vector<double> RestSystem::best_pressures(const Balance& b) const {
    const std::size_t n = constrained_.size();
    std::vector<double> matrix(n * n), right(n);
    for (std::size_t r = 0; r < n; ++r) {
        const std::vector<double>& g = b.volume_slope[r];
        for (std::size_t s = 0; s <= r; ++s) {
            double sum = 0.0;
            for (std::size_t i = 0; i < g.size(); ++i) sum += g[i] * b.volume_slope[s][i] / b.mass[i];
            matrix[r * n + s] = sum;
        }
        for (std::size_t i = 0; i < g.size(); ++i) right[r] += g[i] * b.slope[i] / b.mass[i];
    }
    return linalg::solve_symmetric(n, matrix, right).x;
}

double RestSystem::residual(const Balance& b, const std::vector<double>& pressure) {
    double sum = 0.0;
    for (std::size_t i = 0; i < b.slope.size(); ++i) {
        double out = b.slope[i];
        for (std::size_t r = 0; r < pressure.size(); ++r) out -= b.volume_slope[r][i] * pressure[r];
        sum += out * out;
    }
    return b.scale > 0.0 ? std::sqrt(sum) / b.scale : 0.0;
}

double RestSystem::pressure_jump(std::size_t p, const std::vector<double>& pressure) const {
    const int back = row_[patches_.back[p]], front = row_[patches_.front[p]];
    return (back < 0 ? 0.0 : pressure[static_cast<std::size_t>(back)]) -
           (front < 0 ? 0.0 : pressure[static_cast<std::size_t>(front)]);
}

const linalg::SymmetricMatrix& RestSystem::hessian(const std::vector<double>& pressure) {
    const auto per_patch = static_cast<std::size_t>(patches_.nodes_per_patch);
    parallel_blocks(patches_.size(), kPatchBlock, [&](std::size_t begin, std::size_t end) {
        std::array<Matrix3, 36> block;
        for (std::size_t p = begin; p < end; ++p) {
            patch_hessian(patches_.nodes_per_patch, patches_.corners(p), patches_.tension[p],
                          pressure_jump(p, pressure), block);
            double* out = entry_.data() + slot_start_[p];
            const auto value = [&](const Matrix3& m, const Vec3& left, const Vec3& right) {
                return left[0] * dot(m[0], right) + left[1] * dot(m[1], right) + left[2] * dot(m[2], right);
            };
            // In the order of the slots: unknown by unknown, each with all before it and itself.
            for (std::size_t k = 0; k < per_patch; ++k) {
                const auto rows = space_.at(patches_.nodes[p][k]);
                for (std::size_t i = 0; i < rows.size(); ++i)
                    for (std::size_t l = 0; l <= k; ++l) {
                        const auto columns = space_.at(patches_.nodes[p][l]);
                        const std::size_t last = l < k ? columns.size() : i + 1;
                        for (std::size_t j = 0; j < last; ++j) *out++ = value(block[k * 6 + l], rows[i], columns[j]);
                    }
            }
        }
    });
    std::fill(matrix_.value.begin(), matrix_.value.end(), 0.0);
    for (std::size_t k = 0; k < slot_.size(); ++k) matrix_.value[static_cast<std::size_t>(slot_[k])] += entry_[k];
    return matrix_;
}

std::vector<Vec3> RestSystem::project_volumes(std::vector<Vec3> position, int rounds) {
    if (constrained_.empty()) return position;
    const std::vector<Vec3> start = std::exchange(patches_.position, std::move(position));
    const std::size_t n = constrained_.size();
    for (int round = 0; round < rounds; ++round) {
        const Balance b = balance();
        double worst = 0.0;
        for (std::size_t r = 0; r < n; ++r) worst = std::max(worst, std::abs(b.missing[r]) / std::abs(target_[r]));
        if (worst < 1e-13) break;
        std::vector<double> matrix(n * n);
        for (std::size_t r = 0; r < n; ++r)
            for (std::size_t s = 0; s <= r; ++s)
                for (std::size_t i = 0; i < b.mass.size(); ++i)
                    matrix[r * n + s] += b.volume_slope[r][i] * b.volume_slope[s][i] / b.mass[i];
        const std::vector<double> mu = linalg::solve_symmetric(n, matrix, b.missing).x;
        std::vector<double> x(space_.size(), 0.0);
        for (std::size_t i = 0; i < x.size(); ++i) {
            for (std::size_t r = 0; r < n; ++r) x[i] += b.volume_slope[r][i] * mu[r];
            x[i] /= b.mass[i];
        }
        const std::vector<Vec3> move = space_.expand(x);
        for (std::size_t node = 0; node < move.size(); ++node) patches_.position[node] += move[node];
    }
    return std::exchange(patches_.position, start);
}

namespace {

/// A side of a face: 2 f behind it, 2 f + 1 in front.
std::size_t side_of(const mesh::EdgeUse& use, bool ahead) {
    // Seen along the edge from a to b, a face that runs from a to b has its front counterclockwise of itself.
    return 2 * index(use.face) + (use.forward == ahead ? 1 : 0);
}

/// Two sides with the same gas between them, across an edge.
struct Contact {
    std::size_t side;
    Vec3 step;  // what to add to the shift of this side to get that of the other
};

/// For every side its contacts across the face's edges. A bubble may meet itself, so labels do not tell which sides
/// belong together: their order around the edge does.
std::vector<std::vector<Contact>> contacts(const mesh::FoamMesh& mesh, const mesh::EdgeFaces& edges) {
    std::vector<std::vector<Contact>> found(2 * mesh.faces.size());
    for (std::size_t e = 0; e < edges.size(); ++e) {
        const auto uses = edges.of(e);
        const Vec3 along = mesh::edge_vector(mesh, uses[0]);
        struct Spoke {
            mesh::EdgeUse use;
            double angle;
            Vec3 image;  // of the edge's vertex a in this face
        };
        std::vector<Spoke> spokes;
        Vec3 x;
        for (const mesh::EdgeUse& use : uses) {
            const std::size_t a = (use.opposite + (use.forward ? 1U : 2U)) % 3;
            const Vec3 start = mesh.corner(use.face, a);
            Vec3 out = mesh.corner(use.face, use.opposite) - start;
            out -= (dot(out, along) / squared_norm(along)) * along;
            if (spokes.empty()) x = out;
            const double angle = spokes.empty() ? 0.0 : std::atan2(dot(cross(x, out), along) / norm(along), dot(x, out));
            spokes.push_back({use, angle, start - mesh.position[mesh.faces[use.face].vertices[a]]});
        }
        std::sort(spokes.begin(), spokes.end(), [](const Spoke& p, const Spoke& q) { return p.angle < q.angle; });
        for (std::size_t k = 0; k < spokes.size(); ++k) {
            const Spoke& p = spokes[k];
            const Spoke& q = spokes[(k + 1) % spokes.size()];
            const std::size_t low = side_of(p.use, true), high = side_of(q.use, false);
            found[low].push_back({high, p.image - q.image});
            found[high].push_back({low, q.image - p.image});
        }
    }
    return found;
}

}  // namespace

RegionShifts region_shifts(const mesh::FoamMesh& mesh, const mesh::EdgeFaces& edges) {
    RegionShifts shifts;
    if (!mesh.periodic()) return shifts;
    const std::vector<std::vector<Contact>> neighbors = contacts(mesh, edges);
    std::vector<Vec3> shift(neighbors.size());
    std::vector<std::uint8_t> known(neighbors.size(), 0);
    for (std::size_t seed = 0; seed < neighbors.size(); ++seed) {
        if (known[seed] != 0) continue;
        known[seed] = 1;
        std::vector<std::size_t> queue{seed};
        while (!queue.empty()) {
            const std::size_t side = queue.back();
            queue.pop_back();
            for (const Contact& contact : neighbors[side]) {
                if (known[contact.side] != 0) continue;
                known[contact.side] = 1;
                shift[contact.side] = shift[side] + contact.step;
                queue.push_back(contact.side);
            }
        }
    }
    for (std::size_t side = 0; side < shift.size(); side += 2) {
        shifts.back.push_back(shift[side]);
        shifts.front.push_back(shift[side + 1]);
    }
    return shifts;
}

}  // namespace lamella::equilibrium
