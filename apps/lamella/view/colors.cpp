#include "view/colors.h"
#include "view/message.h"
#include <cmath>
#include <complex>
#include <vector>
#include <array>
namespace lamella::app::view {
namespace {
double lobe(double x, double m, double a, double b) { double t = (x - m) * (x < m ? a : b); return std::exp(-0.5 * t * t); }
std::array<double,3> cmf(double l) {
    return {1.056 * lobe(l, 599.8, 1/37.9, 1/31.0) + 0.362 * lobe(l, 442.0, 1/16.0, 1/26.7) - 0.065 * lobe(l, 501.1, 1/20.4, 1/26.2),
            0.821 * lobe(l, 568.8, 1/46.9, 1/40.5) + 0.286 * lobe(l, 530.9, 1/16.3, 1/31.1),
            1.217 * lobe(l, 437.0, 1/11.8, 1/36.0) + 0.681 * lobe(l, 459.0, 1/26.0, 1/13.8)};
}
double reflect(double l, double d, double c, bool thick) {
    const double n = 1.333; const double ct = std::sqrt(1 - (1 - c * c) / (n * n));
    double R = 0;
    for (int p = 0; p < 2; ++p) {
        const double r = p ? (n * c - ct) / (n * c + ct) : (c - n * ct) / (c + n * ct);
        const double F = r * r;
        if (thick) { R += F + (1-F)*(1-F)*F/(1-F*F+1e-12); continue; }
        const double s = std::sin(2 * M_PI * n * d * ct / l);
        const double k = 4 * F * s * s; R += k / ((1 - F) * (1 - F) + k + 1e-15);
    }
    return R / 2;
}
std::array<double,3> color(double d, double c, bool thick) {
    std::array<double,3> X{}, W{};
    for (double l = 380; l <= 780; l += 5) { auto m = cmf(l); for (int k = 0; k < 3; ++k) { X[k] += m[k] * reflect(l, d, c, thick); W[k] += m[k]; } }
    const double wp[3] = {0.95047, 1, 1.08883};
    for (int k = 0; k < 3; ++k) X[k] *= wp[k] / W[k];
    return {3.2406*X[0]-1.5372*X[1]-0.4986*X[2], -0.9689*X[0]+1.8758*X[1]+0.0415*X[2], 0.0557*X[0]-0.2040*X[1]+1.0570*X[2]};
}
}
std::string color_message() {
    const int nd = 512, nc = 64; const double top = 1500;
    std::vector<float> v, t;
    for (int j = 0; j < nc; ++j) { double c = j / (nc - 1.0);
        for (int i = 0; i < nd; ++i) for (double x : color(top * i / (nd - 1), c, false)) v.push_back(float(x));
        for (double x : color(0, c, true)) t.push_back(float(x)); }
    Message m; m.add("colors", "thin", "-", 3, std::span<const float>(v)); m.add("colors", "thick", "-", 3, std::span<const float>(t));
    return m.finish({{"thicknesses", nd}, {"cosines", nc}, {"largest_thickness_nm", top}});
}
}
