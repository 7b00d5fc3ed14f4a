// SPDX-License-Identifier: MIT
//
// Colour maps whose lightness rises evenly, so that equal steps of a value look like equal steps. They are
// computed here from a few control points in Oklab's polar form (B. Ottosson, "A perceptual color space for
// image processing", 2020), with the chroma cut back to what sRGB can show.
#pragma once

#include <string_view>
#include <vector>

#include <sk/types.hpp>

namespace examples {

/// Names that `colormap` knows, in the order to list them.
std::vector<std::string_view> colormapNames();

/// `entries` colours, sRGB-encoded with components in [0, 1], from the map's low end to its high end.
/// Throws std::runtime_error for an unknown name.
std::vector<sk::float3> colormap(std::string_view name, int entries);

/// A closed circle of hues of one lightness: entry i stands for the angle 2 pi i / entries.
std::vector<sk::float3> hueWheel(int entries);

}  // namespace examples
