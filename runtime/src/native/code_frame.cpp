// SPDX-License-Identifier: MIT
#include "native/code_frame.hpp"

#include <algorithm>
#include <limits>

#include "native/scalars.hpp"

namespace sk {

namespace {

using program::Role;

bool isEmpty(const native::Operand& operand) {
  return operand.components.empty() || std::ranges::count(operand.extent, 0) > 0;
}

bool fits32(std::int64_t number) {
  return number >= std::numeric_limits<std::int32_t>::min() &&
         number <= std::numeric_limits<std::int32_t>::max();
}

/// Sets isSmall and start. Code adds multiples of the strides in 32 bits, and that sum to `start` in 64. In a large whole,
/// sums are large though the elements that are held lie close together.
void setSmall(native::Argument& argument, const native::Operand& operand, const native::HeldIndices& held) {
  argument.start = operand.first;
  std::int64_t least = 0, most = 0;
  bool areSmall = true;
  for (std::size_t d = 0; d < 4; ++d) {
    if (held.low[d] == 0 && held.high[d] == 1) continue;
    least += held.low[d] * operand.stride[d];
    most += (held.high[d] - 1) * operand.stride[d];
    areSmall = areSmall && fits32(operand.stride[d]) && fits32(least) && fits32(most);
  }
  if (areSmall && fits32(operand.held ? most : operand.first + most)) {
    argument.isSmall = 1;
    return;
  }
  constexpr int bits = 32;
  const std::int64_t turns = (least + (std::int64_t{1} << (bits - 1))) >> bits;
  const std::int64_t turned = turns * (std::int64_t{1} << bits);
  if (!operand.held || !fits32(least - turned) || !fits32(most - turned)) return;
  argument.isSmall = 2;
  argument.start += turned;
}

native::Argument argumentOf(const native::Operand& operand) {
  native::Argument argument{};
  argument.components = operand.components.empty() ? nullptr : operand.components.data();
  argument.first = operand.first;
  std::ranges::copy(operand.extent, argument.extent);
  std::ranges::copy(operand.stride, argument.stride);
  std::ranges::copy(operand.multiply, argument.multiply);
  std::ranges::copy(operand.divide, argument.divide);
  argument.countsElements = operand.countsElements ? 1 : 0;
  const native::HeldIndices held = operand.held.value_or(native::HeldIndices{{}, operand.extent});
  setSmall(argument, operand, held);
  std::ranges::copy(held.low, argument.low);
  std::ranges::copy(held.high, argument.high);
  return argument;
}

}  // namespace

CodeFrame::CodeFrame(const program::Kernel& kernel, const native::Call& call,
                     std::pmr::memory_resource* memory)
    : arguments_(memory),
      zeroArrays_(memory),
      frame_{.arguments = nullptr,
             .domain = {call.domain[0], call.domain[1], call.domain[2], call.domain[3]},
             .tables = call.tables.empty() ? nullptr : call.tables.data()} {
  arguments_.reserve(call.operands.size());
  for (std::size_t i = 0; i < call.operands.size(); ++i) {
    const program::Parameter& parameter = kernel.parameters[i];
    // object code applies the boundary mode to the indices of a gather and then reads, even if its stream is
    // omitted
    if (parameter.role == Role::Gather && isEmpty(call.operands[i])) {
      native::Argument& zero = arguments_.emplace_back(argumentOf({}));
      zero.stride[0] = 1;
      zero.components = zeroArrays(kernel);
    } else {
      arguments_.push_back(argumentOf(call.operands[i]));
    }
  }
  frame_.arguments = arguments_.data();
}

void CodeFrame::redirect(std::size_t parameter, const native::Operand& operand) {
  arguments_[parameter] = argumentOf(operand);
}

/// One element of zeros, for any gather of the kernel.
void* const* CodeFrame::zeroArrays(const program::Kernel& kernel) {
  alignas(mostScalarBytes) static constexpr std::byte zero[mostScalarBytes] = {};
  if (zeroArrays_.empty()) {
    std::size_t most = 0;
    for (const program::Parameter& parameter : kernel.parameters) {
      most = std::max(most, scalarsOf(*parameter.element));
    }
    zeroArrays_.resize(most, const_cast<std::byte*>(zero));
  }
  return zeroArrays_.data();
}

}  // namespace sk
