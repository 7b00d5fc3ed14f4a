// SPDX-License-Identifier: MIT
//
// Kernels may be named like what skc derives from other kernels, and like what C++ declares elsewhere.
#include "names.sk.hpp"

#include <cstring>
#include <ctime>
#include <vector>

#include <unistd.h>
#include <catch2/catch.hpp>

namespace {

enum Part {
#define SKC_PART(Word) Word,
#include "../../compiler/program/constant_parts.def"
#undef SKC_PART
};

TEST_CASE("kernels are named after every part of a descriptor's name") {
  sk::Device device = sk::Device::native();
  auto x = device.stream<float>({2}), r = device.stream<float>({2});
  x.write(std::vector<float>{1, 2});
  parts::scale(3, x, r);
  CHECK(r.read() == std::vector<float>{3, 6});
  CHECK(parts::sum(x) == 3);
  CHECK(parts::sum.with({.accumulate = sk::Accumulate::Exact})(x) == 3);
  auto total = device.stream<float>({1});
  parts::fold(x, r, total);
  CHECK(total.read() == std::vector<float>{6});
  const auto isShifted = [&](int by) {
    const auto number = static_cast<float>(by);
    return r.read() == std::vector<float>{1 + number, 2 + number};
  };
#define SKC_PART(Word)          \
  parts::scale##Word(x, r);     \
  CHECK(isShifted(Word));       \
  parts::sum_##Word(x, r);      \
  CHECK(isShifted(100 + Word)); \
  parts::fold##Word(x, r);      \
  CHECK(isShifted(200 + Word));
#include "../../compiler/program/constant_parts.def"
#undef SKC_PART
  parts::blur(x, r);
  CHECK(isShifted(1));
  parts::BlurKernel(x, r);
  CHECK(isShifted(2));
}

TEST_CASE("kernels in a namespace have names that C++ declares outside") {
  sk::Device device = sk::Device::native();
  auto x = device.stream<float>({1}), r = device.stream<float>({1});
  auto when = device.stream<names::tm>({1});
  when.write(std::vector<names::tm>{{2, 3}});
  x.write(std::vector<float>{7});
  names::index(when, r);
  CHECK(r.read() == std::vector<float>{5});
  names::time(x, r, r);
  CHECK(r.read() == std::vector<float>{2});
  names::function(x, r, r);
  CHECK(r.read() == std::vector<float>{14});
}

}  // namespace
