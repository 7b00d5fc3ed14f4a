// SPDX-License-Identifier: MIT
//
// A request for native code of one kernel. The stub makes it (program/stub.hpp), compile() serves it
// (native.hpp).
#pragma once

#include <string>

#include "ir/ir.hpp"

namespace skc::native {

struct KernelRequest {
  ir::KernelId kernel;
  std::string symbol;  ///< the name of its Code
  bool inDoubles = false;  ///< also compiled with double in place of float
  bool inQuads = false;  ///< also compiled with binary128 in place of float
  bool scans = false;  ///< a fold of a scan, which stores its accumulators after, or before, each element
  bool isCold = false;  ///< computes few elements: one level of the CPU is enough
  bool onlyCombines = false;  ///< a reduction that only combines partial results of another
};

}  // namespace skc::native
