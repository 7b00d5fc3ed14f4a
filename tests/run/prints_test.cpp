// SPDX-License-Identifier: MIT
//
// Promises: on native devices, each element prints what it would print alone, once, and no line of one call is mixed with
// another's; on GL devices, kernels that print compute the same and print nothing.
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <sstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "error_of.hpp"
#include "prints.sk.hpp"
#include "sk/sk.hpp"
#include "support/devices.hpp"

namespace run_tests {
namespace {

/// The lines that a call prints, in the order in which they come.
std::vector<std::string> linesOf(const auto& call) {
  std::fflush(stdout);
  std::FILE* const file = std::tmpfile();
  REQUIRE(file != nullptr);
  const int before = dup(STDOUT_FILENO);
  dup2(fileno(file), STDOUT_FILENO);
  call();
  std::fflush(stdout);
  dup2(before, STDOUT_FILENO);
  close(before);
  std::rewind(file);
  std::string text;
  for (int c = std::fgetc(file); c != EOF; c = std::fgetc(file)) text += static_cast<char>(c);
  std::fclose(file);
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::vector<std::string> sorted(std::vector<std::string> lines) {
  std::ranges::sort(lines);
  return lines;
}

std::vector<int> numbers(int count) {
  std::vector<int> list(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) list[static_cast<std::size_t>(i)] = i;
  return list;
}

TEST_CASE("integers of 64 bits are printed whole") {
  sk::Device& device = run_tests::device("native");
  auto x = device.stream<int>({3});
  auto r = device.stream<std::int64_t>({3});
  x.write(numbers(3));
  CHECK(sorted(linesOf([&] { wide(x, r); })) ==
        std::vector<std::string>{"-10000000000 10000000000", "-20000000000 20000000000", "0        0"});
}

TEST_CASE("lanes print in their order") {
  sk::Device& device = run_tests::device("native");
  auto x = device.stream<int>({21}), r = device.stream<int>({21});
  x.write(numbers(21));
  std::vector<std::string> expected;
  for (int i = 0; i < 21; ++i) expected.push_back(std::to_string(i) + " gives " + std::to_string(2 * i));
  CHECK(linesOf([&] { doubled(x, r); }) == expected);
  CHECK(linesOf([&] { doubled(x.domain({3}, {5}), r.domain({3}, {5})); }) ==
        std::vector<std::string>{"3 gives 6", "4 gives 8"});
}

TEST_CASE("only active lanes print") {
  sk::Device& device = run_tests::device("native");
  constexpr int count = 40;
  auto n = device.stream<int>({count});
  auto x = device.stream<float>({count}), r = device.stream<float>({count});
  std::vector<int> counts;
  std::vector<float> values;
  std::vector<std::string> expected;
  for (int e = 0; e < count; ++e) {
    counts.push_back(e * 7 % 5);
    values.push_back(static_cast<float>(e % 4));
    for (int i = 0; i < counts.back(); i += 2) {
      expected.push_back(std::to_string(i) + " in " + std::to_string(counts.back()));
      if (values.back() > 2) expected.push_back("large " + std::to_string(counts.back()) + " 3");
    }
  }
  n.write(counts);
  x.write(values);
  CHECK(sorted(linesOf([&] { divergent(n, x, r); })) == sorted(expected));
}

TEST_CASE("values of every type are printed") {
  sk::Device reference = sk::Device::reference();
  for (sk::Device* one : {&run_tests::device("native"), &reference}) {
    sk::Device& device = *one;
    auto p = device.stream<Pair>({2});
    auto d = device.stream<double>({2});
    auto u = device.stream<std::uint32_t>({2});
    auto b = device.stream<bool>({2});
    auto c = device.stream<std::int8_t>({2});
    auto v = device.stream<sk::int2>({2});
    auto r = device.stream<int>({2});
    p.write(std::vector<Pair>{{sk::half(1.5f), sk::unorm8(1.0f)}, {sk::half(-2.0f), sk::unorm8(0.0f)}});
    d.write(std::vector<double>{1.0 / 3, -1e3});
    u.write(std::vector<std::uint32_t>{0xdeadbeef, 7});
    b.fill(true);
    c.write(std::vector<std::int8_t>{-5, 6});
    v.write(std::vector<sk::int2>{{0, 12}, {1, -3}});
    CHECK(linesOf([&] { kinds(p, d, u, b, c, v, r); }) ==
          std::vector<std::string>{"1.50 1.0 0.333 deadbeef 1 -5 A|  12|0   |% 5.000000e-01",
                                   "-2.00 0.0 -1000.000 00000007 1 6 B|  -3|1   |% 5.000000e-01", "no values",
                                   "no values"});
  }
}

TEST_CASE("no element prints twice, and lines of threads are whole") {
  sk::Device& device = run_tests::device("native");
  const sk::Shape shape{150, 203};
  auto u = device.stream<float>(shape), r = device.stream<float>(shape);
  std::vector<float> values;
  std::vector<std::string> expected;
  for (int i = 0; i < 150 * 203; ++i) {
    values.push_back(static_cast<float>(i));
    expected.push_back(std::to_string(i));
  }
  u.write(values);
  CHECK(sorted(linesOf([&] { averaged(u, r); })) == sorted(expected));
  auto x = device.stream<int>({100000}), y = device.stream<int>({100000});
  x.write(numbers(100000));
  expected.clear();
  for (int i = 0; i < 100000; ++i) expected.push_back(std::to_string(i) + " gives " + std::to_string(2 * i));
  CHECK(sorted(linesOf([&] { doubled(x, y); })) == sorted(expected));
  auto a = device.stream<float>({70, 4}), b = device.stream<float>({4, 90}),
       c = device.stream<float>({70, 90});
  a.fill(1);
  b.fill(1);
  expected.clear();
  for (int row = 0; row < 70; ++row)
    for (int column = 0; column < 90; ++column) expected.push_back(std::to_string(row * 100 + column));
  CHECK(sorted(linesOf([&] { product(a, b, c); })) == sorted(expected));
  CHECK(c.read() == std::vector<float>(70 * 90, 4));
}

TEST_CASE("kernels that push print, too, and a failed assertion prints nothing") {
  sk::Device& device = run_tests::device("native");
  auto x = device.stream<int>({8}), list = device.stream<int>({0}), r = device.stream<int>({8});
  x.write(numbers(8));
  CHECK(linesOf([&] { kept(x, list); }) == std::vector<std::string>{"kept 0", "kept 3", "kept 6"});
  CHECK(list.read() == std::vector<int>{0, 3, 6});
  CHECK(linesOf([&] { quiet(x, r); }) == std::vector<std::string>{"0", "1", "2", "3", "4", "5", "6", "7"});
  std::vector<int> negative = numbers(8);
  negative[4] = -4;
  x.write(negative);
  CHECK(linesOf([&] { CHECK(errorOf([&] { quiet(x, r); }) != "no error"); }).empty());
}

TEST_CASE("on GL devices, kernels compute and do not print") {
  for (const char* name : {"glsl330", "glsl430"}) {
    sk::Device& device = run_tests::device(name);
    auto n = device.stream<int>({3});
    auto x = device.stream<float>({3}), r = device.stream<float>({3});
    n.write(std::vector<int>{1, 4, 5});
    x.write(std::vector<float>{0, 3, 2});
    CHECK(linesOf([&] { divergent(n, x, r); }).empty());
    CHECK(r.read() == std::vector<float>{0, 2, 3});
  }
}

}  // namespace
}  // namespace run_tests
