// SPDX-License-Identifier: MIT
//
// Diagnoses why OpenGL finds no GPU on a machine, from information of its kernel and libraries.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace sk_tool {

/// The inspected machine; tests provide their own.
struct Machine {
  std::filesystem::path root = "/";
  std::function<bool(const std::string&)> canLoad;  ///< a shared library
  std::function<bool(const std::filesystem::path&)> mayUse;  ///< a device file: read and write it
};

/// The machine that this process runs on.
Machine thisMachine();

/// One or more sentences: what is missing, and how to fix it.
std::string whyNoGpu(const Machine& machine);

}  // namespace sk_tool
