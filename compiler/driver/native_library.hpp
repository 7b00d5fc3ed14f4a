// SPDX-License-Identifier: MIT
//
// The library of native code, compiled by the frontend, which compiler/native must not know.
#pragma once

#include "native/library/link_library.hpp"

namespace skc::driver {

/// See native::linkLibrary().
native::LinkedFunctions linkNativeLibrary(ir::Module& module);
/// What native::compile() compiles the library with.
ir::Module compileLibrary(std::string_view file, std::string_view text);

}  // namespace skc::driver
