// SPDX-License-Identifier: MIT
//
// Why a machine shows no GPU to OpenGL, from what its kernel and its libraries say.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace sk_tool {

/// What is looked at; tests have their own.
struct Machine {
  std::filesystem::path root = "/";
  std::function<bool(const std::string&)> canLoad;  ///< a shared library
  std::function<bool(const std::filesystem::path&)> mayUse;  ///< a device file: read and write it
};

/// This one.
Machine thisMachine();

/// One sentence or several: what is missing, and what to do about it.
std::string whyNoGpu(const Machine& machine);

}  // namespace sk_tool
