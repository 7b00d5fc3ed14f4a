// SPDX-License-Identifier: MIT
//
// A program for tests of `sk tune`: program KIND COUNT [SCALE].
//   settle COUNT SCALE    reads what settles, of numbers up to SCALE
//   subtract COUNT        reads a difference that loses digits, and its sum
//   both COUNT            reads both
//   decide COUNT          reads which of the results are above a limit
//   odd COUNT             reads what settles, and the last bit of each number
//   random COUNT          reads something else in each run
//   silent COUNT          reads nothing
//   status COUNT          ends with status 3 and a message
//   signal COUNT          ends by a signal
//   named COUNT           chooses its device itself
//   reads COUNT           reads in all ways that there are
//   called COUNT          calls a kernel in doubles that it could do without
//   fork COUNT            reads what settles, after a fork
//   light COUNT           reads the result of many calls that take little more than reading and writing elements
//   busy COUNT            reads what settles in several calls, after half a second of work on the host
//   text FILE COUNT       reads nothing, but writes its sum to FILE as JSON
//   array FILE COUNT      likewise what settles, to a .npy file
//   picture FILE COUNT    likewise, to a TGA file of one row
#include <chrono>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <sys/wait.h>
#include <unistd.h>

#include <sk/algorithm.hpp>
#include <sk/npy.hpp>
#include <sk/sk.hpp>

#include "tune/tuned.sk.hpp"

namespace {

std::vector<float> numbers(std::size_t count, float scale) {
  std::vector<float> values(count);
  std::uint32_t state = 1;
  for (float& value : values) {
    state = state * 1664525u + 1013904223u;
    value = scale * (static_cast<float>(state >> 8) + 1) / 16777216.0f;
  }
  return values;
}

/// A row of grey texels in a TGA file without compression.
void writePicture(const std::string& file, const std::vector<float>& numbers) {
  const std::size_t count = numbers.size();
  std::string bytes(18, '\0');
  bytes[2] = 3;
  bytes[12] = static_cast<char>(count % 256);
  bytes[13] = static_cast<char>(count / 256);
  bytes[14] = 1;
  bytes[16] = 8;
  for (const float number : numbers) bytes += static_cast<char>(static_cast<unsigned char>(255 * number));
  std::ofstream(file, std::ios::binary) << bytes;
}

int readAll(sk::Device& device, tuned::TunedStreams& streams, sk::Stream<float>& x) {
  auto hits = device.stream<tuned::Hit>({streams.state.size()}, sk::Storage::Default, "hits");
  tuned::meet(x, hits);
  hits.read();
  streams.state.readAsync().get();
  streams.state.readReals();
  streams.state.domain({1}, {3}).read();
  x.read();
  sk::order(x).read();
  sk::Scalar<float> sum = device.scalar<float>(2);
  (sum * 3.0f).read();
  tuned::extremes(x);
  return 0;
}

int runKind(const std::string& kind, std::size_t count, float scale, const std::string& file) {
  sk::Device device = kind == "named" ? sk::Device::native() : sk::Device();
  tuned::TunedStreams streams(device, static_cast<std::int64_t>(count));
  auto x = device.stream<float>({static_cast<std::int64_t>(count)});
  std::vector<float> values = numbers(count, scale);
  if (kind == "random") values[0] = static_cast<float>(std::random_device()());
  x.write(values);
  if (kind == "called") {
    tuned::smooth.with({.precision = sk::Precision::Double, .contraction = sk::Contraction::Exact})(
        x, streams.rest);
    streams.rest.read();
    return 0;
  }
  if (kind == "light") {
    streams.state.write(values);
    for (int i = 0; i < 200; ++i) tuned::blend(x, streams.state, streams.state);
    streams.state.read();
    return 0;
  }
  if (kind == "busy") {
    for (int i = 0; i < 4; ++i) tuned::settle(x, streams.state);
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    streams.state.read();
    return 0;
  }
  if (kind == "fork") {
    const pid_t child = ::fork();
    if (child == 0) ::_exit(0);
    ::waitpid(child, nullptr, 0);
  }
  if (kind != "subtract") tuned::settle(x, streams.state);
  if (kind == "reads") return readAll(device, streams, x);
  if (kind != "settle" && kind != "decide") tuned::subtract(x, streams.rest);
  if (kind == "status") {
    std::fprintf(stderr, "loading\nthere is no field today\n");
    return 3;
  }
  if (kind == "signal") std::raise(SIGABRT);
  if (kind == "silent") return 0;
  if (kind == "text") {
    std::ofstream(file) << "{\"run\": {\"sums\": [" << tuned::total(streams.rest) << "]}}\n";
    return 0;
  }
  if (kind == "array") {
    sk::writeNpy(file, std::vector<std::int64_t>{static_cast<std::int64_t>(count)}, streams.state.readReals(),
                 sk::NumberType::Float64);
    return 0;
  }
  if (kind == "picture") {
    writePicture(file, streams.state.read());
    return 0;
  }
  if (kind == "odd") {
    auto flags = device.stream<int>({static_cast<std::int64_t>(count)}, sk::Storage::Default, "flags");
    tuned::parity(streams.state, flags);
    flags.read();
  }
  if (kind == "decide") {
    auto flags = device.stream<int>({static_cast<std::int64_t>(count)}, sk::Storage::Default, "flags");
    tuned::above(0.75f * scale, streams.state, flags);
    flags.read();
    return 0;
  }
  if (kind != "subtract") streams.state.read();
  if (kind != "settle" && kind != "odd") {
    streams.rest.read();
    std::printf("%g\n", tuned::total(streams.rest));
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string kind = argc > 1 ? argv[1] : "";
  const int first = kind == "text" || kind == "array" || kind == "picture" ? 3 : 2;
  if (argc <= first) return 2;
  const float scale = argc > first + 1 ? std::stof(argv[first + 1]) : 1.0f;
  return runKind(kind, std::stoul(argv[first]), scale, argv[2]);
}
