// SPDX-License-Identifier: MIT
#include "study.hpp"

#include <array>

namespace examples {
namespace {

constexpr std::array<Study, 8> all = {{
    {"stability", "the largest stable step of time, by bisection, against theory", studyStability},
    {"onset", "the Rayleigh number at which convection begins, under refinement", studyOnset},
    {"cavity", "Nusselt numbers of a cavity with warm and cold sides, against de Vahl Davis (1983)",
     studyCavity},
    {"conservation", "how well the total of heat stays", studyConservation},
    {"growth", "how single and double precision grow apart, and what stays alike", studyGrowth},
    {"stopping", "what it costs to ask whether a run has settled", studyStopping},
    {"tables", "what a table of tanh saves, and what it is off by", studyTables},
    {"broken", "what becomes of NaN, infinity and overflow in one cell", studyBroken},
}};

}  // namespace

std::span<const Study> studies() { return all; }

}  // namespace examples
