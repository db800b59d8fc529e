// Sums, messages and agreement between processes; processes are threads here, and MPI's in app.clusters.

#include "lamella/core/error.h"
#include "lamella/core/random.h"
#include "lamella/dist/agree.h"
#include "lamella/dist/balance.h"
#include "lamella/dist/devices.h"
#include "lamella/dist/gather.h"
#include "lamella/dist/halo.h"
#include "lamella/dist/migration.h"
#include "lamella/dist/sum.h"
#include "lamella/dist/world.h"

#include <gtest/gtest.h>

#include "process_team.h"
#include <cstdlib>
#include <numeric>

namespace lamella::dist {
namespace {

using test::as_processes;

double noise(std::uint64_t i) { return uniform01(random_bits(5, RandomStream::kBubblePosition, 0, i)) - 0.3; }

TEST(Sum, IsTheSameHoweverManyProcessesShareTheTerms) {
    const std::int64_t total = 10'000;
    const double alone = lamella::exact_sum(static_cast<std::size_t>(total), [](std::size_t i) { return noise(i); });
    for (const int size : {1, 2, 3, 8})
        as_processes(size, [&](const std::shared_ptr<Communicator>& processes) {
            const Share share = share_of(total, *processes);
            const double sum =
                dist::exact_sum(*processes, static_cast<std::size_t>(share.count), 1.0,
                                [&](std::size_t i) { return noise(static_cast<std::uint64_t>(share.first) + i); });
            EXPECT_EQ(sum, alone) << size << " processes";
        });
}

TEST(Sum, HoldsATrillionTerms) {
    // 512 blocks of 2^31 terms of 1 - 2^-40: every block has the largest low integer there is. One process cannot add
    // them one by one, so a block is made by doubling.
    const double term = 1.0 - 0x1p-40;
    const double terms = 0x1p40;
    const auto block = [&] {
        FixedSum sum(terms);
        sum.add(term);
        for (int k = 0; k < 31; ++k) sum += FixedSum(sum);
        return sum;
    };
    FixedSum expected(terms);
    for (int b = 0; b < 512; ++b) {
        FixedSum one = block();
        one.carry();
        expected += one;
    }
    EXPECT_NEAR(expected.value() / (terms * term), 1.0, 1e-15);
    as_processes(8, [&](const std::shared_ptr<Communicator>& processes) {
        FixedSum sum[] = {FixedSum(terms)};
        for (int b = 0; b < 64; ++b) {
            FixedSum one = block();
            one.carry();
            sum[0] += one;
        }
        dist::sum(*processes, sum);
        EXPECT_EQ(sum[0].value(), expected.value());
    });
}

TEST(Sum, OfATrillionTermsHasRoomForTheLargest) {
    Alone alone;
    // Two terms stand for 10^12 equal ones: the scale leaves room for all of them.
    const double sum = dist::exact_sum(alone, 2, 1e12, [](std::size_t) { return 3.0; });
    EXPECT_EQ(sum, 6.0);
}

TEST(Sum, GoesTogetherWithMaxima) {
    as_processes(3, [&](const std::shared_ptr<Communicator>& processes) {
        FixedSum sums[] = {FixedSum(10.0), FixedSum(10.0)};
        sums[0].add(processes->rank() + 0.5);
        sums[1].add(-1.0);
        double maxima[] = {1.0 * processes->rank(), -2.0 - processes->rank()};
        reduce(*processes, sums, maxima);
        EXPECT_EQ(sums[0].value(), 4.5);
        EXPECT_EQ(sums[1].value(), -3.0);
        EXPECT_EQ(maxima[0], 2.0);
        EXPECT_EQ(maxima[1], -2.0);
    });
}

TEST(Migration, KeepsWhatStaysInPlaceAndFillsTheGaps) {
    as_processes(2, [&](const std::shared_ptr<Communicator>& processes) {
        // Process 0 gives two, drops two and gets one; process 1 gives one and gets two.
        const bool first = processes->rank() == 0;
        const int gone = Migration::kGone;
        const Migration migration(*processes, first ? std::vector{0, 1, gone, 0, 1, 0, gone} : std::vector{1, 0, 1});
        std::vector<int> items = first ? std::vector{0, 1, 2, 3, 4, 5, 6, -1, -1} : std::vector{10, 11, 12};
        migration(items);
        EXPECT_EQ(items, first ? (std::vector{0, 5, 11, 3}) : (std::vector{10, 1, 12, 4}));
    });
}

TEST(Migration, BringsEveryItemToItsDestinationWithAllItsColumns) {
    constexpr std::int64_t kFar = std::int64_t{1} << 40;  // ids beyond 32 bits
    as_processes(5, [&](const std::shared_ptr<Communicator>& processes) {
        const std::size_t own = processes->rank() == 2 ? 0 : 40 + static_cast<std::size_t>(processes->rank());
        std::vector<std::int64_t> id;
        std::vector<double> x;
        std::vector<std::int32_t> wraps;
        std::vector<int> destination;
        for (std::size_t i = 0; i < own; ++i) {
            id.push_back(kFar + processes->rank() * 1000 + static_cast<std::int64_t>(i));
            x.push_back(noise(static_cast<std::uint64_t>(id.back())));
            wraps.push_back(static_cast<std::int32_t>(id.back() % 7));
            destination.push_back(static_cast<int>(id.back() % 4));  // rank 4 gets none
        }
        const Migration migration(*processes, destination);
        migration(id);
        migration(x);
        migration(wraps);
        EXPECT_EQ(id.size(), migration.count());
        if (processes->rank() == 4) {
            EXPECT_TRUE(id.empty());
        }
        for (std::size_t n = 0; n < id.size(); ++n) {
            EXPECT_EQ(id[n] % 4, processes->rank());
            EXPECT_EQ(x[n], noise(static_cast<std::uint64_t>(id[n])));
            EXPECT_EQ(wraps[n], id[n] % 7);
        }
        EXPECT_EQ(sum(*processes, static_cast<std::int64_t>(id.size())), 40 + 41 + 43 + 44);
    });
}

TEST(Halo, KeepsCopiesUpToDateThroughRenumbering) {
    as_processes(3, [&](const std::shared_ptr<Communicator>& processes) {
        // Every process has items rank * 10 .. rank * 10 + 4 and copies the even ones to the next process.
        const int rank = processes->rank();
        Column value;
        for (int i = 0; i < 5; ++i) value.push_back(rank * 10 + i);
        std::vector<std::vector<std::uint32_t>> wanted(3);
        wanted[static_cast<std::size_t>((rank + 1) % 3)] = {0, 2, 4};
        Halo halo(*processes, wanted);
        EXPECT_EQ(halo.copies(), 3U);
        const auto fetched = halo.fetch(std::span<const double>(value));
        const double from = (rank + 2) % 3 * 10;
        EXPECT_EQ(fetched, (std::vector<double>{from, from + 2, from + 4}));

        std::reverse(value.begin(), value.end());
        halo.renumber(std::vector<std::uint32_t>{4, 3, 2, 1, 0}, 8);
        Column twice(5);
        for (std::size_t i = 0; i < 5; ++i) twice[i] = 2.0 * value[i];
        Column* const columns[] = {&value, &twice};
        halo.begin(columns);
        halo.end();
        EXPECT_EQ(value.size(), 11U);
        EXPECT_EQ(value[9], from + 2);
        EXPECT_EQ(twice[10], 2.0 * (from + 4));
    });
}

TEST(Halo, LeavesWhatIsOnItsWayUntilAllMeet) {
    as_processes(2, [&](const std::shared_ptr<Communicator>& processes) {
        std::vector<std::vector<std::uint32_t>> wanted(2);
        wanted[static_cast<std::size_t>(1 - processes->rank())] = {1, 0};
        Halo halo(*processes, wanted);
        halo.renumber(std::vector<std::uint32_t>{0, 1, 2}, 8);
        Column column(8, 0.0);
        Column* const columns[] = {&column};
        for (int round = 1; round <= 4; ++round) {  // between which nothing else is called: see ProcessTeam
            column[0] = 10.0 * round + processes->rank();
            column[1] = -column[0];
            halo.begin(columns);
            halo.end();
            EXPECT_EQ(column[8], -(10.0 * round + 1 - processes->rank()));
            EXPECT_EQ(column[9], 10.0 * round + 1 - processes->rank());
        }
    });
}

TEST(Balance, GivesEachAsMuchAsItIsFast) {
    using List = std::vector<std::int64_t>;
    EXPECT_EQ(weights_for(List{30'000, 30'000}), (List{1024, 1024}));
    EXPECT_EQ(weights_for(List{30'000, 36'000}), (List{1117, 931}));  // 12/11 and 10/11 of the mean
    EXPECT_EQ(weights_for(List{10'000, 90'000}), (List{1280, 768})) << "memory has to stay even";
    EXPECT_EQ(weights_for(List{10'000, 0}), (List{1024, 1024})) << "who has no items has no speed";
}

TEST(Balance, TakesNewWeightsWhereTheSlowestHoldsUpTheOthers) {
    const auto after = [](std::vector<double> pace, std::vector<std::size_t> items, int looks) {
        std::vector<std::int64_t> weights;
        double shares = 0.0;
        int changes = 0;
        test::ProcessTeam team(static_cast<int>(pace.size()));
        team.set_pace(pace);
        team.run([&](const std::shared_ptr<Communicator>& processes) {
            Balance balance(*processes);
            for (int look = 0; look < looks; ++look) {
                { const Balance::Working working(balance); }
                const bool changed = balance.update(items[static_cast<std::size_t>(processes->rank())]);
                if (changed && processes->rank() == 0) ++changes;
            }
            const std::vector<std::int64_t> all(balance.weights().begin(), balance.weights().end());
            if (!weights.empty()) {
                EXPECT_EQ(all, weights) << "not the same on all processes";
            }
            weights = all;
            shares += balance.share();
        });
        EXPECT_NEAR(shares, 1.0, 1e-15);
        EXPECT_LE(changes, 1);
        return weights;
    };
    using List = std::vector<std::int64_t>;
    EXPECT_EQ(after({5.0, 6.0}, {100, 100}, 9), (List{1117, 931}));
    EXPECT_EQ(after({0.5, 0.6}, {100, 100}, 6), (List{1024, 1024})) << "too early to tell";
    EXPECT_EQ(after({0.5, 0.6}, {100, 100}, 7), (List{1117, 931}));
    EXPECT_EQ(after({5.0, 5.2}, {100, 100}, 9), (List{1024, 1024})) << "not worth it";
    EXPECT_EQ(after({5.0, 6.0}, {100, 120}, 9), (List{1024, 1024})) << "more items, not less speed";
    EXPECT_EQ(after({5.0, 50.0, 5.0}, {100, 100, 100}, 9), (List{1280, 768, 1280}));
    EXPECT_EQ(after({5.0, 5.0}, {100, 0}, 9), (List{1024, 1024}));
    EXPECT_EQ(after({5.0}, {100}, 9), (List{1024}));
}

TEST(Gather, IsUndoneByScatterInPiecesOfAnySize) {
    std::vector<std::int64_t> whole(10);
    std::iota(whole.begin(), whole.end(), 0);
    for (const std::size_t values : {1U, 2U, 3U, 100U})
        as_processes(4, [&](const std::shared_ptr<Communicator>& processes) {
            const Share share = share_of(10, *processes);
            const auto from = whole.begin() + share.first;
            const std::vector<std::int64_t> own(from, from + share.count);
            EXPECT_EQ(gather(*processes, std::span(own)), processes->rank() == 0 ? whole : std::vector<std::int64_t>());
            std::vector<std::int64_t> pieces;
            const std::size_t bytes = values * sizeof(std::int64_t);
            gather_in_pieces(
                *processes, std::span(own),
                [&](std::span<const std::int64_t> piece) {
                    EXPECT_LE(piece.size(), values);
                    pieces.insert(pieces.end(), piece.begin(), piece.end());
                },
                bytes);
            EXPECT_EQ(pieces, processes->rank() == 0 ? whole : std::vector<std::int64_t>());
            const auto fetch = [&](std::int64_t first, std::size_t count) {
                EXPECT_LE(count, values);
                return std::vector(whole.begin() + first, whole.begin() + first + static_cast<std::int64_t>(count));
            };
            EXPECT_EQ(scatter_in_pieces<std::int64_t>(*processes, 10, fetch, bytes), own);
        });
}

TEST(Gather, InPiecesFailsForAllWhereTheFileFails) {
    as_processes(3, [&](const std::shared_ptr<Communicator>& processes) {
        const std::vector<double> own(5, 1.0);
        std::size_t taken = 0;
        const auto take = [&](std::span<const double> piece) {
            taken += piece.size();
            if (taken >= 6) throw IoError("the disk is full");
        };
        EXPECT_THROW(gather_in_pieces(*processes, std::span<const double>(own), take, 2 * sizeof(double)), IoError);
        EXPECT_TRUE(taken == 0 || taken == 7) << "nothing is taken after the failure: pieces of 2, 2, 1, 2";
        std::size_t fetched = 0;
        const auto fetch = [&](std::int64_t, std::size_t count) -> std::vector<double> {
            if (++fetched == 4) throw InputError("damaged");
            return std::vector<double>(count);
        };
        EXPECT_THROW(scatter_in_pieces<double>(*processes, 30, fetch, 2 * sizeof(double)), InputError);
        const auto absent = [](std::int64_t, std::size_t) -> std::vector<double> { throw InputError("shorter"); };
        EXPECT_THROW(scatter_in_pieces<double>(*processes, std::int64_t{1} << 48, absent), InputError);
    });
}

TEST(Together, FailsForAllWhereItFailsForOne) {
    for (const int culprit : {0, 2})
        as_processes(3, [&](const std::shared_ptr<Communicator>& processes) {
            const auto work = [&]() -> int {
                if (processes->rank() == culprit) throw InputError("wrong");
                return 7;
            };
            try {
                together(*processes, work);
                ADD_FAILURE() << "nothing was thrown";
            } catch (const InputError& error) {
                EXPECT_TRUE(std::string(error.what()).starts_with("wrong"));
            }
            EXPECT_EQ(together(*processes, [] { return 7; }), 7);
        });
}

TEST(Devices, AreRefusedWhereProcessesWouldShareOne) {
    as_processes(3, [&](const std::shared_ptr<Communicator>& processes) {
        EXPECT_NO_THROW(require_own_devices(*processes, 100 + processes->rank()));
        std::string message;
        try {
            require_own_devices(*processes, processes->rank() / 2);
        } catch (const InputError& error) {
            message = error.what();
        }
        EXPECT_EQ(message.substr(0, message.find(':')), "3 processes were started and find 2 GPUs");
    });
}

TEST(Devices, AreCountedByTheRanksOfOneMachine) {
    for (const char* name : {"OMPI_COMM_WORLD_LOCAL_RANK", "MPI_LOCALRANKID", "SLURM_LOCALID"}) ::unsetenv(name);
    ::setenv("PMIX_RANK", "7", 1);
    EXPECT_EQ(rank_on_machine(), 7);
    ::setenv("SLURM_LOCALID", "0", 1);
    EXPECT_EQ(rank_on_machine(), 0);
    ::unsetenv("SLURM_LOCALID");
    ::unsetenv("PMIX_RANK");
}

}  // namespace
}  // namespace lamella::dist
