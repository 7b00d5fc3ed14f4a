// SPDX-License-Identifier: MIT
//
// What loops on a device consist of (device/loop_state.hpp): calls that repeat, and the device's way to run their iterations.
#pragma once

#include <cstdint>

#include "sk/loop.hpp"
#include "sk/stream.hpp"

namespace sk {

class LoopState;

/// It belongs to one loop, which has been checked before each call.
class LoopRunner {
 public:
  LoopRunner() = default;
  virtual ~LoopRunner() = default;
  LoopRunner(const LoopRunner&) = delete;
  LoopRunner& operator=(const LoopRunner&) = delete;

  virtual void run(LoopState& loop, std::int64_t times) = 0;
  /// Runs until the condition, one element that is checked, is true after an iteration. Returns the number of
  /// iterations.
  virtual std::int64_t runUntil(LoopState& loop, const StreamRegion& done, const LoopEnd& end) = 0;
};

/// A call whose arguments have been checked, with copies of all that it refers to except streams.
class RecordedCall {
 public:
  RecordedCall() = default;
  virtual ~RecordedCall() = default;
  RecordedCall(const RecordedCall&) = delete;
  RecordedCall& operator=(const RecordedCall&) = delete;

  virtual void run() = 0;
};

}  // namespace sk
