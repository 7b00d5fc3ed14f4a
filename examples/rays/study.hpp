// SPDX-License-Identifier: MIT
//
// Experiments on what choices are worth. One file each; docs/rays.md shows their tables.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <sk/sk.hpp>

#include "bench_scenes.hpp"
#include "mesh.hpp"
#include "model.hpp"
#include "support/study.hpp"

namespace rays {

using examples::Findings;
using examples::Study;

std::span<const Study> studies();

Findings studyLeaks(sk::Device& device, bool isSmall);
Findings studyNeedles(sk::Device& device, bool isSmall);
/// Every scene by every mode on every device; the given one does not matter.
Findings studyAlike(sk::Device& device, bool isSmall);
Findings studyLight(sk::Device& device, bool isSmall);
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

/// A closed mesh in a ring on rough ground: 225,000 triangles, or few. The camera looks at all of it.
Model speedModel(bool isSmall);
/// How long a call takes: the processor's time on devices that run there, whatever else runs beside it; else the time that passes.
double callMilliseconds(bool isProcessor, const std::function<void()>& call);

bool runsOnProcessor(const sk::Device& device);
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

}  // namespace rays
