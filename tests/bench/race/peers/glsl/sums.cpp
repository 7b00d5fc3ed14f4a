// SPDX-License-Identifier: MIT
//
// Sums: each pass folds blocks of texels to one, until few are left, which the host adds.
#include <algorithm>

#include <fmt/format.h>

#include "peers/glsl/all.hpp"

namespace race {
namespace {

constexpr const char* sumText = R"(#version 330 core
uniform sampler2D s0;
layout(location = 0) out vec4 r;

void main() {{
  ivec2 first = ivec2(gl_FragCoord.xy) * ivec2({0}, {1});
  vec4 sum = vec4(0.0);
  for (int y = 0; y < {1}; ++y) {{
    for (int x = 0; x < {0}; ++x) sum += texelFetch(s0, first + ivec2(x, y), 0);
  }}
  r = sum;
}}
)";

constexpr const char* dotText = R"(#version 330 core
uniform sampler2D s0;
uniform sampler2D s1;
layout(location = 0) out vec4 r;

void main() {{
  ivec2 first = ivec2(gl_FragCoord.xy) * ivec2({0}, {1});
  vec4 sum = vec4(0.0);
  for (int y = 0; y < {1}; ++y) {{
    for (int x = 0; x < {0}; ++x) {{
      ivec2 p = first + ivec2(x, y);
      sum += texelFetch(s0, p, 0) * texelFetch(s1, p, 0);
    }}
  }}
  r = sum;
}}
)";

constexpr int fold = 8;  // texels in a block's row and in its column
constexpr int fewTexels = 64;

class Sum {
 public:
  Sum(const Problem& p, Packing packing) {
    const int channels = static_cast<int>(packing);
    std::int64_t width = p.columns / channels, height = p.rows;
    for (const auto& values : p.floats) {
      inputs_.push_back(std::make_unique<Texture>(width, height, channels, values.data()));
    }
    do {
      const std::int64_t across = std::min<std::int64_t>(fold, width),
                         down = std::min<std::int64_t>(fold, height);
      const char* text = stages_.empty() && p.floats.size() == 2 ? dotText : sumText;
      width /= across;
      height /= down;
      stages_.push_back({std::make_unique<Texture>(width, height, channels, nullptr),
                         std::make_unique<PassProgram>(fmt::format(fmt::runtime(text), across, down))});
    } while (width * height > fewTexels);
  }

  void draw() {
    std::vector<const Texture*> from;
    for (const auto& input : inputs_) from.push_back(input.get());
    for (const Stage& stage : stages_) {
      stage.program->draw(*stage.target, from);
      from = {stage.target.get()};
    }
    // The sum is a number of the host's.
    total_ = 0;
    for (const float part : stages_.back().target->read()) total_ += part;
  }
  std::vector<float> result() const { return {static_cast<float>(total_)}; }

 private:
  struct Stage {
    std::unique_ptr<Texture> target;
    std::unique_ptr<PassProgram> program;
  };
  std::vector<std::unique_ptr<Texture>> inputs_;
  std::vector<Stage> stages_;
  double total_ = 0;
};

}  // namespace

void addGlslSums(const bench::PlainContext& context, std::vector<Contender>& contenders) {
  for (const char* program : {"sum", "dot"}) {
    for (const Packing packing : {Packing::Scalar, Packing::Packed}) {
      contenders.push_back({program, nameOf(packing), [&context, packing](const Problem& p) {
                              return std::make_unique<GlTask<Sum>>(context, p, packing);
                            }});
    }
  }
}

}  // namespace race
