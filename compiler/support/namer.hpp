// SPDX-License-Identifier: MIT
//
// Chooses names in generated text. Every name that skc derives from a name of the user's comes from here, for every target; the words
// that a target reserves are in its own tables (glsl/words, program/cpp_words, web/js_words).
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>

namespace skc {

/// `base`, or the first of base_2, base_3 ... that is not taken.
template <class Predicate>
std::string uniqueName(const std::string& base, Predicate&& isTaken) {
  std::string name = base;
  for (int i = 2; isTaken(name); ++i) name = base + (base.back() == '_' ? "" : "_") + std::to_string(i);
  return name;
}

/// Finds the names that uniqueName() finds, in a scope that no name leaves. It remembers which numbers are taken, so that
/// a thousand equal names take no longer than a thousand different ones.
class UniqueNames {
 public:
  /// `group`: names that `isTaken` treats alike, if `base` alone does not say so.
  template <class Predicate>
  std::string find(const std::string& base, Predicate&& isTaken, const std::string& group = {}) {
    if (!isTaken(base)) return base;
    const std::string start = base + (base.back() == '_' ? "" : "_");
    int& number = next_.try_emplace(base + group, 2).first->second;
    std::string name = start + std::to_string(number);
    while (isTaken(name)) name = start + std::to_string(++number);
    return name;
  }

 private:
  std::map<std::string, int> next_;
};

/// The names of one scope of generated text.
class Namer {
 public:
  using IsReserved = bool (*)(std::string_view name);
  /// Asks `isTaken` which names the target does not allow in this scope.
  explicit Namer(IsReserved isTaken = [](std::string_view) { return false; }) : isReserved_(isTaken) {}

  /// Marks a name that other text declares in the scope.
  void reserve(std::string name) { reserved_.insert(std::move(name)); }

  /// Returns a name that nothing else in the scope has: `wanted` if possible; `wanted_` if it is reserved, and `wanted_2` if it
  /// was given before.
  std::string take(std::string wanted) {
    while (isReserved(wanted)) wanted += '_';
    std::string name =
        unique_.find(wanted, [&](const std::string& n) { return isReserved(n) || given_.contains(n); });
    given_.insert(name);
    return name;
  }

 private:
  bool isReserved(const std::string& name) const { return isReserved_(name) || reserved_.contains(name); }

  IsReserved isReserved_;
  std::set<std::string> reserved_, given_;
  UniqueNames unique_;
};

}  // namespace skc
