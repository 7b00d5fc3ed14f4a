// SPDX-License-Identifier: MIT
//
// OBJ files as meshes, and the MTL files of their materials, which are a Phong model.
#include <algorithm>
#include <cctype>
#include <map>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "mesh.hpp"
#include "support/obj_file.hpp"
#include "support/text_file.hpp"

namespace rays {

using examples::TextCursor;

namespace {

/// What is looked at of a material in an MTL file.
struct PhongMaterial {
  std::string name;
  sk::float3 diffuse{}, specular{}, emission{};
  double opacity = 1.0, ior = 1.0, illumination = 0.0;
  std::string diffuseTexture;
};

/// One number stands for all three; spectra are passed over.
void readColour(TextCursor& cursor, sk::float3& colour) {
  const std::string_view first = cursor.word();
  if (first == "spectral" || first == "xyz") return;
  colour.x = static_cast<float>(cursor.numberOf(first));
  colour.y = static_cast<float>(cursor.number().value_or(double{colour.x}));
  colour.z = static_cast<float>(cursor.number().value_or(double{colour.y}));
}

/// The file's name, which may have blanks, behind options with values.
std::string textureOf(TextCursor& cursor) {
  for (TextCursor next = cursor; next.word().starts_with('-'); next = cursor) {
    const std::string_view option = cursor.word();
    const bool hasNumbers = option == "-o" || option == "-s" || option == "-t";  // one, two or three of them
    for (int i = option == "-mm" ? 2 : hasNumbers ? 3 : 1; i > 0; --i) {
      TextCursor value = cursor;
      if (hasNumbers && !examples::numberIn(value.word())) break;
      cursor.word();
    }
  }
  return std::string(cursor.rest());
}

void readMaterials(const std::filesystem::path& file, std::vector<PhongMaterial>& materials) {
  const std::string text = examples::bytesOf(file, "the materials");
  TextCursor cursor(file.string(), text, examples::objRules);
  PhongMaterial none;
  while (cursor.nextLine()) {
    PhongMaterial& material = materials.empty() ? none : materials.back();
    const std::string_view key = cursor.word();
    if (key == "newmtl") {
      materials.emplace_back().name = cursor.rest();
    } else if (key == "Kd") {
      readColour(cursor, material.diffuse);
    } else if (key == "Ks") {
      readColour(cursor, material.specular);
    } else if (key == "Ke") {
      readColour(cursor, material.emission);
    } else if (key == "d") {
      const std::string_view word = cursor.word();
      material.opacity = word == "-halo" ? cursor.needNumber("the factor") : cursor.numberOf(word);
    } else if (key == "Tr") {
      material.opacity = 1.0 - cursor.needNumber("the transparency");
    } else if (key == "Ni") {
      material.ior = cursor.needNumber("the index of refraction");
    } else if (key == "illum") {
      material.illumination = cursor.needNumber("the model");
    } else if (key == "map_Kd") {
      material.diffuseTexture = textureOf(cursor);
    }
  }
}

/// What is far from its mirror or glass is taken for diffuse.
Material materialOf(const PhongMaterial& m, std::map<std::string, std::int32_t>& textures) {
  Material material{.name = m.name, .colour = m.diffuse, .emission = m.emission, .glowsBehind = true};
  const double illum = m.illumination;
  const bool isClear = m.opacity < 1 || illum == 4 || illum == 6 || illum == 7 || illum == 9;
  if (isClear) {
    material.scattering = Scattering::Glass;
    material.ior = m.ior > 1 ? static_cast<float>(m.ior) : 1.5f;
    material.colour = {1, 1, 1};
  } else if (illum == 3 || illum == 5) {
    material.scattering = Scattering::Mirror;
    material.colour = m.specular;
  } else if (!m.diffuseTexture.empty()) {
    material.texture =
        textures.try_emplace(m.diffuseTexture, static_cast<std::int32_t>(textures.size())).first->second;
    if (material.colour == sk::float3{0, 0, 0}) material.colour = {1, 1, 1};
  }
  return material;
}

/// Reads the materials, and returns for each of the file's names an index into them; -1 for what no file has.
std::vector<std::int32_t> addMaterials(const examples::ObjFile& file, const std::filesystem::path& folder,
                                       Mesh& mesh) {
  std::vector<PhongMaterial> materials;
  for (const std::filesystem::path& each : file.materialFiles) readMaterials(each, materials);
  std::map<std::string, std::int32_t> textures;
  for (const PhongMaterial& m : materials) mesh.materials.push_back(materialOf(m, textures));
  mesh.textures.resize(textures.size());
  for (const auto& [name, number] : textures) mesh.textures[static_cast<std::size_t>(number)] = folder / name;

  std::vector<std::int32_t> indices;
  for (const std::string& name : file.materials) {
    const auto found = std::ranges::find(mesh.materials, name, &Material::name);
    indices.push_back(
        found == mesh.materials.end() ? -1 : static_cast<std::int32_t>(found - mesh.materials.begin()));
  }
  return indices;
}

Corners cornersOf(const examples::ObjFile& file, const std::array<examples::ObjCorner, 3>& face) {
  Corners corners;
  for (std::size_t i = 0; i < 3; ++i) {
    if (face[i].normal >= 0) corners.normals[i] = file.normals[static_cast<std::size_t>(face[i].normal)];
    if (face[i].texture >= 0) corners.texture[i] = file.textures[static_cast<std::size_t>(face[i].texture)];
  }
  return corners;
}

}  // namespace

Mesh parseObj(const std::string& name, const std::string& text, const std::filesystem::path& folder,
              bool wantsMaterials) {
  examples::ObjOptions options;
  if (wantsMaterials) options.materialsFolder = folder;
  examples::ObjFile file = examples::parseObj(name, text, options);
  Mesh mesh;
  mesh.points = std::move(file.points);
  const std::vector<std::int32_t> materials = addMaterials(file, folder, mesh);
  const bool hasCorners = !file.normals.empty() || !file.textures.empty();
  for (const auto& [corners, material] : file.triangles) {
    Face face{.material = material < 0 ? -1 : materials[static_cast<std::size_t>(material)]};
    for (std::size_t i = 0; i < 3; ++i) face.points[i] = static_cast<std::uint32_t>(corners[i].point);
    mesh.faces.push_back(face);
    if (hasCorners) mesh.corners.push_back(cornersOf(file, corners));
  }
  return mesh;
}

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
