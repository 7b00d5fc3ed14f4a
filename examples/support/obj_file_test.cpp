// SPDX-License-Identifier: MIT
#include "support/obj_file.hpp"

#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "support/testing.hpp"

namespace examples {
namespace {

using Points = std::vector<std::array<std::int32_t, 3>>;

Points trianglesOf(const std::string& text) {
  Points points;
  for (const auto& [corners, material] : parseObj("a.obj", text).triangles)
    points.push_back({corners[0].point, corners[1].point, corners[2].point});
  return points;
}

TEST_CASE("OBJ files with lines of any kind have their triangles") {
  const Points one = {{0, 1, 2}};
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    const std::string head = "v 0 0 0" + end + "v 1 0 0" + end + "v 0 1 0" + end;
    CHECK(trianglesOf(head + "f 1 2 3") == one);
    CHECK(trianglesOf("\xEF\xBB\xBF" + head + "f 1 2 3" + end) == one);
    CHECK(trianglesOf(head + "f 1 \\" + end + "2 3" + end) == one);
    CHECK(trianglesOf(head + "f 1 2\\" + end + " 3" + end) == one);
    CHECK(trianglesOf("v 0 0 \\" + end + "0" + end + "v 1 \\" + end + "0 0" + end + "v 0 1 0" + end +
                      "f 1 2 3" + end) == one);
    CHECK(trianglesOf("# made by C:\\tools\\" + end + head + "f 1 2 3 # the only one" + end) == one);
    CHECK(trianglesOf(head + "# old" + end + "f 1 2 3") == one);
  }
  // CR ends a line also among lines that end with LF: every reader sees the same faces.
  CHECK_THROWS_WITH(trianglesOf("v 0 0 0\nv 1 0 0\nv 0 1 0\n# old\rf 1 2 1900000000\nf 1 2 3\n"),
                    "a.obj:5:7: there is no vertex 1900000000; 3 are above this line");
  CHECK(trianglesOf("  v 0 0 0\n\tv\t1\t0\t0\n  \n\t\nv 0 1 0   \ng a b c\ng\no x y\ns off\nusemtl "
                    "none\nusemtl\nl 1 2\np 1\nunknown 1 "
                    "2\n  f  1  2  3  \n") == one);
  CHECK(trianglesOf("v 0 0 0 1\nv 1 0 0 0.5 0.5 0.5\nv 0 1 0 1 1 1 1\nf 1/ 2// 3/\n") == one);
  CHECK(trianglesOf("v +1.0D+3 1.d0 .5\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\n") == one);
}

TEST_CASE("OBJ corners have texture coordinates, normals and materials") {
  const ObjFile file = parseObj("a.obj",
                                "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0.5 0.25\nvt 1\nvn 0 0 1\nf 1/2/1 2/-2 "
                                "3//1\nusemtl dark red\nf 1 2 3\nusemtl b\nusemtl dark red\nf 1 3 2\n");
  REQUIRE(file.triangles.size() == 3);
  const std::array<ObjCorner, 3>& corners = file.triangles[0].corners;
  CHECK(corners[0].texture == 1);
  CHECK(corners[0].normal == 0);
  CHECK(corners[1].texture == 0);
  CHECK(corners[1].normal == -1);
  CHECK(corners[2].texture == -1);
  CHECK(file.triangles[0].material == -1);
  CHECK(file.triangles[2].material == 0);
  CHECK(file.materials == std::vector<std::string>{"dark red", "b"});
  CHECK(file.textures[1] == sk::float2{1, 0});
}

TEST_CASE("concave OBJ polygons are cut inside") {
  CHECK(trianglesOf("v 0 10 0\nv -1 0 0\nv 0 1 0\nv 1 0 0\nf 1 2 3 4\n") == Points{{0, 1, 2}, {0, 2, 3}});
  CHECK(trianglesOf("v -1 0 0\nv 0 1 0\nv 1 0 0\nv 0 10 0\nf 1 2 3 4\n") == Points{{3, 0, 1}, {3, 1, 2}});
  CHECK(trianglesOf("v 0 0 0\nv 2 0 0\nv 1 0 0\nf 1 2 3\nf 1 2 3 1\n").size() == 3);  // without area
}

TEST_CASE("errors in OBJ files name the line and the column") {
  const std::pair<std::string, std::string> cases[] = {
      {"v 0 0 0\nv 1 x 0\n", "a.obj:2:5: 'x' is no number"},
      {"v 0 0\n", "a.obj:1:6: z is missing"},
      {"v 0 \\\n0\n", "a.obj:2:2: z is missing"},
      {"v 0 0 0 1 1 1 1 1\n",
       "a.obj:1:17: '1' is too much; a position is x y z, and perhaps a weight and a colour"},
      {"v 0 0 0 one\n", "a.obj:1:9: 'one' is no number"},
      {"vt\n", "a.obj:1:3: u is missing"},
      {"v 0 0 0\nv 0 0 0\nv 0 0 0\nf 1 2 4\n", "a.obj:4:7: there is no vertex 4; 3 are above this line"},
      {"v 0 0 0\rf 1 1 -2\r", "a.obj:2:7: there is no vertex -2; 1 are above this line"},
      {"v 0 0 0\nf 1 1 -9223372036854775808\n",
       "a.obj:2:7: there is no vertex -9223372036854775808; 1 are above this line"},
      {"v 0 0 0\nf 0 1 1\n", "a.obj:2:3: 0 is no vertex; they count from 1"},
      {"v 0 0 0\nf 1.0 1 1\n", "a.obj:2:3: '1.0' is no integer"},
      {"v 0 0 0\nf 1 1/2/3/4 1\n", "a.obj:2:5: there is no texture vertex 2; 0 are above this line"},
      {"v 0 0 0\nf /1 1 1\n", "a.obj:2:3: '' is no integer"},
      {"v 0 0 0\nf 1 1\n", "a.obj:2:6: a face has three corners at least, and this one has 2"},
      {"v 0 0 0\nf\n", "a.obj:2:2: a face has three corners at least, and this one has 0"},
      {"v 0 0 0\nf 1//1 1 1\n", "a.obj:2:3: there is no normal 1; 0 are above this line"}};
  for (const auto& [text, message] : cases) {
    CAPTURE(text);
    CHECK_THROWS_WITH(parseObj("a.obj", text), message);
  }
  CHECK(parseObj("a.obj", "").triangles.empty());
  CHECK(std::isnan(parseObj("a.obj", "v nan 0 0\nv 1e999 0 1e-999\n").points[0].x));
  CHECK_THROWS_WITH(parseObj("a.obj", "v 0 1e999 0\n", {.onlyFinite = true}),
                    "a.obj:1:11: a position is not finite");
}

TEST_CASE("files of OBJ materials may have blanks in their names") {
  const WrittenFile one("", "obj test.mtl"), other("", "obj_test.mtl");
  const auto files = [](const std::string& names) {
    return parseObj("a.obj", "mtllib " + names + "\n", {.materialsFolder = "."}).materialFiles;
  };
  CHECK(files("obj test.mtl # both").size() == 1);
  CHECK(files("obj_test.mtl obj_test.mtl").size() == 2);
  CHECK_THROWS_WITH(files("obj_test.mtl none.mtl"), Catch::StartsWith("a.obj:1:21: there is no file '"));
  CHECK(parseObj("a.obj", "mtllib none.mtl\n").materialFiles.empty());
}

}  // namespace
}  // namespace examples
