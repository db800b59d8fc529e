#include "snapshot.h"

#include "lamella/core/error.h"
#include "lamella/measure/measure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace lamella::app {
namespace {

/// What is drawn for a value, and how the color bar reads.
struct ColorScale {
    std::vector<double> values;  ///< per ball; NaN: no value, gray
    double low = 0.0;
    double high = 1.0;
    bool logarithmic = false;
    std::string label;

    unsigned color(std::size_t i) const {
        constexpr unsigned kNoValue = 0xd8d8d8;
        if (!std::isfinite(values[i])) return kNoValue;
        const double x =
            logarithmic ? std::log(values[i] / low) / std::log(high / low) : (values[i] - low) / (high - low);
        return map_color(x);
    }
};

/// The value below which a share of the finite values lies.
double quantile(std::vector<double> values, double share) {
    std::erase_if(values, [](double v) { return !std::isfinite(v); });
    if (values.empty()) return 1.0;
    const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + at, values.end());
    return values[static_cast<std::size_t>(at)];
}

const sim::Field& needed_field(const sim::Frame& frame, const std::string& name, int components) {
    const sim::Field* field = frame.points.find(name);
    if (field == nullptr || field->components != components ||
        field->values.size() != frame.points.size() * static_cast<std::size_t>(components))
        throw InputError(fmt::format("the frame has no field {} to color by", name));
    return *field;
}

ColorScale color_scale(const sim::Frame& frame, ColorBy color_by) {
    ColorScale scale;
    const std::vector<double>& radius = frame.points.radius;
    switch (color_by) {
        case ColorBy::kRadius: {
            const auto initial = frame.find_scalar("initial_mean_radius");
            const double unit = initial != nullptr && initial->value > 0.0 ? initial->value : 1.0;
            for (const double r : radius) scale.values.push_back(r / unit);
            scale.high = quantile(scale.values, 1.0);
            scale.label = initial != nullptr ? "radius {/:Italic R} / ⟨{/:Italic R}_{in}⟩" : "radius {/:Italic R}";
            break;
        }
        case ColorBy::kEnergy: {
            scale.values = needed_field(frame, "energy", 1).values;
            for (double& value : scale.values)
                if (!(value > 0.0)) value = std::nan("");
            scale.logarithmic = true;
            scale.high = quantile(scale.values, 0.999);
            // Below a thousandth lie bubbles that barely touch; they would take all the colors.
            scale.low = std::max(quantile(scale.values, 0.05), 1e-3 * scale.high);
            scale.label = "energy of a bubble";
            break;
        }
        case ColorBy::kDisplacement: {
            const sim::Field& moved = needed_field(frame, "frame_displacement", 3);
            for (std::size_t i = 0; i < radius.size(); ++i)
                scale.values.push_back(
                    norm(Vec3{{moved.values[3 * i], moved.values[3 * i + 1], moved.values[3 * i + 2]}}));
            scale.high = quantile(scale.values, 0.99);  // a few bubbles jump across a gap
            scale.label = "distance moved since the last frame";
            break;
        }
    }
    if (!(scale.high > scale.low)) scale.high = scale.low + (scale.logarithmic ? scale.low : 1.0);
    return scale;
}

/// A circle on the picture.
struct Circle {
    double x, y, radius;
    double depth;  ///< larger is nearer
    unsigned color;
};

/// Discs, and where they cross periodic sides their copies on the other side.
std::vector<Circle> flat_circles(const sim::Frame& frame, const ColorScale& scale) {
    const sim::Box& box = *frame.box;
    std::vector<Circle> circles;
    for (std::size_t i = 0; i < frame.points.size(); ++i) {
        const double r = frame.points.radius[i];
        const auto shifts = [&](std::size_t axis) {
            std::vector<double> all{0.0};
            const double from_origin = frame.points.position[i][axis] - box.origin[axis];
            if (box.periodic[axis] && from_origin < r) all.push_back(box.lengths[axis]);
            if (box.periodic[axis] && from_origin > box.lengths[axis] - r) all.push_back(-box.lengths[axis]);
            return all;
        };
        for (const double dx : shifts(0))
            for (const double dy : shifts(1))
                circles.push_back(
                    {frame.points.position[i][0] + dx, frame.points.position[i][1] + dy, r, 0.0, scale.color(i)});
    }
    return circles;
}

/// Parallel projection from above a corner of the box.
struct Projection {
    Vec3 right, up, toward;

    static Projection oblique() {
        constexpr double kAzimuth = 0.45;    // [rad] about z
        constexpr double kElevation = 0.35;  // [rad] above the xy plane
        const double ca = std::cos(kAzimuth);
        const double sa = std::sin(kAzimuth);
        const double ce = std::cos(kElevation);
        const double se = std::sin(kElevation);
        return {{{ca, sa, 0.0}}, {{-sa * se, ca * se, ce}}, {{sa * ce, -ca * ce, se}}};
    }
};

std::vector<Circle> ball_circles(const sim::Frame& frame, const ColorScale& scale, const Projection& view) {
    std::vector<Circle> circles;
    for (std::size_t i = 0; i < frame.points.size(); ++i) {
        const Vec3& p = frame.points.position[i];
        circles.push_back(
            {dot(p, view.right), dot(p, view.up), frame.points.radius[i], dot(p, view.toward), scale.color(i)});
    }
    std::stable_sort(circles.begin(), circles.end(),
                     [](const Circle& a, const Circle& b) { return a.depth < b.depth; });
    return circles;
}

/// Far balls pale towards the background, and each gets rings that brighten towards a light from the upper left.
std::vector<Circle> lit_balls(const std::vector<Circle>& balls) {
    if (balls.empty()) return {};
    const double far = balls.front().depth;
    const double range = std::max(balls.back().depth - far, 1e-300);
    // Circles cost gnuplot 20 microseconds each, and in a crowd the rings are too small to see.
    const int rings = balls.size() <= 10000 ? 10 : balls.size() <= 40000 ? 5 : 1;
    std::vector<Circle> circles;
    for (const Circle& ball : balls) {
        const double haze = 0.35 * (1.0 - (ball.depth - far) / range);
        for (int ring = 0; ring < rings; ++ring) {
            const double inward = static_cast<double>(ring) / rings;
            Circle circle = ball;
            circle.x -= 0.30 * inward * ball.radius;
            circle.y += 0.30 * inward * ball.radius;
            circle.radius *= 1.0 - 0.85 * inward;
            const double light = rings == 1 ? 0.0 : -0.30 + 0.65 * inward;
            circle.color = shaded(shaded(ball.color, light), haze);
            circles.push_back(circle);
        }
    }
    return circles;
}

std::string circle_data(Gnuplot& gnuplot, const std::vector<Circle>& circles) {
    Columns columns(4);
    for (const Circle& circle : circles) {
        columns[0].push_back(circle.x);
        columns[1].push_back(circle.y);
        columns[2].push_back(circle.radius);
        columns[3].push_back(circle.color);
    }
    return gnuplot.data(columns);
}

/// The twelve edges of the box as three points (two and a gap) each; those behind the balls, or those before them.
std::string box_edges(Gnuplot& gnuplot, const sim::Box& box, const Projection& view, bool behind) {
    Columns lines(2);
    const auto add = [&](const Vec3& p) {
        lines[0].push_back(dot(p, view.right));
        lines[1].push_back(dot(p, view.up));
    };
    const auto corner = [&](unsigned bits) {
        Vec3 p = box.origin;
        for (std::size_t k = 0; k < 3; ++k)
            if ((bits >> k & 1U) != 0) p[k] += box.lengths[k];
        return p;
    };
    // The view comes from +x, -y, +z: the far corner is (low x, high y, low z), and the edges there are hidden.
    constexpr unsigned kFarCorner = 0b010;
    for (unsigned bits = 0; bits < 8; ++bits)
        for (unsigned k = 0; k < 3; ++k) {
            if ((bits >> k & 1U) != 0) continue;
            const unsigned other = bits | 1U << k;
            if ((bits == kFarCorner || other == kFarCorner) != behind) continue;
            add(corner(bits));
            add(corner(other));
            lines[0].push_back(std::nan(""));
            lines[1].push_back(std::nan(""));
        }
    return gnuplot.data(lines);
}

std::string color_bar(const ColorScale& scale) {
    std::string text = fmt::format("set cbrange [{:.9g}:{:.9g}]\nset cblabel {} offset 0.5,0\n", scale.low, scale.high,
                                   gnuplot_text(scale.label));
    text += "set cbtics scale 0.5\n";
    if (scale.logarithmic) text += "set logscale cb\nset format cb '10^{%L}'\nset cbtics 10\n";
    return text;
}

std::string caption(const sim::Frame& frame) {
    std::string text = fmt::format("τ = {:.4g},  {} bubbles", frame.time, frame.points.size());
    if (const auto fraction = measure::find_value(measure::measure_frame(frame), "gas_fraction"))
        text = fmt::format("φ = {:.3g},  ", *fraction) + text;
    return text;
}

void check(const sim::Frame& frame) {
    if (frame.points.empty() || frame.points.radius.size() != frame.points.size())
        throw InputError("the frame holds no bubbles to draw");
    if (!frame.box) throw InputError("the frame has no box to draw the bubbles in");
}

bool within(const sim::Box& box, const Circle& circle) {
    const double x = circle.x - box.origin[0];
    const double y = circle.y - box.origin[1];
    return x >= 0.0 && x <= box.lengths[0] && y >= 0.0 && y <= box.lengths[1];
}

/// gnuplot draws no circle of a plot whose center lies outside the axes; circles that are objects it does, and cuts
/// them off at the border.
std::string overhanging_circles(const sim::Box& box, const std::vector<Circle>& circles, const std::string& rim) {
    std::string script;
    for (const Circle& circle : circles)
        if (!within(box, circle))
            script += fmt::format("set object circle at {:.9g},{:.9g} size first {:.9g} fc rgb '#{:06x}' {} clip back\n",
                                  circle.x, circle.y, circle.radius, static_cast<unsigned>(circle.color), rim);
    return script;
}

Panel flat_panel(Gnuplot& gnuplot, const sim::Frame& frame, const ColorScale& scale) {
    const sim::Box& box = *frame.box;
    const std::vector<Circle> circles = flat_circles(frame, scale);
    // Rims tell touching discs apart, where discs are large enough to have one.
    constexpr std::size_t kMostWithRims = 20000;
    const std::string rim =
        circles.size() <= kMostWithRims
            ? fmt::format("lw {:.2g} fs solid 1 border lc rgb '#202020'", circles.size() < 3000 ? 0.5 : 0.25)
            : "fs solid 1 noborder";
    std::string script = panel_style() + color_bar(scale);
    script += fmt::format("set xrange [{:.9g}:{:.9g}]\nset yrange [{:.9g}:{:.9g}]\nset size ratio -1\n", box.origin[0],
                          box.origin[0] + box.lengths[0], box.origin[1], box.origin[1] + box.lengths[1]);
    script += overhanging_circles(box, circles, rim);
    script += fmt::format("set title {} noenhanced offset 0,-0.4\n", gnuplot_text(caption(frame)));
    script += "set tics out\nset xlabel '{/:Italic x}'\nset ylabel '{/:Italic y}'\nset border front\nunset key\n";
    script += fmt::format(
        "plot {} using 1:2:3:4 with circles lc rgb variable {}, "
        "NaN with points palette\n",
        circle_data(gnuplot, circles), rim);
    return {"snapshot", script, 1.15 * std::min(2.0, box.lengths[0] / box.lengths[1])};
}

Panel projected_panel(Gnuplot& gnuplot, const sim::Frame& frame, const ColorScale& scale) {
    const Projection view = Projection::oblique();
    const std::vector<Circle> circles = lit_balls(ball_circles(frame, scale, view));
    std::string script = panel_style() + color_bar(scale);
    script += fmt::format("set title {} noenhanced offset 0,-0.4\n", gnuplot_text(caption(frame)));
    script +=
        "set size ratio -1\nunset border\nunset tics\nset cbtics\nunset key\nset offsets graph 0.03,0.03,0.03,0.03\n";
    const std::string line = "using 1:2 with lines lc rgb '#555555' lw 0.6";
    script += fmt::format(
        "plot {} {}, {} using 1:2:3:4 with circles lc rgb variable fs solid 1 noborder, {} {}, "
        "NaN with points palette\n",
        box_edges(gnuplot, *frame.box, view, true), line, circle_data(gnuplot, circles),
        box_edges(gnuplot, *frame.box, view, false), line);
    return {"snapshot", script, 1.15};
}

}  // namespace

Panel snapshot_panel(Gnuplot& gnuplot, const sim::Frame& frame, ColorBy color_by) {
    check(frame);
    const ColorScale scale = color_scale(frame, color_by);
    return frame.box->dimension == 2 ? flat_panel(gnuplot, frame, scale) : projected_panel(gnuplot, frame, scale);
}

}  // namespace lamella::app
