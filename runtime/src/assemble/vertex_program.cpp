// SPDX-License-Identifier: MIT
//
// The vertex program of every pass: one triangle that covers the viewport, without vertex data.
#include <iterator>
#include <span>

#include <fmt/format.h>

#include "assemble/assemble.hpp"
#include "assemble/relayed_values.hpp"

namespace sk::assemble {
namespace {

std::string triangle(const Profile& profile, std::span<const RelayedValue> relayed) {
  std::string declarations, statements;
  for (const auto& [type, name] : relayed) {
    const std::string flat = relayedName(name);
    fmt::format_to(std::back_inserter(declarations), "uniform {0} {1};\nflat out {0} {2};\n", type, name,
                   flat);
    fmt::format_to(std::back_inserter(statements), "  {} = {};\n", flat, name);
  }
  return fmt::format(R"({}
{}void main() {{
{}  gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}}
)",
                     profile.version, declarations, statements);
}

}  // namespace

std::string vertexProgram(const Profile& profile) { return triangle(profile, {}); }

std::string vertexProgram(const Profile& profile, const program::Kernel& kernel, const Variant& variant) {
  return triangle(profile, relayedValues(profile, kernel, variant));
}

}  // namespace sk::assemble
