#include "lamella/solvers/melp/rims.h"

#include "lamella/film/solid.h"

#include <algorithm>
#include <cmath>

namespace lamella::melp {
namespace {

// Where two wires meet at less than this angle, the film turned about both fills the corner behind them; at wider ones
// the two pictures meet.
constexpr double kWidestCorner = 1.83;  // 105 degrees

Tensor product(const Tensor& a, const Tensor& b) {
    Tensor c;
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t m = 0; m < 3; ++m) c[k][m] = a[k][0] * b[0][m] + a[k][1] * b[1][m] + a[k][2] * b[2][m];
    return c;
}

/// +-(2 e e^T - 1): half a turn about the unit vector e, or the reflection across the plane normal to it.
Tensor half_turn(const Vec3& e, double sign) {
    Tensor m;
    for (std::size_t k = 0; k < 3; ++k) {
        m[k] = (sign * 2.0 * e[k]) * e;
        m[k][k] -= sign;
    }
    return m;
}

Vec3 unit(const Vec3& x) { return x / norm(x); }

/// A film that meets a ball or stick at a right angle ends there on a line that turns, within the film, as the solid's
/// surface does along it. What lies at `height` above it has a picture that is narrower by the ratio of the two arcs.
double narrowing(const RimPiece& piece, const Vec3& foot, const Vec3& x, const Vec3& normal) {
    const Vec3 middle = film::nearest_on_axis(piece.a, piece.b, x), outward = unit(foot - middle);
    double curvature = 1.0 / piece.radius;
    const bool side = squared_norm(piece.b) > 0.0 && std::abs(dot(middle - piece.a, piece.b)) < squared_norm(piece.b);
    if (side) {
        const Vec3 along = cross(normal, outward);
        const double straight =
            dot(along, piece.b) * dot(along, piece.b) / (squared_norm(piece.b) * squared_norm(along));
        curvature *= squared_norm(along) > 0.0 ? 1.0 - straight : 0.0;
    }
    const double height = dot(x - foot, outward);
    return std::max(1.0 - height * curvature, 0.0) / (1.0 + height * curvature);
}

/// The picture behind one piece, for films near `foot`.
Mirror mirror_at(const RimPiece& piece, std::uint32_t index, const Vec3& foot, const Vec3& x, const Vec3& normal) {
    Mirror mirror{};
    switch (piece.kind) {
        case RimKind::kLine:
            mirror.map = half_turn(unit(piece.b - piece.a), 1.0);
            break;
        case RimKind::kRing:
            mirror.map = half_turn(unit(cross(piece.b, foot - piece.a)), 1.0);
            break;
        case RimKind::kPlate:
            mirror.map = half_turn(piece.b, -1.0);
            break;
        case RimKind::kBall:
            mirror.map = half_turn(unit(x - film::nearest_on_axis(piece.a, piece.b, x)), -1.0);
            mirror.root = std::sqrt(narrowing(piece, foot, x, normal));
            break;
    }
    mirror.sign = piece.slides() ? 1.0 : -1.0;
    mirror.shift = foot - mirror.map * foot;
    const Vec3 v = piece.velocity_at(foot);
    mirror.drift = v - mirror.map * v;
    mirror.key = index;
    return mirror;
}

}  // namespace

std::optional<Vec3> RimPiece::foot(const Vec3& x) const {
    switch (kind) {
        case RimKind::kLine: {
            const Vec3 along = b - a;
            const double s = dot(x - a, along) / squared_norm(along);
            if (!(s >= 0.0 && s <= 1.0)) return std::nullopt;
            return a + s * along;
        }
        case RimKind::kRing: {
            const Vec3 arm = (x - a) - dot(x - a, b) * b;
            const double length = norm(arm);
            if (!(length > 0.0)) return std::nullopt;
            return a + (radius / length) * arm;
        }
        case RimKind::kPlate:
            return x - dot(x - a, b) * b;
        case RimKind::kBall: {
            const Vec3 middle = film::nearest_on_axis(a, b, x);
            const double distance = norm(x - middle);
            if (!(distance > 0.0)) return std::nullopt;
            return middle + (radius / distance) * (x - middle);
        }
    }
    return std::nullopt;
}

Vec3 RimPiece::velocity_at(const Vec3& foot) const {
    if (kind != RimKind::kLine) return velocity_a + cross(velocity_b, foot - a);
    const Vec3 along = b - a;
    const double s = dot(foot - a, along) / squared_norm(along);
    return (1.0 - s) * velocity_a + s * velocity_b;
}

void Rims::add(const RimPiece& piece, std::int32_t wire_a, std::int32_t wire_b) {
    pieces_.push_back({piece, wire_a, wire_b});
}

bool Rims::holds(std::int32_t region) const {
    return std::any_of(pieces_.begin(), pieces_.end(), [&](const Told& t) { return t.piece.region == region; });
}

std::vector<RimPiece> Rims::at(double time) const {
    const auto wire_of = [&](std::int32_t w) { return w < 0 ? film::Wire{} : wires_[static_cast<std::size_t>(w)]; };
    std::vector<RimPiece> pieces;
    pieces.reserve(pieces_.size());
    for (const Told& told : pieces_) {
        RimPiece p = told.piece;
        const film::Wire wire_a = wire_of(told.wire_a), wire_b = wire_of(told.wire_b);
        const auto velocity = [&](const film::Wire& wire, const Vec3& now) {
            if (time < wire.start || time >= wire.end) return Vec3{};
            return wire.velocity + cross(wire.spin, now - (wire.center + (time - wire.start) * wire.velocity));
        };
        p.a = wire_a.carried(told.piece.a, 0.0, time);
        p.velocity_a = velocity(wire_a, p.a);
        if (p.kind == RimKind::kLine) {
            p.b = wire_b.carried(told.piece.b, 0.0, time);
            p.velocity_b = velocity(wire_b, p.b);
        } else {
            p.b = wire_a.carried(told.piece.a + told.piece.b, 0.0, time) - p.a;
            p.velocity_b = time >= wire_a.start && time < wire_a.end ? wire_a.spin : Vec3{};
        }
        pieces.push_back(p);
    }
    return pieces;
}

double Rims::fastest() const {
    double fastest = 0.0;
    for (const Told& told : pieces_)
        for (const std::int32_t w : {told.wire_a, told.wire_b}) {
            if (w < 0) continue;
            const film::Wire& wire = wires_[static_cast<std::size_t>(w)];
            const bool line = told.piece.kind == RimKind::kLine;
            const double arm = line ? std::max(norm(told.piece.a - wire.center), norm(told.piece.b - wire.center))
                                    : norm(told.piece.a - wire.center) + told.piece.radius;
            fastest = std::max(fastest, norm(wire.velocity) + norm(wire.spin) * arm);
        }
    return fastest;
}

void append_mirrors(std::span<const RimPiece> pieces,
                    std::int32_t region,
                    const Vec3& x,
                    const Vec3& normal,
                    double reach,
                    std::vector<Mirror>& mirrors) {
    const auto near = [&](const RimPiece& piece) -> std::optional<Vec3> {
        if (piece.region != region) return std::nullopt;
        std::optional<Vec3> foot = piece.foot(x);
        if (foot && squared_norm(*foot - x) >= reach * reach) foot.reset();
        return foot;
    };
    for (std::size_t k = 0; k < pieces.size(); ++k) {
        const std::optional<Vec3> foot = near(pieces[k]);
        if (!foot) continue;
        const Mirror one = mirror_at(pieces[k], static_cast<std::uint32_t>(k), *foot, x, normal);
        mirrors.push_back(one);
        if (pieces[k].corner_next < 0) continue;
        const auto next = static_cast<std::size_t>(pieces[k].corner_next);
        const std::optional<Vec3> other = near(pieces[next]);
        const Vec3 back = pieces[k].a - pieces[k].b, on = pieces[next].b - pieces[next].a;
        if (!other || dot(back, on) < std::cos(kWidestCorner) * norm(back) * norm(on)) continue;
        const Mirror two = mirror_at(pieces[next], 0, *other, x, normal);
        mirrors.push_back({product(two.map, one.map), two.map * one.shift + two.shift, two.map * one.drift + two.drift,
                           one.sign * two.sign, 1.0, static_cast<std::uint32_t>(pieces.size() + k)});
    }
}

}  // namespace lamella::melp
