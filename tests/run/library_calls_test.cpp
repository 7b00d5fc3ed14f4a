// SPDX-License-Identifier: MIT
//
// Ten remainders in a kernel whose outputs are packed by four: forty calls of library functions, which llvmpipe inlines and must
// compile in time (TIMEOUT in CMakeLists.txt), with its optimisations.
#include <cmath>
#include <vector>

#include <catch2/catch.hpp>

#include "library_calls.sk.hpp"
#include "support/devices.hpp"

TEST_CASE("many remainders in one kernel compile, and are exact") {
  run_tests::onEveryTarget([](sk::Device& device) {
    std::vector<float> x(1000);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = static_cast<float>(i) * 0.375F - 20;
    auto in = device.stream<float>({1000}), out = device.stream<float>({1000});
    in.write(x);
    library_calls::remainders(in, out);
    const std::vector<float> r = out.read();
    const auto mod = [](float a, float b) { return a - b * std::floor(a / b); };  // exact here
    for (std::size_t i = 0; i < x.size(); ++i) {
      const float v = x[i];
      const float expected = std::fmod(v, 2.0F) + std::fmod(v + 1, 3.0F) + std::fmod(v + 2, 5.0F) +
                             std::fmod(v + 3, 7.0F) + std::fmod(v + 4, 11.0F) + std::fmod(v + 5, 13.0F) +
                             (mod(v, 4) + mod(v + 1, 6) + mod(v + 2, 8) + mod(v + 3, 10));
      if (r[i] != expected) {
        INFO(v);
        CHECK(r[i] == expected);
      }
    }
  });
}
