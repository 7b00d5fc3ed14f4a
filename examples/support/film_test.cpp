// SPDX-License-Identifier: MIT
//
// Films: what is written can be read again.
#include "support/film.hpp"

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include <catch2/catch.hpp>

#include "support/image.hpp"

namespace {

using namespace examples;
namespace fs = std::filesystem;

std::string bytesOf(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::uint32_t numberAt(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = (value << 8) | static_cast<unsigned char>(bytes.at(at + i));
  return value;
}

void fill(Film& film, int frames) {
  for (int i = 0; i < frames; ++i) film.add(plainImage(16, 8, {static_cast<float>(i) / 4.0f, 0, 1}));
  film.finish();
}

}  // namespace

TEST_CASE("frames are numbered files") {
  fs::remove_all("film");
  Film film("film/waves.png", 25);
  fill(film, 3);
  CHECK(film.frames() == 3);
  CHECK(loadPicture("film/waves_0002.png").pixels[0].x == 128);
  CHECK_FALSE(fs::exists("film/waves_0003.png"));
}

TEST_CASE("an animated PNG has all frames, in chunks of the right order, and is a PNG") {
  Film film("film/waves.apng", 30);
  fill(film, 4);
  const std::string bytes = bytesOf("film/waves.apng");
  std::string order;
  std::uint32_t sequence = 0;
  for (std::size_t at = 8; at < bytes.size(); at += numberAt(bytes, at) + 12) {
    const std::string type = bytes.substr(at + 4, 4);
    order += type + " ";
    if (type == "acTL") CHECK(numberAt(bytes, at + 8) == 4);
    if (type == "fcTL" || type == "fdAT") CHECK(numberAt(bytes, at + 8) == sequence++);
  }
  CHECK(order == "IHDR acTL fcTL IDAT fcTL fdAT fcTL fdAT fcTL fdAT IEND ");
  CHECK(loadPicture("film/waves.apng").width == 16);
}

TEST_CASE("what cannot become a film is told") {
  CHECK_THROWS_WITH(Film("film/waves.jpg", 25), Catch::Contains("must end in .png, .apng, .mp4"));
  CHECK_THROWS_WITH(Film("/dev/null/waves.apng", 25), Catch::Contains("cannot write"));
  Film film("film/odd.png", 25);
  film.add(plainImage(4, 4, {0, 0, 0}));
  CHECK_THROWS_WITH(film.add(plainImage(5, 4, {0, 0, 0})),
                    Catch::Contains("5 x 4 pixels in a film of 4 x 4"));
  const std::string path = std::getenv("PATH");
  setenv("PATH", "/nonexistent", 1);
  CHECK_THROWS_WITH(Film("film/waves.mp4", 25), Catch::Contains("takes ffmpeg, which is not installed"));
  setenv("PATH", path.c_str(), 1);
}

TEST_CASE("ffmpeg gets every frame, and its failure is told") {
  fs::create_directories("film/bin");
  const auto pretend = [](const std::string& script) {
    std::ofstream("film/bin/ffmpeg") << "#!/bin/sh\n" << script << "\n";
    fs::permissions("film/bin/ffmpeg", fs::perms::owner_all);
  };
  const std::string path = std::getenv("PATH");
  setenv("PATH", ("film/bin:" + path).c_str(), 1);
  pretend("for last; do :; done; cat > \"$last\"; echo \"$@\" > film/arguments");
  Film film("film/it's.mp4", 24);
  fill(film, 5);
  CHECK(fs::file_size("film/it's.mp4") == 5 * 16 * 8 * 3);
  CHECK(bytesOf("film/arguments").find("-video_size 16x8 -framerate 24") != std::string::npos);
  pretend("exit 3");
  Film failing("film/waves.gif", 24);
  CHECK_THROWS_WITH(fill(failing, 2), Catch::Contains("ffmpeg could not write 'film/waves.gif'"));
  setenv("PATH", path.c_str(), 1);
}
