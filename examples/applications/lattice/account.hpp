// SPDX-License-Identifier: MIT
//
// What a scene's steps cost beside those of a program that models everything: measured, on the scene's own lattice.
#pragma once

#include <string>

#include "reference.hpp"
#include "scene.hpp"
#include "support/verification.hpp"

namespace examples {

struct Cost {
  std::string operators;
  int streams = 0;
  double passes = 0.0;  ///< a step
  double bytes = 0.0;  ///< read and written in a step
  double milliseconds = 0.0;  ///< a step: the median of several runs, in turns with the other
};

struct Account {
  Cost scene, full;
  Verification agreement;  ///< that both have made the same of the fields that they share
  std::string text() const;  ///< a table, for people
};

/// Steps the scene's model and the full one from `state`, in turns.
Account accountFor(sk::Device& device, const Scene& scene, const State& state);

}  // namespace examples
