// SPDX-License-Identifier: MIT
//
// Injects faults by number: the n-th opportunity of a kind fails, so that a loop over n tries them all. libepoxy calls the
// driver through function pointers; they are replaced by functions that count, fail and track GL objects. operator new,
// posix_memalign, pthread_create and the system's functions for files are replaced for the whole program. Nothing fails without an armed fault, nor inside the driver.
#pragma once

#include <cstdint>
#include <string>

namespace faults {

enum class Kind : std::uint8_t {
  Allocation,  ///< the allocation of a texture or a buffer leaves GL_OUT_OF_MEMORY
  Program,  ///< a shader is not created or compiled, or a program is not created, linked or loaded
  Mapping,  ///< a buffer is not mapped, or loses its contents when it is unmapped
  Fence,  ///< a fence is not created, or waiting for it fails
  Framebuffer,  ///< a framebuffer is not complete
  Command,  ///< a draw, dispatch, upload or copy leaves GL_OUT_OF_MEMORY and does nothing
  Context,  ///< the context is lost: this call and all later ones do nothing
  Host,  ///< an allocation of host memory by the runtime
  HostOfAnyThread,  ///< like Host, also on threads that the runtime starts; not for drivers that have threads
  File,  ///< a file or folder is not opened, made, renamed, read or written, as on a disk that fails
  Thread,  ///< a thread is not started
};
std::string nameOf(Kind kind);

/// While it lives, this thread runs code of others, such as a driver's: its allocations and its functions of the system do not fail.
class InDriver {
 public:
  InDriver();
  ~InDriver();
  InDriver(const InDriver&) = delete;
  InDriver& operator=(const InDriver&) = delete;
};

/// Arms a fault while it lives.
class Fault {
 public:
  /// `number` counts opportunities from 1. `isLasting`: all later ones fail, too.
  Fault(Kind kind, long number, bool isLasting = false);
  ~Fault();
  Fault(const Fault&) = delete;
  Fault& operator=(const Fault&) = delete;

  bool hasFired() const;
  /// For Kind::Program: the number of opportunities that do not come again, because their programs have been linked.
  long passed() const;
};

/// Replaces the functions of GL and EGL. Call it once, before the first device.
void install();

struct LiveObjects {
  long objects = 0;  ///< GL objects that are alive
  long contexts = 0;
  /// `wrong`: deletions of objects that were deleted before or belong to another context. `left`: objects that were not
  /// deleted before their context.
  long wrong = 0, left = 0;
  std::string kinds = {};  ///< how many objects of each kind are alive, as text
  bool operator==(const LiveObjects&) const = default;
};
LiveObjects liveObjects();

/// The number of threads that were started on a test's thread while a fault was armed.
long startedThreads();

/// The number of blocks of host memory that operator new gave to the runtime on a test's thread while a fault was armed and that
/// have not been freed.
long hostBlocks();

}  // namespace faults
