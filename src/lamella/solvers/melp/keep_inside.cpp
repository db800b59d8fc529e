#include "lamella/solvers/melp/keep_inside.h"

#include "lamella/core/parallel.h"
#include "lamella/film/solid.h"
#include "lamella/solvers/melp/geometry.h"
#include "lamella/solvers/melp/point_grid.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace lamella::melp {
namespace {

/// A place on a rim, the direction from it into the film, and how far a particle has to go there.
struct Edge {
    Vec3 foot, inward;
    double lack;  // <= 0: it stays
};

/// The point of a wire nearest to x, its ends counted.
Vec3 nearest_of_wire(const RimPiece& piece, const Vec3& x) {
    if (const std::optional<Vec3> foot = piece.foot(x)) return *foot;
    if (piece.kind != RimKind::kLine) return piece.a;
    return squared_norm(x - piece.a) < squared_norm(x - piece.b) ? piece.a : piece.b;
}

class Edges {
public:
    explicit Edges(const RimNeighbors& near)
        : near_(near), film_(near.film.begin(), near.film.end()), grid_(film_, 2.0 * near.spacing) {}

    /// Where `x` would leave the film over a piece; nothing if it is far from it.
    std::optional<Edge> at(const RimPiece& piece, const Vec3& x, const Vec3& normal) const {
        if (piece.kind == RimKind::kPlate) return before(*piece.foot(x), piece.b, x);
        if (piece.kind == RimKind::kBall) return beside_solid(piece, x, normal);
        const Vec3 foot = nearest_of_wire(piece, x);
        const double close = near_.spacing + near_.margin;
        if (squared_norm(x - foot) > close * close) return std::nullopt;
        const Vec3 along = piece.kind == RimKind::kLine ? piece.b - piece.a : cross(piece.b, foot - piece.a);
        Vec3 into;
        const double reach = 2.0 * near_.spacing;
        grid_.for_each_near(foot, reach, [&](std::uint32_t i) {
            const Vec3 d = film_[i] - foot;
            if (near_.film_region[i] == piece.region && squared_norm(d) < reach * reach) into += d;
        });
        into -= (dot(into, along) / squared_norm(along)) * along;
        const double length = norm(into);
        return length > 0.0 ? std::optional<Edge>(before(foot, into / length, x)) : std::nullopt;
    }

private:
    Edge before(const Vec3& foot, const Vec3& inward, const Vec3& x) const {
        return {foot, inward, near_.margin - dot(x - foot, inward)};
    }
    /// Along the film to where it is the margin away from the solid.
    std::optional<Edge> beside_solid(const RimPiece& piece, const Vec3& x, const Vec3& normal) const {
        const Vec3 middle = film::nearest_on_axis(piece.a, piece.b, x), arm = x - middle;
        const double reach = piece.radius + near_.margin, missing = reach * reach - squared_norm(arm);
        if (missing <= 0.0) return std::nullopt;
        const Vec3 along = arm - dot(arm, normal) * normal;
        constexpr double kAhead = 1e-3;  // of the radius: less, and the film lies across the outermost point
        const bool across = norm(along) < kAhead * piece.radius;
        const Vec3 inward = across ? frame_of(normal).e1 : along / norm(along);
        const Vec3 foot = piece.foot(x).value_or(middle);
        // Beside a stick only what leads away from its axis counts.
        Vec3 away = inward;
        const Vec3 from_middle = middle - piece.a;
        if (squared_norm(from_middle) < (1.0 - 1e-9) * squared_norm(piece.b))
            away -= (dot(inward, piece.b) / squared_norm(piece.b)) * piece.b;
        const double square = squared_norm(away), outward = dot(arm, away);
        if (!(square > 0.0)) return std::nullopt;
        return Edge{foot, inward, (std::sqrt(outward * outward + square * missing) - outward) / square};
    }

    const RimNeighbors& near_;
    std::vector<Vec3> film_;  // a copy: the film itself may be what is moved
    PointGrid grid_;
};

}  // namespace

void keep_inside(const RimNeighbors& near,
                 std::span<const std::int32_t> region,
                 std::span<const Vec3> normal,
                 std::span<Vec3> position,
                 std::span<Vec3> velocity) {
    if (near.rims.empty()) return;
    const Edges edges(near);
    parallel_for(position.size(), [&](std::size_t i) {
        for (const RimPiece& piece : near.rims) {
            if (piece.region != region[i]) continue;
            const std::optional<Edge> edge = edges.at(piece, position[i], normal[i]);
            if (!edge || edge->lack <= 0.0) continue;
            position[i] += edge->lack * edge->inward;
            const double out = dot(velocity[i] - piece.velocity_at(edge->foot), edge->inward);
            if (out < 0.0) velocity[i] -= out * edge->inward;
        }
    });
}

}  // namespace lamella::melp
