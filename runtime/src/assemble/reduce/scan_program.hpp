// SPDX-License-Identifier: MIT
//
// The programs of a scan. Elements are folded in runs, and their results again, until one run is left in each line;
// then the way back folds, for each item of a level, the items of its run up to it, from the results of the runs
// before it. scan_plan.hpp plans the passes.
#pragma once

#include <string>
#include <vector>

#include "assemble/assemble.hpp"
#include "assemble/reduce/reduce_program.hpp"
#include "sk/program.hpp"

namespace sk::assemble {

/// A kernel of a reduction whose program continues from the results of earlier runs: these are Inputs behind all its
/// parameters, one for each accumulator. The kernel must outlive this object.
class ContinuedKernel {
 public:
  explicit ContinuedKernel(const program::Kernel& kernel);
  ContinuedKernel(const ContinuedKernel&) = delete;
  ContinuedKernel& operator=(const ContinuedKernel&) = delete;

  const program::Kernel& kernel() const { return kernel_; }
  std::span<const program::Parameter> carries() const {
    return std::span(parameters_).last(parameters_.size() - ownParameters_);
  }

 private:
  std::vector<program::Parameter> parameters_;
  std::size_t ownParameters_;
  program::Kernel kernel_;
};

/// The program of one pass (ReduceVariant::scan is not None). Its outputs, and the values of its uniforms, are as in
/// reduceProgram().
std::string scanProgram(const Profile& profile, const program::Reduction& reduction,
                        const ReduceVariant& variant);

}  // namespace sk::assemble
