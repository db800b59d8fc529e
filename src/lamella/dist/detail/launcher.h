#pragma once

namespace lamella::dist::detail {

/// What the environment says of a launcher that started this process.
struct Launch {
    bool launched = false;  ///< by something that speaks MPI's process managers
    int processes = 1;      ///< as far as the environment knows
    int on_this_machine = 1;
    int rank_on_this_machine = 0;
};
Launch launch();

}  // namespace lamella::dist::detail
