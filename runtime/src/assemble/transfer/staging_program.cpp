// SPDX-License-Identifier: MIT
#include "assemble/transfer/staging_program.hpp"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include "glsl_text/staging.hpp"

namespace sk::assemble {

std::string stagingProgram(const Profile& profile, bool writesTexels, std::string_view format,
                           bool isLayered) {
  const std::string_view kind = format.ends_with("UI") ? "u" : format.ends_with("I") ? "i" : "";
  std::string qualifier(format);
  std::ranges::transform(qualifier, qualifier.begin(), [](unsigned char c) { return std::tolower(c); });
  const std::string_view array = isLayered ? "Array" : "";
  std::string text = fmt::format(
      "{}\n{}#define SK_VECTOR {}vec4\n#define SK_SAMPLER {}sampler2D{}\n#define SK_IMAGE {}image2D{}\n"
      "#define SK_FORMAT {}\n",
      profile.version, isLayered ? "#define SK_LAYERED\n" : "", kind, kind, array, kind, array, qualifier);
  if (kind.empty()) {
    text += "#define sk_to_word floatBitsToUint\n#define sk_from_word uintBitsToFloat\n";
  } else {  // GLSL has no such function of integers, whose vectors and scalars have constructors of their own
    text += fmt::format(
        "uint sk_to_word({0} v) {{ return uint(v); }}\nuvec4 sk_to_word({1}vec4 v) {{ return uvec4(v); }}\n"
        "{0} sk_from_word(uint w) {{ return {0}(w); }}\n{1}vec4 sk_from_word(uvec4 w) {{ return {1}vec4(w); "
        "}}\n",
        kind == "u" ? "uint" : "int", kind);
  }
  text += library::stagingHead;
  text += writesTexels ? library::unpackTexels : library::packTexels;
  text += library::stagingMain;
  return text;
}

}  // namespace sk::assemble
