// SPDX-License-Identifier: MIT
//
// Pictures that stop where they are good enough, that go on from a file, and that are written with their layers.
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "exposure.hpp"
#include "raster_file.hpp"
#include "render.hpp"
#include "scene.hpp"
#include "skip.hpp"
#include "state_file.hpp"
#include "support/testing.hpp"

namespace rays {
namespace {

/// A lamp over a floor with a box: shadows with soft edges, where samples differ, and a sky, where they do not.
const std::string lampScene =
    "[camera]\nfrom = [0, 1.2, 3]\nto = [0, 0.3, 0]\n[environment]\ncolour = [0.2, 0.3, 0.4]\n"
    "[[material]]\nname = \"white\"\n[[material]]\nname = \"lamp\"\nemission = [9, 9, 9]\n"
    "[[plane]]\nmaterial = \"white\"\n[[mesh]]\nshape = \"box\"\nmaterial = \"white\"\ntranslate = [0, 0.5, "
    "0]\n"
    "[[sphere]]\ncentre = [1.5, 2, 1]\nradius = 0.4\nmaterial = \"lamp\"\n";

Scene sceneOf(const std::string& picture, const std::string& rest = lampScene) {
  return readScene(examples::WrittenFile(picture + rest, "written_progressive.toml").path(), {});
}

struct Made {
  Rendering rendering;
  Gathered gathered;
};

Made make(sk::Device& device, const Scene& read, const std::filesystem::path& state = {}) {
  const std::unique_ptr<Engine> engine = read.engines.at(read.engine)(device, read.model);
  const std::unique_ptr<Renderer> renderer = engine->renderer(read.picture);
  Rendering rendering = render(*renderer, read, {state, device.name()});
  return {std::move(rendering), renderer->exposure().gathered()};
}

/// A file that is deleted at the end.
struct StateFile {
  std::filesystem::path path = "written_progressive.state";
  StateFile() { std::filesystem::remove(path); }
  ~StateFile() { std::filesystem::remove(path); }
};

TEST_CASE("pixels are asked at powers of two and at one and a half of them") {
  std::vector<int> looks;
  for (int n = 1; n <= 200; ++n)
    if (isLook(n, 20)) looks.push_back(n);
  CHECK(looks == std::vector<int>{20, 24, 32, 48, 64, 96, 128, 192});
}

TEST_CASE("a pixel that stops has the mean of its samples, by every engine") {
  sk::Device device = sk::Device::native();
  for (const char* engine : {"engine = \"bvh\"\n", "engine = \"streaming\"\n",
                             "engine = \"streaming\"\n[streaming]\nmachine = \"multipass\"\n"}) {
    INFO(engine);
    const std::string picture = "[picture]\nsize = [16, 12]\nsamples = 12\nleast_samples = 4\nerror = 0.1\n";
    const Scene read = sceneOf(engine + picture);
    const Made got = make(device, read);
    REQUIRE(got.gathered.counts.size() == 192);

    const std::unique_ptr<Engine> made = read.engines.at(read.engine)(device, read.model);
    const std::unique_ptr<Renderer> all = made->renderer(read.picture);
    std::map<int, int> found;
    for (int n = 1; n <= 12; ++n) {
      all->pass(n - 1);
      const std::vector<sk::float3> image = all->image();
      for (std::size_t i = 0; i < image.size(); ++i) {
        if (got.gathered.counts[i] != n) continue;
        ++found[n];
        CHECK((got.rendering.radiance[i] == image[i]));
      }
    }
    // The sky has stopped at once, edges of shadows not at all, and all stop at looks.
    CHECK(found[4] > 30);
    CHECK(found[12] > 20);
    CHECK(found[4] + found[6] + found[8] + found[12] == 192);
    CHECK(got.rendering.perPixel < 10);
  }
}

TEST_CASE("where pixels stop, the picture is as exact as was asked, and hardly darker") {
  sk::Device device = sk::Device::native();
  // All pixels see nearly one point, half of whose sky a box hides, so that the truth is one number.
  const std::string rest =
      "[camera]\nfrom = [0.4, 1, 0.3]\nto = [0, 0, 0]\nfield_of_view = 0.02\n[environment]\ncolour = [1, 1, "
      "1]\n"
      "[[material]]\nname = \"white\"\n[[mesh]]\nshape = \"quad\"\n[[mesh]]\nshape = \"box\"\ntranslate = "
      "[0.3, 0.6, 0]\nscale = [0.4]\n";
  const std::string picture = "[picture]\nsize = [24, 24]\ndepth = 2\nsampling = \"random\"\n";
  const auto meanOf = [](const std::vector<sk::float3>& pixels) {
    double sum = 0.0;
    for (const sk::float3& p : pixels) sum += p.y;
    return sum / double(pixels.size());
  };
  const double truth = meanOf(make(device, sceneOf(picture + "samples = 600\n", rest)).rendering.radiance);
  const Made got = make(device, sceneOf(picture + "samples = 1000\nerror = 0.03\n", rest));
  CHECK(got.rendering.unfinished == 0);
  CHECK(got.rendering.perPixel < 500);
  // Pixels stop where their samples happen to differ little: the bias is far below what was asked for, and noise is 0.03 / 1.96 at most.
  INFO(meanOf(got.rendering.radiance) / truth - 1 << " " << got.rendering.perPixel);
  CHECK(std::abs(meanOf(got.rendering.radiance) - truth) < 0.003 * truth);
  double squares = 0.0;
  for (const sk::float3& p : got.rendering.radiance) squares += (p.y - truth) * (p.y - truth);
  CHECK(std::sqrt(squares / 576) < 0.03 / 1.96 * truth);
}

TEST_CASE("a picture that goes on from a file is the one without a break, to the bit") {
  const bool isAdaptive = GENERATE(false, true);
  INFO(isAdaptive);
  sk::Device device = sk::Device::native();
  const examples::WrittenFile kept(
      fmt::format("[picture]\nsize = [12, 9]\nleast_samples = 2\nerror = {}\nsamples = 8\n",
                  isAdaptive ? 0.2 : 0.0) +
          lampScene,
      "written_progressive_again.toml");
  Scene read = readScene(kept.path(), {});
  const Made whole = make(device, read);
  const StateFile state;
  for (const int samples : {3, 5, 8}) {
    read.output.samples = samples;
    const Made part = make(device, read, state.path);
    CHECK(part.rendering.samples == samples);
    if (samples < 8) continue;
    CHECK(part.rendering.resumed == 5);
    CHECK((part.gathered == whole.gathered));
    CHECK((part.rendering.radiance == whole.rendering.radiance));
  }
  CHECK(whole.gathered.counts.empty() != isAdaptive);
  // There is nothing to do any more.
  CHECK(make(device, read, state.path).rendering.resumed == 8);
}

TEST_CASE("sums go on from what was gathered, to the bit, on every device") {
  // The samples of the first pixels differ little, so that these stop.
  constexpr int width = 6, height = 5;
  const auto sample = [](int n) {
    std::vector<sk::float3> pixels;
    for (int i = 0; i < width * height; ++i) {
      const float size = i < 12 ? 0.001f : 1.0f;
      pixels.push_back({1 + size * std::sin(float(7 * n + i)), 1e-3f * float(n), 0.1f * float(i % 5)});
    }
    return pixels;
  };
  const Tolerance tolerance{0.01, 0.05};
  Gathered onNative;
  for (const char* profile : {"native", "essl300", "glsl430"}) {
    INFO(profile);
    sk::Device device = examples::deviceNamed(profile);
    const auto add = [&](Exposure& exposure, int n) {
      exposure.radiance.write(sample(n));
      exposure.add();
      if (n % 3 == 2) exposure.narrow(tolerance);
    };
    const Picture picture{.width = width, .height = height};
    Exposure whole(device, picture), first(device, picture);
    for (int n = 0; n < 8; ++n) add(whole, n);
    for (int n = 0; n < 4; ++n) add(first, n);
    Exposure second(device, picture);
    second.restore(first.gathered());
    CHECK(second.activePixels() == first.activePixels());
    for (int n = 4; n < 8; ++n) add(second, n);
    const Gathered gathered = whole.gathered();
    CHECK((second.gathered() == gathered));
    CHECK((second.image() == whole.image()));
    if (onNative.passes == 0) onNative = gathered;
    CHECK((gathered.counts == onNative.counts));
    CHECK((gathered.active == onNative.active));
    CHECK(second.counts()[0] == 3);
    CHECK(second.counts()[29] == 8);
    CHECK(second.pixels().read().front().y > 0);
  }
}

TEST_CASE("states of other pictures, and what is none, are refused") {
  sk::Device device = sk::Device::native();
  const std::string picture = "[picture]\nsize = [4, 3]\nsamples = 2\n";
  const examples::WrittenFile kept(picture + lampScene, "written_progressive_again.toml");
  Scene read = readScene(kept.path(), {});
  const StateFile state;
  const Made first = make(device, read, state.path);
  const auto checkRefused = [&](const Scene& other, const char* message,
                                const std::string& deviceName = "native") {
    CHECK_THROWS_WITH(loadState(state.path, identityOf(other, deviceName)), Catch::Contains(message));
  };
  CHECK((loadState(state.path, identityOf(read, device.name())) == first.gathered));
  checkRefused(read, "it has device native, and this one device another", "another");
  Scene other = read;
  other.picture.width = 5;
  checkRefused(other, "it has size 4 x 3, and this one size 5 x 3");
  other = read;
  other.output.error = 0.1;
  checkRefused(other, "no error to reach");
  other = read;
  other.model.triangles[0].a.x += 1;
  checkRefused(other, "meshes and images");
  {
    const examples::WrittenFile changed(picture + lampScene + "\n", "written_progressive_changed.toml");
    other = read;
    other.file = changed.path();
    checkRefused(other, "scene text");
  }

  std::ifstream stream(state.path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  std::string damaged = bytes;
  damaged[bytes.size() - 30] ^= 1;
  const std::pair<std::string, const char*> files[] = {
      {bytes.substr(0, bytes.size() - 20), "is damaged"},
      {bytes.substr(0, 40), "ends too early"},
      {damaged, "is damaged"},
      {"rays state 0" + bytes.substr(12), "of another version"},
      {"# no state\n", "is no state of a picture"}};
  for (const auto& [changed, message] : files) {
    std::ofstream(state.path, std::ios::binary) << changed;
    checkRefused(read, message);
  }
}

TEST_CASE("OpenEXR files hold the picture, or a build without the library says so") {
  const std::vector<sk::float3> pixels = {{0, 1e-20f, 3}, {4e20f, -5, 6}, {7, 8, 9},
                                          {1, 2, 3},      {4, 5, 6},      {7, 8, 1e9f}};
  std::vector<Layer> layers = {
      {.name = "depth", .pixels = pixels, .isSingle = true},
      {.name = "normal", .pixels = pixels},
      {.name = "id", .pixels = pixels, .isSingle = true, .whole = {-1, 0, 1, 2, 1 << 27, 5}}};
  const examples::WrittenFile file("", "written_map.exr");
  try {
    needExr(file.path());
  } catch (const std::runtime_error& error) {
    CHECK_THAT(error.what(), Catch::Contains("install libopenexr-dev"));
    skip("this build has no OpenEXR");
    return;
  }
  saveExr(file.path(), 3, 2, pixels, layers);
  const Raster raster = loadRaster(file.path());
  CHECK(raster.width == 3);
  CHECK((raster.pixels == pixels));
  std::ifstream stream(file.path(), std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  for (const char* channel : {"Z", "normal.X", "normal.Z", "id"})
    CHECK(bytes.find(std::string(1, '\0') + channel + '\0') != std::string::npos);
  std::filesystem::resize_file(file.path(), 100);
  CHECK_THROWS_WITH(loadRaster(file.path()), Catch::Contains("written_map.exr: this is no OpenEXR picture"));
  CHECK_THROWS_WITH(loadRaster("none.exr"), Catch::Contains("none.exr: the picture does not exist"));
}

}  // namespace
}  // namespace rays
