// SPDX-License-Identifier: MIT
//
// The meshes that examples/applications/rays reads: PLY files begin with their name, all others are read as OBJ. The folder of their materials does
// not exist.
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <string_view>

#include "mesh.hpp"
#include "parsers/entry.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  try {
    const rays::Mesh mesh = bytes.starts_with("ply")
                                ? rays::parsePly("input.ply", bytes)
                                : rays::parseObj("input.obj", bytes, "no/such/folder", true);
    for (const rays::Face& face : mesh.faces) {
      for (const std::uint32_t point : face.points) {
        if (point >= mesh.points.size()) std::abort();
      }
    }
    if (!mesh.corners.empty() && mesh.corners.size() != mesh.faces.size()) std::abort();
  } catch (const std::runtime_error&) {
    return 0;
  }
  return 0;
}
