// The readers of films refuse whatever is wrong with InputError on one line, and what they accept is sound.
// The first byte says which reader: f (Surface Evolver), o (OBJ) or p (PLY).

#include "lamella/core/error.h"
#include "lamella/io/mesh_files.h"
#include "lamella/mesh/check.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::string_view text(reinterpret_cast<const char*>(data), size);
    if (text.empty()) return 0;
    const char* name = text[0] == 'f' ? "fuzz.fe" : text[0] == 'o' ? "fuzz.obj" : "fuzz.ply";
    text.remove_prefix(1);
    lamella::io::FilmFile films;
    try {
        films = lamella::io::parse_films(text, name);
    } catch (const lamella::InputError& problem) {
        if (std::string_view(problem.what()).find('\n') != std::string_view::npos) std::abort();
        return 0;
    }
    if (!lamella::mesh::faults(films.mesh).empty()) std::abort();
    for (const auto& tension : films.tensions)
        if (std::max(lamella::index(tension.a), lamella::index(tension.b)) >= films.mesh.regions.size()) std::abort();
    return 0;
}
