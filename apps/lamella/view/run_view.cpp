#include "view/run_view.h"

#include "lamella/core/error.h"
#include "lamella/film/problem.h"
#include "lamella/io/csv.h"
#include "lamella/io/frame_files.h"
#include "lamella/run/run_folder.h"
#include "lamella/scene/scene.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "frame_source.h"
#include "view/frame_message.h"
#include "view/run_process.h"
#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

namespace lamella::app::view {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

/// "total_area[m^2]" -> {"total_area", "m^2"}.
Json column_json(const std::string& header) {
    const std::size_t bracket = header.find('[');
    if (bracket == std::string::npos || !header.ends_with(']')) return {{"name", header}, {"unit", "-"}};
    return {{"name", header.substr(0, bracket)}, {"unit", header.substr(bracket + 1, header.size() - bracket - 2)}};
}

Json row_json(const std::vector<double>& row) {
    Json values = Json::array();
    for (const double value : row) values.push_back(std::isfinite(value) ? Json(value) : Json(nullptr));
    return values;
}

bool is_inside(const fs::path& folder, const fs::path& file) {
    const auto [end, unused] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
    return end == folder.end();
}

}  // namespace

RunView::RunView(const fs::path& folder, RunProcess* process) : process_(process) {
    const RunReader reader(folder);  // says in words when it is none
    folder_ = fs::canonical(folder);
    try {
        const scene::Scene scene = scene::load_scene(folder_ / "scene.toml", {}, scene::all_solvers());
        if (scene.films) thickness_ = scene.films->material.thickness;
    } catch (const InputError& error) {  // frames can be shown without it; the page says what is missing
        note_ = fmt::format("the scene cannot be read, so the films' thickness is not known: {}", error.what());
    }
}

std::string RunView::state() const {
    Json state{{"folder", folder_.filename().string()}, {"title", ""},  {"solver", ""},
               {"state", "starting"},                   {"stop_reason", ""}, {"time_unit", "s"}};
    if (fs::exists(folder_ / "run.json")) {
        const Json record = Json::parse(text_of("run.json"), nullptr, false);
        if (record.is_discarded() || !record.is_object())
            throw InputError("run.json is damaged; what can be read of the run is in its frames and series");
        for (const char* key : {"title", "solver", "state", "stop_reason", "time_unit"})
            if (record.contains(key) && record[key].is_string()) state[key] = record[key];
    }
    Json times = Json::array();
    const RunReader reader(folder_);
    for (const io::FrameEntry& entry : reader.frames()) times.push_back(entry.time);
    state["frame_times"] = times;
    state["thickness"] = thickness_ ? Json(*thickness_) : Json(nullptr);
    state["note"] = note_;
    state["controlled"] = process_ != nullptr && process_->state() != RunProcess::State::kEnded;
    state["paused"] = process_ != nullptr && process_->state() == RunProcess::State::kPaused;
    return state.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string RunView::series(std::size_t first) const {
    Json columns = Json::array(), rows = Json::array();
    std::size_t count = 0;
    if (fs::exists(folder_ / "series.csv")) {
        const io::CsvTable table = io::read_csv(folder_ / "series.csv");
        for (const std::string& header : table.header) columns.push_back(column_json(header));
        count = table.rows.size();
        for (std::size_t i = first; i < count; ++i) rows.push_back(row_json(table.rows[i]));
    }
    return Json{{"columns", columns}, {"first", std::min(first, count)}, {"rows", rows}}.dump();
}

std::string RunView::scene() const { return text_of("scene.toml"); }

std::string RunView::provenance() const { return text_of("run.json"); }

std::string RunView::frame(std::size_t index) const { return frame_message(io::read_vtp(frame_file(index))); }

std::string RunView::regions(std::size_t index) const { return regions_text(io::read_vtp(frame_file(index))); }

fs::path RunView::frame_file(std::size_t index) const {
    const RunReader reader(folder_);
    if (index >= reader.frames().size())
        throw InputError(reader.frames().empty() ? "the run has no frames yet"
                                                 : fmt::format("the run has frames 0 to {}, no {}",
                                                               reader.frames().size() - 1, index));
    const fs::path file = fs::weakly_canonical(folder_ / reader.frames()[index].file);
    if (!is_inside(folder_, file)) throw InputError(fmt::format("frame {} lies outside the run folder", index));
    return file;
}

std::string RunView::text_of(const char* name) const {
    const fs::path file = fs::weakly_canonical(folder_ / name);
    if (!is_inside(folder_, file)) throw InputError(fmt::format("{} lies outside the run folder", name));
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw IoError(fmt::format("{} cannot be read", name));
    return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace lamella::app::view
