#pragma once

#include "lamella/dist/communicator.h"

#include <cstdint>

namespace lamella::dist {

/// Collective. Every process needs a device of its own.
/// @param identity  of the device that this process has taken, different for any two devices of any machine
/// @throws InputError  on all processes: some of them have the same device
void require_own_devices(Communicator& processes, std::int64_t identity);

}  // namespace lamella::dist
