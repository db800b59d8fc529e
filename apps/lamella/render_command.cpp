#include "lamella/core/error.h"
#include "lamella/core/parallel.h"
#include "lamella/core/units.h"
#include "lamella/io/atomic_file.h"
#include "lamella/io/mesh_files.h"
#include "lamella/render/picture.h"
#include "lamella/sim/film_surface.h"

#include <fmt/format.h>

#include "command_line.h"
#include "commands.h"
#include "external_program.h"
#include "frame_source.h"
#include "progress_display.h"
#include "signals.h"
#include <charconv>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <unistd.h>
#include <vector>

namespace lamella::app {
namespace {

namespace fs = std::filesystem;

struct RenderOptions {
    std::string source;
    std::string frame = "last";
    std::string size = "960x720";
    std::string camera;
    std::string thickness;
    std::string out;
    std::string video;
    double rate = 30.0;
    int bits = 8;
    int threads = 0;
    std::string progress;
    render::PictureOptions picture;
};

/// The frames of a run, or the one that a file holds.
class Frames {
public:
    explicit Frames(const std::string& source) {
        const fs::path path(source);
        if (fs::is_directory(path)) run_.emplace(path);
        else if (!fs::exists(path)) throw InputError(fmt::format("{}: there is no such run folder or file", source));
        else if (path.extension() == ".vtp") single_ = io::read_vtp(path);
        else if (io::is_film_file(path)) single_.surface = sim::film_surface(io::read_films(path).mesh);
        else throw InputError(fmt::format("{}: a run folder, or a .vtp, .ply, .obj or .fe file is expected", source));
    }

    /// @param text  a number, last or all
    std::vector<std::size_t> chosen(const std::string& text) const {
        if (!run_) {
            if (text != "last" && text != "all" && text != "0") throw InputError(fmt::format("a file has frame 0 only, no {}", text));
            return {0};
        }
        if (text != "all") return {run_->frame_index(text)};
        std::vector<std::size_t> all(run_->frames().size());
        for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
        if (all.empty()) throw InputError(fmt::format("{} has no frames", run_->folder().string()));
        return all;
    }
    sim::Frame frame(std::size_t index) const { return run_ ? run_->frame(index) : single_; }
    fs::path default_folder() const { return run_ ? run_->folder() / "pictures" : fs::path("."); }

private:
    std::optional<RunReader> run_;
    sim::Frame single_;
};

double number(std::string_view text, const std::string& what) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) throw InputError(what);
    return value;
}

/// "1920x1080"
void read_size(const std::string& text, render::PictureOptions* picture) {
    const std::string what = fmt::format("--size {} is no size such as 1920x1080", text);
    const std::size_t x = text.find('x');
    if (x == std::string::npos) throw InputError(what);
    for (const auto& [part, target] : {std::pair(text.substr(0, x), &picture->width), {text.substr(x + 1), &picture->height}}) {
        const double value = number(part, what);
        if (value < 1.0 || value != std::floor(value) || value > 16384.0) throw InputError(what + ", each at most 16384");
        *target = static_cast<std::size_t>(value);
    }
}

/// "-60,20" or "-60,20,1.5": azimuth and elevation [deg], zoom.
void read_camera(const std::string& text, render::View* view) {
    const std::string what = fmt::format("--camera {} is not AZIMUTH,ELEVATION[,ZOOM] such as -60,20", text);
    std::vector<double> values;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        values.push_back(number(std::string_view(text).substr(begin, end - begin), what));
        begin = end + 1;
    }
    if (values.size() < 2 || values.size() > 3) throw InputError(what);
    view->azimuth_deg = values[0];
    view->elevation_deg = values[1];
    if (values.size() == 3) view->zoom = values[2];
}

/// What is flat is looked at from above, unless the camera is told otherwise.
bool is_flat(const sim::Frame& frame) { return frame.box && frame.box->dimension == 2; }

/// One camera and one color scale for a whole sequence: everything fits, and a color means the same in all of it.
void share_view(const Frames& frames, const std::vector<std::size_t>& chosen, render::PictureOptions* picture) {
    for (const std::size_t index : chosen) {
        const sim::Frame frame = frames.frame(index);
        if (frame.surface.triangles.empty() && frame.points.empty()) continue;  // all burst
        const render::Bounds bounds = render::frame_bounds(frame);
        picture->bounds = picture->bounds ? render::joined(*picture->bounds, bounds) : bounds;
        if (picture->field.empty()) continue;
        const render::ColorScale scale = render::field_scale(frame, picture->field);
        if (!picture->scale) picture->scale = scale;
        picture->scale->low = std::min(picture->scale->low, scale.low);
        picture->scale->high = std::max(picture->scale->high, scale.high);
        picture->scale->diverging = picture->scale->diverging || scale.diverging;
    }
    if (picture->scale && picture->scale->diverging) {
        picture->scale->high = std::max(-picture->scale->low, picture->scale->high);
        picture->scale->low = -picture->scale->high;
    }
}

void write_picture(const fs::path& path, const render::Picture& picture, const RenderOptions& options) {
    const bool transparent = options.picture.background == "transparent";
    if (path.extension() == ".exr") return io::write_file_atomically(path, io::exr_bytes(picture.light));
    io::write_file_atomically(path, io::png_bytes(render::develop(picture).raster(options.bits, transparent ? 4 : 3)));
}

void check_suffix(const fs::path& path) {
    if (path.extension() != ".png" && path.extension() != ".exr")
        throw InputError(fmt::format("{}: a picture ends in .png or .exr", path.string()));
    if (path.extension() == ".exr" && !io::has_exr()) io::exr_bytes({});  // says what is missing
}

/// Joins 000000.png, 000001.png, ... of a folder into a film.
void make_video(const fs::path& folder, const RenderOptions& options) {
    const fs::path video(options.video), unfinished = video.string() + ".part.mp4", messages = folder / "ffmpeg.log";
    const int status = run_external(
        {"ffmpeg", "-nostdin", "-loglevel", "error", "-y", "-framerate", fmt::format("{:g}", options.rate), "-i",
         (folder / "%06d.png").string(), "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-c:v", "libx264", "-crf", "16", "-pix_fmt",
         "yuv420p", "-movflags", "+faststart", unfinished.string()},
        messages,
        fmt::format("ffmpeg is needed for a film and is not on the PATH (Debian: apt install ffmpeg); the pictures are in {}",
                    folder.string()));
    if (status != 0) throw IoError(fmt::format("ffmpeg could not make {}: {}; the pictures are in {}", options.video, last_line(messages), folder.string()));
    fs::rename(unfinished, video);
    fs::remove(messages);
}

ProgressStyle progress_style(const std::string& name) {
    if (name == "none") return ProgressStyle::kNone;
    if (name == "plain") return ProgressStyle::kPlain;
    if (name == "bar") return ProgressStyle::kBar;
    return ::isatty(STDERR_FILENO) != 0 ? ProgressStyle::kBar : ProgressStyle::kPlain;
}

void render_sequence(RenderOptions options) {
    if (!render::can_render())
        throw InputError("this lamella was built without Embree, which pictures need; install libembree-dev and build again");
    const bool video = !options.video.empty();
    if (video) options.frame = "all";
    const Frames frames(options.source);
    const std::vector<std::size_t> chosen = frames.chosen(options.frame);
    const bool one = options.frame != "all";
    read_size(options.size, &options.picture);
    if (!options.thickness.empty()) options.picture.thickness = parse_quantity(options.thickness, "m");
    if (one && !options.out.empty()) check_suffix(options.out);
    if (video && fs::path(options.video).extension() != ".mp4") throw InputError(fmt::format("{}: a film ends in .mp4", options.video));
    if (is_flat(frames.frame(chosen[0]))) options.picture.view = {.azimuth_deg = -90.0, .elevation_deg = 90.0, .zoom = 1.3};
    if (!options.camera.empty()) read_camera(options.camera, &options.picture.view);
    if (!one) share_view(frames, chosen, &options.picture);

    const fs::path folder = one ? (options.out.empty() ? frames.default_folder() : fs::path(options.out).parent_path())
                                : (options.out.empty() ? frames.default_folder() : fs::path(options.out));
    if (!folder.empty()) fs::create_directories(folder);
    const ThreadLimit threads(options.threads);
    ProgressDisplay display(progress_style(options.progress));
    fs::path path;
    for (std::size_t k = 0; k < chosen.size(); ++k) {
        path = one && !options.out.empty() ? fs::path(options.out) : folder / fmt::format("{:06}.png", chosen[k]);
        const auto show = [&](double fraction) {
            if (stop_signal() != 0) throw Interrupted();
            run::RunProgress progress;
            progress.stage = chosen.size() == 1 ? "picture" : fmt::format("{} pictures", chosen.size());
            progress.fraction = (static_cast<double>(k) + fraction) / static_cast<double>(chosen.size());
            display.show(progress);
        };
        write_picture(path, render::render_frame(frames.frame(chosen[k]), options.picture, show), options);
    }
    display.clear();
    if (video) make_video(folder, options);
    fmt::print(stderr, "{}\n", video ? options.video : one ? path.string() : fmt::format("{} pictures in {}", chosen.size(), folder.string()));
}

}  // namespace

void add_render_command(CLI::App& app, int& exit_code) {
    CLI::App* command =
        add_command(app, "render", "Make pictures of frames by following rays of light",
                    "  lamella render foam                                        RUN/pictures/000060.png, the last frame\n"
                    "  lamella render foam --size 1920x1080 --samples 64 --out foam.png\n"
                    "  lamella render foam --video foam.mp4                       all frames as a film (needs ffmpeg)\n"
                    "  lamella render foam --field velocity --camera 30,45        colored by a field, from elsewhere\n"
                    "  lamella render foam --background transparent --out a.exr   for further work\n");
    auto options = std::make_shared<RenderOptions>();
    render::PictureOptions& picture = options->picture;
    command->add_option("source", options->source, "Run folder, or a frame (.vtp) or films (.ply, .obj, .fe)")->required()->type_name("RUN|FILE");
    command->add_option("--frame", options->frame, "A number, last or all")->type_name("N|last|all");
    command->add_option("--size", options->size, "In pixels; by default 960x720")->type_name("WxH");
    command->add_option("--samples", picture.samples, "Rays per pixel; by default 16, noise falls with the root of it")->type_name("N");
    command->add_option("--out", options->out, "Picture (.png, .exr) of one frame, folder of several; by default RUN/pictures")->type_name("PATH");
    command->add_option("--video", options->video, "Join all frames into a film")->type_name("FILE.mp4");
    command->add_option("--rate", options->rate, "Of the film, pictures per second; by default 30")->check(CLI::Range(0.1, 1000.0))->type_name("R");
    command->add_option("--field", picture.field, "Color films or balls by this field, with a legend")->type_name("NAME");
    command->add_option("--camera", options->camera, "Where it stands, in degrees, and how near; by default -62,16,1")->type_name("AZIMUTH,ELEVATION[,ZOOM]");
    command->add_option("--background", picture.background, "dark, light, transparent, environment, or a color")->type_name("NAME|#RRGGBB");
    command->add_option("--environment", picture.environment, "Light: studio, window, daylight, gray, or a picture of light")->type_name("NAME|FILE.hdr|FILE.exr");
    command->add_flag("--ground", picture.ground, "A polished table under everything");
    command->add_option("--thickness", options->thickness, "Of all films, e.g. \"350 nm\"; by default the frame's, or drained films")->type_name("LENGTH");
    command->add_option("--borders", picture.border_width, "Width of Plateau borders and wires, 1 as usual, 0 none")->type_name("F");
    command->add_option("--exposure", picture.exposure, "Multiplies all light; by default 1")->type_name("F");
    command->add_option("--seed", picture.seed, "Of the noise")->type_name("N");
    command->add_option("--bits", options->bits, "Per channel of a .png: 8 or 16")->check(CLI::IsMember({8, 16}))->type_name("N");
    command->add_option("--threads", options->threads, "0: as many as there are cores")->check(CLI::Range(0, 4096))->type_name("N");
    command->add_option("--progress", options->progress, "bar, plain or none")->check(CLI::IsMember({"bar", "plain", "none"}))->type_name("STYLE");
    command->callback([options, &exit_code] {
        catch_stop_signals();
        try {
            render_sequence(*options);
        } catch (const Interrupted&) {
            exit_code = 128 + stop_signal();
        } catch (const fs::filesystem_error& error) {
            throw IoError(fmt::format("{}: {}", error.path1().string(), error.code().message()));
        }
    });
}

}  // namespace lamella::app
