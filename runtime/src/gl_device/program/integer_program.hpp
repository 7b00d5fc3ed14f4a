// SPDX-License-Identifier: MIT
//
// A program that the runtime wrote for a step of its own, such as one of an append output or of a sort.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <utility>

#include "gl/program.hpp"
#include "gl/uniform.hpp"

namespace sk {

/// A program with integer uniforms, which are set by name. It must be bound to set them.
class IntegerProgram {
 public:
  explicit IntegerProgram(gl::Program&& program) : program_(std::move(program)) {}

  void set(gl::BoundState& bound, std::string_view uniform, std::int32_t value) {
    find(uniform, false).set(bound, value);
  }
  void set(gl::BoundState& bound, std::string_view uniform, const gl::Int4& value) {
    find(uniform, true).set(bound, value);
  }
  /// The uniform `sk_domain_row` of programs that draw to layers.
  gl::IntUniform& row() { return find("sk_domain_row", false); }
  const gl::Program& program() const { return program_; }

 private:
  gl::IntUniform& find(std::string_view name, bool isVector) {
    const auto found =
        std::ranges::find_if(uniforms_, [&](const auto& known) { return known.first == name; });
    if (found != uniforms_.end()) return found->second;
    const std::string owned(name);
    return uniforms_.emplace_back(owned, gl::IntUniform(program_.location(owned), isVector)).second;
  }

  gl::Program program_;
  std::deque<std::pair<std::string, gl::IntUniform>> uniforms_;  ///< a loop's commands refer to them
};

}  // namespace sk
