// SPDX-License-Identifier: MIT
//
// What a generated program computes as C++: compiled by Clang with sk_as_cpp.hpp, linked with the native code that skc has
// made of it, and loaded into this process.
#pragma once

#include <string>
#include <vector>

#include "cpp/samples.hpp"

namespace sk::native {
struct Code;
}

namespace fuzz::cpp {

/// A loaded program. Stays loaded until the process ends.
class Oracle {
 public:
  /// `text` is the program as .sk, whose kernels have kernelParameters (samples.hpp); `object` an object file of native code, or empty; `symbols` are those of its
  /// codes. Throws std::runtime_error with Clang's first message if this cannot be compiled.
  Oracle(const std::string& text, const std::string& object, const std::vector<std::string>& symbols);

  /// What each kernel computes.
  std::vector<Outputs> run() const;
  const sk::native::Code* code(std::size_t i) const { return codes_[i]; }

 private:
  std::vector<std::string> kernels_;
  void* library_ = nullptr;
  const sk::native::Code* const* codes_ = nullptr;
};

}  // namespace fuzz::cpp
