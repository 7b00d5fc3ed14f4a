// SPDX-License-Identifier: MIT
//
// SK_CHECK=folds, which tests/run/CMakeLists.txt sets: on a native device, wrong reduces throw, and correct ones do not.
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "error_of.hpp"
#include "fold_checks.sk.hpp"
#include "sk/sk.hpp"

namespace {

sk::Stream<float> streamOf(sk::Device& device, const std::vector<float>& values) {
  auto stream = device.stream<float>({static_cast<std::int64_t>(values.size())});
  stream.write(values);
  return stream;
}

const std::vector<float> some = {100, 200, 350, -400, 500, 625, 700, -800, 900, 1000, 1100, 1250};

}  // namespace

TEST_CASE("a fold that is not associative throws, with its values") {
  sk::Device device = sk::Device::native();
  const auto x = streamOf(device, some);
  const auto half = streamOf(device, {0.5F}), one = streamOf(device, {1});
  const std::string message = errorOf([&] { fold_checks::average(x, half); });
  INFO(message);
  CHECK(message.find(
            "fold_checks::average: partial results combine in an order that depends on the device") == 0);
  CHECK(message.find("SK_CHECK=folds") != std::string::npos);
  CHECK(fold_checks::average(x, one) == 5525.0F);
}

TEST_CASE("an identity that is not neutral throws") {
  sk::Device device = sk::Device::native();
  auto x = device.stream<sk::float2x2>({5});
  x.write(std::vector<sk::float2x2>(5, sk::float2x2{{{1, 200}, {0, 1}}}));
  const auto two = streamOf(device, {2}), one = streamOf(device, {1});
  const std::string message = errorOf([&] { fold_checks::product(x, two); });
  INFO(message);
  CHECK(message.find("fold_checks::product: what it starts from is not neutral: {1, 0, 0, 1} and then") == 0);
  CHECK(errorOf([&] { fold_checks::product(x, one); }) == "no error");
}

TEST_CASE("an overload that does not combine as the fold does throws") {
  sk::Device device = sk::Device::native();
  const auto x = streamOf(device, some);
  const std::string message = errorOf([&] { fold_checks::mean(x); });
  INFO(message);
  CHECK(message.find("elements folded one after the other give") != std::string::npos);
}

TEST_CASE("a right fold gives what it gives unchecked") {
  sk::Device device = sk::Device::native();
  auto p = device.stream<sk::float2>({2, 3});
  p.write(std::vector<sk::float2>{{0, 0}, {1, 5}, {2, 2}, {3, 1}, {9, 9}, {4, 4}});
  auto to = device.stream<sk::float2>({1});
  to.write(std::vector<sk::float2>{{3, 2}});
  CHECK(fold_checks::nearest(p, to) == sk::float2{2, 2});
}
