#include "lamella/solvers/melp/keep_inside.h"

#include "lamella/core/parallel.h"
#include "lamella/solvers/melp/point_grid.h"

#include <algorithm>
#include <optional>

namespace lamella::melp {
namespace {

/// A place on a rim and the direction from it into the film.
struct Edge {
    Vec3 foot, inward;
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
    std::optional<Edge> at(const RimPiece& piece, const Vec3& x) const {
        if (piece.kind == RimKind::kPlate) return Edge{*piece.foot(x), piece.b};
        if (piece.kind == RimKind::kBall) {
            const std::optional<Vec3> foot = piece.foot(x);
            return foot ? std::optional<Edge>({*foot, (*foot - piece.a) / piece.radius}) : std::nullopt;
        }
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
        return length > 0.0 ? std::optional<Edge>({foot, into / length}) : std::nullopt;
    }

private:
    const RimNeighbors& near_;
    std::vector<Vec3> film_;  // a copy: the film itself may be what is moved
    PointGrid grid_;
};

}  // namespace

void keep_inside(const RimNeighbors& near,
                 std::span<const std::int32_t> region,
                 std::span<Vec3> position,
                 std::span<Vec3> velocity) {
    if (near.rims.empty()) return;
    const Edges edges(near);
    parallel_for(position.size(), [&](std::size_t i) {
        for (const RimPiece& piece : near.rims) {
            if (piece.region != region[i]) continue;
            const std::optional<Edge> edge = edges.at(piece, position[i]);
            if (!edge) continue;
            const double depth = dot(position[i] - edge->foot, edge->inward);
            if (depth >= near.margin) continue;
            position[i] += (near.margin - depth) * edge->inward;
            const double out = dot(velocity[i] - piece.velocity_at(edge->foot), edge->inward);
            if (out < 0.0) velocity[i] -= out * edge->inward;
        }
    });
}

}  // namespace lamella::melp
