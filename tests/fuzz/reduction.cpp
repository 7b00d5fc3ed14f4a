// SPDX-License-Identifier: MIT
#include "reduction.hpp"

#include <algorithm>
#include <sstream>
#include <vector>

#include "tokens.hpp"

namespace fuzz {
namespace {

using Pieces = std::vector<std::string>;

std::string joined(const Pieces& pieces) {
  std::string text;
  for (const std::string& piece : pieces) text += piece;
  return text;
}

Pieces linesOf(const std::string& text) {
  Pieces lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line + "\n");
  return lines;
}

Pieces tokenTexts(const std::string& text) {
  Pieces pieces;
  for (const Token& token : tokensOf(text)) pieces.push_back(token.text);
  return pieces;
}

/// Drops runs of pieces, long runs first, until no single piece can be dropped.
Pieces withoutNeedless(Pieces pieces, const std::function<bool(const std::string&)>& fails) {
  for (std::size_t run = std::max<std::size_t>(pieces.size() / 2, 1);;) {
    bool hasShrunk = false;
    for (std::size_t at = 0; at < pieces.size();) {
      Pieces fewer = pieces;
      const auto begin = fewer.begin() + static_cast<std::ptrdiff_t>(at);
      fewer.erase(begin, begin + static_cast<std::ptrdiff_t>(std::min(run, fewer.size() - at)));
      if (fails(joined(fewer))) {
        pieces = std::move(fewer);
        hasShrunk = true;
      } else {
        at += run;
      }
    }
    if (run == 1 && !hasShrunk) return pieces;
    run = std::max<std::size_t>(run / 2, 1);
  }
}

}  // namespace

std::string reduced(std::string text, const std::function<bool(const std::string&)>& fails) {
  text = joined(withoutNeedless(linesOf(text), fails));
  return joined(withoutNeedless(tokenTexts(text), fails));
}

}  // namespace fuzz
