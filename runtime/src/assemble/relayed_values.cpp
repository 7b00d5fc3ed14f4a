// SPDX-License-Identifier: MIT
//
// The vertex program of every pass: a strip of two triangles with the viewport's corners, without vertex
// data. A single larger triangle would be clipped by software renderers, which takes a good part of a small
// draw's time.
#include "assemble/relayed_values.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <span>

#include <fmt/format.h>

#include "assemble/assemble.hpp"

namespace sk::assemble {
namespace {

/// OpenGL 3.3 and OpenGL ES 3.0 guarantee 60 components, and a location has four.
constexpr int mostLocations = 15;

/// The locations that a value of this type takes; 0 if it cannot be relayed.
int locationsOf(std::string_view type) {
  static constexpr std::array<std::string_view, 12> vectors = {
      "float", "vec2", "vec3", "vec4", "int", "ivec2", "ivec3", "ivec4", "uint", "uvec2", "uvec3", "uvec4"};
  static constexpr std::array<std::string_view, 3> matrices = {"mat2", "mat3", "mat4"};
  if (std::ranges::find(vectors, type) != vectors.end()) return 1;
  return std::ranges::find(matrices, type) != matrices.end() ? type.back() - '0' : 0;
}

}  // namespace

bool RelayedValues::take(std::string_view type, std::string_view name) {
  if (std::ranges::find(values_, name, &RelayedValue::name) != values_.end()) return true;
  const int locations = locationsOf(type);
  if (locations == 0 || locations_ + locations > mostLocations) return false;
  locations_ += locations;
  values_.push_back({std::string(type), std::string(name)});
  return true;
}

std::string relayedName(std::string_view uniform) {
  constexpr std::string_view prefix = "sk_";
  return fmt::format("sk_flat_{}", uniform.substr(prefix.size()));
}

std::string vertexProgram(const Profile& profile, std::span<const RelayedValue> relayed) {
  std::string declarations, statements;
  for (const auto& [type, name] : relayed) {
    const std::string flat = relayedName(name);
    fmt::format_to(std::back_inserter(declarations), "uniform {0} {1};\nflat out {0} {2};\n", type, name,
                   flat);
    fmt::format_to(std::back_inserter(statements), "  {} = {};\n", flat, name);
  }
  return fmt::format(R"({}
{}void main() {{
{}  gl_Position = vec4(float(gl_VertexID & 1) * 2.0 - 1.0, float(gl_VertexID & 2) - 1.0, 0.0, 1.0);
}}
)",
                     profile.version, declarations, statements);
}

}  // namespace sk::assemble
