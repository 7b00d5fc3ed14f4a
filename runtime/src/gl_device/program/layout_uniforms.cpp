// SPDX-License-Identifier: MIT
#include "gl_device/program/layout_uniforms.hpp"

#include <string>

namespace sk {

LayoutUniforms::LayoutUniforms(const gl::Program& program, std::string_view names) {
  const std::size_t star = names.find('*');
  const auto location = [&](std::string_view part) {
    std::string name(names);
    name.replace(star, 1, part);
    return program.location(name);
  };
  origin_ = {location("origin"), true};
  shape_ = {location("shape"), true};
  stride_ = {location("stride"), true};
  shift_ = {location("shift"), false};
  low_ = {location("low"), true};
  high_ = {location("high"), true};
  whole_ = {location("whole"), true};
}

}  // namespace sk
