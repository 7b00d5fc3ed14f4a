// SPDX-License-Identifier: MIT
//
// Needs SK_CACHE=off: the cache knows what has been tried.
#include <string>

#include <catch2/catch.hpp>
#include <epoxy/gl.h>

#include "sk/device.hpp"

namespace {

decltype(epoxy_glShaderSource) driversSource = nullptr;
int changed = 0;

/// A driver whose compiler simplifies rounding errors away in programs that reduce, and in no others.
void simplifyReductions(GLuint shader, GLsizei count, const GLchar* const* texts, const GLint* lengths) {
  std::string program;
  for (GLsizei i = 0; i < count; ++i) {
    const GLint length = lengths == nullptr ? -1 : lengths[i];
    program += length < 0 ? std::string(texts[i]) : std::string(texts[i], static_cast<std::size_t>(length));
  }
  const std::string error = "return d;";
  if (const std::size_t at = program.find(error);
      program.find("void sk_trial_fold(") != std::string::npos && at != std::string::npos) {
    program.replace(at, error.size(), "return 0.0;");
    ++changed;
  }
  const GLchar* const text = program.c_str();
  driversSource(shader, 1, &text, nullptr);
}

}  // namespace

TEST_CASE("rounding errors are tried in programs that reduce") {
  for (const char* profile : {"glsl330", "glsl430", "essl300"}) {
    INFO(profile);
    const sk::DeviceOptions options{.profile = profile};
    REQUIRE(sk::Device(options).arithmetic().exactSums);
    driversSource = epoxy_glShaderSource;
    epoxy_glShaderSource = simplifyReductions;
    changed = 0;
    const bool isTaken = sk::Device(options).arithmetic().exactSums;
    epoxy_glShaderSource = driversSource;
    CHECK(changed > 0);
    CHECK_FALSE(isTaken);
  }
}
