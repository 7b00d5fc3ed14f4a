// SPDX-License-Identifier: MIT
//
// Which components draws write. Passes write all, unless a scope of this kind is open.
#pragma once

#include <array>

#include "gl/bound_state.hpp"

namespace sk::gl {

using ColorMask = std::array<bool, 4>;

class ColorMaskScope {
 public:
  ColorMaskScope(BoundState& bound, const ColorMask& mask) {
    bound.spoil();
    set(mask);
  }
  ~ColorMaskScope() { set({true, true, true, true}); }
  ColorMaskScope(const ColorMaskScope&) = delete;
  ColorMaskScope& operator=(const ColorMaskScope&) = delete;

 private:
  static void set(const ColorMask& mask);
};

}  // namespace sk::gl
