#include "lamella/solvers/equilibrium/crossing_memory.h"

#include "lamella/core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace lamella::equilibrium {
namespace {

constexpr int kMostPartings = 4;  // a true T1 happens once, or a few times while the films swing
constexpr int kNumbers = 6;       // of one crossing in a checkpoint

}  // namespace

bool CrossingMemory::note_parting(const mesh::TopologyEvent& parting, double edge_length) {
    const auto [low, high] = std::minmax(parting.a, parting.b);
    const double near = 2.0 * edge_length;
    auto known = std::find_if(seen_.begin(), seen_.end(), [&, a = low, b = high](const Seen& seen) {
        return seen.crossing.a == a && seen.crossing.b == b &&
               squared_norm(seen.crossing.position - parting.position) < near * near;
    });
    if (known == seen_.end()) known = seen_.insert(seen_.end(), Seen{{low, high, {}}, 0});
    known->crossing.position = parting.position;
    return ++known->times >= kMostPartings;
}

std::vector<mesh::Crossing> CrossingMemory::held() const {
    std::vector<mesh::Crossing> crossings;
    for (const Seen& seen : seen_)
        if (seen.times >= kMostPartings) crossings.push_back(seen.crossing);
    return crossings;
}

void CrossingMemory::save(sim::StateWriter& out) const {
    std::vector<double> numbers;
    for (const Seen& seen : seen_) {
        const Vec3& x = seen.crossing.position;
        numbers.insert(numbers.end(), {static_cast<double>(index(seen.crossing.a)),
                                       static_cast<double>(index(seen.crossing.b)), x[0], x[1], x[2],
                                       static_cast<double>(seen.times)});
    }
    out.write_value("crossings/count", static_cast<std::int64_t>(seen_.size()));
    out.write("crossings/seen", std::span<const double>(numbers));
}

CrossingMemory::CrossingMemory(sim::StateReader& in) {
    const std::int64_t count = in.read_integer("crossings/count");
    constexpr std::int64_t kMost = 1'000'000;
    if (count < 0 || count > kMost) throw InputError(fmt::format("crossings/count = {} is outside [0, {}]", count, kMost));
    std::vector<double> numbers;
    in.read("crossings/seen", static_cast<std::size_t>(count) * kNumbers, numbers);
    const auto region = [](double number) {
        if (!(number >= 0.0 && number < std::numeric_limits<std::uint32_t>::max()))
            throw InputError(fmt::format("crossings/seen: {} is no region", number));
        return static_cast<mesh::RegionId>(static_cast<std::uint32_t>(number));
    };
    for (const double* n = numbers.data(); n != numbers.data() + numbers.size(); n += kNumbers)
        seen_.push_back({{region(n[0]), region(n[1]), {n[2], n[3], n[4]}},
                         static_cast<int>(std::clamp(n[5], 0.0, static_cast<double>(kMostPartings)))});
}

}  // namespace lamella::equilibrium
