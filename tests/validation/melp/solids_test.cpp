// Balls and sticks in films against closed forms.

#include <gtest/gtest.h>

#include "../../unit/melp/bubbles.h"
#include <algorithm>

namespace lamella::melp {
namespace {

constexpr double kRing = 0.05, kBall = 0.012;  // [m]
const double kFilmTension = 2.0 * kTension;    // [N/m]

/// The film between a ring in the plane z = 0 and a ball below its middle that it meets at a right angle: a catenoid
/// r = c cosh((z - z_1) / c), whose slope at the ball is that of the ball's radius there, c = a cos theta sin theta. It
/// pulls with 2 pi c times its tension.
class BallOnFilm {
public:
    /// @param theta  latitude of the contact on the ball
    explicit BallOnFilm(double theta) : c_(kBall * std::cos(theta) * std::sin(theta)), theta_(theta) {}

    double force() const { return 2.0 * std::numbers::pi * c_ * kFilmTension; }
    double contact() const { return kBall * std::cos(theta_); }
    /// How far the film is below the ring at a distance from the axis [m].
    double depth(double r) const { return c_ * (std::acosh(kRing / c_) - std::acosh(std::max(r / c_, 1.0))); }
    /// Of the ball's middle [m].
    double depth_of_ball() const { return depth(contact()) + kBall * std::sin(theta_); }

private:
    double c_, theta_;
};

/// @param value  of a BallOnFilm that grows with theta
template <class Value>
BallOnFilm ball_with(double wanted, Value&& value) {
    double low = 1e-4, high = 0.25 * std::numbers::pi;
    for (int k = 0; k < 60; ++k) {
        const double middle = 0.5 * (low + high);
        (value(BallOnFilm(middle)) < wanted ? low : high) = middle;
    }
    return BallOnFilm(low);
}

std::unique_ptr<MelpSolver> film_with(const std::string& solid,
                                      const std::string& options,
                                      const std::string& material) {
    return films("[[film]]\nshape = \"disk\"\nradius = " + std::to_string(kRing) +
                     "\n[[solid]]\nradius = " + std::to_string(kBall) + "\n" + solid,
                 0.0022, "fine_ratio = 0\n" + options, material);
}

/// Largest difference between the particles' depths and the catenoid's, over its depth at the ball.
double worst(const MelpSolver& solver, const BallOnFilm& exact) {
    double most = 0.0;
    for (const Vec3& x : solver.coarse().position)
        most = std::max(most, std::abs(-x[2] - exact.depth(std::hypot(x[0], x[1]))));
    return most / exact.depth(exact.contact());
}

/// A ball that is pushed down and held: the film hangs from the ring to it as a catenoid and pulls as it should.
TEST(Solids, BallThatIsHeldPullsTheFilmIntoACatenoid) {
    constexpr double kDown = 0.008;
    auto solver = film_with("velocity = [0.0, 0.0, -0.1]\nend = 0.08\n", "damping = 500.0\n", "");
    advance_to(*solver, 0.2);
    const BallOnFilm exact = ball_with(kDown, [](const BallOnFilm& b) { return b.depth_of_ball(); });
    const double force = scalar(*solver, "solid_0_force_z") / exact.force();
    std::printf("held ball, %zu coarse: force %.4f, worst depth %.4f, along the film %.1e\n", solver->coarse().size(),
                force, worst(*solver, exact), scalar(*solver, "solid_0_force_x") / exact.force());
    EXPECT_NEAR(force, 1.0, 0.03);
    EXPECT_LT(worst(*solver, exact), 0.03);
}

/// A free ball sinks until the film carries it.
TEST(Solids, BallRestsOnAFilm) {
    constexpr double kMass = 5e-5;  // [kg]
    auto solver = film_with("free = true\nmass = 5e-5\n", "damping = 60.0\n", "gravity = [0.0, 0.0, -9.81]\n");
    advance_to(*solver, 0.4);
    const BallOnFilm exact = ball_with(kMass * 9.81, [](const BallOnFilm& b) { return b.force(); });
    const film::Body& ball = solver->bodies()[0];
    std::printf("ball of 50 mg: depth %.4f of %.2f mm, force %.4f of its weight, to the side %.2f mm, speed %.1e m/s\n",
                -ball.center[2] / exact.depth_of_ball(), 1e3 * exact.depth_of_ball(), ball.force[2] / (kMass * 9.81),
                1e3 * std::hypot(ball.center[0], ball.center[1]), norm(ball.velocity));
    EXPECT_NEAR(-ball.center[2] / exact.depth_of_ball(), 1.0, 0.03);
}

}  // namespace
}  // namespace lamella::melp
