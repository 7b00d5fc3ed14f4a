// SPDX-License-Identifier: MIT
//
// What a program is run with: the ends of what its kernels are given, and other sizes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "stress/observation.hpp"

namespace sk_tool::stress {

struct Case {
  enum class Kind : std::uint8_t { AsItIs, Value, Size } kind = Kind::AsItIs;
  std::string text = {};  ///< "heat::step.dt = 0.5, the upper end of its range"
  std::vector<std::string> settings = {};  ///< for the option set= of SK_SHADOW
  std::int64_t size = 0;  ///< in the place of the sizes in braces
  bool mustHold = false;  ///< a declared range has the value, or the program takes sizes
  bool hasNan = false;  ///< a NaN is given, so that some results have none either
};

/// The ends of what kernels are given: those of declared ranges; else 0, the smallest and the largest number of the type, and a
/// NaN in the middle of a stream. What the program as it is gives is left out, and so are parameters of no `only` pattern
/// ("heat::*", "heat::step.dt"); all of them if there is none. Values of one name that several kernels are given alike change together.
std::vector<Case> valueCases(const std::vector<Given>& given, const std::vector<std::string>& only);

/// Whether a word of a command line has a size in braces: "--size={256}".
bool hasSize(const std::string& word);
/// The word with another size in the place of each that is in braces; with its own if it is 0.
std::string withSize(const std::string& word, std::int64_t size);

}  // namespace sk_tool::stress
