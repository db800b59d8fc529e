// The processes of MPI; its C interface, without the C++ one that some of its headers still carry.

#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1

#include "lamella/core/error.h"
#include "lamella/dist/detail/launcher.h"
#include "lamella/dist/world.h"

#include <fmt/format.h>
#include <mpi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace lamella::dist {
namespace {

constexpr int kTag = 1;
constexpr std::size_t kMostBytes = std::size_t{1} << 30;  // of one message: MPI counts in int

/// A few sums and maxima that go in one message.
constexpr std::size_t kMostTogether = 12;
struct Together {
    std::array<std::int64_t, kMostTogether> sums;
    std::array<double, kMostTogether> maxima;
};

void combine(void* from, void* into, int* count, MPI_Datatype*) {
    const auto* const a = static_cast<const Together*>(from);
    auto* const b = static_cast<Together*>(into);
    for (int n = 0; n < *count; ++n)
        for (std::size_t k = 0; k < kMostTogether; ++k) {
            b[n].sums[k] += a[n].sums[k];
            b[n].maxima[k] = std::max(b[n].maxima[k], a[n].maxima[k]);
        }
}

template <class T>
void all_reduce(std::span<T> values, MPI_Datatype type, MPI_Op operation) {
    MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), type, operation, MPI_COMM_WORLD);
}

/// Adds the time for which it lives.
class Stopwatch {
public:
    explicit Stopwatch(double& total) : total_(total), begin_(MPI_Wtime()) {}
    ~Stopwatch() { total_ += MPI_Wtime() - begin_; }
    Stopwatch(const Stopwatch&) = delete;
    Stopwatch& operator=(const Stopwatch&) = delete;

private:
    double& total_;
    double begin_;
};

class Mpi final : public Communicator {
public:
    Mpi() {
        int provided = 0;
        MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
        MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
        MPI_Comm_size(MPI_COMM_WORLD, &size_);
        MPI_Type_contiguous(static_cast<int>(sizeof(Together)), MPI_BYTE, &together_);
        MPI_Type_commit(&together_);
        constexpr int kCommutes = 1;
        MPI_Op_create(combine, kCommutes, &combine_);
    }
    ~Mpi() override {
        end_sends();
        MPI_Op_free(&combine_);
        MPI_Type_free(&together_);
        MPI_Finalize();
    }
    Mpi(const Mpi&) = delete;
    Mpi& operator=(const Mpi&) = delete;

    int rank() const override { return rank_; }
    int size() const override { return size_; }

    void reduce(std::span<std::int64_t> sums, std::span<double> maxima) override {
        const Stopwatch stopwatch(seconds_);
        end_sends();
        // MPI does not say what the largest of NaN and a number is; it could differ between processes.
        for (double& value : maxima)
            if (std::isnan(value)) value = std::numeric_limits<double>::infinity();
        if (maxima.empty() || sums.empty() || sums.size() > kMostTogether || maxima.size() > kMostTogether) {
            for_each_chunk(sums, [](std::span<std::int64_t> chunk) { all_reduce(chunk, MPI_INT64_T, MPI_SUM); });
            for_each_chunk(maxima, [](std::span<double> chunk) { all_reduce(chunk, MPI_DOUBLE, MPI_MAX); });
            return;
        }
        Together both{};
        std::copy(sums.begin(), sums.end(), both.sums.begin());
        std::copy(maxima.begin(), maxima.end(), both.maxima.begin());
        all_reduce(std::span(&both, 1), together_, combine_);
        std::copy_n(both.sums.begin(), sums.size(), sums.begin());
        std::copy_n(both.maxima.begin(), maxima.size(), maxima.begin());
    }

    void broadcast(std::span<std::byte> bytes) override {
        end_sends();
        for_each_chunk(bytes, [](std::span<std::byte> chunk) {
            MPI_Bcast(chunk.data(), static_cast<int>(chunk.size()), MPI_BYTE, 0, MPI_COMM_WORLD);
        });
    }

    std::vector<std::int64_t> exchange(std::span<const std::int64_t> to_each) override {
        const Stopwatch stopwatch(seconds_);
        end_sends();
        std::vector<std::int64_t> from(to_each.size());
        MPI_Alltoall(to_each.data(), 1, MPI_INT64_T, from.data(), 1, MPI_INT64_T, MPI_COMM_WORLD);
        return from;
    }

    void begin(std::span<const Outgoing> outgoing, std::span<const Incoming> incoming) override {
        const Stopwatch stopwatch(seconds_);
        end_sends();
        for (const Incoming& message : incoming)
            for_each_chunk(message.bytes, [&](std::span<std::byte> chunk) {
                MPI_Irecv(chunk.data(), static_cast<int>(chunk.size()), MPI_BYTE, message.from, kTag, MPI_COMM_WORLD,
                          &receives_.emplace_back());
            });
        for (const Outgoing& message : outgoing)
            for_each_chunk(message.bytes, [&](std::span<const std::byte> chunk) {
                MPI_Isend(chunk.data(), static_cast<int>(chunk.size()), MPI_BYTE, message.to, kTag, MPI_COMM_WORLD,
                          &sends_.emplace_back());
            });
    }

    void end() override {
        const Stopwatch stopwatch(seconds_);
        wait(receives_);
        end_sends();
    }

    void receive() override {
        const Stopwatch stopwatch(seconds_);
        wait(receives_);
    }

    double seconds() const override { return seconds_; }

    void abort(int exit_code) override { MPI_Abort(MPI_COMM_WORLD, exit_code); }

private:
    static void wait(std::vector<MPI_Request>& requests) {
        MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
        requests.clear();
    }
    /// A long message has left only once the other process has come to receive it.
    void end_sends() { wait(sends_); }

    template <class T, class Work>
    static void for_each_chunk(std::span<T> all, Work&& work) {
        constexpr std::size_t kMost = kMostBytes / sizeof(T);
        for (std::size_t at = 0; at < all.size(); at += kMost) work(all.subspan(at, std::min(kMost, all.size() - at)));
    }

    int rank_ = 0;
    int size_ = 1;
    double seconds_ = 0.0;
    MPI_Datatype together_ = MPI_DATATYPE_NULL;
    MPI_Op combine_ = MPI_OP_NULL;
    std::vector<MPI_Request> receives_, sends_;
};

}  // namespace

std::shared_ptr<Communicator> join_world() {
    const detail::Launch launch = detail::launch();
    std::shared_ptr<Communicator> processes = std::make_shared<Alone>();
    if (launch.launched) processes = std::make_shared<Mpi>();  // without a launcher MPI would only cost time
    if (launch.processes > 1 && !processes->several())
        throw InputError(
            fmt::format("{} processes were started that MPI does not know of each other: under Slurm use "
                        "srun --mpi=pmix, else the mpirun of the MPI that lamella was built with",
                        launch.processes));
    return processes;
}

}  // namespace lamella::dist
