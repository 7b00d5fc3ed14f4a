// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "constants.hpp"
#include "peers/glsl/all.hpp"

namespace race {
namespace {

// The same text serves both packings: a scalar texture's other channels go nowhere.
constexpr const char* text = R"(#version 330 core
uniform sampler2D s0;
uniform sampler2D s1;
layout(location = 0) out vec4 r;

void main() {{
  ivec2 p = ivec2(gl_FragCoord.xy);
  r = {:.1f} * texelFetch(s0, p, 0) + texelFetch(s1, p, 0);
}}
)";

class Saxpy {
 public:
  Saxpy(const Problem& p, Packing packing)
      : channels_(static_cast<int>(packing)),
        x_(p.columns / channels_, p.rows, channels_, p.floats[0].data()),
        y_(p.columns / channels_, p.rows, channels_, p.floats[1].data()),
        r_(p.columns / channels_, p.rows, channels_, nullptr),
        program_(fmt::format(text, saxpyFactor)) {}

  void draw() const { program_.draw(r_, {&x_, &y_}); }
  std::vector<float> result() const { return r_.read(); }

 private:
  int channels_;
  Texture x_, y_, r_;
  PassProgram program_;
};

}  // namespace

void addGlslSaxpy(const bench::PlainContext& context, std::vector<Contender>& contenders) {
  for (const Packing packing : {Packing::Scalar, Packing::Packed}) {
    contenders.push_back({"saxpy", nameOf(packing), [&context, packing](const Problem& p) {
                            return std::make_unique<GlTask<Saxpy>>(context, p, packing);
                          }});
  }
}

}  // namespace race
