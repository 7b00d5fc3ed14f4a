// SPDX-License-Identifier: MIT
#include "study.hpp"

#include <array>

namespace fluid {

namespace {

constexpr std::array<Study, 5> all = {{
    {"taylor_green", "the error of vortices whose solution is known, and the order of convergence", studyTaylorGreen},
    {"time", "the order of convergence in time", studyTime},
    {"energy", "what schemes of convection do to the energy of a flow without viscosity", studyEnergy},
    {"cavity", "a cavity with a moving lid, against Ghia, Ghia and Shin (1982)", studyCavity},
    {"poiseuille", "a channel, against the parabola", studyPoiseuille},
}};

}  // namespace

std::span<const Study> studies() { return all; }

}  // namespace fluid
