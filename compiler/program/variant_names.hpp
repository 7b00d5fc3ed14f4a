// SPDX-License-Identifier: MIT
//
// What the descriptors of the kernels that skc makes of a reduce are called.
#pragma once

#include <cstddef>
#include <string>

#include "ir/ir.hpp"

namespace skc::emit {

/// The kernels of a reduce's compensated variant.
struct CompensatedNames {
  explicit CompensatedNames(const std::string& reduce)
      : fold(reduce + "CompensatedFold"), combine(reduce + "CompensatedCombine"), finish(reduce + "Finish") {}
  std::string fold, combine, finish;
};

/// The kernels of exact sum number `sum` of a reduce.
struct ExactNames {
  ExactNames(const std::string& reduce, std::size_t sum)
      : fold(reduce + "ExactFold" + std::to_string(sum)),
        finish(reduce + "ExactFinish" + std::to_string(sum)),
        term(reduce + "ExactTerm" + std::to_string(sum)) {}
  std::string fold, finish, term;
};

/// The reduce that combines the digits of exact sums. A file has one of each kind for all of its sums.
inline std::string exactCombinationName(const ir::Kernel& combine) { return "sk_" + combine.name; }

}  // namespace skc::emit
