#pragma once

#include <span>

#include "lamella/core/id_vector.h"
#include "lamella/film/problem.h"

namespace lamella::film {

/// Tension of the film at each face [N/m]: the material's, times the factor of its pair of regions.
IdVector<mesh::FaceId, double> face_tensions(const mesh::FoamMesh& mesh,
                                             double film_tension,
                                             std::span<const FilmTension> tensions);

}  // namespace lamella::film
