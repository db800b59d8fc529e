#pragma once

#include "lamella/film/problem.h"
#include "lamella/solvers/melp/options.h"

namespace lamella::melp {

/// @throws InputError  films that this solver does not know, or several bubbles that it could not follow through a
/// contact
void refuse_unknown_films(const film::Problem& films, const Options& options);

}  // namespace lamella::melp
