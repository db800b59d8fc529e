#include "lamella/core/build_info.h"
#include "lamella/scene/scene.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "command_line.h"
#include "commands.h"
#include "output.h"
#include <string>

namespace lamella::app {
namespace {

void print_version(bool json) {
    const BuildInfo build = build_info();
    std::vector<std::string> solvers;
    const sim::SolverRegistry registry = scene::all_solvers();
    for (const sim::SolverEntry& entry : registry.entries()) solvers.push_back(entry.name);
    if (json) {
        const nlohmann::ordered_json object{
            {"version", build.version},     {"commit", build.commit}, {"compiler", build.compiler},
            {"system", build.system},       {"flags", build.flags},   {"build_type", build.build_type},
            {"libraries", build.libraries}, {"parts", build.parts},   {"solvers", solvers}};
        print_result(object.dump(2) + "\n");
        return;
    }
    print_result(
        fmt::format("lamella {} ({})\n", build.version, build.commit) +
        two_columns({{"solvers", fmt::format("{}", fmt::join(solvers, ", "))},
                     {"parts", build.parts.empty() ? "none of the optional ones"
                                                   : fmt::format("{}", fmt::join(build.parts, ", "))},
                     {"built", fmt::format("{} with {} for {}", build.build_type, build.compiler, build.system)},
                     {"flags", build.flags},
                     {"libraries", fmt::format("{}", fmt::join(build.libraries, ", "))}}));
}

}  // namespace

void add_version_command(CLI::App& app) {
    CLI::App* command = add_command(app, "version", "Show what this program is built from, and what is in it",
                                    "  lamella version\n"
                                    "  lamella version --json\n");
    auto json = std::make_shared<bool>(false);
    command->add_flag("--json", *json, "Print one JSON object");
    command->callback([json] { print_version(*json); });
}

}  // namespace lamella::app
