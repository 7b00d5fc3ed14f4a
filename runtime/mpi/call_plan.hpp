// SPDX-License-Identifier: MIT
//
// A call of a kernel on this rank's part of a domain: the halos that it exchanges, and the box that it computes. All ranks
// plan the same, because they keep the same account of which halos are valid.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "exchange.hpp"
#include "halo_needs.hpp"

namespace sk::mpi {

class CallPlan {
 public:
  /// Changes nothing. Throws sk::Error if the kernel cannot run on parts: on
  /// all ranks, if all give the same arguments.
  CallPlan(DomainState& domain, const program::Kernel& kernel, std::span<const Argument> arguments,
           const CallOptions& options);

  /// Whether halos are exchanged.
  bool hasMessages() const { return !requests_.empty() || !otherRequests_.empty(); }
  /// What is exchanged, to compare it, and in words.
  std::uint64_t hash() const;
  std::string halos() const;
  /// Makes ready on this rank what may fail: the arrays and buffers of the
  /// exchanges, and of the call, if it computes. Throws sk::Error.
  void prepareExchanges();
  void prepare();

  /// Computes the box of the options with these arguments.
  using Compute = std::function<void(std::span<const Argument> arguments, const CallOptions& options)>;
  /// After prepare(), on all ranks. The account is that of a call that has
  /// succeeded, even if this one throws.
  void run(const Compute& compute);
  /// Exchanges the halos that the call needs, after prepareExchanges(), and
  /// computes nothing.
  void exchangeHalos();

 private:
  void takeOthers();
  void checkInputs() const;
  bool readsOwn(const SpreadArgument& one) const;
  DeviceState& device() const;
  void evaluateAssertions() const;
  void checkOwnRanges() const;
  void startExchanges();
  void finishOthers();
  void makeRoom();
  static void addRequest(std::vector<HaloRequest>& requests, DomainStreamState* stream,
                         const domain::Depth& depth);
  domain::Depth depthAfter(const DomainStreamState& stream) const;
  bool isOneBox() const;
  void replaceArguments();
  bool isAlikeEverywhere() const;
  std::vector<domain::Piece> piecesOf(const Box& box) const;

  DomainState& domain_;
  const program::Kernel& kernel_;
  CallOptions options_;
  std::vector<Argument> arguments_;
  std::vector<SpreadArgument> spread_;
  std::vector<SpreadArgument> others_;  ///< gathers of other domains
  std::vector<HaloRequest> requests_;
  std::vector<HaloRequest> otherRequests_;
  domain::Depth further_;  ///< deeper than what is read, for later calls
  domain::Depth beyond_;  ///< elements of the halo that are computed, too
  domain::Depth reach_;  ///< how far the call reads around an element
  std::int64_t unit_ = 1;  ///< boxes should begin at multiples of this many elements of the arrays
  Box box_;
  std::vector<DomainStreamState*> swapped_;
  std::vector<std::unique_ptr<Exchange>> otherExchanges_;
  std::optional<Exchange> exchange_;
};

/// Begins a call: counts it, and says whether the ranks have to compare it.
Call beginCall(DomainState& domain, const program::Kernel& kernel, const CallOptions& options);

/// The arguments, with this rank's placed streams for those of the domain.
std::vector<Argument> ownArguments(std::span<const Argument> arguments);

/// This rank's own elements of a stream, placed in the whole.
StreamRegion ownPart(const DomainStreamState& stream);
/// The arguments, with these for the streams of a domain.
std::vector<Argument> ownParts(std::span<const Argument> arguments);

/// Throws sk::Error if the device of the domain records calls.
void refuseRecording(DomainState& domain, const program::Kernel& kernel);

/// Throws sk::Error if the domain of the call, where over(), an iterator or an ordinary input says it, has another shape than that of
/// the ranks.
void checkDomain(const DomainState& domain, const program::Kernel& kernel,
                 std::span<const Argument> arguments, const CallOptions& options);

}  // namespace sk::mpi
