// SPDX-License-Identifier: MIT
//
// A sequence of calls that a device repeats. Device::record checks the calls once; a loop then runs them again
// and again without the checks, and without the application's code between them.
#pragma once

#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>

#include "sk/call.hpp"
#include "sk/owner.hpp"
#include "sk/stream.hpp"

namespace sk {

class DeviceState;
class LoopState;  // the runtime's own

namespace detail {

struct LoopDeleter {
  void operator()(LoopState* state) const noexcept;
};
using LoopOwner = Owner<LoopState, LoopDeleter>;

}  // namespace detail

/// How Loop::until ends.
struct LoopEnd {
  /// A GPU gets this many iterations at a time. If it has OpenGL 4.3 or ES 3.1, it ends the loop by itself; otherwise the host
  /// reads the condition after them, which waits for the device. On native devices and renderers in software, the host
  /// reads it after each iteration.
  std::int64_t every = 16;
  std::int64_t most = 1000;  ///< the most iterations
};

/// Move-only; Device::record creates it. It keeps the streams that its calls use, so that they may be destroyed
/// before it. It must not be used after its device has ended; this throws sk::Error.
class Loop {
 public:
  /// Holds no calls: assign the result of Device::record to it.
  Loop() = default;
  explicit operator bool() const noexcept { return static_cast<bool>(state_); }

  /// Runs the calls `times` times, without waiting for the device. Throws sk::Error if `times` is negative, or if
  /// a stream of the calls has lost its elements or changed its shape since they were recorded. An error in a call
  /// ends the loop.
  void repeat(std::int64_t times);

  /// Runs the calls until the only element of `done`, which they compute, is true after an iteration; `end.most`
  /// times at the most. Returns the number of iterations that have run. On a GPU with less than OpenGL 4.3 and ES 3.1 this is a
  /// multiple of `end.every` or `end.most`: iterations go on until the host asks. Throws sk::Error as repeat() does, or if
  /// `done` has not one element, is on another device or used by no call, or if end.every < 1 or end.most < 0.
  template <StreamOf<bool> S>
  std::int64_t until(const S& done, const LoopEnd& end = {}) {
    return until(regionOf(done), end);
  }

  /// How repeat() runs the calls here, in lines for people to read: which of them run together in tiles, of which lengths and
  /// for how many iterations at once; and of those that run one by one, why. Throws sk::Error as repeat() does.
  std::string plan() const;

 private:
  friend class Device;
  explicit Loop(detail::LoopOwner state) : state_(std::move(state)) {}
  std::int64_t until(const StreamRegion& done, const LoopEnd& end);

  detail::LoopOwner state_;
};

namespace detail {

/// Records the calls on a device between construction and finish(). Without finish(), the destructor drops them.
class Recording {
 public:
  explicit Recording(DeviceState& device);
  ~Recording();
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;
  LoopOwner finish();

 private:
  LoopOwner state_;
};

}  // namespace detail

}  // namespace sk
