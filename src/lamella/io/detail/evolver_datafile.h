#pragma once

#include "lamella/core/vec.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lamella::io::detail {

/// The contents of a Surface Evolver datafile as it says them. References between elements are places in the lists;
/// `number` is the element's own.
struct EvolverDatafile {
    struct Vertex {
        std::int64_t number;
        Vec3 at;
        bool held;  ///< fixed, or on a boundary curve
    };
    struct Edge {
        std::int64_t number;
        std::size_t tail;
        std::size_t head;
        std::array<int, 3> wrap;  ///< periods from tail to head
        bool held;
        std::vector<Vec3> inner;  ///< places between the ends, where it runs along a boundary curve that turns
    };
    struct EdgeUse {
        std::size_t edge;
        bool forward;
    };
    struct Face {
        std::int64_t number;
        int line;
        std::vector<EdgeUse> loop;
        bool held;
        double tension;
        std::optional<std::int64_t> back, front;  ///< attributes region_back and region_front of lamella's own files
    };
    struct FaceUse {
        std::size_t face;
        bool outward;  ///< the face's normal points out of the body
    };
    struct Body {
        std::int64_t number;
        int line;
        std::vector<FaceUse> faces;
        std::optional<double> volume;
    };

    bool torus = false;
    std::array<Vec3, 3> period{{{{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}}};
    std::vector<Vertex> vertices;
    std::vector<Edge> edges;
    std::vector<Face> faces;
    std::vector<Body> bodies;
};

/// The largest number of a body or region in a file: memory is taken for all of them.
inline constexpr std::int64_t kMostRegions = 1'000'000;

/// @throws InputError  name:line, the element, what was found; every keyword and attribute that says something about the
///                     films and is not understood is refused by its name
EvolverDatafile parse_evolver_datafile(std::string_view text, const std::string& name);

}  // namespace lamella::io::detail
