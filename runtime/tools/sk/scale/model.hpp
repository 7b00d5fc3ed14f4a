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
//
// The time of messages by the model LogGP: A. Alexandrov, M. Ionescu, K. Schauser, C. Scheiman, "LogGP: Incorporating
// Long Messages into the LogP Model", SPAA 1995, section 3. Only formulas.
//
// Counts what a rank sends when a grid is split into blocks and halos are exchanged, as sk::Domain does it: one message to
// each neighbour, also to those at edges and corners, with the elements of all streams that the call reads. Only integers.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace sk_tool {

/// One number for each dimension, rows first, as in sk::Shape.
using Extents = std::vector<std::int64_t>;

/// How far elements are read before and after the own one, in one dimension.
struct Halo {
  std::int64_t below = 0, above = 0;

  std::int64_t both() const { return below + above; }
  bool operator==(const Halo&) const = default;
};

/// All ways to write `count` as a product of numbers, one for each dimension, in lexicographic order.
std::vector<Extents> processGrids(std::int64_t count, std::size_t rank);

/// How many dimensions have more than one part.
int splitDimensions(const Extents& parts);

/// Elements of part `index` of `parts` of an extent: the first parts have one more where they cannot be equal.
std::int64_t partExtent(std::int64_t extent, std::int64_t parts, std::int64_t index);

/// The elements of a block.
std::int64_t volumeOf(const Extents& block);

/// The split of a grid.
struct Split {
  Extents parts;  ///< of each dimension
  std::vector<bool> periodic;  ///< for each dimension

  /// The halo of a dimension that is exchanged: none if it is not split. If each of two parts is both before and after the
  /// other, both sides are as deep as the deeper one.
  Halo halo(std::size_t dimension, const Halo& read) const;
};

/// A stream whose halo is exchanged.
struct ExchangedStream {
  std::int64_t bytes = 0;  ///< of an element
  std::vector<Halo> halo;  ///< for each dimension
};

struct Sent {
  std::int64_t messages = 0;
  double bytes = 0;
};

/// What the rank at `place` in the grid of processes, with this block, sends for an exchange of all these streams.
Sent sentBy(const Split& split, const Extents& block, const Extents& place,
            std::span<const ExchangedStream> streams);

/// In seconds, and seconds for each byte.
struct Network {
  double latency = 0;  ///< L: from the end of sending to the start of receiving
  double overhead = 0;  ///< o: a processor's time to send or to receive a message
  double gap = 0;  ///< g: between the messages of a processor
  double gapPerByte = 0;  ///< G: between the bytes of a message; the reciprocal of the bandwidth

  /// Parses "25GB/s,2us[,OVERHEAD[,GAP]]". The second word is the time of a short message from one program to the
  /// other, as ping-pong benchmarks report it: L + 2o. The overhead is a quarter of it unless given; the gap is the
  /// overhead. Throws std::runtime_error.
  static Network parse(const std::string& text);
};

/// The time until a processor has sent and received `messages` messages with `bytes` bytes in all, as its
/// neighbours do at the same time: o + (messages - 1) max(g, o) + (bytes - messages) G + L + o.
double exchangeTime(const Network& network, std::int64_t messages, double bytes);

/// The time of an all-reduce of `bytes` bytes by recursive doubling: ceil(log2 ranks) exchanges, one after the other.
double allReduceTime(const Network& network, std::int64_t ranks, double bytes);

/// Copies between a device and host memory, which messages of a GPU need: seconds and bytes per second. The device carries
/// them out between its kernels, so that no kernel hides them. All 0: messages are sent from where the stream is, as native
/// devices do.
struct Staging {
  double readTime = 0, readBandwidth = 0;
  double writeTime = 0, writeBandwidth = 0;

  bool isNeeded() const { return readTime > 0; }
  double time(double bytes) const;

  /// Parses "READ_BANDWIDTH,READ_TIME,WRITE_BANDWIDTH,WRITE_TIME", or "none". Throws std::runtime_error.
  static Staging parse(const std::string& text);
};

/// What it costs a device to compute a box of a stream in place of all of it.
struct Boxes {
  double factor = 1;  ///< times as long for an element
  double borderTime = 0;  ///< seconds of a call for one border

  /// Parses "FACTOR,TIME". Throws std::runtime_error.
  static Boxes parse(const std::string& text);
};

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
