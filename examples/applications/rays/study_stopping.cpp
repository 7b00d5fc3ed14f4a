// SPDX-License-Identifier: MIT
//
// What it saves that pixels stop, and what it does to the picture: samples are random, and so is when they seem to differ little.
#include "study.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "bvh_engine.hpp"
#include "render.hpp"
#include "scene_shapes.hpp"
#include "shapes.hpp"
#include "support/table.hpp"

namespace rays {
namespace {

/// A box on a floor under a lamp and a sky: shadows with soft edges, and parts where samples are alike.
Scene lampScene(bool isSmall) {
  Scene scene;
  Model& model = scene.model;
  model.materials = {{.name = "white"}, {.name = "lamp", .emission = {30, 30, 30}}};
  model.environment.colour = {0.2f, 0.3f, 0.4f};
  model.planes.push_back({{0, 1, 0}, 0.0f, 0});
  model.spheres.push_back({{1.5f, 2, 1}, 0.25f, 1});
  const Mesh mesh = box();
  for (const Face& face : mesh.faces) {
    const auto corner = [&](std::size_t i) {
      return toFloat3(mesh.points[face.points[i]] + Vector{0, 0.5, 0});
    };
    model.triangles.push_back({corner(0), corner(1), corner(2), model.triangleCount++, 0});
  }
  model.camera.from = {0, 1.2, 3};
  model.camera.to = {0, 0.3, 0};
  chooseUnit(model);
  scene.picture.width = isSmall ? 16 : 48;
  scene.picture.height = isSmall ? 12 : 36;
  return scene;
}

struct Difference {
  double bias, error;  ///< of the mean, and root mean square; relative to the mean
};

Difference differenceOf(const std::vector<sk::float3>& pixels, const std::vector<sk::float3>& truth) {
  double sum = 0.0, wrong = 0.0, squares = 0.0;
  const auto n = static_cast<double>(pixels.size());
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const double d = double(pixels[i].y) - truth[i].y;
    sum += truth[i].y;
    wrong += d;
    squares += d * d;
  }
  return {wrong / sum, std::sqrt(squares / n) / (sum / n)};
}

}  // namespace

Findings studyStopping(sk::Device& device, bool isSmall) {
  Scene scene = lampScene(isSmall);
  const std::unique_ptr<Engine> engine = makeBvhEngine(device, scene.model, {});
  const auto picture = [&](Sampling sampling, std::uint32_t seed, std::int64_t samples, int least,
                           double error) {
    scene.picture.sampling = sampling;
    scene.picture.seed = seed;
    scene.output.samples = samples;
    scene.output.least = least;
    scene.output.error = error;
    return render(*engine->renderer(scene.picture), scene);
  };
  const std::int64_t most = isSmall ? 96 : 4096;
  const std::vector<sk::float3> truth = picture(Sampling::Sobol, 77, isSmall ? 512 : 8192, 32, 0.0).radiance;
  examples::Table table({"error", "least samples", "numbers", "samples a pixel",
                         "of the picture without stopping", "error of pixels", "bias of the mean"});
  examples::Verification small(
      "bias of pictures that stop after 32 samples at least, as a part of the error", isSmall ? 0.5 : 0.1,
      "32 samples of a pixel and as many of each neighbour say whether there is light");
  for (const double error : isSmall ? std::vector<double>{0.2} : std::vector<double>{0.2, 0.1, 0.05, 0.02}) {
    for (const int least : {4, 32}) {
      for (const auto& [sampling, name] :
           {std::pair{Sampling::Random, "random"}, std::pair{Sampling::Sobol, "Sobol"}}) {
        const Rendering got = picture(sampling, 1, most, least, error);
        const Difference d = differenceOf(got.radiance, truth);
        if (least == 32) small.note(static_cast<std::int64_t>(1 / error), std::abs(d.bias) / error);
        table.add({fmt::format("{:.2f}", error), fmt::format("{}", least), name,
                   fmt::format("{:.1f}", got.perPixel),
                   fmt::format("{:.0f} %", 100 * got.perPixel / double(got.samples)),
                   fmt::format("{:.4f}", d.error), fmt::format("{:+.4f}", d.bias)});
      }
    }
  }
  return {table.markdown(), {small}};
}

}  // namespace rays
