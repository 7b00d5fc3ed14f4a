// SPDX-License-Identifier: MIT
//
// The studies of `lattice --study NAME`: each measures one thing about the numerics and sets it against what theory says,
// in a table of Markdown, which the documentation shows.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <sk/sk.hpp>

#include "support/study.hpp"
#include "support/table.hpp"

namespace examples {

std::span<const Study> studies();

Findings studyStability(sk::Device& device, bool small);
Findings studyOnset(sk::Device& device, bool small);
Findings studyCavity(sk::Device& device, bool small);
Findings studyConservation(sk::Device& device, bool small);
Findings studyGrowth(sk::Device& device, bool small);
Findings studyStopping(sk::Device& device, bool small);
Findings studyTables(sk::Device& device, bool small);
Findings studyBroken(sk::Device& device, bool small);

}  // namespace examples
