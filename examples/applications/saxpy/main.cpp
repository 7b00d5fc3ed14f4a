// SPDX-License-Identifier: MIT
//
// The shortest whole program: two streams in, one out, one call. It must stay short enough to quote.
#include <sk/sk.hpp>

#include "check.hpp"
#include "saxpy.sk.hpp"

int main(int argc, char** argv) {
  examples::Saxpy example;
  return example.run(argc, argv, [&] {
    sk::Device device(example.device());
    auto x = device.stream<float>({example.size()});
    auto y = device.stream<float>({example.size()});
    auto r = device.stream<float>({example.size()});
    x.write(example.x());
    y.write(example.y());

    example.time(device, [&] { saxpy(example.a(), x, y, r); });
    example.check(r.read());
  });
}
