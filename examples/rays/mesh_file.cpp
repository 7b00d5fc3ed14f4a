// SPDX-License-Identifier: MIT
#include "mesh.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>

namespace rays {
namespace {

std::string bytesOf(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream bytes;
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored) || !stream || !(bytes << stream.rdbuf())) {
    // An empty file sets failbit, too.
    if (std::filesystem::is_regular_file(file, ignored) && std::filesystem::file_size(file, ignored) == 0)
      return {};
    throw std::runtime_error(fmt::format("the mesh '{}' does not exist or cannot be read", file.string()));
  }
  return std::move(bytes).str();
}

}  // namespace

Mesh loadMesh(const std::filesystem::path& file, bool wantsMaterials) {
  std::string ending = file.extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const bool isObj = ending == ".obj";
  if (!isObj && ending != ".ply")
    throw std::runtime_error(fmt::format("{}: meshes are .obj or .ply files", file.string()));
  const std::string bytes = bytesOf(file);
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  return isObj ? parseObj(file.string(), bytes, folder, wantsMaterials) : parsePly(file.string(), bytes);
}

}  // namespace rays
