// SPDX-License-Identifier: MIT
//
// Every sampler against the density that it says it has: lobes of materials, lights, the sky, the lens, the numbers themselves.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "chi_square_test.hpp"
#include "device_scene.hpp"
#include "light_table.hpp"
#include "microfacets.hpp"
#include "path_tables.hpp"
#include "sampler_test.sk.hpp"

namespace rays {
namespace {

using examples::vecOf;

constexpr double pi = std::numbers::pi;
/// Chi square is farther from its mean by chance once in 30,000 times; the numbers are fixed.
constexpr double bound = 4.0;
constexpr int manySamples = 1 << 17;

enum Kind : int { Diffuse, Mirror, Glass, Metal, Frosted };

struct Lobe {
  Kind kind;
  float eta;
  float alpha;
  double cosine;  ///< of the viewer
};

sk::float3 viewerOf(double cosine) {
  const double sine = std::sqrt(1 - cosine * cosine);
  return {float(sine * 0.8), float(sine * 0.6), float(cosine)};
}

Vector vectorOf(const sk::float4& v) { return {v.x, v.y, v.z}; }

/// Bins of equal solid angle: cosines by longitudes.
struct SphereBins {
  static constexpr int side = 16;

  /// In the unit square.
  static sk::double2 place(const Vector& d) { return {(d.z + 1) / 2, std::atan2(d.y, d.x) / (2 * pi) + 0.5}; }
  static Vector direction(double x, double y) {
    const double z = 2 * x - 1, r = std::sqrt(1 - z * z), angle = 2 * pi * (y - 0.5);
    return {r * std::cos(angle), r * std::sin(angle), z};
  }
};

/// The integral of a lobe's density over each bin, by midpoints; `f` gets the whole integral of what is scattered.
std::vector<double> sharesOf(sk::Device& device, const Lobe& lobe, double& f) {
  constexpr int within = 32, row = SphereBins::side * within;
  std::vector<sk::float3> directions;
  for (int y = 0; y < row; ++y)
    for (int x = 0; x < row; ++x)
      directions.push_back(toFloat3(SphereBins::direction((x + 0.5) / row, (y + 0.5) / row)));
  const auto count = static_cast<std::int64_t>(directions.size());
  sk::Stream<sk::float3> at = device.stream<sk::float3>({count});
  at.write(directions);
  sk::Stream<float> density = device.stream<float>({count}), scattered = device.stream<float>({count});
  kernels::densityOf(lobe.kind, lobe.eta, lobe.alpha, viewerOf(lobe.cosine), at, density, scattered);
  const std::vector<float> densities = density.read(), values = scattered.read();
  const double part = 4 * pi / double(count);
  std::vector<double> shares(SphereBins::side * SphereBins::side);
  f = 0.0;
  for (int y = 0; y < row; ++y) {
    for (int x = 0; x < row; ++x) {
      const auto i = static_cast<std::size_t>(y * row + x);
      shares[static_cast<std::size_t>(y / within * SphereBins::side + x / within)] += part * densities[i];
      f += part * values[i];
    }
  }
  return shares;
}

TEST_CASE("directions that materials scatter have the density that they say") {
  sk::Device device = sk::Device::native();
  sk::Stream<sk::float4> directions = device.stream<sk::float4>({manySamples}),
                         weights = device.stream<sk::float4>({manySamples});
  for (const Lobe& lobe :
       {Lobe{Diffuse, 1.5f, 1, 0.6}, Lobe{Metal, 1.5f, 0.25f, 0.95}, Lobe{Metal, 1.5f, 0.6f, 0.2},
        Lobe{Metal, 1.5f, 1.0f, 0.7}, Lobe{Frosted, 1.5f, 0.3f, 0.8}, Lobe{Frosted, 1.5f, 0.7f, 0.3},
        Lobe{Frosted, 1 / 1.5f, 0.3f, 0.85}, Lobe{Frosted, 1 / 1.5f, 0.6f, 0.5}}) {
    INFO("kind " << lobe.kind << ", eta " << lobe.eta << ", roughness " << lobe.alpha << ", cosine "
                 << lobe.cosine);
    double f = 0.0;
    const std::vector<double> shares = sharesOf(device, lobe, f);
    kernels::scatterMany(lobe.kind, lobe.eta, lobe.alpha, viewerOf(lobe.cosine), 11u,
                         sk::iter(0, manySamples), directions, weights);
    SquareBins bins(SphereBins::side);
    std::vector<double> counts(shares.size() + 1);
    double weight = 0.0;
    const std::vector<sk::float4> d = directions.read(), w = weights.read();
    for (std::size_t i = 0; i < d.size(); ++i) {
      weight += double(w[i].y) / manySamples;
      if (d[i].w > 0) {
        const sk::double2 at = SphereBins::place(vectorOf(d[i]));
        bins.add(at.x, at.y);
      } else {
        counts.back() += 1;
      }
    }
    std::copy(bins.counts().begin(), bins.counts().end(), counts.begin());
    std::vector<double> expected = shares;
    // What would go to the wrong side of the surface is lost.
    const double kept = std::accumulate(shares.begin(), shares.end(), 0.0);
    CHECK(kept < 1.002);
    expected.push_back(std::max(1 - kept, 0.0));
    CHECK(chiSquareDeviation(counts, expected) < bound);
    // The mean of f / density is the integral of f.
    CHECK(weight == Approx(f).epsilon(0.01));
  }
}

constexpr double fitted = 0.0025;  ///< bound of the fit in scattering.sk, of 1 / albedo

TEST_CASE("facets of metals make up for what they lose, as well as the fit says") {
  sk::Device device = sk::Device::native();
  std::vector<double> cosines;
  for (double c = 1e-3; c < 1; c *= 1.45) cosines.push_back(c);
  for (const double c : {0.85, 0.95, 0.99, 1.0}) cosines.push_back(c);
  std::vector<sk::float3> directions;
  for (const double c : cosines) directions.push_back(viewerOf(c));
  const sk::Stream<sk::float3> viewers = streamOf(device, directions);
  sk::Stream<float> factors = device.stream<float>({static_cast<std::int64_t>(cosines.size())});
  for (const double alpha : {0.001, 0.01, 0.04, 0.1, 0.17, 0.25, 0.36, 0.5, 0.64, 0.78, 0.9, 1.0}) {
    kernels::compensationOf(float(alpha), viewers, factors);
    const std::vector<float> factor = factors.read();
    for (std::size_t i = 0; i < cosines.size(); ++i) {
      INFO("roughness " << alpha << ", cosine " << cosines[i]);
      // The quadrature is within 1e-4 itself.
      CHECK(std::abs(factor[i] * reflectedOnce(cosines[i], alpha) - 1) < fitted + 1e-4);
      CHECK(factor[i] >= 1);
      // Where the surface is smooth nothing is lost, and nothing changes.
      if (alpha == 0.001 && cosines[i] > 0.2) CHECK(factor[i] < 1 + 2e-5);
    }
  }
}

TEST_CASE("rough metals that absorb nothing scatter all light, and coloured ones what is left of it") {
  sk::Device device = sk::Device::native();
  sk::Stream<sk::float4> directions = device.stream<sk::float4>({manySamples}),
                         weights = device.stream<sk::float4>({manySamples});
  // Beside the fit, four standard errors, of which one mean in 16,000 is farther by chance.
  const auto check = [](double sum, double squares, double expected) {
    const double mean = sum / manySamples;
    const double error = std::sqrt(std::max(squares / manySamples - mean * mean, 0.0) / manySamples);
    CHECK(std::abs(mean - expected) <= fitted * expected + 4 * error);
  };
  for (const double alpha : {0.001, 0.05, 0.15, 0.3, 0.5, 0.75, 1.0}) {
    for (const double cosine : {1.0, 0.8, 0.5, 0.2, 0.05}) {
      INFO("roughness " << alpha << ", cosine " << cosine);
      kernels::scatterMany(Metal, 1.5f, float(alpha), viewerOf(cosine), 17u, sk::iter(0, manySamples),
                           directions, weights);
      double white = 0.0, whites = 0.0, half = 0.0, halves = 0.0;
      for (const sk::float4& w : weights.read()) {
        white += w.y;
        whites += double(w.y) * w.y;
        half += w.z;
        halves += double(w.z) * w.z;
      }
      check(white, whites, 1.0);
      check(half, halves, reflectedInAll(cosine, alpha, 0.5));
    }
  }
  // What is made up for is not small: facets of roughness 1 reflect this part once.
  CHECK(reflectedOnce(1.0, 1.0) == Approx(1 - std::numbers::ln2).epsilon(1e-3));
}

TEST_CASE("glass reflects the part that Fresnel's formulas have, and mirrors all") {
  sk::Device device = sk::Device::native();
  sk::Stream<sk::float4> directions = device.stream<sk::float4>({manySamples}),
                         weights = device.stream<sk::float4>({manySamples});
  for (const double cosine : {1.0, 0.6, 0.1}) {
    for (const double eta : {1.5, 1 / 1.5}) {
      INFO("cosine " << cosine << ", eta " << eta);
      kernels::scatterMany(Glass, float(eta), 0.0f, viewerOf(cosine), 5u, sk::iter(0, manySamples),
                           directions, weights);
      double passed = 0.0;
      const std::vector<sk::float4> d = directions.read(), w = weights.read();
      const double sine = std::sqrt(1 - cosine * cosine);
      for (std::size_t i = 0; i < d.size(); ++i) {
        passed += w[i].w;
        // Snell's law.
        const double expected = w[i].w > 0 ? sine / eta : sine;
        REQUIRE(std::hypot(d[i].x, d[i].y) == Approx(expected).margin(1e-6));
        REQUIRE((d[i].z < 0) == (w[i].w > 0));
      }
      double reflected = 1.0;
      if (sine < eta) {
        const double t = std::sqrt(1 - sine * sine / (eta * eta));
        const double across = (cosine - eta * t) / (cosine + eta * t),
                     along = (eta * cosine - t) / (eta * cosine + t);
        reflected = (across * across + along * along) / 2;
      }
      const double spread = std::sqrt(reflected * (1 - reflected) * manySamples);
      CHECK(std::abs(passed - (1 - reflected) * manySamples) <= bound * spread + 1e-3);
    }
  }
  kernels::scatterMany(Mirror, 1.5f, 0.0f, viewerOf(0.3), 5u, sk::iter(0, manySamples), directions, weights);
  const sk::float4 d = directions.read()[77];
  CHECK((d.x == -viewerOf(0.3).x && d.y == -viewerOf(0.3).y && d.z == viewerOf(0.3).z && d.w == 0));
}

struct LightSamples {
  std::vector<sk::float4> directions;
  std::vector<sk::float3> targets;
};

LightSamples samplesOf(sk::Device& device, const Model& model, sk::float3 from) {
  const LightTable table = lightTable(model);
  sk::Stream<sk::float4> lights = streamOf(device, table.lights), sky = streamOf(device, table.sky);
  sk::Stream<sk::float4> directions = device.stream<sk::float4>({manySamples});
  sk::Stream<sk::float3> targets = device.stream<sk::float3>({manySamples});
  kernels::lightMany(
      from,
      {.rows = lights,
       .count = table.count,
       .sky = {.image = sky,
               .size = sk::int2{model.environment.image.width, model.environment.image.height}}},
      3u, sk::iter(0, manySamples), directions, targets);
  return {directions.read(), targets.read()};
}

Model lampModel(bool bothSides = false) {
  Model model;
  model.materials = {{.name = "lamp", .emission = {1, 1, 1}, .glowsBehind = bothSides}};
  return model;
}

TEST_CASE("points on a triangle of light are uniform, and their density is per solid angle") {
  sk::Device device = sk::Device::native();
  for (const bool bothSides : {false, true}) {
    Model model = lampModel(bothSides);
    model.triangles = {{{-0.5f, 1, -0.25f}, {0.5f, 1.25f, -0.5f}, {0.25f, 0.75f, 0.75f}, 0, 0}};
    const sk::float3 from = {0.25f, bothSides ? 3.0f : -0.5f, 0.125f};
    const LightSamples s = samplesOf(device, model, from);
    const auto a = vecOf<double>(model.triangles[0].a), b = vecOf<double>(model.triangles[0].b) - a,
               c = vecOf<double>(model.triangles[0].c) - a;
    const Vector n = cross(b, c);
    SquareBins bins(16);
    double worst = 0.0;
    for (std::size_t i = 0; i < s.targets.size(); ++i) {
      const Vector p = vecOf<double>(s.targets[i]) - a;
      const double v = dot(cross(p, c), n) / dot(n, n), w = dot(cross(b, p), n) / dot(n, n);
      bins.add((v + w) * (v + w), w / (v + w));
      const Vector way = vecOf<double>(s.targets[i]) - vecOf<double>(from);
      const double d = length(way), density = d * d * d / std::abs(dot(way, n)) * 2;
      worst = std::max(worst, std::abs(s.directions[i].w / density - 1));
      worst = std::max(worst, length(vectorOf(s.directions[i]) - (1 / d) * way));
    }
    CHECK(bins.deviationFromUniform() < bound);
    CHECK(worst < 1e-5);
  }
}

/// Places in a cone in the unit square, by equal solid angles.
sk::double2 placeInCone(const Vector& direction, const Vector& axis, double oneMinusCosine) {
  const Vector x = normalized(cross(axis, Vector{0.3, -0.5, 0.8})), y = cross(axis, x);
  const Vector aside = direction - axis;
  return {dot(aside, aside) / 2 / oneMinusCosine,
          std::atan2(dot(direction, y), dot(direction, x)) / (2 * pi) + 0.5};
}

TEST_CASE("directions to spheres and suns are uniform in their cones") {
  sk::Device device = sk::Device::native();
  Model sphere = lampModel(), sun;
  sphere.spheres = {{{0.5f, 0.25f, -1}, 0.5f, 0}};
  const Vector towards = normalized(Vector{0.2, 0.9, 0.3});
  sun.suns = {{toFloat3(towards), {1, 1, 1}, 0.05f}};
  const sk::float3 from = {-0.5f, -0.25f, 0.25f};
  const Vector way = vecOf<double>(sphere.spheres[0].centre) - vecOf<double>(from);
  const double sine = 0.5 / length(way);
  const double ofSphere = 1 - std::sqrt(1 - sine * sine), ofSun = 2 * std::pow(std::sin(0.05f / 2.0), 2);
  for (const bool isSun : {false, true}) {
    const LightSamples s = samplesOf(device, isSun ? sun : sphere, from);
    SquareBins bins(16);
    double worst = 0.0;
    for (std::size_t i = 0; i < s.directions.size(); ++i) {
      const sk::double2 at = isSun ? placeInCone(vectorOf(s.directions[i]), towards, ofSun)
                                   : placeInCone(vectorOf(s.directions[i]), normalized(way), ofSphere);
      worst =
          std::max({worst, at.x - 1, std::abs(s.directions[i].w * 2 * pi * (isSun ? ofSun : ofSphere) - 1)});
      bins.add(at.x, at.y);
      if (isSun) continue;
      // The point is on the near side of the sphere.
      const Vector p = vecOf<double>(s.targets[i]) - vecOf<double>(sphere.spheres[0].centre);
      worst = std::max({worst, std::abs(length(p) / 0.5 - 1), dot(p, vectorOf(s.directions[i])) - 1e-3});
    }
    CHECK(bins.deviationFromUniform() < bound);
    CHECK(worst < 1e-4);
  }
}

TEST_CASE("lights are chosen by their power") {
  sk::Device device = sk::Device::native();
  Model model = lampModel();
  // Powers 1 : 4 : 16 : 9, and a point of light.
  model.spheres = {
      {{1, 0, 0}, 0.0625f, 0}, {{0, 1, 0}, 0.125f, 0}, {{0, 0, 1}, 0.25f, 0}, {{-1, 0, 0}, 0.1875f, 0}};
  model.points = {{{0, -1, 0}, {0.1f, 0.1f, 0.1f}}};
  const double unit = 4 * pi * pi * 0.0625 * 0.0625;
  std::vector<double> powers = {unit, 4 * unit, 16 * unit, 9 * unit, 4 * pi * double(0.1f)};
  const double all = std::accumulate(powers.begin(), powers.end(), 0.0);
  for (double& p : powers) p /= all;
  std::vector<double> counts(5);
  for (const sk::float4& d : samplesOf(device, model, {0, 0, 0}).directions)
    ++counts[d.x > 0.8 ? 0 : d.y > 0.8 ? 1 : d.z > 0.8 ? 2 : d.x < -0.8 ? 3 : 4];
  CHECK(chiSquareDeviation(counts, powers) < bound);
}

TEST_CASE("a sky's image is sampled in proportion to its pixels, which are uniform") {
  sk::Device device = sk::Device::native();
  Model model;
  Raster& image = model.environment.image;
  image = {16, 8, {}};
  for (int i = 0; i < 16 * 8; ++i) {
    const float light = i == 37 ? 40.0f : i % 11 == 3 ? 0.0f : 0.5f + float(i % 5);
    image.pixels.push_back({light, light, light});
  }
  model.environment.colour = {1, 1, 1};
  std::vector<double> expected;
  for (int i = 0; i < 16 * 8; ++i)
    expected.push_back(image.pixels[std::size_t(i)].y * std::sin(pi * (i / 16 + 0.5) / 8));
  const double sum = std::accumulate(expected.begin(), expected.end(), 0.0);
  for (double& e : expected) e /= sum;

  const LightSamples s = samplesOf(device, model, {0, 0, 0});
  std::vector<double> counts(expected.size());
  SquareBins within(8);
  double worst = 0.0;
  std::vector<sk::float3> directions;
  for (const sk::float4& d : s.directions) {
    const double x = 16 * (std::atan2(d.z, d.x) / (2 * pi) + 0.5), sine = std::hypot(d.x, d.z),
                 y = 8 * std::atan2(sine, d.y) / pi;
    const auto pixel = static_cast<std::size_t>(std::min(int(y), 7) * 16 + std::min(int(x), 15));
    ++counts[pixel];
    within.add(x - std::floor(x), y - std::floor(y));
    const double density = expected[pixel] / (2 * pi / 16 * pi / 8) / sine;
    // Next to a border another pixel may be meant.
    const double border =
        std::min({x - std::floor(x), std::ceil(x) - x, y - std::floor(y), std::ceil(y) - y});
    if (border > 1e-3) worst = std::max(worst, std::abs(d.w / density - 1));
    directions.push_back({d.x, d.y, d.z});
  }
  CHECK(chiSquareDeviation(counts, expected) < bound);
  CHECK(within.deviationFromUniform() < bound);
  CHECK(worst < 1e-3);

  // skyRadiance returns the same density for a ray that meets the sky by chance.
  const LightTable table = lightTable(model);
  sk::Stream<sk::float4> sky = streamOf(device, table.sky);
  sk::Stream<sk::float3> at = streamOf(device, directions);
  sk::Stream<float> density = device.stream<float>({manySamples});
  kernels::skyDensityOf(
      {.colour = sk::float3{1, 1, 1}, .image = sky, .size = sk::int2{16, 8}, .choice = 1.0f}, at, density);
  const std::vector<float> met = density.read();
  std::size_t differ = 0;
  for (std::size_t i = 0; i < met.size(); ++i) differ += std::abs(met[i] / s.directions[i].w - 1) > 1e-3;
  CHECK(differ < met.size() / 1000);
}

TEST_CASE("rays of a lens begin anywhere on it, and meet in focus") {
  sk::Device device = sk::Device::native();
  Model model;
  model.camera = {.from = {0, 0, 2}, .to = {0, 0, 0}, .fieldOfView = 40, .lens = 0.25, .focus = 1.5};
  const PathTables tables(device, model, {.width = 4, .height = 4});
  sk::Stream<sk::float3> origins = device.stream<sk::float3>({manySamples}),
                         directions = device.stream<sk::float3>({manySamples});
  kernels::cameraMany(tables.view, 9u, sk::iter(0, manySamples), origins, directions);
  const std::vector<sk::float3> from = origins.read(), along = directions.read();
  SquareBins lens(16), pixel(16);
  const double half = std::tan(20 * pi / 180);
  for (std::size_t i = 0; i < from.size(); ++i) {
    const double x = from[i].x / 0.25, y = from[i].y / 0.25;
    REQUIRE(std::hypot(x, y) <= 1.000001);
    lens.add(x * x + y * y, std::atan2(y, x) / (2 * pi) + 0.5);
    // Where the ray is at the distance of the focus, as pixels of a pinhole.
    const double t = 1.5 / -double(along[i].z);
    const double px = (from[i].x + t * along[i].x) / 1.5 / half,
                 py = (from[i].y + t * along[i].y) / 1.5 / half;
    const double u = (px + 1) * 2 - 1, v = (1 - py) * 2 - 2;
    REQUIRE((u > -1e-4 && u < 1.0001 && v > -1e-4 && v < 1.0001));
    pixel.add(u, v);
  }
  CHECK(lens.deviationFromUniform() < bound);
  CHECK(pixel.deviationFromUniform() < bound);
}

enum Numbers : unsigned { Random, Sobol };

std::vector<sk::float4> numbersOf(sk::Device& device, unsigned sampling, int sample, int dimension,
                                  int count) {
  sk::Stream<sk::float4> numbers = device.stream<sk::float4>({count});
  kernels::numbersOf(sampling, sample, dimension, 1u, sk::iter(0, count), numbers);
  return numbers.read();
}

TEST_CASE("numbers of different pixels are uniform and independent, in all pairs of dimensions") {
  sk::Device device = sk::Device::native();
  for (const unsigned sampling : {Random, Sobol}) {
    for (const int sample : {0, 5}) {
      INFO("sampling " << sampling << ", sample " << sample);
      const std::vector<sk::float4> first = numbersOf(device, sampling, sample, 0, 1 << 16),
                                    second = numbersOf(device, sampling, sample, 1, 1 << 16),
                                    later = numbersOf(device, sampling, sample + 1, 0, 1 << 16);
      SquareBins xy(32), zw(32), xz(32), yw(32), next(32), pixels(32), samples(32);
      for (std::size_t i = 0; i < first.size(); ++i) {
        const sk::float4& u = first[i];
        xy.add(u.x, u.y);
        zw.add(u.z, u.w);
        xz.add(u.x, u.z);
        yw.add(u.y, u.w);
        next.add(u.x, second[i].x);
        if (i % 2 == 0) pixels.add(u.x, first[i + 1].x);
        samples.add(u.y, later[i].w);
      }
      for (const SquareBins* bins : {&xy, &zw, &xz, &yw, &next, &pixels, &samples})
        CHECK(bins->deviationFromUniform() < bound);
    }
  }
}

TEST_CASE("Sobol's numbers of a pixel are nets: each elementary interval has its point") {
  sk::Device device = sk::Device::native();
  constexpr int power = 6, count = 1 << power, pixels = 16;
  std::vector<std::vector<sk::float4>> samples;
  for (int i = 0; i < count; ++i) samples.push_back(numbersOf(device, Sobol, i, 2, pixels));
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
    for (int wide = 0; wide <= power; ++wide) {
      const double columns = 1 << wide, rows = 1 << (power - wide);
      std::vector<int> first(count), second(count);
      for (const std::vector<sk::float4>& s : samples) {
        const sk::float4& u = s[pixel];
        ++first[static_cast<std::size_t>(std::floor(u.y * rows) * columns + std::floor(u.x * columns))];
        ++second[static_cast<std::size_t>(std::floor(u.w * rows) * columns + std::floor(u.z * columns))];
      }
      REQUIRE(first == std::vector<int>(count, 1));
      REQUIRE(second == std::vector<int>(count, 1));
    }
  }
}

}  // namespace
}  // namespace rays
