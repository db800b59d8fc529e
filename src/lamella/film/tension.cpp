#include "lamella/film/tension.h"

namespace lamella::film {

IdVector<mesh::FaceId, double> face_tensions(const mesh::FoamMesh& mesh,
                                             double film_tension,
                                             std::span<const FilmTension> tensions) {
    IdVector<mesh::FaceId, double> tension(mesh.faces.size(), film_tension);
    for (const FilmTension& t : tensions)
        for (const mesh::FaceId f : mesh.faces.ids()) {
            const mesh::Face& face = mesh.faces[f];
            if ((face.back == t.a && face.front == t.b) || (face.back == t.b && face.front == t.a))
                tension[f] = t.factor * film_tension;
        }
    return tension;
}

}  // namespace lamella::film
