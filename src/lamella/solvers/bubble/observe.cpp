// What can be seen of a bubble foam: frames, scalars, the numbers of `lamella check`.

#include "lamella/core/fixed_sum.h"
#include "lamella/core/parallel.h"
#include "lamella/solvers/bubble/bubble_solver.h"
#include "lamella/solvers/bubble/census.h"
#include "lamella/solvers/bubble/process_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace lamella::bubble {
namespace {

/// The live bubbles of this process as they are stored.
template <int D>
class StoredOrder {
public:
    explicit StoredOrder(const Foam<D>& foam) {
        for (std::size_t i = 0; i < foam.slots; ++i)
            if (foam.alive(i)) slots_.push_back(static_cast<std::uint32_t>(i));
    }
    std::size_t count() const { return slots_.size(); }
    template <class Value>
    auto column(Value&& value) const {
        std::vector<std::decay_t<decltype(value(std::size_t{}))>> values(count());
        parallel_for(count(), [&](std::size_t n) { values[n] = value(slots_[n]); });
        return values;
    }

private:
    std::vector<std::uint32_t> slots_;
};

template <class Order, class Value>
sim::Field field(const char* name, int components, const Order& order, Value&& value) {
    sim::Field f{.name = name, .unit = "-", .components = components, .integer = false, .values = {}};
    if (components == 1) {
        f.values = order.column([&](std::size_t i) { return double(value(i, 0)); });
        return f;
    }
    const auto c = static_cast<std::size_t>(components);
    f.values.resize(c * order.count());
    for (std::size_t k = 0; k < c; ++k) {
        const std::vector<double> column = order.column([&](std::size_t i) { return double(value(i, k)); });
        parallel_for(order.count(), [&](std::size_t n) { f.values[c * n + k] = column[n]; });
    }
    return f;
}

/// Vectors have three components in two dimensions too; the third is 0.
template <int D>
double component(const Columns<D>& columns, std::size_t i, std::size_t k) {
    return k < D ? columns[k][i] : 0.0;
}

}  // namespace

/// The largest part of memory is taken here, so what is not needed any more is let go of at once.
template <int D>
template <class Order>
sim::Frame BubbleSolver<D>::frame_of(Census<D> census, const Order& order, bool all_fields) const {
    const Foam<D>& foam = system_->foam;
    const Vec<D> inverse = foam.box.inverse_lengths();
    sim::Frame frame;
    frame.solver = "bubble";
    frame.time = clock_.time;
    frame.time_unit = time_unit();
    frame.step = clock_.steps;
    frame.box.emplace();
    frame.box->dimension = D;
    for (std::size_t k = 0; k < D; ++k) {
        frame.box->lengths[k] = foam.box.lengths[k];
        frame.box->periodic[k] = foam.box.periodic[k];
    }
    frame.scalars = scalars_from(census);
    release(census.force);
    release(options_.compat.energy ? census.energy : census.energy_thesis);
    if (!all_fields)
        for (Column* column : {&census.energy, &census.energy_thesis, &census.pressure, &census.free_surface})
            release(*column);
    frame.points.length_unit = "-";

    auto& fields = frame.points.fields;
    const auto add = [&](const char* name, int components, auto&& value) -> sim::Field& {
        return fields.emplace_back(field(name, components, order, value));
    };
    using Index = std::size_t;
    const auto add_census = [&](const char* name, auto& column) -> sim::Field& {
        sim::Field& added = add(name, 1, [&](Index i, Index) { return static_cast<double>(column[i]); });
        release(column);
        return added;
    };
    add_census("contacts", census.contacts).integer = true;
    add("velocity", 3, [&](Index i, Index k) { return component<D>(foam.velocity, i, k); });
    add("path_length", 1, [&](Index i, Index) { return foam.path_length[i]; });
    add("displacement", 3, [&](Index i, Index k) {
        return k < D ? foam.position[k][i] + foam.wraps[k][i] * foam.box.lengths[k] - foam.start[k][i] : 0.0;
    });
    if (all_fields) {
        add_census("energy", options_.compat.energy ? census.energy_thesis : census.energy);
        add_census("pressure", census.pressure);
        add_census("free_surface", census.free_surface);
        census = {};
        add("id", 1, [&](Index i, Index) { return static_cast<double>(foam.id[i]); }).integer = true;
        add("radius_rate", 1, [&](Index i, Index) {
            const double r = Shape<D>::radius(foam.size[i]);
            return foam.size_rate[i] / (D == 2 ? 2.0 * r : 3.0 * r * r);
        });
        add("frame_displacement", 3, [&](Index i, Index k) {
            if (k >= D) return 0.0;
            const double s = foam.position[k][i] - foam.marked[k][i];
            return s - foam.box.lengths[k] * std::nearbyint(s * inverse[k]);
        });
    }
    frame.points.position = order.column([&](std::size_t i) {
        Vec3 x;
        for (std::size_t k = 0; k < D; ++k) x[k] = foam.position[k][i];
        return x;
    });
    frame.points.radius = order.column([&](std::size_t i) { return Shape<D>::radius(foam.size[i]); });
    return frame;
}

template <int D>
sim::Frame BubbleSolver<D>::frame() const {
    observe();
    system_->release_scratch();
    Census<D> census = take_census(*system_, options_);
    return frame_of(std::move(census), id_order(), true);
}

template <int D>
sim::Frame BubbleSolver<D>::measured_frame() const {
    observe();
    system_->release_scratch();
    Census<D> census = take_census(*system_, options_);
    return frame_of(std::move(census), StoredOrder<D>(system_->foam), false);
}

template <int D>
std::vector<sim::Scalar> BubbleSolver<D>::scalars() const {
    observe();
    return scalars_from(take_census(*system_, options_));
}

template <int D>
std::vector<sim::Scalar> BubbleSolver<D>::scalars_from(const Census<D>& census) const {
    const Model& model = system_->model;
    std::vector<sim::Scalar> list = {
        {"scaled_time", "-", clock_.mechanical_time * model.scaled_time_rate(), "tau = K t/<R_in>^2"},
        {"mechanical_time", "-", clock_.mechanical_time, "t, in units of the scene"},
        {"initial_mean_radius", "-", model.initial_mean_radius, "mean radius at the start"},
        {"energy", "-", options_.compat.energy ? census.total_energy_thesis : census.total_energy,
         options_.compat.energy ? "sigma_0 sum (S - d)^2, eq. 3.2" : "contact energy, the potential of the forces"},
        {"energy_thesis", "-", census.total_energy_thesis, "sigma_0 sum (S - d)^2, eq. 3.2"},
        {"volume_error", "-", system_->total_size() / start_gas_ - 1.0, "total gas relative to the start, minus 1"},
        {"critical_radius", "-", census.critical_radius, "rho of eq. 2.28: smaller free bubbles shrink"},
        {"free_surface", "-", census.mean_free_surface, "<A^f>/<A>"},
    };
    static constexpr const char* kAxes = "xyz";
    double trace = 0.0;
    for (std::size_t a = 0; a < D; ++a) {
        trace += census.stress[a * D + a];
        for (std::size_t b = a; b < D; ++b)
            list.push_back({fmt::format("stress_{}{}", kAxes[a], kAxes[b]), "-", census.stress[a * D + b],
                            "-(1/V) sum F_a r_b over contacts"});
    }
    list.push_back({"pressure", "-", -trace / D, "-trace(stress)/d"});
    list.push_back({"steps", "-", static_cast<double>(clock_.steps), "accepted steps"});
    list.push_back({"evaluations", "-", static_cast<double>(clock_.evaluations), "of the right-hand side"});
    list.push_back({"rejections", "-", static_cast<double>(clock_.rejections), "rejected steps"});
    list.push_back({"mean_step", "-",
                    clock_.steps > 0 ? clock_.mechanical_time / static_cast<double>(clock_.steps) : 0.0,
                    "mechanical time per step"});
    return list;
}

template <int D>
std::vector<sim::Scalar> BubbleSolver<D>::characteristic_numbers() const {
    const Model& m = system_->model;
    const double mean = options_.mean_radius;
    const double relaxation = mean * 2.0 / m.push_rate;
    std::vector<sim::Scalar> list = {
        {"mechanical_time_unit", "-", options_.viscosity / options_.surface_tension, "mu_0/sigma_0"},
        {"relaxation_time", "-", relaxation, "of one contact: 2 <R_in> mu_0/F_0"},
        {"step_limit_explicit", "-", relaxation / 3.0,
         "longest step of a method with stability interval 2 in a jammed foam: 2/(3 F_0/(mu_0 <R_in>))"},
        {"step_limit_pec", "-", relaxation / 12.0, "longest step of abm2 without evaluate_again: 0.5/lambda"},
    };
    if (m.exchanges_gas()) {
        list.push_back({"coarsening_time", "-", mean * mean / m.exchange_rate, "<R_in>^2/K: one unit of scaled time"});
        list.push_back({"relaxation_per_coarsening", "-", relaxation * m.scaled_time_rate(),
                        "keep well below 1: the foam must relax faster than it coarsens"});
    }
    const ProcessPlan plan = plan_processes<D>(options_);
    list.push_back({"memory", "MB", plan.memory_alone * 1e-6, "of one process, at most, at the start"});
    list.push_back({"processes", "-", plan.processes,
                    "as many as work at 80 % of one process's speed each, by a model (docs/clusters.md)"});
    list.push_back(
        {"memory_per_process", "MB", plan.memory * 1e-6, "of each of that many, copies of others' bubbles included"});
    list.push_back(
        {"halo_share", "-", plan.halo_share, "copies of others' bubbles per bubble of a process, at the start"});
    return list;
}

template class BubbleSolver<2>;
template class BubbleSolver<3>;

}  // namespace lamella::bubble
