// SPDX-License-Identifier: MIT
//
// Experiments on what choices are worth. One file each; docs/rays.md shows their tables.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include <sk/sk.hpp>

#include "mesh.hpp"
#include "model.hpp"
#include "support/study.hpp"

namespace rays {

using examples::Findings;
using examples::Study;

Findings studyLeaks(sk::Device& device, bool isSmall);
Findings studyNeedles(sk::Device& device, bool isSmall);
/// Every scene by every mode on every device; the given one does not matter.
Findings studyAlike(sk::Device& device, bool isSmall);
Findings studyLight(sk::Device& device, bool isSmall);
Findings studyMetals(sk::Device& device, bool isSmall);
Findings studyConvergence(sk::Device& device, bool isSmall);
Findings studyPrecision(sk::Device& device, bool isSmall);
Findings studySums(sk::Device& device, bool isSmall);
Findings studySpeed(sk::Device& device, bool isSmall);
Findings studyStreaming(sk::Device& device, bool isSmall);
Findings studyWavefront(sk::Device& device, bool isSmall);
Findings studyEngines(sk::Device& device, bool isSmall);
Findings studyStopping(sk::Device& device, bool isSmall);
Findings studyRayEngine(sk::Device& device, bool isSmall);

/// Embree on the same rays, where the program was built with it; throws std::runtime_error elsewhere.
Findings studyEmbree(sk::Device& device, bool isSmall);

inline constexpr std::array<Study, 15> studies = {{
    {"leaks", "what tests of triangles miss at edges and vertices, and how exact their distances are",
     studyLeaks},
    {"needles", "how the errors of distances grow with the aspect ratio of triangles", studyNeedles},
    {"alike", "how far apart pictures are by every mode, on fragment, compute and native", studyAlike},
    {"light", "means of pictures that are known, by each way to reach lights", studyLight},
    {"metals", "what rough metals reflect in a white furnace, by facets once and in all", studyMetals},
    {"convergence", "how fast errors fall with independent samples and with Sobol's", studyConvergence},
    {"precision", "what tests of triangles in halves, floats and doubles miss, and what they cost",
     studyPrecision},
    {"sums", "what sums of a million samples lose in floats", studySums},
    {"speed", "rays per second by test, traversal and size of leaves", studySpeed},
    {"wavefront", "paths by one kernel or by queues, and what sorting rays is worth", studyWavefront},
    {"streaming", "what a uniform grid and each kernel of a multipass machine cost", studyStreaming},
    {"stopping", "what it saves that pixels stop when they are good enough, and what is wrong then",
     studyStopping},
    {"ray_engine", "what sizes of buckets and calls are worth, and not to wait", studyRayEngine},
    {"engines", "the three engines on the scenes of the benchmarks", studyEngines},
    {"embree", "the same rays by Embree: rays per second, and hits that differ", studyEmbree},
}};

/// A closed mesh in a ring on rough ground: 225,000 triangles, or few. The camera looks at all of it.
Model speedModel(bool isSmall);
/// The best of some calls, each with the wait for it. They follow one that compiles and, on a GPU, others that raise its clock.
double bestMilliseconds(sk::Device& device, int calls, const std::function<void()>& call);
/// Millions of elements a second, likewise.
double callRate(sk::Device& device, double elements, int calls, const std::function<void()>& call);

/// Millions of rays a second through a hierarchy of default settings: the best of some calls, without the way to the device and back.
double closestRate(sk::Device& device, const Model& model, std::span<const Ray> rays, int calls);

/// A mesh alone, moved, its ids from 0.
Model modelOf(const Mesh& mesh, Vector moved = {});

/// Triangles of length 1 in all directions, each `aspect` times as long as it is high, as far as floats have such.
Model needles(double aspect, std::size_t count, unsigned seed);
/// From outside and from inside, at points inside of triangles.
std::vector<Ray> raysToTriangles(const Model& model, std::size_t count, unsigned seed);

/// From near `moved`, inside a closed mesh that was moved there, to its vertices and to points of its edges, as floats have them.
std::vector<Ray> raysToEdges(const Model& model, Vector moved, std::size_t count, unsigned seed);

/// Vases, rings and blocks between walls, where every ray hits something: 301,000 triangles, or few.
Model interior(bool isSmall);

/// A torus with bumps and folds: 70,000 triangles, or few.
Model organic(bool isSmall);

/// Rays from what `rays` hit, in any direction about the normal, with the density of the cosine. They are in the order of `rays`, which is gone
/// through again until there are `count`. Throws std::logic_error if nothing is hit.
std::vector<Ray> diffuseRays(const Model& model, std::span<const Ray> rays, std::span<const Hit> hits,
                             std::size_t count);

}  // namespace rays
