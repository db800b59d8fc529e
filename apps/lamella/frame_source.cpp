#include "frame_source.h"

#include "lamella/core/error.h"
#include "lamella/run/run_folder.h"

#include <fmt/format.h>

#include <charconv>

namespace lamella::app {

RunReader::RunReader(std::filesystem::path folder) : folder_(std::move(folder)) {
    if (!std::filesystem::is_directory(folder_))
        throw InputError(fmt::format("{} is not a run folder: there is no such folder", folder_.string()));
    if (!run::is_run_folder(folder_))
        throw InputError(fmt::format("{} is not a run folder: it has no scene.toml and run.json", folder_.string()));
    const std::filesystem::path collection = folder_ / "frames.pvd";
    if (std::filesystem::exists(collection)) frames_ = io::read_pvd(collection);
}

sim::Frame RunReader::frame(std::size_t index) const {
    if (frames_.empty()) throw InputError(fmt::format("{} has no frames", folder_.string()));
    if (index >= frames_.size())
        throw InputError(fmt::format("{} has frames 0 to {}, no {}", folder_.string(), frames_.size() - 1, index));
    return io::read_vtp(folder_ / frames_[index].file);
}

std::size_t RunReader::frame_index(const std::string& text) const {
    if (frames_.empty()) throw InputError(fmt::format("{} has no frames", folder_.string()));
    if (text == "last") return frames_.size() - 1;
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
    if (error != std::errc{} || end != text.data() + text.size())
        throw InputError(fmt::format("\"{}\" is no frame; give a number or last", text));
    if (index >= frames_.size())
        throw InputError(fmt::format("{} has frames 0 to {}, no {}", folder_.string(), frames_.size() - 1, index));
    return index;
}

io::CsvTable RunReader::series() const {
    const std::filesystem::path file = folder_ / "series.csv";
    if (!std::filesystem::exists(file)) throw InputError(fmt::format("{} has no series yet", folder_.string()));
    return io::read_csv(file);
}

std::optional<std::vector<double>> find_column(const io::CsvTable& table, const std::string& name) {
    const int column = table.column(name);
    if (column < 0) return std::nullopt;
    std::vector<double> values;
    values.reserve(table.rows.size());
    for (const auto& row : table.rows) values.push_back(row[static_cast<std::size_t>(column)]);
    return values;
}

}  // namespace lamella::app
