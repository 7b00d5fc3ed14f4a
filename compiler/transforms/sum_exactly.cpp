// SPDX-License-Identifier: MIT
#include "transforms/sum_exactly.hpp"

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "ir/build.hpp"
#include "ir/declared_kernels.hpp"
#include "ir/walk.hpp"
#include "transforms/check_limits.hpp"
#include "transforms/exact_term.hpp"
#include "transforms/float_sums.hpp"
#include "transforms/fold_copy.hpp"
#include "transforms/fold_pattern.hpp"
#include "transforms/scalar_sum.hpp"
#include "transforms/sum_terms.hpp"
#include "transforms/synthesized_kernel.hpp"

namespace skc {
namespace {

using namespace ir;

constexpr Type digitsType = Type::of(Scalar::Int, 4);
constexpr Type intType = Type::of(Scalar::Int);

/// The number of groups of digits, and the bit that stands for 2^-149, the lowest of a float.
struct Format {
  std::uint32_t groups;
  std::int32_t base;
};
constexpr Format ofFloats = {3, 0};
constexpr Format ofProducts = {6, 149};
constexpr std::uint32_t mostGroups = 6;

/// The variables that hold a sum.
struct Digits {
  std::vector<VarId> groups;
  VarId flags = 0;
};

/// Statements that settle the digits: they become small, but keep their sum.
void settle(Block& block, Function& function, const Digits& digits) {
  ExprPtr carry = literal(0);
  for (std::size_t i = 0; i < digits.groups.size(); ++i) {
    const bool isLast = i + 1 == digits.groups.size();
    const auto group = [&] { return varRef(function, digits.groups[i]); };
    ExprPtr next;
    if (!isLast) {
      const VarId var = addVariable(function, fmt::format("carry_{}", function.variables.size()), intType);
      block.push_back(declare(var, intrinsic(Intrinsic::ExactCarry, exprs(group(), clone(carry)))));
      next = varRef(function, var);
    }
    block.push_back(assign(
        group(), intrinsic(Intrinsic::ExactSettled, exprs(group(), std::move(carry), literal(isLast)))));
    carry = std::move(next);
  }
}

/// Statements that add a term.
void add(Block& block, const Function& function, const Digits& digits, const Format& format,
         const Expr& value, const Expr* factor) {
  const bool areProducts = format.groups == ofProducts.groups;
  const auto operands = [&] {
    if (!areProducts) return exprs(clone(value));
    return exprs(clone(value), factor != nullptr ? clone(*factor) : literal(1.0F));
  };
  for (std::uint32_t i = 0; i < format.groups; ++i) {
    std::vector<ExprPtr> args = operands();
    args.push_back(literal(static_cast<std::int32_t>(i)));
    const Intrinsic which = areProducts ? Intrinsic::ExactProductDigits : Intrinsic::ExactDigits;
    block.push_back(
        assign(varRef(function, digits.groups[i]), BinaryOp::Add, intrinsic(which, std::move(args))));
  }
  const Intrinsic which = areProducts ? Intrinsic::ExactProductFlags : Intrinsic::ExactFlags;
  block.push_back(assign(varRef(function, digits.flags), BinaryOp::BitOr, intrinsic(which, operands())));
}

/// Adds parameters that hold digits.
Digits addDigits(SynthesizedKernel& synthesized, const Format& format, ParamRole role,
                 const std::string& suffix = {}) {
  const auto add = [&](const std::string& name, Type type) {
    return synthesized.add(makeParam(name + suffix, role, type, synthesized.kernel.loc));
  };
  Digits digits;
  for (std::uint32_t i = 0; i < format.groups; ++i) {
    digits.groups.push_back(add(fmt::format("digits_{}", i), digitsType));
  }
  digits.flags = add("flags", intType);
  return digits;
}

class ExactSummation {
 public:
  explicit ExactSummation(Module& module) : module_(module) {}

  void sum(KernelId id, const ScalarSum& scalar) {
    const bool areProducts = hasProducts(id, scalar);
    const Format& format = areProducts ? ofProducts : ofFloats;
    KernelSize size = sizeOf(module_, module_.kernels[id]);
    size.parameters += format.groups + 1;  // the digits and flags
    size.planes += format.groups + 1;
    if (!fits(size)) return;
    ExactSum exact{.fold = makeFold(id, scalar, format),
                   .finish = makeFinish(id, scalar, format),
                   .accumulator = scalar.whole.accumulator,
                   .members = scalar.whole.members,
                   .component = scalar.component,
                   .ofProducts = areProducts,
                   .term = exactTerm(module_, id, scalar, areProducts)};
    module_.kernels[id].reduction->exact.push_back(std::move(exact));
  }

 private:
  bool hasProducts(KernelId id, const ScalarSum& sum) const {
    const Kernel& kernel = module_.kernels[id];
    bool found = false;
    walkStmts(module_.functions[kernel.entry].body, [&](const Stmt& stmt) {
      for (const Term& term : termsOf(kernel, stmt, sum)) found = found || term.factor != nullptr;
    });
    return found;
  }

  KernelId makeFold(KernelId id, const ScalarSum& sum, const Format& format) {
    const KernelId combine = combination(format);
    FoldCopy copy(module_, id, "_exact");
    Digits digits;
    for (std::uint32_t i = 0; i < format.groups; ++i) {
      digits.groups.push_back(copy.addAccumulator(fmt::format("digits_{}", i), digitsType,
                                                  construct(digitsType, exprs(literal(0)))));
    }
    digits.flags = copy.addAccumulator("flags", intType, literal(0));
    const Rewriting rewriting{module_.kernels[id], sum, format, digits};
    Block& body = copy.entry().body;
    if (rewriting.rewrite(copy.entry(), body, false) > 1) {
      Block start;
      settle(start, copy.entry(), digits);
      body.insert(body.begin(), std::make_move_iterator(start.begin()), std::make_move_iterator(start.end()));
    }
    copy.dropAccumulators();
    copy.dropOutputs();
    return copy.finish(combine);
  }

  /// Replaces accumulators by digits.
  struct Rewriting {
    const Kernel& kernel;
    const ScalarSum& sum;
    const Format& format;
    const Digits& digits;

    /// Returns the number of terms that an element adds without settling.
    int rewrite(Function& entry, Block& block, bool inLoop) const {
      int terms = 0;
      Block rewritten;
      for (Stmt& stmt : block) {
        const bool isLoop = std::holds_alternative<Loop>(stmt.node);
        forEachBlock(stmt, [&](Block& inner) { terms += rewrite(entry, inner, inLoop || isLoop); });
        if (!foldedBy(kernel, stmt)) {
          rewritten.push_back(std::move(stmt));
          continue;
        }
        // this variant does not have the other accumulators
        for (const Term& term : termsOf(kernel, stmt, sum)) {
          if (inLoop) settle(rewritten, entry, digits);
          add(rewritten, entry, digits, format, *term.value, term.factor.get());
          terms += inLoop ? 0 : 1;
        }
      }
      block = std::move(rewritten);
      return terms;
    }
  };

  /// The reduce that adds digits, built at its first use.
  KernelId combination(const Format& format) {
    std::optional<KernelId>& known = combinations_[format.groups];
    if (known) return *known;
    SynthesizedKernel synthesized(format.groups == ofProducts.groups ? "exact_products" : "exact_sums");
    const Digits parts = addDigits(synthesized, format, ParamRole::Input, "_part");
    const Digits totals = addDigits(synthesized, format, ParamRole::Accumulator);
    Block& body = synthesized.entry.body;
    Digits settled;   // inputs must not change
    for (const VarId part : parts.groups) {
      settled.groups.push_back(
          addVariable(synthesized.entry, fmt::format("part_{}", settled.groups.size()), digitsType));
      body.push_back(declare(settled.groups.back(), varRef(synthesized.entry, part)));
    }
    settle(body, synthesized.entry, settled);
    settle(body, synthesized.entry, totals);
    for (std::uint32_t i = 0; i < format.groups; ++i) {
      body.push_back(assign(varRef(synthesized.entry, totals.groups[i]), BinaryOp::Add,
                            varRef(synthesized.entry, settled.groups[i])));
    }
    body.push_back(assign(varRef(synthesized.entry, totals.flags), BinaryOp::BitOr,
                          varRef(synthesized.entry, parts.flags)));
    known = synthesized.finishCombination(module_);
    return *known;
  }

  KernelId makeFinish(KernelId id, const ScalarSum& sum, const Format& format) {
    const Kernel& kernel = module_.kernels[id];
    const KernelParam& param = kernel.params[sum.whole.accumulator];
    SynthesizedKernel synthesized(kernel, "_finish");
    const VarId plain = synthesized.add(makeParam(param.name, ParamRole::Input, param.type, kernel.loc));
    const Digits digits = addDigits(synthesized, format, ParamRole::Input);
    const VarId result =
        synthesized.add(makeParam("r_" + param.name, ParamRole::Output, param.type, kernel.loc));
    Function& entry = synthesized.entry;
    Digits total;
    for (const VarId group : digits.groups) {
      total.groups.push_back(addVariable(entry, fmt::format("sum_{}", total.groups.size()), digitsType));
      entry.body.push_back(declare(total.groups.back(), varRef(entry, group)));
    }
    total.flags = addVariable(entry, "sum_flags", intType);
    entry.body.push_back(declare(total.flags, varRef(entry, digits.flags)));
    settle(entry.body, entry, total);
    if (!kernel.reduction->seeded) {   // the identity is a summand
      const ExprPtr identity = scalarOf(clone(param.identity), sum);
      add(entry.body, entry, total, format, *identity, nullptr);
      settle(entry.body, entry, total);
    }
    const VarId isNegative = makePositive(entry, total);
    std::vector<ExprPtr> args;
    for (const VarId group : total.groups) args.push_back(varRef(entry, group));
    while (args.size() < mostGroups) args.push_back(construct(digitsType, exprs(literal(0))));
    args.push_back(varRef(entry, total.flags));
    args.push_back(varRef(entry, isNegative));
    args.push_back(literal(format.base));
    entry.body.push_back(assign(varRef(entry, result), varRef(entry, plain)));
    entry.body.push_back(
        assign(scalarOf(varRef(entry, result), sum), intrinsic(Intrinsic::ExactRounded, std::move(args))));
    return synthesized.finish(module_);
  }

  /// Replaces settled digits by their magnitude's; returns the variable that is true if the sum was negative.
  static VarId makePositive(Function& entry, const Digits& total) {
    const VarId isNegative = addVariable(entry, "is_negative", Type::of(Scalar::Bool));
    ExprPtr last = swizzle(varRef(entry, total.groups.back()), "w");
    entry.body.push_back(declare(isNegative, binary(BinaryOp::Less, std::move(last), literal(0))));
    Block negate;
    for (const VarId group : total.groups) {
      negate.push_back(assign(varRef(entry, group), unary(UnaryOp::Negate, varRef(entry, group))));
    }
    settle(negate, entry, total);
    entry.body.push_back(ifStmt(varRef(entry, isNegative), std::move(negate)));
    return isNegative;
  }

  /// The scalar's component of an accumulator's value.
  ExprPtr scalarOf(ExprPtr value, const ScalarSum& sum) const {
    for (const std::uint32_t field : sum.whole.members) value = member(module_, std::move(value), field);
    return componentOf(*value, sum.component);
  }

  Module& module_;
  std::array<std::optional<KernelId>, mostGroups + 1> combinations_ = {};
};

/// The scalars of a reduce that are sums of floats.
std::vector<ScalarSum> scalarSums(const Module& module, KernelId id) {
  const Kernel& kernel = module.kernels[id];
  std::vector<ScalarSum> sums;
  for (const FloatSum& sum : floatSums(module, id)) {
    if (!kernel.reduction->seeded && !kernel.params[sum.accumulator].identity) continue;
    for (unsigned i = 0; i < sum.type.width; ++i) {
      if ((sum.components >> i & 1U) != 0) sums.push_back({sum, i});
    }
  }
  return sums;
}

}  // namespace

void sumExactly(Module& module, Diagnostics&) {
  ExactSummation state(module);
  forEachDeclaredKernel(module, [&](KernelId id) {
    const Kernel& kernel = module.kernels[id];
    if (!kernel.reduction || kernel.isSynthesized) return;
    // otherwise other statements use the accumulators, which the variant with digits does not have
    if (!recogniseFold(kernel, module.functions[kernel.entry])) return;
    for (const ScalarSum& sum : scalarSums(module, id)) state.sum(id, sum);
  });
}

}  // namespace skc
