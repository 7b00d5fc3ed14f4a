// SPDX-License-Identifier: MIT
#include "glsl.hpp"

#include <utility>

#include "glslang.hpp"

namespace fuzz {

std::string glslComplaint(const std::vector<std::string>& listings) {
  std::vector<std::string> programs;
  for (const std::string& listing : listings) {
    for (std::string& program : glslang::programsOf(listing)) programs.push_back(std::move(program));
  }
  for (const std::vector<glslang::Complaint>& ofProgram : glslang::complaintsOf(programs)) {
    if (ofProgram.empty()) continue;
    const glslang::Complaint& first = ofProgram.front();
    return "glslang: " + std::to_string(first.source) + ":" + std::to_string(first.line) + ": " + first.text;
  }
  return {};
}

}  // namespace fuzz
