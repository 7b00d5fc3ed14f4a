// SPDX-License-Identifier: MIT
//
// Something that a loop on a GL device does again and again: an iteration, or several at once. It is done as ever while a log
// notes its GL commands, and is repeated from these notes as soon as textures are where they were.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "sk/loop.hpp"
#include "sk/stream.hpp"

namespace sk {

class GlDevice;
class LoopState;

class Replay {
 public:
  Replay() = default;
  virtual ~Replay() = default;
  Replay(const Replay&) = delete;
  Replay& operator=(const Replay&) = delete;

  virtual void run(LoopState& loop, std::int64_t times) = 0;
  /// Runs until the condition, one element that is checked, is true. Returns how often.
  virtual std::int64_t runUntil(LoopState& loop, const StreamRegion& done, const LoopEnd& end) = 0;
  /// Whether it may be repeated from notes.
  virtual bool mayReplay() const = 0;
};

/// `once` does it for the first time, and whenever it cannot be repeated from notes.
std::unique_ptr<Replay> makeReplay(GlDevice& device, std::function<void(LoopState&)> once);

}  // namespace sk
