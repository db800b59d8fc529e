#include "lamella/render/periodic_images.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <set>

namespace lamella::render {
namespace {

using Cell = std::array<std::int64_t, 3>;  ///< which of the boxes that fill space; [0, 0, 0] is the frame's own

Cell plus(const Cell& a, const Cell& b, std::int64_t sign = 1) {
    return {a[0] + sign * b[0], a[1] + sign * b[1], a[2] + sign * b[2]};
}

/// The axes along which the box repeats, with their lengths; 0 for the others.
Vec3 periods(const sim::Box& box) {
    Vec3 period;
    for (std::size_t k = 0; k < 3; ++k) period[k] = box.periodic[k] ? std::max(box.lengths[k], 0.0) : 0.0;
    return period;
}

/// Places in a periodic box, equal (to rounding) for all images of one place.
class WrappedPlaces {
public:
    WrappedPlaces(const sim::Surface& films, const Vec3& period) : films_(films), period_(period) {
        double extent = norm(period);
        for (const Vec3& p : films.position) extent = std::max(extent, norm(p - films.position[0]));
        grain_ = kGrain * extent;
    }

    Cell of(std::uint32_t vertex) const {
        Cell cell{};
        for (std::size_t k = 0; k < 3; ++k) {
            double x = films_.position[vertex][k];
            if (period_[k] > 0.0) x -= period_[k] * std::floor(x / period_[k]);
            cell[k] = std::llround(x / grain_);
            if (period_[k] > 0.0 && cell[k] == std::llround(period_[k] / grain_)) cell[k] = 0;
        }
        return cell;
    }
    /// How many boxes `a` lies beyond `b`, which is an image of it.
    Cell apart(std::uint32_t a, std::uint32_t b) const {
        Cell cell{};
        for (std::size_t k = 0; k < 3; ++k)
            if (period_[k] > 0.0) cell[k] = std::llround((films_.position[a][k] - films_.position[b][k]) / period_[k]);
        return cell;
    }

private:
    static constexpr double kGrain = 1e-7;
    const sim::Surface& films_;
    Vec3 period_;
    double grain_ = 1.0;
};

struct Placed {
    std::uint32_t triangle;
    Cell cell;
    auto operator<=>(const Placed&) const = default;
};

/// One side of a triangle, as a bubble sees it from within. 0: its back, 1: its front, where its normal points.
struct Wall {
    std::uint32_t triangle;
    std::size_t side;
    auto operator<=>(const Wall&) const = default;
};

/// Puts together the films of one bubble: each in the box where it continues one that is there already. A bubble may
/// touch its own image, so its walls are followed along their inner sides.
class Assembly {
public:
    explicit Assembly(const sim::Surface& films, const Vec3& period) : films_(films), places_(films, period) {
        std::map<Cell, std::uint32_t> number;
        for (std::uint32_t v = 0; v < films.position.size(); ++v)
            place_.push_back(number.emplace(places_.of(v), static_cast<std::uint32_t>(number.size())).first->second);
        for (std::uint32_t t = 0; t < films.triangles.size(); ++t)
            for (std::size_t k = 0; k < 3; ++k) beside_[edge(t, k)].push_back(wing(t, k));
    }

    /// @param walls  all of the bubble; if they go on through the box without an end they stay where they are
    std::vector<Placed> whole(const std::vector<Wall>& walls) const {
        std::map<Wall, Cell> cell;
        std::vector<Placed> placed;
        for (const Wall& start : walls) {
            if (!cell.emplace(start, placed.empty() ? Cell{} : placed.front().cell).second) continue;
            std::vector<Wall> waiting{start};
            while (!waiting.empty()) {
                const Wall wall = waiting.back();
                waiting.pop_back();
                placed.push_back({wall.triangle, cell.at(wall)});
                for (std::size_t k = 0; k < 3; ++k) {
                    const std::optional<Next> next = across(wall, k);
                    if (!next) continue;
                    const Cell there = plus(cell.at(wall), next->apart);
                    const auto [at, anew] = cell.emplace(next->wall, there);
                    if (anew) waiting.push_back(next->wall);
                    if (at->second != there) return as_they_lie(walls);
                }
            }
        }
        return placed;
    }

private:
    struct Next {
        Wall wall;
        Cell apart;  ///< the box where it continues the first, as seen from that one's
    };
    /// A triangle at one of its edges.
    struct Wing {
        std::uint32_t triangle, end;  ///< `end`: the vertex at the end of the edge whose place has the smaller number
        Vec3 inward, normal;          ///< both at right angles to the edge; the first lies in the triangle
    };

    static std::vector<Placed> as_they_lie(const std::vector<Wall>& walls) {
        std::vector<Placed> placed;
        for (const Wall& wall : walls) placed.push_back({wall.triangle, {}});
        return placed;
    }

    std::array<std::uint32_t, 2> edge(std::uint32_t t, std::size_t k) const {
        const std::uint32_t a = place_[films_.triangles[t][k]], b = place_[films_.triangles[t][(k + 1) % 3]];
        return {std::min(a, b), std::max(a, b)};
    }

    Wing wing(std::uint32_t t, std::size_t k) const {
        const std::uint32_t a = films_.triangles[t][k], b = films_.triangles[t][(k + 1) % 3];
        const Vec3 &p = films_.position[a], &q = films_.position[b],
                   &r = films_.position[films_.triangles[t][(k + 2) % 3]];
        const Vec3 normal = cross(q - p, r - p);
        return {t, place_[a] < place_[b] ? a : b, cross(normal, q - p), normal};
    }

    /// The wall behind edge k of a wall: what comes first when turning about the edge through the inside of the bubble.
    std::optional<Next> across(const Wall& wall, std::size_t k) const {
        const Wing own = wing(wall.triangle, k);
        const Vec3 ahead = own.inward / std::max(norm(own.inward), std::numeric_limits<double>::min());
        const Vec3 inside =
            (wall.side == 1 ? 1.0 : -1.0) / std::max(norm(own.normal), std::numeric_limits<double>::min()) * own.normal;
        double nearest = std::numeric_limits<double>::infinity();
        std::optional<Next> next;
        for (const Wing& other : beside_.at(edge(wall.triangle, k))) {
            if (other.triangle == wall.triangle) continue;
            const double angle = std::atan2(dot(other.inward, inside), dot(other.inward, ahead));
            const double turned = angle < 0.0 ? angle + 2.0 * std::numbers::pi : angle;
            if (turned >= nearest) continue;
            nearest = turned;
            const Vec3 onward = std::cos(turned) * inside - std::sin(turned) * ahead;
            next = {{other.triangle, dot(other.normal, onward) < 0.0 ? 1U : 0U}, places_.apart(own.end, other.end)};
        }
        if (next && films_.regions[next->wall.triangle][next->wall.side] != films_.regions[wall.triangle][wall.side])
            return std::nullopt;
        return next;
    }

    const sim::Surface& films_;
    WrappedPlaces places_;
    std::vector<std::uint32_t> place_;  ///< of each vertex; all images of a place have one number
    std::map<std::array<std::uint32_t, 2>, std::vector<Wing>> beside_;
};

/// The box in which the middle of a bubble lies.
Cell home(const sim::Surface& films, const std::vector<Placed>& bubble, const sim::Box& box) {
    const Vec3 period = periods(box);
    Vec3 sum;
    for (const Placed& p : bubble)
        for (const std::uint32_t v : films.triangles[p.triangle])
            for (std::size_t k = 0; k < 3; ++k)
                sum[k] += films.position[v][k] + period[k] * static_cast<double>(p.cell[k]);
    Cell cell{};
    for (std::size_t k = 0; k < 3; ++k)
        if (period[k] > 0.0)
            cell[k] = static_cast<std::int64_t>(
                std::floor((sum[k] / (3.0 * static_cast<double>(bubble.size())) - box.origin[k]) / period[k]));
    return cell;
}

/// The triangles of all bubbles, each bubble whole, `count` times along each periodic axis.
std::set<Placed> whole_bubbles(const sim::Surface& films, const sim::Box& box, int count) {
    std::map<std::int32_t, std::vector<Wall>> walls;  // of each region
    for (std::uint32_t t = 0; t < films.triangles.size(); ++t)
        for (std::size_t side = 0; side < 2; ++side)
            if (films.regions[t][side] != 0) walls[films.regions[t][side]].push_back({t, side});
    const Vec3 period = periods(box);
    const Assembly assembly(films, period);
    std::set<Placed> chosen;
    const auto times = [&](std::size_t k) { return period[k] > 0.0 ? count : 1; };
    for (const auto& [region, own] : walls) {
        const std::vector<Placed> bubble = assembly.whole(own);
        const Cell from = home(films, bubble, box);
        for (std::int64_t i = 0; i < times(0); ++i)
            for (std::int64_t j = 0; j < times(1); ++j)
                for (std::int64_t k = 0; k < times(2); ++k)
                    for (const Placed& p : bubble) chosen.insert({p.triangle, plus(plus(p.cell, from, -1), {i, j, k})});
    }
    return chosen;
}

/// Takes the values of these items, in this order.
void pick(std::vector<sim::Field>& fields, const std::vector<std::uint32_t>& items) {
    for (sim::Field& field : fields) {
        const std::vector<double> all = std::move(field.values);
        const auto width = static_cast<std::size_t>(field.components);
        field.values.clear();
        for (const std::uint32_t item : items)
            for (std::size_t k = 0; k < width; ++k) field.values.push_back(all.at(width * item + k));
    }
}

}  // namespace

sim::Frame periodic_images(sim::Frame frame, int count) {
    if (!frame.box || frame.surface.empty() || frame.surface.regions.size() != frame.surface.triangles.size())
        return frame;
    const Vec3 period = periods(*frame.box);
    if (norm(period) == 0.0) return frame;
    sim::Surface s = frame.surface;
    if (s.find_of_vertices("on_wire") == nullptr)
        s.vertex_fields.push_back({"on_wire", "-", 1, true, std::vector<double>(s.position.size(), 0.0)});
    std::erase_if(s.face_fields, [](const sim::Field& field) { return field.name == sim::kCurvedNodes; });  // places
    s.position.clear();
    s.triangles.clear();
    s.regions.clear();
    std::vector<std::uint32_t> triangles, vertices;
    std::map<Placed, std::uint32_t> number;  // of each vertex in each box
    for (const Placed& p : whole_bubbles(frame.surface, *frame.box, count)) {
        std::array<std::uint32_t, 3> corners{};
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t v = frame.surface.triangles[p.triangle][k];
            const auto [it, anew] = number.emplace(Placed{v, p.cell}, static_cast<std::uint32_t>(s.position.size()));
            corners[k] = it->second;
            if (!anew) continue;
            Vec3 place = frame.surface.position[v];
            for (std::size_t axis = 0; axis < 3; ++axis)
                place[axis] += period[axis] * static_cast<double>(p.cell[axis]);
            s.position.push_back(place);
            vertices.push_back(v);
        }
        triangles.push_back(p.triangle);
        s.triangles.push_back(corners);
        s.regions.push_back(frame.surface.regions[p.triangle]);
    }
    pick(s.vertex_fields, vertices);
    pick(s.face_fields, triangles);
    frame.surface = std::move(s);
    return frame;
}

}  // namespace lamella::render
