// SPDX-License-Identifier: MIT
//
// Spells planes in GLSL.
#include "assemble/elements/planes.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include <fmt/format.h>

#include "sk/scalar_bytes.hpp"

namespace sk::assemble {
namespace {

using program::Element;
using program::Field;
using program::Kernel;
using program::Parameter;
using program::Scalar;

/// The spelling of a plane by component type. `load` converts a texel to a value, `store` a value to a texel;
/// `{0}` is the operand, `{1}` the result's type. Empty: no conversion. Marks keep what these compute apart from what a kernel does.
struct Spelling {
  std::string_view sampler;
  std::string_view texelScalar;
  std::string_view texelVector;  ///< without its width
  std::string_view zero;
  std::string_view valueScalar;
  std::string_view valueVector;
  std::string_view load;
  std::string_view store;
};

// Normalized values are always recomputed from their integers, even if the device converts them, because that
// is exact.
constexpr std::array<Spelling, 16> spellings = {{
    /* Bool    */ {"usampler2D", "uint", "uvec", "0u", "bool", "bvec", "{1}({0})", "{1}({0})"},
    /* Int     */ {"isampler2D", "int", "ivec", "0", "int", "ivec", "", ""},
    /* Uint    */ {"usampler2D", "uint", "uvec", "0u", "uint", "uvec", "", ""},
    /* Float   */ {"sampler2D", "float", "vec", "0.0", "float", "vec", "", ""},
    /* Double  */
    {"usampler2D", "uint", "uvec", "0u", "sk_double", "sk_double", "sk_unpack({0})", "sk_pack({0})"},
    /* Long    */
    {"usampler2D", "uint", "uvec", "0u", "sk_long", "sk_long", "sk_long_of({0})", "sk_words_of({0})"},
    /* Ulong   */
    {"usampler2D", "uint", "uvec", "0u", "sk_ulong", "sk_ulong", "sk_ulong_of({0})", "sk_words_of({0})"},
    /* Half    */ {"sampler2D", "float", "vec", "0.0", "float", "vec", "", ""},
    /* Char    */ {"isampler2D", "int", "ivec", "0", "int", "ivec", "", ""},
    /* Uchar   */ {"usampler2D", "uint", "uvec", "0u", "int", "ivec", "{1}({0})", "{1}({0})"},
    /* Short   */ {"isampler2D", "int", "ivec", "0", "int", "ivec", "", ""},
    /* Ushort  */ {"usampler2D", "uint", "uvec", "0u", "int", "ivec", "{1}({0})", "{1}({0})"},
    /* Unorm8  */
    {"sampler2D", "float", "vec", "0.0", "float", "vec", "$qroundEven($({0} * 255.0$))$Q8$", ""},
    /* Snorm8  */
    {"isampler2D", "int", "ivec", "0", "float", "vec", "max($q{1}({0})$Q7$, -1.0)",
     "{1}(roundEven($({0}$) * 127.0))"},
    /* Unorm16 */
    {"usampler2D", "uint", "uvec", "0u", "float", "vec", "$q{1}({0})$Q16$",
     "{1}(roundEven($({0}$) * 65535.0))"},
    /* Snorm16 */
    {"isampler2D", "int", "ivec", "0", "float", "vec", "max($q{1}({0})$Q15$, -1.0)",
     "{1}(roundEven($({0}$) * 32767.0))"},
}};

const program::Layer ownTexture;

const program::Layer& layerOf(const Parameter& parameter, std::size_t plane) {
  return parameter.layers.empty() ? ownTexture : parameter.layers[plane];
}

/// The first plane that a parameter writes, and the end of the range.
std::pair<std::size_t, std::size_t> writtenPlanes(const Parameter& parameter) {
  if (parameter.planeCount == 0) return {0, heldBy(parameter).fields.size()};
  return {parameter.firstPlane, std::size_t{parameter.firstPlane} + parameter.planeCount};
}

const Spelling& spelling(const Field& field) { return spellings[static_cast<std::size_t>(field.scalar)]; }

std::string sized(std::string_view scalar, std::string_view vector, int width) {
  return width == 1 ? std::string(scalar) : fmt::format("{}{}", vector, width);
}

std::string texelType(const Field& field, int width) {
  return sized(spelling(field).texelScalar, spelling(field).texelVector, width);
}

std::string valueType(const Field& field) {
  return sized(spelling(field).valueScalar, spelling(field).valueVector, field.width);
}

/// Substitutes the operand and the result's type in `pattern`; an empty pattern gives the operand.
std::string converted(std::string_view pattern, std::string operand, const std::string& type) {
  if (pattern.empty()) return operand;
  return fmt::format(fmt::runtime(pattern), operand, type);
}

/// Components of a texel. A wide scalar takes two.
int texelWidth(const Field& field) { return program::is64Bit(field.scalar) ? 2 * field.width : field.width; }

std::string memberOf(std::string_view variable, const Field& field) {
  std::string text(variable);
  if (!field.path.empty()) text += fmt::format(".{}", field.path);
  return text;
}

/// The components in a part of a vector of wide scalars.
char firstComponent(const Field& field) { return "xz"[field.part]; }
char secondComponent(const Field& field) { return "yw"[field.part]; }

/// The value of a field of the element in `variable`.
std::string valueOf(std::string_view variable, const Field& field) {
  const std::string member = memberOf(variable, field);
  if (field.part < 0) return member;
  if (!program::is64Bit(field.scalar)) return fmt::format("{}[{}]", member, field.part);
  if (field.width == 1) return fmt::format("{}.{}", member, firstComponent(field));
  return fmt::format("{3}({0}.{1}, {0}.{2})", member, firstComponent(field), secondComponent(field),
                     valueType(field));
}

/// Adds statements that assign `value` to a field of the element in `variable`.
void assignField(std::vector<std::string>& statements, std::string_view variable, const Field& field,
                 std::string_view value) {
  if (!program::is64Bit(field.scalar) || field.part < 0 || field.width == 1) {
    statements.push_back(fmt::format("{} = {};", valueOf(variable, field), value));
    return;
  }
  // a unique name, because a struct may have several such vectors
  const std::string two = fmt::format("sk_two{}", statements.size());
  const std::string member = memberOf(variable, field);
  statements.push_back(fmt::format("{} {} = {};", valueType(field), two, value));
  statements.push_back(fmt::format("{}.{} = {}.x;", member, firstComponent(field), two));
  statements.push_back(fmt::format("{}.{} = {}.y;", member, secondComponent(field), two));
}

/// Textures of 3 components cannot be rendered to: such planes have 4.
int outputWidth(const Field& field) { return field.width == 3 ? 4 : texelWidth(field); }

std::string planeName(std::string_view prefix, const Parameter& parameter, std::size_t plane) {
  if (heldBy(parameter).fields.size() == 1) return fmt::format("{}_{}", prefix, parameter.symbol);
  return fmt::format("{}{}_{}", prefix, plane, parameter.symbol);
}

std::string outputName(const Parameter& parameter, std::size_t plane) {
  return planeName("sk_out", parameter, plane);
}

/// In a stack, the first layers of all planes precede their second layers.
std::string placeOfPlane(ProgramText& program, const Parameter& parameter, std::size_t plane,
                         const Texel& texel) {
  const program::Layer& layer = layerOf(parameter, plane);
  if (layer.stack < 0) return place(program, texel);
  if (texel.shift.empty()) return fmt::format("ivec3({}, {})", texel.at, layer.layer);
  return fmt::format("{} * ivec3(1, 1, {}) + ivec3(0, 0, {})", place(program, texel), layer.count,
                     layer.layer);
}

/// The scalar of the program's value for a field of the stream.
Scalar valueScalar(const Parameter& parameter, const Field& field) {
  if (parameter.held == nullptr) return field.scalar;
  const auto same = std::ranges::find(parameter.element->fields, field.path, &Field::path);
  return same->scalar;
}

bool isFloating(Scalar scalar) { return scalar == Scalar::Float || scalar == Scalar::Half; }

/// Whether the stream holds floats or halves that the program converts to doubles.
bool isWidened(const Parameter& parameter, const Field& field) {
  return isFloating(field.scalar) && valueScalar(parameter, field) == Scalar::Double;
}

/// Whether the stream holds doubles that the program converts to floats.
bool isNarrowed(const Parameter& parameter, const Field& field) {
  return field.scalar == Scalar::Double && valueScalar(parameter, field) == Scalar::Float;
}

/// The components of a vector of floats that a plane of doubles holds: the program has such vectors in one
/// piece.
std::string partOf(std::string_view variable, const Field& field) {
  static constexpr std::array<std::array<std::string_view, 2>, 2> swizzles = {{{".x", ".xy"}, {".z", ".zw"}}};
  std::string member = memberOf(variable, field);
  if (field.part >= 0) member += swizzles[static_cast<std::size_t>(field.part)][field.width - 1u];
  return member;
}

/// Rounds to half, to nearest, ties to even, because drivers round differently.
std::string halved(ProgramText& program, const Field& field, const std::string& value) {
  program.require(Function::ToHalf);
  if (field.width == 1) return fmt::format("sk_to_half({})", value);
  const std::string signature = fmt::format("vec{0} sk_to_half{0}(vec{0} sk_v)", field.width);
  if (!program.isDefined(signature)) {
    std::vector<std::string> parts;
    for (int c = 0; c < field.width; ++c) parts.push_back(fmt::format("sk_to_half(sk_v.{})", "xyzw"[c]));
    program.function(signature, {fmt::format("return vec{}({});", field.width, fmt::join(parts, ", "))});
  }
  return fmt::format("sk_to_half{}({})", field.width, value);
}

/// Converts a float or a vector of floats to doubles.
std::string widened(ProgramText& program, const Field& field, const std::string& value) {
  if (field.width == 1) return fmt::format("sk_to_double({})", value);
  const std::string signature = fmt::format("sk_double{0} sk_widen{0}(vec{0} sk_v)", field.width);
  if (!program.isDefined(signature)) {
    std::vector<std::string> parts;
    for (int c = 0; c < field.width; ++c) parts.push_back(fmt::format("sk_to_double(sk_v.{})", "xyzw"[c]));
    program.function(signature,
                     {fmt::format("return sk_double{}({});", field.width, fmt::join(parts, ", "))});
  }
  return fmt::format("sk_widen{}({})", field.width, value);
}

/// Converts doubles to a float or a vector of floats, or to floats that are rounded once more, to half.
std::string narrowed(ProgramText& program, const Field& field, const std::string& value) {
  const bool isRoundedAgain = field.scalar == Scalar::Half;
  const std::string_view one = isRoundedAgain ? "sk_to_odd" : "sk_to_float";
  if (field.width == 1) return fmt::format("{}({})", one, value);
  const std::string all = fmt::format("sk_{}{}", isRoundedAgain ? "odd" : "narrow", field.width);
  const std::string signature = fmt::format("vec{0} {1}(sk_double{0} sk_v)", field.width, all);
  if (!program.isDefined(signature)) {
    std::vector<std::string> parts;
    for (int c = 0; c < field.width; ++c) parts.push_back(fmt::format("{}(sk_v.{})", one, "xyzw"[c]));
    program.function(signature, {fmt::format("return vec{}({});", field.width, fmt::join(parts, ", "))});
  }
  return fmt::format("{}({})", all, value);
}

/// Converts the contents of a plane's texel to the program's value.
std::string fetchedValue(ProgramText& program, const Parameter& parameter, const Field& field,
                         std::string value) {
  if (field.scalar == Scalar::Bool) {
    return field.width == 1 ? value + " != 0u" : fmt::format("notEqual({}, uvec{}(0u))", value, field.width);
  }
  if (isWidened(parameter, field)) return widened(program, field, value);
  if (isNarrowed(parameter, field) && program.keepsDenormals())
    return fmt::format("sk_nearest_float({})", value);
  value = converted(spelling(field).load, std::move(value), valueType(field));
  return isNarrowed(parameter, field) ? narrowed(program, field, value) : value;
}

/// Elements of four components, one for each scalar.
class FourElements {
 public:
  FourElements() {
    for (std::size_t i = 0; i < elements_.size(); ++i) {
      const auto scalar = static_cast<Scalar>(i);
      types_[i] = fmt::format("{}4", spellings[i].valueVector);
      fields_[i] = {"", scalar, lanes, 0};
      elements_[i] = {"texel",
                      types_[i],
                      static_cast<std::uint32_t>(lanes * program::hostBytes(scalar)),
                      {&fields_[i], 1}};
    }
  }
  const Element& of(Scalar scalar) const { return elements_[static_cast<std::size_t>(scalar)]; }

 private:
  std::array<std::string, spellings.size()> types_;
  std::array<Field, spellings.size()> fields_;
  std::array<Element, spellings.size()> elements_;
};

/// Fetches the whole texel of a plane.
std::string fetchWhole(ProgramText& program, const Parameter& parameter, std::size_t plane,
                       const Texel& texel) {
  const std::string name = samplerName(parameter, plane);
  const std::string at = placeOfPlane(program, parameter, plane, texel);
  const bool isArray = !texel.shift.empty() || layerOf(parameter, plane).stack >= 0;
  return texel.filtered ? fmt::format("texelFetch({}, {}, 0)", name, at)
                        : texelIn(program, name, at, isArray);
}

std::string fetchPlane(ProgramText& program, const Parameter& parameter, std::size_t plane,
                       const Texel& texel) {
  static constexpr std::array<std::string_view, 4> swizzles = {".x", ".xy", ".xyz", ""};
  const Field& field = heldBy(parameter).fields[plane];
  return fetchedValue(program, parameter, field,
                      fetchWhole(program, parameter, plane, texel) +
                          std::string(swizzles[static_cast<std::size_t>(texelWidth(field) - 1)]));
}

/// Converts `value` from the field's type to its output's type.
std::string toOutput(const Field& field, std::string value) {
  value = converted(spelling(field).store, std::move(value), texelType(field, texelWidth(field)));
  if (field.width == 3) value = fmt::format("{}({}, {})", texelType(field, 4), value, spelling(field).zero);
  return value;
}

bool outputHasType(const Parameter& parameter) {
  const Element& element = *parameter.element;
  const Field& field = element.fields.front();
  return parameter.held == nullptr && !isStruct(element) && spelling(field).store.empty() && field.width != 3;
}

}  // namespace

std::string stackName(std::size_t stack) { return fmt::format("sk_stack{}", stack); }

std::string samplerName(const Parameter& parameter, std::size_t plane) {
  const program::Layer& layer = layerOf(parameter, plane);
  if (layer.stack >= 0) return stackName(static_cast<std::size_t>(layer.stack));
  return planeName("sk_tex", parameter, plane);
}

bool isStruct(const Element& element) {
  const Field& first = element.fields.front();
  return !first.path.empty() || first.part >= 0;
}

std::string place(ProgramText& program, const Texel& texel) {
  if (texel.shift.empty()) return texel.at;
  program.require(Function::Layered);
  return fmt::format("sk_layered({}, {})", texel.at, texel.shift);
}

std::string texelIn(ProgramText& program, std::string_view sampler, const std::string& place, bool isArray) {
  if (!program.samples() || isArray) return fmt::format("texelFetch({}, {}, 0)", sampler, place);
  program.require(Function::Sampled);
  return fmt::format("sk_sampled({}, {})", sampler, place);
}

std::string samplerType(std::string_view sampler, bool isArray) {
  return isArray ? fmt::format("highp {}Array", sampler) : std::string(sampler);
}

void declareSamplers(ProgramText& program, const Parameter& parameter, bool layered) {
  for (std::size_t plane = 0; plane < heldBy(parameter).fields.size(); ++plane) {
    const std::string_view sampler = spelling(heldBy(parameter).fields[plane]).sampler;
    const bool isArray = layered || layerOf(parameter, plane).stack >= 0;
    program.uniform(samplerType(sampler, isArray), samplerName(parameter, plane));
  }
}

void declareOutputs(ProgramText& program, const Parameter& parameter) {
  const auto [first, end] = writtenPlanes(parameter);
  for (std::size_t plane = first; plane < end; ++plane) {
    const Field& field = heldBy(parameter).fields[plane];
    program.output(texelType(field, outputWidth(field)), outputName(parameter, plane), imageFormat(field));
  }
}

std::vector<Parameter> withPlanes(const std::vector<const Parameter*>& outputs, std::size_t first,
                                  std::size_t count) {
  std::vector<Parameter> written;
  std::size_t before = 0;  // planes of the previous outputs
  const std::size_t end = count == 0 ? SIZE_MAX : first + count;
  for (const Parameter* output : outputs) {
    const std::size_t after = before + output->element->fields.size();
    const std::size_t from = std::max(first, before);
    const std::size_t to = std::min(end, after);
    if (from < to) {
      written.push_back(*output);
      written.back().firstPlane = static_cast<std::uint8_t>(from - before);
      written.back().planeCount = static_cast<std::uint8_t>(to - from);
    }
    before = after;
  }
  return written;
}

std::string fetch(ProgramText& program, const Parameter& parameter, const Texel& texel) {
  const Element& element = heldBy(parameter);
  const std::string_view type = parameter.element->glsl;
  if (texel.packed) {
    Texel four = texel;
    four.at = "ivec2(sk_t.x >> 2, sk_t.y)";
    const std::string whole = fetchWhole(program, parameter, 0, four);
    program.function(fmt::format("{} sk_fetch_{}(ivec2 sk_t)", type, parameter.symbol),
                     {fmt::format("return {};", fetchedComponent(program, parameter, whole, "sk_t.x & 3"))});
    return fmt::format("sk_fetch_{}({})", parameter.symbol, texel.at);
  }
  if (!isStruct(element)) return fetchPlane(program, parameter, 0, texel);
  std::vector<std::string> statements = {fmt::format("{} sk_e;", type)};
  for (std::size_t plane = 0; plane < element.fields.size(); ++plane) {
    const Field& field = element.fields[plane];
    Texel here = texel;
    here.at = "sk_t";
    const std::string value = fetchPlane(program, parameter, plane, here);
    if (isNarrowed(parameter, field)) {
      statements.push_back(fmt::format("{} = {};", partOf("sk_e", field), value));
    } else {
      assignField(statements, "sk_e", field, value);
    }
  }
  statements.emplace_back("return sk_e;");
  program.function(fmt::format("{} sk_fetch_{}(ivec2 sk_t)", type, parameter.symbol), statements);
  return fmt::format("sk_fetch_{}({})", parameter.symbol, texel.at);
}

std::string fetchedComponent(ProgramText& program, const Parameter& parameter, std::string_view texel,
                             std::string_view component) {
  return fetchedValue(program, parameter, heldBy(parameter).fields.front(),
                      fmt::format("{}[{}]", texel, component));
}

std::string packedType(const Parameter& parameter) {
  return texelType(heldBy(parameter).fields.front(), lanes);
}

const Element& fourOf(Scalar scalar) {
  static const FourElements elements;
  return elements.of(scalar);
}

Parameter fourOf(const Parameter& parameter) {
  Parameter four = parameter;
  four.element = &fourOf(parameter.element->fields.front().scalar);
  if (parameter.held != nullptr) four.held = &fourOf(parameter.held->fields.front().scalar);
  return four;
}

std::string resultVariable(ProgramText& program, const Parameter& parameter) {
  if (outputHasType(parameter)) return outputName(parameter, 0);
  const std::string name = fmt::format("sk_value_{}", parameter.symbol);
  program.statement(fmt::format("{} {};", parameter.element->glsl, name));
  return name;
}

void copyPlanes(ProgramText& program, const Parameter& parameter, const Texel& texel) {
  static constexpr std::array<std::string_view, 5> swizzles = {"", ".x", ".xy", "", ""};
  declareSamplers(program, parameter, !texel.shift.empty());
  declareOutputs(program, parameter);
  for (std::size_t plane = 0; plane < heldBy(parameter).fields.size(); ++plane) {
    program.statement(fmt::format(
        "{} = {}{};", outputName(parameter, plane),
        texelIn(program, samplerName(parameter, plane), place(program, texel), !texel.shift.empty()),
        swizzles[static_cast<std::size_t>(texelWidth(heldBy(parameter).fields[plane]))]));
  }
}

void store(ProgramText& program, const Parameter& parameter, std::string_view variable,
           std::string_view indent) {
  const Element& element = heldBy(parameter);
  const auto [first, end] = writtenPlanes(parameter);
  for (std::size_t plane = first; plane < end; ++plane) {
    const Field& field = element.fields[plane];
    const std::string output = outputName(parameter, plane);
    if (output == variable) continue;
    const bool isWhole = !isNarrowed(parameter, field);
    std::string value = isWhole ? valueOf(variable, field) : widened(program, field, partOf(variable, field));
    if (isWidened(parameter, field)) value = narrowed(program, field, value);
    if (field.scalar == Scalar::Half && parameter.held != nullptr) value = halved(program, field, value);
    program.statement(fmt::format("{}{} = {};", indent, output, toOutput(field, std::move(value))));
  }
}

namespace {

/// Adds the planes of a float field: one of halves, or several of doubles, with two doubles per texel.
void addFields(const Field& field, Storage storage, std::vector<Field>& fields) {
  const bool isRow = field.part >= 0;  // of a matrix
  if (field.scalar != Scalar::Float || isRow) {
    fields.push_back(field);
    return;
  }
  Field held = field;
  held.scalar = storage == Storage::Half ? Scalar::Half : Scalar::Double;
  if (storage == Storage::Half || field.width <= 2) {
    fields.push_back(held);
    return;
  }
  for (int part = 0; 2 * part < field.width; ++part) {
    held.part = static_cast<std::int8_t>(part);
    held.width = static_cast<std::uint8_t>(std::min(2, field.width - 2 * part));
    fields.push_back(held);
  }
}

}  // namespace

HeldElement::HeldElement(const Element& declared, Storage storage) : element(declared) {
  for (const Field& field : declared.fields) addFields(field, storage, fields);
  std::uint32_t end = 0;
  for (Field& field : fields) {
    field.offset = end;
    end += static_cast<std::uint32_t>(program::hostBytes(field.scalar)) * field.width;
  }
  element.fields = fields;
  element.size = end;
}

bool holdsFloats(const Element& element) {
  return std::ranges::any_of(
      element.fields, [](const Field& field) { return field.scalar == Scalar::Float && field.part < 0; });
}

HeldKernel::HeldKernel(const Kernel& kernel, std::span<const StreamAccess> access)
    : kernel_(kernel), parameters_(kernel.parameters.begin(), kernel.parameters.end()) {
  for (std::size_t i = 0; i < access.size(); ++i) {
    if (access[i].storage == Storage::Single) continue;
    const Element& plain = heldBy(parameters_[i]);
    parameters_[i].held =
        &elements_.emplace_back(std::make_unique<HeldElement>(plain, access[i].storage))->element;
    kernel_.usesDoubles = kernel_.usesDoubles || access[i].storage != Storage::Half;
  }
  if (!elements_.empty()) kernel_.parameters = parameters_;
}

}  // namespace sk::assemble
