// SPDX-License-Identifier: MIT
//
// The GLSL functions that assembled programs share (functions.glsl).
#include "glsl_text/functions.hpp"
#include "assemble/glsl/program_text.hpp"

namespace sk::assemble {

std::string_view text(Function function) {
  switch (function) {
    case Function::Unravel2: return library::unravel2;
    case Function::Unravel3: return library::unravel3;
    case Function::Unravel4: return library::unravel4;
    case Function::Ravel: return library::ravel;
    case Function::Texel: return library::texel;
    case Function::Paired: return library::paired;
    case Function::Divide: return library::divide;
    case Function::Row: return library::row;
    case Function::Layered: return library::layered;
    case Function::Wrap: return library::wrap;
    case Function::WrapOnce: return library::wrapOnce;
    case Function::Mirror: return library::mirror;
    case Function::MirrorOnce: return library::mirrorOnce;
    case Function::ToHalf: return library::toHalf;
    case Function::Ramp: return library::ramp;
    case Function::Local: return library::local;
    case Function::Sampled: return library::sampled;
  }
  return {};
}

}  // namespace sk::assemble
