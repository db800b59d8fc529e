#pragma once

#include <cmath>
#include <cstddef>

#include "lamella/core/host_device.h"

namespace lamella {

/// A point or vector in D dimensions.
template <int D>
struct Vec {
    double v[D] = {};

    LAMELLA_HOST_DEVICE double& operator[](std::size_t k) { return v[k]; }
    LAMELLA_HOST_DEVICE const double& operator[](std::size_t k) const { return v[k]; }

    LAMELLA_HOST_DEVICE Vec& operator+=(const Vec& b) {
        for (int k = 0; k < D; ++k) v[k] += b.v[k];
        return *this;
    }
    LAMELLA_HOST_DEVICE Vec& operator-=(const Vec& b) {
        for (int k = 0; k < D; ++k) v[k] -= b.v[k];
        return *this;
    }
    LAMELLA_HOST_DEVICE Vec& operator*=(double s) {
        for (int k = 0; k < D; ++k) v[k] *= s;
        return *this;
    }

    LAMELLA_HOST_DEVICE friend Vec operator+(Vec a, const Vec& b) { return a += b; }
    LAMELLA_HOST_DEVICE friend Vec operator-(Vec a, const Vec& b) { return a -= b; }
    LAMELLA_HOST_DEVICE friend Vec operator-(Vec a) { return a *= -1.0; }
    LAMELLA_HOST_DEVICE friend Vec operator*(double s, Vec a) { return a *= s; }
    LAMELLA_HOST_DEVICE friend Vec operator*(Vec a, double s) { return a *= s; }
    LAMELLA_HOST_DEVICE friend Vec operator/(Vec a, double s) { return a *= 1.0 / s; }
    friend bool operator==(const Vec&, const Vec&) = default;

    LAMELLA_HOST_DEVICE friend double dot(const Vec& a, const Vec& b) {
        double sum = 0.0;
        for (int k = 0; k < D; ++k) sum += a.v[k] * b.v[k];
        return sum;
    }
    LAMELLA_HOST_DEVICE friend double squared_norm(const Vec& a) { return dot(a, a); }
    LAMELLA_HOST_DEVICE friend double norm(const Vec& a) { return std::sqrt(dot(a, a)); }
};

using Vec2 = Vec<2>;
using Vec3 = Vec<3>;

LAMELLA_HOST_DEVICE inline Vec3 cross(const Vec3& a, const Vec3& b) {
    return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}

}  // namespace lamella
