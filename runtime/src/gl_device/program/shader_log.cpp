// SPDX-License-Identifier: MIT
//
// Translates source locations in programs and in drivers' logs.
#include "gl_device/program/shader_log.hpp"

#include <charconv>
#include <cstdint>
#include <optional>

namespace sk {

namespace {

/// A line number that encodes the source is source << sourceShift | line, which allows a million lines per
/// file.
constexpr unsigned sourceShift = 20;
constexpr std::uint32_t lineMask = (std::uint32_t{1} << sourceShift) - 1;

/// Removes a number from the front of `text`; nullopt if there is none.
std::optional<std::uint32_t> takeNumber(std::string_view& text) {
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{}) {
    return std::nullopt;
  }
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return number;
}

bool take(std::string_view& text, std::string_view prefix) {
  const bool isThere = text.starts_with(prefix);
  if (isThere) {
    text.remove_prefix(prefix.size());
  }
  return isThere;
}

/// Calls change(line) for each line of a text, and joins the results.
template <class Change>
std::string changeLines(std::string_view text, Change change) {
  std::string changed;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    changed += change(text.substr(0, end));
    changed += end == std::string_view::npos ? "" : "\n";
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return changed;
}

std::string withEncodedLine(std::string_view text) {
  std::string_view rest = text;
  if (take(rest, "#line ")) {
    const std::optional<std::uint32_t> line = takeNumber(rest);
    take(rest, " ");
    const std::optional<std::uint32_t> source = line ? takeNumber(rest) : std::nullopt;
    if (source) {
      return "#line " + std::to_string(*source << sourceShift | (*line & lineMask));
    }
  }
  return std::string(text);
}

std::string withSourceName(std::string_view text, std::span<const std::string_view> sources) {
  std::string_view rest = text;
  std::string named;
  for (const std::string_view severity : {"ERROR: ", "WARNING: "}) {
    if (take(rest, severity)) {
      named = severity;
    }
  }
  const bool isNumber = takeNumber(rest).has_value();
  const bool isInBrackets = isNumber && take(rest, "(");
  const std::optional<std::uint32_t> place =
      isInBrackets || (isNumber && take(rest, ":")) ? takeNumber(rest) : std::nullopt;
  if (!place || (*place >> sourceShift) > sources.size()) {
    return std::string(text);
  }
  if (isInBrackets) {
    take(rest, ")");
  }
  const std::uint32_t source = *place >> sourceShift;
  named += source == 0 ? "assembled program" : sources[source - 1];
  return named.append(":").append(std::to_string(*place & lineMask)).append(rest);
}

}  // namespace

std::string withEncodedLines(std::string_view program) { return changeLines(program, withEncodedLine); }

std::string withSourceNames(std::string_view log, std::span<const std::string_view> sources) {
  return changeLines(log, [&](std::string_view line) { return withSourceName(line, sources); });
}

}  // namespace sk
