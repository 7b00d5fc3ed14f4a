// SPDX-License-Identifier: MIT
//
// A program for tests of `sk stress`: program KIND [SIZE].
//   step        a time step that is unstable within its range
//   stable      one that is not, after the host has copied its input
//   divide      divides by what the host writes, whose range has 0
//   plain       kernels without ranges
//   loop        a loop of the device that ends by a condition, not at one end of the range
//   host        likewise a loop of the host
//   crash       ends by a signal if the size is 1
//   refuse      ends with status 2 and a message if the size is odd
//   status      ends with status 3
//   silent      reads nothing
//   nothing     calls no kernel
//   accrue      what it computes grows, and so do its errors
//   vectors     divides vectors by their lengths
//   far         overflows in floats alone
//   twice       starts itself
//   hang        never ends after its last call, if the sum is large
//   store FILE  writes its results
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <unistd.h>

#include <sk/sk.hpp>

#include "stress/stressed.sk.hpp"

namespace {

std::vector<float> hill(int size) {
  std::vector<float> values(static_cast<std::size_t>(size));
  for (int i = 0; i < size; ++i) values[static_cast<std::size_t>(i)] = i % 7 == 3 ? 2.0f : 0.5f;
  return values;
}

std::vector<float> wave(int size) {
  std::vector<float> values(static_cast<std::size_t>(size));
  for (int i = 0; i < size; ++i)
    values[static_cast<std::size_t>(i)] =
        1 + 0.5f * std::sin(6.2831853f * static_cast<float>(i) / static_cast<float>(size));
  return values;
}

struct Line {
  explicit Line(int size)
      : u(device.stream<float>({size}, sk::Storage::Default, "u")),
        v(device.stream<float>({size}, sk::Storage::Default, "v")) {
    u.write(hill(size));
  }
  sk::Device device;
  sk::Stream<float> u, v;
};

void runStep(int size, bool isStable) {
  Line line(size);
  line.u.write(wave(size));
  if (isStable) {
    sk::Stream<float> copy = line.device.stream<float>({size});
    line.u.copyTo(copy);
    std::swap(copy, line.u);
  }
  for (int i = 0; i < 200; ++i) {
    if (isStable) {
      stressed::stableStep(0.25f, line.u, line.v);
    } else {
      stressed::step(0.25f, line.u, line.v);
    }
    std::swap(line.u, line.v);
  }
  line.u.read();
}

void runDivide(int size) {
  Line line(size);
  stressed::reciprocal(line.u, line.v);
  line.v.read();
}

void runPlain(int size) {
  Line line(size);
  stressed::scale(1.5f, 2, line.u, line.v);
  stressed::offset(1.5f, line.v, line.u);
  line.u.read();
}

void runLoop(int size) {
  Line line(size);
  sk::Scalar<bool> done = line.device.scalar<bool>();
  sk::Loop loop = line.device.record([&] {
    stressed::approach(0.5f, line.u, line.v);
    sk::Scalar<float> most = line.device.scalar<float>();
    stressed::distance(line.v, most);
    stressed::isNear(most, done);
    std::swap(line.u, line.v);
  });
  loop.until(done, {.most = 500});
  line.u.read();
}

void runHost(int size) {
  Line line(size);
  for (int i = 0; i < 500; ++i) {
    stressed::approach(0.5f, line.u, line.v);
    std::swap(line.u, line.v);
    if (stressed::distance(line.u) < 0.001f) break;
  }
  line.u.read();
}

void runAccrue(int size) {
  Line line(size);
  for (int i = 0; i < 150; ++i) {
    stressed::accrue(0.01f, line.u, line.v);
    std::swap(line.u, line.v);
  }
  line.u.read();
}

void runVectors(int size) {
  sk::Device device;
  auto d = device.stream<sk::float3>({size}), r = device.stream<sk::float3>({size});
  d.write(std::vector<sk::float3>(static_cast<std::size_t>(size), sk::float3{0.5f, 0.25f, 1}));
  stressed::directions(d, r);
  r.read();
}

void runFar(int size) {
  Line line(size);
  stressed::far(line.u, line.v);
  line.v.read();
}

void runHang(int size) {
  Line line(size);
  for (int i = 0; i < 40; ++i) {
    stressed::offset(0.0f, line.u, line.v);
    usleep(10'000);
  }
  if (line.v.read().front() > 1e30f) pause();
}

void writeResults(const char* file) {
  Line line(10);
  stressed::scale(1.5f, 2, line.u, line.v);
  std::ofstream out(file);
  for (const float value : line.v.read()) out << value << '\n';
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return 64;
  const std::string kind = argv[1];
  const int size = argc > 2 && kind != "store" ? std::atoi(argv[2]) : 10;
  try {
    if (kind == "step" || kind == "stable") runStep(size, kind == "stable");
    if (kind == "divide") runDivide(size);
    if (kind == "plain" || kind == "status") runPlain(size);
    if (kind == "loop") runLoop(size);
    if (kind == "host") runHost(size);
    if (kind == "crash") {
      if (size == 1) std::raise(SIGSEGV);
      runPlain(size);
    }
    if (kind == "refuse") {
      if (size % 2 != 0) {
        std::fprintf(stderr, "the size %d is odd\n", size);
        return 2;
      }
      runPlain(size);
    }
    if (kind == "silent") {
      Line line(size);
      stressed::scale(1.5f, 2, line.u, line.v);
    }
    if (kind == "nothing") Line line(size);
    if (kind == "accrue") runAccrue(size);
    if (kind == "vectors") runVectors(size);
    if (kind == "far") runFar(size);
    if (kind == "hang") runHang(size);
    if (kind == "twice") {
      runPlain(size);
      return std::system((std::string(argv[0]) + " plain").c_str());
    }
    if (kind == "store") writeResults(argv[2]);
  } catch (const sk::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return kind == "status" ? 3 : 0;
}
