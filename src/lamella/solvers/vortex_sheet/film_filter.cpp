#include "lamella/solvers/vortex_sheet/film_filter.h"

#include "lamella/core/parallel.h"

#include <cmath>
#include <numbers>
#include <utility>

namespace lamella::vortex_sheet {

FilmFilter::FilmFilter(const FilmLaplacian& laplacian, const std::function<double(double)>& response, int degree)
    : laplacian_(laplacian), largest_(laplacian.largest_eigenvalue()) {
    // Interpolation at Chebyshev's points: within a small factor of the best polynomial.
    const int points = degree + 1;
    std::vector<double> value;
    const auto angle = [&](int j) { return std::numbers::pi * (j + 0.5) / points; };
    for (int j = 0; j < points; ++j) value.push_back(response(0.5 * largest_ * (1.0 + std::cos(angle(j)))));
    for (int k = 0; k < points; ++k) {
        double sum = 0.0;
        for (int j = 0; j < points; ++j) sum += value[static_cast<std::size_t>(j)] * std::cos(k * angle(j));
        coefficient_.push_back((k == 0 ? 1.0 : 2.0) / points * sum);
    }
}

// Both: Clenshaw's recurrence, b_k = c_k x + 2 t b_{k+1} - b_{k+2}; the answer is c_0 x + t b_1 - b_2.

void FilmFilter::apply(const Circulation& x, Circulation& y) const {
    Circulation next(x.size(), 0.0), after(x.size(), 0.0), product;
    for (std::size_t k = coefficient_.size(); k-- > 0;) {
        laplacian_.multiply(next, product);
        const double factor = k == 0 ? 1.0 : 2.0;
        parallel_for(x.size(), [&](std::size_t i) {
            const double scale = laplacian_.held(i) || laplacian_.cell()[i] == 0.0
                                     ? 0.0
                                     : 1.0 / (laplacian_.cell()[i] * largest_);  // 2 L / largest = K / (cell * largest)
            after[i] = coefficient_[k] * x[i] + factor * (scale * product[i] - next[i]) - after[i];
        });
        std::swap(next, after);
    }
    y = std::move(next);
}

double FilmFilter::at(double eigenvalue) const {
    const double t = largest_ > 0.0 ? 2.0 * eigenvalue / largest_ - 1.0 : -1.0;
    double next = 0.0, after = 0.0;
    for (std::size_t k = coefficient_.size(); k-- > 0;) {
        after = coefficient_[k] + (k == 0 ? 1.0 : 2.0) * t * next - after;
        std::swap(next, after);
    }
    return next;
}

}  // namespace lamella::vortex_sheet
