// SPDX-License-Identifier: MIT
//
// One step of a model in double precision, as plain loops on the host that share nothing with the kernels but the
// coefficients. Fields grow apart from those of a device as their patterns do; one step from the same fields cannot.
#pragma once

#include <map>
#include <vector>

#include "lattice.hpp"
#include "model.hpp"
#include "support/verification.hpp"

namespace examples {

/// Fields row-major from the bottom.
using State = std::map<Field, std::vector<double>>;

State readState(Lattice& lattice);

struct ExactStep {
  State state;
  /// Cells whose neighbour is too near to the boiling point to say in which phase a rounding leaves it.
  std::vector<bool> doubtful;
};
ExactStep stepExactly(const Model& model, const State& state);

/// A step that the device made, from `before` to `after`, against the same in double. The bound counts roundings of the
/// largest numbers that a step adds up, and what a table of tanh is off by, `tableError`.
Verification checkStep(const Model& model, const State& before, const State& after, double tableError);

}  // namespace examples
