// SPDX-License-Identifier: MIT
#include "cpp/tree.hpp"

#include <algorithm>
#include <cstddef>

namespace fuzz::cpp {
namespace {

void append(std::string& text, const Node& node) {
  if (node.kind == Node::Kind::List) {
    for (const NodePtr& child : node.children) {
      append(text, *child);
      text += '\n';
    }
    return;
  }
  std::size_t next = 0;
  for (const char c : node.text) {
    if (c == '$') {
      append(text, *node.children[next++]);
    } else {
      text += c;
    }
  }
}

/// Indents each line by the depth of its braces.
std::string indented(const std::string& text) {
  std::string result;
  int depth = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = std::string_view(text).substr(begin, end - begin);
    begin = end + 1;
    if (line.empty()) continue;
    int change = 0, least = 0;
    for (const char c : line) {
      change += c == '{' ? 1 : c == '}' ? -1 : 0;
      least = std::min(least, change);
    }
    result.append(static_cast<std::size_t>(2 * std::max(0, depth + least)), ' ');
    result.append(line).append("\n");
    depth += change;
  }
  return result;
}

}  // namespace

std::string print(const Node& node) {
  std::string text;
  append(text, node);
  return indented(text);
}

NodePtr clone(const Node& node) {
  auto copy = std::make_unique<Node>();
  copy->kind = node.kind;
  copy->text = node.text;
  copy->type = node.type;
  copy->simple = node.simple;
  copy->isGuard = node.isGuard;
  for (const NodePtr& child : node.children) copy->children.push_back(clone(*child));
  return copy;
}

}  // namespace fuzz::cpp
