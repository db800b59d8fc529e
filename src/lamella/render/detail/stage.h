#pragma once

#include "lamella/optics/film_color_table.h"
#include "lamella/render/detail/curved_film.h"
#include "lamella/render/detail/ray_scene.h"
#include "lamella/render/picture.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace lamella::render::detail {

/// A table under everything.
struct Ground {
    double height = -1.0;
    optics::Rgb color;  ///< as it is seen in mirror images
};

/// Everything that rays need to know of a frame, moved and scaled so that it fills the unit ball around the origin.
struct Stage {
    Bounds bounds;    ///< in the frame
    FineFilms films;  ///< their values: thickness [m], or the field that colors them
    bool films_show_field = false;
    std::string thickness_origin = "none";  ///< see Picture
    std::vector<optics::Rgb> ball_color;
    std::optional<ColorScale> scale;  ///< where a field colors things
    std::optional<Ground> ground;
    std::unique_ptr<RayScene> rays;
};

/// @throws InputError  as render_frame
Stage make_stage(const sim::Frame& frame, const PictureOptions& options);

}  // namespace lamella::render::detail
