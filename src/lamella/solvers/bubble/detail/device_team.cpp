#include "lamella/solvers/bubble/detail/device_team.h"

#include "lamella/solvers/bubble/domain.h"
#include "lamella/solvers/bubble/ownership.h"

#include <utility>
#include <vector>

namespace lamella::bubble::detail {
namespace {

template <int D>
class Team final : public DeviceTeam<D> {
public:
    Team(Domain& domain, Ownership<D>& ownership) : domain_(domain), ownership_(ownership) {}

    dist::Communicator& processes() override { return domain_.processes(); }
    double most_terms() const override { return domain_.most_terms(); }

    dist::Part<D> own_part(const spatial::PeriodicBox<D>& box,
                           std::size_t count,
                           const typename DeviceTeam<D>::Positions& positions) override {
        ownership_.update(box, count, positions);
        return ownership_.own_part();
    }
    dist::Routes to_owners(std::span<const Whereabouts<D>> bubbles) override {
        Lists to = one_for_each_process();
        for (std::uint32_t n = 0; n < bubbles.size(); ++n) {
            const int owner = ownership_.owner(bubbles[n].center);
            if (owner != domain_.processes().rank()) to[static_cast<std::size_t>(owner)].push_back(n);
        }
        return {domain_.processes(), std::move(to)};
    }
    void settle(std::size_t count, std::size_t live) override { ownership_.settle(count, live); }
    dist::Routes to_neighbors(std::span<const Whereabouts<D>> bubbles, double beyond) override {
        Lists to = one_for_each_process();
        for (std::uint32_t n = 0; n < bubbles.size(); ++n)
            ownership_.want_copies(n, bubbles[n].center, bubbles[n].radius + beyond, to);
        return {domain_.processes(), std::move(to)};
    }

private:
    using Lists = std::vector<std::vector<std::uint32_t>>;
    Lists one_for_each_process() const { return Lists(static_cast<std::size_t>(domain_.processes().size())); }

    Domain& domain_;
    Ownership<D>& ownership_;
};

}  // namespace

template <int D>
std::unique_ptr<DeviceTeam<D>> make_device_team(Domain& domain, Ownership<D>& ownership) {
    if (!domain.several()) return nullptr;
    return std::make_unique<Team<D>>(domain, ownership);
}

template std::unique_ptr<DeviceTeam<2>> make_device_team<2>(Domain&, Ownership<2>&);
template std::unique_ptr<DeviceTeam<3>> make_device_team<3>(Domain&, Ownership<3>&);

}  // namespace lamella::bubble::detail
