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
    throw Error("until: the condition is a stream of another device than the loop");
  }
  if (done.shape.size() != 1) {
    throw Error(
        fmt::format("until: the condition has shape {}; give a stream of one bool", toString(done.shape)),
        Error::Kind::Shape);
  }
  if (end.every < 1 || end.most < 0) {
    throw Error(
        fmt::format("until: a condition cannot be asked for every {} iterations, {} at the most; give "
                    "numbers from 1 and from 0 on",
                    end.every, end.most));
  }
}

}  // namespace

void detail::LoopDeleter::operator()(LoopState* state) const noexcept { delete state; }

detail::Recording::Recording(DeviceState& device)
    : state_(withHostMemory("record", [&] {
        if (device.recording == nullptr) flushScalars(device);
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
    if (times < 0) throw Error(fmt::format("repeat: {} is no number of iterations", times));
    const TraceScope traced(loop.device().trace.get(), "call", "loop");
    loop.run(times);
  });
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
