// SPDX-License-Identifier: MIT
//
// Kernels of any rank against those that they stand for.
#include "any_rank.sk.hpp"
#include "error_of.hpp"
#include "layers_of_ranks.sk.hpp"
#include "support/devices.hpp"
#include "support/values.hpp"

using namespace run_tests;

namespace {

sk::Stream<float> numbered(sk::Device& device, const sk::Shape& shape) {
  auto stream = device.stream<float>(shape);
  std::vector<float> values;
  for (int i = 0; i < stream.size(); ++i) values.push_back(float(i * i % 23));
  stream.write(values);
  return stream;
}

template <class Flat>
void checkRelax(sk::Device& device, const sk::Shape& shape, const Flat& flat) {
  INFO(sk::toString(shape));
  const auto b = numbered(device, shape), u = numbered(device, shape);
  auto v = device.stream<float>(shape), expected = device.stream<float>(shape);
  any_rank::relax(b, u, v);
  flat(b, u, expected);
  CHECK(v.read() == expected.read());
}

}  // namespace

TEST_CASE("the rank of a gather chooses the kernel", "[any_rank]") {
  onSomeLayouts([](sk::Device& device) {
    checkRelax(device, {13}, any_rank::flatRelax1);
    checkRelax(device, {5, 7}, any_rank::flatRelax2);
    checkRelax(device, {3, 4, 5}, any_rank::flatRelax3);
  });
}

TEST_CASE("bundles and reduces of any rank", "[any_rank]") {
  onGlAndNative([](sk::Device& device) {
    auto u = device.stream<float>({1, 3}), v = device.stream<float>({1, 3});
    u.write(std::vector<float>{1, 2, 4});
    any_rank::scaled({.u = u, .scale = 0.5f}, v);  // outside is 2
    CHECK(v.read() == std::vector<float>{0.5f * (2 + 2 + 4 - 4), 0.5f * (1 + 4 + 4 - 8), 0.5f * (2 + 2 + 4 - 16)});
    auto u4 = device.stream<float>({1, 1, 1, 2}), v4 = device.stream<float>({1, 1, 1, 2});
    u4.write(std::vector<float>{1, 3});
    any_rank::scaled({.u = u4, .scale = 1}, v4);
    CHECK(v4.read() == std::vector<float>{2 + 3 + 12 - 8, 1 + 2 + 12 - 24});

    auto x = device.stream<float>({2, 2}), y = device.stream<float>({4});
    x.write(std::vector<float>{1, 2, 3, 4});
    y.write(std::vector<float>{1, 2, 3, 4});
    CHECK(any_rank::energy(x, x) == 30.0f);
    CHECK(any_rank::energy(y, y) == 30.0f);
  });
}

TEST_CASE("aliases of gathers have attributes", "[any_rank]") {
  onGlAndNative([](sk::Device& device) {
    auto a = device.stream<float>({2, 3}), b = device.stream<float>({3}), r = device.stream<float>({2});
    a.write(std::vector<float>{1, 2, 3, 10, 20, 30});
    b.write(std::vector<float>{100, 200, 300});
    any_rank::aliased(a, b, b, {.u = a, .w = b}, r);
    CHECK(r.read() == std::vector<float>{3 + 200 - 1 + 10 + 100, 1 + 100 + 100 + 20 + 100});
  });
}

TEST_CASE("overloads that differ in the rank of a gather", "[any_rank]") {
  onGlAndNative([](sk::Device& device) {
    auto r = device.stream<sk::int4>({1});
    any_rank::total(numbered(device, {5}), r);
    CHECK(r.read()[0].x == 5);
    any_rank::total(numbered(device, {2, 3, 4}), r);
    CHECK(r.read()[0].x == 40);
    CHECK(r.read()[0].z == 20);
    CHECK(errorOf([&] { any_rank::total(numbered(device, {2, 3}), r); }) ==
          "total: 'a' has rank 2, but there are kernels for rank 1 or 3 alone; give such a stream, or instantiate the "
          "template for rank 2");
    CHECK(errorOf([&] {
            auto v = device.stream<float>({1});
            any_rank::scaled({.scale = 1}, v);
          }) == "scaled: 'grid.u' is not given, and its rank chooses the kernel; give a stream of rank 2 or 4");
  });
}

TEST_CASE("a gather of another rank than the domain chooses, too", "[any_rank]") {
  onGlAndNative([](sk::Device& device) {
    const auto a = numbered(device, {2, 3}), b = numbered(device, {2, 2, 2});
    auto r = device.stream<float>({3}), s = device.stream<float>({2, 2});
    layers::layer(a, 1, r);
    CHECK(r.read() == std::vector<float>{9, 16, 25 - 23});
    layers::layer(b, 1, s);
    CHECK(s.read() == std::vector<float>{16, 25 - 23, 36 - 23, 49 - 46});
  });
}

TEST_CASE("a gather that is switched off leaves the choice to others", "[any_rank]") {
  onGlAndNative([](sk::Device& device) {
    const auto line = numbered(device, {3}), plane = numbered(device, {2, 3});
    auto r = device.stream<float>({2});
    any_rank::picked({.first = false, .b = plane}, r);
    CHECK(r.read() == std::vector<float>{0, 0});
    any_rank::picked({.first = true, .a = line.domain({1}, {3})}, r);
    CHECK(r.read() == std::vector<float>{1, 1});
  });
}

TEST_CASE("axes that elements choose, and a program's own names", "[any_rank]") {
  onGlAndNative([](sk::Device& device) {
    auto u = device.stream<float>({3}), v = device.stream<float>({3});
    auto d = device.stream<int>({3});
    u.write(std::vector<float>{1, 2, 4});
    d.write(std::vector<int>{0, 1, 0});
    any_rank::along(u, d, v);
    CHECK(v.read() == std::vector<float>{2, 2, 4});
    auto r = device.stream<float>({2});
    own_names::gather(u, r);
    CHECK(r.read() == std::vector<float>{-1, -4});
    auto a = device.stream<float>({5}), first = device.stream<float>({5});
    a.write(std::vector<float>{1, 2, 3, 4, 5});
    firsts_2(a, first);
    CHECK(first.read() == std::vector<float>{1, 2, 0, 0, 0});
    auto flags = device.stream<int>({5});
    between(3, flags);
    CHECK(flags.read() == std::vector<int>{1, 1, 1, 0, 0});
    ownTemplate(u, v);
    CHECK(v.read() == std::vector<float>{2, 3, 5});
  });
}
