#include "lamella/solvers/melp/black_film.h"

#include "lamella/solvers/melp/loops.h"
#include "lamella/solvers/melp/operators.h"

namespace lamella::melp {

std::vector<double> blackness(std::span<const double> thickness, double limit) {
    std::vector<double> chi;
    chi.reserve(thickness.size());
    for (const double eta : thickness) {
        const double square = (eta / limit) * (eta / limit);
        chi.push_back(1.0 / (1.0 + square * square));
    }
    return chi;
}

std::vector<Vec3> line_pull(const Geometry& g,
                            std::span<const Vec3> x,
                            std::span<const double> blackness,
                            double line_tension) {
    const std::vector<Vec3> slope = gradient(g, x, blackness);
    // S on a vector d.
    const auto stress = [&](std::size_t i, const Vec3& d) {
        const double steep = norm(slope[i]);
        if (steep == 0.0) return Vec3{};
        const Vec3 along = d - dot(d, g.normal[i]) * g.normal[i];
        return line_tension * (steep * along - (dot(slope[i], d) / steep) * slope[i]);
    };
    const Neighbors& same = g.neighbors.same;
    std::vector<Vec3> pull(g.size());
    for_each_particle(g.size(), [&](std::size_t i) {
        Vec3 sum;
        for (std::size_t k = same.begin(i); k < same.end(i); ++k) {
            const std::size_t j = same.index[k];
            const Vec3 between = (0.5 * g.area[i] * g.area[j] * same.laplacian[k]) * (x[j] - x[i]);  // a a grad W
            sum += stress(i, between) + stress(j, between);
        }
        pull[i] = sum - dot(sum, g.normal[i]) * g.normal[i];
    });
    return pull;
}

}  // namespace lamella::melp
