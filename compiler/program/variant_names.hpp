// SPDX-License-Identifier: MIT
//
// Names the descriptors of the kernels that skc derives from a reduce.
#pragma once

#include <cstddef>
#include <string>

#include "ir/ir.hpp"

namespace skc::emit {

/// The names for the kernels of a reduce's compensated variant.
struct CompensatedNames {
  explicit CompensatedNames(const std::string& reduce)
      : fold(reduce + "CompensatedFold"), combine(reduce + "CompensatedCombine"), finish(reduce + "Finish") {}
  std::string fold, combine, finish;
};

/// The names for the kernels of exact sum number `sum` of a reduce.
struct ExactNames {
  ExactNames(const std::string& reduce, std::size_t sum)
      : fold(reduce + "ExactFold" + std::to_string(sum)),
        finish(reduce + "ExactFinish" + std::to_string(sum)),
        term(reduce + "ExactTerm" + std::to_string(sum)) {}
  std::string fold, finish, term;
};

/// The names for the parts of a kernel with folded outputs.
struct FoldPartNames {
  explicit FoldPartNames(const std::string& kernel)
      : map(kernel + "Map"), after(kernel + "After"), doubles(kernel + "InDoubles") {}
  std::string map, after, doubles;
};

/// The name of the reduce that combines digits of exact sums. All sums of a kind share it.
inline std::string exactCombinationName(const ir::Kernel& combine) { return "sk_" + combine.name; }

}  // namespace skc::emit
