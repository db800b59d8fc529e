#pragma once

#include "lamella/render/detail/sample_numbers.h"
#include "lamella/render/detail/stage.h"
#include "lamella/render/environment.h"

namespace lamella::render::detail {

/// A ray from the camera.
struct CameraRay {
    Vec3 direction;
    std::optional<optics::Rgb> background;  ///< what is behind everything, straight on; nothing: the environment
    SampleNumbers numbers;
};

/// Light and opacity of one ray from the camera.
struct Seen {
    optics::Rgb light;
    double alpha = 0.0;  ///< 0 where nothing but the background is seen
};

/// Follows rays through a stage, many at a time. It holds scratch memory: one per thread at a time.
///
/// Mirror images. A film shows E, the light of the environment in the mirrored direction, plus (L - E), what else the
/// mirrored ray meets. E is cheap and exact; the small rest is taken by lot, with a chance that grows with the film's
/// reflectance: nearly always for the films that the camera sees, seldom for images of images. No bias, little noise.
/// Matte surfaces show what the whole environment would give them, times the open share of it.
class PathTracer {
public:
    PathTracer(const Stage& stage, const Environment& environment, const optics::FilmColorTable& colors)
        : stage_(stage), environment_(environment), colors_(colors) {}

    void look(const Vec3& origin, std::vector<CameraRay>& rays, std::vector<Seen>* seen);

private:
    enum class Behind : std::uint8_t { kBackground, kEnvironment, kNothing };  ///< what a ray sees that meets nothing
    /// A ray on its way, with what it is worth for the camera's ray that it began with.
    struct Path {
        optics::Rgb weight;
        std::uint32_t camera_ray;
        int depth;  ///< how often it was mirrored or bent
        Behind behind;
    };
    struct Shot {  ///< one ray with all that is known of it
        const RayStart& ray;
        const Path& path;
        RayMeeting& meeting;
        CameraRay& from;
        Seen& seen;
    };

    void shade(const Shot& shot);
    void meet_ground(const Shot& shot) const;
    optics::Rgb cross_films(const Shot& shot);
    void show_film(const Shot& shot,
                   const FilmCrossing& crossing,
                   std::size_t number,
                   const optics::Rgb& passed,
                   const optics::Rgb& reflected,
                   const Vec3& normal);
    void show_thing(const Shot& shot, const optics::Rgb& weight);
    void show_border(const Shot& shot, const optics::Rgb& weight);
    void show_ground(const Shot& shot, const optics::Rgb& weight);
    optics::Rgb matte_light(const Shot& shot, const Vec3& place, const Vec3& normal) const;
    double openness(const Shot& shot, const Vec3& place, const Vec3& normal) const;
    optics::Rgb far_light(const Vec3& direction) const;
    void send(const Shot& from, const RayStart& ray, const optics::Rgb& weight, Behind behind);

    static constexpr int kDeepest = 6;
    const Stage& stage_;
    const Environment& environment_;
    const optics::FilmColorTable& colors_;
    std::vector<RayStart> rays_, next_rays_;  ///< all of one depth, and of the next
    std::vector<Path> paths_, next_paths_;
    std::vector<RayMeeting> meetings_;
};

}  // namespace lamella::render::detail
