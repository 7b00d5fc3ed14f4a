// SPDX-License-Identifier: MIT
#include "program/constant_names.hpp"

#include <algorithm>
#include <iterator>
#include <set>

#include "program/cpp_names.hpp"
#include "support/namer.hpp"

namespace skc::emit {
namespace {

using namespace ir;

constexpr std::string_view words[] = {
#define SKC_PART(Word) #Word,
#include "program/constant_parts.def"
#undef SKC_PART
};

/// Prefixes none of which could give a constant the name of another's.
class Prefixes {
 public:
  std::string take(const std::string& wanted) {
    std::string name = unique_.find(wanted, [&](const std::string& n) { return meetsAny(n); });
    known_.insert(name);
    return name;
  }

 private:
  /// True if constants of two prefixes could have the same name, where `rest` is what the longer one has more than the other: it is a
  /// part. A number behind the prefix rules that out, since no part contains an underscore before a digit.
  static bool isPart(std::string_view rest) {
    return startsWithPart(rest) && rest.find('_') == std::string_view::npos;
  }

  bool meetsAny(const std::string& name) const {
    if (known_.contains(name)) return true;
    const std::string_view text = name;
    for (std::size_t size = 0; size < text.size(); ++size) {
      if (isPart(text.substr(size)) && known_.contains(text.substr(0, size))) return true;
    }
    for (auto longer = known_.lower_bound(name); longer != known_.end() && longer->starts_with(name);
         ++longer) {
      if (isPart(std::string_view(*longer).substr(name.size()))) return true;
    }
    return false;
  }

  std::set<std::string, std::less<>> known_;
  UniqueNames unique_;
};

/// Prefixes that no unit has, since theirs have an underscore before a digit only.
std::string ownName(std::string_view name) { return std::string("sk_").append(name); }

}  // namespace

std::span<const std::string_view> partWords() { return words; }

std::string_view wordOf(Part part) { return words[static_cast<std::size_t>(part)]; }

bool startsWithPart(std::string_view text) {
  return std::ranges::any_of(words, [&](std::string_view word) { return text.starts_with(word); });
}

std::vector<std::string> constantNames(const Module& module, const Program& program) {
  Prefixes prefixes;
  std::vector<std::string> names;
  for (const Unit& unit : program.units())
    names.push_back(prefixes.take(camelCase(module.kernels[unit.id].name)));
  return names;
}

std::vector<std::string> tableNames(const Module& module) {
  Prefixes prefixes;
  std::vector<std::string> names;
  for (const Table& table : module.tables) names.push_back(prefixes.take(ownName(camelCase(table.name))));
  return names;
}

std::string exactCombinationName(const Kernel& combine) { return ownName(combine.name); }

std::string arrayName(std::size_t number) { return ownName("array_" + std::to_string(number)); }

std::string synthesizedStructName(const std::string& glslName) { return ownName(glslName); }

}  // namespace skc::emit
