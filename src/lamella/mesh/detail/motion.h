#pragma once

#include "lamella/mesh/detail/edit_mesh.h"

#include <array>
#include <cstdint>
#include <vector>

namespace lamella::mesh::detail {

/// Shortens displacements such that nothing can cross.
///
/// Two primitives (vertex and face, or two edges) that share no vertex and are a distance D apart cannot meet when
/// their vertices move by at most 0.45 D each. A pair whose vertices move by no more than 0.9 D together is left
/// alone; of every other pair all vertices are held to 0.45 D. A pair nearer than 1e-7 of the longest step stops where
/// it would come nearer, which keeps what is left of a distance above rounding.
///
/// The pairs of the whole mesh are looked for at the first motion after the triangles changed, with what the motions
/// that follow will probably need. Those that could hold a vertex on that way are kept, and while no vertex leaves it
/// the motions are held by them alone, to the same bits as if all pairs were looked at again: any other pair was so far
/// apart that it is out of danger to the end of the way.
class MotionLimit {
public:
    /// @param longest  no vertex goes farther [m]
    /// @param later    how far vertices will probably go in the motions that follow [m]; empty: no other follows
    /// @returns how many vertices were held back
    std::size_t apply(const EditMesh& mesh,
                      double longest,
                      const IdVector<VertexId, double>& later,
                      IdVector<VertexId, Vec3>& displacement);
    /// The triangles changed, or vertices in another way than by `apply`.
    void forget() {
        reach_.clear();
        pairs_.clear();
    }

    /// Two primitives: the first `first` of the vertices against the others.
    struct Pair {
        std::array<VertexId, 4> vertex;
        std::uint8_t first;
    };

private:
    bool within_reach(const IdVector<VertexId, double>& length) const;

    IdVector<VertexId, double> reach_;  ///< how far each vertex may still go before pairs are looked for again [m]
    std::vector<Pair> pairs_;           ///< that could hold a vertex on the way
};

}  // namespace lamella::mesh::detail
