#pragma once

#include "lamella/core/vec.h"

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace lamella::render::detail {

/// What rays can meet. Lengths in any unit in which the whole is about 1 in size: rays are single precision.
struct RayGeometry {
    std::vector<std::array<float, 3>> film_position;
    std::vector<std::array<std::uint32_t, 3>> film_triangles;
    std::vector<std::array<float, 4>> thread_points;  ///< x, y, z, radius
    std::vector<std::uint32_t> thread_segments;       ///< first point of each segment, which runs to the next point
    std::vector<std::uint8_t> segment_is_wire;
    std::vector<std::array<float, 4>> balls;  ///< x, y, z, radius
};

/// A film crossed by a ray.
struct FilmCrossing {
    float distance;
    std::uint32_t triangle;
    float u, v;  ///< weights of its second and third corner
};

enum class Thing : std::uint8_t { kNothing, kBorder, kWire, kBall, kGround };

/// The first thing along a ray that is no film.
struct ThingHit {
    Thing thing = Thing::kNothing;
    float distance = 0.0F;
    std::uint32_t number = 0;  ///< of the segment or ball
    Vec3 normal;               ///< unit, outward
};

struct RayStart {
    Vec3 origin, direction;  ///< unit direction
};

/// What a ray meets: the first thing, and the films before it, sorted by distance. A film met at the edge between two
/// of its triangles counts once.
struct RayMeeting {
    ThingHit thing;
    std::vector<FilmCrossing> films;
};

/// How much the rays that are traced together resemble each other; for speed only.
enum class Bundle : std::uint8_t { kAlike, kMixed };

/// The rays of Embree; this is the only file that knows it.
class RayScene {
public:
    /// @throws InputError  this program was built without Embree
    explicit RayScene(RayGeometry geometry);
    ~RayScene();
    RayScene(const RayScene&) = delete;
    RayScene& operator=(const RayScene&) = delete;

    /// Traces any number of rays.
    void trace(std::span<const RayStart> rays, Bundle bundle, std::vector<RayMeeting>* meetings) const;

    /// Whether an opaque thing (a wire, a ball) is in the way.
    bool blocked(const Vec3& origin, const Vec3& direction) const;

    /// Whether the ray meets anything at all.
    bool meets_anything(const Vec3& origin, const Vec3& direction) const;

    const RayGeometry& geometry() const { return geometry_; }

private:
    struct Impl;
    RayGeometry geometry_;
    std::unique_ptr<Impl> impl_;
};

/// Whether this program was built with Embree.
bool can_trace_rays();

}  // namespace lamella::render::detail
