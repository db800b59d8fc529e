#pragma once

#include "lamella/solvers/melp/neighbors.h"

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace lamella::melp {

/// Two regions whose films are within reach of each other, and since when.
struct Contact {
    std::int32_t a = 0, b = 0;  ///< regions of particles, a < b
    double since = 0.0;         ///< [s]
};

/// When bubbles that touch join.
struct Joining {
    bool ever = true;
    double delay = 0.0;  ///< from the first contact [s]
};

/// Bubbles that fly into each other do not join at once: the air between their films has to drain. How far each pair of
/// regions has come, for cohesion: nothing until the delay is over, all of it a fifth of the delay later. Pairs that
/// come apart start anew.
class Contacts {
public:
    Contacts() = default;
    explicit Contacts(const Joining& joining) : joining_(joining) {}

    /// Whether pairs join at once: there is nothing to keep then.
    bool at_once() const { return joining_.ever && joining_.delay == 0.0; }
    /// Those that are in contact now. @param time  now [s]
    void update(std::span<const RegionPair> touching, double time);
    /// Pairs of regions that have joined from the start. @param pairs  ascending, a < b
    void start_joined(std::span<const RegionPair> pairs);

    /// Region `from` is a part of `into` now.
    void rename(std::int32_t from, std::int32_t into);

    /// 0: apart, to 1: joined. @returns per entry of `other`; empty where all have joined
    std::vector<double> joined(const Neighbors& other, std::span<const std::int32_t> region, double time) const;

    const std::vector<Contact>& pairs() const { return pairs_; }
    void set_pairs(std::vector<Contact> pairs) { pairs_ = std::move(pairs); }

private:
    double share(double since, double time) const;
    const Contact* find(std::int32_t a, std::int32_t b) const;

    Joining joining_;
    std::vector<Contact> pairs_;  // ascending
};

}  // namespace lamella::melp
