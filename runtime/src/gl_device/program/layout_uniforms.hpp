// SPDX-License-Identifier: MIT
//
// The uniforms that hold the region layout of a parameter or of the domain.
#pragma once

#include <string>
#include <string_view>

#include "assemble/region_layout.hpp"
#include "gl/program.hpp"
#include "gl/uniform.hpp"

namespace sk {

class LayoutUniforms {
 public:
  LayoutUniforms() = default;
  /// `names` is the pattern of the uniforms' names, in which `*` stands for origin, shape, stride, shift, low,
  /// high and whole.
  LayoutUniforms(const gl::Program& program, std::string_view names) {
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

  /// The program must be bound.
  void set(gl::BoundState& bound, const assemble::RegionLayout& regionLayout) {
    origin_.set(bound, regionLayout.origin);
    shape_.set(bound, regionLayout.extent);
    stride_.set(bound, regionLayout.stride);
    shift_.set(bound, regionLayout.shift);
    if (!regionLayout.placed) return;
    low_.set(bound, regionLayout.place.low);
    high_.set(bound, regionLayout.place.high);
    whole_.set(bound, regionLayout.place.whole);
  }

 private:
  gl::IntUniform origin_, shape_, stride_, shift_, low_, high_, whole_;
};

}  // namespace sk
