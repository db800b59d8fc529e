// Bubbles that swing: reference/reference.json, oscillation/film_only/eta=5e-07.

#include "../../unit/melp/bubbles.h"

#include <gtest/gtest.h>

namespace lamella::melp {
namespace {

double frequency(double particles, int l, const std::string& more) {
    auto solver = bubble(particles, "start.mode = " + std::to_string(l) + "\nstart.mode_amplitude = 0.01\n" + more);
    const double swing = period(*solver, 4, [&] { return shape_mode(*solver, l); });
    return 2.0 * std::numbers::pi / swing;
}

TEST(Oscillation, HasTheFrequenciesOfABubbleWhoseFilmAloneHasMass) {
    for (const double n : {1200.0,2562.0})
    for (const char* ratio : {"0","16"})
    for (const double steps : {20.0, 100.0}) {
        const std::string more = "steps_per_period = " + std::to_string(steps) + "\nfine_ratio = " + ratio;
        std::printf("N %g ratio %s steps %g: l2 %.4f l3 %.4f\n", n, ratio, steps, frequency(n, 2, more)/400.0, frequency(n, 3, more)/632.4555);
    }
}

}  // namespace
}  // namespace lamella::melp
