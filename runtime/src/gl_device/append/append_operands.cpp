// SPDX-License-Identifier: MIT
#include "gl_device/append/append_operands.hpp"

#include "call/check_argument.hpp"
#include "gl_device/gl_stream.hpp"
#include "sk/limits.hpp"

namespace sk {

using program::Parameter;
using program::Role;

namespace {

/// Whether an element output is a part of its stream, which must then be unpacked, because the domain is.
bool isPartlyWritten(const ResolvedCall& call, std::size_t i) {
  const StreamRegion& region = call.arguments[i].region;
  const Parameter& parameter = call.kernel.parameters[i];
  return parameter.role == Role::Output && assemble::isNeeded(parameter, call.specs) &&
         region.shape != region.stream->shape;
}

Operand operandOf(const ResolvedCall& call, std::size_t i) {
  const Parameter& parameter = call.kernel.parameters[i];
  const Argument& argument = call.arguments[i];
  if (parameter.role == Role::Uniform) return uniformOperand(argument);
  if (parameter.role == Role::Spec) return {.value = argument.value};
  if (parameter.role == Role::Iterator) {
    return iteration(parameter, argument.value, call.domain);
  }
  if (parameter.role == Role::VariableOutput || !assemble::isNeeded(parameter, call.specs)) {
    return {};
  }
  return regionOperand(argument, call.domain);
}

}  // namespace

bool isScattered(const ResolvedCall& call, std::size_t i) {
  const Parameter& parameter = call.kernel.parameters[i];
  return parameter.role == Role::Scatter && assemble::isNeeded(parameter, call.specs);
}

void unpackWritten(const ResolvedCall& call) {
  for (std::size_t i = 0; i < call.arguments.size(); ++i) {
    if (isScattered(call, i) || isPartlyWritten(call, i)) glStream(call.arguments[i].region).unpack();
  }
}

std::vector<Operand> appendOperands(const ResolvedCall& call) {
  std::vector<Operand> operands;
  for (std::size_t i = 0; i < call.arguments.size(); ++i) operands.push_back(operandOf(call, i));
  return operands;
}

bool hasRoom(const Parameter& pushed, std::int64_t elements, std::int32_t textureSize) {
  const std::int64_t most = std::int64_t{textureSize} * textureSize / 2;
  return pushed.pushes >= 0 && pushed.pushes <= mostRoom && elements * pushed.pushes <= most;
}

void failForPushes(const program::Kernel& kernel, const Parameter& appendOutput) {
  fail(Error::Kind::Shape, kernel, "it {} '{}' more than {} values in one call; divide the domain",
       appendOutput.role == Role::Scatter ? "scatters to" : "pushes to", appendOutput.name, mostPushes);
}

}  // namespace sk
