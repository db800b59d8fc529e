#pragma once

#include "lamella/solvers/bubble/options.h"

namespace lamella::bubble {

/// What to expect of several processes.
struct ProcessPlan {
    double processes = 1.0;     ///< a power of two
    double halo_share = 0.0;    ///< copies per own bubble with so many processes
    double memory_alone = 0.0;  ///< the most that one process on its own needs [bytes]
    double memory = 0.0;        ///< the most that each of so many needs [bytes]
};

/// Copies per own bubble where a foam is shared by so many processes: the shell of width <R> + R_max + skin around a
/// part of the recursive bisection, filled like the part. For the foam at its start; as it coarsens, the share grows
/// like (N_0/N)^(1/d).
template <int D>
double halo_share(const Options& options, double processes);

/// The most memory that one of so many processes needs: state and neighbor lists, and what a frame takes. [bytes]
template <int D>
double process_memory(const Options& options, double processes);

/// The largest power of two for which an evaluation of the rates costs each process at most 1.25 times its share:
///   t(P) = N/P (c + c_halo s(P)) + 4 l log2 P
/// with c the time per bubble, c_halo that per copy (packing, sending, unpacking), s the halo share and l the latency
/// of one sum over two processes.
template <int D>
ProcessPlan plan_processes(const Options& options);

}  // namespace lamella::bubble
