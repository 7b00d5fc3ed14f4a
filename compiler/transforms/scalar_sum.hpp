// SPDX-License-Identifier: MIT
//
// One scalar of a float sum. Exact sums work on these: each component of a vector is a sum of its own.
#pragma once

#include <vector>

#include "ir/ir.hpp"
#include "transforms/float_sums.hpp"
#include "transforms/sum_terms.hpp"

namespace skc {

/// A component of a sum.
struct ScalarSum {
  FloatSum whole;
  unsigned component;
};

/// The terms, each one float, that a statement of the reduce adds to the scalar; empty if it adds none.
std::vector<Term> termsOf(const ir::Kernel& reduce, const ir::Stmt& stmt, const ScalarSum& sum);

}  // namespace skc
