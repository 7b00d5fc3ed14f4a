// SPDX-License-Identifier: MIT
//
// Pictures whose radiance is known: furnaces, lights over a floor, the numbers that samples are made of.
#include "render.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "layers.hpp"
#include "light_table.hpp"
#include "path_tables.hpp"
#include "raster_file.hpp"
#include "scenes_test.hpp"
#include "support/testing.hpp"

namespace rays {
namespace {

constexpr double circle = std::numbers::pi;

struct Estimate {
  double mean = 0.0;
  double error = 0.0;  ///< standard error of the mean, of independent pixels
  double least = HUGE_VAL, most = -HUGE_VAL;
};

std::vector<sk::float3> radianceOf(sk::Device& device, const std::string& text) {
  const Scene scene = sceneFrom(text);
  const std::unique_ptr<Engine> engine = scene.engines.at("bvh")(device, scene.model);
  return render(*engine->renderer(scene.picture), scene).radiance;
}

/// Estimates the mean of the green component; each pixel counts as one sample of it.
Estimate estimateOf(const std::vector<sk::float3>& pixels) {
  Estimate e;
  double squares = 0.0;
  const auto n = static_cast<double>(pixels.size());
  for (const sk::float3& p : pixels) {
    e.mean += p.y / n;
    e.least = std::min(e.least, double(p.y));
    e.most = std::max(e.most, double(p.y));
  }
  for (const sk::float3& p : pixels) squares += (p.y - e.mean) * (p.y - e.mean);
  e.error = std::sqrt(squares / (n * (n - 1)));
  return e;
}

Estimate nativeEstimate(const std::string& text) {
  sk::Device device = sk::Device::native();
  return estimateOf(radianceOf(device, text));
}

/// A picture of 16 x 16 pixels, all of which see nearly one point at the origin from above.
std::string pictureOf(int samples, int depth) {
  return fmt::format(
      "[camera]\nfrom = [0.4, 1, 0.3]\nto = [0, 0, 0]\nfield_of_view = 0.02\n"
      "[picture]\nsize = [16, 16]\nsamples = {}\ndepth = {}\nsampling = \"random\"\n",
      samples, depth);
}

const std::string floor =
    "[[material]]\nname = \"floor\"\ncolour = [0.5, 0.5, 0.5]\n[[mesh]]\nshape = \"quad\"\nmaterial = "
    "\"floor\"\n";

/// Within four standard errors, of which one picture in 16,000 is not by chance; the seeds are fixed. What floats round is more
/// than nothing where all samples are alike.
void checkMean(const Estimate& e, double expected) {
  INFO(fmt::format("{} +- {}, expected {}", e.mean, e.error, expected));
  CHECK(std::abs(e.mean - expected) <= 4 * e.error + 1e-5 * expected);
  CHECK(e.error < 0.05 * expected);
}

TEST_CASE("a white furnace stays white, whatever it is made of") {
  const std::string sky = "[environment]\ncolour = [1, 1, 1]\n";
  const std::string things =
      "[[sphere]]\nmaterial = \"m\"\n[[mesh]]\nshape = \"sphere\"\nlevel = 2\nmaterial = \"m\"\nsmooth = "
      "false\n"
      "translate = [1.2, 0, 1]\n";
  for (const char* material : {"type = \"diffuse\"\ncolour = [1, 1, 1]\n",
                               "type = \"mirror\"\ncolour = [1, 1, 1]\n", "type = \"glass\"\n"}) {
    INFO(material);
    const Estimate e = nativeEstimate("[picture]\nsize = [24, 24]\nsamples = 64\ndepth = 200\n" + sky +
                                      "[[material]]\nname = \"m\"\n" + material + things);
    checkMean(e, 1.0);
    CHECK(e.least > 0.5);
  }
}

TEST_CASE("rough metals keep all light, and frosted glass loses little where it is smooth") {
  for (const std::string type : {"metal", "frosted"}) {
    double before = 1.0;
    for (const double roughness : {0.01, 0.3, 1.0}) {
      INFO(type << ' ' << roughness);
      const Estimate e =
          nativeEstimate(fmt::format("[picture]\nsize = [24, 24]\nsamples = 64\ndepth = "
                                     "60\n[environment]\ncolour = [1, 1, 1]\n[camera]\nfield_of_view = 0.1\n"
                                     "[[material]]\nname = \"m\"\ntype = \"{}\"\ncolour = [1, 1, "
                                     "1]\nroughness = {}\n[[sphere]]\nmaterial = \"m\"\n",
                                     type, roughness));
      // What facets of metals send to each other is fitted to 0.25 % (scattering.sk).
      if (type == "metal") CHECK(std::abs(e.mean - 1) <= 0.0025 + 4 * e.error);
      if (type == "frosted") CHECK(e.mean <= before + 4 * e.error + 1e-5);
      before = e.mean;
      if (roughness == 0.01) CHECK(e.mean > 0.98);
    }
  }
}

TEST_CASE("points and suns shine as physics has it") {
  const double albedo = 0.5;
  // A point of intensity 3 at a distance of 2, under an angle of 60 degrees.
  const double y = 2 * std::cos(circle / 3), x = 2 * std::sin(circle / 3);
  const std::string point =
      fmt::format("[[light]]\ntype = \"point\"\nposition = [{}, {}, 0]\nintensity = [3, 3, 3]\n", x, y);
  checkMean(nativeEstimate(pictureOf(1, 2) + floor + point), albedo / circle * 3 * 0.5 / 4);
  const std::string sun = "[[light]]\ntype = \"sun\"\ntowards = [1, 1, 0]\nirradiance = [2, 2, 2]\nangle = ";
  checkMean(nativeEstimate(pictureOf(1, 2) + floor + sun + "0\n"), albedo / circle * 2 * std::sqrt(0.5));
  // A disc all of which is above the horizon has the irradiance of its centre.
  checkMean(nativeEstimate(pictureOf(16, 2) + floor + sun + "5\n"), albedo / circle * 2 * std::sqrt(0.5));
  // All lights at once are the sum.
  checkMean(nativeEstimate(pictureOf(64, 2) + floor + point + sun + "0\n"),
            albedo / circle * (3 * 0.5 / 4 + 2 * std::sqrt(0.5)));
}

TEST_CASE("spheres and squares of light have their irradiance") {
  const std::string lamp = "[[material]]\nname = \"lamp\"\ncolour = [0, 0, 0]\nemission = [4, 4, 4]\n";
  // A sphere of radius r at a distance d: pi L (r / d)^2 cos.
  const double d = std::hypot(1.0, 1.0);
  checkMean(nativeEstimate(pictureOf(64, 2) + floor + lamp +
                           "[[sphere]]\ncentre = [1, 1, 0]\nradius = 0.3\nmaterial = \"lamp\"\n"),
            0.5 * 4 * 0.09 / (d * d) / d);
  // Above the corner of a rectangle a x b at distance 1 (J. Howell, "A catalog of radiation heat transfer configuration factors", B-3),
  // four of which make a square.
  const double a = 0.4, r = std::sqrt(1 + a * a);
  const double corner = (a / r * std::atan(a / r) * 2) / (2 * circle);
  const std::string square =
      "[[mesh]]\nshape = \"quad\"\nmaterial = \"lamp\"\nscale = [0.8]\nrotate = [1, 0, 0, 180]\ntranslate = "
      "[0, 1, 0]\n";
  const std::string aside = "[camera]\nfrom = [1.5, 1, 0.3]\nto = [0, 0, 0]\nfield_of_view = 0.02\n";
  const std::string picture = pictureOf(64, 2);
  checkMean(nativeEstimate(aside + picture.substr(picture.find("[picture]")) + floor + lamp + square),
            0.5 * 4 * 4 * corner);
}

TEST_CASE("a sky's image and a sky's colour are the same light") {
  savePfm("written_sky.pfm", 8, 4, std::vector<sk::float3>(32, {1, 1, 1}));
  const std::string colour = "[environment]\ncolour = [0.7, 0.7, 0.7]\n";
  checkMean(nativeEstimate(pictureOf(64, 2) + floor + colour), 0.35);
  checkMean(nativeEstimate(pictureOf(64, 2) + floor + colour + "image = \"written_sky.pfm\"\n"), 0.35);
  // One bright pixel at the zenith, whose light a floor below must get whole.
  std::vector<sk::float3> pixels(32 * 16, {0.1f, 0.1f, 0.1f});
  pixels[40] = {90, 90, 90};
  savePfm("written_sky.pfm", 32, 16, pixels);
  double expected = 0.0;
  for (int i = 0; i < 32 * 8; ++i) {
    const double top = circle / 16 * (i / 32), bottom = circle / 16 * (i / 32 + 1);
    expected += pixels[std::size_t(i)].y * circle / 16 * 0.5 *
                (std::pow(std::sin(bottom), 2) - std::pow(std::sin(top), 2));
  }
  checkMean(nativeEstimate(pictureOf(256, 2) + floor + "[environment]\nimage = \"written_sky.pfm\"\n"),
            0.5 / circle * expected);
  std::filesystem::remove("written_sky.pfm");
}

TEST_CASE("rays that leave a convex surface never meet it again") {
  // All light that the first hit scatters must reach the sky: any shadow of a surface on itself makes a pixel darker.
  for (const char* thing : {"[[mesh]]\nshape = \"sphere\"\nlevel = 4\nsmooth = false\n", "[[sphere]]\n",
                            "[[mesh]]\nshape = \"box\"\n", "[[plane]]\n"}) {
    for (const char* at : {"[0, 0, 0]", "[700, 300, -400]"}) {
      INFO(thing << at);
      std::string placed = thing;
      const bool isMesh = placed.find("mesh") != std::string::npos;
      placed += fmt::format("{} = {}\n",
                            isMesh                                      ? "translate"
                            : placed.find("plane") == std::string::npos ? "centre"
                                                                        : "through",
                            at);
      const std::string away = std::string(at) == "[0, 0, 0]"
                                   ? "from = [2, 3, 4]\nto = [0, 0, 0]\n"
                                   : "from = [702, 303, -396]\nto = [700, 300, -400]\n";
      const Estimate e = nativeEstimate(
          "[camera]\n" + away +
          "[picture]\nsize = [40, 40]\nsamples = 16\ndepth = 2\n[environment]\ncolour = [1, 1, 1]\n"
          "[[material]]\nname = \"white\"\ncolour = [1, 1, 1]\n" +
          placed);
      CHECK(e.least == Approx(1.0).epsilon(1e-6));
      CHECK(e.most == Approx(1.0).epsilon(1e-6));
    }
  }
}

TEST_CASE("dispatched pictures are those of native code, but for what functions round") {
  const std::string text =
      "[picture]\nsize = [12, 10]\nsamples = 2\ndepth = 4\n[environment]\ncolour = [0.2, 0.3, "
      "0.4]\n[camera]\nlens = 0.05\n"
      "[[material]]\nname = \"a\"\n[[material]]\nname = \"b\"\ntype = \"metal\"\n[[material]]\nname = "
      "\"lamp\"\nemission = [5, 5, 5]\n"
      "[[plane]]\nthrough = [0, -1, 0]\n[[sphere]]\nmaterial = \"b\"\n[[mesh]]\nshape = \"torus\"\nsmooth = "
      "true\n[[sphere]]\n"
      "centre = [2, 2, 1]\nradius = 0.5\nmaterial = \"lamp\"\n";
  const std::string sceneText =
      text.substr(0, text.find("smooth = true\n")) + text.substr(text.find("smooth = true\n") + 14);
  sk::Device native = sk::Device::native();
  const std::vector<sk::float3> expected = radianceOf(native, sceneText);
  // A second to compile. Scenes that look alike (alike_test.cpp) are drawn on glsl330.
  sk::Device device = examples::deviceNamed("glsl430");
  const std::vector<sk::float3> got = radianceOf(device, sceneText);
  // Sines and cosines may send a path past an edge: rarely.
  std::size_t differ = 0;
  for (std::size_t i = 0; i < got.size(); ++i)
    differ += !(std::abs(got[i].y - expected[i].y) <= 1e-3 * (1 + expected[i].y));
  CHECK(differ <= 2);
}

TEST_CASE("a table of aliases has the probabilities of its weights") {
  const std::vector<double> weights = {1, 0, 5, 2.5, 0.25};
  const std::vector<AliasEntry> table = aliasTable(weights);
  std::vector<double> shares(weights.size());
  for (std::size_t i = 0; i < table.size(); ++i) {
    shares[i] += table[i].stays / double(table.size());
    shares[table[i].alias] += (1 - table[i].stays) / double(table.size());
  }
  for (std::size_t i = 0; i < table.size(); ++i) CHECK(shares[i] == Approx(weights[i] / 8.75));
}

TEST_CASE("textures are where their coordinates are, in the picture and in the layers") {
  // Four texels: the left half of the quad's texture is red above and green below, and the right one blue and white.
  savePfm("written_texture.pfm", 2, 2, std::vector<sk::float3>{{1, 0, 0}, {0, 0, 1}, {0, 1, 0}, {1, 1, 1}});
  const std::string scene =
      "[camera]\nfrom = [0, 10, 0]\nto = [0, 0, 0]\nup = [0, 0, -1]\nfield_of_view = 5.72\n[picture]\nsize = "
      "[4, 4]\nsamples = 4096\n"
      "depth = 2\n[environment]\ncolour = [1, 1, 1]\n[[material]]\nname = \"t\"\ncolour = [1, 1, 1]\ntexture "
      "= \"written_texture.pfm\"\n"
      "[[mesh]]\nshape = \"quad\"\nmaterial = \"t\"\n";
  sk::Device device = sk::Device::native();
  const Scene read = sceneFrom(scene);
  const std::unique_ptr<Engine> engine = read.engines.at("bvh")(device, read.model);
  const std::vector<sk::float3> albedo = layersOf(*engine, read.model, read.picture)[2].pixels;
  // The centres of pixels are at 1/8, 3/8 ... of the texture, whose texels have their centres at 1/4 and 3/4 and repeat.
  const auto near = [](const sk::float3& c, const sk::float3& e) {
    return std::abs(c.x - e.x) < 0.01 && std::abs(c.y - e.y) < 0.01 && std::abs(c.z - e.z) < 0.01;
  };
  const float a = 0.75f * 0.75f, b = 0.75f * 0.25f, c = 0.25f * 0.25f;
  CHECK(near(albedo[0], {a + c, b + c, b + c}));
  CHECK(near(albedo[5], {a + c, b + c, b + c}));
  CHECK(near(albedo[3], {b + b, b + c, a + b}));
  CHECK(near(albedo[12], {b + b, a + b, b + c}));
  // A white sky shows the mean over the pixel, where the texture is bilinear: that of its centre. A channel takes
  // values within 0.5 in a pixel, so it deviates by at most 0.25, and the mean of 4096 samples by 0.25 / 64; 0.02 is five of these.
  const std::vector<sk::float3> picture = render(*engine->renderer(read.picture), read).radiance;
  for (std::size_t i = 0; i < picture.size(); ++i) {
    CHECK(std::abs(picture[i].x - albedo[i].x) < 0.02);
    CHECK(std::abs(picture[i].y - albedo[i].y) < 0.02);
    CHECK(std::abs(picture[i].z - albedo[i].z) < 0.02);
  }
  std::filesystem::remove("written_texture.pfm");
}

TEST_CASE("layers have distance, normal and id in the scene's own lengths") {
  const std::string scene =
      "[camera]\nfrom = [0, 0, 500]\nto = [0, 0, 0]\nfield_of_view = 1\n[picture]\nsize = [1, 1]\nsamples = "
      "1\n[[sphere]]\nradius = 100\n";
  sk::Device device = sk::Device::native();
  const Scene read = sceneFrom(scene);
  const std::unique_ptr<Engine> engine = read.engines.at("bvh")(device, read.model);
  const std::vector<Layer> layers = layersOf(*engine, read.model, read.picture);
  CHECK(layers[0].pixels[0].x == Approx(400));
  CHECK(layers[1].pixels[0].z == Approx(1));
  CHECK(layers[3].pixels[0].x == 0);
}

TEST_CASE("the variance is that of the mean") {
  sk::Device device = sk::Device::native();
  const std::string text = pictureOf(200, 2) + floor +
                           "[environment]\ncolour = [1, 1, 1]\n[[mesh]]\nshape = \"box\"\ntranslate = [0.3, "
                           "0.6, 0]\nscale = [0.4]\n";
  const Scene scene = sceneFrom(text);
  const std::unique_ptr<Engine> engine = scene.engines.at("bvh")(device, scene.model);
  const std::unique_ptr<Renderer> renderer = engine->renderer(scene.picture);
  const Estimate between = estimateOf(render(*renderer, scene).radiance);
  const double within = estimateOf(renderer->variance()).mean;
  // All pixels see one point: they differ by what each of them says that it may be off by. 256 of them tell that to a tenth.
  CHECK(within == Approx(between.error * between.error * 256).epsilon(0.35));
}

TEST_CASE("sums of many samples stay what they are") {
  sk::Device device = sk::Device::native();
  Exposure exposure(device, {.width = 1, .height = 1});
  exposure.radiance.fill({0.1f, 0.1f, 0.1f});
  // A sum of floats would be off by a thousandth by now, and by a hundredth after a million.
  for (int i = 0; i < 50'000; ++i) exposure.add();
  CHECK(exposure.image()[0].x == 0.1f);
}

TEST_CASE("Sobol's numbers converge faster than independent ones") {
  const std::string scene = floor +
                            "[environment]\ncolour = [1, 1, 1]\n[[mesh]]\nshape = \"box\"\ntranslate = [0.3, "
                            "0.6, 0]\nscale = [0.4]\n";
  std::string text = pictureOf(64, 2) + scene;
  const Estimate random = nativeEstimate(text);
  text.replace(text.find("random"), 6, "sobol");
  const Estimate sobol = nativeEstimate(text);
  CHECK(sobol.error < 0.6 * random.error);
  CHECK(std::abs(sobol.mean - random.mean) < 4 * (sobol.error + random.error));
}

TEST_CASE("tone maps begin at black and end at white") {
  for (const ToneMap tone : {ToneMap::Linear, ToneMap::Filmic}) {
    Output output;
    output.tone = tone;
    CHECK(toneMapped(0.0f, output) == 0.0f);
    CHECK(toneMapped(1000.0f, output) == 1.0f);
    CHECK(toneMapped(0.1f, output) < toneMapped(0.2f, output));
    CHECK(toneMapped(std::nanf(""), output) == 0.0f);
  }
}

TEST_CASE("float maps are read as they are written") {
  const std::vector<sk::float3> pixels = {{0, 1e-20f, 3}, {4e20f, -5, 6}, {7, 8, 9},
                                          {1, 2, 3},      {4, 5, 6},      {7, 8, 1e9f}};
  const examples::WrittenFile file("", "written_map.pfm");
  savePfm(file.path(), 3, 2, pixels);
  const Raster raster = loadRaster(file.path());
  CHECK(raster.width == 3);
  CHECK(raster.height == 2);
  CHECK((raster.pixels == pixels));
  std::filesystem::resize_file(file.path(), 40);
  CHECK_THROWS_WITH(loadRaster(file.path()), Catch::Contains("the file ends too early"));
}

}  // namespace
}  // namespace rays
