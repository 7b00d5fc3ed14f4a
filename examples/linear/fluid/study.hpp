// SPDX-License-Identifier: MIT
//
// The studies of `fluid --study NAME`: flows whose solution is known, and how far ours are from it, in tables of Markdown that the documentation shows.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <sk/sk.hpp>

#include "support/study.hpp"

namespace fluid {

using examples::Findings;
using examples::Study;

std::span<const Study> studies();

Findings studyTaylorGreen(sk::Device& device, bool small);
Findings studyTime(sk::Device& device, bool small);
Findings studyEnergy(sk::Device& device, bool small);
Findings studyCavity(sk::Device& device, bool small);
Findings studyPoiseuille(sk::Device& device, bool small);
Findings studyCost(sk::Device& device, bool small);

}  // namespace fluid
