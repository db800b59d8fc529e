// cuda_check: whether the foam on the GPU does what its CPU twin does. Needs nothing but the CUDA toolkit.
// Exit code 0: everything that could be checked is right; without a GPU the twin alone is checked, in three orders of
// its threads, and the last line says so.

#include "lamella/core/cuda.h"
#include "lamella/solvers/bubble/detail/device_runner.h"

#include "foam_in_place.h"
#include <cstdio>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

namespace {

using namespace lamella;
using namespace lamella::bubble;
namespace device = lamella::bubble::detail;
using device::DeviceRunner;

int faults = 0;

void expect(bool right, const std::string& what) {
    std::printf("%s  %s\n", right ? "ok  " : "FAIL", what.c_str());
    if (!right) ++faults;
}

/// Position, size and rates of a foam by id.
template <int D>
std::vector<double> state_of(DeviceRunner<D>& runner) {
    Foam<D> foam;
    runner.download(foam);
    constexpr std::size_t kColumns = 2 * D + 3;
    std::int64_t most = 0;
    for (std::size_t i = 0; i < foam.slots; ++i) most = foam.id[i] > most ? foam.id[i] : most;
    std::vector<double> state(kColumns * static_cast<std::size_t>(most + 1), 0.0);
    for (std::size_t i = 0; i < foam.slots; ++i) {
        double* row = &state[kColumns * static_cast<std::size_t>(foam.id[i])];
        *row++ = foam.size[i];
        *row++ = foam.size_rate[i];
        *row++ = foam.path_length[i];
        for (std::size_t k = 0; k < D; ++k) {
            *row++ = foam.position[k][i];
            *row++ = foam.velocity[k][i];
        }
    }
    return state;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
    if (a.size() != b.size()) return 1e300;
    double most = 0.0;
    for (std::size_t n = 0; n < a.size(); ++n) {
        const double d = a[n] < b[n] ? b[n] - a[n] : a[n] - b[n];
        most = d > most || d != d ? d : most;
    }
    return most;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

template <int D>
using Make = std::function<std::unique_ptr<DeviceRunner<D>>()>;

template <int D>
std::vector<double> run(const Options& o, const Make<D>& make, std::int64_t steps) {
    const auto runner = make();
    const Foam<D> foam = FoamInPlace::make<D>(o);
    runner->upload(foam, FoamInPlace::model<D>(o, foam), {},
                   {.next_step = 1e-3, .stiffness = 0.0, .rates_current = false});
    runner->advance(1e9, steps);
    return state_of<D>(*runner);
}

/// Number of bubbles and mean radius at a time: they agree even if single bubbles did not.
template <int D>
std::pair<double, double> statistics(const Options& o, const Make<D>& make, double time) {
    const auto runner = make();
    const Foam<D> foam = FoamInPlace::make<D>(o);
    runner->upload(foam, FoamInPlace::model<D>(o, foam), {},
                   {.next_step = 1e-3, .stiffness = 0.0, .rates_current = false});
    runner->advance(time, 1'000'000'000);
    Foam<D> end;
    runner->download(end);
    double radii = 0.0;
    for (std::size_t i = 0; i < end.slots; ++i) radii += Shape<D>::radius(end.size[i]);
    return {static_cast<double>(end.live), radii / static_cast<double>(end.live)};
}

template <int D>
void check(const std::string& name, const Options& o) {
    using Order = HostMachine::Order;
    constexpr std::int64_t kSteps = 60;
    const auto twin = [&](Order order) -> Make<D> {
        return [&o, order] { return device::make_twin_runner<D>(o, order); };
    };
    const std::vector<double> expected = run<D>(o, twin(Order::kForward), kSteps);
    const bool orders = same_bits(expected, run<D>(o, twin(Order::kBackward), kSteps)) &&
                        same_bits(expected, run<D>(o, twin(Order::kShuffled), kSteps));
    expect(orders, name + ": the twin has the same bits in three orders of its threads");
    if (!cuda_fault().empty()) return;

    const Make<D> gpu = [&o] { return device::make_cuda_runner<D>(o); };
    const double one = largest_difference(run<D>(o, twin(Order::kForward), 1), run<D>(o, gpu, 1));
    const std::vector<double> found = run<D>(o, gpu, kSteps);
    char text[200];
    std::snprintf(text, sizeof text, ": one step differs by %.3g (allowed: 1e-12), %d steps by %.3g%s", one,
                  static_cast<int>(kSteps), largest_difference(expected, found),
                  same_bits(expected, found) ? ", the same bits" : "");
    expect(one <= 1e-12, name + text);
    expect(same_bits(found, run<D>(o, gpu, kSteps)), name + ": the GPU repeats itself bit for bit");
    const auto a = statistics<D>(o, twin(Order::kForward), 0.3);
    const auto b = statistics<D>(o, gpu, 0.3);
    std::snprintf(text, sizeof text, ": at time 0.3 %g and %g bubbles of mean radius %.6g and %.6g", a.first, b.first,
                  a.second, b.second);
    expect(a.first - b.first < 0.01 * a.first && b.first - a.first < 0.01 * a.first &&
               a.second - b.second < 0.01 * a.second && b.second - a.second < 0.01 * a.second,
           name + text);
}

Options options(int dimension, int count) {
    Options o;
    o.dimension = dimension;
    o.count = count;
    o.end_count = 1;
    o.gas_fraction = dimension == 2 ? 0.95 : 0.75;
    return o;
}

}  // namespace

int main() {
    const std::string fault = cuda_fault();
    std::printf("%s\n", fault.empty() ? cuda_device_name().c_str() : fault.c_str());
    check<2>("2D", options(2, 2000));
    check<3>("3D", options(3, 2000));
    Options walls = options(2, 900);
    walls.walls = {true, false, false};
    walls.wall_blocks_gas = true;
    walls.drag = Drag::kNeighborLagged;
    walls.flow.kind = FlowKind::kRegion;
    walls.flow.edge_width = 1.0;
    walls.integrator.norm = ErrorNorm::kRms;
    check<2>("2D, walls, flow, lagged drag, rms error", walls);
    Options lsw = options(3, 700);
    lsw.gas.medium_scaling = MediumScaling::kLsw;
    lsw.integrator.relative_error = true;
    check<3>("3D, lsw, relative error", lsw);
    check<2>("2D, small box", options(2, 20));
    if (faults == 0 && !fault.empty()) std::printf("no GPU: the twin alone was checked\n");
    return faults == 0 ? 0 : 1;
}
