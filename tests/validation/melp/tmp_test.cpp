#include "../../unit/melp/bubbles.h"
#include <gtest/gtest.h>
namespace lamella::melp { namespace {
TEST(Tmp, E) { auto s = bubble(1200, "start.thickness_noise = 0.8\nsteps_per_period = 0.0\nlargest_step = 0.0333333");
 for (int k=0;k<9;++k) { double v=0,t=0; for (size_t i=0;i<s->coarse().size();++i){ double n=dot(s->coarse().velocity[i],s->geometry().normal[i]); v=std::max(v,std::abs(n)); t=std::max(t,norm(s->films().along[i])); }
  std::printf("t %.4f dt %.4f vn %.4f vt %.4f V %.6g Vhat %.6g p %.4g eta %.3g..%.3g spread %.3f mode0 %.5f l1 %.2g l2 %.2g\n", s->time(), scalar(*s,"time_step"), v, t, s->gas()[0].volume, scalar(*s,"particle_volume"), scalar(*s,"gauge_pressure_1"), scalar(*s,"film_thickness_min"), scalar(*s,"film_thickness_max"), scalar(*s,"density_spread"), shape_mode(*s,0), shape_mode(*s,1), shape_mode(*s,2)); std::fflush(stdout); auto r = s->advance(1e9); std::printf("   it %ld res %g\n", (long)r.iterations, r.residual); } }
}}
