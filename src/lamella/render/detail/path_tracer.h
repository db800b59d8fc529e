#pragma once

#include "lamella/render/detail/stage.h"
#include "lamella/render/environment.h"

namespace lamella::render::detail {

/// Light and opacity of one ray from the camera.
struct Seen {
    optics::Rgb light;
    double alpha = 0.0;   ///< 0 where nothing but the background is seen
    bool empty = false;   ///< the ray met nothing
};

/// A sequence of numbers in [0, 1) that one sample of one pixel uses.
class SampleNumbers {
public:
    explicit SampleNumbers(std::uint64_t seed) : state_(seed) {}
    double next() {  // splitmix64
        std::uint64_t z = (state_ += 0x9E3779B97F4A7C15U);
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
        return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1.0p-53;
    }

private:
    std::uint64_t state_;
};

/// Follows rays through a stage. It holds scratch memory: one per thread at a time.
class PathTracer {
public:
    PathTracer(const Stage& stage, const Environment& environment, const optics::FilmColorTable& colors)
        : stage_(stage), environment_(environment), colors_(colors), crossings_(kDeepest + 1) {}

    /// @param background  what is behind everything, straight on; nothing: the environment
    Seen look(const Vec3& origin, const Vec3& direction, const std::optional<optics::Rgb>& background, SampleNumbers& numbers);

private:
    struct Ray {
        Vec3 origin, direction;
        int depth = 0;           ///< how often it was mirrored or bent
        bool straight = true;    ///< it comes from the camera as it is
    };
    struct Mirror {
        Vec3 place, direction;
        optics::Rgb weight;
    };

    optics::Rgb follow(const Ray& ray, const std::optional<optics::Rgb>& background, SampleNumbers& numbers, Seen* seen);
    optics::Rgb things_light(const Ray& ray, const ThingHit& hit, SampleNumbers& numbers);
    optics::Rgb mirrored_light(const Ray& ray, const std::vector<Mirror>& mirrors, SampleNumbers& numbers);
    optics::Rgb matte_light(const Vec3& place, const Vec3& normal, const optics::Rgb& color, SampleNumbers& numbers) const;
    optics::Rgb border_light(const Ray& ray, const ThingHit& hit, SampleNumbers& numbers);

    static constexpr int kDeepest = 6;
    const Stage& stage_;
    const Environment& environment_;
    const optics::FilmColorTable& colors_;
    std::vector<std::vector<FilmCrossing>> crossings_;  ///< of the ray at each depth
};

}  // namespace lamella::render::detail
