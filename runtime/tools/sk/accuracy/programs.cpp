// SPDX-License-Identifier: MIT
#include "accuracy/programs.hpp"

#include <array>

namespace sk_tool {

std::span<const Program> programs() {
  static constexpr std::array<Program, 7> all{{
      {"sum", "a reduce that adds floats", measureSum},
      {"dot", "a reduce that adds products", measureDot},
      {"moments", "a reduce with two results, sum and sum of squares", measureMoments},
      {"diffusion", "steps of a stencil, each from the results of the one before", measureDiffusion},
      {"polynomial", "Horner's rule, also near a root of many", measurePolynomial},
      {"transcendentals", "exp, log, sin and the like", measureTranscendentals},
      {"tables", "a function, computed and looked up in tables", measureTables},
  }};
  return all;
}

}  // namespace sk_tool
