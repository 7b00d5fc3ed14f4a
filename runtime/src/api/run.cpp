// SPDX-License-Identifier: MIT
//
// sk::run: checks and resolves a call of a kernel and passes it to its device. Must not depend on the kind of
// device.
#include "call/check_argument.hpp"
#include "call/check_call.hpp"
#include "call/precision.hpp"
#include "device/device_state.hpp"
#include "sk/call.hpp"
#include "support/checked_size.hpp"

namespace sk {

using program::Kernel;

namespace {

void checkAndRun(const Kernel& kernel, std::span<const Argument> arguments, const CallOptions& options) {
  if (options.accumulate != Accumulate::Default) {
    fail(kernel, "it is no reduce, which alone accumulates; call it without Accumulate");
  }
  refuseScanOptions(kernel, options);
  std::optional<CheckedCall> checked = checkCall(kernel, arguments);
  if (!checked) return;
  DeviceState& device = checked->device;
  const TraceScope traced(device.trace.get(), "call", kernel.name);
  traced.add("domain", checked->call.domain);
  checked->call.options = device.configuration.resolve(kernel, options);
  checkTables(kernel, checked->call.options);
  device.run(checked->call);
}

}  // namespace

void run(const Kernel& kernel, std::span<const Argument> arguments, const CallOptions& options) {
  withHostMemory(kernel.name, [&] { checkAndRun(kernel, arguments, options); });
}

}  // namespace sk
