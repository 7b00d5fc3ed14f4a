// SPDX-License-Identifier: MIT
//
// What object code pushes to variable outputs. Each thread has buffers of its own, and pushes of earlier elements come first in the
// result, however many threads there are.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "native/call.hpp"
#include "native/code_frame.hpp"
#include "native/components.hpp"
#include "sk/native/code.hpp"
#include "sk/program.hpp"

namespace sk {

/// A buffer that grows for one variable output.
class PushBuffer {
 public:
  PushBuffer(const program::Element& element, RealType real);
  PushBuffer(const PushBuffer&) = delete;
  PushBuffer& operator=(const PushBuffer&) = delete;

  native::Sink* sink() { return &sink_; }
  /// The arrays of what was pushed.
  native::Pushed take();

 private:
  struct Sink : native::Sink {
    PushBuffer* buffer;
  };
  void grow();

  Sink sink_;
  std::vector<std::size_t> bytes_;  ///< of a scalar in each array
  native::Pushed arrays_;
  std::vector<std::byte*> pointers_;
};

/// The arguments of a call with one thread's buffers as sinks.
class PushFrame {
 public:
  PushFrame(const program::Kernel& kernel, const CodeFrame& frame, RealType real);
  const native::Frame* get() const { return &frame_; }
  std::vector<native::Pushed> take();

 private:
  std::vector<native::Argument> arguments_;
  native::Frame frame_;
  std::vector<std::unique_ptr<PushBuffer>> buffers_;
};

/// The parts of a call's pushes, put together in order.
class PushParts {
 public:
  /// Any thread may add what the elements from number `order` on have pushed, an entry for each variable output.
  void add(std::int64_t order, std::vector<native::Pushed> pushed);
  /// Gives it to the operands of variable outputs.
  void store(std::span<const native::Operand> operands);

 private:
  struct Part {
    std::int64_t order;
    std::vector<native::Pushed> pushed;
  };
  std::mutex mutex_;
  std::vector<Part> parts_;
};

}  // namespace sk
