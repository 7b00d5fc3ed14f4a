// SPDX-License-Identifier: MIT
//
// Templates: each instance computes in its own types, and C++ selects the instance by the arguments.
#include "templates.sk.hpp"

#include "support/devices.hpp"
#include "support/values.hpp"

using namespace run_tests;

TEST_CASE("instances of a kernel are one overload set") {
  onGlAndNative([](sk::Device& device) {
    auto f = streamOf<float>(device, {3}, {1.5F, 2, -4});
    auto i = streamOf<int>(device, {3}, {1, 16777217, -4});
    templates::axpy(0.5F, f, f, f);
    CHECK(f.read() == std::vector<float>{2.25F, 3, -6});
    templates::axpy(1, i, i, i);
    CHECK(i.read() == std::vector<int>{2, 33554434, -8});
    auto v = streamOf<sk::float2>(device, {1}, {{1, 2}});
    templates::axpy({2, 3}, v, v, v);
    CHECK(v.read()[0] == sk::float2{3, 8});
    auto none = device.stream<float>({0});
    templates::axpy(1.0F, none, none, none);
  });
}

TEST_CASE("borders and identities are of the instance's type") {
  onGlAndNative([](sk::Device& device) {
    auto f = streamOf<float>(device, {3}, {1, 2, 3});
    auto u = streamOf<unsigned>(device, {3}, {1, 2, 4000000000U});
    templates::shifted(f, 1, f);
    CHECK(f.read() == std::vector<float>{4, 6, 14});
    templates::shifted(u, 1, u);
    CHECK(u.read() == std::vector<unsigned>{4, 3705032704U, 14});
    auto i = streamOf<int>(device, {2}, {2147483647, 1});
    CHECK(templates::sum(i) == -2147483647 - 1);
    CHECK(templates::sum(f) == 24.0F);
    CHECK(templates::sum(device.stream<int>({0})) == 0);
    auto total = device.stream<float>({1});
    templates::sum(f, total);
    CHECK(total.read()[0] == 24.0F);
  });
}

TEST_CASE("what a call does not tell is in the name") {
  onGlAndNative([](sk::Device& device) {
    auto a = streamOf<float>(device, {5}, {1, 2, 3, 4, 5});
    auto r = device.stream<float>({5});
    templates::blur_1_false(a, r);
    CHECK(r.read() == std::vector<float>{4, 6, 9, 12, 14});
    templates::blur_2_false(a, r);
    CHECK(r.read() == std::vector<float>{8, 11, 15, 19, 22});
    templates::blur_1_true(a, r);
    CHECK(r.read() == std::vector<float>{16, 36, 81, 144, 196});
    auto i = streamOf<int>(device, {2}, {3, -5});
    auto half = device.stream<float>({2});
    templates::widen_float(i, half);
    CHECK(half.read() == std::vector<float>{1.5F, -2.5F});
    templates::widen_int(i, half);
    CHECK(half.read() == std::vector<float>{1, -2});
  });
}

TEST_CASE("specialisations, and instances that only kernels call") {
  onGlAndNative([](sk::Device& device) {
    auto b = streamOf<bool>(device, {2}, {1, 0});
    templates::negate(b, b);
    CHECK(b.read() == std::vector<std::uint8_t>{0, 1});
    auto f = streamOf<float>(device, {2}, {1, -2});
    templates::negate(f, f);
    CHECK(f.read() == std::vector<float>{-1, 2});
    auto i = streamOf<int>(device, {2}, {1, -2});
    templates::twiceNegated(i, i);
    CHECK(i.read() == std::vector<int>{1, -2});
  });
}

TEST_CASE("lists that end in >>, comparisons in lists, and constraints") {
  onGlAndNative([](sk::Device& device) {
    const auto resultOf = [&](const auto& kernel) {
      auto x = streamOf<float>(device, {2}, {1, 2});
      auto r = device.stream<float>({2});
      kernel(x, r);
      return r.read();
    };
    using Values = std::vector<float>;
    CHECK(resultOf(templates::nested_Pair) == Values{1, 2});
    CHECK(resultOf(templates::compared_1_true_true_5) == Values{6, 7});
    CHECK(resultOf(templates::constrained) == Values{3, 4});
    CHECK(resultOf(templates::doubled) == Values{2, 4});
    CHECK(resultOf(templates::constrainedLast) == Values{2, 3});
    CHECK(resultOf(templates::specialised) == Values{102, 202});
    CHECK(resultOf(templates::added_1) == Values{2, 3});
    CHECK(resultOf(templates::picked) == Values{3, 4});
  });
}
