// SPDX-License-Identifier: MIT
//
// Promises: a variable output holds the pushes of all elements in row-major order, for every size and layout. A call does not
// wait for the output's size; asking for it does.
#include <cstdint>
#include <vector>

#include "pushes.sk.hpp"
#include "support/devices.hpp"

namespace {

using run_tests::onEveryLayout, run_tests::onDrawnLayouts;

constexpr std::int64_t sizes[] = {0, 1, 2, 4, 5, 63, 64, 65, 257, 1009, 4001};

float valueOf(std::int64_t i) { return static_cast<float>((i * 37) % 11) - 5.0F; }

std::vector<float> values(std::int64_t count) {
  std::vector<float> list;
  for (std::int64_t i = 0; i < count; ++i) list.push_back(valueOf(i));
  return list;
}

std::vector<float> positive(const std::vector<float>& list) {
  std::vector<float> kept;
  for (const float x : list) {
    if (x > 0) kept.push_back(x);
  }
  return kept;
}

TEST_CASE("what is pushed comes out in order") {
  onEveryLayout([](sk::Device& device) {
    auto r = device.stream<float>({0});
    for (const std::int64_t size : sizes) {
      INFO("size " << size);
      const std::vector<float> list = values(size);
      auto x = device.stream<float>({size});
      x.write(list);
      keepPositive(x, r);
      CHECK(r.read() == positive(list));
      CHECK(r.shape() == sk::Shape(static_cast<std::int64_t>(positive(list).size())));
    }
  });
}

TEST_CASE("a stream that was pushed to is a stream like any other") {
  onDrawnLayouts([](sk::Device& device) {
    const std::vector<float> list = values(1009);
    auto x = device.stream<float>({1009});
    x.write(list);
    auto r = device.stream<float>({17});
    keepPositive(x, r);
    keepPositive(r, x);  // needs the size of r
    CHECK(x.read() == positive(list));
    keepPositive(x, x);  // reads the old elements
    CHECK(x.size() == r.size());
    CHECK(x.read() == positive(list));
    x.write(std::vector<float>(static_cast<std::size_t>(x.size()), -1.0F));
    keepPositive(x, x);
    CHECK(x.size() == 0);
    CHECK(x.read().empty());
    keepPositive(r.domain({3}, {60}), x);
    CHECK(x.size() == 57);
  });
}

TEST_CASE("an old view of a stream that has become smaller is told") {
  onDrawnLayouts([](sk::Device& device) {
    auto x = device.stream<float>({100});
    x.write(std::vector<float>(100, -1.0F));
    const auto view = x.domain({90}, {100});
    keepPositive(x, x);
    CHECK_THROWS_AS(view.read(), sk::Error);
    auto r = device.stream<float>({1});
    CHECK_THROWS_AS(keepPositive(view, r), sk::Error);
  });
}

TEST_CASE("any number of structs an element") {
  onDrawnLayouts([](sk::Device& device) {
    for (const std::int64_t height : {1, 7, 70}) {
      const std::int64_t width = 13;
      std::vector<int> counts;
      std::vector<Item> expected;
      for (std::int64_t i = 0; i < height * width; ++i) {
        counts.push_back(static_cast<int>(i % 5 == 3 ? 9 : i % 3));
        for (int k = 0; k < counts.back(); ++k) {
          expected.push_back(
              {{static_cast<float>(i % width), static_cast<float>(i / width)}, k, (k & 1) == 0});
        }
      }
      auto count = device.stream<int>({height, width});
      count.write(counts);
      auto r = device.stream<Item>({0});
      repeatItems(count, r);
      const std::vector<Item> got = r.read();
      REQUIRE(got.size() == expected.size());
      bool isSame = true;
      for (std::size_t i = 0; i < got.size(); ++i) {
        isSame = isSame && got[i].where == expected[i].where && got[i].id == expected[i].id &&
                 got[i].even == expected[i].even;
      }
      CHECK(isSame);
    }
  });
}

TEST_CASE("several variable outputs, and an ordinary one beside them") {
  onDrawnLayouts([](sk::Device& device) {
    for (const std::int64_t size : {std::int64_t{0}, std::int64_t{1}, std::int64_t{1009}}) {
      std::vector<int> list, even, twice;
      std::vector<sk::float3> odd;
      for (int i = 0; i < size; ++i) {
        const int x = i * 13 % 101;
        list.push_back(x);
        twice.push_back(2 * x);
        if (x % 2 == 0) even.push_back(x);
        for (int k = 0; x % 2 != 0 && k < 3 && k <= x % 3; ++k) {
          odd.push_back({static_cast<float>(x), static_cast<float>(k), 0.5F});
        }
      }
      auto x = device.stream<int>({size});
      x.write(list);
      auto a = device.stream<int>({3});
      auto b = device.stream<sk::float3>({3});
      divide(x, 0.5F, a, b, x);
      CHECK(a.read() == even);
      CHECK(b.read() == odd);
      CHECK(x.read() == twice);
    }
  });
}

TEST_CASE("nothing, everything, and more than everything") {
  onDrawnLayouts([](sk::Device& device) {
    std::vector<std::uint32_t> list, four;
    for (std::uint32_t i = 0; i < 300; ++i) {
      const std::uint32_t x = i * 2654435761u;
      list.push_back(x);
      four.insert(four.end(), {x, ~x, x + 1, ~(x + 1)});
    }
    auto x = device.stream<unsigned>({20, 15});
    x.write(list);
    auto r = device.stream<unsigned>({5});
    nothing(x, r);
    CHECK(r.size() == 0);
    emitFour(x, r);
    CHECK(r.read() == four);
    emitFour(x.domain({2, 3}, {4, 7}), r);
    CHECK(r.size() == 2 * 4 * 4);
    CHECK(r.read()[4] == list[2 * 15 + 4]);
  });
}

TEST_CASE("indices of four dimensions, with an input that repeats") {
  onDrawnLayouts([](sk::Device& device) {
    auto a = device.stream<sk::int4>({2, 3, 5, 7});
    auto b = device.stream<int>({1, 3, 1, 1});
    std::vector<sk::int4> as, expected;
    const std::vector<int> bs = {0, 1, 2};
    for (int i = 0; i < 2 * 3 * 5 * 7; ++i) {
      as.push_back({i, 0, 0, -i});
      const sk::int4 index{i % 7, i / 7 % 5, i / 35 % 3, i / 105};
      if (((index.x + bs[static_cast<std::size_t>(index.z)]) & 1) == 0) {
        expected.push_back({index.x + i, index.y, index.z, index.w - i});
      }
    }
    a.write(as);
    b.write(bs);
    auto r = device.stream<sk::int4>({0});
    indices(a, b, r);
    CHECK(r.read() == expected);
  });
}

TEST_CASE("helpers push in the order of the calls") {
  onDrawnLayouts([](sk::Device& device) {
    for (const std::int64_t size : sizes) {
      INFO("size " << size);
      std::vector<int> list, r, s, counts;
      const auto pushUnless = [](int x, int none, std::vector<int>& into) {
        if (x != none) into.push_back(x);
        return x != none;
      };
      const auto pushAll = [&](int x, int count, std::vector<int>& into, std::vector<int>& ends) {
        int pushed = 0;
        for (int k = 0; k < count; ++k) pushed += pushUnless(x + k, 3, into) ? 1 : 0;
        if (count > 0) ends.insert(ends.end(), {x, x + count});
        return pushed;
      };
      for (std::int64_t i = 0; i < size; ++i) {
        const int x = static_cast<int>(i * 7 % 23) - 9;
        list.push_back(x);
        const int pushed = pushAll(x, x & 3, r, s);
        counts.push_back(pushed + (pushUnless(x, 7, s) ? 100 : 200));
        if (x < 0) {
          const int more = pushAll(x, 2, s, r);
          r.insert(r.end(), {x, more});
        }
      }
      auto x = device.stream<int>({size}), count = device.stream<int>({size});
      auto first = device.stream<int>({0}), second = device.stream<int>({0});
      x.write(list);
      handOn(x, first, second, count);
      CHECK(first.read() == r);
      CHECK(second.read() == s);
      CHECK(count.read() == counts);
    }
  });
}

TEST_CASE("pushes behind a return are none") {
  onDrawnLayouts([](sk::Device& device) {
    std::vector<int> list(4001);
    for (std::size_t i = 0; i < list.size(); ++i) list[i] = static_cast<int>(i);
    auto x = device.stream<int>({4001}), r = device.stream<int>({0});
    x.write(list);
    once(x, r);
    CHECK(r.read() == list);
  });
}

TEST_CASE("pushes that do not fit say so") {
  sk::Device& device = run_tests::device("glsl330");
  auto x = device.stream<int>({8});
  auto plane = device.stream<int>({2, 4});
  auto odd = device.stream<sk::float3>({1});
  CHECK_THROWS_WITH(divide(x, 1.0F, plane, odd, x),
                    Catch::Contains("divide: 'even'") && Catch::Contains("one dimension"));
  CHECK_THROWS_WITH(divide(x, 1.0F, x, odd, x), Catch::Contains("overlap"));
  auto a = device.stream<sk::int4>({2, 2});
  auto b = device.stream<int>({3, 2});
  auto r = device.stream<sk::int4>({0});
  CHECK_THROWS_WITH(indices(a, b, r), Catch::Contains("indices: 'b' has shape {3, 2}"));
}

}  // namespace
