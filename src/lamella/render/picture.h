#pragma once

#include "lamella/io/image_files.h"
#include "lamella/render/camera.h"
#include "lamella/render/canvas.h"
#include "lamella/render/color_scale.h"
#include "lamella/sim/frame.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace lamella::render {

/// What a picture of a frame shall be.
struct PictureOptions {
    std::size_t width = 960, height = 720;
    int samples = 16;  ///< per pixel
    View view;
    std::string environment = "studio";  ///< see Environment
    bool ground = false;                 ///< a polished table just below everything
    std::string background = "dark";     ///< dark, light, transparent, environment, or a color "#1a2b3c"
    std::string field;                   ///< colors films and balls; empty: as light does
    double thickness = 0.0;              ///< of all films [m]; 0: the frame's, or a drained film where it has none
    double border_width = 1.0;           ///< of Plateau borders and wires, relative to the usual one; 0: none
    double exposure = 1.0;               ///< multiplies all light
    std::uint64_t seed = 1;
    std::optional<Bounds> bounds;     ///< what the camera looks at; the frame's own by default
    std::optional<ColorScale> scale;  ///< of the field; the frame's own range by default
};

/// A picture before it is developed for a screen.
struct Picture {
    io::LightImage light;  ///< linear, RGB and premultiplied alpha
    io::LightImage shown;  ///< the same with highlights compressed before the samples of a pixel were averaged, as
                           ///< edges of bright lamps would be jagged otherwise
    std::optional<ColorScale> scale;  ///< where a field colors it
    std::string thickness_origin;     ///< "frame", "particles", "given", "assumed: ...", "none" where no film shows it
};

/// Follows rays of light through the films of a frame.
///
/// A ray that meets a film goes on behind it, weakened by 1 - C, and its mirror image is weighted with C, the film's
/// color for its thickness and angle (optics/film_color_table.h). Both are followed at the first films; images of
/// images are drawn by lot. Plateau borders bend light as threads of water do; wires are brushed metal, balls matte
/// with a gloss. Films of which no thickness is known get an assumed one (detail/assumed_thickness.h). Same options and
/// frame, same bits on any number of threads.
///
/// @param progress  told the fraction done now and then, on the calling thread; may throw to stop
/// @throws InputError  the frame shows nothing, there is no such field, built without Embree
Picture render_frame(const sim::Frame& frame,
                     const PictureOptions& options,
                     const std::function<void(double)>& progress = {});

/// The picture for a screen: highlights compressed, colors beyond sRGB desaturated, and the legend.
Canvas develop(const Picture& picture);

/// Whether this program can make pictures (it was built with Embree).
bool can_render();

/// The scale that render_frame would use for a field of this frame. @throws InputError  no such field, with the nearest
/// one
ColorScale field_scale(const sim::Frame& frame, const std::string& field);

}  // namespace lamella::render
