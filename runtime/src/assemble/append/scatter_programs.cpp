// SPDX-License-Identifier: MIT
#include "assemble/append/scatter_programs.hpp"

#include <array>
#include <string_view>

#include <fmt/format.h>

#include "assemble/append/append_groups.hpp"
#include "assemble/elements/domain.hpp"
#include "assemble/elements/planes.hpp"
#include "assemble/glsl/program_text.hpp"
#include "glsl_text/combine_records.hpp"

namespace sk::assemble {
namespace {

using program::Parameter;
using program::Scalar;
using program::ScatterOp;

std::string vectorOf(std::string_view scalar, std::string_view vector, int width) {
  return width == 1 ? std::string(scalar) : fmt::format("{}{}", vector, width);
}

std::string_view name(PointStep step) {
  static constexpr std::array<std::string_view, 9> names = {"store",
                                                            "limbs of the elements",
                                                            "limbs of the values",
                                                            "elements of limbs",
                                                            "upper halves of the elements",
                                                            "upper halves of the values",
                                                            "lower halves of the elements",
                                                            "lower halves of the values",
                                                            "elements of halves"};
  return names[static_cast<std::size_t>(step)];
}

class PointText {
 public:
  PointText(const Parameter& appendOutput, PointStep step, const PointTextures& textures)
      : appendOutput_(appendOutput),
        step_(step),
        textures_(textures),
        field_(appendOutput.element->fields.front()),
        domain_(program_, {.domain = Domain::Linear, .rank = 1, .layered = textures.elements}) {}

  std::string write(const Profile& profile) {
    if (hasPoints(step_)) {
      program_.flatInput("int", "sk_entry");
      program_.require(Function::Texel);
      program_.uniform("int", "sk_list_shift");
      program_.statement("ivec2 sk_at = sk_texel(sk_entry, sk_list_shift);");
    } else {
      program_.statement(fmt::format("ivec2 sk_at = {};", domain_.texel().at));
    }
    body();
    program::Kernel declarations;
    return program_.finish(profile, fmt::format("points of {}: {}", appendOutput_.name, name(step_)),
                           declarations);
  }

 private:
  void body() {
    switch (step_) {
      case PointStep::Store: return copyPlanes(program_, appendOutput_, texel());
      case PointStep::SplitLimbs:
      case PointStep::AddLimbs: return splitLimbs();
      case PointStep::JoinLimbs: return joinLimbs();
      case PointStep::SplitUpper:
      case PointStep::Upper: return upper();
      case PointStep::SplitLower:
      case PointStep::Lower: return lower();
      case PointStep::JoinHalves: return joinHalves();
    }
  }

  /// The texel `sk_at`, in the list or in the output.
  Texel texel() {
    if (hasPoints(step_)) return {"sk_at", textures_.list ? "sk_list_shift" : ""};
    return {"sk_at", domain_.texel().shift};
  }
  /// A texel that an earlier step has drawn.
  std::string drawn(const std::string& sampler) {
    program_.uniform(samplerType("sampler2D", textures_.elements), sampler);
    return fmt::format("texelFetch({}, {}, 0)", sampler, place(program_, domain_.texel()));
  }

  int width() const { return field_.width; }
  std::string uvec() const { return vectorOf("uint", "uvec", width()); }
  std::string vec() const { return vectorOf("float", "vec", width()); }
  std::string_view swizzle() const {
    static constexpr std::array<std::string_view, 5> swizzles = {"", ".x", ".xy", ".xyz", ""};
    return swizzles[static_cast<std::size_t>(width())];
  }
  std::string component(std::string_view value, int c) const {
    return width() == 1 ? std::string(value) : fmt::format("{}.{}", value, "xyzw"[c]);
  }
  /// Float render targets have 4 channels for 3 components.
  std::string target(const std::string& value) const {
    return width() == 3 ? fmt::format("vec4({}, 0.0)", value) : value;
  }
  void declareHalf(std::string_view output) {
    program_.output(vectorOf("float", "vec", width() == 3 ? 4 : width()), output);
  }

  /// Declares `sk_bits`: the bits of the list's value or of the element.
  void readBits() {
    declareSamplers(program_, appendOutput_, !texel().shift.empty());
    program_.statement(
        fmt::format("{0} sk_bits = {0}({1});", uvec(), fetch(program_, appendOutput_, texel())));
  }

  /// Declares `sk_bits` so that the largest integer is the wanted value.
  void readOrdered() {
    readBits();
    if (const std::string flip = flipped(); !flip.empty())
      program_.statement(fmt::format("sk_bits {};", flip));
  }

  /// Converts bits to that order, or back.
  std::string flipped() const {
    const bool isSigned = field_.scalar == Scalar::Int;
    const bool isMin = appendOutput_.scatter == ScatterOp::Min;
    if (!isSigned && !isMin) return "";
    return fmt::format("^= {}", isSigned && isMin ? "0x7fffffffu" : isSigned ? "0x80000000u" : "0xffffffffu");
  }

  void splitLimbs() {
    readBits();
    for (int c = 0; c < width(); ++c) {
      program_.output("vec4", fmt::format("sk_out{}", c));
      program_.statement(fmt::format("sk_out{} = vec4(uvec4({}) >> uvec4(0u, 8u, 16u, 24u) & 255u);", c,
                                     component("sk_bits", c)));
    }
  }

  /// After additions, the limbs overlap: the sum wraps, as the elements' sum does.
  void joinLimbs() {
    declareOutputs(program_, appendOutput_);
    program_.function(
        "uint sk_join(vec4 sk_l)",
        {"uvec4 sk_u = uvec4(sk_l);", "return sk_u.x + (sk_u.y << 8) + (sk_u.z << 16) + (sk_u.w << 24);"});
    std::vector<std::string> components;
    for (int c = 0; c < width(); ++c) {
      components.push_back(fmt::format("sk_join({})", drawn(fmt::format("sk_limbs{}", c))));
    }
    finishElement(fmt::format("{}({})", uvec(), fmt::join(components, ", ")));
  }

  void upper() {
    readOrdered();
    declareHalf("sk_half");
    program_.statement(fmt::format("sk_half = {};", target(vec() + "(sk_bits >> 16)")));
  }

  /// -1 in components whose upper half is not the result, which is less than every lower half.
  void lower() {
    readOrdered();
    declareHalf("sk_half");
    program_.statement(fmt::format("{} sk_won = {}{};", vec(), drawn("sk_upper"), swizzle()));
    std::vector<std::string> components;
    for (int c = 0; c < width(); ++c) {
      const std::string bits = component("sk_bits", c);
      components.push_back(
          fmt::format("float({0} >> 16) == {1} ? float({0} & 0xffffu) : -1.0", bits, component("sk_won", c)));
    }
    program_.statement(
        fmt::format("sk_half = {};", target(fmt::format("{}({})", vec(), fmt::join(components, ", ")))));
  }

  void joinHalves() {
    declareOutputs(program_, appendOutput_);
    for (const char* half : {"sk_upper", "sk_lower"}) {
      program_.statement(fmt::format("{0} {1}_half = {0}({2}{3});", uvec(), half, drawn(half), swizzle()));
    }
    finishElement("sk_upper_half << 16 | sk_lower_half", flipped());
  }

  /// Stores bits as an element.
  void finishElement(const std::string& bits, const std::string& change = "") {
    program_.statement(fmt::format("{} sk_bits = {};", uvec(), bits));
    if (!change.empty()) program_.statement(fmt::format("sk_bits {};", change));
    program_.statement(fmt::format("{0} sk_element = {0}(sk_bits);", appendOutput_.element->glsl));
    store(program_, appendOutput_, "sk_element");
  }

  const Parameter& appendOutput_;
  PointStep step_;
  const PointTextures& textures_;
  const program::Field& field_;
  ProgramText program_;
  DomainText domain_;  ///< the output's texels
};

}  // namespace

std::span<const PointStep> pointSteps(const Parameter& scatter) {
  static constexpr PointStep store[] = {PointStep::Store};
  static constexpr PointStep sums[] = {PointStep::SplitLimbs, PointStep::AddLimbs, PointStep::JoinLimbs};
  static constexpr PointStep extremes[] = {PointStep::SplitUpper, PointStep::Upper, PointStep::SplitLower,
                                           PointStep::Lower, PointStep::JoinHalves};
  const bool isFloat = scatter.element->fields.front().scalar == Scalar::Float;
  if (isFloat || scatter.scatter == ScatterOp::Store) return store;
  return scatter.scatter == ScatterOp::Add ? std::span<const PointStep>(sums) : extremes;
}

bool hasPoints(PointStep step) {
  switch (step) {
    case PointStep::Store:
    case PointStep::AddLimbs:
    case PointStep::Upper:
    case PointStep::Lower: return true;
    case PointStep::SplitLimbs:
    case PointStep::JoinLimbs:
    case PointStep::SplitUpper:
    case PointStep::SplitLower:
    case PointStep::JoinHalves: break;
  }
  return false;
}

std::string pointVertexProgram(const Profile& profile, const PointTextures& textures) {
  std::string functions(text(Function::Texel));
  std::string at = "sk_texel(sk_entry, sk_list_shift)";
  if (textures.list) {
    functions += text(Function::Layered);
    at = fmt::format("sk_layered({}, sk_list_shift)", at);
  }
  return fmt::format(R"({0}
// points at the texels of a list
{1}uniform {2} sk_targets;
uniform int sk_list_shift;
uniform int sk_first;
uniform ivec4 sk_size;
uniform int sk_domain_row;
flat out int sk_entry;
{3}
void main() {{
  sk_entry = sk_first + gl_VertexID;
  ivec2 sk_t = texelFetch(sk_targets, {4}, 0).xy - ivec2(0, sk_domain_row);
  bool sk_inside = sk_t.x >= 0 && sk_t.y >= 0 && sk_t.y < sk_size.y;
  gl_PointSize = 1.0;
  gl_Position = sk_inside ? vec4(vec2(2 * sk_t + 1) / vec2(sk_size.xy) - 1.0, 0.0, 1.0)
                          : vec4(2.0, 2.0, 2.0, 1.0);
}}
)",
                     profile.version, profile.es ? "precision highp int;\nprecision highp isampler2D;\n" : "",
                     samplerType("isampler2D", textures.list), functions, at);
}

std::string pointProgram(const Profile& profile, const Parameter& appendOutput, PointStep step,
                         const PointTextures& textures) {
  return PointText(appendOutput, step, textures).write(profile);
}

namespace {

using program::Field;

/// `sk_combine`, of the value so far and one that follows.
std::string combination(const program::Parameter& scatter, std::string_view type) {
  const Field& field = scatter.element->fields.front();
  if (scatter.scatter == ScatterOp::Add)
    return fmt::format("{0} sk_combine({0} a, {0} b) {{ return a + b; }}\n", type);
  const bool isMin = scatter.scatter == ScatterOp::Min;
  if (field.scalar != Scalar::Float)
    return fmt::format("{0} sk_combine({0} a, {0} b) {{ return {1}(a, b); }}\n", type, isMin ? "min" : "max");
  std::string text(orderOfFloats());
  text += fmt::format(
      "float sk_extreme(float a, float b) {{ return {}(floatBitsToUint(b), floatBitsToUint(a)) ? b : a; }}\n",
      isMin ? "sk_below" : "sk_above");
  std::string parts;
  for (int c = 0; c < field.width; ++c)
    parts += fmt::format("{0}sk_extreme(a.{1}, b.{1})", c == 0 ? "" : ", ", "xyzw"[c]);
  return text + fmt::format("{0} sk_combine({0} a, {0} b) {{ return {0}({1}); }}\n", type, parts);
}

}  // namespace

std::string recordProgram(const Profile& profile, const program::Parameter& scatter, bool isCounted) {
  static constexpr std::array<std::string_view, 5> swizzles = {"", ".x", ".xy", ".xyz", ""};
  static constexpr std::array<std::string_view, 5> rests = {"", ", 0, 0, 0", ", 0, 0", ", 0", ""};
  const Field& field = scatter.element->fields.front();
  const bool isFloat = field.scalar == Scalar::Float;
  const std::string_view kind = isFloat ? "" : field.scalar == Scalar::Int ? "i" : "u";
  const std::string_view type = scatter.element->glsl;
  const auto width = static_cast<std::size_t>(field.width);
  const std::array formats = {imageFormat(field)};
  std::string text = fmt::format("{}\n{}{}{}{}", profile.version,
                                 declaresFormats(profile) ? formatExtension(profile, formats) : "",
                                 isPair(scatter) ? "#define SK_PAIRS\n" : "",
                                 isCounted ? "#define SK_COUNTED\n" : "", precisionStatements(profile));
  text += fmt::format(
      "#define SK_VALUE {}\n#define SK_SWIZZLE {}\n#define SK_SAMPLER {}sampler2D\n#define SK_IMAGE "
      "{}image2D\n"
      "#define SK_FORMAT {}\n#define SK_TEXEL(v) {}vec4(v{})\n",
      type, swizzles[width], kind, kind, formats.front(), kind, rests[width]);
  text += combination(scatter, type);
  return text + std::string(library::combineRecords);
}

}  // namespace sk::assemble
