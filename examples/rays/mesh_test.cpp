// SPDX-License-Identifier: MIT
#include "mesh.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <string>
#include <utility>

#include "shapes.hpp"

namespace rays {
namespace {

std::string objMessage(const std::string& text) {
  try {
    parseObj("a.obj", text, ".", true);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "none";
}

std::string plyMessage(const std::string& text) {
  try {
    parsePly("a.ply", text);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "none";
}

const std::string plyHead =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n";

template <class T>
void put(std::string& bytes, T value, bool isBig) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  for (std::size_t i = 0; i < sizeof(T); ++i) bytes += raw[isBig ? sizeof(T) - 1 - i : i];
}

/// Whether each edge is there once in each direction.
bool isClosed(const Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const Face& face : mesh.faces)
    for (std::size_t i = 0; i < 3; ++i) ++edges[{face.points[i], face.points[(i + 1) % 3]}];
  for (const auto& [edge, count] : edges) {
    const auto back = edges.find({edge.second, edge.first});
    if (back == edges.end() || back->second != count) return false;
  }
  return true;
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

TEST_CASE("errors in OBJ files name the line and the column") {
  CHECK(objMessage("v 0 0 0\nv 1 x 0\n") == "a.obj:2:5: 'x' is no number");
  CHECK(objMessage("v 0 0\n") == "a.obj:1:6: z is missing");
  CHECK(objMessage("v 0 0 0\nv 0 0 0\nv 0 0 0\nf 1 2 4\n") ==
        "a.obj:4:7: there is no vertex 4; 3 are above this line");
  CHECK(objMessage("v 0 0 0\nf 1 1 -2\n") == "a.obj:2:7: there is no vertex -2; 1 are above this line");
  CHECK(objMessage("v 0 0 0\nf 1 1 -9223372036854775808\n") ==
        "a.obj:2:7: there is no vertex -9223372036854775808; 1 are above this line");
  CHECK(objMessage("v 0 0 0\nf 0 1 1\n") == "a.obj:2:3: 0 is no vertex; they count from 1");
  CHECK(objMessage("v 0 0 0\nf 1 1\n") == "a.obj:2:6: a face has three corners at least, and this one has 2");
  CHECK(objMessage("v 0 0 0\nf 1/1 1/1 1/1\n") ==
        "a.obj:2:3: there is no texture vertex 1; 0 are above this line");
  CHECK_THAT(objMessage("mtllib none.mtl\n"), Catch::StartsWith("a.obj:1:8: there is no file"));
  CHECK(objMessage("") == "none");
  CHECK(std::isnan(parseObj("a", "v nan 0 0\nv 1e999 0 1e-999\n", ".", true).points[0].x));
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

TEST_CASE("errors in PLY files name their location") {
  const std::string faces =
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n0 0 0\n0 0 0\n0 0 0\n";
  CHECK_THAT(plyMessage("obj\n"), Catch::StartsWith("a.ply:1:1: this is no PLY file"));
  CHECK_THAT(plyMessage(""), Catch::Contains("this is no PLY file"));
  CHECK_THAT(plyMessage("ply\nformat utf 1.0\n"), Catch::StartsWith("a.ply:2:8: 'utf' is no format"));
  CHECK_THAT(plyMessage("ply\nelement vertex 1\nproperty real x\n"),
             Catch::StartsWith("a.ply:3:10: 'real' is no type"));
  CHECK_THAT(plyMessage(plyHead), Catch::Contains("'end_header' is missing"));
  CHECK(plyMessage(plyHead + faces + "3 0 1 4\n") ==
        "a.ply:14:7: there is no vertex 4; they count from 0, and there are 4");
  CHECK_THAT(plyMessage(plyHead + faces + "3 0 1\n"), Catch::Contains("the file ends too early"));
  CHECK_THAT(plyMessage(plyHead + faces + "2 0 1\n"), Catch::Contains("a face has three corners at least"));
  CHECK_THAT(plyMessage(plyHead + faces + "3 0 1 0.5\n"), Catch::Contains("'0.5' is no integer"));
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
