// SPDX-License-Identifier: MIT
//
// The studies of `waves --study NAME`, in tables of Markdown that the documentation shows.
#pragma once

#include <array>
#include <vector>

#include <sk/sk.hpp>

#include "support/study.hpp"
#include "surface.hpp"

namespace waves {

using examples::Findings;
using examples::Study;

/// A standing wave with `x` and `y` half waves along the two dimensions.
struct Mode {
  int x = 1, y = 0;
};

/// The angular frequency of a mode, and the factor of its amplitude in each step.
struct Oscillation {
  double frequency = 0.0, gain = 1.0;
};

std::vector<double> heightsOf(const Mode& mode, const Model& model);
/// The mode's angular frequency by the wave equation.
double exactFrequency(const Mode& mode, const Model& model);
/// The mode's oscillation by the scheme: an eigenvalue of its step on an eigenvector of the discrete Laplacian.
Oscillation schemeOscillation(const Mode& mode, const Model& model);

struct Measured {
  Oscillation oscillation;
  double residual = 0.0;  ///< the largest of all steps
};
/// From the amplitudes in a time series of a simulation, which fit a(n+1) = 2 g cos(w dt) a(n) - g^2 a(n-1).
Measured measure(sk::Device& device, const Model& model, const Mode& mode, std::int64_t steps);

Findings studyDispersion(sk::Device& device, bool small);
Findings studyEnergy(sk::Device& device, bool small);

inline constexpr std::array<Study, 2> studies = {{
    {"dispersion", "the frequency of standing waves against the scheme's and the wave equation's",
     studyDispersion},
    {"energy", "what becomes of the energy in many steps", studyEnergy},
}};

}  // namespace waves
