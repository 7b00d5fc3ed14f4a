// SPDX-License-Identifier: MIT
#include "assemble/append/group_plan.hpp"

namespace sk::assemble {

using program::Field;
using program::Kernel;
using program::Parameter;
using program::Role;
using program::Scalar;
using program::ScatterOp;

namespace {

/// Pushes of up to this many bytes in a tile go through shared memory.
constexpr std::size_t stagedBytes = std::size_t{16} << 10;
/// The most elements that an invocation computes. With more, it needs more registers, and fewer groups run side by side.
constexpr int mostOfInvocation = 8;

/// Bytes of a staged element.
std::size_t bytesOf(const program::Element& element) {
  std::size_t bytes = 0;
  for (const Field& field : element.fields) {
    const int width = field.width == 3 ? 4 : field.width;
    bytes += static_cast<std::size_t>(width) * (field.scalar == Scalar::Double ? 8 : 4);
  }
  return bytes;
}

/// The only field of an element that is one scalar, which no two invocations can each store a part of; else null.
const Field* scalarField(const Parameter& scatter) {
  const Field& field = scatter.element->fields.front();
  const bool isOne = scatter.element->fields.size() == 1 && field.path.empty() && field.width == 1;
  return isOne ? &field : nullptr;
}

/// The part of a program that stores a list's planes, or shares memory with them, takes this many bytes for an entry.
std::size_t bytesOfEntry(const Parameter& pushed) {
  return bytesOf(*pushed.element) + (pushed.role == Role::Scatter ? sizeof(std::uint32_t) : 0);
}

}  // namespace

GroupPlan planGroups(const Kernel& kernel, bool isPacked, Order order) {
  const int elements = isPacked ? lanes : 1;
  const int most = mostOfInvocation / elements;
  std::size_t bytesPerElement = 0;
  bool pushesOnce = true;
  for (const Parameter& parameter : kernel.parameters) {
    if (!isPushed(parameter, order)) continue;
    if (parameter.pushes < 0) return {most, false};
    pushesOnce = pushesOnce && parameter.pushes <= 1;
    bytesPerElement += bytesOfEntry(parameter) * static_cast<std::size_t>(parameter.pushes);
  }
  for (int rounds = most; rounds > 1; rounds /= 2) {
    const std::size_t bytes = bytesPerElement * static_cast<std::size_t>(elements * rounds * appendGroup);
    if (bytes <= stagedBytes) return {rounds, bytes > 0, bytes > 0 && pushesOnce};
  }
  return {most, false};
}

bool isListed(const Parameter& appendOutput, Order order) {
  if (appendOutput.role != Role::Scatter || appendOutput.scatter == ScatterOp::Store) return false;
  const Field* const field = scalarField(appendOutput);
  if (field == nullptr) return true;
  return field->scalar == Scalar::Float && appendOutput.scatter == ScatterOp::Add && order != Order::Any;
}

bool isPushed(const Parameter& appendOutput, Order order) {
  return appendOutput.role == Role::VariableOutput || isListed(appendOutput, order);
}

bool isPair(const Parameter& listed) { return scalarField(listed) != nullptr; }

std::size_t imagesOf(const Parameter& appendOutput, Order order) {
  const bool hasTargets = isListed(appendOutput, order) && !isPair(appendOutput);
  return appendOutput.element->fields.size() + (hasTargets ? 1 : 0);
}

bool hasOwners(const Parameter& scatter, Order order) {
  if (scatter.role != Role::Scatter || scatter.scatter != ScatterOp::Store) return false;
  const Field* const field = scalarField(scatter);
  return order != Order::Any || field == nullptr || field->scalar == Scalar::Double;
}

}  // namespace sk::assemble
