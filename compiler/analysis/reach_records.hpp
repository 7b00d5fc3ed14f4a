// SPDX-License-Identifier: MIT
//
// Collects the reads of a kernel's gathers to what GatherReach says.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "analysis/gather_reach.hpp"
#include "analysis/index_range.hpp"
#include "ir/ir.hpp"

namespace skc::analysis {

class ReachRecords {
 public:
  explicit ReachRecords(const ir::Kernel& kernel);

  /// A read of parameter `param` at this index, x first.
  void add(std::uint32_t param, const std::vector<IndexValue>& index);
  /// A read at an index of which nothing is known but what it depends on.
  void addUnknown(std::uint32_t param, std::uint8_t depends);
  /// Adds what others have recorded of the same kernel.
  void merge(const ReachRecords& others);
  /// Forgets what it knows, when the analysis gives up.
  void giveUp();

  std::vector<GatherReach> take() const;

 private:
  struct Dimension {
    ir::Reach::Kind kind = ir::Reach::Kind::Near;
    std::vector<ir::Distance> below, above;  ///< different in what Spec parameters contribute

    void add(const std::vector<ir::Distance>& before, const std::vector<ir::Distance>& after);
  };
  struct Gather {
    std::vector<Dimension> dimensions;
    std::uint64_t shapes = 0;
  };
  std::vector<Gather> gathers_;
};

}  // namespace skc::analysis
