// SPDX-License-Identifier: MIT
//
// What loops on a device consist of (device/loop_state.hpp): calls that repeat, and the device's way to run their iterations.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

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
  /// What Loop::plan() says.
  virtual std::string plan(LoopState& loop) = 0;
};

/// A stream of a recorded call.
struct StreamUse {
  StreamState* stream;
  bool isWritten;  ///< else it is read
};

/// A call whose arguments have been checked, with copies of all that it refers to except streams.
class RecordedCall {
 public:
  RecordedCall() = default;
  virtual ~RecordedCall() = default;
  RecordedCall(const RecordedCall&) = delete;
  RecordedCall& operator=(const RecordedCall&) = delete;

  virtual void run() = 0;

  /// The name of the kernel, or of what the call does instead.
  virtual std::string_view name() const { return "a step of the runtime"; }
  /// The call as the device repeats it, where it has prepared that, which may happen here; else null, and whyNotOnDevice().
  virtual RecordedCall* onDevice() { return nullptr; }
  virtual std::string_view whyNotOnDevice() const { return "it is no call of a kernel"; }
  /// Adds the streams that it uses, and returns true; or returns false: nothing is known.
  virtual bool addUses(std::vector<StreamUse>&) const { return false; }
};

}  // namespace sk
