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

#include "support/verification.hpp"

namespace smooth {

struct Findings {
  std::string table;  ///< one or more tables, with an empty line between two of them
  std::vector<examples::Verification> verifications;
};

struct Study {
  std::string_view name;
  std::string_view asks;  ///< what it finds out
  Findings (*run)(sk::Device& device, bool small);  ///< small: for tests, coarse and quick
};

std::span<const Study> studies();

Findings studySphere(sk::Device& device, bool small);
Findings studyLayouts(sk::Device& device, bool small);

}  // namespace smooth
