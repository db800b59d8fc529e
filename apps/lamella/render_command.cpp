#include "lamella/core/build_info.h"
#include "lamella/core/error.h"
#include "lamella/core/parallel.h"
#include "lamella/core/units.h"
#include "lamella/io/atomic_file.h"
#include "lamella/render/periodic_images.h"
#include "lamella/render/picture.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "command_line.h"
#include "commands.h"
#include "external_program.h"
#include "picture_source.h"
#include "progress_display.h"
#include "signals.h"
#include <charconv>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
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
    std::string format = "png";
    double rate = 30.0;
    int images = 2;
    int bits = 8;
    int threads = 0;
    std::string progress;
    render::PictureOptions picture;
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
    for (const auto& [part, target] :
         {std::pair(text.substr(0, x), &picture->width), {text.substr(x + 1), &picture->height}}) {
        const double value = number(part, what);
        if (value < 1.0 || value != std::floor(value) || value > 16384.0)
            throw InputError(what + ", each at most 16384");
        *target = static_cast<std::size_t>(value);
    }
}

std::vector<double> numbers(const std::string& text, const std::string& what) {
    std::vector<double> values;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        values.push_back(number(std::string_view(text).substr(begin, end - begin), what));
        begin = end + 1;
    }
    return values;
}

/// "-60,20" or "-60,20,1.5": azimuth and elevation [deg], zoom.
void read_camera(const std::string& text, render::View* view) {
    const std::string what = fmt::format("--camera {} is not AZIMUTH,ELEVATION[,ZOOM] such as -60,20", text);
    const std::vector<double> values = numbers(text, what);
    if (values.size() < 2 || values.size() > 3) throw InputError(what);
    view->azimuth_deg = values[0];
    view->elevation_deg = values[1];
    if (values.size() == 3) view->zoom = values[2];
}

/// The frame as it is drawn: films in a periodic box with their images.
sim::Frame shown_frame(const PictureSource& source, std::size_t index, const RenderOptions& options) {
    return render::periodic_images(source.frame(index), options.images);
}

/// One camera and one color scale for a whole sequence: everything fits, and a color means the same in all of it.
void share_view(const PictureSource& source, const std::vector<std::size_t>& chosen, RenderOptions* options) {
    render::PictureOptions* const picture = &options->picture;
    for (const std::size_t index : chosen) {
        const sim::Frame frame = shown_frame(source, index, *options);
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

/// What a picture shows and how it was made, for the file beside it.
nlohmann::ordered_json notes_on(const fs::path& path,
                                const sim::Frame& frame,
                                const render::Picture& picture,
                                const RenderOptions& options) {
    const render::PictureOptions& o = options.picture;
    nlohmann::ordered_json notes{
        {"picture", path.filename().string()},
        {"lamella", build_info().version},
        {"source", options.source},
        {"solver", frame.solver},
        {"time", frame.time},
        {"time_unit", frame.time_unit},
        {"thickness", picture.thickness_origin},
        {"width", o.width},
        {"height", o.height},
        {"samples", o.samples},
        {"seed", o.seed},
        {"environment", o.environment},
        {"background", o.background},
        {"ground", o.ground},
        {"exposure", o.exposure},
        {"camera",
         {{"azimuth_deg", o.view.azimuth_deg}, {"elevation_deg", o.view.elevation_deg}, {"zoom", o.view.zoom}}}};
    if (picture.scale)
        notes["field"] = {{"name", picture.scale->name},
                          {"unit", picture.scale->unit},
                          {"low", picture.scale->low},
                          {"high", picture.scale->high}};
    return notes;
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
        {"ffmpeg",
         "-nostdin",
         "-loglevel",
         "error",
         "-y",
         "-framerate",
         fmt::format("{:g}", options.rate),
         "-i",
         (folder / "%06d.png").string(),
         "-vf",
         "pad=ceil(iw/2)*2:ceil(ih/2)*2",
         "-c:v",
         "libx264",
         "-crf",
         "16",
         "-pix_fmt",
         "yuv420p",
         "-movflags",
         "+faststart",
         unfinished.string()},
        messages,
        fmt::format(
            "ffmpeg is needed for a film and is not on the PATH (Debian: apt install ffmpeg); the pictures are in {}",
            folder.string()));
    if (status != 0)
        throw IoError(fmt::format("ffmpeg could not make {}: {}; the pictures are in {}", options.video,
                                  last_line(messages), folder.string()));
    fs::rename(unfinished, video);
    fs::remove(messages);
}

ProgressStyle progress_style(const std::string& name) {
    if (name == "none") return ProgressStyle::kNone;
    if (name == "plain") return ProgressStyle::kPlain;
    if (name == "bar") return ProgressStyle::kBar;
    return ::isatty(STDERR_FILENO) != 0 ? ProgressStyle::kBar : ProgressStyle::kPlain;
}

/// Reads the options that are more than a number; what the camera sees by default depends on the first frame.
void complete(const PictureSource& source, const std::vector<std::size_t>& chosen, RenderOptions* options) {
    render::PictureOptions& picture = options->picture;
    read_size(options->size, &picture);
    if (!options->thickness.empty()) picture.thickness = parse_quantity(options->thickness, "m");
    if (!options->video.empty() && fs::path(options->video).extension() != ".mp4")
        throw InputError(fmt::format("{}: a film ends in .mp4", options->video));
    const auto width = static_cast<double>(picture.width), height = static_cast<double>(picture.height);
    const double legend = picture.field.empty() ? 0.0 : 0.22;  // of the width
    const double shorter = std::min(width, height);
    picture.view = render::usual_view(source.frame(chosen[0]), {{(1.0 - legend) * width / shorter, height / shorter}});
    picture.view.shift = 0.5 * legend;
    if (!options->camera.empty()) read_camera(options->camera, &picture.view);
    if (options->frame == "all") share_view(source, chosen, options);
}

/// The file of each chosen frame.
std::vector<fs::path> picture_files(const PictureSource& source,
                                    const std::vector<std::size_t>& chosen,
                                    const RenderOptions& options) {
    if (options.frame != "all" && !options.out.empty()) {
        check_suffix(options.out);
        return {options.out};
    }
    const fs::path folder = options.out.empty() ? source.default_folder() : fs::path(options.out);
    if (folder.extension() == ".png" || folder.extension() == ".exr")
        throw InputError(
            fmt::format("{}: pictures of several frames go into a folder; --frame chooses one", options.out));
    if (options.format == "exr" && !options.video.empty())
        throw InputError("a film is made of .png pictures, not of .exr");
    std::vector<fs::path> files;
    for (const std::size_t index : chosen)
        files.push_back(folder / (source.picture_name(index) + "." + options.format));
    check_suffix(files[0]);
    return files;
}

void render_sequence(RenderOptions options) {
    if (!render::can_render())
        throw InputError(
            "this lamella was built without Embree, which pictures need; install libembree-dev and build again");
    if (!options.video.empty()) options.frame = "all";
    const PictureSource source(options.source);
    const std::vector<std::size_t> chosen = source.chosen(options.frame);
    complete(source, chosen, &options);
    const std::vector<fs::path> files = picture_files(source, chosen, options);
    const fs::path folder = files[0].parent_path();
    if (!folder.empty()) fs::create_directories(folder);

    const ThreadLimit threads(options.threads);
    ProgressDisplay display(progress_style(options.progress));
    nlohmann::ordered_json notes = nlohmann::ordered_json::array();
    for (std::size_t k = 0; k < chosen.size(); ++k) {
        const auto show = [&](double fraction) {
            if (stop_signal() != 0) throw Interrupted();
            run::RunProgress progress;
            progress.stage = chosen.size() == 1 ? "picture" : fmt::format("{} pictures", chosen.size());
            progress.fraction = (static_cast<double>(k) + fraction) / static_cast<double>(chosen.size());
            display.show(progress);
        };
        const sim::Frame frame = shown_frame(source, chosen[k], options);
        const render::Picture picture = render::render_frame(frame, options.picture, show);
        write_picture(files[k], picture, options);
        notes.push_back(notes_on(files[k], frame, picture, options));
    }
    display.clear();
    const bool one = chosen.size() == 1;
    const fs::path beside = one ? fs::path(files[0]).replace_extension(".json") : folder / "pictures.json";
    io::write_file_atomically(
        beside, (one ? notes[0] : notes).dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
    if (!options.video.empty()) make_video(folder, options);
    fmt::print(stderr, "{}\n",
               !options.video.empty() ? options.video
               : one                  ? files[0].string()
                                      : fmt::format("{} pictures in {}", files.size(), folder.string()));
}

}  // namespace

void add_render_command(CLI::App& app, int& exit_code) {
    CLI::App* command = add_command(
        app, "render", "Make pictures of frames by following rays of light",
        "  lamella render foam                                        RUN/pictures/000060.png, the last frame\n"
        "  lamella render foam --size 1920x1080 --samples 64 --out foam.png\n"
        "  lamella render foam --video foam.mp4                       all frames as a film (needs ffmpeg)\n"
        "  lamella render foam --field velocity --camera 30,45        colored by a field, from elsewhere\n"
        "  lamella render foam --background transparent --out a.exr   for further work\n");
    auto options = std::make_shared<RenderOptions>();
    render::PictureOptions& picture = options->picture;
    command
        ->add_option("source", options->source,
                     "Run folder; a frame (.vtp) or films (.ply, .obj, .fe); or a scene, of which the start is drawn")
        ->required()
        ->type_name("RUN|FILE|SCENE");
    command->add_option("--frame", options->frame, "A number, last or all")->type_name("N|last|all");
    command->add_option("--size", options->size, "In pixels; by default 960x720")->type_name("WxH");
    command->add_option("--samples", picture.samples, "Rays per pixel; by default 16, noise falls with the root of it")
        ->type_name("N");
    command
        ->add_option("--out", options->out,
                     "Picture (.png, .exr) of one frame, folder of several; by default RUN/pictures")
        ->type_name("PATH");
    command->add_option("--format", options->format, "Of pictures that get their names by themselves: png or exr")
        ->check(CLI::IsMember({"png", "exr"}))
        ->type_name("NAME");
    command->add_option("--video", options->video, "Join all frames into a film")->type_name("FILE.mp4");
    command->add_option("--rate", options->rate, "Of the film, pictures per second; by default 30")
        ->check(CLI::Range(0.1, 1000.0))
        ->type_name("R");
    command->add_option("--field", picture.field, "Color films or balls by this field, with a legend")
        ->type_name("NAME");
    command
        ->add_option("--camera", options->camera,
                     "Where it stands, in degrees, and how near; by default -62,16,1; flat things are seen from above")
        ->type_name("AZIMUTH,ELEVATION[,ZOOM]");
    command->add_option("--background", picture.background, "dark, light, transparent, environment, or a color")
        ->type_name("NAME|#RRGGBB");
    command
        ->add_option("--environment", picture.environment,
                     "Light: studio, window, daylight, gray, or a picture of light")
        ->type_name("NAME|FILE.hdr|FILE.exr");
    command->add_flag("--ground", picture.ground, "A polished table under everything");
    command
        ->add_option(
            "--thickness", options->thickness,
            "Of all films, e.g. \"350 nm\". By default the frame's; films of which it is not known are drawn as if "
            "they had drained for a while: thin above, thick below (assumed; the .json beside the picture says so)")
        ->type_name("LENGTH");
    command->add_option("--borders", picture.border_width, "Width of Plateau borders and wires, 1 as usual, 0 none")
        ->type_name("F");
    command->add_option("--images", options->images, "Of films in a periodic box, along each axis; by default 2")
        ->check(CLI::Range(1, 8))
        ->type_name("N");
    command->add_option("--exposure", picture.exposure, "Multiplies all light; by default 1")->type_name("F");
    command->add_option("--seed", picture.seed, "Of the noise")->type_name("N");
    command->add_option("--bits", options->bits, "Per channel of a .png: 8 or 16")
        ->check(CLI::IsMember({8, 16}))
        ->type_name("N");
    command->add_option("--threads", options->threads, "0: as many as there are cores")
        ->check(CLI::Range(0, 4096))
        ->type_name("N");
    command->add_option("--progress", options->progress, "bar, plain or none")
        ->check(CLI::IsMember({"bar", "plain", "none"}))
        ->type_name("STYLE");
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
