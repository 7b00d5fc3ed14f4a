// SPDX-License-Identifier: MIT
//
// A picture that is not finished, on file: what was gathered, and of what picture, so that no other one goes on from it. It knows no device.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "exposure.hpp"
#include "scene.hpp"

namespace rays {

/// What makes a picture the one that it is, to the bit, but for how many samples it takes: lines of "key: value".
struct Identity {
  std::vector<std::string> lines;

  friend bool operator==(const Identity&, const Identity&) = default;
};

/// `device` is the device's name: functions such as sin may differ between devices by a rounding.
Identity identityOf(const Scene& scene, const std::string& device);

/// Replaces the file at once: who reads it, or stops the program, finds the old state or the new one whole. Creates the file's folder. Throws
/// std::runtime_error where it cannot be written.
void saveState(const std::filesystem::path& file, const Identity& identity, const Gathered& gathered);

/// Throws std::runtime_error where the file cannot be read, is none of this version, is damaged, or is of another picture; then the message has
/// what differs.
Gathered loadState(const std::filesystem::path& file, const Identity& identity);

}  // namespace rays
