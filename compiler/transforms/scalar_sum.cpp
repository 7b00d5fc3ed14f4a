// SPDX-License-Identifier: MIT
#include "transforms/scalar_sum.hpp"

#include <optional>

#include "transforms/fold_pattern.hpp"

namespace skc {
namespace {

using namespace ir;

/// The component of the added values that goes to the sum; nullopt if none does.
std::optional<unsigned> componentIn(const Kernel& reduce, const Stmt& stmt, const ScalarSum& sum) {
  const std::optional<FoldPart> part = foldedBy(reduce, stmt);
  const bool isOfSum = part && sum.whole.holds(*part) && (part->components >> sum.component & 1U) != 0;
  if (!isOfSum) return std::nullopt;
  const auto* swizzled = std::get_if<Swizzle>(&std::get<Assign>(stmt.node).place->node);
  if (swizzled == nullptr) return sum.component;
  unsigned place = 0;
  while (swizzled->components[place] != sum.component) ++place;
  return place;
}

}  // namespace

std::vector<Term> termsOf(const Kernel& reduce, const Stmt& stmt, const ScalarSum& sum) {
  const std::optional<unsigned> component = componentIn(reduce, stmt, sum);
  if (!component) return {};
  std::vector<Term> terms = termsOf(std::get<Assign>(stmt.node));
  for (Term& term : terms) {
    term.value = componentOf(*term.value, *component);
    if (term.factor) term.factor = componentOf(*term.factor, *component);
  }
  return terms;
}

}  // namespace skc
