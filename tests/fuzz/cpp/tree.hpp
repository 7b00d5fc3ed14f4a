// SPDX-License-Identifier: MIT
//
// A generated program as a tree of text: what the generator builds, what is printed, and what the reducer
// cuts. The tree does not know what its text means.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fuzz::cpp {

struct Node;
using NodePtr = std::unique_ptr<Node>;

/// A piece of a program.
struct Node {
  enum class Kind : std::uint8_t {
    Expression,
    Statement,  ///< or a declaration
    List,  ///< statements or declarations, one after the other; each may be removed
  };
  Kind kind = Kind::Expression;
  std::string text = {};  ///< each '$' stands for the next child
  std::vector<NodePtr> children = {};
  int type = -1;  ///< of an expression: what may replace it has the same type
  std::string simple = {};  ///< of an expression: the simplest one of its type, or empty if it must stay
  bool isGuard = false;  ///< keeps a value in its range: no child may replace it
};

std::string print(const Node& node);

NodePtr clone(const Node& node);

/// An inner node from its text and children.
template <class... Children>
NodePtr makeNode(Node::Kind kind, std::string text, Children... children) {
  auto node = std::make_unique<Node>();
  node->kind = kind;
  node->text = std::move(text);
  (node->children.push_back(std::move(children)), ...);
  return node;
}

inline NodePtr makeList() { return makeNode(Node::Kind::List, {}); }

template <class... Children>
NodePtr makeStatement(std::string text, Children... children) {
  return makeNode(Node::Kind::Statement, std::move(text), std::move(children)...);
}

}  // namespace fuzz::cpp
