// SPDX-License-Identifier: MIT
//
// What `PROGRAM --study NAME` of an example runs and finds out. It prints tables of Markdown, which figures.sh writes into the documentation.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <sk/sk.hpp>

#include "support/verification.hpp"

namespace examples {

struct Findings {
  std::string table;  ///< one or more tables, with an empty line between two of them
  std::vector<Verification> verifications;
};

struct Study {
  std::string_view name;
  std::string_view asks;  ///< what it finds out
  Findings (*run)(sk::Device& device, bool small);  ///< small: for tests, coarse and quick
};

}  // namespace examples
