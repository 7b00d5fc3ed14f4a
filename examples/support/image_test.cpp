// SPDX-License-Identifier: MIT
#include "support/image.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>

namespace examples {
namespace {

/// A folder that goes when the test does.
class Scratch {
 public:
  Scratch() { std::filesystem::create_directories(folder_); }
  ~Scratch() { std::filesystem::remove_all(folder_); }
  std::filesystem::path operator/(const char* name) const { return folder_ / name; }

 private:
  std::filesystem::path folder_ = std::filesystem::temp_directory_path() / "sk_picture_test";
};

TEST_CASE("sRGB's curve and its inverse") {
  CHECK(linearFromSrgb(0.0) == 0.0);
  CHECK(linearFromSrgb(1.0) == Approx(1.0));
  CHECK(linearFromSrgb(0.5) == Approx(0.21404).epsilon(1e-4));  // IEC 61966-2-1
  // The standard's constants meet at the break only to about 1e-7.
  for (double x = 0.0; x <= 1.0; x += 1.0 / 1024)
    CHECK(srgbFromLinear(linearFromSrgb(x)) == Approx(x).margin(1e-6));
}

TEST_CASE("a picture is read as it was written") {
  const Scratch scratch;
  Picture picture{
      3, 2, 255, {{0, 1, 2}, {253, 254, 255}, {10, 20, 30}, {0, 0, 0}, {255, 255, 255}, {7, 77, 177}}};
  savePng(scratch / "made/a.png", picture);
  const Picture back = loadPicture(scratch / "made/a.png");
  CHECK(back.width == 3);
  CHECK(back.height == 2);
  CHECK(back.white == 255);
  CHECK(back.pixels == picture.pixels);
}

TEST_CASE("components outside of [0, 1] are clamped, NaN is black") {
  const Scratch scratch;
  savePng(scratch / "b.png", 1, 1, std::vector<sk::float3>{{-1.0f, 2.0f, NAN}});
  CHECK(loadPicture(scratch / "b.png").pixels == std::vector<sk::int3>{{0, 255, 0}});
}

TEST_CASE("what is no picture is said to be none") {
  const Scratch scratch;
  std::ofstream(scratch / "text.png") << "no picture";
  CHECK_THROWS_WITH(loadPicture(scratch / "text.png"), Catch::Contains("text.png' is no picture"));
  CHECK_THROWS_WITH(loadPicture(scratch / "none.png"), Catch::Contains("does not exist"));
  CHECK_THROWS_WITH(loadPicture(std::filesystem::temp_directory_path()), Catch::Contains("is no file"));
}

}  // namespace
}  // namespace examples
