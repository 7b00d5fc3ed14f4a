// SPDX-License-Identifier: MIT
//
// Linear pictures in and out of files: textures and environments, PFM (portable float map: 32-bit floats, rows from the bottom).
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "layers.hpp"
#include "model.hpp"

namespace rays {

/// .pfm and .exr as they are; PNG, JPEG and what else stb_image reads is decoded from sRGB. Throws std::runtime_error with the file's name.
Raster loadRaster(const std::filesystem::path& file);

/// Creates the file's folder. Throws std::runtime_error where the file cannot be written.
void savePfm(const std::filesystem::path& file, int width, int height, std::span<const sk::float3> pixels);

// OpenEXR files: linear pictures of 32-bit floats with any number of layers, which programs that compose and denoise pictures read. A build
// without the library refuses them (SK_OPENEXR).

/// Throws std::runtime_error where this build has no OpenEXR.
void needExr(const std::filesystem::path& file);

/// Writes channels R, G, B, and those of the layers: depth as Z, normal.X ..., albedo.R ..., variance.R ..., and id and samples as whole
/// numbers (an id of -1 as 2^32 - 1). Compressed without loss. Creates the file's folder. Throws std::runtime_error where the file cannot be written.
void saveExr(const std::filesystem::path& file, int width, int height, std::span<const sk::float3> pixels,
             const std::vector<Layer>& layers);

/// The channels R, G, B, or Y alone for all three. Throws std::runtime_error with the file's name where it is missing, broken or has no such channels.
Raster loadExr(const std::filesystem::path& file);

}  // namespace rays
