#include "lamella/solvers/bubble/system.h"

#include "lamella/core/parallel.h"
#include "lamella/dist/migration.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace lamella::bubble {

template <int D>
System<D>::System(const Options& options, Domain& domain)
    : model(Model::from(options)),
      options_(options),
      domain_(&domain),
      liquid_(options, model, foam.box),
      ownership_(domain) {}

template <int D>
void System<D>::prepare(LiquidMotion motion) {
    Options options = options_;
    if (motion == LiquidMotion::kAtRest) {
        options.flow.kind = FlowKind::kNone;
        options.drag = Drag::kBackground;
        options.wall_drag = 0.0;
    }
    liquid_ = Liquid<D>(options, model, foam.box);
}

template <int D>
double System<D>::mean_radius() const {
    const double sum = domain_->exact_sum(foam.slots, [&](std::size_t i) { return Shape<D>::radius(foam.size[i]); });
    return sum / static_cast<double>(std::max<std::size_t>(foam.live, 1));
}

template <int D>
double System<D>::total_size() const {
    return domain_->exact_sum(foam.slots, [&](std::size_t i) { return foam.size[i]; });
}

template <int D>
std::vector<Column*> System<D>::attached_in_use() const {
    std::vector<Column*> columns = attached;
    std::erase_if(columns, [](const Column* column) { return column->empty(); });
    return columns;
}

template <int D>
void System<D>::distribute() {
    if (!domain_->several()) return;
    dist::Communicator& processes = domain_->processes();
    ownership_.update(foam.box, foam.slots, [&] { return pointers<D>(foam.position); });
    std::vector<int> owner(foam.slots);
    parallel_for(foam.slots, [&](std::size_t i) {
        owner[i] = foam.alive(i) ? ownership_.owner(place(i)) : dist::Migration::kGone;
    });
    const dist::Migration migration(processes, owner);
    foam.slots = migration.count();
    const auto move = [&](auto& column) {
        column.reserve(std::max(column.size(), length()));  // resize() alone would take twice the room
        migration(column);
        column.resize(length());
    };
    Foam<D>::for_each_column(foam, [&](const std::string&, auto& column) { move(column); });
    for (Column* column : attached_in_use()) move(*column);
    ownership_.settle(foam.slots, foam.live);
}

template <int D>
Vec<D> System<D>::place(std::size_t i) const {
    Vec<D> x;
    for (std::size_t k = 0; k < D; ++k) x[k] = foam.position[k][i];
    return x;
}

template <int D>
std::vector<std::uint32_t> System<D>::live_slots() const {
    std::vector<std::uint32_t> slots;
    slots.reserve(foam.slots);
    for (std::size_t i = 0; i < foam.slots; ++i)
        if (foam.alive(i)) slots.push_back(static_cast<std::uint32_t>(i));
    return slots;
}

/// The other processes that own a place which a bubble may touch until the next rebuild get a copy of it.
template <int D>
dist::Halo System<D>::find_copies(const std::vector<std::uint32_t>& kept, double largest_radius) const {
    if (!domain_->several()) return {};
    dist::Communicator& processes = domain_->processes();
    std::vector<std::vector<std::uint32_t>> wanted(static_cast<std::size_t>(processes.size()));
    const dist::Part<D> part = ownership_.own_part();
    for (std::uint32_t n = 0; n < kept.size(); ++n) {
        const double reach = Shape<D>::radius(foam.size[kept[n]]) + largest_radius + skin_;
        const Vec<D> center = place(kept[n]);
        if (!part.holds_all_near(center, reach)) ownership_.want_copies(n, center, reach, wanted);
    }
    return {processes, std::move(wanted)};
}

/// Lists of the kept bubbles, in their order, and the copies that stand in them.
template <int D>
spatial::NeighborSearch<D> System<D>::search_neighbors(const std::vector<std::uint32_t>& kept, dist::Halo& halo) {
    Columns<D> position;
    Column radius(kept.size());
    AlignedVector<std::int64_t> id(kept.size());
    for (std::size_t k = 0; k < D; ++k) {
        position[k].resize(kept.size());
        parallel_for(kept.size(), [&](std::size_t i) { position[k][i] = foam.position[k][kept[i]]; });
    }
    parallel_for(kept.size(), [&](std::size_t i) {
        radius[i] = Shape<D>::radius(foam.size[kept[i]]);
        id[i] = foam.id[kept[i]];
    });
    const double largest = domain_->largest(parallel_max(kept.size(), 0.0, [&](std::size_t i) { return radius[i]; }));
    halo = find_copies(kept, largest);
    const auto append = [&](auto& column) {
        const auto copies = halo.fetch(std::span(std::as_const(column)));
        column.reserve(column.size() + copies.size());
        column.insert(column.end(), copies.begin(), copies.end());
    };
    for (auto& column : position) append(column);
    append(radius);
    append(id);
    return spatial::find_neighbors<D>(foam.box, pointers<D>(position), radius.data(), id.data(), radius.size(), skin_,
                                      {.count = halo.copies(), .largest_radius = largest});
}

template <int D>
void System<D>::release_scratch() {
    rates = {};
    for (Column* column : scratch) release(*column);
}

template <int D>
void System<D>::rebuild(double least_reach) {
    // What the new lists make obsolete makes room for what travels and for them; the vanished are dropped, so that the
    // search sees live bubbles only.
    release_scratch();
    stage = {};
    built_position_ = {};
    release(built_radius_);
    neighbors_ = {};
    distribute();
    const std::vector<std::uint32_t> kept = live_slots();
    skin_ = std::max(options_.integrator.skin * mean_radius(), 2.0 * least_reach);
    dist::Halo halo;
    auto search = search_neighbors(kept, halo);
    neighbors_ = std::move(search.list);
    const std::size_t length = spatial::padded(kept.size());
    std::vector<std::uint32_t> place(kept.size());
    parallel_for(kept.size(), [&](std::size_t i) {
        place[search.order[i]] = static_cast<std::uint32_t>(i);
        search.order[i] = kept[search.order[i]];
    });
    halo.renumber(place, length);
    domain_->set_halo(std::move(halo));

    Foam<D>::for_each_column(foam, [&](const std::string&, auto& column) { reorder(column, search.order, length); });
    for (Column* column : attached_in_use()) reorder(*column, search.order, length);
    foam.slots = kept.size();
    foam.live = static_cast<std::size_t>(domain_->sum(static_cast<std::int64_t>(kept.size())));
    stage.resize(length);
    stage_current();
    built_position_ = stage.position;
    built_radius_ = stage.radius;
    ++rebuilds_;
}

template <int D>
void System<D>::follow_images() {
    if (!neighbors_.has_images()) return;
    const double crossed = parallel_max(foam.slots, 0.0, [&](std::size_t i) {
        for (std::size_t k = 0; k < D; ++k) {
            const double moved = foam.position[k][i] - built_position_[k][i];
            if (foam.box.periodic[k] && std::abs(moved) > 0.5 * foam.box.lengths[k]) return 1.0;
        }
        return 0.0;
    });
    if (domain_->largest(crossed) > 0.0) rebuild();
}

template <int D>
void System<D>::refresh_copies() {
    std::array<Column*, D + 1> columns;
    for (std::size_t k = 0; k < D; ++k) columns[k] = &foam.position[k];
    columns[D] = &foam.size;
    domain_->refresh(columns);
}

template <int D>
double System<D>::expansion() const {
    const Vec<D> inverse = foam.box.inverse_lengths();
    return domain_->largest(parallel_max(foam.slots, 0.0, [&](std::size_t i) {
        if (!foam.alive(i)) return 0.0;
        double squared = 0.0;
        for (std::size_t k = 0; k < D; ++k) {
            const double s = foam.position[k][i] - built_position_[k][i];
            const double nearest_image = s - foam.box.lengths[k] * std::nearbyint(s * inverse[k]);
            squared += nearest_image * nearest_image;
        }
        return std::sqrt(squared) + Shape<D>::radius(foam.size[i]) - built_radius_[i];
    }));
}

template <int D>
void System<D>::stage_current() {
    parallel_for(length(), [&](std::size_t i) {
        for (std::size_t k = 0; k < D; ++k) stage.position[k][i] = foam.position[k][i];
        set_radius<D>(model, foam.size[i], foam.alive(i), stage.radius[i], stage.inverse_radius[i]);
    });
}

template <int D>
Evaluation System<D>::evaluate(Gas gas, Stiffness stiffness, double* also) {
    std::vector<Column*> read_by_neighbors;
    for (auto& column : stage.position) read_by_neighbors.push_back(&column);
    read_by_neighbors.push_back(&stage.radius);
    if (gas == Gas::kOn && model.exchanges_gas()) read_by_neighbors.push_back(&stage.inverse_radius);
    domain_->begin_refresh(read_by_neighbors);
    rates.resize(length());
    Evaluation evaluation =
        contact_pass<D>(model, foam.box, neighbors_, stage, gas, stiffness, *domain_, foam.live, rates, also);
    const double walls = liquid_.apply(neighbors_, stage, foam.velocity, *domain_, rates);
    if (stiffness == Stiffness::kBound) evaluation.stiffness += walls;
    return evaluation;
}

template <int D>
void System<D>::keep_rates(const GasExchange& gas) {
    const bool exchange = gas.film_factor > 0.0;
    parallel_for(length(), [&](std::size_t i) {
        for (std::size_t k = 0; k < D; ++k) foam.velocity[k][i] = rates.velocity[k][i];
        foam.size_rate[i] = exchange ? gas.size_rate(rates.film[i], rates.weight[i], stage.inverse_radius[i]) : 0.0;
    });
}

template class System<2>;
template class System<3>;

}  // namespace lamella::bubble
