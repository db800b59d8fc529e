#include "lamella/film/bursting.h"

#include "lamella/core/error.h"
#include "lamella/core/random.h"
#include "lamella/mesh/area.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace lamella::film {

using mesh::RegionId;

std::optional<RegionId> largest_neighbor(const mesh::FoamMesh& mesh, RegionId region) {
    std::optional<RegionId> neighbor;
    double most = 0.0;
    for (const mesh::FilmArea& film : mesh::film_areas(mesh)) {
        if ((film.a != region && film.b != region) || film.area <= most) continue;
        most = film.area;
        neighbor = film.a == region ? film.b : film.a;
    }
    return neighbor;
}

bool share_film(const mesh::FoamMesh& mesh, RegionId a, RegionId b) {
    return std::any_of(mesh.faces.begin(), mesh.faces.end(), [&](const mesh::Face& face) {
        return (face.back == a && face.front == b) || (face.back == b && face.front == a);
    });
}

std::optional<RegionId> random_outer_bubble(const mesh::FoamMesh& mesh, std::uint64_t seed, std::uint64_t draw) {
    std::vector<RegionId> outer;
    for (const mesh::FilmArea& film : mesh::film_areas(mesh))
        if (film.a == mesh::kOutside && mesh.regions[film.b].kind == mesh::RegionKind::kClosed) outer.push_back(film.b);
    if (outer.empty()) return std::nullopt;
    const double u = uniform01(random_bits(seed, RandomStream::kFilmRupture, 0, draw));
    return outer[std::min(outer.size() - 1, static_cast<std::size_t>(u * static_cast<double>(outer.size())))];
}

void refuse_what_melp_alone_knows(const Problem& films, const char* solver) {
    if (!films.walls.empty()) throw InputError(std::string(solver) + ": [[wall]] is for solver melp");
    if (!films.releases.empty()) throw InputError(std::string(solver) + ": [[faucet]] is for solver melp");
    for (const Event& event : films.events)
        for (const auto& [kind, name] :
             {std::pair{Event::Kind::kPuncture, "puncture"}, std::pair{Event::Kind::kSpot, "spot"}})
            if (event.kind == kind)
                throw InputError(fmt::format("{}: [[event]] with kind = \"{}\" is for solver melp", solver, name));
}

}  // namespace lamella::film
