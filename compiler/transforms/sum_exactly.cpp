// SPDX-License-Identifier: MIT
#include "transforms/passes.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "ir/build.hpp"
#include "ir/ir.hpp"
#include "ir/walk.hpp"
#include "ir/walk_module.hpp"
#include "sk/exact_digits.hpp"
#include "transforms/check_limits.hpp"
#include "transforms/float_sums.hpp"
#include "transforms/fold_copy.hpp"
#include "transforms/fold_pattern.hpp"
#include "transforms/synthesized_kernel.hpp"

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
  std::size_t terms = 0;
  bool isInLoop = false;  ///< adds further terms in a loop
};

TermCount countTerms(const Kernel& reduce, const Block& block, const ScalarSum& sum) {
  TermCount count;
  for (const Stmt& stmt : block) {
    count.terms += termsOf(reduce, stmt, sum).size();
    forEachBlock(stmt, [&](const Block& inner) {
      const TermCount nested = countTerms(reduce, inner, sum);
      const bool isLoop = std::holds_alternative<Loop>(stmt.node);
      count.isInLoop = count.isInLoop || nested.isInLoop || (isLoop && nested.terms > 0);
      count.terms += nested.terms;
    });
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

/// Builds the kernel: a copy of the reduce that writes terms instead of adding them.
class TermKernel {
 public:
  TermKernel(Module& module, KernelId id, const ScalarSum& sum, bool areProducts)
      : reduce_(module.kernels[id]), sum_(sum), areProducts_(areProducts), copy_(module, id, "_terms") {}

  KernelId make() {
    Block& body = copy_.entry().body;
    rewrite(body);
    body.insert(body.begin(), std::make_move_iterator(start_.begin()), std::make_move_iterator(start_.end()));
    copy_.dropAccumulators();
    copy_.dropOutputs();
    return copy_.finishNativeKernel();
  }

 private:
  void rewrite(Block& block) {
    Block rewritten;
    for (Stmt& stmt : block) {
      forEachBlock(stmt, [&](Block& inner) { rewrite(inner); });
      if (!foldedBy(reduce_, stmt)) {
        rewritten.push_back(std::move(stmt));
        continue;
      }
      for (Term& term : termsOf(reduce_, stmt, sum_)) write(std::move(term), stmt.loc, rewritten);
    }
    block = std::move(rewritten);
  }

  void write(Term term, Loc loc, Block& block) {
    const VarId value = addOutput("term", -0.0F);
    block.push_back(assign(varRef(copy_.entry(), value), std::move(term.value), loc));
    if (areProducts_) {
      const VarId factor = addOutput("factor", 1.0F);
      if (term.factor) block.push_back(assign(varRef(copy_.entry(), factor), std::move(term.factor), loc));
    }
    ++terms_;
  }

  /// The output keeps its initial value if the element does not add the term.
  VarId addOutput(const char* name, float beginning) {
    const VarId output = copy_.addOutput(fmt::format("{}_{}", name, terms_), Type::of(Scalar::Float));
    start_.push_back(assign(varRef(copy_.entry(), output), literal(beginning)));
    return output;
  }

  const Kernel& reduce_;  ///< in the module, to which no kernel is added before make() ends
  const ScalarSum& sum_;
  const bool areProducts_;
  FoldCopy copy_;
  Block start_;
  std::size_t terms_ = 0;
};

/// The term of a sum of reduce `id`; empty if an element adds terms in a loop, or more terms than a kernel
/// can output. May add a kernel to the module. `areProducts`: other terms get the factor 1.
ExactTerm exactTerm(Module& module, KernelId id, const ScalarSum& sum, bool areProducts) {
  const Kernel& reduce = module.kernels[id];
  const Block& body = module.functions[reduce.entry].body;
  const TermCount count = countTerms(reduce, body, sum);
  const std::size_t outputs = count.terms * (areProducts ? 2 : 1);
  if (count.isInLoop || reduce.params.size() + outputs > mostNumberedParameters) return {};
  if (count.terms == 1) {
    std::vector<VarId> factors = factorsOf(reduce, body, sum);
    if (!factors.empty()) return {.factors = std::move(factors)};
  }
  return {.kernel = TermKernel(module, id, sum, areProducts).make()};
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
    Digits digits;
    for (std::uint32_t i = 0; i < format.groups; ++i) {
      digits.groups.push_back(copy.addAccumulator(fmt::format("digits_{}", i), digitsType,
                                                  construct(digitsType, exprs(literal(0)))));
    }
    digits.flags = copy.addAccumulator("flags", intType, literal(0));
    const Rewriting rewriting{module_.kernels[id], sum, format, digits, copy.entry()};
    rewriting.rewriteElement();
    copy.dropAccumulators();
    copy.dropOutputs();
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
      const TermCount terms = countTerms(entry.body);
      const bool addsOne = terms.outsideLoops + (terms.isInLoop ? 1 : 0) <= 1;
      rewrite(entry.body, addsOne ? Load(Load::most - 1) : Load::settled());
      if (addsOne) return;
      Block start;
      normalize(start, entry, digits);
      entry.body.insert(entry.body.begin(), std::make_move_iterator(start.begin()),
                        std::make_move_iterator(start.end()));
    }

   private:
    struct TermCount {
      std::int64_t outsideLoops = 0;  ///< the most on a path
      bool isInLoop = false;
    };
    struct Loads {
      Load end;  ///< the most at the end of a block
      Load peak;  ///< the most after a term
    };

    TermCount countTerms(const Block& block) const {
      TermCount count;
      for (const Stmt& stmt : block) {
        if (foldedBy(kernel, stmt)) count.outsideLoops += std::ssize(termsOf(kernel, stmt, sum));
        TermCount inner;
        forEachBlock(stmt, [&](const Block& nested) {
          const TermCount one = countTerms(nested);
          inner = {std::max(inner.outsideLoops, one.outsideLoops), inner.isInLoop || one.isInLoop};
        });
        if (std::holds_alternative<Loop>(stmt.node)) inner = {0, inner.isInLoop || inner.outsideLoops > 0};
        count.outsideLoops += inner.outsideLoops;
        count.isInLoop = count.isInLoop || inner.isInLoop;
      }
      return count;
    }

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
    Digits settled;  // inputs must not change
    for (const VarId part : parts.groups) {
      settled.groups.push_back(
          addVariable(synthesized.entry, fmt::format("part_{}", settled.groups.size()), digitsType));
      body.push_back(declare(settled.groups.back(), varRef(synthesized.entry, part)));
    }
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
    Digits total;
    for (const VarId group : digits.groups) {
      total.groups.push_back(addVariable(entry, fmt::format("sum_{}", total.groups.size()), digitsType));
      entry.body.push_back(declare(total.groups.back(), varRef(entry, group)));
    }
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
