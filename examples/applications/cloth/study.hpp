// SPDX-License-Identifier: MIT
//
// The numerics of the cloth, measured on a device: each study prints a table in Markdown, as it stands in docs/feedback.md
// (studies.sh puts it there).
#pragma once

#include <array>

#include <sk/sk.hpp>

#include "scene.hpp"
#include "simulation.hpp"
#include "support/study.hpp"
#include "support/table.hpp"

namespace examples {

Findings studyFall(sk::Device& device, bool);
Findings studyPendulum(sk::Device& device, bool);
Findings studyCatenary(sk::Device& device, bool);
Findings studyEnergy(sk::Device& device, bool);
Findings studyStability(sk::Device& device, bool);
Findings studyChaos(sk::Device& device, bool);
Findings studyCost(sk::Device& device, bool);

/// All of them, in the order of the documentation.
inline constexpr std::array<Study, 7> studies = {{
    {"fall", "does a point fall as far as it should, however small the step?", studyFall},
    {"pendulum", "is the period of a pendulum the closed form's?", studyPendulum},
    {"catenary", "does a chain hang in a catenary?", studyCatenary},
    {"energy", "what becomes of the energy in 100,000 steps?", studyEnergy},
    {"stability", "where is the limit of the time step, and where should it be?", studyStability},
    {"chaos", "how do single and double precision part, and what do they agree on?", studyChaos},
    {"cost", "what does each part of the model cost, beside all of it?", studyCost},
}};

/// What studies have in common.
struct Trial {
  const char* name;
  Verlet verlet;
  sk::Precision precision;
};
/// The textbook's form and ours in single precision, ours in more.
inline constexpr std::array<Trial, 4> trials = {{
    {"positions, single", Verlet::Positions, sk::Precision::Single},
    {"displacements, single", Verlet::Displacements, sk::Precision::Single},
    {"displacements, extended", Verlet::Displacements, sk::Precision::Extended},
    {"displacements, double", Verlet::Displacements, sk::Precision::Double},
}};

inline Simulation simulate(sk::Device& device, const Scene& scene,
                           sk::Precision precision = sk::Precision::Single) {
  return {device, scene, Features::of(scene), precision};
}

}  // namespace examples
