// SPDX-License-Identifier: MIT
#include "support/text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <iterator>
#include <optional>
#include <vector>

namespace skc {

namespace {

template <class T>
std::string shortest(T value) {
  std::array<char, 32> buffer;
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  std::string text(buffer.data(), end);
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

}  // namespace

std::string shortestFloat(float value) { return shortest(value); }
std::string shortestDouble(double value) { return shortest(value); }

std::string join(std::span<const std::string> items, std::string_view separator) {
  std::string result;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (i > 0) result += separator;
    result += items[i];
  }
  return result;
}

namespace {

/// A space at which the line may be broken.
struct BreakPoint {
  std::size_t position;
  int cost;   ///< number of open brackets first, then the precedence of the operator before the space
};

/// The precedence of the operator that ends the word: 0 for punctuation, nullopt if there is no operator.
std::optional<int> bindingOf(std::string_view word) {
  if (word.empty()) return std::nullopt;
  if (word.back() == ',' || word.back() == ';') return 0;
  constexpr std::string_view levels[] = {
      " ? : ", " || ", " && ", " | ^ & ", " == != ", " < <= > >= ", " << >> ", " + - ", " * / % "};
  const std::string spaced = " " + std::string(word) + " ";
  for (std::size_t level = 0; level < std::size(levels); ++level) {
    if (levels[level].find(spaced) != std::string_view::npos) return static_cast<int>(level) + 1;
  }
  return std::nullopt;
}

/// The spaces after commas, semicolons and binary operators.
std::vector<BreakPoint> breakPoints(std::string_view line) {
  constexpr int perBracket = 16;
  std::vector<BreakPoint> points;
  int depth = 0;
  bool inString = false;
  std::size_t wordStart = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"' && (i == 0 || line[i - 1] != '\\')) inString = !inString;
    if (inString) continue;
    if (c == '(' || c == '[' || c == '{') ++depth;
    if (c == ')' || c == ']' || c == '}') --depth;
    if (c != ' ') continue;
    const std::optional<int> binding = bindingOf(line.substr(wordStart, i - wordStart));
    if (binding) points.push_back({i, depth * perBracket + *binding});
    wordStart = i + 1;
  }
  return points;
}

/// The cheapest break from `first` to `limit`, the last one if several cost the same.
std::optional<std::size_t> chooseBreak(std::string_view line, std::size_t first, std::size_t limit) {
  std::optional<BreakPoint> best;
  for (const BreakPoint& point : breakPoints(line)) {
    if (point.position < first || point.position > limit) continue;
    if (!best || point.cost <= best->cost) best = point;
  }
  if (!best) return std::nullopt;
  return best->position;
}

}  // namespace

std::string wrapLine(std::string_view line, std::size_t limit, std::size_t continuation) {
  const std::size_t indent = std::min(line.find_first_not_of(' '), line.size());
  const bool isTooFar = continuation > limit * 3 / 4;
  const std::string margin(continuation == 0 || isTooFar ? indent + 4 : continuation, ' ');
  std::string result;
  std::size_t before = 0;   // the width of the margin in front of `line`
  while (before + line.size() > limit) {
    const std::size_t first = result.empty() ? indent : before;
    if (first >= limit) break;
    // Scans no further than the limit, because lines may be lists of a thousand items.
    const std::optional<std::size_t> at =
        chooseBreak(line.substr(0, limit - before + 1), first + (limit - first) / 3 - before, limit - before);
    if (!at) break;
    if (!result.empty()) result += margin;
    result += line.substr(0, *at);
    result += '\n';
    line.remove_prefix(*at + 1);
    before = margin.size();
  }
  if (!result.empty()) result += margin;
  return result + std::string(line);
}

std::uint64_t textHash(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  return hash;
}

}  // namespace skc
