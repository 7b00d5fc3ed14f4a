// SPDX-License-Identifier: MIT
#include "serve/own_host.hpp"

#include <string>

namespace sk_tool {

bool isOwnHost(std::string_view given, int port) {
  constexpr int portOfHttp = 80;
  for (const std::string host : {"127.0.0.1", "localhost"}) {
    if (given == host + ":" + std::to_string(port) || (port == portOfHttp && given == host)) return true;
  }
  return false;
}

bool isOwnOrigin(std::string_view given, int port) {
  constexpr std::string_view scheme = "http://";
  return given.starts_with(scheme) && isOwnHost(given.substr(scheme.size()), port);
}

}  // namespace sk_tool
