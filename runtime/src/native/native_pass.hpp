// SPDX-License-Identifier: MIT
//
// Records the loops of native code in a trace. They run on the calling thread and on threads that it starts,
// so that the host's clock times them.
#pragma once

#include <span>
#include <string_view>

#include "device/device_state.hpp"
#include "sk/call.hpp"
#include "sk/program.hpp"
#include "trace/trace.hpp"

namespace sk {

/// Traces and counts one loop nest for as long as this object lives; does nothing if the device does neither.
class NativePass {
 public:
  NativePass(DeviceState& device, const program::Kernel& kernel, std::string_view step,
             std::span<const Argument> arguments, const Shape& domain)
      : trace_(device.trace.get()) {
    if (trace_ != nullptr || device.passCount) begin(device, kernel, step, arguments, domain);
  }
  /// A loop nest of several calls. `describe` returns its record, and is called only if somebody wants it.
  template <class Describe>
  NativePass(DeviceState& device, Describe&& describe) : trace_(device.trace.get()) {
    if (trace_ != nullptr || device.passCount) begin(device, describe());
  }
  ~NativePass() {
    if (trace_ != nullptr) end();
  }
  NativePass(const NativePass&) = delete;
  NativePass& operator=(const NativePass&) = delete;

 private:
  void begin(DeviceState& device, const program::Kernel& kernel, std::string_view step,
             std::span<const Argument> arguments, const Shape& domain);
  void begin(DeviceState& device, PassRecord record);
  void end() noexcept;

  Trace* trace_;
  PassRecord record_;
  Trace::Time begin_ = 0;
};

}  // namespace sk
