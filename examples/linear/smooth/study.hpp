// SPDX-License-Identifier: MIT
//
// The studies of `smooth --study NAME`: how far a flow is from one whose solution is known, and what each layout of the matrix costs, in tables of
// Markdown that the documentation shows.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <sk/sk.hpp>

#include "support/study.hpp"

namespace smooth {

using examples::Findings;
using examples::Study;

std::span<const Study> studies();

Findings studySphere(sk::Device& device, bool small);
Findings studyLayouts(sk::Device& device, bool small);

}  // namespace smooth
