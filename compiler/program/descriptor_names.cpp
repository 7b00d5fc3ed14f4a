// SPDX-License-Identifier: MIT
#include "program/descriptor_names.hpp"

#include <algorithm>
#include <iterator>

#include "program/cpp_names.hpp"
#include "support/namer.hpp"

namespace skc::emit {
namespace {

using namespace ir;

constexpr std::string_view words[] = {
#define SKC_PART(Word) #Word,
#include "program/descriptor_parts.def"
#undef SKC_PART
};

/// True if constants of the two prefixes could have the same name: one prefix is the other followed by a part. A number behind the
/// prefix rules that out, since no part contains an underscore before a digit.
bool mayMeet(std::string_view a, std::string_view b) {
  if (a.size() > b.size()) std::swap(a, b);
  if (!b.starts_with(a)) return false;
  const std::string_view rest = b.substr(a.size());
  return rest.empty() || (startsWithPart(rest) && rest.find('_') == std::string_view::npos);
}

void add(std::vector<std::string>& names, const std::string& wanted) {
  names.push_back(uniqueName(wanted, [&](const std::string& name) {
    return std::ranges::any_of(names, [&](const std::string& other) { return mayMeet(name, other); });
  }));
}

/// Prefixes that no unit has, since theirs have an underscore before a digit only.
std::string ownName(std::string_view name) { return std::string("sk_").append(name); }

}  // namespace

std::span<const std::string_view> partWords() { return words; }

std::string_view wordOf(Part part) { return words[static_cast<std::size_t>(part)]; }

bool startsWithPart(std::string_view text) {
  return std::ranges::any_of(words, [&](std::string_view word) { return text.starts_with(word); });
}

std::vector<std::string> descriptorNames(const Module& module, const Program& program) {
  std::vector<std::string> names;
  for (const Unit& unit : program.units()) add(names, camelCase(module.kernels[unit.id].name));
  return names;
}

std::vector<std::string> tableNames(const Module& module) {
  std::vector<std::string> names;
  for (const Table& table : module.tables) add(names, ownName(camelCase(table.name)));
  return names;
}

std::string exactCombinationName(const Kernel& combine) { return ownName(combine.name); }

std::string synthesizedStructName(const std::string& glslName) { return ownName(glslName); }

}  // namespace skc::emit
