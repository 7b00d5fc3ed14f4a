// SPDX-License-Identifier: MIT
#include "markdown.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <regex>
#include <sstream>
#include <stdexcept>

namespace docs {
namespace {

namespace fs = std::filesystem;

/// Reads a document line by line; each function takes the lines that are its own.
class Reader {
 public:
  Reader(Document& document, std::vector<std::string> lines)
      : document_(document), lines_(std::move(lines)) {}

  void run() {
    while (at_ < lines_.size()) {
      const std::string& line = lines_[at_];
      if (line.starts_with("```")) {
        block();
      } else if (line.starts_with("<!-- prelude")) {
        prelude();
      } else if (line.starts_with("#")) {
        heading();
      } else if (line.starts_with("> ")) {
        quote();
      } else {
        if (line.starts_with("|")) document_.rows.push_back({section_, line, number()});
        links(line);
        ++at_;
      }
    }
  }

 private:
  int number() const { return static_cast<int>(at_) + 1; }

  void heading() {
    const std::string& line = lines_[at_];
    const std::size_t level = line.find_first_not_of('#');
    section_ = trimmed(line.substr(level));
    quote_.clear();
    document_.headings.push_back({static_cast<int>(level), section_, number()});
    ++at_;
  }

  void block() {
    Block block;
    block.document = document_.name;
    block.line = number();
    block.section = section_;
    block.quote = quote_;
    std::istringstream words(lines_[at_].substr(3));
    words >> block.language;
    for (std::string word; words >> word;) block.words.push_back(word);
    for (++at_; at_ < lines_.size() && lines_[at_] != "```"; ++at_) block.text += lines_[at_] + "\n";
    if (at_ == lines_.size()) throw std::runtime_error(block.place() + ": the block is not closed");
    ++at_;
    document_.blocks.push_back(std::move(block));
  }

  void prelude() {
    for (++at_; at_ < lines_.size() && lines_[at_] != "-->"; ++at_) document_.prelude += lines_[at_] + "\n";
    ++at_;
  }

  void quote() {
    Piece quote{section_, {}, number()};
    for (; at_ < lines_.size() && lines_[at_].starts_with("> "); ++at_) {
      quote.text += (quote.text.empty() ? "" : " ") + lines_[at_].substr(2);
    }
    quote_ = quote.text;
    document_.quotes.push_back(std::move(quote));
  }

  void links(const std::string& line) {
    static const std::regex pattern(R"re(\]\(([^)\s]+)\))re");
    const std::string visible = std::regex_replace(line, std::regex("`[^`]*`"), "");
    for (std::sregex_iterator it(visible.begin(), visible.end(), pattern), end; it != end; ++it) {
      document_.links.push_back({section_, (*it)[1], number()});
    }
  }

  Document& document_;
  std::vector<std::string> lines_;
  std::size_t at_ = 0;
  std::string section_, quote_;
};

}  // namespace

bool Block::has(std::string_view word) const {
  return std::find(words.begin(), words.end(), word) != words.end();
}

std::string Block::value(std::string_view key) const {
  for (const std::string& word : words) {
    if (word.starts_with(key) && word.size() > key.size() && word[key.size()] == '=')
      return word.substr(key.size() + 1);
  }
  return {};
}

Document readDocument(const fs::path& root, const std::string& name) {
  Document document;
  document.name = name;
  Reader(document, linesOf(readFile(root / name))).run();
  return document;
}

const std::vector<Document>& documents() {
  static const std::vector<Document> all = [] {
    const fs::path root = SK_DOCS_SOURCE;
    std::vector<std::string> names = {"README.md"};
    for (const char* folder : {"docs", "examples", "tests"}) {
      for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / folder)) {
        if (entry.path().extension() == ".md") names.push_back(fs::relative(entry.path(), root).string());
      }
    }
    std::sort(names.begin(), names.end());
    std::vector<Document> read;
    for (const std::string& name : names) read.push_back(readDocument(root, name));
    return read;
  }();
  return all;
}

std::vector<const Block*> blocksOf(std::string_view language) {
  std::vector<const Block*> found;
  for (const Document& document : documents()) {
    for (const Block& block : document.blocks) {
      if (block.language == language) found.push_back(&block);
    }
  }
  return found;
}

std::string anchorOf(std::string_view heading) {
  std::string anchor;
  for (const char c : heading) {
    const auto u = static_cast<unsigned char>(c);
    if (std::isalnum(u) || c == '_' || c == '-' || u >= 0x80) anchor += static_cast<char>(std::tolower(u));
    if (c == ' ') anchor += '-';
  }
  return anchor;
}

std::string readFile(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw std::runtime_error("cannot read " + path.string());
  return {std::istreambuf_iterator<char>(in), {}};
}

void writeFile(const fs::path& path, std::string_view text) {
  std::ofstream out(path, std::ios::binary);
  out << text;
  if (!out.flush()) throw std::runtime_error("cannot write " + path.string());
}

std::vector<std::string> linesOf(std::string_view text) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    lines.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

std::string trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(" \t") + 1 - first));
}

}  // namespace docs
