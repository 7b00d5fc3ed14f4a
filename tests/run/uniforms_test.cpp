// SPDX-License-Identifier: MIT
//
// Uniform arrays, and arrays in uniform structs: every element arrives, from every kind of host array.
#include "uniforms.sk.hpp"

#include <array>

#include "support/devices.hpp"
#include "support/values.hpp"

using namespace run_tests;

TEST_CASE("uniform arrays") {
  onEveryProfile([](sk::Device& device) {
    auto a = streamOf<float>(device, {4}, {1, 2, 4, 8});
    auto r = device.stream<float>({4});
    uniforms::convolve(std::array<float, 3>{1, 10, 100}, a, r);
    CHECK(r.read() == std::vector<float>{211, 421, 842, 884});
    const float other[3] = {0, 1, 0};
    uniforms::convolve(other, a, r);
    CHECK(r.read() == std::vector<float>{1, 2, 4, 8});
    auto i = streamOf<int>(device, {5}, {0, 1, 2, 3, 4});
    auto table = device.stream<sk::int3>({5});
    auto t = device.stream<float>({5});
    const std::array<sk::int3, 4> rows = {{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {-1, -2, 2147483647}}};
    const std::array<bool, 2> flags = {false, true};
    const std::array<uniforms::Tap, 2> taps = {{{{1, 2}, 3}, {{4, 5}, 6}}};
    uniforms::pick(rows, flags, taps, i, table, t);
    CHECK(table.read() == std::vector<sk::int3>{rows[0], rows[1], rows[2], rows[3], rows[0]});
    CHECK(t.read() == std::vector<float>{2, 6, 2, 6, 2});
  });
}

TEST_CASE("arrays in uniform structs") {
  onEveryProfile([](sk::Device& device) {
    auto i = streamOf<int>(device, {2}, {0, 10});
    auto r = device.stream<float>({2});
    uniforms::Filter filter{{{{1, 0}, 2}, {{3, 0}, 5}, {{7, 0}, 11}}, 3, {true, false, true, false, false}};
    uniforms::filtered(filter, i, r);
    CHECK(r.read() == std::vector<float>{79, 209});
    filter.count = 1;
    uniforms::filtered(filter, i, r);
    CHECK(r.read() == std::vector<float>{2, 22});
  });
}
