#pragma once

#include "lamella/solvers/vortex_sheet/film_laplacian.h"

#include <functional>
#include <vector>

namespace lamella::vortex_sheet {

/// A function f of the films' Laplacian L = K / (2 cell), as a Chebyshev polynomial in L: what a wave of wave number k
/// along the films is to be multiplied with, f(k^2). One product with K per degree. Keeps the sum over regions at each
/// vertex where f(0) = 1, and rims as they are then.
class FilmFilter {
public:
    /// @param laplacian  must outlive the filter
    /// @param response   f, from 0 to laplacian.largest_eigenvalue() [1/m^2]
    FilmFilter(const FilmLaplacian& laplacian, const std::function<double(double)>& response, int degree);

    /// y = f(L) x
    void apply(const Circulation& x, Circulation& y) const;

    /// The polynomial at an eigenvalue of L, for whoever wonders how close it comes.
    double at(double eigenvalue) const;

private:
    const FilmLaplacian& laplacian_;
    double largest_;
    std::vector<double> coefficient_;  ///< of T_k(2 lambda / largest - 1)
};

}  // namespace lamella::vortex_sheet
