// SPDX-License-Identifier: MIT
//
// The lights of a model for kernels that choose one at random, in proportion to its power. It knows no device.
#pragma once

#include <span>
#include <vector>

#include <sk/types.hpp>

#include "model.hpp"

namespace rays {

/// For numbers drawn in proportion to weights: place i stays i with probability `stays`, and else becomes `alias` (M. Vose, "A linear algorithm
/// for generating random numbers with a given distribution", 1991).
struct AliasEntry {
  double stays = 1.0;
  std::size_t alias = 0;
};
/// Weights must not be negative, and not all 0.
std::vector<AliasEntry> aliasTable(std::span<const double> weights);

struct LightTable {
  /// Four elements a light, suns first. (a or position or direction, kind), (b or radius or 1 - cosine, alias), (c, stays),
  /// (radiance or intensity or irradiance, probability). Kinds as in lights.sk.
  std::vector<sk::float4> lights;
  int count = 0;
  /// Two elements a pixel of the environment's image: (stays, alias, 0, 0) and (radiance, density per latitude and longitude).
  std::vector<sk::float4> sky;
  double skyChoice = 0.0;
  /// For each material: the probability, per area, that a point of its triangles and spheres is chosen.
  std::vector<double> shares;
};

LightTable lightTable(const Model& model);

/// Returns false if every picture of the model is black: no light, no shape that emits, and a black environment.
bool hasLight(const Model& model);

}  // namespace rays
