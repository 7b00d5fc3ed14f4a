// SPDX-License-Identifier: MIT
#include "native/factor_kernel.hpp"

namespace sk {

FactorKernel::FactorKernel(const program::Kernel& fold, std::span<const std::uint8_t> factors,
                           const native::Call& call)
    : call_(call) {
  for (const std::uint8_t parameter : factors) {
    operands_.push_back(call.operands[parameter]);
    operands_.back().holdsFloats = false;  // read as floats, without widening
    parameters_.push_back(fold.parameters[parameter]);
    const auto number = static_cast<std::uint8_t>(slots_.size());
    slots_.push_back({.parameter = number, .row = {}, .reach = 0, .isOutput = 0});
  }
  call_.operands = operands_;
  code_.slots = slots_.data();
  code_.slotCount = static_cast<std::uint32_t>(slots_.size());
  kernel_.parameters = parameters_;
  kernel_.code = &code_;
}

}  // namespace sk
