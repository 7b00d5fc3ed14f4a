// SPDX-License-Identifier: MIT
//
// Reads rays from a text file and writes hits to a table, so that they can be compared with those of another tracer.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "model.hpp"

namespace rays {

/// A ray for each line `ox oy oz dx dy dz [tmin tmax]`; lines that are empty or begin with # are none. Throws std::runtime_error,
/// "FILE:LINE:COLUMN: what is wrong".
std::vector<Ray> loadRays(const std::filesystem::path& file);

/// `width` > 0: "x,y,id,t,u,v", row by row; else "ray,id,t,u,v". Where nothing is hit, id is -1 and t inf. Numbers have as many
/// digits as it takes to read the same floats again. Creates the file's folder; throws where it cannot be written.
void saveHits(const std::filesystem::path& file, std::span<const Hit> hits, int width);

}  // namespace rays
