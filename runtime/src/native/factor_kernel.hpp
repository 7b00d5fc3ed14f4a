// SPDX-License-Identifier: MIT
//
// The factors of a term (program::SumTerm) as a kernel that has only slots and no code, so that the runtime's
// own sums read floats the way object code does.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "native/call.hpp"
#include "sk/native/code.hpp"
#include "sk/program.hpp"

namespace sk {

class FactorKernel {
 public:
  /// `call` is a call of `fold`; `factors` are the numbers of the parameters that are factors.
  FactorKernel(const program::Kernel& fold, std::span<const std::uint8_t> factors, const native::Call& call);
  FactorKernel(const FactorKernel&) = delete;
  FactorKernel& operator=(const FactorKernel&) = delete;

  const program::Kernel& kernel() const { return kernel_; }
  const native::Call& call() const { return call_; }

 private:
  std::vector<native::Operand> operands_;
  std::vector<program::Parameter> parameters_;
  std::vector<native::Slot> slots_;
  native::Code code_{};
  program::Kernel kernel_;
  native::Call call_;
};

}  // namespace sk
