// SPDX-License-Identifier: MIT
//
// Reads devices as measured by `sk info --json`, as far as the compiler needs them.
#pragma once

#include <string>
#include <vector>

#include "ir/ir.hpp"

namespace skc::driver {

struct MeasuredDevice {
  std::string name;
  ir::Limits limits;
};

/// The devices of a file that draw; native ones have no limits. Throws std::runtime_error for a bad file.
std::vector<MeasuredDevice> readDevices(const std::string& file);

}  // namespace skc::driver
