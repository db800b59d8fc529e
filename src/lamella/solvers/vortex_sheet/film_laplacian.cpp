#include "lamella/solvers/vortex_sheet/film_laplacian.h"

#include "lamella/core/parallel.h"
#include "lamella/linalg/conjugate_gradient.h"

#include <algorithm>
#include <cmath>

namespace lamella::vortex_sheet {
namespace {

using mesh::Corner;
using mesh::FaceId;
using mesh::FoamMesh;
using mesh::VertexId;

/// Half the cotangent of the angle at corner k, not below zero.
double half_cotangent(const FoamMesh& mesh, FaceId f, std::size_t k) {
    const auto& v = mesh.faces[f].vertices;
    const Vec3 a = mesh.position[v[(k + 1) % 3]] - mesh.position[v[k]];
    const Vec3 b = mesh.position[v[(k + 2) % 3]] - mesh.position[v[k]];
    const double area = norm(cross(a, b));
    return area > 0.0 ? std::max(0.0, 0.5 * dot(a, b) / area) : 0.0;
}

/// The rows of the regions of one vertex, filled anew for each.
class VertexRows {
public:
    struct Term {
        std::uint32_t column;
        double value;
    };

    void clear(std::size_t rows) {
        if (rows_.size() < rows) rows_.resize(rows);
        for (auto& row : rows_) row.clear();
    }
    void add(std::size_t row, std::uint32_t column, double value) {
        for (Term& term : rows_[row])
            if (term.column == column) {
                term.value += value;
                return;
            }
        rows_[row].push_back({column, value});
    }
    /// Row `row`, its columns ascending.
    const std::vector<Term>& sorted(std::size_t row) {
        std::sort(rows_[row].begin(), rows_[row].end(),
                  [](const Term& a, const Term& b) { return a.column < b.column; });
        return rows_[row];
    }

private:
    std::vector<std::vector<Term>> rows_;
};

/// What a face adds to the rows of its corner; those of the vertex begin with entry `first`.
void add_corner(
    const FoamMesh& mesh, const SheetTopology& topology, const Corner& corner, std::size_t first, VertexRows& rows) {
    const auto& entry = topology.entry[corner.face];
    for (const std::size_t step : {1U, 2U}) {
        const std::size_t other = (corner.k + step) % 3;
        const double c = half_cotangent(mesh, corner.face, (corner.k + 3 - step) % 3);
        for (const std::size_t side : {0U, 1U})
            for (const std::size_t across : {0U, 1U}) {
                const double sign = side == across ? 1.0 : -1.0;
                const std::size_t row = entry[corner.k][side] - first;
                rows.add(row, entry[corner.k][across], sign * c);
                rows.add(row, entry[other][across], -sign * c);
            }
    }
}

/// Film area at a vertex, a third of each triangle [m^2].
double area_at(const FoamMesh& mesh, const SheetTopology& topology, VertexId v) {
    double area = 0.0;
    for (const Corner& corner : topology.corners.of(v)) {
        const auto& u = mesh.faces[corner.face].vertices;
        area += norm(cross(mesh.position[u[1]] - mesh.position[u[0]], mesh.position[u[2]] - mesh.position[u[0]])) / 6.0;
    }
    return area;
}

}  // namespace

FilmLaplacian::FilmLaplacian(const FoamMesh& mesh, const SheetTopology& topology)
    : FilmLaplacian(mesh, topology, [](VertexId) { return true; }) {}

FilmLaplacian::FilmLaplacian(const FoamMesh& mesh,
                             const SheetTopology& topology,
                             const std::function<bool(VertexId)>& wanted)
    : start_(topology.size() + 1, 0),
      diagonal_(topology.size(), 0.0),
      cell_(topology.size(), 0.0),
      held_(topology.size(), 0) {
    constexpr std::size_t kBlock = 512;
    struct Part {
        std::vector<std::uint32_t> column;
        std::vector<double> value;
    };
    const std::size_t vertices = mesh.position.size();
    std::vector<Part> parts((vertices + kBlock - 1) / kBlock);
    parallel_blocks(vertices, kBlock, [&](std::size_t begin, std::size_t end) {
        Part& part = parts[begin / kBlock];
        VertexRows rows;
        for (std::size_t i = begin; i < end; ++i) {
            const auto v = static_cast<VertexId>(i);
            if (!wanted(v)) continue;
            const std::size_t first = topology.first(v), regions = topology.last(v) - first;
            rows.clear(regions);
            for (const Corner& corner : topology.corners.of(v)) add_corner(mesh, topology, corner, first, rows);
            const double area = area_at(mesh, topology, v);
            for (std::size_t r = 0; r < regions; ++r) {
                const auto& row = rows.sorted(r);
                for (const auto& term : row) {
                    part.column.push_back(term.column);
                    part.value.push_back(term.value);
                    if (term.column == first + r) diagonal_[first + r] = term.value;
                }
                start_[first + r + 1] = row.size();
                cell_[first + r] = 2.0 * area / static_cast<double>(regions);
                held_[first + r] = topology.hold[v] == Hold::kRim ? 1 : 0;
            }
        }
    });
    for (std::size_t i = 0; i < topology.size(); ++i) start_[i + 1] += start_[i];
    column_.reserve(start_.back());
    value_.reserve(start_.back());
    for (const Part& part : parts) {
        column_.insert(column_.end(), part.column.begin(), part.column.end());
        value_.insert(value_.end(), part.value.begin(), part.value.end());
    }
}

void FilmLaplacian::multiply(const std::vector<double>& x, std::vector<double>& y) const {
    y.resize(x.size());
    parallel_for(x.size(), [&](std::size_t i) {
        double sum = 0.0;
        for (std::size_t k = start_[i]; k < start_[i + 1]; ++k) sum += value_[k] * x[column_[k]];
        y[i] = sum;
    });
}

double FilmLaplacian::largest_eigenvalue() const {  // Gershgorin's circles
    double largest = 0.0;
    for (std::size_t i = 0; i < cell_.size(); ++i) {
        double sum = 0.0;
        for (std::size_t k = start_[i]; k < start_[i + 1]; ++k) sum += std::abs(value_[k]);
        if (held_[i] == 0 && cell_[i] > 0.0) largest = std::max(largest, 0.5 * sum / cell_[i]);
    }
    return largest;
}

void diffuse(const FilmLaplacian& laplacian, double viscosity, double dt, Circulation& phi) {
    // A regular film: Gamma = phi_b - phi_a has twice the stiffness of either, so half of K makes d Gamma/dt right.
    const double factor = 0.5 * viscosity * dt;
    std::vector<double> scratch, right(phi.size());
    const auto apply = [&](const std::vector<double>& x, std::vector<double>& y) {
        laplacian.multiply(x, scratch);
        y.resize(x.size());
        for (std::size_t i = 0; i < x.size(); ++i)
            y[i] = laplacian.held_[i] != 0 ? x[i] : laplacian.cell_[i] * x[i] + factor * scratch[i];
    };
    std::vector<double> scale(phi.size());
    for (std::size_t i = 0; i < phi.size(); ++i) {
        right[i] = laplacian.held_[i] != 0 ? phi[i] : laplacian.cell_[i] * phi[i];
        scale[i] = laplacian.held_[i] != 0 ? 1.0 : 1.0 / (laplacian.cell_[i] + factor * laplacian.diagonal_[i]);
    }
    constexpr double kTolerance = 1e-10;
    constexpr int kMostSteps = 500;
    linalg::conjugate_gradient(apply, scale, right, phi, kTolerance, kMostSteps);
}

void filter_grid_noise(const FilmLaplacian& laplacian, double strength, Circulation& phi) {
    // D^-1 K has eigenvalues between 0 and about 2.7 on jumps (D: the diagonal); twice gives the fourth order.
    constexpr double kShortest = 2.5;
    std::vector<double> once, twice;
    const auto apply = [&](const std::vector<double>& x, std::vector<double>& y) {
        laplacian.multiply(x, y);
        for (std::size_t i = 0; i < y.size(); ++i)
            y[i] = laplacian.held_[i] != 0 || laplacian.diagonal_[i] == 0.0 ? 0.0 : y[i] / laplacian.diagonal_[i];
    };
    apply(phi, once);
    apply(once, twice);
    for (std::size_t i = 0; i < phi.size(); ++i) phi[i] -= strength / (kShortest * kShortest) * twice[i];
}

void even_out(const FilmLaplacian& laplacian, const std::vector<std::uint32_t>& entries, int sweeps, Circulation& phi) {
    constexpr double kRelaxation = 0.4;  // eigenvalues of D^-1 K reach 2.5: the shortest waves go at once
    std::vector<double> change(entries.size());
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        for (std::size_t i = 0; i < entries.size(); ++i) {
            const std::uint32_t e = entries[i];
            double sum = 0.0;
            for (std::size_t k = laplacian.start_[e]; k < laplacian.start_[e + 1]; ++k)
                sum += laplacian.value_[k] * phi[laplacian.column_[k]];
            const bool fixed = laplacian.held_[e] != 0 || laplacian.diagonal_[e] == 0.0;
            change[i] = fixed ? 0.0 : kRelaxation * sum / laplacian.diagonal_[e];
        }
        for (std::size_t i = 0; i < entries.size(); ++i) phi[entries[i]] -= change[i];
    }
}

}  // namespace lamella::vortex_sheet
