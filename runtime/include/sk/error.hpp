// SPDX-License-Identifier: MIT
//
// The one exception of the runtime. Its text names the kernel, the parameter and the shapes that do
// not fit, and says what to do; the library itself never prints.
#pragma once

#include <stdexcept>

namespace sk {

class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace sk
