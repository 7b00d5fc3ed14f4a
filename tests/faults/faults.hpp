// SPDX-License-Identifier: MIT
//
// Faults by number: the n-th chance of a kind fails, so that a loop over n tries every one. libepoxy calls the driver through
// variables, which are replaced here by functions that count, fail and keep the books of GL's objects; operator new and
// posix_memalign are replaced for the whole program. Nothing fails while no fault is armed, nor inside of the driver.
#pragma once

#include <cstdint>
#include <string>

namespace faults {

enum class Kind : std::uint8_t {
  Allocation,  ///< of a texture or a buffer: GL_OUT_OF_MEMORY
  Program,  ///< a shader is not created or compiled, a program not created or linked
  Mapping,  ///< a buffer is not mapped, or its contents are lost as it is unmapped
  Fence,  ///< there is none, or waiting for it fails
  Framebuffer,  ///< it is not complete
  Command,  ///< a draw, dispatch, upload or copy leaves GL_OUT_OF_MEMORY and does nothing
  Context,  ///< lost: from this call on, none does anything
  Host,  ///< an allocation of host memory by the runtime
  HostOfAnyThread,  ///< also by threads that it starts; not where a driver has threads
};
std::string nameOf(Kind kind);

/// One fault for as long as this lives.
class Fault {
 public:
  /// `number`: from 1. `isLasting`: all that come after fail, too.
  Fault(Kind kind, long number, bool isLasting = false);
  ~Fault();
  Fault(const Fault&) = delete;
  Fault& operator=(const Fault&) = delete;

  bool hasFired() const;
  /// Kind::Program: chances that belong to programs which are there now, and come no more.
  long passed() const;
};

/// Replaces the functions of GL and EGL. Once, before the first device.
void install();

struct Census {
  long objects = 0;  ///< of GL that live
  long contexts = 0;
  /// Names that were deleted twice or in another context than theirs, and objects that were left to die with a context.
  long wrong = 0, left = 0;
  std::string kinds = {};  ///< of the living
  bool operator==(const Census&) const = default;
};
Census census();

}  // namespace faults
