// SPDX-License-Identifier: MIT
#include "listings.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>

namespace docs {
namespace {

namespace fs = std::filesystem;

constexpr const char* bodyHead =
    "kernel void example(int n, bool flag, float s, float4 w, float x<>, float a[], float b[][],\n"
    "                    out float r<>, out float4 c<>) {\n"
    "  r = x;\n  c = w;\n";

std::vector<std::string> meaningfulLines(const std::string& text) {
  std::vector<std::string> lines;
  for (const std::string& line : linesOf(text)) {
    if (std::string bare = trimmed(line); !bare.empty()) lines.push_back(std::move(bare));
  }
  return lines;
}

}  // namespace

std::string wholeFile(const Block& block) {
  // #line keeps the block's own line numbers in messages
  return block.has("body") ? bodyHead + std::string("#line 1\n") + block.text + "}\n" : block.text;
}

std::string fileName(const Block& block) {
  const std::string given = block.value("file");
  if (!given.empty()) return given;
  return fs::path(block.document).filename().string() + "." + std::to_string(block.line) + ".sk";
}

void writeNamedFiles(const fs::path& folder) {
  std::map<std::string, std::string> written;
  for (const Block* block : blocksOf("sk")) {
    const std::string name = block->value("file");
    if (name.empty()) continue;
    const auto [entry, isNew] = written.emplace(name, block->text);
    if (!isNew && entry->second != block->text)
      throw std::runtime_error(block->place() + ": another " + name);
    writeFile(folder / name, block->text);
  }
}

bool quotes(const std::string& excerpt, const std::string& text) {
  const std::vector<std::string> lines = meaningfulLines(text);
  auto at = lines.begin();
  std::vector<std::string> chunk;
  const auto take = [&] {
    if (chunk.empty()) return true;
    at = std::search(at, lines.end(), chunk.begin(), chunk.end());
    if (at == lines.end()) return false;
    at += static_cast<std::ptrdiff_t>(chunk.size());
    chunk.clear();
    return true;
  };
  for (const std::string& line : meaningfulLines(excerpt)) {
    if (line != "...") {
      chunk.push_back(line);
    } else if (!take()) {
      return false;
    }
  }
  return take();
}

}  // namespace docs
