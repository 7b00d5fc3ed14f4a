// SPDX-License-Identifier: MIT
//
// SK_CHECK=written, which tests/run/CMakeLists.txt sets: what reads a stream that nothing has written throws an error that
// names it, and every way of writing one counts. The tag hides the tests from runs without that setting.
#include <cstdint>
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

/// What a kernel says that reads one element of those that nothing has written.
std::string unreadAt(const char* kernel, const char* parameter, const char* index,
                     const char* shape = "{6}") {
  return std::string(kernel) + ": '" + parameter + "' is read at " + index + " of shape " + shape +
         ", an element that nothing has written; write() or fill() it first, or let a kernel write it "
         "(SK_CHECK=written)";
}

/// What any other operation says.
std::string lacking(const char* what, const char* index, const char* shape = "{6}") {
  return std::string(what) + ": nothing has written the element at " + index + " of shape " + shape +
         "; write() or fill() it first, let a kernel write it, or ask for a view without it "
         "(SK_CHECK=written)";
}

/// A stream of six floats, of which those from `begin` to `end` (exclusive) are 1.
sk::Stream<float> partOf(sk::Device& device, int begin, int end) {
  auto part = device.stream<float>({count});
  part.domain({begin}, {end}).fill(1);
  return part;
}

sk::Stream<int> numbers(sk::Device& device, const std::vector<int>& values) {
  auto stream = device.stream<int>({static_cast<int>(values.size())});
  stream.write(values);
  return stream;
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
    CHECK(errorOf([&] { device.record([&] { doubled(u, r); }).repeat(1); }) == unread("doubled", "x"));
    sk::Scalar<float> factor = device.scalar<float>();
    CHECK(errorOf([&] { scaled(factor, x, r); }).find("scaled: 'factor' reads a stream of shape {1}") == 0);
    sk::Scalar<float> known = device.scalar<float>();
    known = 2.0F;
    sk::Scalar<float> twice = known * 2.0F;
    CHECK(errorOf([&] { known += factor; }).find("a scalar: nothing has written") == 0);
    CHECK(known.read() == 2.0F);  // as is what is pending beside it
    CHECK(twice.read() == 4.0F);
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

TEST_CASE("a read of an element that nothing has written is an error, which names it", "[.written]") {
  onEveryTarget([](sk::Device& device) {
    auto x = device.stream<float>({count}), r = device.stream<float>({count}), t = device.stream<float>({1});
    auto list = device.stream<float>({0});
    x.fill(1);
    auto most = partOf(device, 0, 5), inner = partOf(device, 1, 5);
    CHECK(errorOf([&] { doubled(most, r); }) == unreadAt("doubled", "x", "{5}"));
    CHECK(errorOf([&] { r.read(); }) == unread("read"));  // it has not run
    CHECK(errorOf([&] { doubled(most.domain({0}, {5}), r.domain({0}, {5})); }) == "no error");
    CHECK(errorOf([&] { r.domain({0}, {5}).read(); }) == "no error");
    CHECK(errorOf([&] { doubled(most.domain({3}, {6}), r.domain({0}, {3})); }) ==
          unreadAt("doubled", "x", "{2}", "{3}"));
    CHECK(errorOf([&] { doubled(sk::stride(most.domain({3}, {6}), {2}), r.domain({0}, {2})); }) ==
          unreadAt("doubled", "x", "{1}", "{2}"));
    CHECK(errorOf([&] { gathered(inner, r); }).find("gathered: 'a' is read at {") == 0);
    CHECK(errorOf([&] { chosen(inner, numbers(device, {1, 2, 3, 4, 3, 2}), r); }) == "no error");
    CHECK(errorOf([&] { chosen(inner, numbers(device, {1, 2, 9, 4, 3, 2}), r); }) ==
          unreadAt("chosen", "a", "{5}"));
    CHECK(errorOf([&] { sum(most); }) == unreadAt("sum", "x", "{5}"));
    CHECK(errorOf([&] { sum(most.domain({0}, {5})); }) == "no error");
    CHECK(errorOf([&] { sum(most, t); }) == unreadAt("sum", "x", "{5}"));
    CHECK(errorOf([&] { sums(most, r); }) == unreadAt("sums", "x", "{5}"));
    CHECK(errorOf([&] { squares(most, r, t); }) == unreadAt("squares", "x", "{5}"));
    CHECK(errorOf([&] { positive(most, list); }) == unreadAt("positive", "x", "{5}"));
    const sk::Rows rows(numbers(device, {0, 2, 5}));
    CHECK(errorOf([&] { sum(rows(most), r.domain({0}, {2})); }) == "no error");
    CHECK(errorOf([&] { sum(rows(inner), r.domain({0}, {2})); }) == unreadAt("sum", "x", "{0}"));
    CHECK(errorOf([&] { most.read(); }) == lacking("read", "{5}"));
    CHECK(errorOf([&] { most.readReals(); }) == lacking("readReals", "{5}"));
    CHECK(errorOf([&] { sk::sort(inner); }) == lacking("sk::sort", "{0}"));
    CHECK(errorOf([&] { sk::sort(x, inner); }) == lacking("sk::sort", "{0}"));
    CHECK(errorOf([&] { most.domain({5}, {6}).copyTo(r.domain({0}, {1})); }) ==
          lacking("copyTo", "{0}", "{1}"));
    sk::Stream<float> moved = std::move(most);
    std::swap(moved, inner);
    CHECK(errorOf([&] { doubled(inner, r); }) == unreadAt("doubled", "x", "{5}"));
  });
}

TEST_CASE("a member of a bundle is named with its path", "[.written]") {
  onEveryTarget([](sk::Device& device) {
    auto x = device.stream<float>({count}), r = device.stream<float>({count});
    auto most = partOf(device, 0, 5);
    x.fill(1);
    Ground ground{{x, most}, 1};
    CHECK(errorOf([&] { ofGround(ground, r); }) == unreadAt("ofGround", "ground.layers.bottom", "{5}"));
    most.domain({5}, {6}).fill(2);
    CHECK(errorOf([&] { ofGround(ground, r); }) == "no error");
  });
}

TEST_CASE("elements that do not change a result may be unwritten", "[.written]") {
  onEveryTarget([](sk::Device& device) {
    auto x = device.stream<float>({count}), r = device.stream<float>({count});
    x.fill(1);
    auto u = device.stream<float>({count});
    CHECK(errorOf([&] { weighted(0.0F, u, x, r); }) == "no error");
    CHECK(errorOf([&] { weighted(0.5F, u, x, r); }) == unread("weighted", "x"));
    CHECK(errorOf([&] { guarded(4, partOf(device, 0, 4), r); }) == "no error");
    CHECK(errorOf([&] { guarded(5, partOf(device, 0, 4), r); }) == unreadAt("guarded", "x", "{4}"));
    auto n = device.stream<std::uint32_t>({count});
    n.domain({0}, {5}).fill(1);
    CHECK(errorOf([&] { counted(n, x, r); }) == unreadAt("counted", "n", "{5}"));
    auto set = device.stream<bool>({count});
    auto pairs = device.stream<sk::float2>({count});
    auto s = device.stream<float>({count});
    pairs.fill({-1, 3});
    CHECK(errorOf([&] { flagged(set, pairs, r, s); }) == "no error");  // it chooses among equal values
    pairs.fill({1, 3});
    CHECK(errorOf([&] { flagged(set, pairs, r, s); }) == unread("flagged", "set"));
    // a frame around a grid, whose corners no neighbor() reaches
    auto grid = device.stream<float>({4, 5}), next = device.stream<float>({4, 5});
    grid.domain({1, 0}, {3, 5}).fill(1);
    grid.domain({0, 1}, {4, 4}).fill(1);
    const sk::Box inside{{1, 1}, {3, 4}};
    CHECK(errorOf([&] { around.with({.box = inside})(grid, next); }) == "no error");
    CHECK(errorOf([&] { around.with({.box = {{0, 1}, {3, 4}}})(grid, next); }) ==
          unreadAt("around", "u", "{0, 0}", "{4, 5}"));
    CHECK(errorOf([&] { next.domain({1, 1}, {3, 4}).read(); }) == "no error");
    CHECK(errorOf([&] { next.read(); }) == lacking("read", "{0, 0}", "{4, 5}"));
    // copies of what nothing has written are unwritten, too
    CHECK(errorOf([&] { grid.copyTo(next); }) == "no error");
    CHECK(errorOf([&] { around.with({.box = inside})(next, grid); }) == "no error");
    CHECK(errorOf([&] { next.read(); }) == lacking("read", "{0, 0}", "{4, 5}"));
    next.fill(1);
    grid.copyTo(next);
    CHECK(errorOf([&] { next.read(); }) == lacking("read", "{0, 0}", "{4, 5}"));
  });
}

TEST_CASE("an operation writes just its elements", "[.written]") {
  onEveryTarget([](sk::Device& device) {
    auto x = device.stream<float>({count});
    x.fill(1);
    const auto unwritten = [&](auto&& write) {
      auto u = device.stream<float>({count});
      CHECK(errorOf([&] { write(u); }) == "no error");
      std::string all;
      for (int k = 0; k < count; ++k)
        all += errorOf([&] { u.domain({k}, {k + 1}).read(); }) == "no error" ? '.' : '?';
      return all;
    };
    using U = sk::Stream<float>;
    const std::vector<float> two{1, 2};
    CHECK(unwritten([&](U& u) { u.domain({1}, {3}).write(two); }) == "?..???");
    CHECK(unwritten([&](U& u) { u.domain({1}, {3}).writeAsync(two); }) == "?..???");
    CHECK(unwritten([&](U& u) { sk::stride(u, {2}, {1}).fill(2); }) == "?.?.?.");
    CHECK(unwritten([&](U& u) { x.domain({0}, {2}).copyTo(u.domain({4}, {6})); }) == "????..");
    CHECK(unwritten([&](U& u) { doubled(x.domain({0}, {2}), u.domain({4}, {6})); }) == "????..");
    CHECK(unwritten([&](U& u) { doubled.with({.box = {{2}, {4}}})(x, u); }) == "??..??");
    CHECK(unwritten([&](U& u) { placed(numbers(device, {5, 0, 5, 3, 7, -1}), x, u); }) == ".??.?.");
    CHECK(unwritten([&](U& u) {
            auto list = device.stream<float>({0});
            divided(2, x.domain({0}, {3}), list, u);
            CHECK(list.read() == std::vector<float>{1, 1});
          }) == "...???");
    CHECK(unwritten([&](U& u) { sum(x.reshape({2, 3}), u.domain({2}, {4}).reshape({2, 1})); }) == "??..??");
    CHECK(unwritten([&](U& u) { sums(x.domain({0}, {3}), u.domain({0}, {3})); }) == "...???");
    CHECK(unwritten([&](U& u) { static_cast<void>(errorOf([&] { u.write(two); })); }) == "??????");
    CHECK(unwritten([&](U& u) { static_cast<void>(errorOf([&] { doubled(x.domain({0}, {2}), u); })); }) ==
          "??????");
    CHECK(unwritten([&](U& u) { device.record([&] { doubled(x, u), x.copyTo(u), u.fill(1); }); }) ==
          "??????");
    CHECK(unwritten([&](U& u) {
            device.record([&] { doubled(x.domain({0}, {2}), u.domain({0}, {2})); }).repeat(1);
          }) == "..????");
    CHECK(unwritten([&](U& u) { placed(numbers(device, {0, 1, 2, 3, 4, 5}), x, u); }) == "......");
  });
}

TEST_CASE("what combines values reads the elements that it changes", "[.written]") {
  onEveryTarget([](sk::Device& device) {
    auto x = device.stream<float>({count});
    x.fill(-2);
    auto most = partOf(device, 0, 5), low = partOf(device, 0, 3);
    CHECK(errorOf([&] { added(numbers(device, {0, 1, 2, 3, 4, 0}), x, most); }) == "no error");
    CHECK(errorOf([&] { added(numbers(device, {0, 1, 2, 5, 4, 0}), x, most); }) ==
          unreadAt("added", "r", "{5}"));
    CHECK(errorOf([&] { grown(x, low); }) == "no error");
    CHECK(errorOf([&] { grown(x, low.domain({1}, {6})); }) == unreadAt("grown", "r", "{2}", "{5}"));
    CHECK(low.domain({0}, {3}).read() == std::vector<float>{1, 1, 1});
    CHECK(errorOf([&] { low.read(); }) == lacking("read", "{3}"));
  });
}

TEST_CASE("loops are checked each time that they run", "[.written]") {
  onEveryTarget([](sk::Device& device) {
    auto u = device.stream<float>({count}), v = device.stream<float>({count});
    sk::Scalar<float> factor = device.scalar<float>();
    sk::Loop loop = device.record([&] {
      scaled(factor, u, v);
      std::swap(u, v);
    });
    CHECK(errorOf([&] { loop.repeat(1); }) != "no error");
    factor = 2.0F;
    CHECK(errorOf([&] { loop.repeat(1); }) == unread("scaled", "x"));
    u.domain({0}, {5}).fill(1);
    CHECK(errorOf([&] { loop.repeat(1); }) == unreadAt("scaled", "x", "{5}"));
    u.domain({5}, {6}).fill(1);
    CHECK(errorOf([&] { loop.repeat(3); }) == "no error");
    CHECK(u.read() == std::vector<float>(count, 8));
    sk::Scalar<float> total = device.scalar<float>();
    sk::Loop sumUp = device.record([&] { total = total + 1.0F; });
    CHECK(errorOf([&] { sumUp.repeat(1); }).find("a scalar: nothing has written") == 0);
    total = 1.0F;
    CHECK(errorOf([&] { sumUp.repeat(2); }) == "no error");
    CHECK(total.read() == 3.0F);
    sk::Scalar<bool> done = device.scalar<bool>();
    sk::Loop untilDone = device.record([&] {
      total = total + 1.0F;
      done = total >= 5.0F;
    });
    CHECK(untilDone.until(done, {.every = 4}) == 2);  // whatever the device, the host asks each time
  });
}

TEST_CASE("passes of the check are not counted, and its streams leave the application's alone",
          "[.written]") {
  onEveryTarget([](sk::Device& device) {
    auto x = partOf(device, 0, 5), r = device.stream<float>({count});
    device.countPasses(true);
    guarded(5, x, r);
    const std::int64_t passes = device.passCount().passes;
    device.countPasses(false);
    CHECK(passes == 1);
    CHECK(r.read() == std::vector<float>{1, 1, 1, 1, 1, 0});
    CHECK(x.domain({0}, {5}).read() == std::vector<float>(5, 1));
  });
}

}  // namespace
}  // namespace run_tests
