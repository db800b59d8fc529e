#pragma once

#include "lamella/solvers/bubble/detail/device_view.h"

// One turn of the loops that advance a foam on a GPU by steps of rkc2 (see rkc2.cpp, whose bits this repeats): update
// each bubble (device_update.h), gather over its contacts (device_gather.h), decide (device_decide.h). The phase says
// what a turn does; decisions are taken by one thread on what the loops have added up, and the host is asked only for
// new neighbor lists.

namespace lamella::bubble::detail {

using UpdateSums = Reduction<3, 5>;
using GatherSums = Reduction<2, 6>;

}  // namespace lamella::bubble::detail
