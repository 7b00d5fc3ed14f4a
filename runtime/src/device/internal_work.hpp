// SPDX-License-Identifier: MIT
//
// Marks what the runtime does on its own, so that nobody takes it for the application's.
#pragma once

#include "device/device_state.hpp"

namespace sk {

/// While it lives, the runtime works on its own: calls and reads are parts of something that the application asked for.
class InternalWork {
 public:
  explicit InternalWork(DeviceState& device) : device_(device) { ++device_.internalWork; }
  ~InternalWork() { --device_.internalWork; }
  InternalWork(const InternalWork&) = delete;
  InternalWork& operator=(const InternalWork&) = delete;

 private:
  DeviceState& device_;
};

}  // namespace sk
