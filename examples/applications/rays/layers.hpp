// SPDX-License-Identifier: MIT
//
// Auxiliary images for compositing and denoising: distance, normal, albedo and id of what each pixel's centre sees, the variance of its mean, and
// its number of samples. Every engine provides them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine.hpp"
#include "exposure.hpp"
#include "model.hpp"

namespace rays {

struct Layer {
  std::string name;
  std::vector<sk::float3> pixels{};  ///< row by row from the top; of single numbers all three are the same
  bool isSingle = false;
  std::vector<std::int32_t> whole{};  ///< the same where numbers are whole, which floats hold up to 2^24 only
};

/// "variance" (of the mean, where there are two samples) and "samples" (of each pixel).
std::vector<Layer> layersOf(Exposure& exposure);

/// "depth" (distance in the scene's lengths, infinite where nothing is seen), "normal" (towards the viewer, zero where nothing is seen), "albedo"
/// (of the material, textures included), "id" (-1: nothing).
std::vector<Layer> layersOf(Engine& engine, const Model& model, const Picture& picture);

/// Returns true if a sample of the camera's rays meets only the backs of opaque surfaces, as it does from within a wall.
bool seesBacksAlone(Engine& engine, const Model& model);

/// PREFIX_NAME.pfm for each. Throws std::runtime_error where a file cannot be written.
void saveLayers(const std::string& prefix, const std::vector<Layer>& layers, const Picture& picture);

}  // namespace rays
