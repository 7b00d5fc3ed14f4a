// SPDX-License-Identifier: MIT
#include "call/check_written.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "assemble/condition.hpp"
#include "call/check_call.hpp"
#include "call/resolved_call.hpp"
#include "device/stream_state.hpp"
#include "sk/error.hpp"

namespace sk {

namespace {

using program::Parameter;
using program::Role;

bool isNeverWritten(const StreamState& stream) { return stream.isUnwritten && stream.shape.size() > 0; }

/// A scatter output that combines values with its elements reads these.
bool isReadAs(const Parameter& parameter) {
  switch (parameter.role) {
    case Role::Input:
    case Role::Gather:
    case Role::Uniform: return true;
    case Role::Scatter: return parameter.scatter != program::ScatterOp::Store;
    case Role::Output:
    case Role::VariableOutput:
    case Role::Accumulator:
    case Role::Iterator:
    case Role::Spec: return false;
  }
  return false;
}

bool isWrittenAs(Role role) {
  return role == Role::Output || role == Role::VariableOutput || role == Role::Scatter ||
         role == Role::Accumulator;
}

}  // namespace

void checkWritten(const program::Kernel& kernel, const Parameter& parameter, const StreamState& stream) {
  if (!isReadAs(parameter) || !isNeverWritten(stream)) return;
  fail(Error::Kind::Misuse, kernel,
       "'{}' reads a stream of shape {} that nothing has written; write() or fill() it first, or let a "
       "kernel write it "
       "(SK_CHECK=written)",
       parameter.name, toString(stream.shape));
}

void checkWritten(const StreamState& stream, std::string_view context) {
  if (!isNeverWritten(stream)) return;
  throw Error(
      fmt::format("{}: nothing has written this stream of shape {}; write() or fill() it first, or let a "
                  "kernel write it (SK_CHECK=written)",
                  context, toString(stream.shape)),
      Error::Kind::Misuse);
}

void noteWritten(const program::Kernel& kernel, std::span<const Argument> arguments) {
  const assemble::SpecValues specs = specsOf(kernel, arguments);
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    StreamState* const stream = arguments[i].region.stream;
    if (stream == nullptr || !isWrittenAs(kernel.parameters[i].role)) continue;
    if (assemble::isNeeded(kernel.parameters[i], specs)) stream->isUnwritten = false;
  }
}

namespace {

enum class Check : std::uint8_t { None, Folds, Halos, Written, Collectives };

constexpr std::array<std::pair<std::string_view, Check>, 4> checks = {{{"folds", Check::Folds},
                                                                       {"halos", Check::Halos},
                                                                       {"written", Check::Written},
                                                                       {"collectives", Check::Collectives}}};

Check checkNamed(std::string_view name) {
  if (name.empty()) return Check::None;
  std::string known;
  for (const auto& [word, check] : checks) {
    if (word == name) return check;
    known += fmt::format("{}{}", known.empty() ? "" : ", ", word);
  }
  throw Error(fmt::format("there is no check '{}'; choose one of {}, or unset SK_CHECK", name, known));
}

Check chosenCheck() {
  static const Check chosen = [] {
    const char* const value = std::getenv("SK_CHECK");
    return checkNamed(value == nullptr ? "" : value);
  }();
  return chosen;
}

}  // namespace

void requireKnownCheck() { static_cast<void>(chosenCheck()); }
bool checksFolds() { return chosenCheck() == Check::Folds; }
bool checksHalos() { return chosenCheck() == Check::Halos; }
bool checksWritten() { return chosenCheck() == Check::Written; }
bool checksCollectives() { return chosenCheck() == Check::Collectives; }

}  // namespace sk
