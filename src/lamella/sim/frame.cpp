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

const Field* Surface::find_of_vertices(std::string_view name) const { return find_named(vertex_fields, name); }
const Field* Surface::find_of_faces(std::string_view name) const { return find_named(face_fields, name); }
const Field* Surface::find_of_regions(std::string_view name) const { return find_named(region_fields, name); }

std::size_t Surface::regions_described() const {
    if (region_fields.empty() || region_fields[0].components < 1) return 0;
    return region_fields[0].values.size() / static_cast<std::size_t>(region_fields[0].components);
}

const Scalar* Frame::find_scalar(std::string_view name) const { return find_named(scalars, name); }

}  // namespace lamella::sim
