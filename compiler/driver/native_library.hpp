// SPDX-License-Identifier: MIT
//
// Compiles the library of native code with the frontend, on which compiler/native must not depend.
#pragma once

#include "native/library/link_library.hpp"

namespace skc::driver {

/// See native::linkLibrary().
native::LinkedFunctions linkNativeLibrary(ir::Module& module);
/// The function with which native::compile() compiles the library.
ir::Module compileLibrary(std::string_view file, std::string_view text);

}  // namespace skc::driver
