// SPDX-License-Identifier: MIT
//
// A reduction over all ranks of a domain. Each rank folds its own elements with the variant that one device would use, and
// keeps the accumulators as they are before they are finished. All ranks then get the accumulators of all, in the order of
// the elements, and combine them. Exact sums are integers, which MPI adds.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "accumulators.hpp"
#include "api/resolved_reduce.hpp"
#include "call/box.hpp"
#include "call/placed.hpp"
#include "device/loop_state.hpp"
#include "domain_state.hpp"

namespace sk::mpi {

/// The arguments of a device that stands in front of another one, as those of that one. What is written is to be noted by
/// StreamState::noteUnderlyingWritten().
std::vector<Argument> underlying(std::span<const Argument> given);
BoxedArguments underlying(const BoxedArguments& given);

/// A reduction of this rank's elements, and what makes results of its accumulators.
struct Variant {
  const program::Reduction* reduction;
  CallOptions options;
  const program::CompensatedReduction* second = nullptr;  ///< its rounding errors are added
  const program::WideReduction* wide = nullptr;  ///< its doubles are rounded
  bool inDoubles = false;  ///< native code keeps doubles for floats
};

class RankReduction final : private Details {
 public:
  /// `arguments` are those of the rank's own elements in the box of the call, or of any elements if it has none there.
  RankReduction(DomainState& domain, const program::Reduction& reduction, const BoxedArguments& arguments,
                const CallOptions& options, const Box& box);
  ~RankReduction();
  RankReduction(const RankReduction&) = delete;
  RankReduction& operator=(const RankReduction&) = delete;

  /// Folds this rank's elements. Throws sk::Error if it cannot.
  void fold();
  /// What else than options, the box and the domain the ranks compare of the call, if anything, in lines.
  void setDetails(std::string details) { details_ = std::move(details); }
  /// Posts what is collective, on all ranks on which fold() has succeeded; the
  /// others refuse the call.
  void post(const Call& call);
  bool isReady();
  void wait();
  /// Waits. Throws sk::Error on all ranks if one of them has refused the call.
  void receive();
  /// Combines the parts of all ranks, after receive(). May read the arguments
  /// of the call.
  void finish();
  /// receive() and finish() of a call that others do not wait for, which stores
  /// one value for each accumulator.
  void take(std::span<void* const> results);
  /// finish(), and stores the results: one value for each accumulator.
  void finish(std::span<void* const> results);
  /// Stores the results to streams of one element, one for each accumulator, after finish(): what was folded in doubles is not rounded to floats before.
  void store(std::span<const StreamRegion> results);

 private:
  /// Accumulators that travel to all ranks.
  struct Step {
    Variant variant;
    const program::ExactSum* digits = nullptr;  ///< the sum whose digits they are
    std::vector<Argument> arguments;
    std::size_t elementBytes = 0;
    Bytes own;  ///< of this rank's parts
  };

  void storeUnderlying(std::span<const StreamRegion> results);
  std::string details() const override;
  bool isInterleaved() const;
  Shape partsOf(int rank) const;
  std::int64_t countOfParts() const;
  bool isFirst() const;
  bool sumsEverything() const;
  std::byte* valueOf(std::size_t accumulator);
  void checkResults() const;
  ResolvedReduction partOf(const Step& step) const;
  void startStep(const Variant& variant, const program::ExactSum* digits,
                 std::span<const Argument> arguments);
  void layOutSteps();
  void layOutPosted();
  void takePosted();
  std::uint64_t hashOfMessages() const;
  void foldExactly();
  int complete();
  std::vector<std::int64_t> exactWords();
  Bytes allOf(std::size_t step) const;
  Bytes inOrder(const Bytes& parts, std::size_t elementBytes) const;
  void combine(const Step& step, const Accumulators& all, const Accumulators& result);
  void finishStep(std::size_t number);
  void finishDigits(const Step& step, const Accumulators& digits);
  void finishWords();

  DomainState& domain_;
  Box box_;
  bool hasElements_;
  OwnedArguments arguments_;
  std::vector<Bytes> values_;  ///< one for each accumulator
  std::optional<Accumulators> doubles_;  ///< the same, if the call computes in doubles
  ResolvedReduction call_;
  DenseArguments dense_;
  std::vector<std::unique_ptr<Step>> steps_;
  Bytes own_, all_;  ///< the parts of all steps: of this rank, and of all
  Agreement::Started agreed_;
  /// The words of exact sums and then the parts of all steps, if these are so few that they do not wait until the ranks have been
  /// compared; or empty.
  std::vector<std::int64_t> posted_;
  std::vector<int> counts_, offsets_;
  MPI_Request stepsRequest_ = MPI_REQUEST_NULL;
  std::vector<std::int64_t> words_;  ///< of all exact sums, if the device keeps them as integers
  std::vector<std::size_t> wordCounts_;
  MPI_Request wordsRequest_ = MPI_REQUEST_NULL;  ///< of words_, or of posted_
  std::string details_;
};

}  // namespace sk::mpi
