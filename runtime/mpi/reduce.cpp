// SPDX-License-Identifier: MIT
//
// Reductions and kernels with folded outputs on streams of a domain: what they fold on this rank, and where the results go.
#include <algorithm>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include "call/box.hpp"
#include "call/check_argument.hpp"
#include "call/check_reduction.hpp"
#include "call/placed.hpp"
#include "call/precision.hpp"
#include "call_plan.hpp"
#include "device/transfer_state.hpp"
#include "rank_reduction.hpp"

namespace sk {

using mpi::Bytes;
using mpi::RankReduction;
using program::Kernel;
using program::Parameter;
using program::Reduction;
using program::Role;

namespace {

/// The arguments of accumulators, which are streams of one element, and values in host memory for them.
class StreamResults {
 public:
  StreamResults(const Reduction& reduction, std::span<const Argument> arguments) {
    for (std::size_t i = 0; i < arguments.size(); ++i) {
      const Parameter& parameter = reduction.fold.parameters[i];
      if (parameter.role != Role::Accumulator) continue;
      const StreamRegion& region = arguments[i].region;
      if (region.distributed != nullptr || region.shape.size() != 1) {
        fail(Error::Kind::Shape, reduction.fold,
             "over the ranks of a domain it folds to one value, but '{}' has shape {}; give an ordinary "
             "stream of one "
             "element, or take the value that the call returns",
             parameter.name, toString(region.shape));
      }
      regions.push_back(region);
      bytes_.emplace_back(parameter.element->size);
    }
    for (Bytes& one : bytes_) values.push_back(one.data());
  }

  std::vector<StreamRegion> regions;
  std::vector<void*> values;

 private:
  std::vector<Bytes> bytes_;
};

/// Starts a reduction to values over the ranks.
std::unique_ptr<RankReduction> started(DomainState& domain, const Reduction& reduction,
                                       std::span<const Argument> arguments, const CallOptions& options) {
  const Box box = boxOrAll(options.box, domain.parts.whole());
  checkBox(reduction.fold, box, domain.parts.whole());
  const Box own = domain::intersection(domain.own, box);
  CallOptions others = options;
  others.box = {};
  const Box folded = domain::isEmpty(own) ? domain.own : own;
  const BoxedArguments local = argumentsIn(reduction.fold, mpi::ownArguments(arguments), folded);
  auto reductionOfAll = std::make_unique<RankReduction>(domain, reduction, local, others, box);
  reductionOfAll->start();
  return reductionOfAll;
}

/// Stores this rank's part of the outputs of a kernel with folded outputs.
void storeOwnOutputs(DomainState& domain, const Reduction& reduction, std::span<const Argument> arguments,
                     const CallOptions& options) {
  const Box own = domain::intersection(domain.own, boxOrAll(options.box, domain.parts.whole()));
  if (domain::isEmpty(own)) return;
  CallOptions others = options;
  others.box = {};
  const BoxedArguments local = argumentsIn(reduction.fold, mpi::ownArguments(arguments), own);
  void* const toValues[] = {nullptr};
  ResolvedReduction call = checkReduction(reduction, local.arguments, toValues, {}, local.placed);
  call.options = resolvedOptions(call, others);
  storeOutputs(call);
}

/// A reduction whose value is asked for later.
class PendingReduction final : public TransferState {
 public:
  explicit PendingReduction(std::unique_ptr<RankReduction> reduction) : reduction_(std::move(reduction)) {}

  bool isReady() override { return reduction_->isReady(); }
  void wait() override { reduction_->wait(); }
  void take(std::byte* value) override {
    void* const values[] = {value};
    reduction_->finish(values);
  }

 private:
  std::unique_ptr<RankReduction> reduction_;
};

/// What every call does first: compares what the ranks call, and exchanges the halos of gathers.
void begin(DomainState& domain, const Reduction& reduction, std::span<const Argument> arguments,
           const CallOptions& options) {
  mpi::refuseRecording(domain, reduction.fold);
  domain.agree(&reduction, mpi::hashOf(reduction.fold, options), reduction.fold.name);
  const std::vector<mpi::SpreadArgument> spread = mpi::spreadArguments(domain, reduction.fold, arguments);
  if (domain.parts.ranks() > 1 && std::ranges::any_of(spread, &mpi::SpreadArgument::isGather))
    mpi::CallPlan(domain, reduction.fold, arguments, options).exchangeHalos();
}

}  // namespace

void DomainState::reduce(const Reduction& reduction, std::span<const Argument> arguments,
                         std::span<void* const> results, const CallOptions& chosen) {
  begin(*this, reduction, arguments, chosen);
  if (results.empty()) {
    const StreamResults targets(reduction, arguments);
    if (later != nullptr) return reduceLater(reduction, arguments, targets.values, chosen);
    if (parts.ranks() == 1) {
      std::vector<Argument> own = mpi::ownArguments(arguments);
      for (std::size_t i = 0; i < own.size(); ++i) {
        if (reduction.fold.parameters[i].role == Role::Accumulator)  // one element in any rank
          own[i].region = detail::reshaped(own[i].region, Shape{1});
      }
      return sk::reduce(reduction, own, chosen);
    }
    const std::unique_ptr<RankReduction> all = started(*this, reduction, arguments, chosen);
    all->finish();
    return all->store(targets.regions);
  }
  if (later != nullptr) return reduceLater(reduction, arguments, results, chosen);
  if (parts.ranks() == 1) return sk::reduce(reduction, mpi::ownArguments(arguments), results, chosen);
  started(*this, reduction, arguments, chosen)->finish(results);
}

/// Keeps the reduction for the future of detail::later(); the stub that has called gets zeros.
void DomainState::reduceLater(const Reduction& reduction, std::span<const Argument> arguments,
                              std::span<void* const> results, const CallOptions& chosen) {
  if (results.size() != 1 || *later) {
    fail(reduction.fold,
         "later() starts one reduction that has one result; call it for each, or call the reduction itself");
  }
  const auto accumulator = std::ranges::find(reduction.fold.parameters, Role::Accumulator, &Parameter::role);
  std::memset(results[0], 0, accumulator->element->size);
  *later = detail::TransferOwner(new PendingReduction(started(*this, reduction, arguments, chosen)));
}

detail::TransferOwner detail::later(DomainState* domain, void (*call)(void*), void* context) {
  TransferOwner started;
  if (domain == nullptr)
    throw Error("the sk::Domain was moved from; use the one that it was moved to", Error::Kind::Lost);
  domain->later = &started;
  try {
    call(context);
  } catch (...) {
    domain->later = nullptr;
    throw;
  }
  domain->later = nullptr;
  if (!started)
    throw Error(
        "Domain::later: no reduction of a stream of this domain was called; give one, and its arguments");
  return started;
}

void DomainState::fold(const Reduction& reduction, std::span<const Argument> arguments,
                       const CallOptions& chosen) {
  begin(*this, reduction, arguments, chosen);
  const StreamResults targets(reduction, arguments);
  if (parts.ranks() == 1) {
    sk::fold(reduction, mpi::ownArguments(arguments), chosen);
  } else {
    const bool isTogether = device.profile() == "native" && chosen.accumulate != Accumulate::Exact &&
                            !needsPrecisionVariant(chosen);
    if (isTogether) {  // native code stores elements while it folds
      const std::unique_ptr<RankReduction> all = started(*this, reduction, arguments, chosen);
      all->finish();
      all->store(targets.regions);
    } else {  // values are not stored yet, so that the kernel may overwrite what is folded
      std::vector<Argument> inputs(arguments.begin(), arguments.end());
      for (std::size_t i = 0; i < inputs.size(); ++i) {
        if (reduction.fold.parameters[i].role == Role::Output) inputs[i].region.distributed = nullptr;
      }
      const std::unique_ptr<RankReduction> all = started(*this, reduction, inputs, chosen);
      all->finish();
      storeOwnOutputs(*this, reduction, arguments, chosen);
      all->store(targets.regions);
    }
  }
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (reduction.fold.parameters[i].role != Role::Output) continue;
    if (DomainStreamState* const stream = domainStream(arguments[i].region)) stream->valid = {};
  }
}

}  // namespace sk
