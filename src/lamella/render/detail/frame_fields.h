#pragma once

#include "lamella/render/detail/film_patches.h"
#include "lamella/sim/frame.h"

#include <optional>
#include <string>
#include <vector>

namespace lamella::render::detail {

/// A field of a frame and whose values it holds.
struct NamedField {
    const sim::Field* field;
    enum Place { kVertices, kFaces, kPoints } place;
};

/// The fields of that name that can color something; a name may stand for one of the films and one of the points.
/// @throws InputError  there is none; the message names the nearest one
std::vector<NamedField> find_fields(const sim::Frame& frame, const std::string& name);

/// The scalar field `thickness`, of the films or else of the points.
std::optional<NamedField> thickness_field(const sim::Frame& frame);

/// The regions beside a triangle; the outside twice where a frame says nothing of them.
std::array<std::int32_t, 2> regions_beside(const sim::Surface& surface, std::size_t triangle);

/// The radii of balls as a field.
sim::Field radius_field(const sim::Points& points);

/// The values of a field (lengths of vectors) for the corners of each triangle.
std::vector<std::array<double, 3>> corner_values(const FilmPatches& patches, const NamedField& field);

}  // namespace lamella::render::detail
