// SPDX-License-Identifier: MIT
//
// Joins what object code pushes to variable outputs. The results are in the order of elements, whatever the
// number of threads.
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
  /// Adds what a run of elements has pushed; parts are joined in ascending `order`. Thread-safe.
  void add(std::int64_t order, std::span<RecordFrame::Output> pushed);
  /// Joins all parts and gives them to the operands of variable outputs.
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
