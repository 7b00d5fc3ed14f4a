// SPDX-License-Identifier: MIT
//
// One scalar of a sum of floats, which exact sums go by: each component of a vector is a sum of its own.
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

/// The terms that a statement of the reduce adds to the scalar, each of one float; none if it adds nothing to it.
std::vector<Term> termsOf(const ir::Kernel& reduce, const ir::Stmt& stmt, const ScalarSum& sum);

}  // namespace skc
