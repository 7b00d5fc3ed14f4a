// SPDX-License-Identifier: MIT
//
// The time of messages by the model LogGP: A. Alexandrov, M. Ionescu, K. Schauser, C. Scheiman, "LogGP: Incorporating
// Long Messages into the LogP Model", SPAA 1995, section 3. Only formulas.
#pragma once

#include <cstdint>
#include <string>

namespace sk_tool {

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

}  // namespace sk_tool
