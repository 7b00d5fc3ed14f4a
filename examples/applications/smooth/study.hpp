// SPDX-License-Identifier: MIT
//
// The studies of `smooth --study NAME`: how far a flow is from one whose solution is known, and what each layout of the matrix costs, in tables of
// Markdown that the documentation shows.
#pragma once

#include <array>

#include <sk/sk.hpp>

#include "support/study.hpp"

namespace smooth {

using examples::Findings;
using examples::Study;

Findings studySphere(sk::Device& device, bool small);
Findings studyLayouts(sk::Device& device, bool small);

inline constexpr std::array<Study, 2> studies = {{
    {"sphere", "the radius of a sphere that shrinks, against sqrt(r^2 - 4 t), and the order of convergence",
     studySphere},
    {"layouts", "iterations, residual and time of a step with each layout of the matrix", studyLayouts},
}};

}  // namespace smooth
