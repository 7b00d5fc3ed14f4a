// SPDX-License-Identifier: MIT
#include "light_table.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "bvh.hpp"

namespace rays {
namespace {

constexpr double pi = std::numbers::pi;

/// In the order of lights.sk.
enum class LightKind : std::uint8_t { Triangle, Sphere, Point, Sun, Sky, BothSides };

struct Light {
  LightKind kind = LightKind::Triangle;
  sk::float3 a{}, b{}, c{};
  sk::float3 emission{};
  double power = 0.0;
};

/// Per area of a surface that emits radiance 1.
double exitance(const Material& m) { return (m.glowsBehind ? 2 : 1) * pi; }

double luminance(const sk::float3& c) { return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z; }

double areaOf(const Triangle& t) {
  const auto a = examples::vecOf<double>(t.a);
  return 0.5 * length(cross(examples::vecOf<double>(t.b) - a, examples::vecOf<double>(t.c) - a));
}

/// Returns the radius of a sphere around the origin that contains the scene. Distant lights shine on its disc.
double sceneRadius(const Model& model) {
  double most = 0.0;
  const auto grow = [&](const sk::float3& p, double r) {
    most = std::max(most, length(examples::vecOf<double>(p)) + r);
  };
  for (const Triangle& t : model.triangles)
    for (const sk::float3* p : {&t.a, &t.b, &t.c}) grow(*p, 0.0);
  for (const Sphere& s : model.spheres) grow(s.centre, s.radius);
  return most > 0.0 ? most : 1.0;
}

sk::float4 joined(const sk::float3& v, double w) { return {v.x, v.y, v.z, static_cast<float>(w)}; }

/// Gives the power of the image on the scene.
double addSky(const Model& model, double radius, LightTable& table) {
  const Raster& image = model.environment.image;
  if (image.pixels.empty()) return 0.0;
  std::vector<double> weights;
  double sum = 0.0;
  for (int y = 0; y < image.height; ++y) {
    const double sine = std::sin(pi * (y + 0.5) / image.height);
    for (int x = 0; x < image.width; ++x) {
      const sk::float3& p = image.pixels[std::size_t(y) * std::size_t(image.width) + std::size_t(x)];
      weights.push_back(std::max(0.0, luminance(p) * luminance(model.environment.colour)) * sine);
      sum += weights.back();
    }
  }
  if (!(sum > 0)) return 0.0;
  const std::vector<AliasEntry> aliases = aliasTable(weights);
  const double pixelArea = 2 * pi / image.width * pi / image.height;  // of latitude and longitude
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const sk::float3& p = image.pixels[i];
    const sk::float3& by = model.environment.colour;
    table.sky.push_back(
        {static_cast<float>(aliases[i].stays), packedInt(static_cast<std::int64_t>(aliases[i].alias)), 0, 0});
    table.sky.push_back(joined({p.x * by.x, p.y * by.y, p.z * by.z}, weights[i] / sum / pixelArea));
  }
  return sum * pixelArea * pi * radius * radius;
}

std::vector<Light> lightsOf(const Model& model, double radius) {
  std::vector<Light> lights;
  for (const Sun& sun : model.suns) {
    const double oneMinusCosine = 2 * std::pow(std::sin(sun.angle / 2), 2);
    Light light{LightKind::Sun, sun.towards, {static_cast<float>(oneMinusCosine), 0, 0}, {},
                sun.irradiance, 0.0};
    light.power = luminance(sun.irradiance) * pi * radius * radius;
    if (oneMinusCosine > 0) {
      // The irradiance of a disc of radiance 1 is pi times the square of its sine.
      const auto radiance = static_cast<float>(1 / (pi * std::pow(std::sin(sun.angle), 2)));
      light.emission = {sun.irradiance.x * radiance, sun.irradiance.y * radiance,
                        sun.irradiance.z * radiance};
    }
    lights.push_back(light);
  }
  for (const Triangle& t : model.triangles) {
    const Material& m = model.materials[static_cast<std::size_t>(t.material)];
    const LightKind kind = m.glowsBehind ? LightKind::BothSides : LightKind::Triangle;
    if (m.emits())
      lights.push_back({kind, t.a, t.b, t.c, m.emission, exitance(m) * areaOf(t) * luminance(m.emission)});
  }
  for (const Sphere& s : model.spheres) {
    const Material& m = model.materials[static_cast<std::size_t>(s.material)];
    const double area = 4 * pi * double(s.radius) * s.radius;
    if (m.emits()) {
      lights.push_back({LightKind::Sphere,
                        s.centre,
                        {s.radius, 0, 0},
                        {},
                        m.emission,
                        exitance(m) * area * luminance(m.emission)});
    }
  }
  for (const PointLight& p : model.points)
    lights.push_back({LightKind::Point, p.position, {}, {}, p.intensity, 4 * pi * luminance(p.intensity)});
  return lights;
}

}  // namespace

std::vector<AliasEntry> aliasTable(std::span<const double> weights) {
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  std::vector<AliasEntry> table(weights.size());
  std::vector<double> scaled;
  std::vector<std::size_t> small, large;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    scaled.push_back(weights[i] / sum * static_cast<double>(weights.size()));
    table[i].alias = i;
    (scaled.back() < 1 ? small : large).push_back(i);
  }
  while (!small.empty() && !large.empty()) {
    const std::size_t s = small.back(), l = large.back();
    small.pop_back();
    table[s] = {scaled[s], l};
    scaled[l] -= 1 - scaled[s];
    if (scaled[l] >= 1) continue;
    large.pop_back();
    small.push_back(l);
  }
  return table;
}

LightTable lightTable(const Model& model) {
  LightTable table;
  const double radius = sceneRadius(model);
  std::vector<Light> lights = lightsOf(model, radius);
  if (const double power = addSky(model, radius, table); power > 0)
    lights.push_back({LightKind::Sky, {}, {}, {}, {}, power});
  std::vector<double> powers;
  for (const Light& light : lights) powers.push_back(light.power);
  const double total = std::accumulate(powers.begin(), powers.end(), 0.0);
  table.shares.assign(model.materials.size(), 0.0);
  if (!(total > 0)) return table;

  const std::vector<AliasEntry> aliases = aliasTable(powers);
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const Light& light = lights[i];
    table.lights.push_back(joined(light.a, packedInt(static_cast<std::int64_t>(light.kind))));
    table.lights.push_back(joined(light.b, packedInt(static_cast<std::int64_t>(aliases[i].alias))));
    table.lights.push_back(joined(light.c, aliases[i].stays));
    table.lights.push_back(joined(light.emission, light.power / total));
    if (light.kind == LightKind::Sky) table.skyChoice = light.power / total;
  }
  table.count = static_cast<int>(lights.size());
  for (std::size_t m = 0; m < model.materials.size(); ++m)
    table.shares[m] = exitance(model.materials[m]) * luminance(model.materials[m].emission) / total;
  return table;
}

bool hasLight(const Model& model) {
  return lightTable(model).count > 0 || luminance(model.environment.colour) > 0;
}

}  // namespace rays
