#include "lamella/sim/frame.h"

#include <algorithm>

namespace lamella::sim {
namespace {

template <class Items>
auto find_named(const Items& items, std::string_view name) -> decltype(items.data()) {
    const auto it = std::find_if(items.begin(), items.end(), [&](const auto& item) { return item.name == name; });
    return it == items.end() ? nullptr : &*it;
}

}  // namespace

const Field* Points::find(std::string_view name) const { return find_named(fields, name); }

const Scalar* Frame::find_scalar(std::string_view name) const { return find_named(scalars, name); }

}  // namespace lamella::sim
