// SPDX-License-Identifier: MIT
//
// The loops of native code in a trace. They run on the calling thread and those that it starts, so that the host's clock
// times them.
#pragma once

#include <span>

#include "sk/call.hpp"
#include "trace.hpp"

namespace sk {

/// One loop nest for as long as this lives; nothing where `trace` is null.
class NativePass {
 public:
  NativePass(Trace* trace, const program::Kernel& kernel, std::string_view step,
             std::span<const Argument> arguments, const Shape& domain)
      : trace_(trace) {
    if (trace_ != nullptr) begin(kernel, step, arguments, domain);
  }
  ~NativePass() {
    if (trace_ != nullptr) end();
  }
  NativePass(const NativePass&) = delete;
  NativePass& operator=(const NativePass&) = delete;

 private:
  void begin(const program::Kernel& kernel, std::string_view step, std::span<const Argument> arguments,
             const Shape& domain);
  void end() noexcept;

  Trace* trace_;
  PassRecord record_;
  Trace::Time begin_ = 0;
};

}  // namespace sk
