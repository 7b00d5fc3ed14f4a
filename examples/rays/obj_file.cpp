// SPDX-License-Identifier: MIT
//
// OBJ files. tinyobjloader makes triangles of polygons and reads materials; but it takes words that are no numbers, NaN and
// infinities for 0, and tells nobody. So numbers and indices are checked here, with line and column, and positions are ours.
#include "mesh.hpp"

#include <algorithm>
#include <map>
#include <sstream>

#include <tiny_obj_loader.h>

#include "support/text_cursor.hpp"

namespace rays {

using examples::TextCursor;

namespace {

/// Counts of what faces refer to, up to their line.
struct Counts {
  std::int64_t points = 0, textures = 0, normals = 0;
};

void checkIndex(const TextCursor& cursor, std::string_view word, std::int64_t count, std::string_view what) {
  const std::int64_t index = cursor.integerOf(word);
  if (index == 0) cursor.fail(fmt::format("0 is no {}; they count from 1", what));
  if (index > count || index < -count)
    cursor.fail(fmt::format("there is no {} {}; {} are above this line", what, index, count));
}

void checkFace(TextCursor& cursor, const Counts& counts) {
  int corners = 0;
  for (std::string_view word = cursor.word(); !word.empty(); word = cursor.word(), ++corners) {
    const std::size_t first = std::min(word.find('/'), word.size());
    const std::size_t second = std::min(word.find('/', std::min(first + 1, word.size())), word.size());
    checkIndex(cursor, word.substr(0, first), counts.points, "vertex");
    if (first + 1 < second)
      checkIndex(cursor, word.substr(first + 1, second - first - 1), counts.textures, "texture vertex");
    if (second + 1 < word.size()) checkIndex(cursor, word.substr(second + 1), counts.normals, "normal");
  }
  if (corners < 3)
    cursor.fail(fmt::format("a face has three corners at least, and this one has {}", corners));
}

/// Reads positions, and checks all else that will be read.
std::vector<Vector> checkText(const std::string& name, const std::string& text,
                              const std::filesystem::path& folder, bool wantsMaterials) {
  std::vector<Vector> points;
  Counts counts;
  TextCursor cursor(name, text);
  while (cursor.nextLine()) {
    const std::string_view key = cursor.word();
    if (key == "v") {
      const double x = cursor.needNumber("x"), y = cursor.needNumber("y"), z = cursor.needNumber("z");
      points.push_back({x, y, z});
      ++counts.points;
    } else if (key == "vn") {
      for (const std::string_view what : {"x", "y", "z"}) cursor.needNumber(what);
      ++counts.normals;
    } else if (key == "vt") {
      cursor.needNumber("u");
      ++counts.textures;
    } else if (key == "f") {
      checkFace(cursor, counts);
    } else if (key == "mtllib" && wantsMaterials) {
      const std::string_view file = cursor.word();
      if (!std::filesystem::exists(folder / file))
        cursor.fail(fmt::format("there is no file '{}'", (folder / file).string()));
    }
  }
  return points;
}

sk::float3 colourOf(const tinyobj::real_t (&c)[3]) {
  return {static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2])};
}

/// MTL has a Phong model: what is far from its mirror or glass is taken for diffuse.
Material materialOf(const tinyobj::material_t& m, std::map<std::string, std::int32_t>& textures) {
  Material material{
      .name = m.name, .colour = colourOf(m.diffuse), .emission = colourOf(m.emission), .glowsBehind = true};
  const bool isClear = m.dissolve < 1 || m.illum == 4 || m.illum == 6 || m.illum == 7 || m.illum == 9;
  if (isClear) {
    material.scattering = Scattering::Glass;
    material.ior = m.ior > 1 ? static_cast<float>(m.ior) : 1.5f;
    material.colour = {1, 1, 1};
  } else if (m.illum == 3 || m.illum == 5) {
    material.scattering = Scattering::Mirror;
    material.colour = colourOf(m.specular);
  } else if (!m.diffuse_texname.empty()) {
    material.texture =
        textures.try_emplace(m.diffuse_texname, static_cast<std::int32_t>(textures.size())).first->second;
    if (material.colour == sk::float3{0, 0, 0}) material.colour = {1, 1, 1};
  }
  return material;
}

Corners cornersOf(const tinyobj::attrib_t& all, std::span<const tinyobj::index_t> face) {
  Corners corners;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto n = static_cast<std::size_t>(std::max(face[i].normal_index, 0));
    const auto t = static_cast<std::size_t>(std::max(face[i].texcoord_index, 0));
    if (face[i].normal_index >= 0)
      corners.normals[i] = {all.normals[3 * n], all.normals[3 * n + 1], all.normals[3 * n + 2]};
    if (face[i].texcoord_index >= 0) corners.texture[i] = {all.texcoords[2 * t], all.texcoords[2 * t + 1]};
  }
  return corners;
}

}  // namespace

Mesh parseObj(const std::string& name, const std::string& text, const std::filesystem::path& folder,
              bool wantsMaterials) {
  Mesh mesh;
  mesh.points = checkText(name, text, folder, wantsMaterials);

  tinyobj::attrib_t all;
  std::vector<tinyobj::shape_t> shapes;
  std::vector<tinyobj::material_t> materials;
  std::string warning, error;
  std::istringstream stream(text);
  tinyobj::MaterialFileReader reader(folder.string() + "/");
  if (!tinyobj::LoadObj(&all, &shapes, &materials, &warning, &error, &stream,
                        wantsMaterials ? &reader : nullptr))
    throw std::runtime_error(fmt::format("{}: {}", name, error));

  std::map<std::string, std::int32_t> textures;
  for (const tinyobj::material_t& m : materials) mesh.materials.push_back(materialOf(m, textures));
  mesh.textures.resize(textures.size());
  for (const auto& [file, number] : textures) mesh.textures[static_cast<std::size_t>(number)] = folder / file;
  const bool hasCorners = !all.normals.empty() || !all.texcoords.empty();
  for (const tinyobj::shape_t& shape : shapes) {
    const std::span<const tinyobj::index_t> indices = shape.mesh.indices;
    for (std::size_t f = 0; 3 * f + 2 < indices.size(); ++f) {
      const auto point = [&](std::size_t i) {
        return static_cast<std::uint32_t>(indices[3 * f + i].vertex_index);
      };
      mesh.faces.push_back({{point(0), point(1), point(2)}, shape.mesh.material_ids[f]});
      if (hasCorners) mesh.corners.push_back(cornersOf(all, indices.subspan(3 * f, 3)));
    }
  }
  return mesh;
}

}  // namespace rays
