#include "lamella/linalg/detail/multigrid.h"

namespace lamella::linalg::detail {

bool has_multigrid() { return false; }
std::unique_ptr<Multigrid> make_multigrid(const SymmetricMatrix&) { return nullptr; }

}  // namespace lamella::linalg::detail
