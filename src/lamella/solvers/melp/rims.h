#pragma once

#include "lamella/core/vec.h"
#include "lamella/film/wire.h"
#include "lamella/solvers/melp/tensor.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace lamella::melp {

/// What a film ends on, and how the film goes on behind it.
///
/// Behind a straight wire a film at rest goes on as its own picture turned by 180 degrees about the wire, behind a
/// plate that it meets at a right angle as its mirror image: Schwarz's principle for minimal surfaces. Behind a ring
/// and on a ball the same holds for the tangent and the tangent plane at the nearest point, but for terms of the order
/// (distance / radius).
enum class RimKind : std::uint8_t {
    kLine,   ///< a straight wire from `a` to `b`
    kRing,   ///< a wire around the center `a` with the unit axis `b`
    kPlate,  ///< a plane through `a` with the unit normal `b`, toward the film; films slide on it
    kBall,   ///< a ball around `a`, or a stick from `a` - `b` to `a` + `b`; films slide on it
};

/// Where the film beyond a rim is: place(x) = map x + shift, velocity(w) = map w + drift.
struct Mirror {
    Tensor map;
    Vec3 shift;         ///< [m]
    Vec3 drift;         ///< [m/s]
    double sign = 1.0;  ///< of velocities along the normals: -1 behind a wire, which the film turns about
    double root = 1.0;  ///< of how much smaller the picture's area is than the film's, behind a ball or stick
    std::uint32_t key;  ///< which pieces it is the picture behind: the same for all particles

    Vec3 place(const Vec3& x) const { return map * x + shift; }
    Vec3 velocity(const Vec3& w) const { return map * w + drift; }
    Vec3 normal(const Vec3& n) const { return sign * (map * n); }
};

/// One smooth piece of rim of one region, at one moment.
struct RimPiece {
    RimKind kind = RimKind::kLine;
    std::int32_t region = 0;
    Vec3 a{}, b{};                    ///< see RimKind [m]
    double radius = 0.0;              ///< of a ring or a ball [m]
    Vec3 velocity_a{}, velocity_b{};  ///< of the points a and b of a line [m/s]; of the center, and the spin [1/s]
    std::int32_t corner_next = -1;    ///< of a line: the piece that begins where it ends, if they meet at a right angle

    /// The point of the piece nearest to x; nothing where that is beyond the ends of a line, or in the middle of a
    /// ball.
    std::optional<Vec3> foot(const Vec3& x) const;
    /// Of the point of the piece at `foot` [m/s].
    Vec3 velocity_at(const Vec3& foot) const;
    bool slides() const { return kind == RimKind::kPlate || kind == RimKind::kBall; }
};

/// Everything that holds the films of a scene: it moves as it is told, so it has no state of its own.
class Rims {
public:
    /// A piece as it is at time 0, and the wires that move its points, -1: none. Those of a line are its ends; the
    /// others move as a whole, with the first wire.
    void add(const RimPiece& piece, std::int32_t wire_a, std::int32_t wire_b);
    void set_wires(std::vector<film::Wire> wires) { wires_ = std::move(wires); }

    /// The pieces at a time, with their velocities then.
    std::vector<RimPiece> at(double time) const;
    bool empty() const { return pieces_.empty(); }
    bool holds(std::int32_t region) const;
    /// How fast any point of them ever moves, at most [m/s].
    double fastest() const;

private:
    struct Told {
        RimPiece piece;
        std::int32_t wire_a, wire_b;
    };
    std::vector<Told> pieces_;
    std::vector<film::Wire> wires_;
};

/// Pictures of the film around `x`, whose normal there is `normal`, behind the pieces of its region that are within
/// `reach`, and behind two that meet at a right angle near it.
void append_mirrors(std::span<const RimPiece> pieces,
                    std::int32_t region,
                    const Vec3& x,
                    const Vec3& normal,
                    double reach,
                    std::vector<Mirror>& mirrors);

}  // namespace lamella::melp
