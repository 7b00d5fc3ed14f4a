// SPDX-License-Identifier: MIT
#include "assemble/glsl/longs.hpp"

#include "glsl_text/longs.hpp"

namespace sk::assemble {

std::string longDefinitions(bool besideDoubles) {
  std::string text(library::integers);
  if (besideDoubles) text += library::conversions;
  return text;
}

}  // namespace sk::assemble
