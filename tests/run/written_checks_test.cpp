// SPDX-License-Identifier: MIT
//
// SK_CHECK=written, which tests/run/CMakeLists.txt sets: what reads a stream that nothing has written throws an error that
// names it, and every way of writing one counts. The tag hides the tests from runs without that setting.
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "error_of.hpp"
#include "sk/sk.hpp"
#include "support/devices.hpp"
#include "written_checks.sk.hpp"

namespace run_tests {
namespace {

constexpr int count = 6;

std::string unread(const char* what, const char* parameter = nullptr) {
  const std::string stream =
      "of shape {6} that nothing has written; write() or fill() it first, or let a kernel write it "
      "(SK_CHECK=written)";
  if (parameter == nullptr)
    return std::string(what) +
           ": nothing has written this stream of shape {6}; write() or fill() "
           "it first, or let a kernel write it (SK_CHECK=written)";
  return std::string(what) + ": '" + parameter + "' reads a stream " + stream;
}

TEST_CASE("a read of a stream that nothing has written is an error", "[.written]") {
  onEveryTarget([](sk::Device& device) {
    auto x = device.stream<float>({count}), u = device.stream<float>({count}),
         r = device.stream<float>({count});
    auto i = device.stream<int>({count});
    auto list = device.stream<float>({0});
    auto t = device.stream<float>({1});
    x.fill(1);
    i.write(std::vector<int>{0, 1, 2, 3, 4, 5});
    CHECK(errorOf([&] { doubled(u, r); }) == unread("doubled", "x"));
    CHECK(errorOf([&] { doubled(u, u); }) == unread("doubled", "x"));
    CHECK(errorOf([&] { gathered(u, r); }) == unread("gathered", "a"));
    CHECK(errorOf([&] { switched(true, x, u, r); }) == unread("switched", "a"));
    CHECK(errorOf([&] { added(i, x, u); }) == unread("added", "r"));
    CHECK(errorOf([&] { positive(u, list); }) == unread("positive", "x"));
    CHECK(errorOf([&] { sum(u); }) == unread("sum", "x"));
    CHECK(errorOf([&] { sums(u, r); }) == unread("sums", "x"));
    CHECK(errorOf([&] { squares(u, r, t); }) == unread("squares", "x"));
    CHECK(errorOf([&] { u.read(); }) == unread("read"));
    CHECK(errorOf([&] { u.readAsync(); }) == unread("readAsync"));
    CHECK(errorOf([&] { u.copyTo(r); }) == unread("copyTo"));
    CHECK(errorOf([&] { sk::sort(u); }) == unread("sk::sort"));
    CHECK(errorOf([&] { doubled(u.domain({0}, {2}), r.domain({0}, {2})); }) == unread("doubled", "x"));
    CHECK(errorOf([&] { r.read(); }) == unread("read"));  // none of the calls has run
    CHECK(errorOf([&] { device.record([&] { doubled(u, r); }); }) == unread("doubled", "x"));
    sk::Scalar<float> factor = device.scalar<float>();
    CHECK(errorOf([&] { scaled(factor, x, r); }).find("scaled: 'factor' reads a stream of shape {1}") == 0);
  });
}

TEST_CASE("every way of writing a stream counts", "[.written]") {
  onEveryTarget([](sk::Device& device) {
    const std::vector<float> ones(count, 1.0f);
    auto x = device.stream<float>({count});
    x.write(ones);
    const auto reads = [&](auto&& write) {
      auto u = device.stream<float>({count});
      CHECK(errorOf([&] { write(u); }) == "no error");
      return errorOf([&] { u.read(); });
    };
    auto i = device.stream<int>({count});
    i.write(std::vector<int>{0, 1, 2, 3, 4, 5});
    CHECK(reads([&](sk::Stream<float>& u) { u.write(ones); }) == "no error");
    CHECK(reads([&](sk::Stream<float>& u) { u.writeAsync(ones); }) == "no error");
    CHECK(reads([&](sk::Stream<float>& u) { u.writeReals(std::vector<double>(count, 1.0)); }) == "no error");
    CHECK(reads([&](sk::Stream<float>& u) { u.fill(1); }) == "no error");
    CHECK(reads([&](sk::Stream<float>& u) { u.domain({0}, {2}).fill(1); }) == "no error");
    CHECK(reads([&](sk::Stream<float>& u) { x.copyTo(u); }) == "no error");
    CHECK(reads([&](sk::Stream<float>& u) { doubled(x, u); }) == "no error");
    CHECK(reads([&](sk::Stream<float>& u) { switched(false, x, sk::none, u); }) == "no error");
    CHECK(reads([&](sk::Stream<float>& u) { placed(i, x, u); }) == "no error");
    CHECK(reads([&](sk::Stream<float>& u) { positive(x, u); }) == "no error");
    CHECK(reads([&](sk::Stream<float>& u) { sums(x, u); }) == "no error");
    CHECK(reads([&](sk::Stream<float>& u) { sum(x, u); }) == "no error");
    CHECK(reads([&](sk::Stream<float>& u) { squares(x, u, device.stream<float>({1})); }) == "no error");
    CHECK(reads([&](sk::Stream<float>& u) { squares(x, x, u); }) == "no error");
    CHECK(reads([&](sk::Stream<float>& u) { device.record([&] { doubled(x, u); }).repeat(1); }) ==
          "no error");
    auto unwritten = device.stream<float>({count});
    std::swap(unwritten, x);
    CHECK(errorOf([&] { x.read(); }) == unread("read"));
    CHECK(errorOf([&] { unwritten.read(); }) == "no error");
    sk::Scalar<float> factor = device.scalar<float>();
    factor = 2.0f;
    CHECK(errorOf([&] { scaled(factor, unwritten, x); }) == "no error");
    CHECK(errorOf([&] { device.stream<float>({0}).read(); }) == "no error");
    sk::Stream<int> order = sk::order(unwritten);
    CHECK(errorOf([&] { order.read(); }) == "no error");
  });
}

}  // namespace
}  // namespace run_tests
