// SPDX-License-Identifier: MIT
#include "assemble/program/several_bodies.hpp"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

namespace sk::assemble {
namespace {

using program::Definition;
using program::Kernel;
using program::Parameter;

/// Macros by which a body calls the functions of its parameters under other names.
std::vector<std::pair<std::string, std::string>> accessorsOf(const Kernel& kernel,
                                                             std::span<const std::string> symbols) {
  std::vector<std::pair<std::string, std::string>> macros;
  for (std::size_t i = 0; i < kernel.parameters.size(); ++i) {
    const Parameter& parameter = kernel.parameters[i];
    const auto rename = [&](bool isUsed, std::string_view function) {
      if (!isUsed) return;
      const std::string ours =
          symbols[i].empty() ? fmt::format("sk_{}", function) : fmt::format("sk_{}_{}", function, symbols[i]);
      macros.emplace_back(fmt::format("sk_{}_{}", function, parameter.symbol), ours);
    };
    rename(parameter.usesIndex, "index");
    rename(parameter.usesExtent, "extent");
    rename(parameter.usesAt, "at");
    rename(parameter.usesNear, "near");
    rename(parameter.usesSample, "sample");
  }
  return macros;
}

/// Whether a macro of this name would also change the components of vectors.
bool isSwizzle(std::string_view name) {
  return name.size() <= 4 && name.find_first_not_of("xyzwrgbastpq") == std::string_view::npos;
}

}  // namespace

std::optional<std::string> SeveralBodies::add(const Kernel& kernel, std::span<const std::string> symbols) {
  if (kernel.definitions.empty()) return std::nullopt;
  auto macros = accessorsOf(kernel, symbols);
  std::string accessors;
  for (const auto& [name, ours] : macros) accessors += name + " " + ours + "\n";
  for (const Instance& instance : instances_) {
    if (instance.body == kernel.body && instance.accessors == accessors) return instance.entry;
  }
  std::string entry(kernel.entry);
  for (const Definition& definition : kernel.definitions) {
    if (definition.name.empty() || !taken_.contains(definition.name)) continue;
    // members of structs, and components of vectors, would be renamed, too
    if (!kernel.declarations.empty() || isSwizzle(definition.name)) return std::nullopt;
    const std::string ours = fmt::format("sk_{}_{}", instances_.size(), definition.name);
    macros.emplace_back(definition.name, ours);
    if (definition.name == kernel.entry) entry = ours;
  }
  std::string_view rest = kernel.body;
  for (const Definition& definition : kernel.definitions) {
    if (!definition.name.empty()) {
      taken_.emplace(definition.name);
      continue;
    }
    const std::string_view helper = rest.substr(0, definition.bytes);
    rest.remove_prefix(definition.bytes);
    if (std::ranges::find(helperTexts_, helper) != helperTexts_.end()) continue;
    helperTexts_.push_back(helper);
    helpers_ += helper;
  }
  for (const auto& [name, ours] : macros) bodies_ += fmt::format("#define {} {}\n", name, ours);
  bodies_ += rest;
  if (!bodies_.ends_with('\n')) bodies_ += '\n';
  for (const auto& [name, ours] : macros) bodies_ += fmt::format("#undef {}\n", name);
  instances_.push_back({kernel.body, std::move(accessors), entry});
  return entry;
}

}  // namespace sk::assemble
