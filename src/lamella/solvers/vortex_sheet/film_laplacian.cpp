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

struct Entry {
    std::uint32_t column;
    double value;
};

/// What face f adds to the rows of its corner k.
void add_corner(const FoamMesh& mesh, const SheetTopology& topology, const Corner& corner, std::vector<Entry> row[2]) {
    const auto& entry = topology.entry[corner.face];
    for (const std::size_t step : {1U, 2U}) {
        const std::size_t other = (corner.k + step) % 3;
        const double c = half_cotangent(mesh, corner.face, (corner.k + 3 - step) % 3);
        for (const std::size_t side : {0U, 1U})
            for (const std::size_t across : {0U, 1U}) {
                const double sign = side == across ? 1.0 : -1.0;
                row[side].push_back({entry[corner.k][across], sign * c});
                row[side].push_back({entry[other][across], -sign * c});
            }
    }
}

}  // namespace

FilmLaplacian::FilmLaplacian(const FoamMesh& mesh, const SheetTopology& topology)
    : diagonal_(topology.size(), 0.0), cell_(topology.size(), 0.0), held_(topology.size(), 0) {
    start_.push_back(0);
    std::vector<std::vector<Entry>> rows;
    for (const VertexId v : mesh.position.ids()) {
        const std::size_t first = topology.first(v), regions = topology.last(v) - first;
        rows.assign(regions, {});
        double area = 0.0;
        for (const Corner& corner : topology.corners.of(v)) {
            std::vector<Entry> sides[2];
            add_corner(mesh, topology, corner, sides);
            for (const std::size_t side : {0U, 1U}) {
                auto& row = rows[topology.entry[corner.face][corner.k][side] - first];
                row.insert(row.end(), sides[side].begin(), sides[side].end());
            }
            const auto& u = mesh.faces[corner.face].vertices;
            area += norm(cross(mesh.position[u[1]] - mesh.position[u[0]], mesh.position[u[2]] - mesh.position[u[0]])) / 6.0;
        }
        for (std::size_t r = 0; r < regions; ++r) {
            auto& row = rows[r];
            std::stable_sort(row.begin(), row.end(), [](const Entry& a, const Entry& b) { return a.column < b.column; });
            for (std::size_t i = 0; i < row.size();) {
                double sum = 0.0;
                const std::uint32_t column = row[i].column;
                for (; i < row.size() && row[i].column == column; ++i) sum += row[i].value;
                column_.push_back(column);
                value_.push_back(sum);
                if (column == first + r) diagonal_[first + r] = sum;
            }
            start_.push_back(column_.size());
            cell_[first + r] = 2.0 * area / static_cast<double>(regions);
            held_[first + r] = topology.hold[v] == Hold::kRim ? 1 : 0;
        }
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
