// SPDX-License-Identifier: MIT
//
// GLSL as one writes it by hand, in a context of its own on the renderer of our GL device: a float a texel, and, where
// that is worth the trouble, four ("packed"), which is the best that fragment programs can do by hand.
#pragma once

#include <string>
#include <vector>

#include "contender.hpp"
#include "peers.hpp"
#include "peers/glsl/pass.hpp"

namespace race {

/// Adds them all; none, and the reason, where no context can be had.
void addGlslPeers(const std::string& renderer, Field& field);

/// The two ways to lay floats in textures.
enum class Packing : int { Scalar = 1, Packed = 4 };

// Each program's own. `context` outlives the tasks.
void addGlslRays(const bench::PlainContext& context, std::vector<Contender>& contenders);
void addGlslSaxpy(const bench::PlainContext& context, std::vector<Contender>& contenders);
void addGlslSums(const bench::PlainContext& context, std::vector<Contender>& contenders);
void addGlslStencils(const bench::PlainContext& context, std::vector<Contender>& contenders);
void addGlslMandelbrot(const bench::PlainContext& context, std::vector<Contender>& contenders);

inline const char* nameOf(Packing packing) { return packing == Packing::Scalar ? "GLSL" : "GLSL packed"; }

}  // namespace race
