// SPDX-License-Identifier: MIT
//
// Serves the playground to browsers of this machine. Only this file's source knows HTTP.
#pragma once

#include <functional>
#include <string>

#include "serve/assets.hpp"

namespace sk_tool {

struct Service {
  Assets assets;
  int port = 0;                                                   ///< 0: one that is free
  std::function<std::string()> start;                             ///< JSON of what the page shows first
  std::function<std::string(const std::string& text)> compile;    ///< JSON of a compilation
  std::function<void(const std::string& address)> started;        ///< called when browsers may come
};

/// Serves on 127.0.0.1 until SIGINT or SIGTERM. Throws std::runtime_error if the port is taken.
void serve(const Service& service);

}  // namespace sk_tool
