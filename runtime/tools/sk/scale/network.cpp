// SPDX-License-Identifier: MIT
#include "scale/network.hpp"

#include <algorithm>
#include <bit>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

#include "scale/quantities.hpp"

namespace sk_tool {

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

}  // namespace sk_tool
