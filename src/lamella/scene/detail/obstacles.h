#pragma once

#include "lamella/core/error.h"
#include "lamella/scene/film_tables.h"

namespace lamella::scene::detail {

/// [[solid]] and [[wall]], checked. @param where  the table, for messages
film::Solid solid_of(const SolidTable& table, const SourceLocation& where);
film::Wall wall_of(const WallTable& table, const SourceLocation& where);

}  // namespace lamella::scene::detail
