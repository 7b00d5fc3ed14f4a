// SPDX-License-Identifier: MIT
//
// What object code pushes to variable outputs, put together: pushes of earlier elements come first in the result, however many
// threads there are.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "native/call.hpp"
#include "native/record_buffer.hpp"

namespace sk {

class PushParts {
 public:
  /// Any thread may add what the elements from number `order` on have pushed.
  void add(std::int64_t order, std::span<RecordFrame::Output> pushed);
  /// Gives it to the operands of variable outputs.
  void store(std::span<const native::Operand> operands);

 private:
  struct Part {
    std::int64_t order;
    std::vector<std::unique_ptr<RecordBuffer>> outputs;
  };
  native::Pushed joined(std::size_t output) const;

  std::mutex mutex_;
  std::vector<Part> parts_;
};

}  // namespace sk
