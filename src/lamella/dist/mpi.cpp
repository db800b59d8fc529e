// The processes of MPI; its C interface, without the C++ one that some of its headers still carry.

#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1

#include "lamella/core/error.h"
#include "lamella/dist/detail/launcher.h"
#include "lamella/dist/world.h"

#include <fmt/format.h>
#include <mpi.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lamella::dist {
namespace {

constexpr int kTag = 1;
constexpr std::size_t kMostBytes = std::size_t{1} << 30;  // of one message: MPI counts in int

class Mpi final : public Communicator {
public:
    Mpi() {
        int provided = 0;
        MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
        MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
        MPI_Comm_size(MPI_COMM_WORLD, &size_);
    }
    ~Mpi() override { MPI_Finalize(); }
    Mpi(const Mpi&) = delete;
    Mpi& operator=(const Mpi&) = delete;

    int rank() const override { return rank_; }
    int size() const override { return size_; }

    void sum(std::span<std::int64_t> values) override {
        for_each_chunk(values, [](std::span<std::int64_t> chunk) {
            MPI_Allreduce(MPI_IN_PLACE, chunk.data(), static_cast<int>(chunk.size()), MPI_INT64_T, MPI_SUM,
                          MPI_COMM_WORLD);
        });
    }

    void largest(std::span<double> values) override {
        // MPI does not say what the largest of NaN and a number is; it could differ between processes.
        for (double& value : values)
            if (std::isnan(value)) value = std::numeric_limits<double>::infinity();
        for_each_chunk(values, [](std::span<double> chunk) {
            MPI_Allreduce(MPI_IN_PLACE, chunk.data(), static_cast<int>(chunk.size()), MPI_DOUBLE, MPI_MAX,
                          MPI_COMM_WORLD);
        });
    }

    void broadcast(std::span<std::byte> bytes) override {
        for_each_chunk(bytes, [](std::span<std::byte> chunk) {
            MPI_Bcast(chunk.data(), static_cast<int>(chunk.size()), MPI_BYTE, 0, MPI_COMM_WORLD);
        });
    }

    std::vector<std::int64_t> exchange(std::span<const std::int64_t> to_each) override {
        std::vector<std::int64_t> from(to_each.size());
        MPI_Alltoall(to_each.data(), 1, MPI_INT64_T, from.data(), 1, MPI_INT64_T, MPI_COMM_WORLD);
        return from;
    }

    void begin(std::span<const Outgoing> outgoing, std::span<const Incoming> incoming) override {
        for (const Incoming& message : incoming)
            for_each_chunk(message.bytes, [&](std::span<std::byte> chunk) {
                MPI_Irecv(chunk.data(), static_cast<int>(chunk.size()), MPI_BYTE, message.from, kTag, MPI_COMM_WORLD,
                          &requests_.emplace_back());
            });
        for (const Outgoing& message : outgoing)
            for_each_chunk(message.bytes, [&](std::span<const std::byte> chunk) {
                MPI_Isend(chunk.data(), static_cast<int>(chunk.size()), MPI_BYTE, message.to, kTag, MPI_COMM_WORLD,
                          &requests_.emplace_back());
            });
    }

    void end() override {
        MPI_Waitall(static_cast<int>(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE);
        requests_.clear();
    }

    void abort(int exit_code) override { MPI_Abort(MPI_COMM_WORLD, exit_code); }

private:
    template <class T, class Work>
    static void for_each_chunk(std::span<T> all, Work&& work) {
        constexpr std::size_t kMost = kMostBytes / sizeof(T);
        for (std::size_t at = 0; at < all.size(); at += kMost) work(all.subspan(at, std::min(kMost, all.size() - at)));
    }

    int rank_ = 0;
    int size_ = 1;
    std::vector<MPI_Request> requests_;
};

}  // namespace

std::shared_ptr<Communicator> join_world() {
    const detail::Launch launch = detail::launch();
    std::shared_ptr<Communicator> processes = std::make_shared<Alone>();
    if (launch.launched) processes = std::make_shared<Mpi>();  // without a launcher MPI would only cost time
    if (launch.processes > 1 && !processes->several())
        throw InputError(fmt::format("{} processes were started that MPI does not know of each other: under Slurm use "
                                     "srun --mpi=pmix, else the mpirun of the MPI that lamella was built with",
                                     launch.processes));
    return processes;
}

}  // namespace lamella::dist
