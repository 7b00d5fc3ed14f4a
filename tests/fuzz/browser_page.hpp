// SPDX-License-Identifier: MIT
//
// Runs a module in Chromium, which takes seconds to start.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>

namespace fuzz {

/// A page has been silent for minutes: pages post their progress.
struct HungPage : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// What the page of tests/fuzz with this name, which has the files of a folder beside it, reports by number. Throws
/// std::runtime_error if the browser fails, HungPage if the page hangs; another one can run then.
std::map<std::uint64_t, std::string> reportsOf(const std::filesystem::path& folder, const std::string& page);

}  // namespace fuzz
