// SPDX-License-Identifier: MIT
//
// The programs of a scan. Elements are folded in runs, and their results again, until one run is left in each line;
// then the way back folds, for each item of a level, the items of its run up to it, from the results of the runs
// before it. scan_plan.hpp plans the passes.
//
// Also what these programs have in common with dispatched ones (scan_tile_program.hpp). Items of a level, elements or results of runs, are numbered row-major;
// those of a line are sk_inner apart.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "assemble/assemble.hpp"
#include "assemble/reduce/fold_text.hpp"
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

class ScanText : protected FoldText {
 protected:
  ScanText(const Profile& profile, const program::Reduction& reduction, const ReduceVariant& variant);
  ~ScanText() = default;

  /// Declares the parameters and the outputs, and returns these.
  std::vector<program::Parameter> declareParameters();
  /// What the program computes, for readers.
  std::string comment() const;

  bool isOneLine() const { return variant_.runs == Runs::OneBlock; }
  bool isExclusive() const { return variant_.scan == ScanPass::Exclusive; }
  /// Whether folds start from their first item.
  bool isSeeded() const {
    const bool startsFromItem = isOfPartials(variant_.walk) ? !variant_.ofDigits : reduction_.seeded;
    return startsFromItem && !isExclusive();
  }
  /// Whether the result is packed, too: the accumulators after, or before, each of the four elements.
  bool keepsLanes() const { return variant_.packed && variant_.scan != ScanPass::Folds; }
  std::string keptOf(const program::Parameter& accumulator) const { return held("sk_kept", accumulator); }
  std::string_view timesInner() const { return isOneLine() ? "" : " * sk_inner"; }

  /// Sets the index of the current element.
  void moveTo(std::string_view number, std::string_view indent);
  std::string elementAt(std::size_t i, std::string_view number);
  /// The texel of an item. A line of elements begins anywhere in its stream.
  Texel numbered(std::string_view number);
  /// The texel of the result with a number, for programs whose invocations store several.
  Texel resultTexel(const std::string& number);
  /// Sets the accumulators to a result of the level above.
  void takeCarry(std::string_view number, std::string_view indent);

  ContinuedKernel continued_;
};

}  // namespace sk::assemble
