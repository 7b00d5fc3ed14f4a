// SPDX-License-Identifier: MIT
#include "peers.hpp"

#include <algorithm>
#include <exception>

#include <dlfcn.h>
#include <fmt/format.h>

namespace race {

void loadPeers(const std::filesystem::path& folder, Field& field) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename();
    if (name.starts_with("peer_") && name.ends_with(".so")) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  for (const std::filesystem::path& file : files) {
    try {
      void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
      void* addPeers = library == nullptr ? nullptr : dlsym(library, addPeersName);
      if (addPeers == nullptr) throw std::runtime_error(dlerror());
      reinterpret_cast<AddPeers>(addPeers)(field.contenders);
    } catch (const std::exception& error) {
      field.absent.push_back(fmt::format("{}: {}", file.filename().string(), error.what()));
    }
  }
}

}  // namespace race
