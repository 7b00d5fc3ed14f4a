// SPDX-License-Identifier: MIT
//
// Where convection begins between plates of infinite extent, by linear theory (S. Chandrasekhar, "Hydrodynamic and
// Hydromagnetic Stability", 1961, chapter II).
#pragma once

namespace examples {

/// The Rayleigh number above which rolls of wave number k (times the height) grow between plates without friction:
/// (pi^2 + k^2)^3 / k^2; the least is 657.511, at k = 2.2214.
double criticalBetweenFreePlates(double k);

/// The same between rigid ones, by bisection of the characteristic equation of even modes; the least is 1707.762, at 3.117.
/// For k from 1 to 8.
double criticalBetweenRigidPlates(double k);

}  // namespace examples
