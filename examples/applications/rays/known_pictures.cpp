// SPDX-License-Identifier: MIT
#include "known_pictures.hpp"

#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "bvh_engine.hpp"
#include "scene_shapes.hpp"
#include "shapes.hpp"
#include "study.hpp"

namespace rays {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr float lampRadiance = 4.0f;
constexpr double albedo = 0.5;

sk::float3 grey(double x) {
  const auto f = static_cast<float>(x);
  return {f, f, f};
}

Material floorMaterial() { return {.name = "floor", .colour = grey(albedo)}; }

/// A camera that sees one point, under an angle that no lamp below stands in.
void look(Model& model, Vector from, Vector to) {
  model.camera = {.from = from, .to = to, .up = {0.1, 1, 0.2}, .fieldOfView = 0.0005, .focus = 1};
}

/// The floor y = 0 of this material, seen at the origin.
Model floorOf(const Material& material) {
  Model model;
  model.materials = {material,
                     {.name = "lamp", .colour = grey(0), .emission = grey(lampRadiance)},
                     {.name = "shade", .colour = grey(0)}};
  model.planes.push_back({{0, 1, 0}, 0.0f, 0});
  look(model, {0.5, 1, 0.3}, {0, 0, 0});
  return model;
}

void addPolygon(Model& model, const std::vector<Vector>& corners, std::int32_t material) {
  for (std::size_t i = 2; i < corners.size(); ++i)
    model.triangles.push_back({toFloat3(corners[0]), toFloat3(corners[i - 1]), toFloat3(corners[i]),
                               model.triangleCount++, material});
}

/// Irradiance at the origin of a floor with the normal y, from a polygon above it that emits radiance 1 (J. Lambert, "Photometria", 1760).
double polygonIrradiance(const std::vector<Vector>& corners) {
  double sum = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector a = normalized(corners[i]), b = normalized(corners[(i + 1) % corners.size()]);
    const Vector across = cross(a, b);
    sum += std::atan2(length(across), dot(a, b)) * normalized(across).y / 2;
  }
  return std::abs(sum);
}

KnownPicture polygonAbove(std::string name, const std::vector<Vector>& corners, bool bothSides = false) {
  KnownPicture picture{.name = std::move(name), .model = floorOf(floorMaterial())};
  picture.model.materials[1].glowsBehind = bothSides;
  addPolygon(picture.model, corners, 1);
  picture.radiance = albedo / pi * lampRadiance * polygonIrradiance(corners);
  return picture;
}

KnownPicture sphereAbove(std::string name, Vector centre, double radius, const Material& floor) {
  KnownPicture picture{.name = std::move(name), .model = floorOf(floor)};
  picture.model.spheres.push_back({toFloat3(centre), static_cast<float>(radius), 1});
  const double d = length(centre);
  picture.radiance = floor.scattering == Scattering::Diffuse
                         ? albedo * lampRadiance * radius * radius / (d * d) * centre.y / d
                         : unknown;
  return picture;
}

KnownPicture sunAbove() {
  KnownPicture picture{.name = "a sun's disc", .model = floorOf(floorMaterial())};
  const Vector towards = normalized(Vector{0, 1, 2});
  picture.model.suns.push_back({toFloat3(towards), grey(2), static_cast<float>(5 * pi / 180)});
  picture.radiance = albedo / pi * 2 * towards.y;
  return picture;
}

/// Rows of pixels that brighten towards the zenith, and one that is 30 times as bright.
KnownPicture skyAbove() {
  KnownPicture picture{.name = "a sky's image", .model = floorOf(floorMaterial())};
  Raster& image = picture.model.environment.image;
  image.width = 16;
  image.height = 8;
  picture.model.environment.colour = grey(1);
  double irradiance = 0.0;
  for (int y = 0; y < image.height; ++y) {
    const auto squareOfSine = [&](int row) { return std::pow(std::sin(pi * row / image.height), 2); };
    for (int x = 0; x < image.width; ++x) {
      const double radiance = x == 5 && y == 2 ? 9.0 : 0.1 * (image.height - y);
      image.pixels.push_back(grey(radiance));
      if (y < image.height / 2)
        irradiance += radiance * pi / image.width * (squareOfSine(y + 1) - squareOfSine(y));
    }
  }
  picture.radiance = albedo / pi * irradiance;
  return picture;
}

/// The light of all that is above, at once.
KnownPicture allAbove(const std::vector<KnownPicture>& parts) {
  KnownPicture picture{.name = "all of these", .model = floorOf(floorMaterial())};
  Model& model = picture.model;
  for (const KnownPicture& part : parts) {
    for (Triangle t : part.model.triangles) {
      t.id = model.triangleCount++;
      model.triangles.push_back(t);
    }
    model.spheres.insert(model.spheres.end(), part.model.spheres.begin(), part.model.spheres.end());
    model.suns.insert(model.suns.end(), part.model.suns.begin(), part.model.suns.end());
    picture.radiance += part.radiance;
  }
  return picture;
}

/// A lamp without extent in a sphere of radius 1: what its wall scatters shines on all of the wall alike (R. Ulbricht, 1900).
KnownPicture integratingSphere() {
  constexpr double reflectance = 0.7, intensity = 3.0;
  KnownPicture picture{.name = "an integrating sphere", .depth = 100};
  Model& model = picture.model;
  model.materials = {{.name = "wall", .colour = grey(reflectance)}};
  model.spheres.push_back({{0, 0, 0}, 1.0f, 0});
  const Vector lamp = {0.3, 0.2, 0}, seen = {0, 0, -1};
  model.points.push_back({toFloat3(lamp), grey(intensity)});
  look(model, {-0.2, 0.1, 0.4}, seen);
  const Vector way = lamp - seen;
  const double direct = intensity * way.z / std::pow(length(way), 3);
  const double others = reflectance / (1 - reflectance) * intensity;
  picture.radiance = reflectance / pi * (direct + others);
  return picture;
}

/// A box that emits radiance 1 inside: each segment of a path adds the albedo's next power.
KnownPicture furnace(int segment) {
  KnownPicture picture{.name = fmt::format("a furnace, segment {}", segment),
                       .model = modelOf(box()),
                       .radiance = std::pow(0.75, segment - 1),
                       .depth = segment,
                       .lastSegmentAlone = segment > 1};
  picture.model.materials = {
      {.name = "wall", .colour = grey(0.75), .emission = grey(1), .glowsBehind = true}};
  look(picture.model, {-0.2, 0.1, 0.3}, {0.5, 0.15, -0.1});
  return picture;
}

std::vector<float> greenOf(sk::Device& device, const KnownPicture& picture, const Effort& effort,
                           Strategy strategy, Sampling sampling, int depth) {
  const std::unique_ptr<Engine> engine = makeBvhEngine(device, picture.model, {});
  const std::unique_ptr<Renderer> renderer = engine->renderer({.width = effort.side,
                                                               .height = effort.side,
                                                               .depth = depth,
                                                               .sampling = sampling,
                                                               .strategy = strategy});
  for (int i = 0; i < effort.samples; ++i) renderer->pass(i);
  std::vector<float> green;
  for (const sk::float3& p : renderer->image()) green.push_back(p.y);
  return green;
}

}  // namespace

std::vector<KnownPicture> knownPictures() {
  const std::vector<Vector> square = {{-0.4, 1, -0.4}, {0.4, 1, -0.4}, {0.4, 1, 0.4}, {-0.4, 1, 0.4}};
  const std::vector<Vector> tilted = {{-1, 0.3, 0.5}, {-1.2, 1.5, 0.2}, {-0.6, 1.4, -0.9}};
  std::vector<KnownPicture> all;
  all.push_back(polygonAbove("a square of light above", square));
  all.push_back(
      polygonAbove("a triangle of light, aside, of two sides", {tilted[0], tilted[2], tilted[1]}, true));
  all.push_back(sphereAbove("a sphere of light", {1.1, 1, -0.9}, 0.3, floorMaterial()));
  all.push_back(sphereAbove("a small sphere, low", {-2, 0.4, 1}, 0.2, floorMaterial()));
  all.push_back(sunAbove());
  all.push_back(allAbove({all[0], all[2], all[3], all[4]}));
  all.push_back(skyAbove());
  const Material metal = {
      .name = "metal", .scattering = Scattering::Metal, .colour = grey(0.9), .roughness = 0.3f};
  const Material frosted = {
      .name = "frosted", .scattering = Scattering::Frosted, .colour = grey(1), .roughness = 0.4f};
  all.push_back(sphereAbove("a sphere of light over rough metal", {-0.6, 1.2, -0.5}, 0.4, metal));
  all.push_back(sphereAbove("the same over frosted glass", {-0.6, 1.2, -0.5}, 0.4, frosted));
  // What passes through the glass, into it and out of it.
  all.push_back(sphereAbove("the same below frosted glass", {-0.4, -1.2, -0.3}, 0.5, frosted));
  all.push_back(sphereAbove("the same seen from within the glass", {-0.5, 1, -0.4}, 0.5, frosted));
  look(all.back().model, {0.3, -1, 0.2}, {0, 0, 0});
  all.push_back(integratingSphere());
  for (int segment = 1; segment <= 6; ++segment) all.push_back(furnace(segment));
  for (KnownPicture& picture : all) chooseUnit(picture.model);
  return all;
}

Estimate estimate(sk::Device& device, const KnownPicture& picture, const Effort& effort, Strategy strategy,
                  Sampling sampling) {
  std::vector<float> green = greenOf(device, picture, effort, strategy, sampling, picture.depth);
  if (picture.lastSegmentAlone) {
    const std::vector<float> before = greenOf(device, picture, effort, strategy, sampling, picture.depth - 1);
    for (std::size_t i = 0; i < green.size(); ++i) green[i] -= before[i];
  }
  const auto n = static_cast<double>(green.size());
  Estimate e;
  for (const float g : green) e.mean += g / n;
  for (const float g : green) e.error += (g - e.mean) * (g - e.mean);
  e.error = std::sqrt(e.error / (n * (n - 1)));
  return e;
}

std::vector<double> rootMeanSquares(sk::Device& device, const KnownPicture& picture, int side,
                                    const std::vector<int>& samples, Strategy strategy, Sampling sampling) {
  const std::unique_ptr<Engine> engine = makeBvhEngine(device, picture.model, {});
  const std::unique_ptr<Renderer> renderer = engine->renderer(
      {.width = side, .height = side, .depth = picture.depth, .sampling = sampling, .strategy = strategy});
  std::vector<double> errors;
  int done = 0;
  for (const int count : samples) {
    for (; done < count; ++done) renderer->pass(done);
    double squares = 0.0;
    for (const sk::float3& p : renderer->image())
      squares += (p.y - picture.radiance) * (p.y - picture.radiance);
    errors.push_back(std::sqrt(squares / (double(side) * side)));
  }
  return errors;
}

double deviation(const Estimate& e, double known) {
  return std::abs(e.mean - known) / std::hypot(e.error, 0x1p-20 * known);
}

}  // namespace rays
