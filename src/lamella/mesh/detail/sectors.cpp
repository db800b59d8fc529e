#include "lamella/mesh/detail/sectors.h"

#include "lamella/mesh/detail/face_shape.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lamella::mesh::detail {
namespace {

constexpr std::size_t kMostFaces = 100;
constexpr std::size_t kMostSectors = 32;

/// Disjoint sets of small numbers.
class Groups {
public:
    explicit Groups(std::size_t n) {
        for (std::size_t i = 0; i < n; ++i) parent_[i] = static_cast<std::uint8_t>(i);
    }
    std::uint8_t root(std::size_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return static_cast<std::uint8_t>(i);
    }
    /// The smaller root stays: the result does not depend on the order of the calls.
    void unite(std::size_t i, std::size_t j) {
        const std::uint8_t a = root(i);
        const std::uint8_t b = root(j);
        parent_[std::max(a, b)] = std::min(a, b);
    }

private:
    std::array<std::uint8_t, 2 * kMostFaces> parent_;
};

/// A face at v seen from one of its edges v -> w: its place in faces_at(v) and on which side counterclockwise lies.
struct Spoke {
    VertexId w;
    std::uint8_t place;
    bool front_ahead;  // the front side is the one ahead
};

using Spokes = SmallVector<Spoke, 24>;

Spokes spokes_at(const EditMesh& mesh, VertexId v) {
    Spokes spokes;
    const FaceList& faces = mesh.faces_at(v);
    for (std::size_t i = 0; i < faces.size(); ++i) {
        const auto& vertices = mesh.face(faces[i]).vertices;
        const std::size_t k = vertices[0] == v ? 0 : vertices[1] == v ? 1 : 2;
        spokes.push_back({vertices[(k + 1) % 3], static_cast<std::uint8_t>(i), true});
        spokes.push_back({vertices[(k + 2) % 3], static_cast<std::uint8_t>(i), false});
    }
    std::sort(spokes.begin(), spokes.end(),
              [](const Spoke& a, const Spoke& b) { return a.w != b.w ? a.w < b.w : a.place < b.place; });
    return spokes;
}

/// Angle of each face's other vertex about v -> w, and the faces in its order.
template <class Item, class FaceOf>
void sort_by_angle(const EditMesh& mesh, VertexId v, VertexId w, Item* begin, Item* end, FaceOf&& face_of) {
    const Vec3 axis = mesh.at(w) - mesh.at(v);
    const Vec3 unit = (1.0 / norm(axis)) * axis;
    struct Turn {
        double angle;
        Item item;
    };
    SmallVector<Turn, 8> turns;
    Vec3 e1, e2;
    for (Item* it = begin; it != end; ++it) {
        const Face& face = mesh.face(face_of(*it));
        VertexId other = kNoVertex;
        for (const VertexId u : face.vertices)
            if (u != v && u != w) other = u;
        const Vec3 arm = mesh.at(other) - mesh.at(v);
        if (it == begin) {
            e1 = arm - dot(arm, unit) * unit;
            e2 = cross(unit, e1);
            turns.push_back({0.0, *it});
        } else {
            const double angle = std::atan2(dot(arm, e2), dot(arm, e1));
            turns.push_back({angle < 0.0 ? angle + 6.283185307179586 : angle, *it});
        }
    }
    std::stable_sort(turns.begin(), turns.end(), [](const Turn& a, const Turn& b) { return a.angle < b.angle; });
    for (std::size_t i = 0; i < turns.size(); ++i) begin[i] = turns[i].item;
}

}  // namespace

int direction(const Face& face, VertexId v, VertexId w) {
    const auto& u = face.vertices;
    for (std::size_t k = 0; k < 3; ++k)
        if (u[k] == v) return u[(k + 1) % 3] == w ? 1 : -1;
    return 0;
}

// The face's normal is (edge direction) x (direction into the face) when it runs along the edge: turning
// counterclockwise about the edge moves the face towards its front.
RegionId ahead_of(const Face& face, VertexId v, VertexId w) {
    return direction(face, v, w) > 0 ? face.front : face.back;
}
RegionId behind_of(const Face& face, VertexId v, VertexId w) {
    return direction(face, v, w) > 0 ? face.back : face.front;
}

void sort_around(const EditMesh& mesh, VertexId v, VertexId w, SmallVector<FaceId, 8>& faces) {
    if (faces.size() > 2) sort_by_angle(mesh, v, w, faces.begin(), faces.end(), [](FaceId f) { return f; });
}

bool label_cycle_holds(const EditMesh& mesh, VertexId v, VertexId w) {
    if (mesh.on_wire(v) && mesh.on_wire(w)) return true;
    auto faces = mesh.faces_on(v, w);
    sort_around(mesh, v, w, faces);
    for (std::size_t i = 0; i < faces.size(); ++i) {
        const FaceId next = faces[i + 1 < faces.size() ? i + 1 : 0];
        if (ahead_of(mesh.face(faces[i]), v, w) != behind_of(mesh.face(next), v, w)) return false;
    }
    return true;
}

bool Sectors::regular() const {
    if (components != 1) return false;
    const std::uint32_t all = count() == 32 ? 0xffffffffU : (1U << count()) - 1U;
    for (std::size_t s = 0; s < count(); ++s)
        if ((neighbors[s] | (1U << s)) != all) return false;
    return true;
}

std::optional<Sectors> sectors_at(const EditMesh& mesh, VertexId v) {
    const FaceList& faces = mesh.faces_at(v);
    if (faces.size() > kMostFaces) return std::nullopt;
    Groups sides(2 * faces.size());
    Groups components(faces.size());
    Spokes spokes = spokes_at(mesh, v);
    const auto ahead = [](const Spoke& s) { return 2U * s.place + (s.front_ahead ? 1U : 0U); };
    const auto behind = [](const Spoke& s) { return 2U * s.place + (s.front_ahead ? 0U : 1U); };
    for (std::size_t first = 0; first < spokes.size();) {
        std::size_t last = first + 1;
        while (last < spokes.size() && spokes[last].w == spokes[first].w) ++last;
        for (std::size_t i = first + 1; i < last; ++i) components.unite(spokes[first].place, spokes[i].place);
        const bool open = mesh.on_wire(v) && mesh.on_wire(spokes[first].w);
        if (last - first > 2)
            sort_by_angle(mesh, v, spokes[first].w, spokes.begin() + first, spokes.begin() + last,
                          [&](const Spoke& s) { return faces[s.place]; });
        if (!open)
            for (std::size_t i = first; i < last; ++i)
                sides.unite(ahead(spokes[i]), behind(spokes[i + 1 < last ? i + 1 : first]));
        first = last;
    }

    Sectors result;
    SmallVector<std::uint8_t, 8> roots;
    SmallVector<std::uint8_t, 8> component_roots;
    const auto number = [](auto& known, std::uint8_t root) {
        for (std::size_t i = 0; i < known.size(); ++i)
            if (known[i] == root) return static_cast<std::uint8_t>(i);
        known.push_back(root);
        return static_cast<std::uint8_t>(known.size() - 1);
    };
    for (std::size_t i = 0; i < faces.size(); ++i) {
        const Face& face = mesh.face(faces[i]);
        const std::uint8_t back = number(roots, sides.root(2 * i));
        const std::uint8_t front = number(roots, sides.root(2 * i + 1));
        if (roots.size() > kMostSectors) return std::nullopt;
        for (const auto& [sector, label] : {std::pair{back, face.back}, std::pair{front, face.front}}) {
            if (sector == result.labels.size()) {
                result.labels.push_back(label);
                result.neighbors.push_back(0);
            } else if (result.labels[sector] != label) {
                return std::nullopt;
            }
        }
        result.neighbors[back] |= 1U << front;
        result.neighbors[front] |= 1U << back;
        result.faces.push_back({number(component_roots, components.root(i)), back, front});
    }
    result.components = static_cast<std::uint8_t>(component_roots.size());
    return result;
}

bool is_regular(const EditMesh& mesh, VertexId v) {
    const FaceList& faces = mesh.faces_at(v);
    if (faces.size() > kMostFaces) return false;
    const Spokes spokes = spokes_at(mesh, v);
    Groups components(faces.size());
    bool film = true;  // two faces on every edge
    bool crossing = false;
    for (std::size_t first = 0; first < spokes.size();) {
        std::size_t last = first + 1;
        while (last < spokes.size() && spokes[last].w == spokes[first].w) {
            components.unite(spokes[first].place, spokes[last].place);
            ++last;
        }
        film = film && last - first == 2;
        crossing = crossing || last - first > 3;
        first = last;
    }
    if (mesh.on_wire(v)) return !crossing;
    if (film) {
        for (std::size_t i = 1; i < faces.size(); ++i)
            if (components.root(i) != 0) return false;
        return true;
    }
    const auto sectors = sectors_at(mesh, v);
    return sectors && sectors->regular();
}

}  // namespace lamella::mesh::detail
