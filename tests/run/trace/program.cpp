// SPDX-License-Identifier: MIT
//
// trace_program SCENARIO: runs a scenario; check.py then checks the trace in the file that SK_TRACE names.
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <thread>
#include <vector>

#include <sk/sk.hpp>

#include "trace/traced.sk.hpp"

namespace {

void callAll() {
  sk::Device device;
  const std::vector<float> values(512 * 512, 1);
  auto x = device.stream<float>({512, 512}, sk::Storage::Default, "x");
  auto y = device.stream<float>({512, 512}), r = device.stream<float>({512, 512});
  x.write(values);
  y.write(values);
  saxpy(2, x, y, r);
  saxpy(3, x, y, r);
  blur(r.domain({0, 0}, {64, 64}), x.domain({0, 0}, {64, 64}));
  saxpy(2, x, y, x);
  if (total(r) != 4 * 512 * 512) std::abort();
  auto picked = device.stream<float>({0});
  pick(r, picked);
  if (picked.size() != 512 * 512) std::abort();
  r.read();
  device.finish();
}

/// Calls one kernel and one reduce with streams of many shapes.
void callInManyShapes() {
  sk::Device device;
  for (std::int64_t rows = 2; rows < 40; ++rows) {
    auto x = device.stream<float>({rows, 2 * rows + 1}), r = device.stream<float>({rows, 2 * rows + 1});
    x.write(std::vector<float>(static_cast<std::size_t>(x.size()), 1));
    saxpy(2, x, x, r);
    if (total(r) != 3 * static_cast<float>(r.size())) std::abort();
  }
}

/// Exits the process while a device and streams are alive.
void exitInTheMiddle() {
  sk::Device device;
  auto x = device.stream<float>({64, 64}), r = device.stream<float>({64, 64});
  x.write(std::vector<float>(64 * 64, 1));
  saxpy(2, x, x, r);
  std::_Exit(0);
}

/// Makes a call with wrong arguments, whose exception nobody catches.
void throwInTheMiddle() {
  sk::Device device;
  auto x = device.stream<float>({64, 64}), r = device.stream<float>({64, 64});
  x.write(std::vector<float>(64 * 64, 1));
  saxpy(2, x, x, r);
  saxpy(2, x, x.domain({0, 0}, {32, 32}), r);
}

void useThreads() {
  std::vector<std::jthread> threads;
  for (int i = 0; i < 2; ++i) {
    threads.emplace_back([] {
      sk::Device device;
      auto x = device.stream<float>({64, 64}), r = device.stream<float>({64, 64});
      x.write(std::vector<float>(64 * 64, 1));
      for (int call = 0; call < 20; ++call) saxpy(2, x, x, r);
      if (r.read().front() != 3) std::abort();
    });
  }
}

}  // namespace

int main(int, char** argv) {
  const std::string_view scenario = argv[1];
  if (scenario == "calls") {
    callAll();
  } else if (scenario == "shapes") {
    callInManyShapes();
  } else if (scenario == "exit") {
    exitInTheMiddle();
  } else if (scenario == "throw") {
    throwInTheMiddle();
  } else if (scenario == "threads") {
    useThreads();
  } else {
    std::fprintf(stderr, "there is no scenario '%s'\n", argv[1]);
    return 1;
  }
}
