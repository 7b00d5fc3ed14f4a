// SPDX-License-Identifier: MIT
//
// The parts of a scene that there may be any number of, pins and bodies, and what of their tables others use, too.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "scene.hpp"
#include "support/scene_file.hpp"

namespace examples {

std::optional<Vector> vectorOf(const SceneTable& table, std::string_view key);
/// Returns a vector of unit length. Throws if the table has a zero vector.
std::optional<Vector> directionOf(const SceneTable& table, std::string_view key);
/// Red, green and blue from 0 to 1, sRGB-encoded.
std::optional<Vector> colourOf(const SceneTable& table, std::string_view key);

/// One pin for each table [[pin]].
std::vector<Pin> pinsOf(const SceneTable& scene, const Cloth& cloth);
/// One body for each table [[sphere]], [[plane]], [[capsule]] and [[box]].
std::vector<Body> bodiesOf(const SceneTable& scene);

}  // namespace examples
