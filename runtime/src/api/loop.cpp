// SPDX-License-Identifier: MIT
//
// Implements sk::Loop: recording calls, and running them again.
#include "sk/loop.hpp"

#include <fmt/format.h>

#include "device/device_state.hpp"
#include "device/loop_state.hpp"
#include "sk/error.hpp"
#include "support/checked_size.hpp"

namespace sk {

namespace {

LoopState& stateOf(const detail::LoopOwner& loop) {
  if (!loop) {
    throw Error(
        "a loop: it has no calls, since it was default-constructed or moved from; make one by "
        "device.record(...)",
        Error::Kind::Lost);
  }
  loop->checkBeforeRun();
  flushScalars(loop->device());
  return *loop;
}

void checkEnd(const LoopState& loop, const StreamRegion& done, const LoopEnd& end) {
  const StreamState& stream = liveStream(done, "until");
  if (stream.device != &loop.device()) {
    throw Error("until: the condition is on another device than the loop; compute it inside Device::record",
                Error::Kind::Device);
  }
  if (done.shape.size() != 1) {
    throw Error(
        fmt::format("until: the condition has shape {}; give a stream of one bool", toString(done.shape)),
        Error::Kind::Shape);
  }
  if (!loop.uses(done.stream)) {
    throw Error(
        "until: no call of the loop writes the condition, so that it never changes; compute it inside "
        "Device::record, and assign it to a scalar or stream that exists before");
  }
  if (end.every < 1 || end.most < 0) {
    throw Error(
        fmt::format("until: every is {} and most is {}; give 1 or more for every, and 0 or more for most",
                    end.every, end.most));
  }
}

}  // namespace

void detail::LoopDeleter::operator()(LoopState* state) const noexcept { delete state; }

detail::Recording::Recording(DeviceState& device)
    : state_(withHostMemory("record", [&] {
        if (device.recording == nullptr) {
          flushScalars(device);
          device.arithmetic();  // its trial runs programs, which are not to be recorded
        }
        return LoopOwner(new LoopState(device));
      })) {}

detail::Recording::~Recording() = default;

detail::LoopOwner detail::Recording::finish() {
  return withHostMemory("record", [&] {
    state_->finish();
    return std::move(state_);
  });
}

void Loop::repeat(std::int64_t times) {
  withHostMemory("repeat", [&] {
    LoopState& loop = stateOf(state_);
    if (times < 0) throw Error(fmt::format("repeat: times is {}; give 0 or more", times));
    const TraceScope traced(loop.device().trace.get(), "call", "loop");
    if (loop.device().trace) traced.add("plan", loop.plan());
    loop.run(times);
  });
}

std::string Loop::plan() const {
  return withHostMemory("plan", [&] { return stateOf(state_).plan(); });
}

std::int64_t Loop::until(const StreamRegion& done, const LoopEnd& end) {
  return withHostMemory("until", [&] {
    LoopState& loop = stateOf(state_);
    checkEnd(loop, done, end);
    const TraceScope traced(loop.device().trace.get(), "call", "loop");
    return loop.runUntil(done, end);
  });
}

}  // namespace sk
