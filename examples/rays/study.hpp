// SPDX-License-Identifier: MIT
//
// Experiments on what choices are worth. One file each; docs/rays.md shows their tables.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <sk/sk.hpp>

#include "mesh.hpp"
#include "model.hpp"
#include "support/verification.hpp"

namespace rays {

struct Findings {
  std::string table;  ///< in Markdown, which docs/rays.md shows
  std::vector<examples::Verification> verifications{};
};

struct Study {
  std::string_view name;
  std::string_view asks;  ///< for --help
  /// `isSmall`: in seconds, with fewer rays.
  Findings (*run)(sk::Device& device, bool isSmall);
};

std::span<const Study> studies();

Findings studyLeaks(sk::Device& device, bool isSmall);
Findings studySpeed(sk::Device& device, bool isSmall);
Findings studyStreaming(sk::Device& device, bool isSmall);
Findings studyRayEngine(sk::Device& device, bool isSmall);

/// A mesh alone, moved, its ids from 0.
Model modelOf(const Mesh& mesh, Vector moved = {});

/// A closed mesh in a ring on rough ground: 225,000 triangles, or some thousands.
Model speedModel(bool isSmall);

/// From what was hit, about its normals, with the density of the cosine.
std::vector<Ray> diffuseRays(const Model& model, const std::vector<Ray>& rays, const std::vector<Hit>& hits);

/// From near `moved`, inside a closed mesh that was moved there, to its vertices and to points of its edges, as floats have them.
std::vector<Ray> raysToEdges(const Model& model, Vector moved, std::size_t count, unsigned seed);

}  // namespace rays
