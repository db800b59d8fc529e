#pragma once

#include "lamella/dist/part.h"
#include "lamella/dist/routes.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>

namespace lamella::bubble {
class Domain;
template <int D>
class Ownership;
}  // namespace lamella::bubble

namespace lamella::bubble::detail {

/// A bubble that may have to do with other devices than its own.
template <int D>
struct Whereabouts {
    Vec<D> center;
    double radius;
    std::uint32_t slot;
};

/// What a foam that lives on the devices of several processes has to ask of the others. Everything is collective.
template <int D>
class DeviceTeam {
public:
    virtual ~DeviceTeam() = default;

    virtual dist::Communicator& processes() = 0;
    virtual double most_terms() const = 0;

    /// The part of the box that this process owns from now on. @see Ownership::update
    using Positions = std::function<std::array<const double*, D>()>;
    virtual dist::Part<D> own_part(const spatial::PeriodicBox<D>& box,
                                   std::size_t count,
                                   const Positions& positions) = 0;
    /// The ways of these bubbles, which the part does not hold, to their owners.
    virtual dist::Routes to_owners(std::span<const Whereabouts<D>> bubbles) = 0;
    /// @see Ownership::settle
    virtual void settle(std::size_t count, std::size_t live) = 0;
    /// The ways of copies of these bubbles to all who own a place within radius + `beyond` of their centers.
    virtual dist::Routes to_neighbors(std::span<const Whereabouts<D>> bubbles, double beyond) = 0;
};

/// The processes that share a foam; nullptr where there is one.
template <int D>
std::unique_ptr<DeviceTeam<D>> make_device_team(Domain& domain, Ownership<D>& ownership);

}  // namespace lamella::bubble::detail
