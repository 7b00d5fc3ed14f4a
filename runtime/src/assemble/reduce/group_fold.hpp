// SPDX-License-Identifier: MIT
//
// The part of a kernel's compute program that folds (Work::Folds). Each work group computes one or more tiles of texels, one
// above the other, combines what its invocations have folded, and adds the result to a list. The group that finishes last
// combines the list, in the order of the groups' numbers, and stores the folded outputs.
//
// The buffer at binding 0 holds the number of groups that have finished, which is 0 before and after a call, and then the
// list. Uniforms of the program, all ivec4:
//   sk_groups   the number of groups in the whole call, the tiles of each group, the number of groups side by side, and
//               the number of the dispatch's first group
//   sk_result   the texel of the folded outputs
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "assemble/assemble.hpp"
#include "assemble/glsl/program_text.hpp"
#include "sk/program.hpp"

namespace sk::assemble {

/// The tiles of each work group of a call that folds, given those of the whole call: few groups, whose results one group can
/// combine quickly, but enough for a large GPU, which runs about 2,000 at once.
constexpr std::int64_t tilesOfFoldingGroup(std::int64_t tiles) {
  constexpr std::int64_t most = 4096, enough = 1024;
  return tiles <= enough ? 1 : std::max<std::int64_t>((tiles + most - 1) / most, 2);
}

/// The bytes of the buffer before the list, and at most those of each plane of an entry of the list.
inline constexpr std::size_t foldListStart = 16, foldPlaneBytes = 32;

/// Whether a compute program can fold beside the outputs of a kernel: elements may be folded in any order, work groups can
/// combine accumulators without other arguments, and their shared memory has room for those of all invocations.
bool mayFoldInGroups(const program::Reduction& reduction);

class GroupFold {
 public:
  /// `reduction` must outlive the object. `isPacked`: the domain has four elements in a texel.
  GroupFold(ProgramText& program, const program::Reduction& reduction, bool isPacked);

  /// Adds an accumulator, and returns the variable that holds it.
  std::string define(const program::Parameter& accumulator);
  /// Declares the folded outputs, which follow all others, and makes main() fold.
  void finish();

 private:
  int groupSize() const { return group_.first * group_.second; }
  std::string total(const program::Parameter& accumulator) const;
  std::string shared(const program::Parameter& accumulator) const;
  /// Adds statements to `lines`.
  void startFromIdentities(std::vector<std::string>& lines) const;
  void combineInGroup(std::vector<std::string>& lines) const;
  void combineList(std::vector<std::string>& lines) const;
  /// A call that folds values, one for each accumulator, into the accumulators.
  template <class ValueOf>
  std::string combining(ValueOf&& valueOf) const;

  ProgramText& program_;
  const program::Reduction& reduction_;
  const bool isPacked_;
  std::pair<int, int> group_{};  ///< of the kernel's outputs, not of what it folds
  std::vector<const program::Parameter*> accumulators_;
};

}  // namespace sk::assemble
