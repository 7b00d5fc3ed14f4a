// SPDX-License-Identifier: MIT
//
// What linear theory says: how large a step of time may be, each operator's own limit from the eigenvalues of its differences; and where
// convection begins between plates of infinite extent (S. Chandrasekhar, "Hydrodynamic and Hydromagnetic Stability", 1961, chapter II).
#pragma once

#include <string>
#include <vector>

#include "model.hpp"

namespace examples {

struct Limit {
  std::string of;  ///< "diffusion"
  std::string formula;  ///< "h^2 / 4D"
  double largest = 0.0;  ///< stable up to here; infinite where nothing limits it
  double chosen = 0.0;  ///< the step that the model takes
  bool holds() const { return chosen <= largest; }
};

/// The largest stable explicit step of diffusion in `dimensions`: the Laplacian's eigenvalues reach down to
/// -4 dimensions / h^2, and 1 - 4 dimensions D dt / h^2 must stay above -1.
double diffusionLimit(double rate, double spacing, int dimensions);

/// That of Gray-Scott about u = 1, v = 0, where u decays by F beside diffusing.
double reactionLimit(const Reaction& reaction, int dimensions);

/// That of velocity and pressure, at rest, in the plane: of a wave of sound whose differences are the largest, eigenvalues l obey
/// l^2 - (2 - a - s) l + 1 - a = 0, a = 8 (nu + lambda) dt / h^2, s = 8 c^2 dt^2 / h^2, which stay in the unit circle
/// while 2 c^2 dt^2 + 4 (nu + lambda) dt <= h^2. A wind u needs u^2 dt < 2 nu beside it.
double soundLimit(const Flow& flow, double spacing);

/// Dimensions in which there is more than one cell: a difference to oneself is none.
int dimensionsOf(const Grid& grid);

/// All that the model has.
std::vector<Limit> limitsOf(const Model& model);

/// The Rayleigh number above which rolls of wave number k (times the height) grow between plates without friction:
/// (pi^2 + k^2)^3 / k^2; the least is 657.511, at k = 2.2214.
double criticalBetweenFreePlates(double k);

/// The same between rigid ones, by bisection of the characteristic equation of even modes; the least is 1707.762, at 3.117.
/// For k from 1 to 8.
double criticalBetweenRigidPlates(double k);

}  // namespace examples
