// SPDX-License-Identifier: MIT
#include "transforms/exact_term.hpp"

#include <cstddef>
#include <iterator>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "ir/build.hpp"
#include "ir/walk.hpp"
#include "transforms/fold_copy.hpp"
#include "transforms/fold_pattern.hpp"

namespace skc {
namespace {

using namespace ir;

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

}  // namespace

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

}  // namespace skc
