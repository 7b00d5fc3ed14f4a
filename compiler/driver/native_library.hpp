// SPDX-License-Identifier: MIT
//
// The library of native code, compiled by the frontend, which compiler/native must not know.
#pragma once

#include "native/library/link_library.hpp"

namespace skc::driver {

/// See native::linkLibrary().
native::LinkedFunctions linkNativeLibrary(ir::Module& module);

}  // namespace skc::driver
