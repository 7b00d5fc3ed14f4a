// SPDX-License-Identifier: MIT
#include "program/cpp_literals.hpp"

#include <fmt/format.h>

namespace skc::emit {
namespace {

constexpr std::size_t pieceSize = 15000;

}  // namespace

std::string rawString(std::string_view text) {
  std::string result;
  do {
    std::size_t length = text.size();
    if (length > pieceSize) {
      const std::size_t lineEnd = text.rfind('\n', pieceSize - 1);
      length = lineEnd == std::string_view::npos ? pieceSize : lineEnd + 1;
    }
    if (!result.empty()) result += "\n    ";
    result += fmt::format("R\"glsl({})glsl\"", text.substr(0, length));
    text.remove_prefix(length);
  } while (!text.empty());
  return result;
}

std::string floatLiteral(float value) { return fmt::format("{:#}F", value); }

std::string doubleLiteral(double value) { return fmt::format("{:#}", value); }

std::string quoted(std::string_view text) {
  std::string result = "\"";
  for (char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + '"';
}

}  // namespace skc::emit
