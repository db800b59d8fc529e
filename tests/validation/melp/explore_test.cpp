#include "../../unit/melp/bubbles.h"
#include <gtest/gtest.h>
namespace lamella::melp {
namespace {
void show(const MelpSolver& s, std::initializer_list<const char*> names) {
    std::printf("t %.5g ", s.time());
    for (auto n : names) std::printf("%s %.6g  ", n, scalar(s, n));
    std::printf("\n"); std::fflush(stdout);
}
TEST(Explore, Static) {
    for (const char* ratio : {"cfl=0.4"}) for (double n : {1200.0}) {
        auto s = bubble(n, std::string("fine_ratio = 0\n")+ratio);
        for (int k = 0; k < 10; ++k) { for (int j = 0; j < 60; ++j) s->advance(1e9);
            show(*s, {"gauge_pressure_1","max_velocity","particle_area","particle_volume","density_spread","momentum_x","momentum_z"}); }
        std::printf("exact area %g volume %g 4s/R %g c %g\n", 4*std::numbers::pi*kRadius*kRadius, 4*std::numbers::pi/3*std::pow(kRadius,3), 4*kTension/kRadius, std::sqrt(2*kTension/5e-4));
    }
}
TEST(Explore, Equalise) {
    auto s = bubble(1200, "start.thickness_noise = 0.5\nsteps_per_period = 0\nlargest_step = 0.0333");
    show(*s, {"film_thickness_mean","film_thickness_deviation"});
    for (double t : {0.05,0.1,0.2,0.5,1.0,2.0,5.0}) { while (s->time()<t) s->advance(t);
      show(*s, {"film_thickness_mean","film_thickness_deviation","max_velocity","momentum_x","liquid_error","density_spread","strays","time_step","gauge_pressure_1"}); }
}
TEST(Explore, Drain) {
    auto s = bubble(1200, "floating = true\nair_drag=1e-3\nsteps_per_period = 0\nlargest_step = 0.0166\ntheta=1.0", "gravity=[0.0,0.0,-9.81]");
    for (double t : {0.1,0.5,1.0,2.0,5.0}) { while (s->time()<t) s->advance(t);
      show(*s, {"film_thickness_min","film_thickness_max","film_thickness_deviation","max_velocity","momentum_z","liquid_error","density_spread","strays","time_step","gauge_pressure_1","particle_volume"});
      // slope
      double sw=0,sz=0,sl=0,szz=0,szl=0; auto&g=s->geometry();
      for (size_t i=0;i<g.size();++i){ double w=g.area[i], z=s->coarse().position[i][2], l=std::log(s->films().thickness[i]); sw+=w;sz+=w*z;sl+=w*l;szz+=w*z*z;szl+=w*z*l; }
      double k=-(szl-sz*sl/sw)/(szz-sz*sz/sw); std::printf("slope %.5f zc %.5g wanted %.5f\n", k, sz/sw, 1000*9.81*5e-7/(2*8.31446*298.15*1e-7)); }
}
TEST(Explore, Fly) {
    for (const char* o : {"fine_ratio=0","fine_ratio=16"}) {
    auto s = solver_of(std::string("[material]\nthickness=5e-7\n[[bubble]]\nradius=0.05\nvelocity=[0.5,0.0,0.2]\n[resolution]\nedge_length=0.005\n[melp]\n")+o); s->start({});
    for (double t : {0.001,0.005,0.01,0.02,0.05}) { while (s->time()<t) s->advance(t); show(*s,{"momentum_x","momentum_z","momentum_y","max_velocity","density_spread","energy_kinetic"}); } }
}
}
}
