// SPDX-License-Identifier: MIT
//
// The vertex program of every pass: a strip of two triangles with the viewport's corners, without vertex
// data. A single larger triangle would be clipped by software renderers, which takes a good part of a small
// draw's time.
#include <iterator>
#include <span>

#include <fmt/format.h>

#include "assemble/assemble.hpp"

namespace sk::assemble {

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
