// SPDX-License-Identifier: MIT
#include "study.hpp"

#include <array>
#include <random>

namespace rays {

std::span<const Study> studies() {
  static constexpr std::array all = {
      Study{"leaks", "what tests of triangles miss at edges and vertices, and how exact their distances are",
            studyLeaks},
      Study{"alike", "how far apart pictures are by every mode, on fragment, compute and native", studyAlike},
      Study{"light", "means of pictures that are known, by each way to reach lights", studyLight},
      Study{"convergence", "how fast errors fall with independent samples and with Sobol's",
            studyConvergence},
      Study{"precision", "what tests of triangles in halves, floats and doubles miss, and what they cost",
            studyPrecision},
      Study{"sums", "what sums of a million samples lose in floats", studySums},
      Study{"speed", "rays per second by test, traversal and size of leaves", studySpeed},
      Study{"wavefront", "paths by one kernel or by queues, and what sorting rays is worth", studyWavefront},
      Study{"streaming", "what a uniform grid and each kernel of a multipass machine cost", studyStreaming},
      Study{"stopping", "what it saves that pixels stop when they are good enough, and what is wrong then",
            studyStopping},
      Study{"ray_engine", "what sizes of buckets and calls are worth, and not to wait", studyRayEngine},
      Study{"engines", "the three engines on the scenes of the benchmarks", studyEngines},
      Study{"embree", "the same rays by Embree: rays per second, and hits that differ", studyEmbree},
  };
  return all;
}

Model modelOf(const Mesh& mesh, Vector moved) {
  Model model;
  for (const Face& face : mesh.faces) {
    const auto point = [&](std::size_t i) { return toFloat3(mesh.points[face.points[i]] + moved); };
    model.triangles.push_back({point(0), point(1), point(2), model.triangleCount++, 0});
  }
  model.materials.push_back({.name = "grey"});
  return model;
}

std::vector<Ray> raysToEdges(const Model& model, Vector moved, std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<Ray> rays;
  rays.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Triangle& t = model.triangles[random() % model.triangles.size()];
    const std::array<sk::float3, 3> corners = {t.a, t.b, t.c};
    const auto a = examples::vecOf<double>(corners[i % 3]), b = examples::vecOf<double>(corners[(i + 1) % 3]);
    const double along = i % 4 == 0 ? 0.0 : i % 4 == 1 ? 0.5 : 0.5 + 0.5 * uniform(random);
    const Vector aside = 0.05 * Vector{uniform(random), uniform(random), uniform(random)};
    const sk::float3 from = toFloat3(i % 5 == 0 ? moved : moved + aside), to = toFloat3(a + along * (b - a));
    rays.push_back({.origin = from, .direction = {to.x - from.x, to.y - from.y, to.z - from.z}});
  }
  return rays;
}

}  // namespace rays
