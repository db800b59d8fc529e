// Saving and loading a bubble foam: live bubbles by id, so that a checkpoint depends neither on how they were
// stored nor on who owned them.

#include <cmath>

#include <fmt/format.h>

#include "lamella/core/error.h"
#include "lamella/solvers/bubble/bubble_solver.h"

namespace lamella::bubble {
template <int D>
void BubbleSolver<D>::save(sim::StateWriter& out) const {
    observe();
    const IdOrder<D> order = id_order();
    const Model& m = system_->model;
    out.write_value("dimension", std::int64_t{D});
    out.write_value("bubbles", order.part().total);
    Foam<D>::for_each_column(system_->foam, [&](const std::string& name, const auto& column) {
        const auto sorted = order.column([&](std::size_t i) { return column[i]; });
        out.write_part("foam/" + name, std::span(sorted), order.part());
    });
    for (std::size_t k = 0; k < D; ++k) out.write_value(fmt::format("box/length_{}", k), system_->foam.box.lengths[k]);
    out.write_value("model/initial_mean_radius", m.initial_mean_radius);
    out.write_value("model/initial_mean_surface", m.initial_mean_surface);
    out.write_value("time", clock_.time);
    out.write_value("mechanical_time", clock_.mechanical_time);
    out.write_value("steps", clock_.steps);
    out.write_value("evaluations", clock_.evaluations);
    out.write_value("rejections", clock_.rejections);
    out.write_value("start_gas", start_gas_);
    out.write_value("start_count", start_count_);
    integrator_->save(out, order);
}

template <int D>
void BubbleSolver<D>::load(sim::StateReader& in) {
    const auto refuse = [](const std::string& what) { throw InputError("the checkpoint does not fit this scene: " + what); };
    if (in.read_integer("dimension") != D) refuse("its foam has another dimension");
    const std::int64_t count = in.read_integer("bubbles");
    const std::int64_t start_count = in.read_integer("start_count");
    if (count < 1 || count > start_count || start_count > (std::int64_t{1} << 50)) refuse("its bubble counts are impossible");

    Foam<D>& foam = system_->foam;
    // The first column is read before room is made for all: a wrong count is found while little memory is taken.
    std::vector<double> sizes;
    in.read_part("foam/size", static_cast<std::size_t>(count), sizes);
    const std::size_t n = sizes.size();
    foam.resize(n);
    foam.live = static_cast<std::size_t>(count);
    domain_.expect_items(static_cast<double>(start_count));
    Foam<D>::for_each_column(foam, [&](const std::string& name, auto& column) {
        std::vector<typename std::decay_t<decltype(column)>::value_type> values;
        in.read_part("foam/" + name, static_cast<std::size_t>(count), values);
        std::copy(values.begin(), values.end(), column.begin());
    });
    Model& m = system_->model;
    for (std::size_t k = 0; k < D; ++k) {
        foam.box.lengths[k] = in.read_double(fmt::format("box/length_{}", k));
        foam.box.periodic[k] = !options_.walls[k];
        if (!(foam.box.lengths[k] > 0.0) || !std::isfinite(foam.box.lengths[k])) refuse("its box is not a box");
    }
    std::int64_t bad = 0;
    for (std::size_t i = 0; i < n; ++i) {
        bool good = std::isfinite(foam.size[i]) && foam.size[i] > 0.0 && foam.id[i] >= 0 && foam.id[i] < start_count;
        for (std::size_t k = 0; k < D; ++k) good = good && std::abs(foam.position[k][i]) <= 1e3 * foam.box.lengths[k];
        bad += good ? 0 : 1;
    }
    bad = domain_.sum(bad);
    if (bad > 0) refuse(fmt::format("{} bubbles have an impossible position, size or id", bad));
    m.initial_mean_radius = in.read_double("model/initial_mean_radius");
    m.initial_mean_surface = in.read_double("model/initial_mean_surface");
    clock_.time = in.read_double("time");
    clock_.mechanical_time = in.read_double("mechanical_time");
    clock_.steps = in.read_integer("steps");
    clock_.evaluations = in.read_integer("evaluations");
    clock_.rejections = in.read_integer("rejections");
    start_gas_ = in.read_double("start_gas");
    start_count_ = start_count;
    m.total_size = start_gas_;
    m.largest_count = static_cast<double>(start_count_);
    make_integrator();
    integrator_->load(in, *system_);
    system_->prepare(LiquidMotion::kAsGiven);
    system_->rebuild();
    look_for_the_largest();
    take_to_device();
}

template class BubbleSolver<2>;
template class BubbleSolver<3>;

}  // namespace lamella::bubble
