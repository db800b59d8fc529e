#include "lamella/render/periodic_images.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <type_traits>

namespace lamella::render {
namespace {

void repeat_values(std::vector<sim::Field>& fields, std::size_t times) {
    for (sim::Field& field : fields) {
        const std::vector<double> once = field.values;
        for (std::size_t i = 1; i < times; ++i) field.values.insert(field.values.end(), once.begin(), once.end());
    }
}

/// The shifts of all images, the box itself first.
std::vector<Vec3> image_shifts(const sim::Box& box, int count) {
    std::vector<Vec3> shifts{{}};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!box.periodic[axis] || box.lengths[axis] <= 0.0) continue;
        const std::vector<Vec3> before = shifts;
        for (int i = 1; i < count; ++i)
            for (Vec3 shift : before) {
                shift[axis] += i * box.lengths[axis];
                shifts.push_back(shift);
            }
    }
    return shifts;
}

/// For each vertex the smallest number of those that films connect it with. Vertices at one place (to rounding) are
/// one.
std::vector<std::uint32_t> connected_parts(const sim::Surface& s, double grain) {
    std::vector<std::uint32_t> root(s.position.size()), order(root.size());
    std::iota(root.begin(), root.end(), 0U);
    std::iota(order.begin(), order.end(), 0U);
    const auto find = [&](std::uint32_t v) {
        while (root[v] != v) v = root[v] = root[root[v]];
        return v;
    };
    const auto join = [&](std::uint32_t a, std::uint32_t b) {
        a = find(a), b = find(b);
        root[std::max(a, b)] = std::min(a, b);
    };
    std::vector<std::array<std::int64_t, 3>> cell(root.size());
    for (std::size_t v = 0; v < cell.size(); ++v)
        for (std::size_t k = 0; k < 3; ++k) cell[v][k] = std::llround(s.position[v][k] / grain);
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return cell[a] != cell[b] ? cell[a] < cell[b] : a < b; });
    for (std::size_t i = 1; i < order.size(); ++i)
        if (cell[order[i]] == cell[order[i - 1]]) join(order[i], order[i - 1]);
    for (const auto& [a, b, c] : s.triangles) join(a, b), join(b, c);
    for (std::uint32_t v = 0; v < root.size(); ++v) root[v] = find(v);
    return root;
}

/// Leaves only the largest connected part of the films.
void drop_loose_films(sim::Surface& s, double grain) {
    const std::vector<std::uint32_t> part = connected_parts(s, grain);
    std::vector<std::size_t> size(part.size(), 0);
    for (const auto& t : s.triangles) ++size[part[t[0]]];
    const auto largest = static_cast<std::uint32_t>(std::max_element(size.begin(), size.end()) - size.begin());
    std::vector<std::size_t> kept;
    for (std::size_t t = 0; t < s.triangles.size(); ++t)
        if (part[s.triangles[t][0]] == largest) kept.push_back(t);
    const auto pick = [&](auto& list, std::size_t width) {
        std::remove_reference_t<decltype(list)> some;
        for (const std::size_t t : kept)
            for (std::size_t k = 0; k < width; ++k) some.push_back(list[width * t + k]);
        list = std::move(some);
    };
    for (sim::Field& field : s.face_fields) pick(field.values, static_cast<std::size_t>(field.components));
    if (s.regions.size() == s.triangles.size()) pick(s.regions, 1);
    pick(s.triangles, 1);
}

}  // namespace

sim::Frame periodic_images(sim::Frame frame, int count) {
    if (!frame.box || frame.surface.empty()) return frame;
    const std::vector<Vec3> shifts = image_shifts(*frame.box, count);
    if (shifts.size() == 1) return frame;
    sim::Surface& s = frame.surface;
    if (s.find_of_vertices("on_wire") == nullptr)
        s.vertex_fields.push_back({"on_wire", "-", 1, true, std::vector<double>(s.position.size(), 0.0)});
    const auto vertices = static_cast<std::uint32_t>(s.position.size());
    const std::size_t triangles = s.triangles.size(), labels = s.regions.size();
    for (std::size_t i = 1; i < shifts.size(); ++i) {
        const std::uint32_t first = static_cast<std::uint32_t>(i) * vertices;
        for (std::uint32_t v = 0; v < vertices; ++v) s.position.push_back(Vec3(s.position[v]) + shifts[i]);
        for (std::size_t t = 0; t < triangles; ++t) {
            const auto [a, b, c] = s.triangles[t];
            s.triangles.push_back({a + first, b + first, c + first});
        }
        for (std::size_t t = 0; t < labels; ++t) s.regions.push_back(std::array(s.regions[t]));
    }
    repeat_values(s.vertex_fields, shifts.size());
    repeat_values(s.face_fields, shifts.size());
    drop_loose_films(s, 1e-7 * norm(frame.box->lengths));
    return frame;
}

}  // namespace lamella::render
