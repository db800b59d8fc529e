#include "lamella/solvers/melp/voronoi.h"

#include "lamella/solvers/melp/geometry.h"

#include <algorithm>

namespace lamella::melp {

void VoronoiCell::build(std::span<const Vec3> position, const Vec3& normal, const Neighbors& same, std::size_t i) {
    const double far = same.kernel.support_radius;
    cell_.assign({{-far, -far, kNobody}, {far, -far, kNobody}, {far, far, kNobody}, {-far, far, kNobody}});
    farthest_ = 2.0 * far * far;
    const Frame frame = frame_of(normal);
    seen_.clear();
    for (std::size_t k = same.begin(i); k < same.end(i); ++k) {
        const Vec3 d = position[same.index[k]] - position[i];
        seen_.push_back({same.index[k], dot(frame.e1, d), dot(frame.e2, d), squared_norm(d)});
    }
    // Near ones first: few of the others touch what they leave.
    const double near = 0.5 * far;
    for (const bool nearer : {true, false})
        for (const Seen& other : seen_)
            if ((other.square < near * near) == nearer) cut_off(other.j, other.u, other.v);
}

void VoronoiCell::cut_off(std::uint32_t j, double u, double v) {
    const double half = 0.5 * (u * u + v * v);
    if (half == 0.0 || half > 2.0 * farthest_) return;  // its bisector passes beyond all corners
    beyond_.resize(cell_.size());
    bool any = false;
    for (std::size_t c = 0; c < cell_.size(); ++c) {
        beyond_[c] = cell_[c].u * u + cell_[c].v * v - half;
        any = any || beyond_[c] > 0.0;
    }
    if (!any) return;
    cut_.clear();
    farthest_ = 0.0;
    const auto add = [&](const Corner& corner) {
        farthest_ = std::max(farthest_, corner.u * corner.u + corner.v * corner.v);
        cut_.push_back(corner);
    };
    for (std::size_t c = 0; c < cell_.size(); ++c) {
        const std::size_t after = c + 1 == cell_.size() ? 0 : c + 1;
        const Corner &a = cell_[c], &b = cell_[after];
        const double at_a = beyond_[c], at_b = beyond_[after];
        const auto crossing = [&](std::uint32_t next) {
            const double s = at_a / (at_a - at_b);
            return Corner{a.u + s * (b.u - a.u), a.v + s * (b.v - a.v), next};
        };
        if (at_a <= 0.0) add(a);
        if (at_a <= 0.0 && at_b > 0.0) add(crossing(j));
        if (at_a > 0.0 && at_b <= 0.0) add(crossing(a.next));
    }
    cell_.swap(cut_);
}

double VoronoiCell::area() const {
    double sum = 0.0;
    for (std::size_t k = 0; k < cell_.size(); ++k) {
        const Corner& b = cell_[(k + 1) % cell_.size()];
        sum += cell_[k].u * b.v - cell_[k].v * b.u;
    }
    return 0.5 * sum;
}

Star star_of(
    std::span<const Vec3> x, std::span<const Vec3> n, const Neighbors& same, std::size_t i, VoronoiCell& cell) {
    cell.build(x, n[i], same, i);
    Star star;
    star.cell_area = cell.area();
    const auto ring = cell.corners();
    for (std::size_t k = 0; k < ring.size(); ++k) {
        const std::uint32_t a = ring[k].next, b = ring[(k + 1) % ring.size()].next;
        if (a == VoronoiCell::kNobody || b == VoronoiCell::kNobody || a == b) continue;
        const Vec3 area = 0.5 * cross(x[a] - x[i], x[b] - x[i]);
        const double bulge =
            dot(n[a] - n[i], x[a] - x[i]) + dot(n[b] - n[a], x[b] - x[a]) + dot(n[i] - n[b], x[i] - x[b]);
        star.area += area;
        star.bulge += norm(area) * bulge / 24.0;
    }
    return star;
}

}  // namespace lamella::melp
