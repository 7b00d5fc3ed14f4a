// SPDX-License-Identifier: MIT
//
// glslangValidator, the reference compiler of GLSL, over what skc writes: many programs in one process, and its
// messages as data.
#pragma once

#include <string>
#include <vector>

namespace glslang {

/// The programs of a listing (skc --emit=glsl), each from its #version line on.
std::vector<std::string> programsOf(const std::string& listing);

struct Complaint {
  int source;  ///< source string number: 0 the program itself, else the file of #line
  int line;
  std::string text;
};

/// What glslang complains of in fragment and compute programs, program by program. Throws std::runtime_error where it cannot
/// be run.
std::vector<std::vector<Complaint>> complaintsOf(const std::vector<std::string>& programs);

}  // namespace glslang
