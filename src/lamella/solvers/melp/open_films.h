#pragma once

#include "lamella/film/problem.h"
#include "lamella/solvers/melp/options.h"
#include "lamella/solvers/melp/rims.h"

#include <array>
#include <cstdint>
#include <vector>

namespace lamella::melp {

/// Points on a surface, with its normals.
struct Sample {
    std::vector<Vec3> position, normal;
};

/// A film of the scene that ends on wires: all triangles between one pair of open regions.
class OpenFilm {
public:
    std::int32_t back = 0;       ///< the region that the normals point away from; its number in frames
    double area = 0.0;           ///< [m^2]
    double volume = 0.0;         ///< between it and the plane of its rim [m^3]; 0 for films with several rims
    std::vector<RimPiece> rims;  ///< regions not set, corner_next within this list
    std::vector<std::array<std::int32_t, 2>> wires;  ///< what moves the points of each piece

    /// Points spread over it, about `count` of them: along spirals on disks and half spheres, in staggered rows on
    /// rectangles, otherwise on the triangles of the mesh.
    Sample sample(std::size_t count) const;
    bool half_sphere() const { return shape_ == Shape::kHalfSphere; }

private:
    friend std::vector<OpenFilm> open_films(const film::Problem& films);
    enum class Shape { kMesh, kDisk, kHalfSphere, kRectangle };
    void recognize();

    Shape shape_ = Shape::kMesh;
    std::vector<std::array<Vec3, 3>> triangle_;
};

/// The films on wires of a scene.
/// @throws InputError  naming what this solver does not know: films that meet along borders, films that end in the air,
/// rims with corners that point into the film
std::vector<OpenFilm> open_films(const film::Problem& films);

/// Points on triangles, as many on each as its area asks for, along a sequence that fills each evenly.
Sample on_triangles(const std::vector<std::array<Vec3, 3>>& triangles, std::size_t count);

}  // namespace lamella::melp
