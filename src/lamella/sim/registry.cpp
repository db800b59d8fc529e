#include "lamella/sim/registry.h"

#include <algorithm>

namespace lamella::sim {

void SolverRegistry::add(SolverEntry entry) { entries_.push_back(std::move(entry)); }

const SolverEntry* SolverRegistry::find(std::string_view name) const {
    const auto it = std::find_if(entries_.begin(), entries_.end(), [&](const auto& e) { return e.name == name; });
    return it == entries_.end() ? nullptr : &*it;
}

}  // namespace lamella::sim
