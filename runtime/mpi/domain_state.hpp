// SPDX-License-Identifier: MIT
//
// A domain and its streams: what this rank holds, how much of it is valid, and the device that computes it.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "combination.hpp"
#include "device/staging.hpp"
#include "domain/decomposition.hpp"
#include "messages.hpp"
#include "sk/mpi.hpp"

namespace sk {

/// A stream's elements of this rank, with a halo around them. All ranks keep the same depths.
class DomainStreamState final : public detail::DistributedStream {
 public:
  DomainStreamState(DomainState& domain, const program::Element& element, Storage storage,
                    std::string_view name);
  ~DomainStreamState();
  DomainStreamState(const DomainStreamState&) = delete;
  DomainStreamState& operator=(const DomainStreamState&) = delete;

  detail::Distribution& distribution() override;

  /// The elements with their halo, placed in the whole.
  StreamRegion placed() const;
  /// The elements of a box of the whole, all of which are held.
  StreamRegion part(const Box& box) const;
  StreamRegion part(StreamState* state, const Box& box) const;
  /// Makes room for a halo; the elements of the rank stay, the halo is invalid afterwards.
  void deepen(const domain::Depth& depth);
  /// An array like the one of the elements, to be written while that is read; exchange() then takes it.
  StreamRegion spare();
  void exchange();

  DomainState* domain;  ///< null after the domain has ended
  const program::Element& element;
  domain::Depth allocated;  ///< the depth of the halo where there is a neighbor
  domain::Depth valid;  ///< the depth in which the halo has the elements of the neighbors

 private:
  detail::StreamOwner create() const;
  StreamRegion placed(StreamState* state) const;

  Storage storage_;
  std::string name_;
  detail::StreamOwner local_, spare_;
};

/// The memory through which halos reach a GL device's streams.
struct HaloStaging {
  bool isChosen = false;  ///< whether the ranks have found out if all of them have it
  std::unique_ptr<Staging> toHost;  ///< null: at least one has not
  std::unique_ptr<Staging> toDevice;
};

/// The device of a rank, which domains beside each other share.
struct RankDevice {
  std::map<const void*, std::unique_ptr<mpi::Combination>> combinations;  ///< outlive the device
  Device device;
};

class DomainState final : public detail::Distribution {
 public:
  DomainState(MPI_Comm communicator, const DomainOptions& options);
  /// On the ranks and the device of another domain.
  DomainState(const DomainState& beside, const DomainOptions& options);
  ~DomainState();
  DomainState(const DomainState&) = delete;
  DomainState& operator=(const DomainState&) = delete;

  void run(const program::Kernel& kernel, std::span<const Argument> arguments,
           const CallOptions& options) override;
  void reduce(const program::Reduction& reduction, std::span<const Argument> arguments,
              std::span<void* const> results, const CallOptions& options) override;
  void fold(const program::Reduction& reduction, std::span<const Argument> arguments,
            const CallOptions& options) override;
  void scan(const program::Reduction& reduction, std::span<const Argument> arguments,
            const CallOptions& options) override;

  /// Collective where `key` is new: throws sk::Error on all ranks unless all give the same hash. `what` names the call.
  void agree(const void* key, std::uint64_t hash, std::string_view what);

  /// The ranks along a dimension that have this rank's place in all others, in their order. Collective when it is first asked for.
  const mpi::Communicator& lineOf(int dimension);

  mpi::Communicator communicator;
  int rank = 0;
  DomainOptions options;
  domain::Decomposition parts;
  Box own;
  std::vector<Index> directions;
  std::shared_ptr<RankDevice> rankDevice;
  Device& device;
  DomainStatistics statistics;
  std::vector<DomainStreamState*> streams;
  detail::TransferOwner* later =
      nullptr;  ///< where the next reduction to a value is kept instead of awaited; or null
  HaloStaging staging;  ///< ends before the device
  std::vector<std::vector<std::byte>> sendBuffers, receiveBuffers;  ///< one for each direction, kept

 private:
  DomainState(MPI_Comm communicator, const DomainOptions& options, std::shared_ptr<RankDevice> shared);
  void reduceLater(const program::Reduction& reduction, std::span<const Argument> arguments,
                   std::span<void* const> results, const CallOptions& options);

  std::set<const void*> agreed_;
  std::map<int, mpi::Communicator> lines_;
};

/// The stream of an argument, or null if it is no stream of a domain. Throws sk::Error if its domain has ended.
DomainStreamState* domainStream(const StreamRegion& region);

/// The stream that `what` is asked of. Throws sk::Error if there is none, or if its domain has ended.
DomainStreamState& liveStream(DomainStreamState* stream, std::string_view what);

}  // namespace sk
