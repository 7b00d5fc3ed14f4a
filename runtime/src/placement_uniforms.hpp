// SPDX-License-Identifier: MIT
//
// The uniforms that tell a program where a region lies: of a parameter, or of the domain.
#pragma once

#include <string_view>

#include "assemble/placement.hpp"
#include "gl/program.hpp"
#include "gl/uniform.hpp"

namespace sk {

class PlacementUniforms {
 public:
  PlacementUniforms() = default;
  /// `names`: what the uniforms are called, `*` standing for origin, shape, stride and shift.
  PlacementUniforms(const gl::Program& program, std::string_view names);

  /// Its program must be bound.
  void set(const assemble::Placement& placement) {
    origin_.set(placement.origin);
    shape_.set(placement.extent);
    stride_.set(placement.stride);
    shift_.set(placement.shift);
  }

 private:
  gl::IntUniform origin_, shape_, stride_, shift_;
};

}  // namespace sk
