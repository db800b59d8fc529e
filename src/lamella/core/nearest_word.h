#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace lamella {

/// Number of single-letter changes (insert, delete, replace, swap of neighbors) that turn `a` into `b`; letter case and
/// '-' against '_' do not count.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The candidate that `word` was probably meant to be, or nothing when none is near (more than a third of its letters
/// differ). Of equally near ones the first.
std::optional<std::string> nearest_word(std::string_view word, std::span<const std::string> candidates);

}  // namespace lamella
