// SPDX-License-Identifier: MIT
#include "web/used_functions.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <unordered_set>
#include <vector>

namespace skc::web {
namespace {

/// A function, or a line outside of functions, which has no name.
struct Section {
  std::string_view text;
  std::string_view name;
};

bool isWord(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

std::string_view lineAt(std::string_view text) { return text.substr(0, text.find('\n') + 1); }

std::string_view withoutComment(std::string_view line) { return line.substr(0, line.find("//")); }

/// The name of the function that a line begins to define or declare: "f" of "float f(float x) {". Empty if there is none.
std::string_view functionName(std::string_view line) {
  const std::size_t open = line.find('(');
  if (open == std::string_view::npos || !isWord(line.front())) return {};
  std::size_t begin = open;
  while (begin > 0 && isWord(line[begin - 1])) --begin;
  const bool hasType = begin > 0 && begin < open && line[begin - 1] == ' ';
  const std::string_view type = line.substr(0, begin);
  return hasType && std::ranges::all_of(type, [](char c) { return isWord(c) || c == ' '; })
             ? line.substr(begin, open - begin)
             : std::string_view();
}

/// The length of the function at the beginning of a text, up to the line of its last brace; 0 if it is only declared.
std::size_t functionLength(std::string_view text) {
  int depth = 0;
  bool isOpen = false;
  for (std::size_t at = 0; at < text.size();) {
    const std::string_view line = lineAt(text.substr(at));
    if (line.empty()) return 0;
    at += line.size();
    for (const char c : withoutComment(line)) {
      if (!isOpen && c == ';') return 0;
      isOpen = isOpen || c == '{';
      depth += c == '{' ? 1 : c == '}' ? -1 : 0;
    }
    if (isOpen && depth == 0) return at;
  }
  return 0;
}

std::vector<Section> sectionsOf(std::string_view program) {
  std::vector<Section> sections;
  while (!program.empty()) {
    std::string_view line = lineAt(program);
    if (line.empty()) line = program;
    const std::string_view name = functionName(line);
    const std::size_t length = name.empty() ? 0 : functionLength(program);
    const std::string_view text = program.substr(0, length == 0 ? line.size() : length);
    if (!line.starts_with("//")) sections.push_back({text, length == 0 ? std::string_view() : name});
    program.remove_prefix(text.size());
  }
  return sections;
}

/// Words in the order in which they were found first.
class Words {
 public:
  void add(std::string_view text) {
    while (!text.empty()) {
      const auto end = std::ranges::find_if_not(text, isWord);
      const std::string_view word(text.begin(), end);
      if (!word.empty() && known_.insert(word).second) list_.push_back(word);
      text.remove_prefix(std::max<std::size_t>(word.size(), 1));
    }
  }
  std::size_t size() const { return list_.size(); }
  std::string_view operator[](std::size_t number) const { return list_[number]; }

 private:
  std::unordered_set<std::string_view> known_;
  std::vector<std::string_view> list_;
};

}  // namespace

std::string withUsedFunctions(std::string_view program, std::string_view more) {
  const std::vector<Section> sections = sectionsOf(program);
  Words words;
  words.add("main");
  words.add(more);
  std::multimap<std::string_view, std::size_t> functions;  // sections, by name
  for (std::size_t i = 0; i < sections.size(); ++i) {
    if (sections[i].name.empty()) {
      words.add(sections[i].text);
    } else {
      functions.emplace(sections[i].name, i);
    }
  }
  std::vector<bool> isUsed(sections.size());
  for (std::size_t w = 0; w < words.size(); ++w) {  // what a function that is used adds comes later
    const auto [first, last] = functions.equal_range(words[w]);
    for (auto function = first; function != last; ++function) {
      isUsed[function->second] = true;
      words.add(sections[function->second].text);
    }
  }
  std::string used;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    if (sections[i].name.empty() && sections[i].text == "\n" && used.ends_with("\n\n")) continue;
    if (sections[i].name.empty() || isUsed[i]) used += sections[i].text;
  }
  return used;
}

}  // namespace skc::web
