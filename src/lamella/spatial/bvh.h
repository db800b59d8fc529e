#pragma once

#include "lamella/core/vec.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace lamella::spatial {

/// An axis-aligned box.
struct Bounds {
    Vec3 low, high;

    bool meets(const Bounds& b) const {
        for (std::size_t k = 0; k < 3; ++k)
            if (low[k] > b.high[k] || b.low[k] > high[k]) return false;
        return true;
    }
    void enclose(const Bounds& b) {
        for (std::size_t k = 0; k < 3; ++k) {
            low[k] = low[k] < b.low[k] ? low[k] : b.low[k];
            high[k] = high[k] > b.high[k] ? high[k] : b.high[k];
        }
    }
};

/// A binary tree of boxes, halved at the median of the longest side; the same boxes give the same tree.
class BoxTree {
public:
    explicit BoxTree(std::vector<Bounds> boxes);

    /// Calls found(i) for every box that meets `query`, until it returns false. @returns false when it did
    bool query(const Bounds& query, const std::function<bool(std::size_t)>& found) const;

private:
    struct Node {
        Bounds bounds;
        std::uint32_t begin, end;  // of order_
        std::uint32_t right;       // the left child follows its parent; 0: a leaf
    };
    std::uint32_t build(std::uint32_t begin, std::uint32_t end);

    std::vector<Bounds> boxes_;
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;
};

}  // namespace lamella::spatial
