// SPDX-License-Identifier: MIT
//
// A call of a kernel on this rank's part of a domain: the halos that it exchanges, and the box that it computes. All ranks
// plan the same, because they keep the same account of which halos are valid.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "exchange.hpp"
#include "halo_needs.hpp"

namespace sk::mpi {

class CallPlan {
 public:
  /// Collective at the first call of a kernel. Throws sk::Error, on all ranks, if the kernel cannot run on parts.
  CallPlan(DomainState& domain, const program::Kernel& kernel, std::span<const Argument> arguments,
           const CallOptions& options);

  /// Computes the box of the options with these arguments.
  using Compute = std::function<void(std::span<const Argument> arguments, const CallOptions& options)>;
  void run(const CallOptions& options, const Compute& compute);
  /// Exchanges the halos that the call needs, and computes nothing.
  void exchangeHalos() const;

 private:
  void takeOthers();
  void checkInputs() const;
  void exchangeOthers() const;
  void makeRoom(const domain::Depth& further);
  static void addRequest(std::vector<HaloRequest>& requests, DomainStreamState* stream,
                         const domain::Depth& depth);
  domain::Depth depthAfter(const DomainStreamState& stream) const;
  void replaceArguments();
  bool isAlikeEverywhere() const;
  std::vector<domain::Piece> piecesOf(const Box& box) const;

  DomainState& domain_;
  const program::Kernel& kernel_;
  std::vector<Argument> arguments_;
  std::vector<SpreadArgument> spread_;
  std::vector<SpreadArgument> others_;  ///< gathers of other domains
  std::vector<HaloRequest> requests_;
  std::vector<HaloRequest> otherRequests_;
  domain::Depth beyond_;  ///< elements of the halo that are computed, too
  domain::Depth reach_;  ///< how far the call reads around an element
  std::int64_t unit_ = 1;  ///< boxes should begin at multiples of this many elements of the arrays
  Box box_;
  std::vector<DomainStreamState*> swapped_;
};

/// For comparing the calls of all ranks.
std::uint64_t hashOf(const program::Kernel& kernel, const CallOptions& options);

/// The arguments, with this rank's placed streams for those of the domain.
std::vector<Argument> ownArguments(std::span<const Argument> arguments);

/// Throws sk::Error if the device of the domain records calls.
void refuseRecording(DomainState& domain, const program::Kernel& kernel);

}  // namespace sk::mpi
