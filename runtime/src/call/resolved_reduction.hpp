// SPDX-License-Identifier: MIT
//
// What every step of a reduction needs to know, found once after its arguments have been checked. Values and streams take the
// same way: values are one block, and go to host memory.
#pragma once

#include <cstddef>
#include <deque>
#include <span>
#include <vector>

#include "sk/call.hpp"
#include "sk/program.hpp"
#include "sk/shape.hpp"

namespace sk {

class DeviceState;

struct ResolvedReduction {
  DeviceState& device;
  const program::Reduction& reduction;
  std::span<const Argument> arguments;  ///< to values, those of accumulators are empty
  Shape domain;  ///< of the inputs together
  Shape blocks;  ///< their numbers in each dimension of the domain
  std::span<void* const> values = {};  ///< where the results go, one for each accumulator; none: to streams
  CallOptions options = {};

  bool isToValues() const { return !values.empty(); }
  /// The stream results' shape, which may have fewer dimensions than `blocks`.
  const Shape& shapeOfResults() const;
  /// The same elements folded by another reduction.
  ResolvedReduction of(const program::Reduction& other, std::span<const Argument> otherArguments,
                       std::span<void* const> otherValues) const;
};

/// Room for accumulators that are not results yet: in host memory or in streams, as the results of the reduction are.
class TemporaryResults {
 public:
  explicit TemporaryResults(const ResolvedReduction& call) : call_(call) {}

  /// Returns the argument for the accumulator.
  Argument add(const program::Element& element);

  std::vector<Argument> arguments;
  std::vector<void*> values;  ///< none where they are streams

 private:
  const ResolvedReduction& call_;
  std::deque<std::vector<std::byte>> bytes_;
  std::vector<detail::StreamOwner> streams_;
};

}  // namespace sk
