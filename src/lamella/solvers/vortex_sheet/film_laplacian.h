#pragma once

#include "lamella/solvers/vortex_sheet/sheet.h"

#include <functional>
#include <vector>

namespace lamella::vortex_sheet {

/// The Laplacian of jumps along the films [method sheet 14.2]: a stiffness matrix over entries, compressed rows, with
///   phi K phi / 2 = 1/2 sum_f sum_edges 1/2 cot(angle opposite) (Gamma_f(p) - Gamma_f(q))^2
/// It sees differences of regions only, so it keeps the sum over regions at each vertex, and closed loops around triple
/// lines, exactly. Cotangents are not taken below zero: diffusion stays dissipative and monotone on any mesh.
class FilmLaplacian {
public:
    FilmLaplacian(const mesh::FoamMesh& mesh, const SheetTopology& topology);
    /// The rows of the wanted vertices alone; those of all others are empty.
    FilmLaplacian(const mesh::FoamMesh& mesh,
                  const SheetTopology& topology,
                  const std::function<bool(mesh::VertexId)>& wanted);

    /// y = K x
    void multiply(const std::vector<double>& x, std::vector<double>& y) const;
    const std::vector<double>& diagonal() const { return diagonal_; }
    /// Film area per region at the vertex of an entry, the mean cell of [Fei19] [m^2].
    const std::vector<double>& cell() const { return cell_; }
    /// Whether an entry lies on a rim, where circulations stay.
    bool held(std::size_t entry) const { return held_[entry] != 0; }
    /// An upper bound of the eigenvalues of K / (2 cell), which are wave numbers squared [1/m^2].
    double largest_eigenvalue() const;

private:
    std::vector<std::size_t> start_;
    std::vector<std::uint32_t> column_;
    std::vector<double> value_;
    std::vector<double> diagonal_;
    std::vector<double> cell_;
    std::vector<std::uint8_t> held_;  // rims: their circulation stays

    friend void diffuse(const FilmLaplacian&, double, double, Circulation&);
    friend void filter_grid_noise(const FilmLaplacian&, double, Circulation&);
    friend void even_out(const FilmLaplacian&, const std::vector<std::uint32_t>&, int, Circulation&);
};

/// Physical surface viscosity: d Gamma / dt = viscosity * Laplacian of Gamma along the films, over `dt`, implicitly.
/// @param viscosity  [m^2/s]
void diffuse(const FilmLaplacian& laplacian, double viscosity, double dt, Circulation& phi);

/// Takes the shortest waves out: the mode that changes sign from vertex to vertex loses the share `strength`, one
/// of wave number k about strength * (k h / pi)^4.
void filter_grid_noise(const FilmLaplacian& laplacian, double strength, Circulation& phi);

/// Evens the jumps out at the given entries, ascending, by sweeps of a damped relaxation; all other entries stay. Never
/// raises phi K phi.
void even_out(const FilmLaplacian& laplacian, const std::vector<std::uint32_t>& entries, int sweeps, Circulation& phi);

}  // namespace lamella::vortex_sheet
