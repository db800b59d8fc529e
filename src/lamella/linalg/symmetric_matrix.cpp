#include "lamella/linalg/symmetric_matrix.h"

#include "lamella/core/error.h"

#include <algorithm>

namespace lamella::linalg {

std::size_t SymmetricMatrix::slot(int i, int j) const {
    const auto column = static_cast<std::size_t>(std::min(i, j));
    const auto begin = row.begin() + column_start[column];
    const auto end = row.begin() + column_start[column + 1];
    const auto at = std::lower_bound(begin, end, std::max(i, j));
    LAMELLA_ASSERT(at != end && *at == std::max(i, j));
    return static_cast<std::size_t>(at - row.begin());
}

SymmetricMatrix coupled(std::size_t size, const Groups& groups) {
    // Rows of each column, with repetitions, by counting; then sorted and made unique column by column.
    std::vector<std::size_t> start(size + 1, 0);
    const auto each_pair = [&](auto&& use) {
        for (std::size_t g = 0; g < groups.size(); ++g)
            for (const int i : groups.of(g))
                for (const int j : groups.of(g))
                    if (i > j) use(static_cast<std::size_t>(j), i);
        for (std::size_t k = 0; k < size; ++k) use(k, static_cast<int>(k));
    };
    each_pair([&](std::size_t column, int) { ++start[column + 1]; });
    for (std::size_t k = 0; k < size; ++k) start[k + 1] += start[k];
    std::vector<int> rows(start[size]);
    std::vector<std::size_t> next(start.begin(), start.end() - 1);
    each_pair([&](std::size_t column, int row) { rows[next[column]++] = row; });

    SymmetricMatrix matrix;
    matrix.column_start.reserve(size + 1);
    matrix.column_start.push_back(0);
    for (std::size_t k = 0; k < size; ++k) {
        const auto begin = rows.begin() + static_cast<std::ptrdiff_t>(start[k]);
        const auto end = rows.begin() + static_cast<std::ptrdiff_t>(start[k + 1]);
        std::sort(begin, end);
        matrix.row.insert(matrix.row.end(), begin, std::unique(begin, end));
        matrix.column_start.push_back(static_cast<int>(matrix.row.size()));
    }
    matrix.value.assign(matrix.row.size(), 0.0);
    return matrix;
}

void multiply(const SymmetricMatrix& matrix, std::span<const double> x, std::span<double> result) {
    std::fill(result.begin(), result.end(), 0.0);
    for (std::size_t j = 0; j < matrix.size(); ++j) {
        for (auto s = static_cast<std::size_t>(matrix.column_start[j]);
             s < static_cast<std::size_t>(matrix.column_start[j + 1]); ++s) {
            const auto i = static_cast<std::size_t>(matrix.row[s]);
            result[i] += matrix.value[s] * x[j];
            if (i != j) result[j] += matrix.value[s] * x[i];
        }
    }
}

}  // namespace lamella::linalg
