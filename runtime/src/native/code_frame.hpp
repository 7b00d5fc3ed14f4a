// SPDX-License-Identifier: MIT
//
// The operands of a call in the form that object code takes (sk/native/code.hpp).
#pragma once

#include <memory_resource>
#include <span>
#include <vector>

#include "native/call.hpp"
#include "sk/native/code.hpp"
#include "sk/program.hpp"

namespace sk {

/// A Frame with its Arguments, one per parameter of the kernel. What the operands point to must outlive it.
class CodeFrame {
 public:
  CodeFrame(const program::Kernel& kernel, const native::Call& call,
            std::pmr::memory_resource* memory = std::pmr::get_default_resource());
  CodeFrame(const CodeFrame&) = delete;
  CodeFrame& operator=(const CodeFrame&) = delete;

  const native::Frame* get() const { return &frame_; }
  /// Lets a parameter read another stream.
  void redirect(std::size_t parameter, const native::Operand& operand);
  std::span<const native::Argument> arguments() const { return arguments_; }

 private:
  void* const* zeroArrays(const program::Kernel& kernel);

  std::pmr::vector<native::Argument> arguments_;
  std::pmr::vector<void*> zeroArrays_;
  native::Frame frame_;
};

}  // namespace sk
