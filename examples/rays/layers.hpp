// SPDX-License-Identifier: MIT
//
// What stands beside a picture for whoever works on with it: distance, normal, albedo and id of what each pixel's centre sees, and the variance
// of its mean. Any engine has them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine.hpp"
#include "model.hpp"

namespace rays {

struct Layer {
  std::string name;
  std::vector<sk::float3> pixels;  ///< row by row from the top; of single numbers all three are the same
};

/// "depth" (distance in the scene's lengths, infinite where nothing is seen), "normal" (towards the viewer, zero where nothing is seen), "albedo"
/// (of the material, textures included), "id" (-1: nothing).
std::vector<Layer> layersOf(Engine& engine, const Model& model, const Picture& picture);

/// PREFIX_NAME.pfm for each. Throws std::runtime_error where a file cannot be written.
void saveLayers(const std::string& prefix, const std::vector<Layer>& layers, const Picture& picture);

}  // namespace rays
