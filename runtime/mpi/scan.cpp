// SPDX-License-Identifier: MIT
//
// Scans of streams of a domain. Each rank scans its own elements; the ranks along the scanned dimension exchange the totals of
// their lines; and each rank combines the totals before its own with its results. Only what a scan over one device would fold
// is folded, in the same order, but floats are rounded once more for each rank before.
#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "accumulators.hpp"
#include "call/box.hpp"
#include "call/check_asserts.hpp"
#include "call/check_call.hpp"
#include "call/check_ranges.hpp"
#include "call/check_written.hpp"
#include "call_details.hpp"
#include "call_plan.hpp"
#include "domain_state.hpp"
#include "rank_reduction.hpp"

namespace sk {

using mpi::Accumulators;
using mpi::Bytes;
using program::Parameter;
using program::Reduction;
using program::Role;

namespace {

/// A scan over several ranks, whose arguments have been checked.
class RankScan {
 public:
  RankScan(DomainState& domain, const Reduction& reduction, std::span<const Argument> arguments,
           const CallOptions& options)
      : domain_(domain),
        reduction_(reduction),
        given_(mpi::ownArguments(arguments)),
        ownParts_(mpi::ownParts(arguments)),
        options_(options),
        dimension_(scannedDimension()) {
    for (const Argument& argument : arguments) {
      local_.push_back(argument);
      DomainStreamState* const stream = domainStream(argument.region);
      if (stream != nullptr) local_.back().region = stream->part(domain.own);
    }
    // ranks exchange what the devices hold, whatever stands in front of these
    scanned_ = local_;
    for (std::vector<Argument>* all : {&local_, &given_, &ownParts_}) *all = mpi::underlying(*all);
  }

  int dimension() const { return dimension_; }
  bool hasMessages() const { return domain_.parts.split()[dimension_] > 1; }

  /// Scans this rank's elements, and makes ready what may fail. Changes no
  /// stream of the domain.
  void prepare() {
    if (isExact()) {
      fail(reduction_.fold,
           "exact scans of floats are not possible along dimension {}, which "
           "is divided over {} ranks; call "
           "it "
           "without Accumulate::Exact, or do not divide that dimension",
           dimension_, domain_.parts.split()[dimension_]);
    }
    evaluateAssertions();
    if (checksRanges()) checkRangesRead(reduction_.fold, ownParts_);
    const AssertionsEvaluated evaluated(device());
    const Shape own = domain::shapeOf(domain_.own);
    results_.emplace(accumulators(own.size()));
    sk::scan(reduction_, withResults(*results_, own), options_);
    foldTotals();
  }

  /// The bytes of the total of one line, after prepare(). (Ranks may have different numbers of lines.)
  std::size_t lineBytes() const { return lineBytes_; }

  /// Collective, after prepare(), on the ranks along the dimension.
  void exchangeTotals(const mpi::Communicator& line) {
    const auto count = static_cast<int>(own_.size());
    mpi::check(MPI_Allgather(own_.data(), count, MPI_BYTE, all_.data(), count, MPI_BYTE, line),
               reduction_.fold.name);
    ++domain_.statistics.reductions;
  }

  /// Combines the totals before this rank with its results, and stores these.
  void store() {
    storeUnderlying();
    for (std::size_t i = 0; i < scanned_.size(); ++i) {
      if (isResult(i)) scanned_[i].region.stream->noteUnderlyingWritten();
    }
  }

 private:
  void storeUnderlying() {
    if (!hasMessages()) {
      evaluateAssertions();
      checkOwnRanges();
    }
    const AssertionsEvaluated evaluated(device());
    if (!hasMessages()) return sk::scan(reduction_, local_, options_);
    const Shape own = domain::shapeOf(domain_.own);
    if (const std::optional<Accumulators> before = totalsBefore()) {
      const ResolvedReduction call{
          *results_->regions.front().stream->device, reduction_, local_, own, own, {}, options_};
      mpi::combineEach(domain_, call, *before, *results_, lines());
    }
    if (checksRanges()) checkResults();
    std::size_t next = 0;
    for (std::size_t i = 0; i < local_.size(); ++i) {
      if (isResult(i)) detail::copy(detail::reshaped(results_->regions[next++], own), local_[i].region);
    }
  }

  DeviceState& device() const { return *resultRegion().stream->device; }

  /// Assertions may speak of places in the whole, which what the ranks scan does not know.
  void evaluateAssertions() const {
    const CallOptions options = device().configuration.resolve(reduction_.fold, options_);
    checkFoldAssertions(device(), reduction_.fold, given_, domain_.own, options);
  }

  void checkOwnRanges() const {
    if (!checksRanges()) return;
    checkRangesRead(reduction_.fold, ownParts_);
    checkRangesWritten({.device = device(),
                        .kernel = reduction_.fold,
                        .arguments = ownParts_,
                        .run = [this](std::span<const Argument> others, std::span<void* const>) {
                          std::vector<Argument> local(others.begin(), others.end());
                          for (Argument& argument : local) argument.region.placement = {};
                          sk::scan(reduction_, local, options_);
                        }});
  }

  /// Checks the ranges of results that are not stored yet.
  void checkResults() const {
    std::size_t next = 0;
    for (std::size_t i = 0; i < local_.size(); ++i) {
      if (!isResult(i)) continue;
      StreamRegion result = detail::reshaped(results_->regions[next++], domain::shapeOf(domain_.own));
      result.placement = ownParts_[i].region.placement;
      checkResultRange(reduction_.fold, reduction_.fold.parameters[i], result);
    }
  }

  bool isResult(std::size_t i) const { return reduction_.fold.parameters[i].role == Role::Accumulator; }

  /// The dimension that is scanned; of a scan over all elements, the only one in which these are divided.
  int scannedDimension() const {
    const Shape& whole = domain_.parts.whole();
    if (options_.along) {
      if (*options_.along < 0 || *options_.along >= whole.rank()) {
        fail(Error::Kind::Shape, reduction_.fold,
             "the domain has shape {}, which has no dimension {}; along is 0 "
             "to {}",
             toString(whole), *options_.along, whole.rank() - 1);
      }
      return *options_.along;
    }
    int slowest = 0;
    while (slowest + 1 < whole.rank() && whole[slowest] == 1) ++slowest;
    for (int d = slowest + 1; d < whole.rank(); ++d) {
      if (domain_.parts.split()[d] == 1) continue;
      fail(reduction_.fold,
           "a scan over all elements goes on from row to row, but the rows are "
           "divided over ranks (split {}); "
           "divide the first dimension alone, .split = {{{}}}, or scan each "
           "line: .with({{.along = ...}})",
           toString(domain_.parts.split()), splitOfFirst(slowest));
    }
    return slowest;
  }
  std::string splitOfFirst(int slowest) const {
    std::string text;
    for (int d = 0; d < domain_.parts.whole().rank(); ++d)
      text += (d == 0 ? "" : ", ") + std::to_string(d == slowest ? domain_.parts.ranks() : 1);
    return text;
  }

  const StreamRegion& resultRegion() const {
    const auto result = std::ranges::find(reduction_.fold.parameters, Role::Accumulator, &Parameter::role);
    return local_[static_cast<std::size_t>(result - reduction_.fold.parameters.begin())].region;
  }

  bool isExact() const {
    return !reduction_.exact.empty() &&
           device().configuration.resolve(reduction_.fold, options_).accumulate == Accumulate::Exact;
  }

  /// Native code keeps doubles if a result does.
  bool isInDoubles() const {
    for (std::size_t i = 0; i < local_.size(); ++i) {
      if (isResult(i) && mpi::isInMemory(local_[i].region) &&
          local_[i].region.stream->storage >= Storage::Extended)
        return true;
    }
    return false;
  }

  Accumulators accumulators(std::int64_t count) const {
    return {device(), reduction_, Shape{count}, isInDoubles()};
  }

  std::vector<Argument> withResults(const Accumulators& results, const Shape& shape) const {
    std::vector<Argument> arguments = local_;
    std::size_t next = 0;
    for (std::size_t i = 0; i < arguments.size(); ++i) {
      if (isResult(i)) arguments[i].region = detail::reshaped(results.regions[next++], shape);
    }
    return arguments;
  }

  mpi::LinesOf lines() const {
    const Shape own = domain::shapeOf(domain_.own);
    if (!options_.along) return {own.size(), 1};
    mpi::LinesOf lines{own[dimension_], 1};
    for (int d = dimension_ + 1; d < own.rank(); ++d) lines.inner *= own[d];
    return lines;
  }

  /// One total for each line of this rank.
  Shape shapeOfTotals() const {
    const Shape own = domain::shapeOf(domain_.own);
    Shape shape = own.with(dimension_, 1);
    for (int d = 0; !options_.along && d < own.rank(); ++d) shape = shape.with(d, 1);
    return shape;
  }
  /// The place of this rank among those along the dimension, which lineOf()
  /// numbers.
  int place() const { return static_cast<int>(domain_.parts.placeOf(domain_.rank)[dimension_]); }
  int ranks() const { return static_cast<int>(domain_.parts.split()[dimension_]); }

  void foldTotals() {
    const Shape shape = shapeOfTotals();
    Accumulators totals = accumulators(shape.size());
    lineBytes_ = totals.elementBytes();
    own_.resize(totals.elements() * lineBytes_);
    if (own_.size() > mpi::mostBytes / static_cast<std::size_t>(ranks())) {
      fail(Error::Kind::Memory, reduction_.fold,
           "it has {} lines on a rank, whose totals do not fit in one message "
           "of {} ranks; divide another "
           "dimension",
           shape.size(), ranks());
    }
    if (place() + 1 < ranks()) {
      CallOptions fold = options_;
      fold.along = {};
      fold.scan = Scan::Default;
      sk::reduce(reduction_, withResults(totals, shape), fold);
      own_ = totals.read();
    }
    all_.resize(own_.size() * static_cast<std::size_t>(ranks()));
  }

  /// The totals of all ranks before this one along the dimension, combined; nullopt on the first rank.
  std::optional<Accumulators> totalsBefore() const {
    if (place() == 0) return std::nullopt;
    const Shape shape = shapeOfTotals();
    const auto totalsOf = [&](int of) {
      const auto from = all_.begin() + static_cast<std::ptrdiff_t>(own_.size()) * of;
      return Bytes(from, from + static_cast<std::ptrdiff_t>(own_.size()));
    };
    std::optional<Accumulators> before;
    before.emplace(accumulators(shape.size())).write(totalsOf(0));
    Accumulators totals = accumulators(shape.size());
    const ResolvedReduction call{
        *before->regions.front().stream->device, reduction_, local_, shape, shape, {}, options_};
    for (int other = 1; other < place(); ++other) {
      totals.write(totalsOf(other));
      mpi::combineEach(domain_, call, *before, totals, {1, shape.size()});
      std::swap(*before, totals);
    }
    return before;
  }

  DomainState& domain_;
  const Reduction& reduction_;
  std::vector<Argument> given_;  ///< placed in the whole
  std::vector<Argument> ownParts_;  ///< the rank's own elements, placed in the whole
  CallOptions options_;
  int dimension_;
  std::vector<Argument> scanned_;  ///< of this rank
  std::vector<Argument> local_;  ///< the same, on the device that computes
  std::optional<Accumulators> results_;
  std::size_t lineBytes_ = 0;
  Bytes own_, all_;  ///< totals: of this rank, and of all along the dimension
};

/// Throws sk::Error unless results are streams of the domain, and nothing but elements is spread.
void checkArguments(DomainState& domain, const Reduction& reduction, std::span<const Argument> arguments) {
  std::vector<Argument> others(arguments.begin(), arguments.end());
  for (std::size_t i = 0; i < arguments.size() && i < reduction.fold.parameters.size(); ++i) {
    const Parameter& parameter = reduction.fold.parameters[i];
    if (parameter.role != Role::Accumulator) continue;
    const DomainStreamState* const result = domainStream(arguments[i].region);
    if (result == nullptr || result->domain != &domain) {
      fail(reduction.fold,
           "'{}' is no stream of the domain whose elements it scans; create it "
           "by domain.stream, with a "
           "result "
           "for each element",
           parameter.name);
    }
    others[i] = {};
  }
  for (const mpi::SpreadArgument& one : mpi::spreadArguments(domain, reduction.fold, others)) {
    if (!one.isGather) continue;
    fail(reduction.fold,
         "'{}' is gathered from a stream of the domain, which a scan over "
         "ranks cannot do; let a kernel store "
         "what is to be scanned",
         reduction.fold.parameters[one.index].name);
  }
}

}  // namespace

void DomainState::scan(const Reduction& reduction, std::span<const Argument> arguments,
                       const CallOptions& chosen) {
  mpi::Call call = mpi::beginCall(*this, reduction.fold, chosen);
  const mpi::KernelDetails details(*this, reduction.fold, arguments, chosen);
  call.details = &details;
  if (agreement.isAlways()) details.addTo(call);
  std::optional<RankScan> scan;
  const mpi::Refusal refusal = mpi::caught(reduction.fold.name, [&] {
    mpi::refuseRecording(*this, reduction.fold);
    checkArguments(*this, reduction, arguments);
    mpi::checkDomain(*this, reduction.fold, arguments, chosen);
    if (!chosen.box.isWhole())
      fail(reduction.fold,
           "a scan takes no box; scan all elements, or let a "
           "kernel store 0 outside of it");
    if (parts.ranks() > 1 && asksPlace(reduction.fold)) {
      fail(reduction.fold,
           "it asks where an element is (indexof, extentof, "
           "neighbor or an iterator), which a scan over ranks "
           "cannot "
           "say; let a kernel store what is to be scanned");
    }
    scan.emplace(*this, reduction, arguments, chosen);
    if (scan->hasMessages()) scan->prepare();
  });
  if (!refusal) call.add(scan->lineBytes());
  if (refusal || call.isFirst || agreement.isAlways() || scan->hasMessages()) agreement.agree(call, refusal);
  const mpi::Communicator* const line = scan->hasMessages() ? &lineOf(scan->dimension()) : nullptr;
  agreement.act(reduction.fold.name, [&] {
    for (std::size_t i = 0; i < arguments.size(); ++i) {
      if (reduction.fold.parameters[i].role == Role::Accumulator)
        domainStream(arguments[i].region)->valid = {};
    }
    if (line != nullptr) scan->exchangeTotals(*line);
    scan->store();
  });
}

}  // namespace sk
