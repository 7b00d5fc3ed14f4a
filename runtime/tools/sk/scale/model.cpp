// SPDX-License-Identifier: MIT
#include "scale/model.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "scale/quantities.hpp"

namespace sk_tool {

namespace {

// Which calls exchange repeats after some steps.
constexpr int firstSteps = 8, mostSteps = 256;

using Halos = std::vector<Halo>;  // one for each dimension

Halos times(Halos halos, std::int64_t factor) {
  for (Halo& halo : halos) halo = {halo.below * factor, halo.above * factor};
  return halos;
}

Halos less(Halos halos, const Halos& other) {
  for (std::size_t d = 0; d < halos.size(); ++d) {
    halos[d].below -= other[d].below;
    halos[d].above -= other[d].above;
  }
  return halos;
}

bool covers(const Halos& halos, const Halos& other) {
  for (std::size_t d = 0; d < halos.size(); ++d) {
    if (halos[d].below < other[d].below || halos[d].above < other[d].above) return false;
  }
  return true;
}

/// One way to distribute a step.
class Prediction {
 public:
  Prediction(const ScaledStep& step, const Cluster& cluster, const Extents& parts, std::int64_t exchangeEvery)
      : step_(step), cluster_(cluster), split_{parts, step.periodic}, every_(exchangeEvery) {
    result_.parts = parts;
    result_.exchangeEvery = exchangeEvery;
    for (const std::int64_t part : parts) result_.devices *= part;
    for (std::size_t d = 0; d < parts.size(); ++d) {
      result_.block.push_back(step.isPerDevice ? step.grid[d] : partExtent(step.grid[d], parts[d], 0));
      place_.push_back(parts[d] > 2 ? 1 : 0);  // has neighbours on both sides, if any rank has
    }
    for (const StepCall& call : step.calls) {
      reaches_.push_back(call.reach(step.grid.size()));
      for (std::size_t d = 0; d < parts.size(); ++d) reaches_.back()[d] = split_.halo(d, reaches_.back()[d]);
    }
  }

  /// Whether each block has the elements that its neighbours need.
  bool isPossible() const {
    for (std::size_t d = 0; d < result_.parts.size(); ++d) {
      const std::int64_t parts = result_.parts[d];
      const std::int64_t least = step_.isPerDevice ? step_.grid[d] : step_.grid[d] / parts;
      if (least < 1) return false;
      for (const Halos& reach : reaches_) {
        if (std::max(reach[d].below, reach[d].above) * every_ > least) return false;
      }
    }
    return true;
  }

  Distribution run() {
    Halos valid(step_.grid.size());  // elements around the block that are what the neighbours have
    const auto addStep = [&] {
      for (std::size_t i = 0; i < step_.calls.size(); ++i) valid = add(step_.calls[i], reaches_[i], valid);
    };
    for (int step = 0; step < firstSteps; ++step) addStep();
    for (double* total : totals()) *total = 0;
    const Halos start = valid;
    int steps = 0;
    do {
      addStep();
      ++steps;
    } while (valid != start && steps < mostSteps);
    for (double* total : totals()) *total /= steps;
    result_.time = result_.compute + result_.waiting;
    Extents held = result_.block;
    for (const Halos& reach : reaches_) {
      const Extents one = grown(result_.block, times(reach, every_));
      for (std::size_t d = 0; d < held.size(); ++d) held[d] = std::max(held[d], one[d]);
    }
    result_.memory = static_cast<double>(volumeOf(held)) * step_.bytesPerElement;
    return result_;
  }

 private:
  struct ExchangeTimes {
    double messages, copies;
  };

  static Extents grown(Extents block, const Halos& margin) {
    for (std::size_t d = 0; d < block.size(); ++d) block[d] += margin[d].both();
    return block;
  }

  std::array<double*, 5> totals() {
    return {&result_.compute, &result_.exchange, &result_.waiting, &result_.messages, &result_.bytes};
  }

  /// Adds a call, and returns how much is valid around what it has written.
  Halos add(const StepCall& call, const Halos& reach, const Halos& valid) {
    const double reduction = reductionTime(call);
    result_.exchange += reduction;
    result_.waiting += reduction;
    const bool exchanges = !covers(valid, reach);
    const Halos depth = exchanges ? times(reach, every_) : valid;
    const Halos margin = every_ == 1 ? Halos(reach.size()) : less(depth, reach);
    const double volume = static_cast<double>(volumeOf(grown(result_.block, margin)));
    const double factor = result_.devices > 1 ? call.boxes.factor : 1;  // what is held has a halo
    result_.compute += call.perCall + volume * call.perElement * factor;
    if (exchanges) addExchange(call, reach, exchangeOf(call, less(depth, reach)));
    return margin;
  }

  void addExchange(const StepCall& call, const Halos& reach, const ExchangeTimes& exchange) {
    result_.exchange += exchange.messages + exchange.copies;
    result_.waiting += exchange.messages + exchange.copies;
    Extents interior = result_.block;
    for (std::size_t d = 0; d < interior.size(); ++d) interior[d] -= reach[d].both();
    const bool isEmpty = std::ranges::any_of(interior, [](std::int64_t extent) { return extent <= 0; });
    if (!cluster_.hasOverlap || isEmpty) return;
    const double hiding =
        call.perCall + static_cast<double>(volumeOf(interior)) * call.perElement * call.boxes.factor;
    result_.waiting -= std::min(exchange.messages, hiding);
    result_.compute += 2 * splitDimensions(result_.parts) * call.boxes.borderTime;  // a call for each side
  }

  /// Exchanges the gathers' halos, with `further` more elements around them.
  ExchangeTimes exchangeOf(const StepCall& call, const Halos& further) {
    std::vector<ExchangedStream> streams;
    for (const ExchangedGather& gather : call.gathers) {
      streams.push_back(gather.stream);
      for (std::size_t d = 0; d < further.size(); ++d) {
        streams.back().halo[d].below += further[d].below;
        streams.back().halo[d].above += further[d].above;
      }
    }
    const Sent sent = sentBy(split_, result_.block, place_, streams);
    result_.messages += static_cast<double>(sent.messages);
    result_.bytes += sent.bytes;
    return {exchangeTime(cluster_.network, sent.messages, sent.bytes), cluster_.staging.time(sent.bytes)};
  }

  double reductionTime(const StepCall& call) const {
    if (call.reducedBytes == 0 || result_.devices == 1) return 0;
    const auto bytes = static_cast<double>(call.reducedBytes);
    return cluster_.staging.time(bytes) + allReduceTime(cluster_.network, result_.devices, bytes);
  }

  const ScaledStep& step_;
  const Cluster& cluster_;
  Split split_;
  std::int64_t every_;
  std::vector<Halos> reaches_;  ///< of each call, in dimensions that are split
  Extents place_;
  Distribution result_;
};

bool fits(const Distribution& one, const Cluster& cluster) {
  return !cluster.memory || one.memory <= *cluster.memory;
}

/// The best of those that `counts` accepts: what fits the memory before what does not, then the fastest. Among those that are
/// as fast but for one in a thousand, it is the one with the shallowest halos and the least exchange, because it depends
/// least on the network; and the first one.
template <class Counts>
std::optional<Distribution> bestOf(const std::vector<Distribution>& all, const Cluster& cluster,
                                   Counts&& counts) {
  bool anyFits = false;
  for (const Distribution& one : all) anyFits = anyFits || (counts(one) && fits(one, cluster));
  std::vector<const Distribution*> chosen;
  for (const Distribution& one : all) {
    if (counts(one) && fits(one, cluster) == anyFits) chosen.push_back(&one);
  }
  if (chosen.empty()) return std::nullopt;
  const double limit = 1.001 * (*std::ranges::min_element(chosen, {}, &Distribution::time))->time;
  std::erase_if(chosen, [limit](const Distribution* one) { return one->time > limit; });
  return **std::ranges::min_element(
      chosen, {}, [](const Distribution* one) { return std::pair(one->exchangeEvery, one->exchange); });
}

}  // namespace

std::vector<Halo> StepCall::reach(std::size_t rank) const {
  std::vector<Halo> all(rank);
  for (const ExchangedGather& gather : gathers) {
    for (std::size_t d = 0; d < rank; ++d) {
      all[d].below = std::max(all[d].below, gather.stream.halo[d].below);
      all[d].above = std::max(all[d].above, gather.stream.halo[d].above);
    }
  }
  return all;
}

double timeOfOne(const ScaledStep& step) {
  double time = 0;
  for (const StepCall& call : step.calls) {
    time += call.perCall + static_cast<double>(volumeOf(step.grid)) * call.perElement;
  }
  return time;
}

std::optional<Distribution> predict(const ScaledStep& step, const Cluster& cluster, const Extents& parts,
                                    std::int64_t exchangeEvery, double singleTime) {
  Prediction prediction(step, cluster, parts, exchangeEvery);
  if (!prediction.isPossible()) return std::nullopt;
  Distribution result = prediction.run();
  const double share = step.isPerDevice ? 1 : static_cast<double>(result.devices);
  result.efficiency = singleTime / (share * result.time);
  return result;
}

BestOf bestOf(const ScaledStep& step, const Cluster& cluster, std::int64_t devices,
              std::optional<std::int64_t> exchangeEvery) {
  const double single = timeOfOne(step);
  const std::vector<std::int64_t> choices =
      exchangeEvery ? std::vector{*exchangeEvery} : std::vector<std::int64_t>{1, 2, 4, 8, 16, 32};
  std::vector<Distribution> all;
  std::vector<Extents> grids = processGrids(devices, step.grid.size());
  std::ranges::reverse(grids);  // faces of slow dimensions, which are contiguous, come first
  for (const Extents& parts : grids) {
    const int dimensions = splitDimensions(parts);
    if (dimensions > 3) continue;
    for (const std::int64_t every : choices) {
      if (dimensions == 0 && every != choices.front()) continue;  // nothing is exchanged
      if (const auto one = predict(step, cluster, parts, every, single)) all.push_back(*one);
    }
  }
  BestOf result{.devices = devices,
                .best = bestOf(all, cluster, [](const Distribution&) { return true; }),
                .byDimensions = {},
                .fits = false};
  for (int dimensions = 1; dimensions <= 3; ++dimensions) {
    result.byDimensions.push_back(bestOf(all, cluster, [dimensions](const Distribution& one) {
      return splitDimensions(one.parts) == dimensions;
    }));
  }
  result.fits = result.best && fits(*result.best, cluster);
  return result;
}

Network Network::parse(const std::string& text) {
  const std::vector<std::string> words = wordsOf(text, ',');
  if (words.size() < 2 || words.size() > 4) {
    throw std::runtime_error(
        fmt::format("'{}' is no network; give BANDWIDTH,LATENCY[,OVERHEAD[,GAP]] as in 25GB/s,2us", text));
  }
  const double latency = parseTime(words[1]);
  Network network{.gapPerByte = 1 / parseBandwidth(words[0])};
  network.overhead = words.size() > 2 ? parseTime(words[2]) : latency / 4;
  network.gap = words.size() > 3 ? parseTime(words[3]) : network.overhead;
  network.latency = latency - 2 * network.overhead;
  if (network.latency < 0) {
    throw std::runtime_error(fmt::format(
        "the overhead in '{}' is more than half of the latency, which is from one program to the other",
        text));
  }
  return network;
}

double exchangeTime(const Network& network, std::int64_t messages, double bytes) {
  if (messages == 0) return 0;
  const auto count = static_cast<double>(messages);
  return network.overhead + (count - 1) * std::max(network.gap, network.overhead) +
         std::max(bytes - count, 0.0) * network.gapPerByte + network.latency + network.overhead;
}

double allReduceTime(const Network& network, std::int64_t ranks, double bytes) {
  const int rounds = std::bit_width(static_cast<std::uint64_t>(ranks - 1));
  return rounds * exchangeTime(network, 1, bytes);
}

double Staging::time(double bytes) const {
  if (!isNeeded() || bytes == 0) return 0;
  return readTime + bytes / readBandwidth + writeTime + bytes / writeBandwidth;
}

Staging Staging::parse(const std::string& text) {
  if (text == "none") return {};
  const std::vector<std::string> words = wordsOf(text, ',');
  if (words.size() != 4) {
    throw std::runtime_error(
        fmt::format("'{}' says nothing of copies to host memory; give "
                    "READ_BANDWIDTH,READ_TIME,WRITE_BANDWIDTH,WRITE_TIME as in "
                    "12GB/s,26us,5.6GB/s,22us, or none",
                    text));
  }
  return {.readTime = parseTime(words[1]),
          .readBandwidth = parseBandwidth(words[0]),
          .writeTime = parseTime(words[3]),
          .writeBandwidth = parseBandwidth(words[2])};
}

Boxes Boxes::parse(const std::string& text) {
  const std::vector<std::string> words = wordsOf(text, ',');
  std::size_t read = 0;
  double factor = 0;
  try {
    factor = std::stod(words[0], &read);
  } catch (const std::logic_error&) {  // not a number
  }
  if (words.size() != 2 || read != words[0].size() || !(factor >= 1) || factor > 100) {
    throw std::runtime_error(fmt::format(
        "'{}' says nothing of boxes; give how many times as long an element takes, 1 to 100, and the time of "
        "a call for a border, as in 1.3,6us",
        text));
  }
  return {.factor = factor, .borderTime = parseTime(words[1])};
}

namespace {

void addGrids(std::int64_t count, std::size_t rank, Extents& parts, std::vector<Extents>& grids) {
  if (parts.size() + 1 == rank) {
    parts.push_back(count);
    grids.push_back(parts);
    parts.pop_back();
    return;
  }
  for (std::int64_t part = 1; part <= count; ++part) {
    if (count % part != 0) continue;
    parts.push_back(part);
    addGrids(count / part, rank, parts, grids);
    parts.pop_back();
  }
}

/// The offsets of all neighbours: -1, 0 or 1 in each dimension that is split, not all of them 0.
std::vector<Extents> directionsOf(const Extents& parts) {
  std::vector<Extents> directions = {Extents(parts.size(), 0)};
  for (std::size_t d = 0; d < parts.size(); ++d) {
    if (parts[d] == 1) continue;
    const std::size_t count = directions.size();
    for (const std::int64_t step : {-1, 1}) {
      for (std::size_t i = 0; i < count; ++i) {
        directions.push_back(directions[i]);
        directions.back()[d] = step;
      }
    }
  }
  directions.erase(directions.begin());
  return directions;
}

bool hasNeighbor(const Split& split, const Extents& place, const Extents& direction) {
  for (std::size_t d = 0; d < place.size(); ++d) {
    const std::int64_t there = place[d] + direction[d];
    if ((there < 0 || there >= split.parts[d]) && !split.periodic[d]) return false;
  }
  return true;
}

}  // namespace

std::vector<Extents> processGrids(std::int64_t count, std::size_t rank) {
  std::vector<Extents> grids;
  Extents parts;
  addGrids(count, rank, parts, grids);
  return grids;
}

int splitDimensions(const Extents& parts) {
  return static_cast<int>(std::ranges::count_if(parts, [](std::int64_t part) { return part > 1; }));
}

std::int64_t partExtent(std::int64_t extent, std::int64_t parts, std::int64_t index) {
  return extent / parts + (index < extent % parts ? 1 : 0);
}

std::int64_t volumeOf(const Extents& block) {
  std::int64_t volume = 1;
  for (const std::int64_t extent : block) volume *= extent;
  return volume;
}

Halo Split::halo(std::size_t dimension, const Halo& read) const {
  if (parts[dimension] == 1) return {};
  if (parts[dimension] > 2 || !periodic[dimension]) return read;
  const std::int64_t deeper = std::max(read.below, read.above);
  return {deeper, deeper};
}

Sent sentBy(const Split& split, const Extents& block, const Extents& place,
            std::span<const ExchangedStream> streams) {
  Sent sent;
  for (const Extents& direction : directionsOf(split.parts)) {
    if (!hasNeighbor(split, place, direction)) continue;
    double bytes = 0;
    for (const ExchangedStream& stream : streams) {
      double elements = 1;
      for (std::size_t d = 0; d < block.size(); ++d) {
        const Halo halo = split.halo(d, stream.halo[d]);
        // A neighbour after the block reads what lies before its own elements.
        const std::int64_t depth = direction[d] > 0 ? halo.below : halo.above;
        elements *= static_cast<double>(direction[d] == 0 ? block[d] : depth);
      }
      bytes += elements * static_cast<double>(stream.bytes);
    }
    if (bytes > 0) ++sent.messages;
    sent.bytes += bytes;
  }
  return sent;
}

}  // namespace sk_tool
