// Exact signs by floating-point expansions: sums of doubles of falling size whose bits do not overlap [Shewchuk97].

#include "lamella/geometry/predicates.h"

#include <array>
#include <cmath>
#include <cstddef>

namespace lamella::geometry::detail {
namespace {

struct TwoDoubles {
    double high, low;  // high = fl(exact), high + low = exact
};

TwoDoubles two_sum(double a, double b) {
    const double sum = a + b;
    const double b_part = sum - a;
    const double a_part = sum - b_part;
    return {sum, (a - a_part) + (b - b_part)};
}

TwoDoubles two_product(double a, double b) {
    const double product = a * b;
    return {product, std::fma(a, b, -product)};
}

/// The exact value of at most N doubles, smallest first, none of them zero.
template <std::size_t N>
struct Expansion {
    std::array<double, N> part;
    std::size_t size = 0;

    /// Adds one double exactly. The parts stay in order and free of overlap (Grow-Expansion).
    void add(double b) {
        double carry = b;
        std::size_t kept = 0;
        for (std::size_t i = 0; i < size; ++i) {
            const TwoDoubles s = two_sum(carry, part[i]);
            if (s.low != 0.0) part[kept++] = s.low;
            carry = s.high;
        }
        if (carry != 0.0) part[kept++] = carry;
        size = kept;
    }
    int sign() const { return size == 0 ? 0 : part[size - 1] > 0.0 ? 1 : -1; }
};

Expansion<2> difference(double a, double b) {
    const TwoDoubles d = two_sum(a, -b);
    Expansion<2> result;
    result.add(d.low);
    result.add(d.high);
    return result;
}

template <std::size_t N, std::size_t M>
Expansion<2 * N * M> product(const Expansion<N>& a, const Expansion<M>& b) {
    Expansion<2 * N * M> result;
    for (std::size_t i = 0; i < a.size; ++i)
        for (std::size_t j = 0; j < b.size; ++j) {
            const TwoDoubles p = two_product(a.part[i], b.part[j]);
            result.add(p.low);
            result.add(p.high);
        }
    return result;
}

template <std::size_t N, std::size_t M>
Expansion<N + M> sum(const Expansion<N>& a, const Expansion<M>& b, double sign_of_b) {
    Expansion<N + M> result;
    for (std::size_t i = 0; i < a.size; ++i) result.add(a.part[i]);
    for (std::size_t i = 0; i < b.size; ++i) result.add(sign_of_b * b.part[i]);
    return result;
}

}  // namespace

int exact_orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    std::array<Expansion<2>, 3> u, v, w;
    for (std::size_t k = 0; k < 3; ++k) {
        u[k] = difference(b[k], a[k]);
        v[k] = difference(c[k], a[k]);
        w[k] = difference(d[k], a[k]);
    }
    const auto term = [&](std::size_t i, std::size_t j, std::size_t k) {
        return product(sum(product(v[j], w[k]), product(v[k], w[j]), -1.0), u[i]);
    };
    return sum(sum(term(0, 1, 2), term(1, 2, 0), 1.0), term(2, 0, 1), 1.0).sign();
}

int exact_orient2d(const Vec2& a, const Vec2& b, const Vec2& c) {
    const auto left = product(difference(b[0], a[0]), difference(c[1], a[1]));
    const auto right = product(difference(b[1], a[1]), difference(c[0], a[0]));
    return sum(left, right, -1.0).sign();
}

}  // namespace lamella::geometry::detail
