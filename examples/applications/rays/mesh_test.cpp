// SPDX-License-Identifier: MIT
#include "mesh.hpp"

#include <catch2/catch.hpp>
#include <cstring>
#include <fstream>
#include <string>
#include <utility>

#include "scenes_test.hpp"
#include "shapes.hpp"
#include "support/testing.hpp"

namespace rays {
namespace {

const std::string plyHead =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n";

template <class T>
void put(std::string& bytes, T value, bool isBig) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  for (std::size_t i = 0; i < sizeof(T); ++i) bytes += raw[isBig ? sizeof(T) - 1 - i : i];
}

TEST_CASE("OBJ faces have polygons, relative indices and materials") {
  std::ofstream("mesh_test.mtl")
      << "newmtl red\nKd 1 0 0\nnewmtl lamp\nKd 0 0 0\nKe 3 2 1\nnewmtl clear\nd 0.1\nNi 1.4\n";
  const Mesh mesh =
      parseObj("a.obj",
               "mtllib mesh_test.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 0.1 0\nvn 0 0 1\nvt 0.5 0.25\n"
               "usemtl red\nf 1/1/1 2/1/1 3/1/1\nusemtl lamp\nf -4 -3 -2 -1\n",
               ".", true);
  REQUIRE(mesh.faces.size() == 3);
  CHECK(mesh.faces[0].points == std::array<std::uint32_t, 3>{0, 1, 2});
  CHECK(mesh.faces[0].material == 0);
  CHECK(mesh.faces[2].material == 1);
  CHECK(mesh.points[3].y == 0.1);
  CHECK(mesh.corners[0].texture[1].y == 0.25f);
  CHECK(mesh.materials[0].colour == sk::float3{1, 0, 0});
  CHECK(mesh.materials[1].emits());
  CHECK(mesh.materials[2].scattering == Scattering::Glass);
  CHECK(mesh.materials[2].ior == Approx(1.4));
}

TEST_CASE("MTL files are read like OBJ files") {
  const examples::WrittenFile file(
      "\xEF\xBB\xBF# made by C:\\tools\\\rnewmtl dark red\rKd 5.0D-1 \\\r0.25 # one is missing\rKe spectral "
      "lamp.rfl\rmap_Kd -o 1 2 -clamp on "
      "brick wall.png\rnewmtl mirror\rillum 3\rKs 1\rnewmtl glass\rTr .9",
      "mesh_test.mtl");
  const auto read = [](const std::string& text) {
    return parseObj("a.obj", "mtllib mesh_test.mtl\n" + text, ".", true);
  };
  const Mesh mesh = read("v 0 0 0\nusemtl mirror\nf 1 1 1\nusemtl none\nf 1 1 1\n");
  REQUIRE(mesh.materials.size() == 3);
  CHECK(mesh.materials[0].name == "dark red");
  CHECK(mesh.materials[0].colour == sk::float3{0.5f, 0.25f, 0.25f});
  REQUIRE(mesh.textures.size() == 1);
  CHECK(mesh.textures[0].filename() == "brick wall.png");
  CHECK(mesh.materials[1].scattering == Scattering::Mirror);
  CHECK(mesh.materials[1].colour == sk::float3{1, 1, 1});
  CHECK(mesh.materials[2].scattering == Scattering::Glass);
  CHECK(mesh.faces[0].material == 1);
  CHECK(mesh.faces[1].material == -1);
  const examples::WrittenFile wrong("newmtl a\nKd 1 x 0\n", "wrong.mtl");
  CHECK_THROWS_WITH(parseObj("a.obj", "mtllib wrong.mtl\n", ".", true),
                    Catch::Contains("wrong.mtl:2:6: 'x' is no number"));
  CHECK(parseObj("a.obj", "mtllib none.mtl\n", ".", false).materials.empty());
}

TEST_CASE("PLY files are read as text and in both orders of bytes") {
  const std::string text =
      plyHead +
      "property uchar quality\nelement face 2\nproperty list uchar int vertex_indices\nelement edge 1\n"
      "property int a\nend_header\n0 0 0 7\n1 0 0 7\n1 1 0 7\n0 1\n0.5 7\n4 0 1 2 3\n3 0 2 3\n5\n";
  const Mesh mesh = parsePly("a.ply", text);
  REQUIRE(mesh.faces.size() == 3);
  CHECK(mesh.faces[1].points == std::array<std::uint32_t, 3>{0, 2, 3});
  CHECK(mesh.points[3].z == 0.5);
  for (const bool isBig : {false, true}) {
    std::string bytes =
        "ply\nformat binary_" + std::string(isBig ? "big" : "little") +
        "_endian 1.0\ncomment made by hand\nelement vertex 3\nproperty double x\nproperty float y\n"
        "property short z\nelement face 1\nproperty list ushort uint vertex_index\nend_header\n";
    for (int i = 0; i < 3; ++i) {
      put(bytes, double(i), isBig);
      put(bytes, 0.25f, isBig);
      put(bytes, std::int16_t(-i), isBig);
    }
    put(bytes, std::uint16_t(3), isBig);
    for (std::uint32_t i = 0; i < 3; ++i) put(bytes, i, isBig);
    const Mesh read = parsePly("a.ply", bytes);
    REQUIRE(read.faces.size() == 1);
    CHECK(read.points[2].x == 2.0);
    CHECK(read.points[2].z == -2.0);
    bytes.pop_back();
    CHECK_THROWS_WITH(parsePly("a.ply", bytes), Catch::Contains("the file ends too early"));
  }
}

TEST_CASE("PLY elements come in any order, lines end in any way, and polygons are cut") {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    std::string text;
    for (const std::string_view line : {"ply",
                                        "format ascii 1.0",
                                        "comment a dart \\",
                                        "obj_info -",
                                        "element face 2",
                                        "property list uchar float quality",
                                        "property list uchar int vertex_index",
                                        "element nothing 1000000000",
                                        "element vertex 4",
                                        "property float nz",
                                        "property list uchar int tags",
                                        "property float z",
                                        "property float y",
                                        "property float x",
                                        "property float nx",
                                        "property float ny",
                                        "end_header",
                                        "0 4 0 1",
                                        "2 3",
                                        "2 0.5 1D0 3 2 1 0",
                                        "1 0 0 0 -1 0 0 1 2 7 8 0 1 0 0 0",
                                        "1 0 0 0 1 0 0 1 0 0 10 0 0 0"})
      text += std::string(line) + end;
    const Mesh mesh = parsePly("a.ply", text);
    REQUIRE(mesh.faces.size() == 3);
    CHECK(mesh.points[3].y == 10.0);
    CHECK(mesh.faces[0].points == std::array<std::uint32_t, 3>{3, 0, 1});
    CHECK(mesh.faces[1].points == std::array<std::uint32_t, 3>{3, 1, 2});
    CHECK(mesh.faces[2].points == std::array<std::uint32_t, 3>{2, 1, 0});
    REQUIRE(mesh.corners.size() == 3);
    CHECK(mesh.corners[2].normals[0] == sk::float3{0, 0, 1});

    // The first byte of the body may be that of a line end.
    std::string bytes = "ply" + end + "format binary_little_endian 1.0" + end + "element vertex 1" + end +
                        "property uchar x" + end + "property uchar y" + end + "property uchar z" + end +
                        "end_header" + end;
    CHECK(parsePly("a.ply", bytes + "\n\r\n").points[0] == Vector{10, 13, 10});
  }
}

TEST_CASE("errors in PLY files name their location") {
  const std::string faces =
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n0 0 0\n0 0 0\n0 0 0\n";
  const std::pair<std::string, const char*> cases[] = {
      {"obj\n", "a.ply:1:1: this is no PLY file"},
      {"", "this is no PLY file"},
      {"ply\nformat utf 1.0\n", "a.ply:2:8: 'utf' is no format"},
      {"ply\nelement vertex 1\nproperty real x\n", "a.ply:3:10: 'real' is no type"},
      {plyHead, "'end_header' is missing"},
      {plyHead + faces + "3 0 1 4\n", "a.ply:14:7: there is no vertex 4; they count from 0, and there are 4"},
      {plyHead + faces + "3 0 1\n", "the file ends too early"},
      {plyHead + faces + "2 0 1\n", "a face has three corners at least"},
      {plyHead + faces + "3 0 1 0.5\n", "'0.5' is no integer"},
      {plyHead + faces + "3 0 1 2 3\n",
       "a.ply:14:9: the file goes on after its last element; the header has fewer"},
      {"ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\nproperty float y\n"
       "property float z\nelement face 4000000000\nproperty list uchar int vertex_indices\nend_header\n",
       "the file ends too early"},
      {plyHead + "element vertex 4\n", "a.ply:7:9: there is another element 'vertex' above"},
      {plyHead + "element face\n", "a.ply:7:13: the number of elements is missing"},
      {plyHead + "element face 1\nproperty int vertex_indices\nend_header\n",
       "a.ply:9:1: faces have no list 'vertex_indices'"},
      {"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nend_header\n",
       "a.ply:6:1: vertices have no property 'z'"},
      {"ply\nformat ascii 1.0\nelement face 1\nproperty list float int "
       "vertex_index\nend_header\n3.5 0 0 0\n",
       "a list cannot have 3.5 elements"},
      {"ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int "
       "vertex_index\nend_header\n3 0 0 0\n",
       "there is no vertex 0; they count from 0, and there are 0"}};
  for (const auto& [text, message] : cases)
    CHECK_THROWS_WITH(parsePly("a.ply", text), Catch::Contains(message));
  CHECK_THROWS_WITH(loadMesh("none.ply", true), Catch::Contains("does not exist"));
  CHECK_THROWS_WITH(loadMesh("none.stl", true), Catch::Contains("meshes are .obj or .ply files"));
}

TEST_CASE("computed meshes are closed") {
  CHECK(box().faces.size() == 12);
  CHECK(sponge(1).faces.size() == 144);
  for (const Mesh& mesh : {box(), sponge(2), icosphere(0, false), icosphere(3, true), torus(7, 5, 0.2)})
    CHECK(isClosed(mesh));
  CHECK(icosphere(3, false).faces.size() == 20 * 64);
  CHECK(terrain(3, 0.5, 1).faces.size() == 128);
  CHECK(sphereFlake({0, 0, 0}, 1, 2).size() == 91);
}

}  // namespace
}  // namespace rays
