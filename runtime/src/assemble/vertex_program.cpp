// SPDX-License-Identifier: MIT
//
// The vertex program of every pass: one triangle that covers the viewport, without vertex data.
#include <fmt/format.h>

#include "assemble/assemble.hpp"

namespace sk::assemble {

std::string vertexProgram(const Profile& profile) {
  return fmt::format(R"({}
void main() {{
  gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}}
)",
                     profile.version);
}

}  // namespace sk::assemble
