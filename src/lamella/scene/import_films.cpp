#include "lamella/core/error.h"
#include "lamella/io/mesh_files.h"
#include "lamella/scene/detail/film_from_file.h"
#include "lamella/scene/detail/lenient_json.h"
#include "lamella/scene/import.h"
#include "lamella/sim/node.h"

#include <fmt/format.h>

#include <algorithm>

namespace lamella::scene {

std::string import_films(const std::filesystem::path& path, const std::filesystem::path& folder) {
    const io::FilmFile films = io::read_films(path);
    const auto& mesh = films.mesh;
    const auto bubbles = std::count_if(mesh.regions.begin(), mesh.regions.end(), [](const mesh::Region& r) {
        return r.kind == mesh::RegionKind::kClosed;
    });
    const auto held = std::count(mesh.on_wire.begin(), mesh.on_wire.end(), std::uint8_t{1});
    const std::filesystem::path absolute = std::filesystem::absolute(path).lexically_normal();
    const auto seen_from = [&] { return absolute.lexically_proximate(std::filesystem::absolute(folder).lexically_normal()); };
    const std::string file = (folder.empty() ? absolute : seen_from()).string();
    const std::string title = path.filename().string();
    if (!detail::is_utf8(file)) throw InputError({path.parent_path().string(), 0, 0}, "the file's name is not UTF-8, so no scene can hold it");
    std::string text = fmt::format(
        "# Imported from {}: {} bubbles, {} triangles, {} of {} vertices held by wires{}.\n"
        "# The file counts from this scene's folder and is read when the scene is run; the run keeps a copy.\n\n",
        sim::quoted_text(title), bubbles, mesh.faces.size(), held, mesh.position.size(),
        mesh.periodic() ? ", in a periodic cell" : "");
    text += fmt::format("title = {}\nsolver = \"equilibrium\"\n\n", sim::quoted_text("Imported from " + title));
    text += fmt::format("[resolution]\nedge_length = {}\n\n", sim::exact_text(detail::edge_length_for(mesh)));
    text += fmt::format("[[film]]\nshape = \"mesh\"\nfile = {}\nscale = 1.0\n", sim::quoted_text(file));
    return text;
}

}  // namespace lamella::scene
