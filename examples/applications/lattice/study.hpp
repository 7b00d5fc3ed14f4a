// SPDX-License-Identifier: MIT
//
// The studies of `lattice --study NAME`: each measures one thing about the numerics and sets it against what theory says,
// in a table of Markdown, which the documentation shows.
#pragma once

#include <array>

#include <sk/sk.hpp>

#include "support/study.hpp"
#include "support/table.hpp"

namespace examples {

Findings studyStability(sk::Device& device, bool small);
Findings studyOnset(sk::Device& device, bool small);
Findings studyCavity(sk::Device& device, bool small);
Findings studyConservation(sk::Device& device, bool small);
Findings studyGrowth(sk::Device& device, bool small);
Findings studyStopping(sk::Device& device, bool small);
Findings studyTables(sk::Device& device, bool small);
Findings studyBroken(sk::Device& device, bool small);

inline constexpr std::array<Study, 8> studies = {{
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

}  // namespace examples
