#pragma once

#include "lamella/core/vec.h"
#include "lamella/io/image_files.h"
#include "lamella/optics/color.h"

#include <string>
#include <vector>

namespace lamella::render {

/// A direction with the light from there, drawn at random.
struct LightSample {
    Vec3 direction;      ///< unit
    optics::Rgb light;   ///< radiance [of white paper]
    double density = 0.0;///< probability per solid angle [1/sr]
};

/// The light that comes from infinitely far, by direction; z points up, azimuth 0 is towards +x.
class Environment {
public:
    /// "studio": large soft lamps in a dark room, made for films; "daylight": a window-lit hazy sky over gray ground;
    /// "gray": the same light from everywhere; otherwise a picture of light (.hdr, .exr) of the whole sphere.
    /// @throws InputError  no such name or file
    explicit Environment(const std::string& name);

    optics::Rgb light(const Vec3& direction) const;
    /// Draws a direction where the light is strong, from two numbers in [0, 1).
    LightSample sample(double a, double b) const;

    static const std::vector<std::string>& names();

private:
    optics::Rgb painted(const Vec3& direction) const;
    void prepare_sampling();

    enum class Kind { kStudio, kDaylight, kGray, kPicture } kind_ = Kind::kStudio;
    io::LightImage picture_;
    std::vector<double> row_sum_, cell_sum_;  ///< running sums of light over the rows and within each row
};

}  // namespace lamella::render
