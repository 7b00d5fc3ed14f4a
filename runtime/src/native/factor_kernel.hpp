// SPDX-License-Identifier: MIT
//
// The factors of a term (program::SumTerm) as a kernel that has no code but slots for them, so that the runtime's own sums read their
// floats as object code would.
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
  /// `call` is one of `fold`, some parameters of which are the factors.
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
