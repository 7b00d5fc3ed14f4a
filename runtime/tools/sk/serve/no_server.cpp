// SPDX-License-Identifier: MIT
//
// In place of server.cpp where the library for HTTP is missing.
#include <stdexcept>

#include "serve/server.hpp"

namespace sk_tool {

void serve(const Service&) {
  throw std::runtime_error(
      "this sk was built without cpp-httplib, which serves pages; install it (Debian: libcpp-httplib-dev), "
      "and build sk again");
}

}  // namespace sk_tool
