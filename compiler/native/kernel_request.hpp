// SPDX-License-Identifier: MIT
//
// What the native back end is asked for, kernel by kernel. The stub says it (program/stub.hpp), compile() does it (native.hpp).
#pragma once

#include <string>

#include "ir/ir.hpp"

namespace skc::native {

/// A kernel that gets native code.
struct KernelRequest {
  ir::KernelId kernel;
  std::string symbol;  ///< of its Code
  bool inDoubles = false;  ///< computing in double, too, wherever the kernel says float
  bool inQuads = false;  ///< and in binary128
  bool isCold = false;  ///< computes a handful of elements: one level of the CPU does
  bool onlyCombines = false;  ///< a reduce that nothing runs but to combine partial results of another
};

}  // namespace skc::native
