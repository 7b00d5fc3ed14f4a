// SPDX-License-Identifier: MIT
//
// glslangValidator over listings of skc: many programs in one process, and its messages as data.
#pragma once

#include <string>
#include <vector>

namespace golden {

/// The programs of a listing, each from its #version line on.
std::vector<std::string> programsOf(const std::string& listing);

struct Complaint {
  int source;          ///< source string number: 0 the program itself, else the file of #line
  int line;
  std::string text;
};

/// What glslang complains of in fragment programs, program by program.
std::vector<std::vector<Complaint>> complaintsOf(const std::vector<std::string>& programs);

}  // namespace golden
