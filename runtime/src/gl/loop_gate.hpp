// SPDX-License-Identifier: MIT
//
// Ends a loop on the device: a buffer with the counts of the loop's draws and dispatches, and a small program that sets
// all of them to zero once a condition is true. Commands that are queued behind it then do nothing. Requires compute
// programs, and thus OpenGL 4.3 or ES 3.1.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "gl/bound_state.hpp"
#include "gl/buffer.hpp"
#include "gl/object_name.hpp"
#include "gl/program.hpp"
#include "gl/queue_points.hpp"

namespace sk::gl {

class LoopGate {
 public:
  /// A loop's condition: a component, of 0 or 1, of a texel of a texture of unsigned integers without layers.
  struct Condition {
    GLuint texture = 0;
    std::array<GLint, 3> place{};  ///< x, y and the component
  };
  struct State {
    bool isDone = false;
    std::int64_t ran = 0;  ///< iterations since open()
  };

  LoopGate() = default;

  /// Writes the counts of a draw, and of dispatches with these groups. Saves the application's bindings of indirect
  /// and copied buffers if `isGuest`. False, with nothing bound, if the driver fails; then `log` has its messages.
  bool open(BoundState& bound, std::span<const CommandLog::Groups> dispatches, bool isGuest,
            std::string& log);
  IndirectCounts counts() const;
  /// Ends an iteration: counts it if it ran, and tests the condition.
  void pass(BoundState& bound, const Condition& condition, GLuint sampler);
  /// Queues a copy of the state, which the next but one call of this function overwrites. Throws std::bad_alloc.
  void ask(BoundState& bound);
  /// The state as it was when it was last asked for, or the time before that. Waits for the device.
  State lastAnswer(BoundState& bound) const { return answer(bound, 0); }
  State answerBefore(BoundState& bound) const { return answer(bound, 1); }
  /// Restores the bindings.
  void close(BoundState& bound);

 private:
  using Buffer = ObjectName<deleteBuffer>;
  struct Answer {
    Buffer buffer;
    Fence fence;
  };

  bool build(BoundState& bound, std::string& log);
  State answer(BoundState& bound, std::size_t age) const;

  Program program_;
  IntUniform place_, dispatches_;
  Buffer buffer_;
  std::array<Answer, 2> answers_;
  std::size_t asked_ = 0;  ///< times
  GLint count_ = 0;  ///< of dispatches
  bool isGuest_ = false;
  GLint drawBuffer_ = 0, dispatchBuffer_ = 0, readBuffer_ = 0, writeBuffer_ = 0;  ///< of the application
};

}  // namespace sk::gl
