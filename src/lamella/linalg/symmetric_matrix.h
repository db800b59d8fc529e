#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace lamella::linalg {

/// A sparse symmetric matrix: its lower triangle by columns, rows ascending. Every diagonal entry is stored, and is the
/// first of its column.
struct SymmetricMatrix {
    std::vector<int> column_start;  ///< size + 1
    std::vector<int> row;
    std::vector<double> value;

    std::size_t size() const { return column_start.empty() ? 0 : column_start.size() - 1; }
    double& diagonal(std::size_t i) { return value[static_cast<std::size_t>(column_start[i])]; }
    /// Where entry (i, j) = (j, i) is stored. It must be one of the pattern.
    std::size_t slot(int i, int j) const;
};

/// Groups of unknowns, e.g. those of each element: group g is member[start[g]] ... member[start[g + 1] - 1].
struct Groups {
    std::vector<std::size_t> start{0};
    std::vector<int> member;

    std::size_t size() const { return start.size() - 1; }
    std::span<const int> of(std::size_t g) const {
        return std::span(member).subspan(start[g], start[g + 1] - start[g]);
    }
    void close_group() { start.push_back(member.size()); }
};

/// The matrix of zeros in which any two unknowns of a group are coupled. Members are below `size`.
SymmetricMatrix coupled(std::size_t size, const Groups& groups);

/// result = matrix * x; both have size() entries.
void multiply(const SymmetricMatrix& matrix, std::span<const double> x, std::span<double> result);

}  // namespace lamella::linalg
