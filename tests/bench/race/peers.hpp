// SPDX-License-Identifier: MIT
//
// Peers in shared libraries: those that were built, and that this machine can load.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "contender.hpp"

namespace race {

/// What takes part, and what does not, with the reason.
struct Field {
  std::vector<Contender> contenders;
  std::vector<std::string> absent;
};

/// Loads every peer_*.so of the folder, in the order of their names, and never unloads them.
void loadPeers(const std::filesystem::path& folder, Field& field);

}  // namespace race
