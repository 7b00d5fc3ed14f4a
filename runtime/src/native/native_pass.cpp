// SPDX-License-Identifier: MIT
#include "native/native_pass.hpp"

#include <new>
#include <utility>

#include "native/native_stream.hpp"

namespace sk {

namespace {

/// The bytes of a region in the arrays that hold it.
std::int64_t bytesOf(const StreamRegion& region) {
  return region.shape.size() * nativeStream(region).components.bytesOfElement();
}

}  // namespace

void NativePass::begin(DeviceState& device, const program::Kernel& kernel, std::string_view step,
                       std::span<const Argument> arguments, const Shape& domain) {
  PassRecord record{std::string(kernel.name), std::string(step), "native", toString(domain), 0, 0};
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (arguments[i].region.stream == nullptr) continue;
    const program::Role role = kernel.parameters[i].role;
    const bool isRead = role == program::Role::Input || role == program::Role::Gather;
    (isRead ? record.bytesRead : record.bytesWritten) += bytesOf(arguments[i].region);
  }
  begin(device, std::move(record));
}

void NativePass::begin(DeviceState& device, PassRecord record) {
  record_ = std::move(record);
  if (device.passCount) record_.addTo(*device.passCount);
  begin_ = Trace::now();
}

void NativePass::end() noexcept {
  const Trace::Time end = Trace::now();
  try {
    trace_->hostPass(record_, begin_, end);
    trace_->devicePass(record_, begin_, end, "wall clock");
  } catch (const std::bad_alloc&) {
    return;  // the trace lacks this pass
  }
}

}  // namespace sk
