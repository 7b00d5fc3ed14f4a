// SPDX-License-Identifier: MIT
#include "cpp/reducer.hpp"

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

namespace fuzz::cpp {
namespace {

class Reducer {
 public:
  Reducer(NodePtr root, const std::function<bool(const Node&)>& fails, int budget)
      : root_(std::move(root)), fails_(fails), budget_(budget) {}

  NodePtr run() {
    for (bool changed = true; changed && budget_ > 0;) {
      changed = lists(root_);
      changed |= simplify(root_);
    }
    return std::move(root_);
  }

 private:
  bool stillFails() { return budget_-- > 0 && fails_(*root_); }

  /// Removes elements of all lists, long runs first, from the end, since what comes later is used less.
  bool lists(NodePtr& node) {
    bool changed = node->kind == Node::Kind::List && shorten(node->children);
    for (NodePtr& child : node->children) {
      if (child->kind != Node::Kind::Expression) changed |= lists(child);
    }
    return changed;
  }

  bool shorten(std::vector<NodePtr>& children) {
    bool changed = false;
    for (std::size_t run = std::max<std::size_t>(1, children.size() / 2);; run /= 2) {
      for (std::size_t end = children.size(); end > 0 && budget_ > 0;) {
        const std::size_t begin = end > run ? end - run : 0;
        const auto at = [&](std::size_t i) { return children.begin() + static_cast<std::ptrdiff_t>(i); };
        std::vector<NodePtr> removed(std::make_move_iterator(at(begin)), std::make_move_iterator(at(end)));
        children.erase(at(begin), at(end));
        if (stillFails()) {
          changed = true;
        } else {
          children.insert(at(begin), std::make_move_iterator(removed.begin()),
                          std::make_move_iterator(removed.end()));
        }
        end = std::min(begin, children.size());
      }
      if (run <= 1) return changed;
    }
  }

  /// Tries `replacement` in the place of `node`.
  bool replaces(NodePtr& node, NodePtr replacement) {
    std::swap(node, replacement);
    if (stillFails()) return true;
    std::swap(node, replacement);
    return false;
  }

  bool simplify(NodePtr& node) {
    if (budget_ <= 0) return false;
    bool changed = false;
    if (node->kind == Node::Kind::Expression) {
      if (!node->simple.empty() && node->text != node->simple) {
        NodePtr simple = makeNode(Node::Kind::Expression, node->simple);
        simple->type = node->type;
        simple->simple = node->simple;
        if (replaces(node, std::move(simple))) return true;
      }
      for (bool found = true; found && !node->isGuard;) {
        found = false;
        for (const NodePtr& child : node->children) {
          if (child->type != node->type) continue;
          found = replaces(node, clone(*child));
          changed |= found;
          break;
        }
      }
    } else if (node->kind == Node::Kind::Statement && node->text != "{\n$}") {
      // A statement with blocks: one of them in its place.
      for (std::size_t i = 0; i < node->children.size(); ++i) {
        if (node->children[i]->kind != Node::Kind::List || node->text.find("{\n$") == std::string::npos)
          continue;
        if (replaces(node, makeStatement("{\n$}", clone(*node->children[i])))) {
          changed = true;
          break;
        }
      }
    }
    for (NodePtr& child : node->children) changed |= simplify(child);
    return changed;
  }

  NodePtr root_;
  const std::function<bool(const Node&)>& fails_;
  int budget_;
};

}  // namespace

NodePtr reduced(NodePtr root, const std::function<bool(const Node&)>& fails, int budget) {
  return Reducer(std::move(root), fails, budget).run();
}

}  // namespace fuzz::cpp
