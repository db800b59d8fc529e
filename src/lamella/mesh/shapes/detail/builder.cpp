#include "lamella/mesh/shapes/detail/builder.h"

#include "lamella/core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lamella::mesh::detail {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kRowHeight = 0.8660254037844386;  // of equilateral triangles

}  // namespace

void require_positive(double value, std::string_view name) {
    if (!(value > 0.0) || !std::isfinite(value))
        throw InputError(fmt::format("the {} must be positive (got {})", name, value));
}

void require_affordable(double area, double edge_length) {
    constexpr double kMostFaces = 2e7;
    const double faces = area / (0.5 * kRowHeight * edge_length * edge_length);
    if (!(faces <= kMostFaces))
        throw InputError(fmt::format("edges of {} m would give {:.2g} faces; at most 2e7 are allowed", edge_length,
                                     faces));
}

FoamMesh empty_mesh(std::size_t regions, RegionKind kind) {
    FoamMesh mesh;
    mesh.regions.push_back({RegionKind::kOpen, 0.0});
    for (std::size_t r = 0; r < regions; ++r) mesh.regions.push_back({kind, 0.0});
    return mesh;
}

VertexId Welder::at(const Vec3& place, bool wire) {
    std::array<long long, 3> key;
    for (std::size_t k = 0; k < 3; ++k) key[k] = std::llround(place[k] / grid_);
    const auto [it, fresh] = known_.try_emplace(key, kNoVertex);
    if (fresh) it->second = mesh_.add_vertex(place, wire);
    return it->second;
}

void add_triangle_grid(FoamMesh& mesh,
                       int n,
                       const std::function<VertexId(double, double)>& vertex,
                       RegionId back,
                       RegionId front) {
    const auto at = [&](int i, int j) { return vertex(static_cast<double>(i) / n, static_cast<double>(j) / n); };
    for (int j = 0; j < n; ++j)
        for (int i = 0; i + j < n; ++i) {
            mesh.add_face(at(i, j), at(i + 1, j), at(i, j + 1), back, front);
            if (i + j + 1 < n) mesh.add_face(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1), back, front);
        }
}

Axis::Axis(const Vec3& middle, const Vec3& direction) : center(middle) {
    const double length = norm(direction);
    if (!(length > 0.0) || !std::isfinite(length)) throw InputError("an axis must not be zero");
    z = direction / length;
    std::size_t least = 0;
    for (std::size_t k = 1; k < 3; ++k)
        if (std::abs(z[k]) < std::abs(z[least])) least = k;
    Vec3 other;
    other[least] = 1.0;
    const Vec3 across = cross(z, other);
    x = across / norm(across);
    y = cross(z, x);
}

Vec3 Axis::at(double radius, double angle, double height) const {
    return center + (radius * std::cos(angle)) * x + (radius * std::sin(angle)) * y + height * z;
}

std::vector<VertexId> Revolution::ring(double radius, double height, bool wire, double offset) {
    const int count = std::max(3, static_cast<int>(std::lround(2.0 * kPi * radius / edge_)));
    std::vector<VertexId> row;
    for (int k = 0; k < count; ++k)
        row.push_back(mesh_.add_vertex(axis_.at(radius, 2.0 * kPi * (k + offset) / count, height), wire));
    return row;
}

int Revolution::rows_of(double length) const {
    return std::max(1, static_cast<int>(std::lround(length / (kRowHeight * edge_))));
}

/// Adds the rows between the first and the last. @returns the last of them
std::vector<VertexId> Revolution::inner_rows(std::vector<VertexId> row, int rows, const Profile& profile) {
    for (int k = 1; k < rows; ++k) {
        const auto [radius, height] = profile(static_cast<double>(k) / rows);
        std::vector<VertexId> next = ring(radius, height, false, k % 2 == 0 ? 0.0 : 0.5);
        stitch(row, next);
        row = std::move(next);
    }
    return row;
}

void Revolution::close(std::vector<VertexId> row, double length, const Profile& profile) {
    row = inner_rows(std::move(row), rows_of(length), profile);
    const auto [radius, height] = profile(1.0);
    stitch(row, {mesh_.add_vertex(axis_.at(radius, 0.0, height))});
}

void Revolution::join(const std::vector<VertexId>& from,
                      const std::vector<VertexId>& to,
                      double length,
                      const Profile& profile) {
    // With an even number of rows equal rings face each other after the staggering in between.
    const int rows = std::max(2, 2 * ((rows_of(length) + 1) / 2));
    stitch(inner_rows(from, rows, profile), to);
}

/// Goes around both rows at once, always along the shorter of the two diagonals.
void Revolution::stitch(const std::vector<VertexId>& from, const std::vector<VertexId>& to) {
    const auto distance = [&](VertexId v, VertexId w) { return squared_norm(mesh_.position[v] - mesh_.position[w]); };
    std::size_t first = 0;
    for (std::size_t k = 1; k < to.size(); ++k)
        if (distance(from[0], to[k]) < distance(from[0], to[first])) first = k;
    const auto low = [&](std::size_t i) { return from[i % from.size()]; };
    const auto high = [&](std::size_t j) { return to[(first + j) % to.size()]; };
    const std::size_t low_steps = from.size() > 1 ? from.size() : 0, high_steps = to.size() > 1 ? to.size() : 0;
    for (std::size_t i = 0, j = 0; i < low_steps || j < high_steps;) {
        const bool step_low =
            j == high_steps || (i < low_steps && distance(low(i + 1), high(j)) <= distance(low(i), high(j + 1)));
        if (step_low) {
            mesh_.add_face(low(i), low(i + 1), high(j), back_, front_);
            ++i;
        } else {
            mesh_.add_face(low(i), high(j + 1), high(j), back_, front_);
            ++j;
        }
    }
}

}  // namespace lamella::mesh::detail
