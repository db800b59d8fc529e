#include "lamella/solvers/melp/patch.h"

#include "lamella/linalg/small_cholesky.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace lamella::melp {

Frame frame_of(const Vec3& n) {
    // The branch keeps the divisor away from zero.
    const double sign = n[2] < 0.0 ? -1.0 : 1.0;
    const double a = -1.0 / (sign + n[2]);
    const double b = n[0] * n[1] * a;
    return {{{1.0 + sign * n[0] * n[0] * a, sign * b, -sign * n[0]}}, {{b, sign + n[1] * n[1] * a, -n[1]}}, n};
}

PatchShape shape_of(const Patch& patch) {
    // Films that are resolved are less steep than this over their smooth normals; the fit at a sharp fold may tilt onto
    // one of its faces, and onto the other one in the next step.
    constexpr double kSteepest = 0.4;
    const auto& c = patch.c;
    const double zu = c[1], zv = c[2], zuu = 2.0 * c[3], zuv = c[4], zvv = 2.0 * c[5];
    const double g = 1.0 + zu * zu + zv * zv;
    const double sum = ((1.0 + zv * zv) * zuu - 2.0 * zu * zv * zuv + (1.0 + zu * zu) * zvv) / (g * std::sqrt(g));
    const double slope = std::sqrt(zu * zu + zv * zv), part = slope > kSteepest ? kSteepest / slope : 1.0;
    const Vec3 normal = patch.frame.normal - part * (zu * patch.frame.e1 + zv * patch.frame.e2);
    return {normal / norm(normal), sum};
}

namespace {

using Lanes3 = std::array<Simd, 3>;
using Mask = Simd::mask_type;
using Places = std::array<const Vec3*, kLanes>;

Simd product(const Lanes3& a, const Lanes3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// What lane l finds at place[l].
template <class Place>
Lanes3 lanes_of(Place&& place) {
    Lanes3 result;
    for (std::size_t c = 0; c < 3; ++c) result[c] = Simd([&](auto l) { return place(l)[c]; });
    return result;
}

/// The fits of eight particles.
class PatchFits {
public:
    using Terms = std::array<Simd, Patch::kTerms>;

    /// @param patch  one to eight, of which the frames are set; lanes beyond them repeat the last one
    PatchFits(std::span<const Patch> patch, double unit) : per_unit_(1.0 / unit) {
        const auto of = [&](std::size_t l) -> const Patch& { return patch[std::min(l, patch.size() - 1)]; };
        origin_ = lanes_of([&](std::size_t l) { return of(l).origin; });
        e1_ = lanes_of([&](std::size_t l) { return of(l).frame.e1; });
        e2_ = lanes_of([&](std::size_t l) { return of(l).frame.e2; });
        normal_ = lanes_of([&](std::size_t l) { return of(l).frame.normal; });
        matrix_[0] = 1.0;  // the particle itself, at the origin
    }

    /// One more place for each lane that has one.
    void add(const Places& place, const Mask& there) {
        Lanes3 d = lanes_of([&](std::size_t l) -> const Vec3& { return *place[l]; });
        for (std::size_t c = 0; c < 3; ++c) d[c] = per_unit_ * (d[c] - origin_[c]);
        FitPoint<Simd> point = fit_point(product(e1_, d), product(e2_, d), product(normal_, d), product(d, d));
        point.weight = select(there, point.weight, Simd(0.0));
        for (std::size_t p = 0; p < kTerms; ++p) {
            const Simd weighted = point.weight * point.term[p];
            for (std::size_t q = 0; q <= p; ++q) matrix_[p * kTerms + q] += weighted * point.term[q];
            right_[p] += weighted * point.z;
        }
    }

    /// Once all places are there. @returns false for lanes whose places make no quadratic
    Mask solve() {
        const Mask definite = linalg::factor_positive<kTerms>(matrix_);
        linalg::solve_factored<kTerms>(matrix_, right_);
        return definite;
    }
    const Terms& terms() const { return right_; }
    /// The first row of the inverse, after solve().
    Terms row() const {
        Terms row{};
        row[0] = 1.0;
        linalg::solve_factored<kTerms>(matrix_, row);
        return row;
    }

private:
    static constexpr std::size_t kTerms = Patch::kTerms;

    double per_unit_;
    Lanes3 origin_, e1_, e2_, normal_;
    std::array<Simd, kTerms * kTerms> matrix_{};  // of the normal equations, the lower triangle
    Terms right_{};
};

/// The places that stand in the rows of up to eight particles.
template <class List>
void add_rows(const List& list,
              std::size_t first,
              std::size_t count,
              auto&& place_of,
              PatchFits& fits,
              std::array<std::size_t, kLanes>& places) {
    static constexpr Vec3 kNowhere{};
    std::array<std::size_t, kLanes> length{};
    for (std::size_t l = 0; l < count; ++l) length[l] = list.end(first + l) - list.begin(first + l);
    const Simd ends([&](auto l) { return static_cast<double>(length[l]); });
    const std::size_t longest = *std::max_element(length.begin(), length.end());
    for (std::size_t k = 0; k < longest; ++k) {
        Places place;
        for (std::size_t l = 0; l < kLanes; ++l)
            place[l] = k < length[l] ? &place_of(list.begin(first + l) + k) : &kNowhere;
        fits.add(place, ends > static_cast<double>(k));
    }
    for (std::size_t l = 0; l < kLanes; ++l) places[l] += length[l];
}

}  // namespace

void fit_patches(std::span<const Vec3> position,
                 std::span<const Vec3> frame_normal,
                 const Neighbors& neighbors,
                 const Images& images,
                 std::size_t first,
                 std::span<Patch> patch,
                 std::span<FitRow> row) {
    const double unit = neighbors.kernel.support_radius;
    for (std::size_t done = 0; done < patch.size(); done += kLanes) {
        const std::size_t at = first + done, count = std::min(patch.size() - done, kLanes);
        for (std::size_t l = 0; l < count; ++l)
            patch[done + l] = {.origin = position[at + l], .frame = frame_of(frame_normal[at + l])};
        PatchFits fits(patch.subspan(done, count), unit);
        std::array<std::size_t, kLanes> places;  // the particle's own among them
        places.fill(1);
        add_rows(
            neighbors, at, count, [&](std::size_t k) -> const Vec3& { return position[neighbors.index[k]]; }, fits,
            places);
        add_rows(
            images, at, count, [&](std::size_t k) -> const Vec3& { return images.place[k]; }, fits, places);
        const Mask definite = fits.solve();
        const PatchFits::Terms terms = fits.terms();
        const PatchFits::Terms rows = row.empty() ? PatchFits::Terms{} : fits.row();
        for (std::size_t l = 0; l < count; ++l) {
            if (places[l] < Patch::kTerms || !definite[l]) continue;
            patch[done + l].c = {terms[0][l] * unit, terms[1][l],        terms[2][l],
                                 terms[3][l] / unit, terms[4][l] / unit, terms[5][l] / unit};
            for (std::size_t p = 0; p < Patch::kTerms && !row.empty(); ++p) row[done + l][p] = rows[p][l];
        }
    }
}

}  // namespace lamella::melp
