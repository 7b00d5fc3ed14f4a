// SPDX-License-Identifier: MIT
//
// Makes a failing case smaller.
#pragma once

#include <functional>
#include <optional>
#include <span>

#include "numbers/case.hpp"

namespace fuzz::numbers {

/// The number of the first of some cases that fails, and how.
struct Failure {
  std::size_t number;
  std::string what;
};
using FindFailure = std::function<std::optional<Failure>(std::span<const Case>)>;

struct Shrunk {
  Case smallest;
  std::string what;
};

/// The smallest case that was found to fail, after at most `budget` attempts, in which `find` is shown up to `together` cases at once.
Shrunk shrunk(Case failing, std::string what, const FindFailure& find, int budget, std::size_t together);

}  // namespace fuzz::numbers
