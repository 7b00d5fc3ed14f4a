// SPDX-License-Identifier: MIT
//
// The studies that `PROGRAM --study NAME` of an example runs. Each prints tables of Markdown, which figures.sh writes into the documentation.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <sk/sk.hpp>

#include "support/verification.hpp"

namespace examples {

struct Findings {
  std::string table;  ///< one or more tables, with an empty line between two of them
  std::vector<Verification> verifications{};
};

struct Study {
  std::string_view name;
  std::string_view does;  ///< what it finds out, for --help
  Findings (*run)(sk::Device& device, bool small);  ///< small: for tests, coarse and quick
};

}  // namespace examples
