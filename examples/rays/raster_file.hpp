// SPDX-License-Identifier: MIT
//
// Linear pictures in and out of files: textures and environments, PFM (portable float map: 32-bit floats, rows from the bottom).
#pragma once

#include <filesystem>
#include <span>

#include "model.hpp"

namespace rays {

/// .pfm and .exr as they are; PNG, JPEG and what else stb_image reads is decoded from sRGB. Throws std::runtime_error with the file's name.
Raster loadRaster(const std::filesystem::path& file);

/// Creates the file's folder. Throws std::runtime_error where the file cannot be written.
void savePfm(const std::filesystem::path& file, int width, int height, std::span<const sk::float3> pixels);

}  // namespace rays
