// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "constants.hpp"
#include "peers/glsl/all.hpp"

namespace race {
namespace {

constexpr const char* text = R"(#version 330 core
layout(location = 0) out float r;

void main() {{
  vec2 c = vec2({:.9f}, {:.9f}) + vec2({:.9e}, {:.9e}) * gl_FragCoord.xy;
  vec2 z = vec2(0.0);
  int steps = 0;
  while (steps < {} && dot(z, z) <= 4.0) {{
    z = vec2(z.x * z.x - z.y * z.y, 2.0 * z.x * z.y) + c;
    ++steps;
  }}
  r = float(steps);
}}
)";

class Picture {
 public:
  explicit Picture(const Problem& p)
      : steps_(p.columns, p.rows, 1, nullptr),
        program_(fmt::format(text, mandelbrotLeft, mandelbrotTop,
                             mandelbrotExtent / static_cast<float>(p.columns),
                             mandelbrotExtent / static_cast<float>(p.rows), mandelbrotSteps)) {}

  void draw() const { program_.draw(steps_, {}); }
  std::vector<float> result() const { return steps_.read(); }

 private:
  Texture steps_;
  PassProgram program_;
};

}  // namespace

void addGlslMandelbrot(const bench::PlainContext& context, std::vector<Contender>& contenders) {
  contenders.push_back({"mandelbrot", "GLSL", [&context](const Problem& p) {
                          return std::make_unique<GlTask<Picture>>(context, p);
                        }});
}

}  // namespace race
