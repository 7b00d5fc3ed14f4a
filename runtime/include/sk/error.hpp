// SPDX-License-Identifier: MIT
//
// The one exception of the runtime. Its text names the kernel, the parameter and the shapes that do
// not fit, and says what to do; the library itself never prints.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace sk {

class Error : public std::runtime_error {
 public:
  /// What went wrong, for programs that handle some errors differently from others.
  enum class Kind : std::uint8_t {
    Device,   ///< there is no such device, or it cannot do what is asked of it
    Shape,    ///< shapes, extents or ranks that do not go together, or that are too large
    Type,     ///< a stream of other elements than a parameter is declared with
    Memory,   ///< no memory for it, on the host or on the device
    Compile,  ///< the driver refuses a program, or the .sk file was compiled without what a call needs
    Lost,     ///< a device, context or stream that is no more, or that a driver has reset
    File,     ///< a file that cannot be read or written, or does not hold what it should
    Misuse,   ///< anything else that a program should not ask for
  };

  explicit Error(const std::string& what, Kind kind = Kind::Misuse) : std::runtime_error(what), kind_(kind) {}
  explicit Error(const char* what, Kind kind = Kind::Misuse) : std::runtime_error(what), kind_(kind) {}

  Kind kind() const noexcept { return kind_; }

 private:
  Kind kind_;
};

}  // namespace sk
