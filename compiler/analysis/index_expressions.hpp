// SPDX-License-Identifier: MIT
//
// Evaluates expressions to IndexValues, reports the gathers that they read, and learns from conditions.
//
// Collects the reads of a kernel's gathers to what GatherReach says.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "analysis/gather_reach.hpp"
#include "analysis/index_range.hpp"
#include "ir/ir.hpp"
#include "support/function_ref.hpp"

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

/// Gives the result of a call of a function with these arguments, in a state.
using CallRule = FunctionRef<IndexValues(ir::FunctionId, const std::vector<IndexValues>&)>;

class IndexExpressions {
 public:
  /// In `state`, which must outlive it and which it changes only in `learn` and `assign`.
  IndexExpressions(const ir::Module& module, const ir::Kernel& kernel, IndexState& state,
                   ReachRecords& records, CallRule call)
      : module_(module), kernel_(kernel), state_(state), records_(records), call_(call) {}

  IndexValues of(const ir::Expr& expr) const;
  IndexValues binary(ir::BinaryOp op, ir::Type type, const IndexValues& lhs, const IndexValues& rhs) const;
  /// Restricts the state to elements for which a scalar condition has this value.
  void learn(const ir::Expr& condition, bool isTrue);
  /// Assigns to an lvalue; to one of several elements, if an index is not known.
  void assign(const ir::Expr& place, IndexValues value);

 private:
  friend class IndexRule;
  void learnOrder(const ir::Expr& low, const ir::Expr& high, std::int64_t gap);
  void limit(const ir::Expr& place, const IndexRange& bound, std::int64_t gap, bool isAbove);

  const ir::Module& module_;
  const ir::Kernel& kernel_;
  IndexState& state_;
  ReachRecords& records_;
  CallRule call_;
};

}  // namespace skc::analysis
