// SPDX-License-Identifier: MIT
//
// Checks the GLSL that skc writes with glslangValidator, the reference compiler: many programs in one process, with its
// messages as data.
#pragma once

#include <string>
#include <vector>

namespace glslang {

/// The programs of a listing (skc --emit=glsl), each from its #version line on.
std::vector<std::string> programsOf(const std::string& listing);

struct Complaint {
  int source;  ///< source string number: 0 for the program itself, else the file that a #line names
  int line;
  std::string text;
};

/// glslang's complaints about each of these fragment and compute programs. Throws std::runtime_error if glslang cannot be
/// run.
std::vector<std::vector<Complaint>> complaintsOf(const std::vector<std::string>& programs);

}  // namespace glslang
