// SPDX-License-Identifier: MIT
//
// As much of Markdown as our documents use: headings, fenced blocks, quotes, links, table rows and HTML
// comments, each with its line. It knows no language inside the blocks.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace docs {

struct Heading {
  int level;
  std::string text;
  int line;
};

/// ```sk error file=heat.sk
struct Block {
  std::string document;             ///< "docs/language.md"
  int line;                         ///< of the fence
  std::string section;              ///< text of the heading above
  std::string quote;                ///< the last quote (> ...) of that section, on one line
  std::string language;             ///< first word after the fence; empty if none
  std::vector<std::string> words;   ///< the others
  std::string text;

  bool has(std::string_view word) const;
  /// `heat.sk` of `file=heat.sk`; empty if there is none.
  std::string value(std::string_view key) const;
  std::string place() const { return document + ":" + std::to_string(line); }
};

/// A piece of text with its line: a quote, a table row, the target of a link.
struct Piece {
  std::string section;
  std::string text;
  int line;
};

struct Document {
  std::string name;
  std::vector<Heading> headings;
  std::vector<Block> blocks;
  std::vector<Piece> quotes, rows, links;
  std::string prelude;              ///< of its C++ fragments: the comment <!-- prelude ... -->
};

Document readDocument(const std::filesystem::path& root, const std::string& name);
/// README.md, docs/*.md and the README.md files of examples and of tests/docs.
const std::vector<Document>& documents();
/// All blocks of a language.
std::vector<const Block*> blocksOf(std::string_view language);

/// The anchor that GitHub gives a heading: "What is undefined" has "what-is-undefined".
std::string anchorOf(std::string_view heading);

std::string readFile(const std::filesystem::path& path);
void writeFile(const std::filesystem::path& path, std::string_view text);
std::vector<std::string> linesOf(std::string_view text);
/// Without spaces at both ends.
std::string trimmed(std::string_view text);

}  // namespace docs
