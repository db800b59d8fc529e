#pragma once

#include "lamella/solvers/bubble/domain.h"
#include "lamella/solvers/bubble/foam.h"
#include "lamella/solvers/bubble/gas_sums.h"
#include "lamella/solvers/bubble/model.h"
#include "lamella/spatial/neighbor_list.h"

namespace lamella::bubble {

/// A state whose rates are wanted: the current one, or a stage inside a step. Removed bubbles have radius 0 and
/// inverse radius 0. Columns are as long as the foam's.
template <int D>
struct Stage {
    Columns<D> position;
    Column radius;
    Column inverse_radius;

    void resize(std::size_t length) {
        for (auto& column : position) column.resize(length);
        radius.resize(length);
        inverse_radius.resize(length);
    }
};

/// What the contact pass finds for each bubble.
template <int D>
struct Rates {
    Columns<D> velocity;  ///< dx/dt
    Column film;          ///< sum_j A_ij (1/R_j - 1/R_i)
    Column weight;        ///< w_i of the exchange through the liquid, e.g. the free surface A_i^f

    void resize(std::size_t length) {
        for (auto& column : velocity) column.resize(length);
        film.resize(length);
        weight.resize(length);
    }
};

struct Evaluation {
    GasExchange gas;
    double stiffness = 0.0;  ///< bound of the largest relaxation rate [1/time], where it was asked for
};

enum class Gas { kOff, kOn };
enum class Stiffness { kSkip, kBound };

/// One pass over all contacts: velocities by eq. 2.15 without the liquid's own motion, film exchange, free surface,
/// and the sums that close the gas exchange.
///
/// The bound on the relaxation rate: the pushes are -grad of a potential whose Hessian is at most
/// sum_contacts (F_0/(mu_0 S)) n n^T, so its largest eigenvalue is at most 2 max_i lambda_max(sum_j n n^T/S) F_0/mu_0;
/// exact for a triangular lattice. Exchange of gas adds at most 2 K (1 + kappa) / R_min^2.
///
/// @param also    if given, becomes its largest over all processes: it goes with the sums, which saves a wait
/// @param domain  refreshes the copies in `stage`: what was begun is ended here, behind the bubbles that need no copies
template <int D>
Evaluation contact_pass(const Model& model,
                        const spatial::PeriodicBox<D>& box,
                        const spatial::NeighborList<D>& neighbors,
                        const Stage<D>& stage,
                        Gas gas,
                        Stiffness stiffness,
                        Domain& domain,
                        std::size_t live,
                        Rates<D>& rates,
                        double* also = nullptr);

}  // namespace lamella::bubble
