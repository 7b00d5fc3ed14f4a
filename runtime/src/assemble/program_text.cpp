// SPDX-License-Identifier: MIT
//
// Sections in, program out.
#include "assemble/program_text.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "assemble/double_intrinsics.hpp"
#include "assemble/doubles.hpp"
#include "assemble/exact_sums.hpp"
#include "assemble/intrinsics.hpp"
#include "assemble/tables.hpp"

namespace sk::assemble {
namespace {

constexpr std::size_t lineLength = 100;

constexpr std::uint32_t bit(Function function) { return 1u << static_cast<unsigned>(function); }

void addOnce(std::vector<std::string>& lines, std::string line) {
  if (std::ranges::find(lines, line) == lines.end()) lines.push_back(std::move(line));
}

/// Adds text of the kernel's, which numbers its own lines, and goes back to numbering the lines of
/// the program.
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

/// The functions of the set in their order, but of the unravelling ones the highest.
void addFunctions(std::string& program, std::uint32_t set) {
  if (set & bit(Function::Unravel4)) set &= ~(bit(Function::Unravel2) | bit(Function::Unravel3));
  if (set & bit(Function::Unravel3)) set &= ~bit(Function::Unravel2);
  for (unsigned i = 0; set >> i != 0; ++i) {
    if (set >> i & 1u) program += text(static_cast<Function>(i));
  }
}

constexpr std::string_view esPrecision =
    "precision highp float;\n"
    "precision highp int;\n"
    "precision highp sampler2D;\n"
    "precision highp isampler2D;\n"
    "precision highp usampler2D;\n";

}  // namespace

std::string ProgramText::uniform(std::string_view type, std::string_view name) {
  addOnce(uniforms_, fmt::format("uniform {} {};", type, name));
  return std::string(name);
}

void ProgramText::flatInput(std::string_view type, std::string_view name) {
  addOnce(uniforms_, fmt::format("flat in {} {};", type, name));
}

void ProgramText::output(std::string_view type, std::string_view name) {
  outputs_.push_back(fmt::format("layout(location = {}) out {} {};", outputs_.size(), type, name));
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

bool ProgramText::isDefined(std::string_view signature) const {
  return std::ranges::find(signatures_, signature) != signatures_.end();
}

void ProgramText::statement(std::string_view line) {
  fmt::format_to(std::back_inserter(main_), "  {}\n", line);
}

void ProgramText::prologue(std::string_view line) {
  fmt::format_to(std::back_inserter(prologue_), "  {}\n", line);
}

std::string ProgramText::finish(const Profile& profile, std::string_view comment,
                                const program::Kernel& kernel) const {
  std::string program = fmt::format("{}\n// {}\n", profile.version, comment);
  const IntrinsicTexts intrinsics = intrinsicTexts(kernel.intrinsics, profile.accurate);
  const bool hasExactFloats = kernel.usesExactSums || intrinsics.useExactFloats ||
                              callDoubleIntrinsics(kernel.intrinsics) ||
                              (kernel.usesDoubles && profile.doubles == Doubles::Pairs);
  if (kernel.usesDoubles) program += doubleExtensions(profile.doubles);
  if (hasExactFloats) program += exactExtensions(profile.barrier);
  if (profile.es) program += esPrecision;
  if (hasExactFloats) program += exactDefinitions(profile.barrier);
  if (kernel.usesDoubles) program += doubleDefinitions(profile.doubles);
  program += doubleIntrinsicDefinitions(kernel.intrinsics, profile.doubles, profile.barrier);
  program += intrinsics.definitions;
  addForeign(program, kernel.declarations);
  program += '\n';
  addLines(program, uniforms_);
  addLines(program, outputs_);
  addLines(program, variables_);
  addFunctions(program, used_);
  program += functions_;
  program += tableDefinitions(kernel.tables, profile.tables);
  addForeign(program, kernel.body);
  program += "\nvoid main() {\n" + prologue_ + main_ + "}\n";
  return program;
}

std::string call(std::string_view name, const std::vector<std::string>& arguments, std::string_view indent) {
  std::string line = fmt::format("{}({})", name, fmt::join(arguments, ", "));
  if (line.size() <= lineLength) return line;
  return fmt::format("{}(\n{}{})", name, indent, fmt::join(arguments, fmt::format(",\n{}", indent)));
}

}  // namespace sk::assemble
