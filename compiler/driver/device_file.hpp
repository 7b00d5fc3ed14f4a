// SPDX-License-Identifier: MIT
//
// Devices as `sk info --json` has measured them: what of them is known to the compiler.
#pragma once

#include <string>
#include <vector>

#include "ir/ir.hpp"

namespace skc::driver {

struct MeasuredDevice {
  std::string name;
  ir::Limits limits;
};

/// Those of a file that draw: native ones have no limits. Throws std::runtime_error saying what is wrong with the file.
std::vector<MeasuredDevice> readDevices(const std::string& file);

}  // namespace skc::driver
