// SPDX-License-Identifier: MIT
//
// The runtime's only exception. Its text names the kernel, the parameter and the shapes that do not match,
// and says what to do. The library never prints.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace sk {

class Error : public std::runtime_error {
 public:
  /// The cause, for programs that handle some errors differently from others.
  enum class Kind : std::uint8_t {
    Device,  ///< there is no such device, or it cannot do what is requested
    Shape,  ///< shapes, extents or ranks that do not match or are too large
    Type,  ///< a stream whose element type is not the parameter's
    Memory,  ///< out of memory, on the host or on the device
    Compile,  ///< the driver rejects a program, or the .sk file was compiled without what a call needs
    Lost,  ///< a device, context or stream that has ended, or that a driver has reset
    File,  ///< a file that cannot be read or written, or has unexpected contents
    Misuse,  ///< any other misuse of the API
  };

  explicit Error(const std::string& what, Kind kind = Kind::Misuse) : std::runtime_error(what), kind_(kind) {}
  explicit Error(const char* what, Kind kind = Kind::Misuse) : std::runtime_error(what), kind_(kind) {}

  Kind kind() const noexcept { return kind_; }

 private:
  Kind kind_;
};

}  // namespace sk
