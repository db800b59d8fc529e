#include "lamella/geometry/triangle_intersection.h"

#include "lamella/geometry/predicates.h"

#include <algorithm>
#include <cmath>

namespace lamella::geometry {
namespace {

/// Drops the coordinate along which the triangle's normal is longest: what lies in its plane keeps its order.
class Projection {
public:
    explicit Projection(const Triangle& t) {
        const Vec3 n = cross(t[1] - t[0], t[2] - t[0]);
        const double x = std::abs(n[0]), y = std::abs(n[1]), z = std::abs(n[2]);
        dropped_ = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    }
    Vec2 operator()(const Vec3& p) const { return {{p[(dropped_ + 1) % 3], p[(dropped_ + 2) % 3]}}; }

private:
    std::size_t dropped_;
};

/// p lies in the box of a and b; for p on their line: on the segment.
bool within(const Vec2& a, const Vec2& b, const Vec2& p) {
    return std::min(a[0], b[0]) <= p[0] && p[0] <= std::max(a[0], b[0]) && std::min(a[1], b[1]) <= p[1] &&
           p[1] <= std::max(a[1], b[1]);
}

bool segments_meet(const Vec2& p, const Vec2& q, const Vec2& a, const Vec2& b) {
    const int pa = orient2d(p, q, a);
    const int pb = orient2d(p, q, b);
    const int ap = orient2d(a, b, p);
    const int aq = orient2d(a, b, q);
    if (pa * pb < 0 && ap * aq < 0) return true;
    return (pa == 0 && within(p, q, a)) || (pb == 0 && within(p, q, b)) || (ap == 0 && within(a, b, p)) ||
           (aq == 0 && within(a, b, q));
}

bool contains(const std::array<Vec2, 3>& t, const Vec2& p) {
    const int s0 = orient2d(t[0], t[1], p);
    const int s1 = orient2d(t[1], t[2], p);
    const int s2 = orient2d(t[2], t[0], p);
    return (s0 >= 0 && s1 >= 0 && s2 >= 0) || (s0 <= 0 && s1 <= 0 && s2 <= 0);
}

bool coplanar_segment_meets(const Vec3& p, const Vec3& q, const Triangle& t) {
    const Projection flat(t);
    const std::array<Vec2, 3> corners{flat(t[0]), flat(t[1]), flat(t[2])};
    const Vec2 a = flat(p);
    const Vec2 b = flat(q);
    for (std::size_t i = 0; i < 3; ++i)
        if (segments_meet(a, b, corners[i], corners[(i + 1) % 3])) return true;
    return contains(corners, a);
}

/// With the signs of p and q against the plane of t already known.
bool segment_meets(const Vec3& p, int sign_p, const Vec3& q, int sign_q, const Triangle& t) {
    if (sign_p * sign_q > 0) return false;
    if (sign_p == 0 && sign_q == 0) return coplanar_segment_meets(p, q, t);
    const int s0 = orient3d(p, q, t[0], t[1]);
    const int s1 = orient3d(p, q, t[1], t[2]);
    if (s0 * s1 < 0) return false;
    const int s2 = orient3d(p, q, t[2], t[0]);
    return s0 * s2 >= 0 && s1 * s2 >= 0;
}

std::array<int, 3> sides(const Triangle& plane, const Triangle& points) {
    return {orient3d(plane[0], plane[1], plane[2], points[0]), orient3d(plane[0], plane[1], plane[2], points[1]),
            orient3d(plane[0], plane[1], plane[2], points[2])};
}

bool on_one_side(const std::array<int, 3>& signs) {
    return (signs[0] > 0 && signs[1] > 0 && signs[2] > 0) || (signs[0] < 0 && signs[1] < 0 && signs[2] < 0);
}

}  // namespace

bool segment_meets_triangle(const Vec3& p, const Vec3& q, const Triangle& t) {
    return segment_meets(p, orient3d(t[0], t[1], t[2], p), q, orient3d(t[0], t[1], t[2], q), t);
}

bool triangles_meet(const Triangle& s, const Triangle& t) {
    const std::array<int, 3> of_t = sides(s, t);
    if (on_one_side(of_t)) return false;
    const std::array<int, 3> of_s = sides(t, s);
    if (on_one_side(of_s)) return false;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        if (segment_meets(t[i], of_t[i], t[j], of_t[j], s) || segment_meets(s[i], of_s[i], s[j], of_s[j], t))
            return true;
    }
    return false;
}

bool triangles_meet_beyond_shared(const Triangle& s, const Triangle& t, int shared) {
    if (shared == 1) return segment_meets_triangle(s[1], s[2], t) || segment_meets_triangle(t[1], t[2], s);
    if (orient3d(s[0], s[1], s[2], t[2]) != 0) return false;
    const Projection flat(s);
    return orient2d(flat(s[0]), flat(s[1]), flat(s[2])) * orient2d(flat(s[0]), flat(s[1]), flat(t[2])) > 0;
}

}  // namespace lamella::geometry
