// SPDX-License-Identifier: MIT
#include "transforms/passes.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "ir/build.hpp"
#include "ir/ir.hpp"
#include "ir/walk.hpp"
#include "sk/exact_digits.hpp"
#include "transforms/check_limits.hpp"
#include "transforms/float_sums.hpp"
#include "transforms/fold_copy.hpp"
#include "transforms/fold_pattern.hpp"

namespace skc {

using namespace ir;

namespace {

// Determines what an element adds to an exact sum, for native code, whose runtime adds terms without
// rounding: the inputs that form the term, or a kernel that computes it.
//
//   before   reduce void r(float x<>, float y<>, reduce float total<>) { if (y > 0) total += x * (y - 1); }
//   after    the same, whose term is computed by
//            kernel void r_terms(float x<>, float y<>, out float term_0<>, out float factor_0<>) {
//              term_0 = -0; factor_0 = 1;
//              if (y > 0) { term_0 = x; factor_0 = y - 1; }
//            }

/// Descriptors number parameters with a byte.
constexpr std::size_t mostNumberedParameters = std::numeric_limits<std::uint8_t>::max();

/// The number of terms that an element adds.
struct TermCount {
  std::size_t all = 0;
  std::size_t onPath = 0;  ///< outside of loops, the most on a path
  bool isInLoop = false;  ///< adds further terms in a loop
};

TermCount countTerms(const Kernel& reduce, const Block& block, const ScalarSum& sum) {
  TermCount count;
  for (const Stmt& stmt : block) {
    const std::size_t own = termsOf(reduce, stmt, sum).size();
    TermCount inner;
    forEachBlock(stmt, [&](const Block& nested) {
      const TermCount one = countTerms(reduce, nested, sum);
      inner = {inner.all + one.all, std::max(inner.onPath, one.onPath), inner.isInLoop || one.isInLoop};
    });
    if (std::holds_alternative<Loop>(stmt.node)) inner = {inner.all, 0, inner.all > 0};
    count = {count.all + own + inner.all, count.onPath + own + inner.onPath,
             count.isInLoop || inner.isInLoop};
  }
  return count;
}

bool mayReturn(const Stmt& stmt) {
  if (std::holds_alternative<Return>(stmt.node)) return true;
  bool found = false;
  forEachBlock(stmt, [&](const Block& inner) {
    for (const Stmt& nested : inner) found = found || mayReturn(nested);
  });
  return found;
}

/// The inputs of a sum's only term, if every element adds it; otherwise empty.
std::vector<VarId> factorsOf(const Kernel& reduce, const Block& body, const ScalarSum& sum) {
  for (const Stmt& stmt : body) {
    const std::vector<Term> terms = termsOf(reduce, stmt, sum);
    if (!terms.empty()) return inputsOf(reduce, terms[0]);
    if (mayReturn(stmt)) return {};
  }
  return {};
}

/// A copy of the reduce that writes terms instead of adding them.
KernelId makeTermKernel(Module& module, KernelId id, const ScalarSum& sum, bool areProducts) {
  const Kernel& reduce = module.kernels[id];  // no kernel is added before this one
  FoldCopy copy(module, id, "_terms");
  Function& entry = copy.entry();
  Block start;
  std::size_t terms = 0;
  // an output keeps its initial value if the element does not add the term
  const auto write = [&](const char* name, float initial, ExprPtr value, Loc loc, Block& to) {
    const VarId output =
        copy.add(fmt::format("{}_{}", name, terms), ParamRole::Output, Type::of(Scalar::Float));
    start.push_back(assign(varRef(entry, output), literal(initial)));
    if (value) to.push_back(assign(varRef(entry, output), std::move(value), loc));
  };
  rewriteFolds(reduce, entry.body, [&](const Stmt& fold, const FoldTarget&, Block& to) {
    for (Term& term : termsOf(reduce, fold, sum)) {
      write("term", -0.0F, std::move(term.value), fold.loc, to);
      if (areProducts) write("factor", 1.0F, std::move(term.factor), fold.loc, to);
      ++terms;
    }
    return true;
  });
  prepend(entry.body, std::move(start));
  copy.drop({ParamRole::Accumulator, ParamRole::Output});
  return copy.finishNativeKernel();
}

/// The term of a sum of reduce `id`; empty if an element adds terms in a loop, or more terms than a kernel
/// can output. May add a kernel to the module. `areProducts`: other terms get the factor 1.
ExactTerm exactTerm(Module& module, KernelId id, const ScalarSum& sum, bool areProducts) {
  const Kernel& reduce = module.kernels[id];
  const Block& body = module.functions[reduce.entry].body;
  const TermCount count = countTerms(reduce, body, sum);
  const std::size_t outputs = count.all * (areProducts ? 2 : 1);
  if (count.isInLoop || reduce.params.size() + outputs > mostNumberedParameters) return {};
  if (count.all == 1) {
    std::vector<VarId> factors = factorsOf(reduce, body, sum);
    if (!factors.empty()) return {.factors = std::move(factors)};
  }
  return {.kernel = makeTermKernel(module, id, sum, areProducts)};
}

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

using Load = sk::program::DigitLoad<std::int32_t>;

/// Statements that normalize the digits: they become small, but keep their sum.
void normalize(Block& block, Function& function, const Digits& digits) {
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

/// Something that may be written several times: the expression itself, or a variable that the block gets for it.
ExprPtr computedOnce(Block& block, Function& function, const char* name, const Expr& value) {
  if (std::holds_alternative<VarRef>(value.node) || std::holds_alternative<Literal>(value.node)) {
    return clone(value);
  }
  const VarId var = addVariable(function, fmt::format("{}_{}", name, function.variables.size()), value.type);
  block.push_back(declare(var, clone(value)));
  return varRef(function, var);
}

/// Statements that add a term.
void add(Block& block, Function& function, const Digits& digits, const Format& format, const Expr& value,
         const Expr* factor) {
  const bool areProducts = format.groups == ofProducts.groups;
  const ExprPtr term = computedOnce(block, function, "term", value);
  const ExprPtr other = factor != nullptr ? computedOnce(block, function, "factor", *factor) : literal(1.0F);
  const auto operands = [&] {
    return areProducts ? exprs(clone(*term), clone(*other)) : exprs(clone(*term));
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

/// Adds parameters that hold digits, each by `add`.
template <class Add>
Digits addDigits(const Format& format, Add&& add) {
  Digits digits;
  for (std::uint32_t i = 0; i < format.groups; ++i)
    digits.groups.push_back(add(fmt::format("digits_{}", i), digitsType));
  digits.flags = add("flags", intType);
  return digits;
}

Digits addDigits(SynthesizedKernel& synthesized, const Format& format, ParamRole role,
                 const std::string& suffix = {}) {
  return addDigits(format, [&](const std::string& name, Type type) {
    return synthesized.add(makeParam(name + suffix, role, type, synthesized.kernel.loc));
  });
}

/// Copies the groups of digits, which are inputs, to variables that may change.
Digits copied(Function& entry, const Digits& digits, std::string_view name) {
  Digits copy;
  for (const VarId group : digits.groups) {
    copy.groups.push_back(addVariable(entry, fmt::format("{}_{}", name, copy.groups.size()), digitsType));
    entry.body.push_back(declare(copy.groups.back(), varRef(entry, group)));
  }
  return copy;
}

class ExactSummation {
 public:
  explicit ExactSummation(Module& module) : module_(module) {}

  /// Whether the variant of a sum can be described.
  bool hasRoom(KernelId id, const ScalarSum& scalar) const {
    const Format& format = hasProducts(id, scalar) ? ofProducts : ofFloats;
    KernelSize size = sizeOf(module_, module_.kernels[id]);
    size.parameters += format.groups + 1;  // the digits and flags
    size.planes += format.groups + 1;
    return fits(size);
  }

  void sum(KernelId id, const ScalarSum& scalar) {
    const bool areProducts = hasProducts(id, scalar);
    const Format& format = areProducts ? ofProducts : ofFloats;
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
    const Digits digits = addDigits(format, [&](const std::string& name, Type type) {
      return copy.add(name, ParamRole::Accumulator, type, literalOf(type, 0));
    });
    const Rewriting rewriting{module_.kernels[id], sum, format, digits, copy.entry()};
    rewriting.rewriteElement();
    copy.drop({ParamRole::Accumulator, ParamRole::Output});
    return copy.finish(combine);
  }

  /// Replaces accumulators by digits.
  ///
  /// A run folds as many elements as digits have room for terms (program::longestRun), so that an element may add one term
  /// as it is. An element that may add more settles before the first, and again where its terms have used the room. In a
  /// loop, the first term of an iteration settles, whatever the iterations before have added.
  struct Rewriting {
    const Kernel& kernel;
    const ScalarSum& sum;
    const Format& format;
    const Digits& digits;
    Function& entry;

    void rewriteElement() const {
      const TermCount terms = countTerms(kernel, entry.body, sum);
      const bool addsOne = terms.onPath + (terms.isInLoop ? 1 : 0) <= 1;
      rewrite(entry.body, addsOne ? Load(Load::most - 1) : Load::settled());
      if (addsOne) return;
      Block start;
      normalize(start, entry, digits);
      prepend(entry.body, std::move(start));
    }

   private:
    struct Loads {
      Load end;  ///< the most at the end of a block
      Load peak;  ///< the most after a term
    };

    /// Rewrites a block before which the digits have at most this load.
    Loads rewrite(Block& block, Load load) const {
      Load peak;
      Block rewritten;
      for (Stmt& stmt : block) {
        Loads inner{load, {}};
        const bool isLoop = std::holds_alternative<Loop>(stmt.node);
        forEachBlock(stmt, [&](Block& nested) {
          const Loads one = rewrite(nested, isLoop ? Load(Load::most) : load);
          inner = {std::max(inner.end, one.end), std::max(inner.peak, one.peak)};
        });
        load = isLoop ? std::max(load, inner.peak) : inner.end;
        peak = std::max(peak, inner.peak);
        if (!foldedBy(kernel, stmt)) {
          rewritten.push_back(std::move(stmt));
          continue;
        }
        // this variant does not have the other accumulators
        for (const Term& term : termsOf(kernel, stmt, sum)) {
          if (load.room() == 0) {
            normalize(rewritten, entry, digits);
            load = Load::settled();
          }
          add(rewritten, entry, digits, format, *term.value, term.factor.get());
          load = load + Load(1);
          peak = std::max(peak, load);
        }
      }
      block = std::move(rewritten);
      return {load, peak};
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
    const Digits settled = copied(synthesized.entry, parts, "part");
    normalize(body, synthesized.entry, settled);
    normalize(body, synthesized.entry, totals);
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
    Digits total = copied(entry, digits, "sum");
    total.flags = addVariable(entry, "sum_flags", intType);
    entry.body.push_back(declare(total.flags, varRef(entry, digits.flags)));
    normalize(entry.body, entry, total);
    if (!kernel.reduction->seeded) {  // the identity is a summand
      const ExprPtr identity = scalarOf(clone(param.identity), sum);
      add(entry.body, entry, total, format, *identity, nullptr);
      normalize(entry.body, entry, total);
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
    normalize(negate, entry, total);
    entry.body.push_back(ifStmt(varRef(entry, isNegative), std::move(negate)));
    return isNegative;
  }

  /// The scalar's component of an accumulator's value.
  ExprPtr scalarOf(ExprPtr value, const ScalarSum& sum) const {
    return componentOf(*member(module_, std::move(value), sum.whole.members), sum.component);
  }

  Module& module_;
  std::array<std::optional<KernelId>, mostGroups + 1> combinations_ = {};
};

/// True if all that floats are added to are sums, so that an exact call adds none of them inexactly.
bool areAll(const std::vector<ScalarSum>& sums, const FoldPattern& pattern) {
  return std::ranges::all_of(pattern.targets, [&](const FoldTarget& target) {
    if (target.op != FoldOp(BinaryOp::Add) || target.type.scalar != Scalar::Float) return true;
    return std::ranges::any_of(sums, [&](const ScalarSum& sum) { return sum.whole.overlaps(target); });
  });
}

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
    // without a pattern, other statements use the accumulators, which the variant with digits does not have
    if (!kernel.reduction || !kernel.reduction->pattern || kernel.isSynthesized) return;
    const std::vector<ScalarSum> sums = scalarSums(module, id);
    const bool haveRoom =
        std::ranges::all_of(sums, [&](const ScalarSum& sum) { return state.hasRoom(id, sum); });
    if (!haveRoom || !areAll(sums, *kernel.reduction->pattern)) return;
    for (const ScalarSum& sum : sums) state.sum(id, sum);
  });
}

}  // namespace skc
