#pragma once

#include "lamella/core/vec.h"
#include "lamella/io/image_files.h"
#include "lamella/optics/color.h"

#include <memory>
#include <string>
#include <vector>

namespace lamella::render {

/// A direction with the light from there, drawn at random.
struct LightSample {
    Vec3 direction;        ///< unit
    optics::Rgb light;     ///< radiance [of white paper]
    double density = 0.0;  ///< probability per solid angle [1/sr]
};

/// The light that comes from infinitely far, by direction; z points up, azimuth 0 is towards +x.
class Environment {
public:
    /// "studio": large soft lamps in a dark room, made for films; "window": a room with a bright window of six panes
    /// and a warm wall; "daylight": a hazy sky with a veiled sun over gray ground; "gray": the same light from
    /// everywhere; otherwise a picture of light (.hdr, .pic, .exr) of the whole sphere, azimuth 0 in its middle.
    /// @throws InputError  no such name or file   @throws IoError
    explicit Environment(const std::string& name);
    ~Environment();
    Environment(Environment&&) noexcept;
    Environment& operator=(Environment&&) noexcept;

    optics::Rgb light(const Vec3& direction) const;

    /// What a white matte surface with this normal throws back when nothing is in the way:
    /// 1/pi of the integral of light(d) max(0, normal . d) over the sphere. From a table, to about 1 percent.
    optics::Rgb matte(const Vec3& normal) const;
    /// The largest luminance of matte() over all normals.
    double brightest_matte() const { return brightest_matte_; }

    /// Draws a direction where the light is strong, from two numbers in [0, 1).
    LightSample sample(double a, double b) const;
    /// The density [1/sr] with which sample() draws a direction.
    double density(const Vec3& direction) const;

    static const std::vector<std::string>& names();

private:
    optics::Rgb painted(const Vec3& direction) const;
    optics::Rgb cell_light(std::size_t row, std::size_t column) const;
    double cell_density(std::size_t row, std::size_t column, double polar) const;
    void prepare_sampling();
    void prepare_matte();

    struct Room;  ///< lamps and walls
    std::unique_ptr<Room> room_;
    io::LightImage picture_;
    std::vector<optics::Rgb> cell_;           ///< mean light by direction, row by row from above
    std::vector<double> row_sum_, cell_sum_;  ///< running sums of light over the rows and within each row
    std::vector<optics::Rgb> matte_;
    double brightest_matte_ = 0.0;
};

}  // namespace lamella::render
