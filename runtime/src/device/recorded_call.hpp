// SPDX-License-Identifier: MIT
//
// A call that a loop repeats (device/loop_state.hpp).
#pragma once

namespace sk {

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
