#pragma once

#include "lamella/solvers/bubble/options.h"

namespace lamella::bubble {

/// What to expect of several processes.
struct ProcessPlan {
    double bytes_per_bubble = 0.0;
    double processes = 1.0;   ///< a power of two
    double halo_share = 0.0;  ///< copies per own bubble with so many processes
    double memory = 0.0;      ///< of one of them [bytes]
};

/// Copies per own bubble where a foam is shared by so many processes: the shell of width <R> + R_max + skin around a
/// square or cubic part, filled like the part. For the foam at its start; as it coarsens, the share grows like
/// (N_0/N)^(1/d).
template <int D>
double halo_share(const Options& options, double processes);

/// The largest power of two for which an evaluation of the rates costs each process at most 1.25 times its share:
///   t(P) = N/P (c + c_halo s(P)) + 4 l log2 P
/// with c the time per bubble, c_halo that per copy (packing, sending, unpacking), s the halo share and l the latency of
/// one sum over two processes; an evaluation takes two to four sums or maxima.
template <int D>
ProcessPlan plan_processes(const Options& options);

}  // namespace lamella::bubble
