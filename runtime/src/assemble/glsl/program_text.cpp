// SPDX-License-Identifier: MIT
//
// Joins the sections of a program.
// The GLSL functions that assembled programs share (functions.glsl).
#include "assemble/glsl/program_text.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "assemble/glsl/double_intrinsics.hpp"
#include "assemble/glsl/intrinsics.hpp"
#include "assemble/glsl/longs.hpp"
#include "assemble/glsl/own_arithmetic.hpp"
#include "assemble/glsl/tables.hpp"
#include "glsl_text/functions.hpp"
#include "glsl_text/loop_check.hpp"

namespace sk::assemble {
namespace {

constexpr std::size_t lineLength = 100;

constexpr std::uint32_t bit(Function function) { return 1u << static_cast<unsigned>(function); }

void addOnce(std::vector<std::string>& lines, std::string line) {
  if (std::ranges::find(lines, line) == lines.end()) lines.push_back(std::move(line));
}

/// Adds text with line numbers of its own, and then resumes the numbering of the program.
void addForeign(std::string& program, std::string_view text) {
  if (text.empty()) return;
  program += '\n';
  program += text;
  if (!text.ends_with('\n')) program += '\n';
  const auto next = std::ranges::count(program, '\n') + 2;
  fmt::format_to(std::back_inserter(program), "#line {} 0\n", next);
}

void addLines(std::string& program, const std::vector<std::string>& lines) {
  for (const std::string& line : lines) program += line + '\n';
}

/// Adds the functions of the set in order; of the unravelling functions, only the highest.
void addFunctions(std::string& program, std::uint32_t set) {
  if (set & bit(Function::Unravel4)) set &= ~(bit(Function::Unravel2) | bit(Function::Unravel3));
  if (set & bit(Function::Unravel3)) set &= ~bit(Function::Unravel2);
  for (unsigned i = 0; set >> i != 0; ++i) {
    if (set >> i & 1u) program += text(static_cast<Function>(i));
  }
}

/// Components of a texel's type: "vec2", "uint" ...
int componentsOf(std::string_view type) {
  const char last = type.back();
  return last >= '2' && last <= '4' ? last - '0' : 1;
}

std::string_view imageType(std::string_view texel, bool isArray) {
  switch (texel.front()) {
    case 'i': return isArray ? "iimage2DArray" : "iimage2D";
    case 'u': return isArray ? "uimage2DArray" : "uimage2D";
    default: return isArray ? "image2DArray" : "image2D";
  }
}

std::string_view vectorOf(std::string_view texel) {
  return texel.front() == 'i' ? "ivec4" : texel.front() == 'u' ? "uvec4" : "vec4";
}

/// A value of four components, as imageStore() requires; it ignores those that the image lacks.
std::string wholeTexel(std::string_view type, std::string_view value) {
  const int components = componentsOf(type);
  if (components == 4) return std::string(value);
  const std::string_view vector = vectorOf(type);
  if (components == 1) return fmt::format("{}({})", vector, value);
  const std::string_view zero = vector == "ivec4" ? "0" : vector == "uvec4" ? "0u" : "0.0";
  return fmt::format("{}({}, {}, {})", vector, value, zero, zero);
}

/// The size of a work group.
std::pair<int, int> groupForTexels(int components) {
  return components == 4 ? groupOfWideTexels : std::pair(16, 16);
}

/// What buffers that draws write take in GLSL 3.30. Profile::version has them in compute programs, and in ES.
std::string_view loopCheckExtensions(const Profile& profile) {
  if (profile.es || profile.stage == Stage::Compute) return {};
  return "#extension GL_ARB_shader_storage_buffer_object : require\n"
         "#extension GL_ARB_shading_language_420pack : require\n";
}

constexpr std::string_view esPrecision =
    "precision highp float;\n"
    "precision highp int;\n"
    "precision highp sampler2D;\n"
    "precision highp isampler2D;\n"
    "precision highp usampler2D;\n";
constexpr std::string_view esPrecisionOfImages =
    "precision highp image2D;\n"
    "precision highp iimage2D;\n"
    "precision highp uimage2D;\n"
    "precision highp image2DArray;\n"
    "precision highp iimage2DArray;\n"
    "precision highp uimage2DArray;\n";

/// The format of an image of 32 bits with the components of a texel's type.
std::string plainFormat(std::string_view texel) {
  const std::string_view kind = texel.front() == 'i' ? "i" : texel.front() == 'u' ? "ui" : "f";
  return fmt::format("{}32{}",
                     std::string_view("rgba").substr(0, static_cast<std::size_t>(componentsOf(texel))), kind);
}

}  // namespace

std::string ProgramText::uniform(std::string_view type, std::string_view name) {
  if (relaysUniforms_ && relayed_.take(type, name)) {
    flatInput(type, relayedName(name));
    return relayedName(name);
  }
  addOnce(uniforms_, fmt::format("uniform {} {};", type, name));
  return std::string(name);
}

void ProgramText::flatInput(std::string_view type, std::string_view name) {
  addOnce(uniforms_, fmt::format("flat in {} {};", type, name));
}

void ProgramText::output(std::string_view type, std::string_view name, std::string_view format) {
  outputs_.push_back({.type = std::string(type),
                      .name = std::string(name),
                      .format = format.empty() ? plainFormat(type) : std::string(format)});
}

void ProgramText::storeAt(std::string_view place, bool isArray) {
  place_ = place;
  isArray_ = isArray;
}

void ProgramText::storeInBuffer() { isInBuffer_ = true; }

void ProgramText::dispatchGroups(std::int32_t width, std::int32_t height, bool storesApart) {
  group_ = {width, height};
  storesApart_ = storesApart;
}

void ProgramText::foldTiles(std::pair<int, int> group, std::vector<std::string> before,
                            std::vector<std::string> after) {
  beforeTiles_ = std::move(before);
  afterTiles_ = std::move(after);
  groupOfTiles_ = group;
  takeManyIterations();  // the number of tiles depends on the domain
}

std::pair<int, int> ProgramText::groupOfTexels() const {
  return groupForTexels(outputs_.empty() ? 1 : componentsOf(outputs_.front().type));
}

void ProgramText::storeLater(std::size_t first) {
  for (std::size_t i = first; i < outputs_.size(); ++i) outputs_[i].isStoredLater = true;
}

void ProgramText::makeAtomic(std::size_t output, std::string_view format) {
  outputs_[output].atomicFormat = format;
}

std::string ProgramText::storeOf(std::size_t output, std::string_view place) const {
  const auto& [type, name, isStoredLater, atomicFormat, format] = outputs_[output];
  return fmt::format("imageStore(sk_image{}, {}, {});", output, place, wholeTexel(type, name));
}

std::vector<std::string> ProgramText::storesOf(std::size_t first, std::size_t end,
                                               std::string_view place) const {
  std::vector<std::string> stores;
  for (std::size_t i = first; i < end; ++i) stores.push_back(storeOf(i, place));
  return stores;
}

std::vector<std::string> ProgramText::storing(std::string_view place, bool isArray) {
  storeLater(0);
  isArray_ = isArray;
  return storesOf(0, outputs_.size(), place);
}

void ProgramText::buffer(std::string_view declaration) {
  addOnce(variables_, fmt::format("layout(std430, binding = 0) {};", declaration));
}

void ProgramText::variable(std::string_view type, std::string_view name) {
  addOnce(variables_, fmt::format("{} {};", type, name));
}

void ProgramText::require(Function function) { used_ |= bit(function); }

void ProgramText::function(std::string_view signature, const std::vector<std::string>& statements) {
  if (isDefined(signature)) return;
  signatures_.emplace_back(signature);
  fmt::format_to(std::back_inserter(functions_), "\n{} {{\n", signature);
  for (const std::string& line : statements) functions_ += "  " + line + '\n';
  functions_ += "}\n";
}

void ProgramText::defineWith(std::string_view signature, std::string_view lines) {
  signatures_.emplace_back(signature);
  fmt::format_to(std::back_inserter(functions_), "\n{} {{\n{}}}\n", signature, lines);
}

bool ProgramText::isDefined(std::string_view signature) const {
  return std::ranges::find(signatures_, signature) != signatures_.end();
}

void ProgramText::statement(std::string_view line) {
  fmt::format_to(std::back_inserter(main_), "  {}\n", line);
}

void ProgramText::prologue(std::string_view line) {
  fmt::format_to(std::back_inserter(prologue_), "  {}\n", line);
}

void ProgramText::together(std::string_view line) {
  require(Function::Local);
  fmt::format_to(std::back_inserter(together_), "  {}\n", line);
}

void ProgramText::keepTogether(std::string_view line) {
  fmt::format_to(std::back_inserter(keptTogether_), "  {}\n", line);
}

bool ProgramText::takeShared(std::size_t bytes) {
  if (shared_ + bytes > groupBytes) return false;
  shared_ += bytes;
  return true;
}

void ProgramText::foreign(std::string_view text) { foreign_ += text; }

std::string ProgramText::finish(const Profile& profile, std::string_view comment,
                                const program::Kernel& kernel) const {
  std::string program = fmt::format("{}\n// {}\n", profile.version, comment);
  const IntrinsicTexts intrinsics = intrinsicTexts(kernel.intrinsics, profile.accurate);
  const bool hasPreciseDoubles = kernel.usesDoubles && profile.doubles == Doubles::Native &&
                                 barrierOfBodies(profile) == Barrier::Precise;
  const auto textOf = [&](std::string_view text) { return bodyText(profile, text); };
  const std::string body = textOf(kernel.body), declarations = textOf(kernel.declarations);
  const std::string more = textOf(foreign_), ours = textOf(ownText()),
                    main = textOf(mainOf(prologue_ + main_));
  const auto guards = [&](std::string_view text) { return guardsOperations(profile, text); };
  const bool hasExactFloats = hasPreciseDoubles || guards(body) || guards(declarations) || guards(more) ||
                              guards(main) || guards(ours) || kernel.usesExactSums ||
                              intrinsics.useExactFloats || callDoubleIntrinsics(kernel.intrinsics) ||
                              (kernel.usesDoubles && profile.doubles == Doubles::Pairs);
  program += extensions_;
  if (declaresFormats_ && !isInBuffer_) program += extensionsOfImages(profile);
  if (kernel.usesDoubles) program += doubleExtensions(profile.doubles);
  if (hasExactFloats) program += exactExtensions(profile);
  const bool hasLoopCheck = profile.checksLoops && (kernel.usesLoops || takesManyIterations_);
  if (hasLoopCheck) program += loopCheckExtensions(profile);
  const auto multiplies = [](std::string_view text) {
    return text.find("sk_mulhi(") != std::string_view::npos;
  };
  if (!profile.highProducts && (multiplies(body) || multiplies(declarations) || multiplies(more)))
    program += "#define SK_WITHOUT_HIGH_PRODUCTS\n";
  program += precisionStatements(profile);
  if (hasExactFloats) program += exactDefinitions(profile.barrier);
  if (kernel.usesDoubles) program += doubleDefinitions(profile.doubles, barrierOfBodies(profile));
  if (kernel.usesLongs) program += longDefinitions(kernel.usesDoubles);
  program += doubleIntrinsicDefinitions(kernel.intrinsics, profile.doubles, profile.barrier);
  program += intrinsics.definitions;
  program += fractionDefinitions(declarations + ours + body + more + main);
  addForeign(program, declarations);
  program += '\n';
  program += ours;
  program += tableDefinitions(kernel.tables, profile.tables);
  program += bodyDefinitions(profile, body + more + main);
  addForeign(program, body);
  addForeign(program, more);
  if (!hasLoopCheck) return program + main;
  program += library::loopCheckBegin;
  program += main;
  program += isDrawn() ? library::loopCheckOfDraw : library::loopCheckOfDispatch;
  return program + std::string(library::loopCheckEnd);
}

std::string ProgramText::extensionsOfImages(const Profile& profile) const {
  std::vector<std::string> formats;
  bool areAtomic = false;
  for (const Output& output : outputs_) {
    areAtomic = areAtomic || !output.atomicFormat.empty();
    formats.push_back(output.atomicFormat.empty() ? output.format : output.atomicFormat);
  }
  std::string text(formatExtension(profile, formats));
  if (areAtomic) text += "#extension GL_OES_shader_image_atomic : require\n";
  return text;
}

std::string ProgramText::ownText() const {
  std::string text;
  if (!isDrawn()) text += "uniform ivec4 sk_rect;\n";
  addLines(text, uniforms_);
  text += declarationOfOutputs();
  if (!isDrawn()) text += "ivec2 sk_pixel;\n";
  addLines(text, variables_);
  addFunctions(text, used_);
  return text + functions_;
}

/// Outputs are variables in both stages; compute programs then copy them to images or to a buffer.
std::string ProgramText::declarationOfOutputs() const {
  std::string text = isInBuffer_ ? declarationOfBuffer() : std::string();
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    const auto& [type, name, isStoredLater, atomicFormat, format] = outputs_[i];
    if (isDrawn()) {
      fmt::format_to(std::back_inserter(text), "layout(location = {}) out {} {};\n", i, type, name);
    } else {
      if (!atomicFormat.empty())
        fmt::format_to(std::back_inserter(text), "layout(binding = {}, {}) uniform {} sk_image{};\n", i,
                       atomicFormat, imageType(type, false), i);
      else if (!isInBuffer_)
        fmt::format_to(std::back_inserter(text),
                       "layout(binding = {}{}{}) writeonly uniform {} sk_image{};\n", i,
                       declaresFormats_ ? ", " : "", declaresFormats_ ? std::string_view(format) : "",
                       imageType(type, isArray_), i);
      fmt::format_to(std::back_inserter(text), "{} {};\n", type, name);
    }
  }
  return text;
}

std::string ProgramText::declarationOfBuffer() const {
  std::string text = "layout(std430, binding = 0) writeonly buffer sk_values {\n";
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    fmt::format_to(std::back_inserter(text), "  {} sk_value{};\n", vectorOf(outputs_[i].type), i);
  }
  return text + "};\n";
}

/// Invocations outside the rectangle, which fill the last work groups, return immediately.
std::string ProgramText::mainOf(const std::string& body) const {
  if (isDrawn()) return "\nvoid main() {\n" + body + "}\n";
  if (!mainOfGroups_.empty()) return "\nvoid sk_run() {\n" + body + storesAtEnd() + "}\n" + mainOfGroups_;
  if (groupOfTiles_.first > 0) return mainOfTiles(body);
  const bool isGrouped = group_.first > 0;
  const auto [width, height] = isGrouped ? group_ : groupOfTexels();
  std::string text =
      fmt::format("\nlayout(local_size_x = {}, local_size_y = {}) in;\n\nvoid main() {{\n", width, height);
  if (isGrouped) {
    text += "  sk_pixel = sk_rect.xy + ivec2(gl_WorkGroupID.xy);\n" + body;
    if (storesAtEnd().empty()) return text + "}\n";
    if (!storesApart_) text += "  if (gl_LocalInvocationIndex != 0u) return;\n";
  } else if (together_.empty()) {
    text += "  sk_pixel = sk_rect.xy + ivec2(gl_GlobalInvocationID.xy);\n";
    text += "  if (any(greaterThanEqual(ivec2(gl_GlobalInvocationID.xy), sk_rect.zw))) return;\n" + body;
  } else {
    text += fmt::format("  sk_pixel = sk_rect.xy + ivec2(gl_WorkGroupID.xy) * ivec2({}, {}) + sk_local();\n",
                        width, height);
    text += together_ + keptTogether_ + "  memoryBarrierShared();\n  barrier();\n";
    text += "  if (any(greaterThanEqual(sk_pixel - sk_rect.xy, sk_rect.zw))) return;\n" + body;
  }
  return text + storesAtEnd() + "}\n";
}

/// All invocations of a group combine what they have folded, also those outside the rectangle.
std::string ProgramText::mainOfTiles(const std::string& body) const {
  const auto [width, height] = groupOfTiles_;
  const bool isTogether = !together_.empty();
  std::string text = "\nvoid sk_run() {\n" + body + storesAtEnd() + "}\n";
  fmt::format_to(std::back_inserter(text),
                 "\nlayout(local_size_x = {}, local_size_y = {}) in;\n\nvoid main() {{\n", width, height);
  for (const std::string& line : beforeTiles_) text += "  " + line + '\n';
  text += "  for (int sk_tile = 0; sk_tile < sk_groups.y; ++sk_tile) {\n";
  fmt::format_to(
      std::back_inserter(text),
      "  sk_pixel = sk_rect.xy + ivec2(gl_WorkGroupID.x, int(gl_WorkGroupID.y) * sk_groups.y + sk_tile) * "
      "ivec2({}, {}) + {};\n",
      width, height, isTogether ? "sk_local()" : "ivec2(gl_LocalInvocationID.xy)");
  if (isTogether) text += together_ + keptTogether_ + "  memoryBarrierShared();\n  barrier();\n";
  text += "  if (all(lessThan(sk_pixel - sk_rect.xy, sk_rect.zw))) sk_run();\n";
  if (isTogether) text += "  barrier();\n";  // the next tile replaces what has been read
  text += "  }\n";
  for (const std::string& line : afterTiles_) text += "  " + line + '\n';
  return text + "}\n";
}

std::string ProgramText::storesAtEnd() const {
  std::string text;
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    if (isInBuffer_) {
      fmt::format_to(std::back_inserter(text), "  sk_value{} = {};\n", i,
                     wholeTexel(outputs_[i].type, outputs_[i].name));
    } else if (!outputs_[i].isStoredLater) {
      fmt::format_to(std::back_inserter(text), "  {}\n", storeOf(i, place_));
    }
  }
  return text;
}

std::string_view formatExtension(const Profile& profile, std::span<const std::string> formats) {
  Profile plain = profile;
  plain.storesAllFormats = false;
  const bool needsMore =
      !std::ranges::all_of(formats, [&](const std::string& format) { return mayStore(plain, format); });
  return needsMore ? "#extension GL_NV_image_formats : require\n" : "";
}

std::string precisionStatements(const Profile& profile) {
  if (!profile.es) return {};
  std::string text(esPrecision);
  if (profile.stage == Stage::Compute) text += esPrecisionOfImages;
  return text;
}

std::string call(std::string_view name, const std::vector<std::string>& arguments, std::string_view indent) {
  std::string line = fmt::format("{}({})", name, fmt::join(arguments, ", "));
  if (line.size() <= lineLength) return line;
  return fmt::format("{}(\n{}{})", name, indent, fmt::join(arguments, fmt::format(",\n{}", indent)));
}

std::string_view text(Function function) {
  switch (function) {
    case Function::Unravel2: return library::unravel2;
    case Function::Unravel3: return library::unravel3;
    case Function::Unravel4: return library::unravel4;
    case Function::Ravel: return library::ravel;
    case Function::Texel: return library::texel;
    case Function::Paired: return library::paired;
    case Function::Divide: return library::divide;
    case Function::Row: return library::row;
    case Function::Layered: return library::layered;
    case Function::Wrap: return library::wrap;
    case Function::WrapOnce: return library::wrapOnce;
    case Function::Mirror: return library::mirror;
    case Function::MirrorOnce: return library::mirrorOnce;
    case Function::ToHalf: return library::toHalf;
    case Function::Ramp: return library::ramp;
    case Function::Local: return library::local;
    case Function::Sampled: return library::sampled;
  }
  return {};
}

}  // namespace sk::assemble
