// SPDX-License-Identifier: MIT
//
// Named points (F, k) of the reaction of Gray and Scott, and what their patterns look like.
#pragma once

#include <string_view>

namespace examples {

/// A class of patterns and a point (F, k) that shows it.
struct Pattern {
  std::string_view name;
  double feed;  ///< F
  double kill;  ///< k
  std::string_view looks;
};
/// Throws std::runtime_error, listing the names, for an unknown one.
const Pattern& findPattern(std::string_view name);

}  // namespace examples
