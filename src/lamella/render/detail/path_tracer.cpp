#include "lamella/render/detail/path_tracer.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lamella::render::detail {
namespace {

using optics::Rgb;

constexpr double kWater = 1.333;
constexpr Rgb kSteel{{0.56, 0.57, 0.60}};

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
        point.normal[k] = static_cast<double>(w * films.normal[t[0]][k] + c.u * films.normal[t[1]][k] + c.v * films.normal[t[2]][k]);
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

}  // namespace

Seen PathTracer::look(const Vec3& origin, const Vec3& direction, const std::optional<Rgb>& background, SampleNumbers& numbers) {
    Seen seen;
    seen.light = follow({origin, direction, 0, true}, background, numbers, &seen);
    return seen;
}

Rgb PathTracer::follow(const Ray& ray, const std::optional<Rgb>& background, SampleNumbers& numbers, Seen* seen) {
    std::vector<FilmCrossing>& crossings = crossings_[static_cast<std::size_t>(ray.depth)];
    const ThingHit hit = stage_.rays->trace(ray.origin, ray.direction, &crossings);
    Rgb light, passed{{1.0, 1.0, 1.0}};
    std::vector<Mirror> mirrors;
    mirrors.reserve(crossings.size());
    for (const FilmCrossing& crossing : crossings) {
        const FilmPoint point = film_point(stage_.films, crossing);
        if (stage_.films_show_field) {
            light += kFieldOpacity * times(passed, field_film_light(stage_.scale->color(point.value), point.normal, ray.direction));
            passed = (1.0 - kFieldOpacity) * passed;
            continue;
        }
        const Rgb reflected = colors_.reflected(point.value, std::abs(dot(point.normal, ray.direction)));
        mirrors.push_back({ray.origin + static_cast<double>(crossing.distance) * ray.direction,
                           mirror(ray.direction, point.normal), times(passed, reflected)});
        passed = times(passed, Rgb{{1.0, 1.0, 1.0}} - reflected);
    }
    if (hit.thing != Thing::kNothing) light += times(passed, things_light(ray, hit, numbers));
    else if (!background || !ray.straight) light += times(passed, environment_.light(ray.direction));
    else light += times(passed, *background);
    if (seen != nullptr) {
        seen->empty = hit.thing == Thing::kNothing && crossings.empty();
        seen->alpha = hit.thing == Thing::kNothing ? 1.0 - optics::luminance(passed) : 1.0;
    }
    return light + mirrored_light(ray, mirrors, numbers);
}

/// The mirror images in the films along a ray: those of the first two that the camera sees are followed, one of the others is
/// drawn by its brightness.
Rgb PathTracer::mirrored_light(const Ray& ray, const std::vector<Mirror>& mirrors, SampleNumbers& numbers) {
    if (ray.depth >= kDeepest) return {};
    Rgb light;
    const auto follow_mirror = [&](const Mirror& m) {
        return follow({m.place, m.direction, ray.depth + 1, false}, std::nullopt, numbers, nullptr);
    };
    const std::size_t followed = ray.depth == 0 ? std::min<std::size_t>(2, mirrors.size()) : 0;
    for (std::size_t i = 0; i < followed; ++i) light += times(mirrors[i].weight, follow_mirror(mirrors[i]));
    const auto brightness = [](const Mirror& m) { return std::abs(m.weight[0]) + std::abs(m.weight[1]) + std::abs(m.weight[2]); };
    double sum = 0.0;
    for (std::size_t i = followed; i < mirrors.size(); ++i) sum += brightness(mirrors[i]);
    // Rays of mirror images are worth a tenth of their elders and are drawn less often; what is drawn counts for the rest.
    const double survival = ray.depth == 0 ? 1.0 : std::min(1.0, 1.5 * sum);
    double draw = numbers.next();
    if (sum == 0.0 || draw >= survival) return light;
    draw *= sum / survival;
    for (std::size_t i = followed; i < mirrors.size(); ++i) {
        const double own = brightness(mirrors[i]);
        draw -= own;
        if (draw < 0.0 || i + 1 == mirrors.size()) return light + sum / (own * survival) * times(mirrors[i].weight, follow_mirror(mirrors[i]));
    }
    return light;
}

Rgb PathTracer::things_light(const Ray& ray, const ThingHit& hit, SampleNumbers& numbers) {
    if (hit.thing == Thing::kBorder) return border_light(ray, hit, numbers);
    const Vec3 place = ray.origin + static_cast<double>(hit.distance) * ray.direction;
    const Vec3 shown = environment_.light(mirror(ray.direction, hit.normal));
    const double cosine = std::clamp(-dot(ray.direction, hit.normal), 0.0, 1.0);
    if (hit.thing == Thing::kWire) return 0.7 * times(kSteel, shown) + matte_light(place, hit.normal, 0.2 * kSteel, numbers);
    return matte_light(place, hit.normal, stage_.ball_color[hit.number], numbers) + 0.7 * water_reflectance(cosine) * shown;
}

/// Light that a matte surface throws back: one lamp is drawn, and seen or not.
Rgb PathTracer::matte_light(const Vec3& place, const Vec3& normal, const Rgb& color, SampleNumbers& numbers) const {
    const double a = numbers.next();
    const LightSample lamp = environment_.sample(a, numbers.next());
    const double cosine = dot(normal, lamp.direction);
    if (cosine <= 0.0 || stage_.rays->blocked(place + 1e-4 * normal, lamp.direction)) return {};
    return cosine / (std::numbers::pi * lamp.density) * times(color, lamp.light);
}

/// A Plateau border as a round thread of water: light is bent into it and out again, as in an endless cylinder, whose far side
/// lies where the chord ends. The mirror image on its surface is taken from the environment.
Rgb PathTracer::border_light(const Ray& ray, const ThingHit& hit, SampleNumbers& numbers) {
    const RayGeometry& geometry = stage_.rays->geometry();
    const auto& a = geometry.thread_points[geometry.thread_segments[hit.number]];
    const auto& b = geometry.thread_points[geometry.thread_segments[hit.number] + 1];
    Vec3 axis;
    for (std::size_t k = 0; k < 3; ++k) axis[k] = static_cast<double>(b[k]) - static_cast<double>(a[k]);
    axis *= 1.0 / std::max(norm(axis), 1e-12);
    Vec3 normal = hit.normal - dot(hit.normal, axis) * axis;
    normal *= 1.0 / std::max(norm(normal), 1e-12);
    const double cosine = -dot(ray.direction, normal);
    const Rgb shown = environment_.light(mirror(ray.direction, hit.normal));
    if (cosine <= 1e-3 || ray.depth >= kDeepest) return shown;
    const double reflected = water_reflectance(cosine);
    const double inside = std::sqrt(1.0 - (1.0 - cosine * cosine) / (kWater * kWater));
    const Vec3 bent = ray.direction / kWater + (cosine / kWater - inside) * normal;
    const Vec3 across = bent - dot(bent, axis) * axis;
    const double chord = 2.0 * static_cast<double>(a[3]) * -dot(bent, normal) / std::max(squared_norm(across), 1e-9);
    const Vec3 place = ray.origin + static_cast<double>(hit.distance) * ray.direction + chord * bent;
    // By symmetry the ray leaves as it came in: turned by the same angle about the far side's normal.
    Vec3 far = normal + chord / static_cast<double>(a[3]) * across;
    far *= 1.0 / std::max(norm(far), 1e-12);
    const double out = std::sqrt(std::max(0.0, 1.0 - kWater * kWater * (1.0 - inside * inside)));
    Vec3 leaving = kWater * bent + (out - kWater * inside) * far;
    leaving *= 1.0 / std::max(norm(leaving), 1e-12);
    const Rgb through = follow({place + 1e-4 * far, leaving, ray.depth + 1, false}, std::nullopt, numbers, nullptr);
    return reflected * shown + (1.0 - reflected) * (1.0 - reflected) * through;
}

}  // namespace lamella::render::detail
