// SPDX-License-Identifier: MIT
//
// The uniforms that tell a program where a region lies: of a parameter, or of the domain.
#pragma once

#include <string_view>

#include "assemble/region_layout.hpp"
#include "gl/program.hpp"
#include "gl/uniform.hpp"

namespace sk {

class LayoutUniforms {
 public:
  LayoutUniforms() = default;
  /// `names`: what the uniforms are called, `*` standing for origin, shape, stride and shift.
  LayoutUniforms(const gl::Program& program, std::string_view names);

  /// Its program must be bound.
  void set(const assemble::RegionLayout& regionLayout) {
    origin_.set(regionLayout.origin);
    shape_.set(regionLayout.extent);
    stride_.set(regionLayout.stride);
    shift_.set(regionLayout.shift);
  }

 private:
  gl::IntUniform origin_, shape_, stride_, shift_;
};

}  // namespace sk
