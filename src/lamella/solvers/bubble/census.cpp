#include "lamella/solvers/bubble/census.h"

#include <cmath>

#include "lamella/core/fixed_sum.h"
#include "lamella/core/parallel.h"
#include "lamella/solvers/bubble/contact.h"

namespace lamella::bubble {

template <int D>
Census<D> take_census(System<D>& system, const Options& options) {
    system.refresh_copies();
    const Domain& domain = system.domain();
    const Foam<D>& foam = system.foam;
    const auto& neighbors = system.neighbors();
    const std::size_t length = system.length();
    const Vec<D> inverse = foam.box.inverse_lengths();
    const double stiffness = options.surface_tension;
    const double force_scale = system.model.energy_scale;

    Census<D> census;
    census.contacts.assign(length, 0);
    for (Column* column : {&census.energy, &census.energy_thesis, &census.pressure, &census.force, &census.free_surface})
        column->assign(length, 0.0);
    std::array<Column, static_cast<std::size_t>(D * D)> virial;
    for (Column& column : virial) column.assign(length, 0.0);

    parallel_for(foam.slots, [&](std::size_t i) {
        if (!foam.alive(i)) return;
        const double radius = Shape<D>::radius(foam.size[i]);
        double covered = 0.0;
        const std::size_t group = i / kLanes;
        for (std::uint64_t e = neighbors.group_start[group] + i % kLanes; e < neighbors.group_start[group + 1];
             e += kLanes) {
            const std::uint32_t j = neighbors.index[e];
            const double other = foam.alive(j) ? Shape<D>::radius(foam.size[j]) : 0.0;
            Vec<D> separation;
            for (std::size_t k = 0; k < D; ++k) {
                const double s = foam.position[k][i] - foam.position[k][j];
                const double image = neighbors.has_images() ? neighbors.image[k][e] : std::nearbyint(s * inverse[k]);
                separation[k] = s - foam.box.lengths[k] * image;
            }
            const double squared = squared_norm(separation);
            if (!touching(squared, radius, other)) continue;
            const Overlap<double> overlap(squared, radius, other);
            const double factor = force_scale * push(overlap);  // F = factor * separation
            ++census.contacts[i];
            covered += film_size<D>(squared, overlap, radius, other);
            census.energy[i] += force_scale * contact_energy(overlap);
            census.energy_thesis[i] += 0.5 * stiffness * overlap.depth() * overlap.depth();
            census.force[i] += factor * overlap.distance;
            census.pressure[i] += factor * squared;
            for (std::size_t a = 0; a < D; ++a)
                for (std::size_t b = 0; b < D; ++b)
                    virial[a * D + b][i] += factor * separation[a] * separation[b];
        }
        census.free_surface[i] = larger(1.0 - covered / Shape<D>::surface(radius), 0.0);
        census.pressure[i] /= 2.0 * D * Shape<D>::kVolume * foam.size[i];
    });

    // Every contact was met twice.
    const auto half_sum = [&](const Column& column) {
        return 0.5 * domain.exact_sum(foam.slots, [&](std::size_t i) { return column[i]; });
    };
    census.total_energy = half_sum(census.energy);
    census.total_energy_thesis = 2.0 * half_sum(census.energy_thesis);
    for (std::size_t c = 0; c < virial.size(); ++c) census.stress[c] = -half_sum(virial[c]) / foam.box.volume();
    const auto surface_sum = [&](bool free_only, bool by_radius) {
        return domain.exact_sum(foam.slots, [&](std::size_t i) {
            if (!foam.alive(i)) return 0.0;
            const double radius = Shape<D>::radius(foam.size[i]);
            const double surface = Shape<D>::surface(radius) * (free_only ? census.free_surface[i] : 1.0);
            return by_radius ? surface / radius : surface;
        });
    };
    const double free = surface_sum(true, false);
    census.mean_free_surface = free / surface_sum(false, false);
    census.critical_radius = free > 0.0 ? free / surface_sum(true, true) : 0.0;
    std::int64_t twice = 0;
    for (std::size_t i = 0; i < foam.slots; ++i) twice += census.contacts[i];
    twice = domain.sum(twice);
    census.total_contacts = twice / 2;
    if (twice > 0) census.mean_contact_force = half_sum(census.force) / static_cast<double>(census.total_contacts);
    return census;
}

template Census<2> take_census<2>(System<2>&, const Options&);
template Census<3> take_census<3>(System<3>&, const Options&);

}  // namespace lamella::bubble
