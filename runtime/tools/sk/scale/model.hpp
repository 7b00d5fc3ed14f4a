// SPDX-License-Identifier: MIT
//
// Predicts the time of a step on many devices: the rates of its kernels on one device, their halos, and the network.
// A pure function of numbers: it runs nothing and prints nothing. docs/domains.md explains the terms.
//
// A step calls kernels one after the other, and each reads what the one before has written. A call with gathers that reach
// beyond the block exchanges their halos while it computes the interior, and then computes the rest. Only messages are under
// way meanwhile: a device with a queue copies halos to and from host memory between its kernels. If several calls share
// an exchange, halos are as many times as deep, and blocks are computed with a margin that shrinks from call to call.
// (DomainOptions::exchangeEvery.)
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scale/halo_exchange.hpp"
#include "scale/network.hpp"

namespace sk_tool {

/// A gather from a stream whose elements change from step to step.
struct ExchangedGather {
  std::string name;
  ExchangedStream stream;
};

/// A call of a kernel in a step.
struct StepCall {
  std::string name;
  double perCall = 0;  ///< seconds that a call takes for any number of elements
  double perElement = 0;  ///< seconds
  Boxes boxes = {};  ///< of calls that compute a part of what a device holds
  std::vector<ExchangedGather> gathers = {};
  std::int64_t reducedBytes =
      0;  ///< of the value that all ranks combine; 0: the call is no reduction to a value

  /// The farthest of its gathers, for each dimension.
  std::vector<Halo> reach(std::size_t rank) const;
};

struct ScaledStep {
  Extents grid;  ///< rows first
  std::vector<bool> periodic;  ///< for each dimension
  bool isPerDevice =
      false;  ///< the grid is each device's block, so that the whole grows with the number of devices
  std::vector<StepCall> calls;
  double bytesPerElement = 0;  ///< of all streams together
};

struct Cluster {
  Network network;
  Staging staging = {};
  std::optional<double> memory = {};  ///< bytes of a device; without it, every block fits
  bool hasOverlap = true;
};

/// A way to distribute a step, and what the model says of it. Times are seconds per step, of the slowest rank.
struct Distribution {
  std::int64_t devices = 1;
  Extents parts;  ///< of each dimension
  Extents block;  ///< the largest
  std::int64_t exchangeEvery = 1;  ///< calls that read neighbours
  double time = 0;
  double compute = 0;  ///< of kernels, margins and extra calls for borders included
  double exchange = 0;  ///< of halos, hidden or not, and of reductions
  double waiting = 0;  ///< the part of `exchange` that no kernel hides
  double efficiency =
      1;  ///< time of one device / (devices * time); if the grid is per device, time of one / time
  double messages = 0, bytes = 0;  ///< sent by a rank with neighbours on all sides, per step
  double memory = 0;  ///< bytes of a device for streams with their halos
};

/// Predicts one distribution; nullopt if a block is thinner than its halo. `singleTime` is timeOfOne().
std::optional<Distribution> predict(const ScaledStep& step, const Cluster& cluster, const Extents& parts,
                                    std::int64_t exchangeEvery, double singleTime);

/// Seconds per step on one device, with memory for everything.
double timeOfOne(const ScaledStep& step);

/// The best distributions over a number of devices.
struct BestOf {
  std::int64_t devices = 1;
  std::optional<Distribution> best;  ///< empty if every block would be thinner than its halo
  std::vector<std::optional<Distribution>> byDimensions;  ///< the best that splits 1, 2 or 3 dimensions
  bool fits = true;  ///< the best one fits the memory
};

/// Tries every grid of processes that splits at most three dimensions, with an exchange every 1, 2, 4 ... 32 calls that read
/// neighbours, or as `exchangeEvery` says.
BestOf bestOf(const ScaledStep& step, const Cluster& cluster, std::int64_t devices,
              std::optional<std::int64_t> exchangeEvery = {});

}  // namespace sk_tool
