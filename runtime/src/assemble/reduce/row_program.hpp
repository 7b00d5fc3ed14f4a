// SPDX-License-Identifier: MIT
//
// The program of one pass over rows of different lengths (ReduceVariant::rows), which tables describe: each invocation
// folds a piece of a row, or what a scan needs for one item. Items are elements, or the results of pieces.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "assemble/assemble.hpp"
#include "assemble/reduce/reduce_program.hpp"
#include "sk/program.hpp"

namespace sk::assemble {

/// The invocations of a work group that folds a group of pieces, and the most items of such a group.
inline constexpr std::int32_t rowGroupSize = 256, rowGroupItems = 1024;

/// A kernel of a reduction whose program also reads tables, which are Inputs behind all its parameters:
///   Folds   for each piece, the first item and their number (int2)
///   Groups  the same, then for each group, the first piece, their number, the first item and their number (int4)
///   Inclusive, Exclusive   for each item, how many of its piece precede it, and the number of the result that it
///           continues from, or -1 (int2)
/// The kernel must outlive this object.
class RowKernel {
 public:
  RowKernel(const program::Kernel& kernel, RowPass pass);
  RowKernel(const RowKernel&) = delete;
  RowKernel& operator=(const RowKernel&) = delete;

  const program::Kernel& kernel() const { return kernel_; }
  /// The first table: pieces or items.
  const program::Parameter& table() const { return parameters_[ownParameters_]; }
  /// RowPass::Groups: the second table.
  const program::Parameter& groups() const { return parameters_[ownParameters_ + 1]; }

 private:
  std::vector<program::Parameter> parameters_;
  std::size_t ownParameters_;
  program::Kernel kernel_;
};

/// Whether work groups can fold the items of RowPass::Groups: they start from identities, are combined by the same
/// program, and have room in shared memory.
bool mayGroupRows(const program::Reduction& reduction);

/// The program of one pass (ReduceVariant::rows is not None). Its outputs, and the values of its uniforms, are as in
/// reduceProgram().
std::string rowProgram(const Profile& profile, const program::Reduction& reduction,
                       const ReduceVariant& variant);

}  // namespace sk::assemble
