// SPDX-License-Identifier: MIT
//
// Stencils. Packed, a texel holds four neighbours of a row: those to its left and right come from this texel and the
// ones beside it, so that four results take as many fetches as one does otherwise.
#include <string>

#include <fmt/format.h>

#include "constants.hpp"
#include "peers/glsl/all.hpp"

namespace race {
namespace {

constexpr const char* head = R"(#version 330 core
uniform sampler2D s0;
layout(location = 0) out vec4 r;

vec4 at(ivec2 p) { return texelFetch(s0, clamp(p, ivec2(0), textureSize(s0, 0) - 1), 0); }
)";

constexpr const char* scalarNeighbours = R"(
struct Row { vec4 left, here, right; };
Row row(ivec2 p) { return Row(at(p - ivec2(1, 0)), at(p), at(p + ivec2(1, 0))); }
)";

constexpr const char* packedNeighbours = R"(
struct Row { vec4 left, here, right; };
Row row(ivec2 p) {
  vec4 here = at(p);
  // The borders continue: the texel outside of a row would be the first or last one, not its outer element.
  float before = p.x > 0 ? texelFetch(s0, ivec2(p.x - 1, clamp(p.y, 0, textureSize(s0, 0).y - 1)), 0).w : here.x;
  float behind = p.x + 1 < textureSize(s0, 0).x
      ? texelFetch(s0, ivec2(p.x + 1, clamp(p.y, 0, textureSize(s0, 0).y - 1)), 0).x : here.w;
  return Row(vec4(before, here.xyz), here, vec4(here.yzw, behind));
}
)";

constexpr const char* heat = R"(
void main() {{
  ivec2 p = ivec2(gl_FragCoord.xy);
  Row u = row(p);
  vec4 sum = u.left + u.right + at(p - ivec2(0, 1)) + at(p + ivec2(0, 1));
  r = u.here + {:.9f} * (sum - 4.0 * u.here);
}}
)";

constexpr const char* binomial = R"(
void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  Row a = row(p - ivec2(0, 1)), u = row(p), b = row(p + ivec2(0, 1));
  vec4 corners = a.left + a.right + b.left + b.right;
  vec4 sides = a.here + u.left + u.right + b.here;
  r = (corners + 2.0 * sides + 4.0 * u.here) / 16.0;
}
)";

class Stencil {
 public:
  Stencil(const Problem& p, Packing packing, const std::string& body)
      : channels_(static_cast<int>(packing)),
        u_(p.columns / channels_, p.rows, channels_, p.floats[0].data()),
        v_(p.columns / channels_, p.rows, channels_, nullptr),
        program_(head + std::string(packing == Packing::Scalar ? scalarNeighbours : packedNeighbours) +
                 body) {}

  void draw() const { program_.draw(v_, {&u_}); }
  std::vector<float> result() const { return v_.read(); }

 private:
  int channels_;
  Texture u_, v_;
  PassProgram program_;
};

}  // namespace

void addGlslStencils(const bench::PlainContext& context, std::vector<Contender>& contenders) {
  const auto add = [&](const char* program, const std::string& body) {
    for (const Packing packing : {Packing::Scalar, Packing::Packed}) {
      contenders.push_back({program, nameOf(packing), [&context, packing, body](const Problem& p) {
                              return std::make_unique<GlTask<Stencil>>(context, p, packing, body);
                            }});
    }
  };
  add("5-point stencil", fmt::format(fmt::runtime(heat), heatFlow));
  add("9-point stencil", binomial);
}

}  // namespace race
