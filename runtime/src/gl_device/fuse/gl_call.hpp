// SPDX-License-Identifier: MIT
//
// A kernel's call in a loop on a GL device, which may run together with others (fused_calls.hpp).
#pragma once

#include <memory>
#include <string>

#include "call/resolved_call.hpp"
#include "device/loop_runner.hpp"

namespace sk {

class GlDevice;

class GlCall final : public RecordedCall {
 public:
  /// `call` must outlive it.
  GlCall(GlDevice& device, const ResolvedCall& call);

  void run() override;
  std::string_view name() const override { return call_.kernel.name; }
  const ResolvedCall& resolved() const { return call_; }
  /// Why it runs by itself, whatever the calls beside it; empty if it need not.
  const std::string& whyAlone() const { return whyAlone_; }

 private:
  GlDevice& device_;
  const ResolvedCall& call_;
  const std::string whyAlone_;
};

/// Whether texels hold the values of a stream's elements as kernels compute them, so that a value that is stored and read
/// again is the same.
bool holdsExactly(const StreamState& stream);

}  // namespace sk
