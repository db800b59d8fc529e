#include "lamella/run/detail/team.h"

#include "lamella/core/cuda.h"
#include "lamella/core/error.h"
#include "lamella/dist/agree.h"
#include "lamella/dist/gather.h"
#include "lamella/io/frame_files.h"
#include "lamella/measure/measure.h"

#include <sys/resource.h>

#include <optional>
#include <utility>

namespace lamella::run {
namespace {

using dist::Communicator;
using Processes = std::shared_ptr<Communicator>;

enum class Task : std::int64_t {
    kLeave,
    kCreate,
    kStart,
    kAdvance,
    kFrame,
    kMeasuredFrame,
    kMeasure,
    kWriteFrame,
    kScalars,
    kMarkFrame,
    kSave,
    kLoad,
    kReport
};

/// What process 0 tells the others to do.
struct Order {
    Task task = Task::kLeave;
    double time_limit = 0.0;
};

Order give(Communicator& processes, Order order) {
    processes.broadcast(std::as_writable_bytes(std::span(&order, 1)));
    return order;
}

/// Does what all processes do at once. The errors of core/error.h come from decisions that all make alike, so that all
/// have them; any other error is this process's own, and the rest would wait for it for ever.
template <class Work>
auto in_step(Communicator& processes, const LastWords& last_words, Work&& work) {
    constexpr int kFailed = 3;
    constexpr int kDeviceFailed = 4;
    try {
        return work();
    } catch (const CudaError& error) {
        last_words(error.what());
        processes.abort(kDeviceFailed);
        throw;
    } catch (const InputError&) {
        throw;
    } catch (const IoError&) {
        throw;
    } catch (const NumericalError&) {
        throw;
    } catch (const Interrupted&) {
        throw;
    } catch (...) {
        processes.abort(kFailed);
        throw;
    }
}

/// Brings what the processes save to process 0, columns piece by piece. There `out` is the file, elsewhere it is empty.
class JoiningWriter final : public sim::StateWriter {
public:
    JoiningWriter(Communicator& processes, sim::StateWriter* out) : processes_(processes), out_(out) {}
    void write(std::string_view name, std::span<const double> v) override { put(name, v); }
    void write(std::string_view name, std::span<const std::int64_t> v) override { put(name, v); }
    void write(std::string_view name, std::span<const std::int32_t> v) override { put(name, v); }
    void write_part(std::string_view name, std::span<const double> v, sim::Part p) override { join(name, v, p); }
    void write_part(std::string_view name, std::span<const std::int64_t> v, sim::Part p) override { join(name, v, p); }
    void write_part(std::string_view name, std::span<const std::int32_t> v, sim::Part p) override { join(name, v, p); }

private:
    template <class T>
    void put(std::string_view name, std::span<const T> values) {
        dist::together(processes_, [&] {
            if (out_ != nullptr) out_->write(name, values);
        });
    }
    template <class T>
    void join(std::string_view name, std::span<const T> values, sim::Part part) {
        if (part.total == 0) return put(name, values);
        std::int64_t at = 0;
        dist::gather_in_pieces(processes_, values, [&](std::span<const T> piece) {
            out_->write_part(name, piece, {at, part.total});
            at += static_cast<std::int64_t>(piece.size());
        });
    }

    Communicator& processes_;
    sim::StateWriter* out_;
};

/// Shares out what process 0 reads, columns piece by piece. There `in` is the file, elsewhere it is empty.
class SharingReader final : public sim::StateReader {
public:
    SharingReader(Communicator& processes, sim::StateReader* in) : processes_(processes), in_(in) {}
    void read(std::string_view name, std::size_t n, std::vector<double>& v) override { copy(name, n, v); }
    void read(std::string_view name, std::size_t n, std::vector<std::int64_t>& v) override { copy(name, n, v); }
    void read(std::string_view name, std::size_t n, std::vector<std::int32_t>& v) override { copy(name, n, v); }
    void read_part(std::string_view name, std::size_t n, std::vector<double>& v) override { share(name, n, v); }
    void read_part(std::string_view name, std::size_t n, std::vector<std::int64_t>& v) override { share(name, n, v); }
    void read_part(std::string_view name, std::size_t n, std::vector<std::int32_t>& v) override { share(name, n, v); }

private:
    template <class T>
    void copy(std::string_view name, std::size_t count, std::vector<T>& values) {
        dist::together(processes_, [&] {
            if (in_ != nullptr) in_->read(name, count, values);
        });
        values.resize(count);
        processes_.broadcast(std::as_writable_bytes(std::span(values)));
    }
    template <class T>
    void share(std::string_view name, std::size_t count, std::vector<T>& values) {
        const auto total = static_cast<std::int64_t>(count);
        values = dist::scatter_in_pieces<T>(processes_, total, [&](std::int64_t first, std::size_t wanted) {
            std::vector<T> piece;
            in_->read_stretch(name, {first, total}, wanted, piece);
            return piece;
        });
    }

    Communicator& processes_;
    sim::StateReader* in_;
};

/// Writes the frame whose shares the processes have, those of lower ranks first, as one file. The values travel column
/// by column and piece by piece; `path` counts on process 0 only.
void write_shares(Communicator& processes, const sim::Frame& share, const std::filesystem::path& path) {
    const sim::Points& points = share.points;
    std::int64_t counts[] = {static_cast<std::int64_t>(points.size()), static_cast<std::int64_t>(points.radius.size())};
    processes.sum(counts);
    std::optional<io::VtpStream> file;
    dist::together(processes, [&] {
        if (processes.rank() == 0) file.emplace(path, share, static_cast<std::size_t>(counts[0]), counts[1] > 0);
    });
    const auto column = [&](std::span<const double> values) {
        dist::gather_in_pieces(processes, values, [&](std::span<const double> piece) { file->append(piece); });
    };
    column(points.radius);
    for (const sim::Field& field : points.fields) column(field.values);
    static_assert(sizeof(Vec3) == 3 * sizeof(double));
    column({reinterpret_cast<const double*>(points.position.data()), 3 * points.size()});
    dist::together(processes, [&] {
        if (file) file->commit();
    });
}

ProcessReport own_report(const Communicator* processes) {
    struct rusage usage {};
    ::getrusage(RUSAGE_SELF, &usage);
    constexpr double kUnit = 1024.0;  // of Linux's ru_maxrss [bytes]
    return {kUnit * static_cast<double>(usage.ru_maxrss), processes != nullptr ? processes->seconds() : 0.0};
}

std::vector<ProcessReport> gathered_reports(Communicator& processes) {
    const ProcessReport own = own_report(&processes);
    return dist::gather(processes, std::span(&own, 1));
}

/// Process 0 does its part of what it orders.
template <class Work>
auto as_all(Communicator& processes, const LastWords& last_words, Order order, Work&& work) {
    give(processes, order);
    return in_step(processes, last_words, work);
}

/// Process 0's solver, which has all the others do the same. Its frame is process 0's share.
class TeamSolver final : public sim::Solver {
public:
    TeamSolver(Processes processes, LastWords last_words, std::unique_ptr<sim::Solver> own)
        : processes_(std::move(processes)), last_words_(std::move(last_words)), own_(std::move(own)) {}

    void start(const sim::StartContext& context) override {
        all({Task::kStart}, [&] { own_->start(context); });
    }
    sim::StepReport advance(double time_limit) override {
        return all({Task::kAdvance, time_limit}, [&] { return own_->advance(time_limit); });
    }
    double time() const override { return own_->time(); }
    std::string time_unit() const override { return own_->time_unit(); }
    std::int64_t step() const override { return own_->step(); }
    std::optional<std::string> stop_reason() const override { return own_->stop_reason(); }
    std::optional<double> progress() const override { return own_->progress(); }
    double slow_motion() const override { return own_->slow_motion(); }
    sim::Frame frame() const override {
        return all({Task::kFrame}, [&] { return own_->frame(); });
    }
    sim::Frame measured_frame() const override {
        return all({Task::kMeasuredFrame}, [&] { return own_->measured_frame(); });
    }
    void mark_frame() override {
        all({Task::kMarkFrame}, [&] { own_->mark_frame(); });
    }
    std::vector<sim::Scalar> scalars() const override {
        return all({Task::kScalars}, [&] { return own_->scalars(); });
    }
    std::vector<sim::Event> take_events() override { return own_->take_events(); }
    std::vector<sim::Scalar> characteristic_numbers() const override { return own_->characteristic_numbers(); }
    void save(sim::StateWriter& out) const override {
        all({Task::kSave}, [&] {
            JoiningWriter writer(*processes_, &out);
            own_->save(writer);
        });
    }
    void load(sim::StateReader& in) override {
        all({Task::kLoad}, [&] {
            SharingReader reader(*processes_, &in);
            own_->load(reader);
        });
    }

private:
    template <class Work>
    auto all(Order order, Work&& work) const -> decltype(work()) {
        return as_all(*processes_, last_words_, order, work);
    }

    Processes processes_;
    LastWords last_words_;
    std::unique_ptr<sim::Solver> own_;
};

/// What another process than 0 has.
struct Follower {
    std::unique_ptr<sim::Solver> solver;
    sim::Frame share;  ///< of the frame that is being shown; else empty
};

void obey(Communicator& processes, const Order& order, Follower& follower) {
    sim::Solver& solver = *follower.solver;
    if (order.task != Task::kMeasure && order.task != Task::kWriteFrame) follower.share = {};
    switch (order.task) {
        case Task::kStart:
            solver.start({});
            break;
        case Task::kAdvance:
            solver.advance(order.time_limit);
            solver.take_events();  // process 0 has them
            break;
        case Task::kFrame:
            follower.share = solver.frame();
            break;
        case Task::kMeasuredFrame:
            follower.share = solver.measured_frame();
            break;
        case Task::kMeasure:
            measure::measure_frame(follower.share, processes);
            break;
        case Task::kWriteFrame:
            write_shares(processes, follower.share, {});
            break;
        case Task::kScalars:
            solver.scalars();
            break;
        case Task::kMarkFrame:
            solver.mark_frame();
            break;
        case Task::kSave: {
            JoiningWriter writer(processes, nullptr);
            solver.save(writer);
            break;
        }
        case Task::kLoad: {
            SharingReader reader(processes, nullptr);
            solver.load(reader);
            break;
        }
        case Task::kReport:
            gathered_reports(processes);
            break;
        case Task::kLeave:
        case Task::kCreate:
            break;
    }
}

}  // namespace

Team::Team(Processes processes, LastWords last_words)
    : processes_(std::move(processes)), last_words_(std::move(last_words)) {
    if (processes_ && !processes_->several()) processes_.reset();
}

Team::~Team() {
    if (processes_) give(*processes_, {Task::kLeave});
}

std::unique_ptr<sim::Solver> Team::create(const MakeSolver& make) {
    if (!processes_) return make(nullptr);
    give(*processes_, {Task::kCreate});
    return std::make_unique<TeamSolver>(processes_, last_words_,
                                        dist::together(*processes_, [&] { return make(processes_); }));
}

std::vector<sim::Scalar> Team::measure(const sim::Frame& share) const {
    if (!processes_) return measure::measure_frame(share);
    return as_all(*processes_, last_words_, {Task::kMeasure},
                  [&] { return measure::measure_frame(share, *processes_); });
}

void Team::write_frame(const std::filesystem::path& path, const sim::Frame& share) const {
    if (!processes_) return io::write_vtp(path, share);
    as_all(*processes_, last_words_, {Task::kWriteFrame}, [&] { write_shares(*processes_, share, path); });
}

std::vector<ProcessReport> Team::report() const {
    if (!processes_) return {own_report(nullptr)};
    give(*processes_, {Task::kReport});
    return gathered_reports(*processes_);
}

void follow(const Processes& processes, const LastWords& last_words, const MakeSolver& make) {
    Follower follower;
    while (true) {
        const Order order = give(*processes, {});
        if (order.task == Task::kLeave) return;
        try {
            if (order.task == Task::kCreate) {
                follower = {};
                follower.solver = dist::together(*processes, [&] { return make(processes); });
            } else {
                in_step(*processes, last_words, [&] { obey(*processes, order, follower); });
            }
        } catch (const std::exception&) {
            // Process 0 has the same error and decides what follows from it: a checkpoint, or the end.
        }
    }
}

}  // namespace lamella::run
