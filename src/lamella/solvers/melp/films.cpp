#include "lamella/solvers/melp/films.h"

#include "lamella/solvers/melp/flight.h"
#include "lamella/solvers/melp/loops.h"

#include <algorithm>

namespace lamella::melp {
namespace {

// Where hardly a fine particle reaches, a film of this share of the mean thickness keeps accelerations finite. It is
// not liquid: no total counts it.
constexpr double kThinnest = 0.05;

std::vector<double> region_areas(const Geometry& geometry, const CoarseParticles& coarse, std::size_t regions) {
    std::vector<double> area(regions, 0.0);
    for (std::size_t e = 0; e < coarse.size(); ++e)
        area[static_cast<std::size_t>(coarse.region[e])] += geometry.area[e];
    return area;
}

/// Where hardly a fine particle reaches there is no film to pull and to be pulled: the particle takes part in what its
/// neighbors do. With nothing on it the slope of surfactant around it and borders of black film threw it, at 85 m/s.
void fill_dry(const Geometry& geometry, Films& films) {
    std::vector<std::uint8_t> open = films.dry;  // 1: not filled yet
    for (bool any = true; any;) {                // inward from the edges of dry places
        any = false;
        const std::vector<std::uint8_t> before = open;
        for (std::size_t i = 0; i < films.size(); ++i) {
            if (before[i] == 0) continue;
            const std::optional<Vec3> along = mean_around(geometry, before, i, films.along);
            if (!along) continue;
            films.along[i] = *along - dot(*along, geometry.normal[i]) * geometry.normal[i];
            for (std::vector<double>* values : {&films.temperature, &films.pressing, &films.tension})
                (*values)[i] = *mean_around(geometry, before, i, *values);
            open[i] = 0;
            any = true;
        }
    }
}

}  // namespace

Films films_of(const Geometry& geometry,
               const CoarseParticles& coarse,
               const Gathered& gathered,
               const std::vector<EvenFilm>& even,
               const film::SurfactantLaw& law,
               const Heat& heat) {
    const std::size_t count = coarse.size();
    const std::vector<double> area = region_areas(geometry, coarse, even.size());
    std::vector<double> liquid(even.size(), 0.0);
    for (std::size_t e = 0; e < count; ++e)
        liquid[static_cast<std::size_t>(coarse.region[e])] += gathered.liquid_volume[e];
    std::vector<double> along_normal(count);
    for (std::size_t e = 0; e < count; ++e) along_normal[e] = dot(coarse.velocity[e], geometry.normal[e]);
    std::vector<Vec3> drift = Flight(geometry, coarse, geometry.area, even.size()).of(along_normal);
    for (std::size_t r = 0; r < even.size(); ++r)
        if (even[r].held) drift[r] = {};
    Films films;
    films.liquid_volume.resize(count);
    films.dry.resize(count);
    films.thickness.resize(count);
    films.seen_thickness.resize(count);
    films.concentration.resize(count);
    films.temperature.resize(count);
    films.pressing.resize(count);
    films.tension.resize(count);
    films.along.resize(count);
    for_each_particle(count, [&](std::size_t e) {
        const auto r = static_cast<std::size_t>(coarse.region[e]);
        const double a = geometry.area[e];
        const bool evenly = even[r].liquid_volume > 0.0;
        const double share = evenly ? a / area[r] : 0.0;
        const double volume = evenly ? share * even[r].liquid_volume : gathered.liquid_volume[e];
        const double thinnest = kThinnest * (evenly ? even[r].liquid_volume : liquid[r]) / area[r];
        films.dry[e] = volume < thinnest * a ? 1 : 0;
        films.liquid_volume[e] = std::max(volume, thinnest * a);
        films.thickness[e] = films.liquid_volume[e] / a;
        films.concentration[e] = (evenly ? share * even[r].surfactant : gathered.surfactant[e]) / a;
        films.temperature[e] = !evenly && volume > 0.0 ? gathered.heat[e] / volume : law.temperature;
        films.pressing[e] = films.concentration[e] * heat.pressure_factor(films.temperature[e]);
        films.tension[e] =
            evenly ? law.reference_tension : law.tension(films.pressing[e]) + heat.extra_tension(films.temperature[e]);
        films.seen_thickness[e] = volume > 0.0 && !evenly ? gathered.seen_volume[e] / volume : films.thickness[e];
        Vec3 u;
        if (evenly)
            u = drift[r];
        else if (volume > 0.0)
            u = gathered.momentum[e] / volume;
        films.along[e] = u - dot(u, geometry.normal[e]) * geometry.normal[e];
    });
    fill_dry(geometry, films);
    return films;
}

}  // namespace lamella::melp
