// SPDX-License-Identifier: MIT
//
// Files of fields: what is in them, byte by byte, and what is refused.
#include "support/field_file.hpp"

#include <cstring>
#include <fstream>
#include <string>

#include <catch2/catch.hpp>
#include <sk/npy.hpp>

#include "support/image.hpp"
#include "support/testing.hpp"
#include "support/text_file.hpp"

namespace {

using namespace examples;
namespace fs = std::filesystem;
using Catch::Matchers::Contains;

const GridFile plane{
    {3, 2, 1}, 0.5, {{"u", 1, {1, 2, 3, 4, 5, 6}}, {"velocity", 3, std::vector<double>(18, 0.25)}}};

/// The floats at a place behind the underscore that begins appended data.
std::vector<float> floatsAt(const std::string& file, std::size_t offset) {
  const std::size_t start = file.find("<AppendedData encoding=\"raw\">\n_") + 31 + offset;
  std::uint64_t bytes = 0;
  std::memcpy(&bytes, file.data() + start, sizeof bytes);
  std::vector<float> values(bytes / sizeof(float));
  std::memcpy(values.data(), file.data() + start + sizeof bytes, bytes);
  return values;
}

}  // namespace

TEST_CASE("grids are written for VTK") {
  const fs::path file = "fields.vti";
  CHECK(saveGrid(file, plane) == std::vector<fs::path>{file});
  const std::string text = bytesOf(file, "the file");
  CHECK_THAT(text, Contains("WholeExtent=\"0 3 0 2 0 0\" Origin=\"0 0 0\" Spacing=\"0.5 0.5 0.5\""));
  CHECK_THAT(text, Contains("Name=\"u\" NumberOfComponents=\"1\" format=\"appended\" offset=\"0\""));
  CHECK_THAT(text, Contains("Name=\"velocity\" NumberOfComponents=\"3\" format=\"appended\" offset=\"32\""));
  CHECK(floatsAt(text, 0) == std::vector<float>{1, 2, 3, 4, 5, 6});
  CHECK(floatsAt(text, 32) == std::vector<float>(18, 0.25f));
  fs::remove(file);
}

TEST_CASE("grids are written for NumPy, and as floats alone") {
  const auto files = saveGrid("fields.npy", plane);
  REQUIRE(files == std::vector<fs::path>{"fields_u.npy", "fields_velocity.npy"});
  CHECK(sk::readNpy(files[0]).extents == std::vector<std::int64_t>{2, 3});
  CHECK(sk::readNpy(files[0]).values == plane.fields[0].values);
  CHECK(sk::readNpy(files[1]).extents == std::vector<std::int64_t>{2, 3, 3});
  CHECK(loadGrid(files[0], plane.cells) == plane.fields[0].values);
  const GridFile one{{3, 2, 1}, 0.5, {plane.fields[0]}};
  CHECK(saveGrid("fields.raw", one) == std::vector<fs::path>{"fields_u.raw"});
  CHECK(bytesOf("fields_u.raw", "the file").size() == 24);
  CHECK_THROWS_WITH(loadGrid(files[0], {2, 3, 1}),
                    Contains("'fields_u.npy' has an array of the shape (2, 3), and the grid needs (3, 2)"));
  CHECK_THROWS_WITH(saveGrid("fields.csv", plane), Contains("must end in .vti (VTK), .npy (NumPy) or .raw"));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  sk::writeNpy("fields.npy", std::vector<std::int64_t>{1, 2}, std::vector<double>{1, nan});
  CHECK_THROWS_WITH(loadGrid("fields.npy", {2, 1, 1}), Contains("number 1 is not finite"));
  for (const char* name : {"fields_u.npy", "fields_velocity.npy", "fields.npy", "fields_u.raw"})
    fs::remove(name);
}

TEST_CASE("pictures are grids whose last row is the lowest") {
  Image image = plainImage(2, 2, {0, 0, 0});
  for (int part = 0; part < 3; ++part) image.pixel(0, 1)[part] = 255;   // bottom left
  savePng("mask.png", image);
  CHECK(loadGrid("mask.png", {2, 2, 1})[0] == Approx(1.0));
  CHECK(loadGrid("mask.png", {2, 2, 1})[2] == 0.0);
  CHECK_THROWS_WITH(loadGrid("mask.png", {3, 2, 1}), Contains("has 2 x 2 pixels, and the grid 3 x 2 cells"));
  CHECK_THROWS_WITH(loadGrid("mask.png", {2, 2, 2}), Contains("a grid in space is read from a .npy file"));
  fs::remove("mask.png");
}

TEST_CASE("surfaces are written for VTK") {
  saveSurface("surface.vtp",
              {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, {{"Normals", 3, std::vector<double>(9, 1)}}});
  const std::string text = bytesOf("surface.vtp", "the file");
  CHECK_THAT(text, Contains("NumberOfPoints=\"3\" NumberOfPolys=\"1\""));
  CHECK(floatsAt(text, 44) == std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0});
  CHECK_THROWS_WITH(saveSurface("surface.ply", {}), Contains("must end in .vtp (VTK)"));
  fs::remove("surface.vtp");
}
