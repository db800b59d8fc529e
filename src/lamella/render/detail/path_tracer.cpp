#include "lamella/render/detail/path_tracer.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lamella::render::detail {
namespace {

using optics::Rgb;

constexpr double kWater = 1.333;
constexpr Rgb kWhite{{1.0, 1.0, 1.0}};
constexpr Rgb kSteel{{0.33, 0.34, 0.36}};

Rgb times(const Rgb& a, const Rgb& b) { return {{a[0] * b[0], a[1] * b[1], a[2] * b[2]}}; }

Vec3 mirror(const Vec3& d, const Vec3& n) { return d - 2.0 * dot(d, n) * n; }

/// What one interface of water reflects, unpolarized.
double water_reflectance(double cosine) {
    const double inside = std::sqrt(1.0 - (1.0 - cosine * cosine) / (kWater * kWater));
    const double s = (cosine - kWater * inside) / (cosine + kWater * inside);
    const double p = (kWater * cosine - inside) / (kWater * cosine + inside);
    return 0.5 * (s * s + p * p);
}

struct FilmPoint {
    Vec3 normal;
    double value;
};

FilmPoint film_point(const FineFilms& films, const FilmCrossing& c) {
    const auto& t = films.triangles[c.triangle];
    const float w = 1.0F - c.u - c.v;
    FilmPoint point{};
    for (std::size_t k = 0; k < 3; ++k)
        point.normal[k] =
            static_cast<double>(w * films.normal[t[0]][k] + c.u * films.normal[t[1]][k] + c.v * films.normal[t[2]][k]);
    point.normal *= 1.0 / std::max(norm(point.normal), 1e-12);
    point.value = static_cast<double>(w * films.value[t[0]] + c.u * films.value[t[1]] + c.v * films.value[t[2]]);
    return point;
}

/// A film that shows a field: matte on both sides, lit from the camera's upper left, and a little transparent.
constexpr double kFieldOpacity = 0.86;

Rgb field_film_light(const Rgb& color, const Vec3& normal, const Vec3& direction) {
    const Vec3 n = dot(normal, direction) > 0.0 ? -normal : normal;
    const Vec3 lamp = Vec3{{-0.25, -0.2, 0.6}} - 0.85 * direction;
    const double lit = std::max(0.0, dot(n, lamp)) / norm(lamp);
    return (0.38 + 0.62 * lit) * color;
}

/// A direction above a surface, with a density of cosine / pi.
Vec3 facing_direction(const Vec3& normal, double a, double b) {
    const double z = 1.0 - 2.0 * a, around = 2.0 * std::numbers::pi * b, ring = std::sqrt(std::max(0.0, 1.0 - z * z));
    const Vec3 sum = normal + Vec3{{ring * std::cos(around), ring * std::sin(around), z}};
    const double length = norm(sum);
    return length > 1e-6 ? sum / length : normal;
}

}  // namespace

void PathTracer::look(const Vec3& origin, std::vector<CameraRay>& rays, std::vector<Seen>* seen) {
    seen->assign(rays.size(), {});
    rays_.clear();
    paths_.clear();
    for (std::size_t i = 0; i < rays.size(); ++i) {
        rays_.push_back({origin, rays[i].direction});
        paths_.push_back({kWhite, static_cast<std::uint32_t>(i), 0,
                          rays[i].background ? Behind::kBackground : Behind::kEnvironment});
    }
    for (int depth = 0; !rays_.empty(); ++depth) {
        next_rays_.clear();
        next_paths_.clear();
        stage_.rays->trace(rays_, depth == 0 ? Bundle::kAlike : Bundle::kMixed, &meetings_);
        for (std::size_t i = 0; i < rays_.size(); ++i) {
            const std::uint32_t from = paths_[i].camera_ray;
            shade({rays_[i], paths_[i], meetings_[i], rays[from], (*seen)[from]});
        }
        rays_.swap(next_rays_);
        paths_.swap(next_paths_);
    }
}

void PathTracer::send(const Shot& from, const RayStart& ray, const Rgb& weight, Behind behind) {
    if (from.path.depth >= kDeepest) return;
    next_rays_.push_back(ray);
    next_paths_.push_back({weight, from.path.camera_ray, from.path.depth + 1, behind});
}

/// What a ray that is no longer the camera's sees where it meets nothing.
Rgb PathTracer::far_light(const Vec3& direction) const {
    return stage_.ground && direction[2] < 0.0 ? stage_.ground->color : environment_.light(direction);
}

void PathTracer::shade(const Shot& shot) {
    if (stage_.ground) meet_ground(shot);
    const Rgb passed = cross_films(shot);
    const Rgb weight = times(shot.path.weight, passed);
    if (shot.path.depth == 0 && !shot.meeting.films.empty())
        shot.seen.alpha = std::clamp(1.0 - optics::luminance(passed), 0.0, 1.0);
    if (shot.meeting.thing.thing != Thing::kNothing) return show_thing(shot, weight);
    if (shot.path.behind == Behind::kBackground)
        shot.seen.light += times(weight, *shot.from.background);
    else if (shot.path.behind == Behind::kEnvironment)
        shot.seen.light += times(weight, far_light(shot.ray.direction));
}

/// Lets a ray that goes down end at the ground, unless something else is nearer.
void PathTracer::meet_ground(const Shot& shot) const {
    if (shot.ray.direction[2] >= 0.0) return;
    const auto distance = static_cast<float>((stage_.ground->height - shot.ray.origin[2]) / shot.ray.direction[2]);
    ThingHit& hit = shot.meeting.thing;
    if (distance <= 0.0F || (hit.thing != Thing::kNothing && distance > hit.distance)) return;
    hit = {Thing::kGround, distance, 0, {{0.0, 0.0, 1.0}}};
    std::erase_if(shot.meeting.films, [&](const FilmCrossing& c) { return c.distance >= distance; });
}

/// Adds what the films along a ray show; returns how much of what is behind them comes through.
Rgb PathTracer::cross_films(const Shot& shot) {
    Rgb passed = kWhite;
    std::size_t number = 0;
    for (const FilmCrossing& crossing : shot.meeting.films) {
        const FilmPoint point = film_point(stage_.films, crossing);
        if (stage_.films_show_field) {
            const Rgb shown = field_film_light(stage_.scale->color(point.value), point.normal, shot.ray.direction);
            shot.seen.light += kFieldOpacity * times(times(shot.path.weight, passed), shown);
            passed = (1.0 - kFieldOpacity) * passed;
            continue;
        }
        const Rgb reflected = colors_.reflected(point.value, std::abs(dot(point.normal, shot.ray.direction)));
        show_film(shot, crossing, number++, passed, reflected, point.normal);
        passed = times(passed, kWhite - reflected);
    }
    return passed;
}

/// E, and by lot a ray for L - E. A lot of the camera's first films comes from numbers that are even over the samples.
void PathTracer::show_film(const Shot& shot,
                           const FilmCrossing& crossing,
                           std::size_t number,
                           const Rgb& passed,
                           const Rgb& reflected,
                           const Vec3& normal) {
    const Rgb own = times(passed, reflected), weight = times(shot.path.weight, own);
    const Vec3 image = mirror(shot.ray.direction, normal);
    const Rgb far = far_light(image);
    shot.seen.light += times(weight, far);
    const bool first = shot.path.depth == 0;
    // What is in the way can take all of E: where a lamp is mirrored, (nearly) every ray looks.
    constexpr double kOwn = 3.5, kLamp = 1.3, kLater = 0.4;
    double eager = 0.0;
    for (std::size_t k = 0; k < 3; ++k) eager += std::abs(own[k]) * (kOwn + kLamp * far[k]) / 3.0;
    const double chance = std::min(1.0, (first ? 1.0 : kLater) * eager);
    const double lot = first && number < 2 ? shot.from.numbers.lot(number) : shot.from.numbers.next();
    if (lot >= chance || shot.path.depth >= kDeepest) return;
    shot.seen.light -= 1.0 / chance * times(weight, far);
    const Vec3 place = shot.ray.origin + static_cast<double>(crossing.distance) * shot.ray.direction;
    send(shot, {place, image}, 1.0 / chance * weight, Behind::kEnvironment);
}

void PathTracer::show_thing(const Shot& shot, const Rgb& weight) {
    const ThingHit& hit = shot.meeting.thing;
    if (hit.thing == Thing::kGround) return show_ground(shot, weight);
    if (shot.path.depth == 0) shot.seen.alpha = 1.0;
    if (hit.thing == Thing::kBorder) return show_border(shot, weight);
    const Vec3 place = shot.ray.origin + static_cast<double>(hit.distance) * shot.ray.direction;
    const Vec3 image = mirror(shot.ray.direction, hit.normal);
    if (hit.thing == Thing::kWire) {  // brushed: it shows what lies around the mirror image's direction
        const Rgb around = environment_.matte(image) / environment_.brightest_matte();
        shot.seen.light += times(weight, times(kSteel, around) + 0.02 * far_light(image));
        return;
    }
    const double cosine = std::clamp(-dot(shot.ray.direction, hit.normal), 0.0, 1.0);
    const Rgb color = times(stage_.ball_color[hit.number], matte_light(shot, place, hit.normal));
    shot.seen.light += times(weight, color + 0.5 * water_reflectance(cosine) * far_light(image));
}

/// Light that white matte paper throws back, so that it is at most white: lamps that are right for films, which reflect
/// four percent, would burn paper out. A little of it comes from everywhere.
Rgb PathTracer::matte_light(const Shot& shot, const Vec3& place, const Vec3& normal) const {
    constexpr double kEverywhere = 0.10;
    const double full = environment_.brightest_matte();
    const double open = openness(shot, place, normal);
    return (open * environment_.matte(normal) + kEverywhere * (0.4 + 0.6 * open) * full * kWhite) /
           ((1.0 + kEverywhere) * full);
}

/// How much of the light that could reach a matte surface does: of a few directions, some drawn where the environment
/// is bright and some where the surface faces, the share that nothing opaque blocks, by what they would bring. Between
/// 0 and 1 and exact where all or nothing is open; elsewhere its mean is off by a part that falls with the number of
/// directions.
double PathTracer::openness(const Shot& shot, const Vec3& place, const Vec3& normal) const {
    const bool first = shot.path.depth == 0;
    SampleNumbers& numbers = shot.from.numbers;
    const int directions = first && shot.meeting.thing.thing == Thing::kBall ? 6 : 2;
    double open = 0.0, all = 0.0;
    for (int i = 0; i < directions; ++i) {
        const double a = first && i < 2 ? numbers.lot(2 * static_cast<std::size_t>(i)) : numbers.next();
        const double b = first && i < 2 ? numbers.lot(2 * static_cast<std::size_t>(i) + 1) : numbers.next();
        const Vec3 direction = i % 2 == 0 ? environment_.sample(a, b).direction : facing_direction(normal, a, b);
        const double cosine = dot(normal, direction);
        if (cosine <= 0.0) continue;
        const double density = 0.5 * (environment_.density(direction) + cosine / std::numbers::pi);
        const double bring = optics::luminance(environment_.light(direction)) * cosine / density;
        all += bring;
        if (!stage_.rays->blocked(place + 1e-4 * normal, direction)) open += bring;
    }
    return all > 0.0 ? open / all : 1.0;
}

/// A Plateau border as a round thread of water: light is bent into it and out again, as in an endless cylinder, whose
/// far side lies where the chord ends. The mirror image on its surface is taken from the environment.
void PathTracer::show_border(const Shot& shot, const Rgb& weight) {
    const RayGeometry& geometry = stage_.rays->geometry();
    const ThingHit& hit = shot.meeting.thing;
    const Vec3& direction = shot.ray.direction;
    const auto& a = geometry.thread_points[geometry.thread_segments[hit.number]];
    const auto& b = geometry.thread_points[geometry.thread_segments[hit.number] + 1];
    Vec3 axis;
    for (std::size_t k = 0; k < 3; ++k) axis[k] = static_cast<double>(b[k]) - static_cast<double>(a[k]);
    axis *= 1.0 / std::max(norm(axis), 1e-12);
    Vec3 normal = hit.normal - dot(hit.normal, axis) * axis;
    normal *= 1.0 / std::max(norm(normal), 1e-12);
    const double cosine = -dot(direction, normal);
    const double reflected = cosine > 1e-3 ? water_reflectance(cosine) : 1.0;
    shot.seen.light += reflected * times(weight, far_light(mirror(direction, hit.normal)));
    if (reflected == 1.0) return;
    const double inside = std::sqrt(1.0 - (1.0 - cosine * cosine) / (kWater * kWater));
    const Vec3 bent = direction / kWater + (cosine / kWater - inside) * normal;
    const Vec3 across = bent - dot(bent, axis) * axis;
    const double radius = static_cast<double>(a[3]);
    const double chord = 2.0 * radius * -dot(bent, normal) / std::max(squared_norm(across), 1e-9);
    // By symmetry the ray leaves as it came in: turned by the same angle about the far side's normal.
    Vec3 far = normal + chord / radius * across;
    far *= 1.0 / std::max(norm(far), 1e-12);
    const double out = std::sqrt(std::max(0.0, 1.0 - kWater * kWater * (1.0 - inside * inside)));
    Vec3 leaving = kWater * bent + (out - kWater * inside) * far;
    leaving *= 1.0 / std::max(norm(leaving), 1e-12);
    const Vec3 place = shot.ray.origin + static_cast<double>(hit.distance) * direction + chord * bent + 1e-4 * far;
    send(shot, {place, leaving}, (1.0 - reflected) * (1.0 - reflected) * weight, Behind::kEnvironment);
}

/// A polished table without an edge: it has the background's color where nothing shades it, and mirrors what stands on
/// it (not the lamps, whose images would draw the table's outline), less and less with the distance.
void PathTracer::show_ground(const Shot& shot, const Rgb& weight) {
    const Vec3 up{{0.0, 0.0, 1.0}};
    const Vec3& direction = shot.ray.direction;
    const Vec3 place = shot.ray.origin + static_cast<double>(shot.meeting.thing.distance) * direction;
    const double away = place[0] * place[0] + place[1] * place[1];
    constexpr double kShaded = 9.0;  // shadows end three radii away
    const double open = away < kShaded ? 1.0 - (1.0 - away / kShaded) * (1.0 - openness(shot, place, up)) : 1.0;
    if (shot.path.depth == 0) shot.seen.alpha = 1.0 - open * (1.0 - shot.seen.alpha);
    const bool backdrop = shot.path.behind == Behind::kBackground;
    const Rgb color = backdrop                               ? *shot.from.background
                      : shot.path.behind == Behind::kNothing ? Rgb{}
                                                             : stage_.ground->color;
    shot.seen.light += open * times(weight, color);
    if (shot.path.depth > 1) return;
    const double fresnel = 0.05 + 0.95 * std::pow(std::clamp(1.0 + direction[2], 0.0, 1.0), 5.0);
    const double image = fresnel * std::exp(-0.25 * away);
    if (image > 1e-3) send(shot, {place + 1e-4 * up, mirror(direction, up)}, image * weight, Behind::kNothing);
}

}  // namespace lamella::render::detail
