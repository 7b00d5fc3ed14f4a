// SPDX-License-Identifier: MIT
//
// Records: when frames are due, and what is on file after a run that ends early.
#include "support/record.hpp"

#include <stdexcept>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <catch2/catch.hpp>

#include "support/field_view.hpp"
#include "support/options.hpp"
#include "support/testing.hpp"
#include "support/text_file.hpp"

namespace {

using namespace examples;
namespace fs = std::filesystem;

Image picture() { return plainImage(4, 2, {1, 0, 0}); }
GridFile noFields() { throw std::logic_error("no fields are wanted"); }

/// The steps after which a run of `steps` steps adds its pictures; 0 is the start.
std::vector<std::int64_t> framesOf(int frames, std::int64_t steps) {
  const fs::path output = frames > 1 ? "recorded.apng" : "recorded.png";
  std::vector<std::int64_t> added;
  {
    Frames pictures({.output = output, .frames = frames});
    for (std::int64_t step = 0; step <= steps; ++step) {
      if (step == 0 ? !pictures.wantsStart() : !pictures.isDue(step, steps)) continue;
      pictures.add(picture, noFields);
      added.push_back(step);
    }
    pictures.finish();
    CHECK(pictures.count() == static_cast<int>(added.size()));
  }
  fs::remove(output);
  return added;
}

}  // namespace

TEST_CASE("frames are evenly spaced from the start of a run to its end") {
  using Steps = std::vector<std::int64_t>;
  CHECK(framesOf(1, 5) == Steps{5});
  CHECK(framesOf(2, 5) == Steps{0, 5});
  CHECK(framesOf(3, 10) == Steps{0, 5, 10});
  CHECK(framesOf(4, 10) == Steps{0, 3, 6, 10});
  CHECK(framesOf(9, 3) == Steps{0, 1, 2, 3});  // one a step, where there are fewer steps
}

TEST_CASE("without an output no frame is due") {
  const Frames pictures({.output = "", .frames = 3});
  CHECK_FALSE(pictures.wantsStart());
  CHECK_FALSE(pictures.isDue(5, 5));
}

TEST_CASE("pictures that were made before an error are a complete file") {
  fs::remove("early.apng");
  CHECK_THROWS_AS(([] {
                    Frames pictures({.output = "early.apng", .frames = 100});
                    pictures.add(picture, noFields);
                    pictures.add(picture, noFields);
                    throw std::runtime_error("step 2");
                  }()),
                  std::runtime_error);
  const std::string bytes = bytesOf("early.apng", "the film");
  CHECK(bytes.find("IEND") != std::string::npos);
  CHECK(bytes.substr(bytes.find("acTL") + 4, 4) == std::string("\0\0\0\2", 4));
  fs::remove("early.apng");
}

TEST_CASE("rows of numbers are on file at once, in a folder that is created") {
  fs::remove_all("rows");
  CsvFile csv("rows/deep/numbers.csv", "step,time");
  csv.add("1,0.5");
  CHECK(bytesOf("rows/deep/numbers.csv", "the table") == "step,time\n1,0.5\n");
  fs::remove_all("rows");
  CsvFile none("", "step");
  CHECK_FALSE(none.isWanted());
  none.add("1");
  CHECK_THROWS_WITH(CsvFile("/dev/full", "step"), "cannot write '/dev/full'");
}

TEST_CASE("a scene's record is read, and its picture has the scene's name by default") {
  const WrittenFile file(
      "[record]\noutput = \"a.gif\"\nframes = 7\nframes_per_second = 12\ncsv = \"a.csv\"\n");
  const Record r = readRecord(loadScene(file.path()).table("record"), "pool");
  CHECK(r.output == "a.gif");
  CHECK(r.frames == 7);
  CHECK(r.framesPerSecond == 12);
  CHECK(r.csv == "a.csv");
  CHECK(readRecord(std::nullopt, "pool").output == "pool.png");

  CLI::App cli;
  const RecordOptions options(cli, "the time");
  cli.parse("--output b.png --frames 2");
  Record mixed = r;
  options.apply(mixed);
  CHECK(mixed.output == "b.png");
  CHECK(mixed.frames == 2);
  CHECK(mixed.csv == "a.csv");
}

TEST_CASE("a view shows all corners of a box") {
  const BoxView view = boxView({10, 20, 30}, 0.6, 0.3, 100);
  const auto part = [](const sk::float3& a, const sk::float3& b) {
    return (a.x * b.x + a.y * b.y + a.z * b.z) / (b.x * b.x + b.y * b.y + b.z * b.z);
  };
  float across = 0, along = 0;
  for (const float x : {-0.5f, 9.5f})
    for (const float y : {-0.5f, 19.5f})
      for (const float z : {-0.5f, 29.5f}) {
        const sk::float3 corner = {x - view.middle.x, y - view.middle.y, z - view.middle.z};
        across = std::max(across, std::abs(part(corner, view.right)));
        along = std::max(along, std::abs(part(corner, view.up)));
      }
  CHECK(across == Approx(1 / 1.04));
  CHECK(along == Approx(1 / 1.04));
  CHECK(part(view.right, view.up) == Approx(0).margin(1e-6));
  CHECK(view.height % 2 == 0);
}
