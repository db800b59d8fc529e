#include "lamella/run/provenance.h"

#include "lamella/core/build_info.h"
#include "lamella/core/error.h"
#include "lamella/core/parallel.h"
#include "lamella/io/atomic_file.h"

#include <fmt/chrono.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <ctime>

namespace lamella::run {
namespace {

using nlohmann::ordered_json;

double wall_seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double cpu_seconds() {
    timespec now{};
    ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::string now_text() {
    return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}",
                       fmt::gmtime(std::chrono::system_clock::to_time_t(std::chrono::system_clock::now())));
}

std::string host_name() {
    std::array<char, 256> name{};
    return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unknown";
}

ordered_json stage_seconds(const StageTimes& times, double StageTimes::Seconds::*kind) {
    ordered_json seconds;
    for (std::size_t k = 0; k < kStageNames.size(); ++k)
        seconds[kStageNames[k]] = times.of(static_cast<Stage>(k)).*kind;
    return seconds;
}

/// Adds the numbers of one object to those of another, key by key.
void add_numbers(ordered_json& sum, const ordered_json& part) {
    for (const auto& [key, value] : part.items()) sum[key] = sum.value(key, 0.0) + value.get<double>();
}

std::vector<double> in_megabytes(std::vector<double> bytes) {
    for (double& value : bytes) value = std::round(value * 1e-5) * 0.1;
    return bytes;
}

}  // namespace

StageTimes::Stopwatch::Stopwatch(Seconds& total) : total_(total), begin_{wall_seconds(), cpu_seconds()} {}

StageTimes::Stopwatch::~Stopwatch() {
    total_.wall += wall_seconds() - begin_.wall;
    total_.cpu += cpu_seconds() - begin_.cpu;
}

struct Provenance::Impl {
    std::filesystem::path path;
    std::string title;
    std::string solver;
    std::uint64_t seed = 0;
    std::string device;
    int processes = 1;
    std::string started;
    ordered_json earlier_sessions;  ///< as an array
    std::vector<std::string> notes;

    ordered_json session(const RunRecord& record) const {
        const BuildInfo build = build_info();
        return {{"version", build.version},
                {"commit", build.commit},
                {"build",
                 {{"compiler", build.compiler},
                  {"system", build.system},
                  {"type", build.build_type},
                  {"flags", build.flags},
                  {"libraries", build.libraries}}},
                {"host", host_name()},
                {"processes", processes},
                {"threads", thread_count()},
                {"device", device},
                {"start", started},
                {"end", now_text()},
                {"steps", record.steps_taken},
                {"evaluations", record.evaluations},
                {"wall_seconds", stage_seconds(record.times, &StageTimes::Seconds::wall)},
                {"cpu_seconds", stage_seconds(record.times, &StageTimes::Seconds::cpu)},
                {"peak_memory_mb", in_megabytes(record.peak_memory)},
                {"exchange_seconds", record.exchange_seconds}};
    }

    void take_over_sessions();
};

void Provenance::Impl::take_over_sessions() {
    earlier_sessions = ordered_json::array();
    std::error_code error;
    if (!std::filesystem::exists(path, error)) return;
    try {
        const ordered_json old = ordered_json::parse(io::read_file(path));
        for (const auto& entry : old.at("sessions")) {
            ordered_json checked = ordered_json::object();  // the sums below must not trip over a damaged file
            add_numbers(checked, entry.at("wall_seconds"));
            add_numbers(checked, entry.at("cpu_seconds"));
            static_cast<void>(entry.at("steps").get<std::int64_t>());
            static_cast<void>(entry.at("start").get<std::string>());
            earlier_sessions.push_back(entry);
        }
    } catch (const std::exception&) {
        earlier_sessions = ordered_json::array();
        notes.push_back("run.json could not be understood; its record of earlier sessions is lost");
    }
}

Provenance::Provenance(std::filesystem::path path, const scene::Scene& scene, std::string device, int processes)
    : impl_(new Impl{.path = std::move(path),
                     .title = scene.title,
                     .solver = scene.solver,
                     .seed = scene.seed,
                     .device = std::move(device),
                     .processes = processes,
                     .started = now_text(),
                     .earlier_sessions = {},
                     .notes = scene.notes}) {
    impl_->take_over_sessions();
}

Provenance::~Provenance() = default;

const std::vector<std::string>& Provenance::notes() const { return impl_->notes; }

void Provenance::write(const RunRecord& record) {
    ordered_json sessions = impl_->earlier_sessions;
    sessions.push_back(impl_->session(record));
    const ordered_json& last = sessions.back();

    std::int64_t steps = 0;
    ordered_json wall = ordered_json::object();
    ordered_json cpu = ordered_json::object();
    for (const auto& session : sessions) {
        steps += session.at("steps").get<std::int64_t>();
        add_numbers(wall, session.at("wall_seconds"));
        add_numbers(cpu, session.at("cpu_seconds"));
    }

    ordered_json file{{"program", "lamella"}};
    for (const char* key : {"version", "commit", "build", "host", "processes", "threads", "device"})
        file[key] = last.at(key);
    file["title"] = impl_->title;
    file["solver"] = impl_->solver;
    file["seed"] = impl_->seed;
    file["state"] = record.state;
    file["stop_reason"] = record.stop_reason;
    file["start"] = sessions.front().at("start");
    file["end"] = last.at("end");
    file["time"] = record.time;
    file["time_unit"] = record.time_unit;
    file["step"] = record.step;
    file["frames"] = record.frames;
    file["steps"] = steps;
    file["wall_seconds"] = wall;
    file["cpu_seconds"] = cpu;
    file["notes"] = record.notes;
    file["sessions"] = sessions;
    // Text from a scene may hold bytes that are no UTF-8; they are replaced, not a reason to fail.
    io::write_file_atomically(impl_->path, file.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n");
}

std::string recorded_state(const std::filesystem::path& run_json) {
    std::error_code absent;
    if (!std::filesystem::is_regular_file(run_json, absent)) return "";
    const auto json = ordered_json::parse(io::read_file(run_json), nullptr, false);
    return json.is_object() && json.contains("state") && json["state"].is_string() ? json["state"].get<std::string>()
                                                                                   : "";
}

}  // namespace lamella::run
