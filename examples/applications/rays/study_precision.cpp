// SPDX-License-Identifier: MIT
//
// The test of triangles in halves, floats and doubles, with vertices stored in halves and in floats: hits, leaks, distances, time.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <string_view>

#include <fmt/format.h>

#include "device_scene.hpp"
#include "precision.sk.hpp"
#include "reference.hpp"
#include "shapes.hpp"
#include "study.hpp"
#include "support/table.hpp"

namespace rays {
namespace {

struct Found {
  std::vector<sk::float3> hits;
  std::vector<int> ids;
  double nanoseconds = 0.0;  ///< of a ray and a triangle
};

std::vector<sk::float3> verticesOf(const Model& model) {
  std::vector<sk::float3> vertices;
  for (const Triangle& t : model.triangles) vertices.insert(vertices.end(), {t.a, t.b, t.c});
  return vertices;
}

Found trace(sk::Device& device, const Model& model, const std::vector<Ray>& rays, HowToIntersect how,
            sk::Precision precision, sk::Storage storage) {
  const auto n = static_cast<std::int64_t>(rays.size());
  std::vector<sk::float3> origins, directions;
  for (const Ray& r : rays) {
    origins.push_back(r.origin);
    directions.push_back(r.direction);
  }
  const std::vector<sk::float3> corners = verticesOf(model);
  auto vertices = device.stream<sk::float3>({static_cast<std::int64_t>(corners.size())}, storage);
  vertices.write(corners);
  auto from = device.stream<sk::float3>({n}), along = device.stream<sk::float3>({n}),
       hit = device.stream<sk::float3>({n});
  from.write(origins);
  along.write(directions);
  auto id = device.stream<int>({n});
  const bool isNative = device.name().starts_with("native");
  const double milliseconds = bestMilliseconds(device, 3, [&] {
    kernels::closestOfAll.with({.precision = precision})(static_cast<unsigned>(how), !isNative,
                                                         static_cast<int>(model.triangles.size()), vertices,
                                                         from, along, hit, id);
  });
  return {hit.read(), id.read(), 1e6 * milliseconds / (double(n) * double(model.triangles.size()))};
}

/// From inside of a ball, anywhere.
std::vector<Ray> raysInside(std::size_t count) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < count; ++i) {
    const Vector from = 0.1 * Vector{normal(random), normal(random), normal(random)};
    rays.push_back(
        {.origin = toFloat3(from),
         .direction = toFloat3(normalized(Vector{normal(random), normal(random), normal(random)}))});
  }
  return rays;
}

/// By loops in double precision.
Hit nearest(const Model& model, const Ray& ray) {
  Hit best;
  double inside = 0.0;
  for (const Triangle& t : model.triangles) {
    const Meeting meeting = meet(t, ray);
    if (!(meeting.t > 0) || meeting.inside <= inside) continue;
    inside = meeting.inside;
    best = {t.id, static_cast<float>(meeting.t), 0, 0};
  }
  return best;
}

/// Between floats as large as the expected one.
double unitsOff(float got, float expected) {
  const double unit = std::ldexp(1.0, std::ilogb(expected) - 23);
  return std::abs(double(got) - expected) / unit;
}

}  // namespace

Findings studyPrecision(sk::Device& device, bool isSmall) {
  const Model model = modelOf(icosphere(2, false));
  const std::vector<Ray> inside = raysInside(isSmall ? 1000 : 50'000),
                         edges = raysToEdges(model, {}, isSmall ? 1000 : 50'000, 5);
  std::vector<Hit> expected;
  for (const Ray& ray : inside) expected.push_back(nearest(model, ray));
  examples::Table table({"test", "computed in", "vertices in", "wrong ids of a million", "leaks of a million",
                         "error of t in ulp: median", "largest", "ns a test"});
  examples::Verification leaks(
      "leaks of the watertight test in floats and doubles", 0.0,
      "the sign of every edge function is exact, whatever the vertices are rounded to");
  const std::array precisions = {std::pair{"half", sk::Precision::Half},
                                 std::pair{"single", sk::Precision::Single},
                                 std::pair{"double", sk::Precision::Double}};
  const std::array storages = {std::pair{"half", sk::Storage::Half},
                               std::pair{"single", sk::Storage::Single}};
  for (const HowToIntersect how : {HowToIntersect::Watertight, HowToIntersect::Moller}) {
    for (const auto& [precisionName, precision] : precisions) {
      for (const auto& [storageName, storage] : storages) {
        const Found found = trace(device, model, inside, how, precision, storage),
                    atEdges = trace(device, model, edges, how, precision, storage);
        std::vector<double> errors;
        double wrong = 0.0;
        for (std::size_t i = 0; i < inside.size(); ++i) {
          wrong += found.ids[i] != expected[i].id;
          if (found.ids[i] >= 0) errors.push_back(unitsOff(found.hits[i].x, expected[i].t));
        }
        std::ranges::sort(errors);
        const auto missed =
            static_cast<double>(std::ranges::count_if(atEdges.ids, [](int id) { return id < 0; }));
        const bool isWatertight = how == HowToIntersect::Watertight;
        if (isWatertight && precision != sk::Precision::Half) leaks.note(0, missed);
        table.add({isWatertight ? "watertight" : "moller", precisionName, storageName,
                   fmt::format("{:.0f}", 1e6 * wrong / double(inside.size())),
                   fmt::format("{:.0f}", 1e6 * missed / double(edges.size())),
                   fmt::format("{:.3g}", errors.empty() ? 0.0 : errors[errors.size() / 2]),
                   fmt::format("{:.3g}", errors.empty() ? 0.0 : errors.back()),
                   fmt::format("{:.2f}", found.nanoseconds)});
      }
    }
  }
  return {table.markdown(), {leaks}};
}

Findings studySums(sk::Device& device, bool isSmall) {
  const int sums = isSmall ? 64 : 1024;
  constexpr int count = 1'000'000, ofCall = 50'000;
  examples::Table table({"a million samples", "floats", "compensated", "doubles"});
  examples::Verification kept("mean error of compensated sums and of doubles", 0x1p-24,
                              "half a unit of the float that holds the mean");
  const std::array<std::string_view, 3> kinds = {"0.1 each", "independent, from 0 to 1",
                                                 "one of 100,000, then from 0 to 0.01"};
  for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
    auto added = device.stream<kernels::Sums>({sums});
    kernels::startSums(17u, sk::iter(0, sums), added);
    for (int first = 0; first < count; first += ofCall)
      kernels::addMany(static_cast<unsigned>(kind), first, ofCall, added, added);
    double ofFloats = 0.0, ofKahan = 0.0, ofDoubles = 0.0;
    for (const kernels::Sums& sum : added.read()) {
      ofFloats += (sum.plain / sum.wide - 1) / sums;
      ofKahan += (sum.compensated / sum.wide - 1) / sums;
      // As a picture holds it.
      ofDoubles += (static_cast<float>(sum.wide / count) * double(count) / sum.wide - 1) / sums;
    }
    kept.note(static_cast<std::int64_t>(kind), std::abs(ofKahan));
    kept.note(static_cast<std::int64_t>(kind), std::abs(ofDoubles));
    table.add({std::string(kinds[kind]), fmt::format("{:+.1e}", ofFloats), fmt::format("{:+.1e}", ofKahan),
               fmt::format("{:+.1e}", ofDoubles)});
  }
  return {table.markdown(), {kept}};
}

}  // namespace rays
