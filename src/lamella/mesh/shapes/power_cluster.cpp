#include "lamella/mesh/shapes/power_cluster.h"

#include "lamella/core/error.h"
#include "lamella/core/random.h"
#include "lamella/mesh/volume.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

namespace lamella::mesh {
namespace {

constexpr double kReach = 1.3;       // of a ball: covers the holes between balls that touch
constexpr double kMostPoints = 2e7;  // of the lattice

/// Which region a point is in.
class PowerLabels {
public:
    explicit PowerLabels(const std::vector<Ball>& balls) : balls_(balls) {}

    RegionId operator()(const Vec3& x) const {
        RegionId nearest = kOutside;
        double least = 1e300;
        for (std::size_t i = 0; i < balls_.size(); ++i) {
            const double squared = squared_norm(x - balls_[i].center);
            const double radius = balls_[i].radius;
            if (squared > kReach * kReach * radius * radius || squared - radius * radius >= least) continue;
            least = squared - radius * radius;
            nearest = static_cast<RegionId>(i + 1);
        }
        return nearest;
    }

private:
    const std::vector<Ball>& balls_;
};

/// A body-centered cubic lattice around the balls: corners of cubes and their centers.
class Lattice {
public:
    Lattice(const std::vector<Ball>& balls, double spacing) : spacing_(spacing) {
        Vec3 low{{1e300, 1e300, 1e300}};
        Vec3 high = -low;
        for (const Ball& ball : balls)
            for (std::size_t k = 0; k < 3; ++k) {
                low[k] = std::min(low[k], ball.center[k] - kReach * ball.radius);
                high[k] = std::max(high[k], ball.center[k] + kReach * ball.radius);
            }
        double points = 2.0;
        for (std::size_t k = 0; k < 3; ++k) {
            origin_[k] = low[k] - 1.5 * spacing;
            const double cells = std::ceil((high[k] - low[k]) / spacing) + 3.0;
            points *= cells + 1.0;
            if (!(points < kMostPoints))
                throw InputError("the edge length is too small for these bubbles: more than 20 million lattice points");
            cells_[k] = static_cast<std::uint32_t>(cells);
        }
    }

    std::array<std::uint32_t, 3> cells() const { return cells_; }
    std::uint32_t corner(std::uint32_t i, std::uint32_t j, std::uint32_t k) const { return 2 * cube(i, j, k); }
    std::uint32_t center(std::uint32_t i, std::uint32_t j, std::uint32_t k) const { return 2 * cube(i, j, k) + 1; }
    std::size_t size() const { return 2 * static_cast<std::size_t>(cells_[0] + 1) * (cells_[1] + 1) * (cells_[2] + 1); }
    Vec3 at(std::uint32_t id) const {
        const std::uint32_t cube = id / 2;
        const double half = id % 2 == 1 ? 0.5 : 0.0;
        const std::uint32_t i = cube % (cells_[0] + 1);
        const std::uint32_t j = cube / (cells_[0] + 1) % (cells_[1] + 1);
        const std::uint32_t k = cube / ((cells_[0] + 1) * (cells_[1] + 1));
        return origin_ + spacing_ * Vec3{{i + half, j + half, k + half}};
    }

private:
    std::uint32_t cube(std::uint32_t i, std::uint32_t j, std::uint32_t k) const {
        return i + (cells_[0] + 1) * (j + (cells_[1] + 1) * k);
    }

    double spacing_;
    Vec3 origin_;
    std::array<std::uint32_t, 3> cells_{};
};

/// A point of the films inside a tetrahedron: a place to orient by (middle of its corners), and the mesh vertex.
struct Cut {
    Vec3 middle;
    VertexId vertex;
};

class Marching {
public:
    Marching(const std::vector<Ball>& balls, double spacing);
    FoamMesh run();

private:
    void tetrahedron(std::array<std::uint32_t, 4> corners);
    void two_labels(const std::array<std::uint32_t, 4>& c, std::size_t alone);
    void two_and_two(const std::array<std::uint32_t, 4>& c);
    void three_labels(const std::array<std::uint32_t, 4>& c);
    void four_labels(const std::array<std::uint32_t, 4>& c);
    Cut edge(std::uint32_t a, std::uint32_t b);
    Cut face(std::uint32_t a, std::uint32_t b, std::uint32_t c);
    void triangle(const Cut& a, const Cut& b, const Cut& c, std::uint32_t behind, std::uint32_t before);
    void quad(const Cut& a, const Cut& b, const Cut& c, const Cut& d, std::uint32_t behind, std::uint32_t before) {
        triangle(a, b, c, behind, before);
        triangle(a, c, d, behind, before);
    }
    Vec3 jittered(Vec3 at) const;

    Lattice lattice_;
    PowerLabels label_of_;
    double spacing_;
    std::vector<RegionId> label_;
    std::unordered_map<std::uint64_t, VertexId> on_edge_;
    struct TripleHash {
        std::size_t operator()(const std::array<std::uint32_t, 3>& t) const {
            return (t[0] * 0x9e3779b97f4a7c15ULL) ^ (t[1] * 0xc2b2ae3d27d4eb4fULL) ^ (t[2] * 0x165667b19e3779f9ULL);
        }
    };
    std::unordered_map<std::array<std::uint32_t, 3>, VertexId, TripleHash> on_face_;
    FoamMesh mesh_;
};

Marching::Marching(const std::vector<Ball>& balls, double spacing)
    : lattice_(balls, spacing), label_of_(balls), spacing_(spacing), label_(lattice_.size()) {
    for (std::size_t i = 0; i < label_.size(); ++i) label_[i] = label_of_(lattice_.at(static_cast<std::uint32_t>(i)));
    mesh_.regions.push_back({RegionKind::kOpen, 0.0});
    for (std::size_t i = 0; i < balls.size(); ++i) mesh_.regions.push_back({RegionKind::kClosed, 0.0});
}

/// Off the lattice's planes, where many points would be exactly coplanar.
Vec3 Marching::jittered(Vec3 at) const {
    const auto v = static_cast<std::uint32_t>(mesh_.position.size());
    for (std::uint32_t k = 0; k < 3; ++k)
        at[k] += 1e-3 * spacing_ * (uniform01(random_bits(0, RandomStream::kMeshJitter, k, v)) - 0.5);
    return at;
}

Cut Marching::edge(std::uint32_t a, std::uint32_t b) {
    if (a > b) std::swap(a, b);
    const Vec3 from = lattice_.at(a);
    const Vec3 to = lattice_.at(b);
    const auto [it, fresh] = on_edge_.try_emplace((std::uint64_t{a} << 32) | b);
    if (fresh) {
        // Where label_of changes, kept away from the ends.
        double low = 0.0, high = 1.0;
        for (int step = 0; step < 12; ++step) {
            const double middle = 0.5 * (low + high);
            (label_of_(from + middle * (to - from)) == label_[a] ? low : high) = middle;
        }
        it->second = mesh_.add_vertex(jittered(from + std::clamp(low, 0.2, 0.8) * (to - from)));
    }
    return {0.5 * (from + to), it->second};
}

Cut Marching::face(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const Cut ab = edge(a, b), bc = edge(b, c), ca = edge(c, a);
    std::array<std::uint32_t, 3> key{a, b, c};
    std::sort(key.begin(), key.end());
    const auto [it, fresh] = on_face_.try_emplace(key);
    if (fresh)
        it->second = mesh_.add_vertex(jittered(
            (1.0 / 3.0) * (mesh_.position[ab.vertex] + mesh_.position[bc.vertex] + mesh_.position[ca.vertex])));
    return {(1.0 / 3.0) * (lattice_.at(a) + lattice_.at(b) + lattice_.at(c)), it->second};
}

/// Oriented from the region of lattice point `behind` to that of `before`.
void Marching::triangle(const Cut& a, const Cut& b, const Cut& c, std::uint32_t behind, std::uint32_t before) {
    const Vec3 normal = cross(b.middle - a.middle, c.middle - a.middle);
    const bool forward = dot(normal, lattice_.at(before) - lattice_.at(behind)) > 0.0;
    mesh_.add_face(a.vertex, forward ? b.vertex : c.vertex, forward ? c.vertex : b.vertex, label_[behind],
                   label_[before]);
}

void Marching::two_labels(const std::array<std::uint32_t, 4>& c, std::size_t alone) {
    const std::uint32_t a = c[alone];
    const std::uint32_t p = c[(alone + 1) % 4], q = c[(alone + 2) % 4], r = c[(alone + 3) % 4];
    triangle(edge(a, p), edge(a, q), edge(a, r), a, p);
}

/// c[0], c[1] against c[2], c[3].
void Marching::two_and_two(const std::array<std::uint32_t, 4>& c) {
    quad(edge(c[0], c[2]), edge(c[0], c[3]), edge(c[1], c[3]), edge(c[1], c[2]), c[0], c[2]);
}

/// c[0] and c[1] alike, c[2] and c[3] different: a triple line between the two faces with three labels.
void Marching::three_labels(const std::array<std::uint32_t, 4>& c) {
    const Cut f0 = face(c[0], c[2], c[3]);
    const Cut f1 = face(c[1], c[2], c[3]);
    triangle(edge(c[2], c[3]), f0, f1, c[2], c[3]);
    quad(edge(c[0], c[2]), edge(c[1], c[2]), f1, f0, c[0], c[2]);
    quad(edge(c[0], c[3]), edge(c[1], c[3]), f1, f0, c[0], c[3]);
}

/// Four triple lines meet inside.
void Marching::four_labels(const std::array<std::uint32_t, 4>& c) {
    std::array<Cut, 4> opposite;  // face without corner i
    Vec3 middle, place;
    for (std::size_t i = 0; i < 4; ++i) {
        opposite[i] = face(c[(i + 1) % 4], c[(i + 2) % 4], c[(i + 3) % 4]);
        middle += 0.25 * lattice_.at(c[i]);
        place += 0.25 * mesh_.position[opposite[i].vertex];
    }
    const Cut inside{middle, mesh_.add_vertex(jittered(place))};
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = i + 1; j < 4; ++j) {
            std::array<std::size_t, 2> others{};
            std::size_t n = 0;
            for (std::size_t k = 0; k < 4; ++k)
                if (k != i && k != j) others[n++] = k;
            quad(edge(c[i], c[j]), opposite[others[0]], inside, opposite[others[1]], c[i], c[j]);
        }
}

void Marching::tetrahedron(std::array<std::uint32_t, 4> c) {
    const auto label = [&](std::size_t i) { return label_[c[i]]; };
    if (label(0) == label(1) && label(0) == label(2) && label(0) == label(3)) return;
    // Corners with the same label side by side.
    std::stable_sort(c.begin(), c.end(), [&](std::uint32_t a, std::uint32_t b) { return label_[a] < label_[b]; });
    const bool same01 = label(0) == label(1), same12 = label(1) == label(2), same23 = label(2) == label(3);
    switch (same01 + same12 + same23) {
        case 0:
            four_labels(c);
            break;
        case 1:
            if (same12) c = {c[1], c[2], c[0], c[3]};
            if (same23) c = {c[2], c[3], c[0], c[1]};
            three_labels(c);
            break;
        default:
            if (same01 && same23)
                two_and_two(c);
            else
                two_labels(c, same01 ? 3 : 0);
    }
}

FoamMesh Marching::run() {
    const auto [nx, ny, nz] = lattice_.cells();
    for (std::uint32_t k = 1; k < nz; ++k)
        for (std::uint32_t j = 1; j < ny; ++j)
            for (std::uint32_t i = 1; i < nx; ++i)
                // Two neighboring centers and the four corners between them, once per axis.
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    const std::uint32_t here = lattice_.center(i, j, k);
                    const std::uint32_t there = lattice_.center(i - (axis == 0), j - (axis == 1), k - (axis == 2));
                    std::array<std::uint32_t, 4> ring{};
                    constexpr std::array<std::array<std::uint32_t, 2>, 4> kAround{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
                    for (std::size_t n = 0; n < 4; ++n) {
                        const auto [s, t] = kAround[n];
                        ring[n] = axis == 0   ? lattice_.corner(i, j + s, k + t)
                                  : axis == 1 ? lattice_.corner(i + s, j, k + t)
                                              : lattice_.corner(i + s, j + t, k);
                    }
                    for (std::size_t n = 0; n < 4; ++n) tetrahedron({here, there, ring[n], ring[(n + 1) % 4]});
                }
    return std::move(mesh_);
}

}  // namespace

std::vector<Ball> pack_balls(const std::vector<double>& radii, std::uint64_t seed) {
    double volume = 0.0;
    for (const double r : radii) {
        if (!(r > 0.0) || !std::isfinite(r))
            throw InputError(fmt::format("a bubble's radius must be positive (got {})", r));
        volume += r * r * r;
    }
    const double heap = 1.5 * std::cbrt(volume);
    std::vector<Ball> balls;
    for (std::size_t i = 0; i < radii.size(); ++i) {
        Vec3 at;
        for (std::uint32_t k = 0; k < 3; ++k)
            at[k] = heap * (2.0 * uniform01(random_bits(seed, RandomStream::kClusterPosition, k, i)) - 1.0);
        balls.push_back({at, radii[i]});
    }
    constexpr int kRounds = 1000;
    for (int round = 0; round < kRounds; ++round) {
        // Drawn to the middle, less and less; pairs that overlap are pushed apart.
        const double draw = 0.02 * (1.0 - static_cast<double>(round) / kRounds);
        for (Ball& ball : balls) ball.center *= 1.0 - draw;
        for (std::size_t i = 0; i < balls.size(); ++i)
            for (std::size_t j = 0; j < i; ++j) {
                const Vec3 apart = balls[i].center - balls[j].center;
                const double distance = norm(apart);
                const double overlap = balls[i].radius + balls[j].radius - distance;
                if (overlap <= 0.0 || distance == 0.0) continue;
                const Vec3 push = (0.4 * overlap / distance) * apart;
                balls[i].center += push;
                balls[j].center -= push;
            }
    }
    return balls;
}

FoamMesh power_cluster(const std::vector<Ball>& balls, double edge_length) {
    if (balls.empty()) throw InputError("a cluster needs at least one bubble");
    if (!(edge_length > 0.0) || !std::isfinite(edge_length))
        throw InputError(fmt::format("the edge length must be positive (got {})", edge_length));
    constexpr double kSpacing =
        1.5;  // of the lattice, in edges: its tetrahedra are cut into triangles about half as large
    FoamMesh mesh = Marching(balls, kSpacing * edge_length).run();
    const auto volumes = region_volumes(mesh);
    for (const RegionId r : mesh.regions.ids()) {
        if (r == kOutside) continue;
        if (!(volumes[r] > 0.0))
            throw InputError(fmt::format("bubble {} (radius {}) is too small for edges of length {}", index(r),
                                         balls[index(r) - 1].radius, edge_length));
        mesh.regions[r].target_volume = volumes[r];
    }
    return mesh;
}

}  // namespace lamella::mesh
