#include "lamella/solvers/bubble/system.h"

#include <algorithm>
#include <cmath>

#include "lamella/core/parallel.h"

namespace lamella::bubble {

template <int D>
System<D>::System(const Options& options, Domain& domain)
    : model(Model::from(options)), options_(options), domain_(&domain), liquid_(options, model, foam.box) {}

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
    const double sum = exact_sum(foam.slots, [&](std::size_t i) { return Shape<D>::radius(foam.size[i]); });
    return sum / static_cast<double>(std::max<std::size_t>(foam.live, 1));
}

template <int D>
double System<D>::total_size() const {
    return exact_sum(foam.slots, [&](std::size_t i) { return foam.size[i]; });
}

template <int D>
void System<D>::rebuild(double least_reach) {
    // Drop the vanished first: the search then sees live bubbles only.
    std::vector<std::uint32_t> kept;
    kept.reserve(foam.live);
    for (std::size_t i = 0; i < foam.slots; ++i)
        if (foam.alive(i)) kept.push_back(static_cast<std::uint32_t>(i));
    Columns<D> position = foam.position;
    Column radius(kept.size());
    std::vector<std::int64_t> id(kept.size());
    for (auto& column : position) reorder(column, kept, kept.size());
    parallel_for(kept.size(), [&](std::size_t i) {
        radius[i] = Shape<D>::radius(foam.size[kept[i]]);
        id[i] = foam.id[kept[i]];
    });

    skin_ = std::max(options_.integrator.skin * mean_radius(), 2.0 * least_reach);
    auto search = spatial::find_neighbors<D>(foam.box, pointers<D>(position), radius.data(), id.data(), kept.size(), skin_);
    neighbors_ = std::move(search.list);
    parallel_for(kept.size(), [&](std::size_t i) { search.order[i] = kept[search.order[i]]; });

    const std::size_t length = spatial::padded(kept.size());
    Foam<D>::for_each_column(foam, [&](const std::string&, auto& column) { reorder(column, search.order, length); });
    for (Column* column : attached)
        if (!column->empty()) reorder(*column, search.order, length);
    foam.slots = foam.live = kept.size();
    stage.resize(length);
    rates.resize(length);
    stage_current();
    built_position_ = stage.position;
    built_radius_ = stage.radius;
    ++rebuilds_;
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
Evaluation System<D>::evaluate(Gas gas, Stiffness stiffness) {
    for (auto& column : stage.position) {
        Column* const one[] = {&column};
        domain_->halo(one);
    }
    Evaluation evaluation =
        contact_pass<D>(model, foam.box, neighbors_, stage, gas, stiffness, *domain_, foam.live, rates);
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
