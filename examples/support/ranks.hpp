// SPDX-License-Identifier: MIT
//
// The processes that run an example together, as mpirun or srun starts them. This header knows no MPI; joinRanks() and divideGrid() do,
// which are in the library sk_examples_ranks. Where MPI is not installed, each process is alone.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <sk/shape.hpp>

#include "support/grid_stream.hpp"

namespace examples {

/// How many processes a launcher of MPI says that it has started, of which this is one; 0 without a launcher.
int startedProcesses();

/// Whether the elements at the ends of a grid are neighbors of those at the other ends, as [[wrap]] gathers have it.
enum class Ends : std::uint8_t { Open, Joined };

/// One process alone. Derived classes are processes that compute together.
class Ranks {
 public:
  virtual ~Ranks() = default;
  virtual int rank() const { return 0; }
  virtual int count() const { return 1; }
  /// Whether this process prints and writes files.
  bool isFirst() const { return rank() == 0; }

  /// Why a process is alone although a launcher has started several, and what to do about it.
  virtual std::string_view whyAlone() const { return "it computes in one process; start it without mpirun"; }
  /// Divides a grid, which has elements, over the ranks. The device is that of --device. Null if there is nothing to divide it over.
  virtual std::unique_ptr<DividedGrid> divide(const std::string& device, const sk::Shape& shape, Ends ends);

  /// Called once, at the end of the program, with the message that it ends with on this rank, or an empty text. Prints
  /// what all ranks say once. If others go on, ends them, too: they would wait for this rank.
  virtual void end(const std::string& error);

  /// Throws std::runtime_error if there are several ranks: `what` is for one. `instead` says what to do.
  void refuseSeveral(std::string_view what, std::string_view instead) const;
};

/// A grid's space, and what it is made of: the ranks' devices, or one device if this process is alone. The arguments are those of Ranks::divide().
class OwnedSpace {
 public:
  OwnedSpace(Ranks& ranks, const std::string& device, const sk::Shape& shape, Ends ends);
  OwnedSpace(const OwnedSpace&) = delete;
  OwnedSpace& operator=(const OwnedSpace&) = delete;
  const Space& get() const { return *space_; }

 private:
  std::unique_ptr<DividedGrid> divided_;
  std::optional<sk::Device> device_;
  std::optional<Space> space_;
};

/// "4 ranks, each on native", or the device's name alone.
std::string placeOf(const Ranks& ranks, std::string_view device);

/// All processes that a launcher has started with this one; without a launcher, this process alone. On all ranks but the first,
/// standard output leads nowhere from then on.
std::unique_ptr<Ranks> joinRanks();

/// Divides a grid over all ranks. MPI must have been initialized. Throws std::logic_error where it is not installed.
std::unique_ptr<DividedGrid> divideGrid(const std::string& device, const sk::Shape& shape, Ends ends);

}  // namespace examples
