// SPDX-License-Identifier: MIT
//
// A kernel's call on a native device that runs again and again, in a loop.
#pragma once

#include <memory>
#include <vector>

#include "device/loop_runner.hpp"
#include "native/operands.hpp"
#include "native/run_code.hpp"

namespace sk {

inline CodeChoice codeChoice(RealType real, const CallOptions& options) {
  return {.real = real,
          .mayContract = options.contraction == Contraction::Fast,
          .mayReorder = options.order == Order::Any};
}

/// It keeps its operands for the next run.
class PreparedRun final : public RecordedCall {
 public:
  /// `call` and `kernel`, the variant of its kernel that runs, must outlive it.
  PreparedRun(NativeDevice& device, const ResolvedCall& call, const program::Kernel& kernel, RealType real,
              std::vector<native::Table> tables)
      : device_(device),
        resolved_(call),
        kernel_(kernel),
        choice_(codeChoice(real, call.options)),
        tables_(tables),
        operands_(real, kernel, call.arguments, call.domain, std::move(tables), false, call.options.box),
        call_(operands_.call()),
        code_(kernel, choice_, operands_.readsValuesInStreams()) {
    call_.isSilent = device.isSilent;
  }

  /// False if it must run as calls outside of loops do.
  bool mayRun() { return operands_.mayRunAgain(); }

  void run() override;

  NativeDevice& device() const { return device_; }
  const ResolvedCall& resolved() const { return resolved_; }
  const program::Kernel& kernel() const { return kernel_; }
  const CodeChoice& choice() const { return choice_; }
  const std::vector<native::Table>& tables() const { return tables_; }

 private:
  NativeDevice& device_;
  const ResolvedCall& resolved_;
  const program::Kernel& kernel_;
  const CodeChoice choice_;
  const std::vector<native::Table> tables_;
  Operands operands_;
  native::Call call_;
  RepeatedCode code_;
};

}  // namespace sk
