#include "lamella/mesh/staged_move.h"

#include <algorithm>
#include <cmath>

namespace lamella::mesh {

std::size_t staged_move(Tracker& tracker, const IdVector<VertexId, Vec3>& displacement, int most_moves) {
    double longest = 0.0;
    for (const Vec3& d : displacement) longest = std::max(longest, norm(d));
    const double reach = 0.9 * tracker.options().longest_step * tracker.options().edge_length;
    const double moves = std::clamp(std::ceil(longest / reach), 1.0, static_cast<double>(most_moves));
    const double share = std::min(1.0 / moves, longest > 0.0 ? reach / longest : 1.0);
    IdVector<VertexId, Vec3> part = displacement;
    for (Vec3& d : part) d *= share;
    IdVector<VertexId, double> later(part.size());
    if (moves > 1.0)
        for (const VertexId v : part.ids()) later[v] = (moves - 1.0) * norm(part[v]);
    std::size_t limited = 0;
    for (int k = 0; k < static_cast<int>(moves); ++k) limited = std::max(limited, tracker.move(part, later).limited);
    return limited;
}

}  // namespace lamella::mesh
