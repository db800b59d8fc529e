#include "lamella/solvers/melp/contacts.h"

#include "lamella/solvers/melp/loops.h"

#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>

namespace lamella::melp {
namespace {

bool before(const Contact& p, const Contact& q) { return std::pair(p.a, p.b) < std::pair(q.a, q.b); }

}  // namespace

const Contact* Contacts::find(std::int32_t a, std::int32_t b) const {
    const Contact wanted{std::min(a, b), std::max(a, b), 0.0};
    const auto at = std::lower_bound(pairs_.begin(), pairs_.end(), wanted, before);
    return at != pairs_.end() && at->a == wanted.a && at->b == wanted.b ? &*at : nullptr;
}

void Contacts::update(std::span<const RegionPair> touching, double time) {
    if (at_once()) return;
    std::vector<Contact> now;
    for (const auto& [a, b] : touching) {
        const Contact* known = find(a, b);
        now.push_back({a, b, known == nullptr ? time : known->since});
    }
    pairs_ = std::move(now);
}

void Contacts::start_joined(std::span<const RegionPair> pairs) {
    for (const auto& pair : pairs) pairs_.push_back({pair[0], pair[1], -std::numeric_limits<double>::infinity()});
}

void Contacts::rename(std::int32_t from, std::int32_t into) {
    for (Contact& pair : pairs_) {
        if (pair.a == from) pair.a = into;
        if (pair.b == from) pair.b = into;
        if (pair.a > pair.b) std::swap(pair.a, pair.b);
    }
    std::erase_if(pairs_, [](const Contact& pair) { return pair.a == pair.b; });
    // Of two that are the same now the older stays.
    std::sort(pairs_.begin(), pairs_.end(), [](const Contact& p, const Contact& q) {
        return std::tuple(p.a, p.b, p.since) < std::tuple(q.a, q.b, q.since);
    });
    pairs_.erase(std::unique(pairs_.begin(), pairs_.end(),
                             [](const Contact& p, const Contact& q) { return p.a == q.a && p.b == q.b; }),
                 pairs_.end());
}

double Contacts::share(double since, double time) const {
    if (since == -std::numeric_limits<double>::infinity()) return 1.0;
    if (!joining_.ever) return 0.0;
    constexpr double kRamp = 0.2;  // delays
    return std::clamp((time - since - joining_.delay) / (kRamp * joining_.delay), 0.0, 1.0);
}

std::vector<double> Contacts::joined(const Neighbors& other, std::span<const std::int32_t> region, double time) const {
    std::vector<double> result;
    if (at_once()) return result;
    result.resize(other.index.size());
    for_each_particle(other.size(), [&](std::size_t i) {
        std::int32_t last = -1;
        double joined = 0.0;
        for (std::size_t k = other.begin(i); k < other.end(i); ++k) {
            if (const std::int32_t there = region[other.index[k]]; there != last) {
                const Contact* pair = find(region[i], there);
                joined = pair == nullptr ? 0.0 : share(pair->since, time);
                last = there;
            }
            result[k] = joined;
        }
    });
    return result;
}

}  // namespace lamella::melp
