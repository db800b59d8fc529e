// The importer refuses whatever is wrong with InputError on one line, and what it accepts becomes a scene that the
// scene reader accepts.

#include "lamella/core/error.h"
#include "lamella/scene/import.h"
#include "lamella/scene/scene.h"

#include "../unit/scene/toy_solver.h"
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::string scene;
    try {
        scene = lamella::scene::import_foam_json_text({reinterpret_cast<const char*>(data), size}, "fuzz.json");
    } catch (const lamella::InputError& problem) {
        if (std::string_view(problem.what()).find('\n') != std::string_view::npos) std::abort();
        return 0;
    }
    // Outside of the try block: an imported scene that is refused is a crash.
    lamella::scene::parse_scene(scene, "fuzz.toml", {}, lamella::toy::registry());
    return 0;
}
