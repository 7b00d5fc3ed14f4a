// SPDX-License-Identifier: MIT
//
// Operations with scalars (sk/scalar.hpp) that a device carries out in one pass: all of them read what was there before.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "sk/program.hpp"
#include "sk/scalar.hpp"
#include "sk/stream.hpp"

namespace sk {

class DeviceState;

/// A value of a pass.
struct ScalarRef {
  enum class Kind : std::uint8_t { Read, Number, Step } kind = Kind::Read;
  std::uint32_t index = 0;
};

struct ScalarStep {
  detail::ScalarOp op;
  program::Scalar type;  ///< of the operands, except the condition of Select
  const program::Element* result;
  std::array<ScalarRef, 3> operands;
};

/// What RecordedCall::name() says of it.
inline constexpr std::string_view operationsName = "operations with scalars";

struct ScalarPass {
  struct Number {
    const program::Element* element;
    alignas(8) std::array<std::byte, 8> value;
  };
  struct Output {
    StreamState* stream;
    std::uint32_t step;
  };

  std::vector<StreamRegion> reads;  ///< of one element
  std::vector<Number> numbers;
  std::vector<ScalarStep> steps;  ///< each one's operands come before it
  std::vector<Output> outputs;
};

/// The most in one pass. Every device with GL can read and write as much.
inline constexpr std::size_t mostScalarReads = 12, mostScalarOutputs = 4;
/// The most operations that wait for a pass, so that programs stay small.
inline constexpr std::size_t mostScalarSteps = 64;

/// An operation that may have yet to be carried out.
struct ScalarNode {
  struct Operand {
    std::shared_ptr<ScalarNode> node;  ///< or null:
    StreamState* stream = nullptr;  ///< a scalar that exists, or null:
    ScalarPass::Number number{};
  };

  DeviceState* device = nullptr;  ///< null after the device has ended
  detail::ScalarOp op;
  const program::Element* element;  ///< of the result
  program::Scalar type;  ///< of the operands, except the condition of Select
  std::vector<Operand> operands;
  const detail::ScalarHandle* holder = nullptr;  ///< the application's; null: only other operations need it
  StreamState* target = nullptr;  ///< where the result goes; null: to `result`
  detail::StreamOwner result;
  enum class State : std::uint8_t { Pending, Done, Lost } state = State::Pending;
};

/// The operations of a device that have yet to be carried out, in the order in which they were asked for.
struct PendingScalars {
  std::vector<std::shared_ptr<ScalarNode>> nodes;
  std::size_t reads = 0;  ///< at most
  std::size_t steps = 0;  ///< at most
};

/// Carries out all operations with scalars of the device that have been asked for.
void flushScalars(DeviceState& device);

}  // namespace sk
