// SPDX-License-Identifier: MIT
//
// A domain and its streams: what this rank holds, how much of it is valid, and the device that computes it,
// with the reductions that combine the results of ranks.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "agreement.hpp"
#include "device/device_state.hpp"
#include "device/stream_state.hpp"
#include "device/unload_watch.hpp"
#include "device/write_scope.hpp"
#include "domain/decomposition.hpp"
#include "messages.hpp"
#include "sk/mpi.hpp"
#include "sk/program.hpp"

namespace sk::mpi {

/// The reduction that folds partial results of another, in order: its `combine` alone.
struct Combination {
  explicit Combination(const program::Reduction& of)
      : operands(of.combine.parameters.size()),
        reduction{.fold = of.combine, .combine = of.combine, .combineOperands = operands, .seeded = true} {
    std::iota(operands.begin(), operands.end(), std::uint8_t{0});
    reduction.commutative = of.commutative;
  }
  Combination(const Combination&) = delete;
  Combination& operator=(const Combination&) = delete;

  std::vector<std::uint8_t> operands;
  program::Reduction reduction;
};

}  // namespace sk::mpi

namespace sk {

namespace mpi {
class RankReduction;
}

/// A stream's elements of this rank, with a halo around them. All ranks keep
/// the same account of what is valid.
class PendingReduction;
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
  Storage storage() const { return local_->storage; }
  /// Makes room for a halo. The elements stay, and so does what is valid.
  void deepen(const domain::Depth& depth);
  /// Calls write(region), which writes all elements of this rank: a lost stream
  /// is whole again. Ends the halo.
  template <class Write>
  void writeOwn(Write&& write);
  /// An array like the one of the elements, to be written while that is read; exchange() then takes it.
  StreamRegion spare();
  void exchange();

  DomainState* domain;  ///< null after the domain has ended
  std::int64_t number =
      0;  ///< among the streams of the domain, from 1 on; with SK_CHECK=collectives the same on all ranks
  const program::Element& element;
  domain::Depth allocated;  ///< the depth of the halo where there is a neighbor; ranks may differ
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
  std::unique_ptr<Staging> toHost,
      toDevice;  ///< null before the first exchange, and if not all ranks have it
};

/// The combinations of reductions, each of which is made at its first use, and ends when the reduction's file is unloaded.
class Combinations {
 public:
  const program::Reduction& of(const program::Reduction& reduction, DeviceState& device);

 private:
  struct Made {
    std::unique_ptr<mpi::Combination> combination;
    std::uint64_t object;  ///< program::LinkedFile::objectOf()
  };
  std::map<const program::Reduction*, Made> made_;
  UnloadWatch unloads_;
};

/// The numbers of the objects that have descriptors (program::LinkedFile::objectOf()): with its address, a number tells a descriptor
/// from one of another file that was loaded in the place of the first.
class ObjectNumbers {
 public:
  std::uint64_t of(const void* descriptor);

 private:
  std::unordered_map<const void*, std::uint64_t> numbers_;
  UnloadWatch unloads_;
};

/// The device of a rank, which domains beside each other share.
struct RankDevice {
  ObjectNumbers objects = {};
  Combinations combinations = {};  ///< outlive the device
  Device device;
  bool stagesHalos;  ///< whether the devices of all ranks do; devices of one host may differ
};

class DomainState final : public detail::Distribution, private mpi::Agreement::Member {
 public:
  /// Collective, as the constructors of sk::Domain.
  static detail::DomainOwner create(MPI_Comm communicator, const DomainOptions& options);
  static detail::DomainOwner createBeside(const DomainState& beside, const DomainOptions& options);
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

  /// Collective where SK_CHECK=collectives asks for it: creates a stream.
  detail::DomainStreamOwner createStream(const program::Element& element, Storage storage,
                                         std::string_view name);

  /// The ranks along a dimension that have this rank's place in all others, in their order. Collective when it is first asked for.
  const mpi::Communicator& lineOf(int dimension);

  std::shared_ptr<mpi::Agreement> sharedAgreement;  ///< by domains beside each other
  mpi::Agreement& agreement;
  mpi::Communicator communicator;
  std::int64_t number = 0;  ///< among the domains beside each other, from 1 on; the same on all ranks
  int rank = 0;
  DomainOptions options;
  domain::Decomposition parts;
  Box own;
  std::vector<Index> directions;
  std::shared_ptr<RankDevice> rankDevice;
  Device& device;
  DomainStatistics statistics;
  std::vector<DomainStreamState*> streams;
  std::int64_t streamCount = 0;  ///< of all that have been created
  detail::TransferOwner* later =
      nullptr;  ///< where the next reduction to a value is kept instead of awaited; or null
  std::vector<PendingReduction*> pending;  ///< of futures that have not ended
  HaloStaging staging;  ///< ends before the device
  std::vector<std::vector<std::byte>> sendBuffers,
      receiveBuffers;  ///< one for each direction, kept

 private:
  struct Start;
  static detail::DomainOwner finish(Start& start, MPI_Comm communicator);
  explicit DomainState(Start& start);
  void forget() noexcept override;
  /// Waits for the messages of reductions whose futures have not ended.
  void endPending() noexcept;
  void checkLater(const program::Reduction& reduction, std::span<void* const> results) const;
  void keepLater(const program::Reduction& reduction, std::span<void* const> results,
                 std::unique_ptr<mpi::RankReduction> part);

  std::array<std::optional<mpi::Communicator>, maxRank> lines_;
};

template <class Write>
void DomainStreamState::writeOwn(Write&& write) {
  const StreamRegion own = part(domain->own);
  if (own.stream->device->recording != nullptr) {
    throw Error(
        "the elements of a sk::DomainStream cannot be written while calls are recorded, because a loop would "
        "not end "
        "its halo; write them outside of Device::record");
  }
  valid = {};
  WriteScope repair;
  if (own.stream->isLost()) {
    repair.add(own.stream);
    repair.begin();
    own.stream->setWritten();  // its halo is not read
  }
  write(own);
  repair.commit();
}

/// The stream of an argument, or null if it is no stream of a domain. Throws sk::Error if its domain has ended.
DomainStreamState* domainStream(const StreamRegion& region);

/// The stream that `what` is asked of. Throws sk::Error if there is none, or if its domain has ended.
DomainStreamState& liveStream(DomainStreamState* stream, std::string_view what);

}  // namespace sk
