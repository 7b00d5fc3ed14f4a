// SPDX-License-Identifier: MIT
#include "transforms/remove_jumps.hpp"

#include <iterator>
#include <optional>
#include <utility>

#include "ir/evaluate.hpp"
#include "ir/walk.hpp"
#include "transforms/condition.hpp"

namespace skc {
namespace {

using namespace ir;

/// True if a statement contains a jump of the loop around it; a `break` in a switch belongs to the switch.
bool mayLeave(const Stmt& stmt, bool inSwitch = false) {
  if (std::holds_alternative<Continue>(stmt.node)) return true;
  if (std::holds_alternative<Break>(stmt.node)) return !inSwitch;
  if (std::holds_alternative<Loop>(stmt.node)) return false;
  inSwitch = inSwitch || std::holds_alternative<Switch>(stmt.node);
  bool may = false;
  forEachBlock(stmt, [&](const Block& inner) {
    for (const Stmt& one : inner) may = may || mayLeave(one, inSwitch);
  });
  return may;
}

/// How part of an iteration ends: control reaches what follows, or all of it leaves.
enum class End : std::uint8_t { GoesOn, Continues, Breaks, Unknown };

class JumpRemover {
 public:
  explicit JumpRemover(const Module& module) : module_(module) {}

  /// `endsIteration`: the block ends the iteration, so that some elements may leave it earlier than others.
  End leave(Block& block, bool endsIteration) const {
    for (std::size_t i = 0; i < block.size(); ++i) {
      decide(block, i);
      if (i == block.size()) break;
      if (!mayLeave(block[i])) continue;
      const End end = leave(block, i, endsIteration);
      if (end != End::GoesOn) return end;
    }
    return End::GoesOn;
  }

 private:
  /// Replaces an `if` that may leave the iteration and whose condition is known by the branch taken.
  void decide(Block& block, std::size_t i) const {
    while (i < block.size() && mayLeave(block[i])) {
      auto* n = std::get_if<If>(&block[i].node);
      const auto cond = n == nullptr ? std::nullopt : evaluate(module_, *n->cond, Constants::LookThrough);
      if (!cond) return;
      Block taken = std::move(*cond != 0 ? n->then : n->otherwise);
      const auto at = block.erase(block.begin() + static_cast<std::ptrdiff_t>(i));
      block.insert(at, std::make_move_iterator(taken.begin()), std::make_move_iterator(taken.end()));
    }
  }

  /// Processes statement `i`, which may leave the iteration. GoesOn if the next
  /// one is still to be processed.
  End leave(Block& block, std::size_t i, bool endsIteration) const {
    Stmt& stmt = block[i];
    if (std::holds_alternative<Continue>(stmt.node)) return cut(block, i, End::Continues);
    if (std::holds_alternative<Break>(stmt.node)) return cut(block, i, End::Breaks);
    if (auto* n = std::get_if<Scope>(&stmt.node)) {
      const End end = leave(n->body, false);
      return end == End::GoesOn ? end : cut(block, i + 1, end);
    }
    if (std::holds_alternative<If>(stmt.node)) return divide(block, i, endsIteration);
    return End::Unknown;
  }

  static End cut(Block& block, std::size_t size, End end) {
    block.erase(block.begin() + static_cast<std::ptrdiff_t>(size), block.end());
    return end;
  }

  /// An `if` with one branch that continues: the rest of the iteration moves to the other branch.
  End divide(Block& block, std::size_t i, bool endsIteration) const {
    auto& choice = std::get<If>(block[i].node);
    const End then = leave(choice.then, false);
    const End otherwise = leave(choice.otherwise, false);
    if (then == otherwise && then != End::GoesOn) return cut(block, i + 1, then);
    const bool oneContinues = (then == End::Continues && otherwise == End::GoesOn) ||
                              (then == End::GoesOn && otherwise == End::Continues);
    if (!oneContinues || !endsIteration) return End::Unknown;
    Block& rest = then == End::Continues ? choice.otherwise : choice.then;
    const auto next = block.begin() + static_cast<std::ptrdiff_t>(i) + 1;
    rest.insert(rest.end(), std::make_move_iterator(next), std::make_move_iterator(block.end()));
    block.erase(next, block.end());
    const End end = leave(rest, true);
    if (choice.then.empty()) {
      choice.cond = notOf(*choice.cond);
      std::swap(choice.then, choice.otherwise);
    }
    return end == End::Breaks || end == End::Unknown ? End::Unknown : End::Continues;
  }

  const Module& module_;
};

}  // namespace

IterationEnd removeJumps(const Module& module, Block& iteration) {
  switch (JumpRemover(module).leave(iteration, true)) {
    case End::GoesOn:
    case End::Continues: return IterationEnd::Completes;
    case End::Breaks: return IterationEnd::LeavesLoop;
    case End::Unknown: break;
  }
  return IterationEnd::Unknown;
}

}  // namespace skc
