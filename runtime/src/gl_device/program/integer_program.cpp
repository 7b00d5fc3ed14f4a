// SPDX-License-Identifier: MIT
#include "gl_device/program/integer_program.hpp"

#include <algorithm>

namespace sk {

gl::IntUniform& IntegerProgram::find(std::string_view name, bool isVector) {
  const auto found = std::find_if(uniforms_.begin(), uniforms_.end(),
                                  [&](const auto& known) { return known.first == name; });
  if (found != uniforms_.end()) {
    return found->second;
  }
  const std::string owned(name);
  return uniforms_.emplace_back(owned, gl::IntUniform(program_.location(owned), isVector)).second;
}

}  // namespace sk
