#include "lamella/run/checkpoint_file.h"

#include "lamella/core/error.h"
#include "lamella/io/checkpoint.h"

namespace lamella::run {
namespace {

constexpr const char* kSolverGroup = "solver/";

/// Puts every name into a group of another writer.
class GroupWriter : public sim::StateWriter {
public:
    explicit GroupWriter(sim::StateWriter& out) : out_(out) {}
    void write(std::string_view name, std::span<const double> values) override { out_.write(inside(name), values); }
    void write(std::string_view name, std::span<const std::int64_t> values) override {
        out_.write(inside(name), values);
    }
    void write(std::string_view name, std::span<const std::int32_t> values) override {
        out_.write(inside(name), values);
    }
    void write_part(std::string_view name, std::span<const double> values, sim::Part part) override {
        out_.write_part(inside(name), values, part);
    }
    void write_part(std::string_view name, std::span<const std::int64_t> values, sim::Part part) override {
        out_.write_part(inside(name), values, part);
    }
    void write_part(std::string_view name, std::span<const std::int32_t> values, sim::Part part) override {
        out_.write_part(inside(name), values, part);
    }

private:
    static std::string inside(std::string_view name) { return kSolverGroup + std::string(name); }
    sim::StateWriter& out_;
};

class GroupReader : public sim::StateReader {
public:
    explicit GroupReader(sim::StateReader& in) : in_(in) {}
    void read(std::string_view name, std::size_t count, std::vector<double>& values) override {
        in_.read(inside(name), count, values);
    }
    void read(std::string_view name, std::size_t count, std::vector<std::int64_t>& values) override {
        in_.read(inside(name), count, values);
    }
    void read(std::string_view name, std::size_t count, std::vector<std::int32_t>& values) override {
        in_.read(inside(name), count, values);
    }
    void read_stretch(std::string_view name, sim::Part part, std::size_t count, std::vector<double>& v) override {
        in_.read_stretch(inside(name), part, count, v);
    }
    void read_stretch(std::string_view name, sim::Part part, std::size_t count, std::vector<std::int64_t>& v) override {
        in_.read_stretch(inside(name), part, count, v);
    }
    void read_stretch(std::string_view name, sim::Part part, std::size_t count, std::vector<std::int32_t>& v) override {
        in_.read_stretch(inside(name), part, count, v);
    }

private:
    static std::string inside(std::string_view name) { return kSolverGroup + std::string(name); }
    sim::StateReader& in_;
};

std::uint64_t read_size(sim::StateReader& in, std::string_view name) {
    const std::int64_t value = in.read_integer(name);
    if (value < 0) throw InputError("the checkpoint is damaged: " + std::string(name) + " is negative");
    return static_cast<std::uint64_t>(value);
}

}  // namespace

void write_checkpoint(const std::filesystem::path& path,
                      const std::string& solver_name,
                      const sim::Solver& solver,
                      const RunState& state) {
    io::CheckpointWriter file(path, solver_name);
    file.write_value("run/output_time", state.output_time);
    file.write_value("run/output_step", state.output_step);
    file.write_value("run/frames", static_cast<std::int64_t>(state.frame_times.size()));
    file.write("run/frame_times", std::span<const double>(state.frame_times));
    file.write_value("run/series_bytes", static_cast<std::int64_t>(state.series_bytes));
    file.write_value("run/events_bytes", static_cast<std::int64_t>(state.events_bytes));
    GroupWriter inside(file);
    solver.save(inside);
    file.commit();
}

RunState read_checkpoint(const std::filesystem::path& path, const std::string& solver_name, sim::Solver& solver) {
    io::CheckpointReader file(path, solver_name);
    RunState state;
    state.output_time = file.read_double("run/output_time");
    state.output_step = file.read_integer("run/output_step");
    file.read("run/frame_times", read_size(file, "run/frames"), state.frame_times);
    state.series_bytes = read_size(file, "run/series_bytes");
    state.events_bytes = read_size(file, "run/events_bytes");
    GroupReader inside(file);
    solver.load(inside);
    return state;
}

}  // namespace lamella::run
