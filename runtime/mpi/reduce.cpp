// SPDX-License-Identifier: MIT
//
// Reductions and kernels with folded outputs on streams of a domain: what they fold on this rank, and where the results go.
#include <algorithm>
#include <cstring>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "call/box.hpp"
#include "call/check_call.hpp"
#include "call/check_ranges.hpp"
#include "call/check_reduction.hpp"
#include "call/check_written.hpp"
#include "call/placed.hpp"
#include "call/resolved_call.hpp"
#include "call_details.hpp"
#include "call_plan.hpp"
#include "device/device_state.hpp"
#include "device/stream_state.hpp"
#include "rank_reduction.hpp"

namespace sk {

using mpi::Bytes;
using mpi::RankReduction;
using program::Kernel;
using program::Parameter;
using program::Reduction;
using program::Role;

/// A reduction whose value is asked for later. It ends with its domain, whose communicator its messages need.
class PendingReduction final : public TransferState {
 public:
  PendingReduction(DomainState& domain, std::unique_ptr<RankReduction> reduction)
      : domain_(&domain), reduction_(std::move(reduction)) {
    domain.pending.push_back(this);
  }
  ~PendingReduction() override {
    if (domain_ != nullptr) std::erase(domain_->pending, this);
  }

  bool isReady() override { return reduction_ == nullptr || reduction_->isReady(); }
  void wait() override {
    if (reduction_ != nullptr) reduction_->wait();
  }
  void take(std::byte* value) override {
    if (reduction_ == nullptr) {
      throw Error(
          "the sk::Domain of this future has ended, and its value with it; get() it before the domain ends",
          Error::Kind::Lost);
    }
    void* const values[] = {value};
    reduction_->take(values);
  }
  void endWithDomain() noexcept {
    reduction_.reset();
    domain_ = nullptr;
  }

 private:
  DomainState* domain_;
  std::unique_ptr<RankReduction> reduction_;
};

void DomainState::endPending() noexcept {
  for (PendingReduction* one : pending) one->endWithDomain();
}

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
             "over the ranks of a domain it folds to one value, but '{}' has "
             "shape {}; give an ordinary "
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

/// This rank's part of a reduction to values over the ranks.
std::unique_ptr<RankReduction> partOf(DomainState& domain, const Reduction& reduction,
                                      std::span<const Argument> arguments, const CallOptions& options) {
  const Box box = boxOrAll(options.box, domain.parts.whole());
  checkBox(reduction.fold, box, domain.parts.whole());
  const Box own = domain::intersection(domain.own, box);
  CallOptions others = options;
  others.box = {};
  const Box folded = domain::isEmpty(own) ? domain.own : own;
  const BoxedArguments local =
      argumentsIn(reduction.fold, mpi::ownArguments(arguments), folded, options.over);
  others.over = local.over;
  return std::make_unique<RankReduction>(domain, reduction, local, others, box);
}

/// Stores this rank's part of the outputs of a kernel with folded outputs.
void storeOwnOutputs(DomainState& domain, const Reduction& reduction, std::span<const Argument> arguments,
                     const CallOptions& options) {
  const Box own = domain::intersection(domain.own, boxOrAll(options.box, domain.parts.whole()));
  if (domain::isEmpty(own)) return;
  CallOptions others = options;
  others.box = {};
  const BoxedArguments local =
      mpi::underlying(argumentsIn(reduction.fold, mpi::ownArguments(arguments), own, options.over));
  others.over = local.over;
  void* const toValues[] = {nullptr};
  ResolvedReduction call = checkReduction(reduction, local.arguments, toValues, {}, local.placed, local.over);
  call.options = resolvedOptions(call, others);
  storeOutputs(call);
}

/// Notes what storeOwnOutputs() has written, or a fold that stores outputs.
void noteOwnWritten(DomainState& domain, const Reduction& reduction, std::span<const Argument> arguments,
                    const CallOptions& options) {
  const Box own = domain::intersection(domain.own, boxOrAll(options.box, domain.parts.whole()));
  for (std::size_t i = 0; i < arguments.size() && !domain::isEmpty(own); ++i) {
    if (reduction.fold.parameters[i].role != Role::Output) continue;
    if (DomainStreamState* const stream = domainStream(arguments[i].region)) {
      const StreamRegion part = stream->part(own);
      part.stream->noteUnderlyingWritten();
      noteWritten(part);
    }
  }
}

/// The results of a call that runs for its checks alone.
class RehearsedResults {
 public:
  /// `own`: the elements that it computes.
  RehearsedResults(DeviceState& device, const Box& own, const Shape& whole)
      : device_(device), own_(own), whole_(whole) {}

  /// A part of the whole, like an output.
  StreamRegion part(const StreamRegion& like) {
    StreamRegion region = create(*like.stream->element, domain::shapeOf(own_), like.stream->storage);
    region.placement = {own_.begin, whole_};
    return region;
  }
  StreamRegion value(const program::Element& element) { return create(element, Shape{1}, Storage::Single); }

 private:
  StreamRegion create(const program::Element& element, const Shape& shape, Storage storage) {
    streams_.push_back(device_.createStream(element, shape, storage));
    return {streams_.back().get(), Index::origin(shape.rank()), shape};
  }

  DeviceState& device_;
  const Box own_;
  const Shape whole_;
  std::vector<std::unique_ptr<StreamState>> streams_;
};

/// With SK_CHECK=asserts and SK_CHECK=written, which find something before a call writes: calls it for this rank's part as on one
/// device, with results of our own. Throws sk::Error for what they find.
void rehearse(DomainState& domain, const Reduction& reduction, std::span<const Argument> arguments,
              const CallOptions& options) {
  if (!checksAsserts() && !checksWritten()) return;
  CallOptions part = options;
  part.box = domain::intersection(domain.own, boxOrAll(options.box, domain.parts.whole()));
  if (domain::isEmpty(part.box)) return;
  DeviceState& device = *domain.streams.front()->placed().stream->device;
  const UncountedPasses uncounted(device.passCount);
  RehearsedResults results(device, part.box, domain.parts.whole());
  std::vector<Argument> mine = mpi::ownArguments(arguments);
  std::vector<Bytes> bytes;
  for (std::size_t i = 0; i < mine.size(); ++i) {
    const Parameter& parameter = reduction.fold.parameters[i];
    if (parameter.role == Role::Output && mine[i].region.stream != nullptr)
      mine[i].region = results.part(mine[i].region);
    if (parameter.role != Role::Accumulator) continue;
    mine[i].region = reduction.parts != nullptr ? results.value(*parameter.element) : StreamRegion{};
    bytes.emplace_back(parameter.element->size);
  }
  if (reduction.parts != nullptr) return sk::fold(reduction, mine, part);
  std::vector<void*> values;
  for (Bytes& one : bytes) values.push_back(one.data());
  sk::reduce(reduction, mine, values, part);
}

/// With SK_CHECK=ranges: checks what this rank's own elements hold, and what a fold would store to them. The totals are those of all
/// ranks, and come later.
void checkOwnRanges(DomainState& domain, const Reduction& reduction, std::span<const Argument> arguments,
                    const CallOptions& options) {
  if (!checksRanges()) return;
  checkRangesRead(reduction.fold, mpi::ownParts(arguments));
  CallOptions part = options;
  part.box = domain::intersection(domain.own, boxOrAll(options.box, domain.parts.whole()));
  if (reduction.parts == nullptr || domain::isEmpty(part.box)) return;
  std::vector<Argument> mine = mpi::ownArguments(arguments);
  for (std::size_t i = 0; i < mine.size(); ++i) {
    if (reduction.fold.parameters[i].role == Role::Accumulator)  // one element in any rank
      mine[i].region = detail::reshaped(mine[i].region, Shape{1});
  }
  checkRangesWritten({.device = *domain.streams.front()->placed().stream->device,
                      .kernel = reduction.fold,
                      .arguments = mine,
                      .box = part.box,
                      .checksFolded = false,
                      .run = [&](std::span<const Argument> others, std::span<void* const>) {
                        sk::fold(reduction, others, part);
                      }});
}

/// A call of a reduction or of a kernel with folded outputs.
class Fold {
 public:
  Fold(DomainState& domain, const Reduction& reduction, std::span<const Argument> arguments,
       const CallOptions& options)
      : domain_(domain),
        reduction_(reduction),
        arguments_(arguments),
        options_(options),
        details_(domain, reduction.fold, arguments, options),
        call_(mpi::beginCall(domain, reduction.fold, options)) {
    call_.details = &details_;
    if (domain.agreement.isAlways()) details_.addTo(call_);
  }

  /// Checks what this rank can, and exchanges the halos of gathers. The first
  /// call that fails is kept for start().
  template <class Check>
  void prepare(Check&& check) {
    std::optional<mpi::CallPlan> plan;
    refusal_ = mpi::caught(name(), [&] {
      mpi::refuseRecording(domain_, reduction_.fold);
      const std::vector<mpi::SpreadArgument> spread =
          mpi::spreadArguments(domain_, reduction_.fold, arguments_);
      mpi::checkDomain(domain_, reduction_.fold, arguments_, options_);
      check();
      if (domain_.parts.ranks() == 1 || std::ranges::none_of(spread, &mpi::SpreadArgument::isGather)) return;
      plan.emplace(domain_, reduction_.fold, arguments_, options_);
      plan->prepareExchanges();
    });
    if (!plan || !plan->hasMessages()) return;
    mpi::Call call = call_;
    mpi::KernelDetails details = details_;
    details.setPlan(*plan);
    call.details = &details;
    call.add(plan->hash());
    domain_.agreement.agree(call, std::exchange(refusal_, std::nullopt));
    refusal_ = mpi::caught(name(), [&] { plan->exchangeHalos(); });
  }

  /// Folds this rank's elements, and posts what is collective. Throws sk::Error
  /// on all ranks, here or when they wait, if one of them cannot.
  std::unique_ptr<RankReduction> start(std::span<const Argument> arguments) {
    std::unique_ptr<RankReduction> part;
    if (!refusal_) {
      refusal_ = mpi::caught(name(), [&] {
        part = partOf(domain_, reduction_, arguments, options_);
        rehearse(domain_, reduction_, arguments_, options_);
        checkOwnRanges(domain_, reduction_, arguments_, options_);
        part->fold();
        if (domain_.agreement.isAlways()) part->setDetails(details_.details());
      });
    }
    if (refusal_) {
      domain_.agreement.agree(call_, refusal_);
    } else {
      part->post(call_);
    }
    return part;
  }

  /// What needs no other rank.
  template <class Act>
  void act(Act&& act) {
    if (refusal_) domain_.agreement.failAlone(*refusal_);
    domain_.agreement.act(name(), act);
  }

 private:
  std::string_view name() const { return reduction_.fold.name; }

  DomainState& domain_;
  const Reduction& reduction_;
  const std::span<const Argument> arguments_;
  const CallOptions& options_;
  mpi::KernelDetails details_;
  mpi::Call call_;
  mpi::Refusal refusal_;
};

}  // namespace

void DomainState::reduce(const Reduction& reduction, std::span<const Argument> arguments,
                         std::span<void* const> results, const CallOptions& chosen) {
  Fold call(*this, reduction, arguments, chosen);
  std::optional<StreamResults> targets;
  call.prepare([&] {
    if (results.empty()) targets.emplace(reduction, arguments);
    if (later != nullptr) checkLater(reduction, results.empty() ? targets->values : results);
  });
  if (later != nullptr) {
    std::unique_ptr<RankReduction> part = call.start(arguments);
    return call.act(
        [&] { keepLater(reduction, results.empty() ? targets->values : results, std::move(part)); });
  }
  if (parts.ranks() == 1) {
    return call.act([&] {
      std::vector<Argument> mine = mpi::ownArguments(arguments);
      if (!results.empty()) return sk::reduce(reduction, mine, results, chosen);
      for (std::size_t i = 0; i < mine.size(); ++i) {
        if (reduction.fold.parameters[i].role == Role::Accumulator)  // one element in any rank
          mine[i].region = detail::reshaped(mine[i].region, Shape{1});
      }
      sk::reduce(reduction, mine, chosen);
    });
  }
  const std::unique_ptr<RankReduction> all = call.start(arguments);
  all->receive();
  call.act([&] {
    if (!results.empty()) return all->finish(results);
    all->finish();
    all->store(targets->regions);
  });
}

/// The stub that has called gets zeros.
void DomainState::checkLater(const Reduction& reduction, std::span<void* const> results) const {
  if (results.size() == 1 && !*later) return;
  fail(reduction.fold,
       "later() starts one reduction that has one result; call "
       "it for each, or call the reduction itself");
}

/// Keeps the reduction for the future of detail::later(); the stub that has called gets zeros.
void DomainState::keepLater(const Reduction& reduction, std::span<void* const> results,
                            std::unique_ptr<RankReduction> part) {
  const auto accumulator = std::ranges::find(reduction.fold.parameters, Role::Accumulator, &Parameter::role);
  std::memset(results[0], 0, accumulator->element->size);
  *later = detail::TransferOwner(new PendingReduction(*this, std::move(part)));
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
        "Domain::later: no reduction of a stream of this domain was "
        "called; give one, and its arguments");
  return started;
}

void DomainState::fold(const Reduction& reduction, std::span<const Argument> arguments,
                       const CallOptions& chosen) {
  Fold call(*this, reduction, arguments, chosen);
  std::optional<StreamResults> targets;
  // Native code stores elements while it folds. Otherwise, values are not stored yet, so that the kernel may overwrite what is folded.
  // So that SK_CHECK=ranges can judge the totals before anything is stored, it never does then.
  const bool isTogether = device.profile() == "native" && chosen.accumulate != Accumulate::Exact &&
                          !needsPrecisionVariant(chosen) && !checksRanges();
  std::vector<Argument> inputs;
  call.prepare([&] {
    targets.emplace(reduction, arguments);
    inputs.assign(arguments.begin(), arguments.end());
    for (std::size_t i = 0; i < inputs.size() && !isTogether; ++i) {
      if (reduction.fold.parameters[i].role == Role::Output) inputs[i].region.distributed = nullptr;
    }
  });
  const auto forgetHalos = [&] {
    for (std::size_t i = 0; i < arguments.size(); ++i) {
      if (reduction.fold.parameters[i].role != Role::Output) continue;
      if (DomainStreamState* const stream = domainStream(arguments[i].region)) stream->valid = {};
    }
  };
  if (parts.ranks() == 1) {
    return call.act([&] {
      forgetHalos();
      sk::fold(reduction, mpi::ownArguments(arguments), chosen);
    });
  }
  const std::unique_ptr<RankReduction> all = call.start(inputs);
  all->receive();
  call.act([&] {
    forgetHalos();
    all->finish();
    if (!isTogether) storeOwnOutputs(*this, reduction, arguments, chosen);
    noteOwnWritten(*this, reduction, arguments, chosen);
    all->store(targets->regions);
  });
}

}  // namespace sk
