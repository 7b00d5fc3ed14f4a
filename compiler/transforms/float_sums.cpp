// SPDX-License-Identifier: MIT
#include "transforms/float_sums.hpp"

#include <algorithm>
#include <optional>
#include <tuple>
#include <utility>

#include "ir/walk.hpp"
#include "transforms/static_lvalue.hpp"

namespace skc {
namespace {

using namespace ir;

bool isAccumulator(const Kernel& kernel, VarId var) {
  return var < kernel.params.size() && kernel.params[var].role == ParamRole::Accumulator;
}

/// True if a sum and an lvalue share components, such as a struct and its member.
bool overlap(const FloatSum& sum, const StaticLValue& lvalue) {
  if (sum.accumulator != lvalue.root) return false;
  const std::size_t common = std::min(sum.members.size(), lvalue.members.size());
  if (!std::equal(sum.members.begin(), sum.members.begin() + common, lvalue.members.begin())) return false;
  return lvalue.members.size() < sum.members.size() || (sum.components & lvalue.mask()) != 0;
}

/// Collects what one reduce adds to, and which accumulators it reads or writes otherwise.
class Uses {
 public:
  /// `ofParts`: it is a combining reduce, where only unchanged parts that are added count as sums.
  Uses(const Kernel& kernel, const Function& entry, bool ofParts) : kernel_(kernel), ofParts_(ofParts) {
    take(entry.body, false);
  }

  std::vector<FloatSum> sums() const {
    std::vector<FloatSum> result;
    for (const FloatSum& sum : added_) {
      if (std::ranges::none_of(taken_, [&](const StaticLValue& lvalue) { return overlap(sum, lvalue); })) {
        result.push_back(sum);
      }
    }
    return result;
  }

 private:
  void take(const Block& block, bool isHead) {
    for (const Stmt& stmt : block) {
      const std::optional<FoldPart> part = isHead ? std::nullopt : foldedBy(kernel_, stmt);
      if (part && part->op == FoldOp(BinaryOp::Add) && part->type.isFloat() &&
          (!ofParts_ || addsItsPart(std::get<Assign>(stmt.node)))) {
        add(*part);
      } else {
        forEachOperand(stmt, [&](const ExprPtr& operand) { take(*operand); });
      }
      const auto* loop = std::get_if<Loop>(&stmt.node);
      forEachBlock(stmt, [&](const Block& inner) {
        take(inner, loop != nullptr && (&inner == &loop->init || &inner == &loop->step));
      });
    }
  }

  void take(const Expr& expr) {
    if (const std::optional<StaticLValue> lvalue = staticLValue(expr)) {
      if (isAccumulator(kernel_, lvalue->root)) taken_.push_back(*lvalue);
    } else {
      forEachOperand(expr, [&](const ExprPtr& operand) { take(*operand); });
    }
  }

  void add(const FoldPart& part) {
    for (FloatSum& sum : added_) {
      if (sum.accumulator != part.accumulator || sum.members != part.members) continue;
      sum.components |= part.components;
      return;
    }
    added_.push_back({part.accumulator, part.members, part.type, part.components});
  }

  /// True for `place += part`, where `part` is the same member of the corresponding input.
  bool addsItsPart(const Assign& fold) const {
    const std::vector<Summand> summands = summandsOf(fold);
    if (summands.size() != 1 || summands[0].isNegative) return false;
    StaticLValue part = *staticLValue(*fold.place);
    part.root = elementOf(kernel_, part.root);
    return staticLValue(*summands[0].value) == part;
  }

  const Kernel& kernel_;
  const bool ofParts_;
  std::vector<FloatSum> added_;
  std::vector<StaticLValue> taken_;
};

}  // namespace

bool FloatSum::holds(const FoldPart& part) const {
  return accumulator == part.accumulator && members == part.members && (components & part.components) != 0;
}

VarId sameAccumulator(const Kernel& of, VarId accumulator, const Kernel& in) {
  auto before = std::ranges::count(of.params.begin(), of.params.begin() + accumulator, ParamRole::Accumulator,
                                   &KernelParam::role);
  VarId same = 0;
  while (in.params[same].role != ParamRole::Accumulator || before-- > 0) ++same;
  return same;
}

std::vector<FloatSum> floatSums(const Module& module, KernelId id) {
  const Kernel& kernel = module.kernels[id];
  const Kernel& combine = module.kernels[*kernel.reduction->combine];
  std::vector<FloatSum> sums = Uses(kernel, module.functions[kernel.entry], false).sums();
  const std::vector<FloatSum> combined = Uses(combine, module.functions[combine.entry], true).sums();
  std::erase_if(sums, [&](const FloatSum& sum) {
    const VarId accumulator = sameAccumulator(kernel, sum.accumulator, combine);
    return std::ranges::none_of(combined, [&](const FloatSum& other) {
      return other.accumulator == accumulator && other.members == sum.members &&
             (other.components & sum.components) == sum.components;
    });
  });
  std::ranges::sort(sums, {}, [](const FloatSum& sum) { return std::tie(sum.accumulator, sum.members); });
  return sums;
}

}  // namespace skc
