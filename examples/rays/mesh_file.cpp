// SPDX-License-Identifier: MIT
#include "mesh.hpp"

#include <algorithm>
#include <cctype>
#include <stdexcept>

#include <fmt/format.h>

#include "support/text_file.hpp"

namespace rays {

Mesh loadMesh(const std::filesystem::path& file, bool wantsMaterials) {
  std::string ending = file.extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const bool isObj = ending == ".obj";
  if (!isObj && ending != ".ply")
    throw std::runtime_error(fmt::format("{}: meshes are .obj or .ply files", file.string()));
  const std::string bytes = examples::bytesOf(file, "the mesh");
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  return isObj ? parseObj(file.string(), bytes, folder, wantsMaterials) : parsePly(file.string(), bytes);
}

}  // namespace rays
