// SPDX-License-Identifier: MIT
//
// What the programs of scans have in common. Items of a level, elements or results of runs, are numbered row-major;
// those of a line are sk_inner apart.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "assemble/reduce/fold_text.hpp"
#include "assemble/reduce/scan_program.hpp"

namespace sk::assemble {

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
