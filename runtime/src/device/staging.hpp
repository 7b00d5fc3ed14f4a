// SPDX-License-Identifier: MIT
//
// Host memory that a device's own programs reach: they copy boxes of streams there and back, without the driver between
// them.
#pragma once

#include <cstddef>

#include "sk/stream.hpp"

namespace sk {

/// In memory, a box has a word of 32 bits for each component as it is stored, in the order of
/// assemble/transfer/staging_program.hpp.
class Staging {
 public:
  /// Who writes the memory, and who reads it.
  enum class Way : bool { ToHost, ToDevice };

  virtual ~Staging() = default;
  Staging() = default;
  Staging(const Staging&) = delete;
  Staging& operator=(const Staging&) = delete;

  /// The bytes of a box.
  virtual std::size_t bytesOf(const StreamRegion& box) const = 0;
  /// Makes room for `bytes` undefined bytes, once the device has finished with those before. Throws sk::Error if memory is
  /// exhausted. Pointers into the memory are valid until the next call.
  virtual std::byte* room(std::size_t bytes) = 0;
  /// Adds the copy of a box, which is not empty, to the memory or from it, at a multiple of 4 bytes. Streams must stay until
  /// flush().
  virtual void copy(const StreamRegion& box, std::size_t offset) = 0;
  /// Begins to carry out all copies, those of one stream together.
  virtual void flush() = 0;
  /// Waits until the copies have been carried out. Throws sk::Error if the device is lost or has failed.
  virtual void wait() = 0;
};

}  // namespace sk
