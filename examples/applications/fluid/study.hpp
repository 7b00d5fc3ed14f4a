// SPDX-License-Identifier: MIT
//
// The studies of `fluid --study NAME`: flows whose solution is known, and how far ours are from it, in tables of Markdown that the documentation shows.
#pragma once

#include <array>

#include <sk/sk.hpp>

#include "support/study.hpp"

namespace fluid {

using examples::Findings;
using examples::Study;

Findings studyTaylorGreen(sk::Device& device, bool small);
Findings studyTime(sk::Device& device, bool small);
Findings studyEnergy(sk::Device& device, bool small);
Findings studyCavity(sk::Device& device, bool small);
Findings studyPoiseuille(sk::Device& device, bool small);
Findings studyCost(sk::Device& device, bool small);

inline constexpr std::array<Study, 6> studies = {{
    {"taylor_green", "the error of vortices whose solution is known, and the order of convergence",
     studyTaylorGreen},
    {"time", "the order of convergence in time", studyTime},
    {"energy", "what schemes of convection do to the energy of a flow without viscosity", studyEnergy},
    {"cavity", "a cavity with a moving lid, against Ghia, Ghia and Shin (1982)", studyCavity},
    {"poiseuille", "a channel, against the parabola", studyPoiseuille},
    {"cost", "what each part of a scene costs, and a scene without it saves", studyCost},
}};

}  // namespace fluid
