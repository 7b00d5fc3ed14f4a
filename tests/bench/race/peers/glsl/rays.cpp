// SPDX-License-Identifier: MIT
//
// Rays through a hierarchy of boxes in one fragment program: nodes and triangles in textures 4096 texels wide, the nearer child first, a stack for
// the others, and the test of Moeller and Trumbore.
#include <fmt/format.h>

#include "peers/glsl/all.hpp"
#include "rays_layout.hpp"

namespace race {
namespace {

constexpr int width = 4096;

constexpr const char* text = R"(#version 330 core
uniform sampler2D s0, s1, s2, s3;  // origins, directions, nodes, triangles
layout(location = 0) out vec4 r;
const float nowhere = 3e38;

vec4 node(int i) { return texelFetch(s2, ivec2(i & 4095, i >> 12), 0); }
vec4 corner(int i) { return texelFetch(s3, ivec2(i & 4095, i >> 12), 0); }
int number(float f) { return floatBitsToInt(f) - 0x40000001; }

float entry(vec3 o, vec3 inverse, float least, vec3 low, vec3 high, float most) {
  vec3 a = (low - o) * inverse, b = (high - o) * inverse, s = min(a, b), t = max(a, b);
  float from = max(max(s.x, s.y), max(s.z, least)), to = min(min(t.x, t.y), min(t.z, most));
  return from <= to * 1.000001 ? from : nowhere;
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 from = texelFetch(s0, pixel, 0), along = texelFetch(s1, pixel, 0);
  vec3 o = from.xyz, d = along.xyz, inverse = 1.0 / d;
  float best = along.w, least = from.w;
  int id = -1, top = 0, at = 0;
  int stack[32];
  bool goesOn = entry(o, inverse, least, node(0).xyz, node(1).xyz, best) < nowhere;
  while (goesOn) {
    // Mesa ends loops after 65,535 rounds.
    for (int round = 0; round < 16384 && goesOn; ++round) {
      int first = number(node(2 * at).w), count = number(node(2 * at + 1).w);
      bool pops = true;
      if (count == 0) {
        float t0 = entry(o, inverse, least, node(2 * first).xyz, node(2 * first + 1).xyz, best);
        float t1 = entry(o, inverse, least, node(2 * first + 2).xyz, node(2 * first + 3).xyz, best);
        int nearer = t1 < t0 ? first + 1 : first;
        if (max(t0, t1) < nowhere) stack[top++] = 2 * first + 1 - nearer;
        if (min(t0, t1) < nowhere) {
          at = nearer;
          pops = false;
        }
      }
      for (int i = first; i < first + count; ++i) {
        vec4 a = corner(3 * i);
        vec3 ab = corner(3 * i + 1).xyz - a.xyz, ac = corner(3 * i + 2).xyz - a.xyz, p = cross(d, ac), ao = o - a.xyz;
        float det = dot(ab, p), u = dot(ao, p) / det;
        vec3 q = cross(ao, ab);
        float v = dot(d, q) / det, t = dot(ac, q) / det;
        if (det != 0.0 && u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t >= least && t < best) {
          best = t;
          id = number(a.w);
        }
      }
      if (pops) {
        goesOn = top > 0;
        if (goesOn) at = stack[--top];
      }
    }
  }
  r = vec4(float(id), id < 0 ? -1.0 : best, 0.0, 0.0);
}
)";

/// Elements of four floats, `width` a row.
Texture tableOf(std::vector<float> elements) {
  const std::size_t row = 4 * static_cast<std::size_t>(width);
  const std::size_t rows = (elements.size() + row - 1) / row;
  elements.resize(rows * row);
  return {width, static_cast<std::int64_t>(rows), 4, elements.data()};
}

class NearestHits {
 public:
  explicit NearestHits(const Problem& p)
      : hits_(p.columns, p.rows, 4, nullptr),
        origins_(p.columns, p.rows, 4, p.floats[rayOrigins].data()),
        directions_(p.columns, p.rows, 4, p.floats[rayDirections].data()),
        nodes_(tableOf(p.floats[rayNodes])),
        triangles_(tableOf(p.floats[rayShapes])),
        program_(text) {}

  void draw() const { program_.draw(hits_, {&origins_, &directions_, &nodes_, &triangles_}); }
  std::vector<float> result() const {
    const std::vector<float> texels = hits_.read();
    std::vector<float> all;
    for (std::size_t part = 0; part < 2; ++part)
      for (std::size_t i = part; i < texels.size(); i += 4) all.push_back(texels[i]);
    return all;
  }

 private:
  Texture hits_, origins_, directions_, nodes_, triangles_;
  PassProgram program_;
};

}  // namespace

void addGlslRays(const bench::PlainContext& context, std::vector<Contender>& contenders) {
  for (const char* program : rayPrograms) {
    contenders.push_back({program, "GLSL", [&context](const Problem& p) {
                            return std::make_unique<GlTask<NearestHits>>(context, p);
                          }});
  }
}

}  // namespace race
