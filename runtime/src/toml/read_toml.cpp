// SPDX-License-Identifier: MIT
#define TOML_IMPLEMENTATION
#include "toml/read_toml.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <memory>
#include <string_view>

#include <fmt/format.h>

namespace sk {

namespace {

constexpr std::size_t mostBytes = std::size_t{16} << 20;
/// The most dots of a key. With the limit for nested values, this bounds the depth of tables: 64 values, each
/// with a key of 32 parts.
constexpr int mostDots = 31;

/// The end of the string that begins at `at`: after its closing quotes, or the end of the line or the text if
/// there are none.
std::size_t endOfString(std::string_view text, std::size_t at) {
  const char quote = text[at];
  const std::string_view three = text.substr(at, 3);
  const bool isMultiLine = three.size() == 3 && three[1] == quote && three[2] == quote;
  at += isMultiLine ? 3 : 1;
  for (; at < text.size(); ++at) {
    if (text[at] == '\\' && quote == '"') {
      ++at;
    } else if (text[at] == '\n' && !isMultiLine) {
      return at;
    } else if (text[at] == quote) {
      if (!isMultiLine) return at + 1;
      const std::size_t end = std::min(text.find_first_not_of(quote, at), text.size());
      if (end - at >= 3) return std::min(end, at + 5);  // two quotes may precede the closing ones
      at = end - 1;
    }
  }
  return text.size();
}

/// The line of the first key that has too many parts, or 0.
toml::source_index lineOfLongKey(std::string_view text) {
  toml::source_index line = 1;
  int dots = 0;
  for (std::size_t at = 0; at < text.size();) {
    const char c = text[at];
    if (c == '"' || c == '\'') {
      const std::size_t end = endOfString(text, at);
      line += static_cast<toml::source_index>(std::ranges::count(text.substr(at, end - at), '\n'));
      at = end;
      continue;
    }
    if (c == '#') {
      at = std::min(text.find('\n', at), text.size());
      continue;
    }
    if (c == '.' && ++dots > mostDots) return line;
    if (c == '\n' || c == '=' || c == ',') dots = 0;
    if (c == '\n') ++line;
    ++at;
  }
  return 0;
}

[[noreturn]] void fail(const std::string& file, toml::source_index line, const std::string& message) {
  throw toml::parse_error(message.c_str(), toml::source_position{line, line == 0 ? 0U : 1U},
                          std::make_shared<const std::string>(file));
}

std::string textOf(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) fail(file, 0, "File could not be opened for reading");
  std::string text;
  for (std::array<char, 1 << 14> block; in;
       text.append(block.data(), static_cast<std::size_t>(in.gcount()))) {
    if (text.size() > mostBytes) fail(file, 0, fmt::format("File is larger than {} MiB", mostBytes >> 20));
    in.read(block.data(), block.size());
  }
  if (in.bad()) fail(file, 0, "File could not be read");
  return text;
}

}  // namespace

toml::table readToml(const std::string& file) {
  const std::string text = textOf(file);
  if (const toml::source_index line = lineOfLongKey(text); line != 0)
    fail(file, line, fmt::format("a key has more than {} parts", mostDots + 1));
  return toml::parse(std::string_view(text), std::string_view(file));
}

}  // namespace sk
