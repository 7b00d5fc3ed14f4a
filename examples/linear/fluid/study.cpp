// SPDX-License-Identifier: MIT
#include "study.hpp"

#include <array>

namespace fluid {

namespace {

constexpr std::array<Study, 6> all = {{
    {"taylor_green", "the error of vortices whose solution is known, and the order of convergence",
     studyTaylorGreen},
    {"time", "the order of convergence in time", studyTime},
    {"energy", "what schemes of convection do to the energy of a flow without viscosity", studyEnergy},
    {"cavity", "a cavity with a moving lid, against Ghia, Ghia and Shin (1982)", studyCavity},
    {"poiseuille", "a channel, against the parabola", studyPoiseuille},
    {"cost", "what each part of a scene costs, and a scene without it saves", studyCost},
}};

}  // namespace

std::span<const Study> studies() { return all; }

}  // namespace fluid
