// SPDX-License-Identifier: MIT
//
// What one would write by hand: plain GL 3.3 in a context of its own, on the same renderer and with the same
// layout (a float texture a stream, texelFetch, one triangle). It must not use the runtime.
#pragma once

#include <string>
#include <vector>

#include <epoxy/gl.h>

#include "plain_context.hpp"

namespace bench {

/// One pass that writes a float texture of width x height from up to two like it. Make it, use it and let
/// it go while its context is current.
class PlainPass {
 public:
  /// `inputs`: the textures' texels, for samplers `x` and `y`.
  PlainPass(const char* fragmentText, int width, int height, const std::vector<std::vector<float>>& inputs);
  ~PlainPass();
  PlainPass(const PlainPass&) = delete;
  PlainPass& operator=(const PlainPass&) = delete;

  void setFloat(const char* uniform, float value) const;
  /// Binds what a program must bind that does other things in between, and draws.
  void draw() const;
  std::vector<float> result() const;

 private:
  GLuint program_ = 0;
  GLuint array_ = 0;
  GLuint framebuffer_ = 0;
  std::vector<GLuint> textures_;   ///< the inputs, then the output
  int width_;
  int height_;
};

// saxpy: float a, samplers x and y. binomial: sampler x. The sampled ones leave clamping, and finding the
// texel, to the sampler: GLSL of another kind, which some renderers run faster.
extern const char* const saxpyText;
extern const char* const saxpySampledText;
extern const char* const binomialText;
extern const char* const binomialSampledText;

}  // namespace bench
