// The scene reader refuses whatever is wrong with InputError on one line, and what it accepts it writes back so that it
// reads the same again. The first line of the input, when it holds "--set ", is an override.

#include "lamella/core/error.h"
#include "lamella/scene/scene.h"

#include "../unit/scene/toy_solver.h"
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::string_view text(reinterpret_cast<const char*>(data), size);
    std::vector<std::string> overrides;
    if (constexpr std::string_view kSet = "--set "; text.starts_with(kSet)) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        overrides.emplace_back(text.substr(kSet.size(), end - kSet.size()));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    const lamella::sim::SolverRegistry registry = lamella::toy::registry();
    std::string resolved;
    try {
        resolved = resolved_toml(lamella::scene::parse_scene(text, "fuzz.toml", overrides, registry), registry);
    } catch (const lamella::InputError& problem) {
        if (std::string_view(problem.what()).find('\n') != std::string_view::npos) std::abort();
        return 0;
    }
    // Outside of the try block: a resolved scene that is refused is a crash.
    const auto again = lamella::scene::parse_scene(resolved, "fuzz.toml", {}, registry);
    if (resolved_toml(again, registry) != resolved) std::abort();
    return 0;
}
