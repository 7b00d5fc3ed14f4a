// SPDX-License-Identifier: MIT
//
// Names, overloads and namespaces of kernels, and calls among kernels, against plain C++. All results are exact.
#include "kernels.sk.hpp"
#include "same_names.sk.hpp"
#include "support/devices.hpp"
#include "support/host_array.hpp"
#include "support/values.hpp"

using namespace run_tests;
using sk::float2, sk::float3, sk::int2, sk::int4;

namespace {

constexpr std::int64_t count = 77;
const std::vector<float> x = values<float>(count), y = values<float>(count, 1);
const std::vector<int> n = [] {
  auto list = values<int>(count, 2);
  for (int& k : list) k = k % 1000;
  return list;
}();

}  // namespace

TEST_CASE("names that GLSL or C++ have taken are nobody's trouble") {
  onGlAndNative([](sk::Device& device) {
    auto r = device.stream<float>({count}), s = device.stream<float>({count});
    texture(streamOf<float>(device, x), 3, streamOf<float>(device, y), r, s);
    CHECK(difference(r.read(), [](std::size_t i) { return x[i] + 3; }) == "");
    CHECK(difference(s.read(), [](std::size_t i) { return y[1] + x[i] + 3; }) == "");
    std::vector<buffer> b;
    for (std::size_t i = 0; i < x.size(); ++i) b.push_back({x[i], y[i], n[i], {1, 2}});
    auto out = device.stream<buffer>({count});
    sample(streamOf<buffer>(device, b), out);
    const auto read = out.read();
    for (std::size_t i = 0; i < x.size(); ++i) {
      CHECK(read[i].in == x[i] + y[i]);
      CHECK(read[i].xy == float2{static_cast<float>(n[i]), 2});
    }
  });
}

TEST_CASE("overloads are chosen by the types of the streams") {
  onGlAndNative([](sk::Device& device) {
    const auto xs = streamOf<float>(device, x), ys = streamOf<float>(device, y);
    const auto ns = streamOf<int>(device, n);
    std::vector<float2> p;
    for (std::size_t i = 0; i < x.size(); ++i) p.push_back({x[i], y[i]});
    const auto ps = streamOf<float2>(device, p);
    auto r = device.stream<float>({count});
    auto m = device.stream<int>({count});
    auto q = device.stream<float2>({count});
    twiceOf(xs, r);
    CHECK(difference(r.read(), [](std::size_t i) { return 2 * x[i]; }) == "");
    twiceOf(ns, m);
    CHECK(difference(m.read(), [](std::size_t i) { return 2 * n[i] + 1; }) == "");
    twiceOf(ps, q);
    CHECK(difference(q.read(), [](std::size_t i) { return float2{2 * x[i] + 2, 2 * y[i] + 2}; }) == "");
    twiceOf(xs, ys, r);
    CHECK(difference(r.read(), [](std::size_t i) { return 2 * x[i] + y[i]; }) == "");
    twiceOf(ps, xs, q);
    CHECK(difference(q.read(), [](std::size_t i) { return float2{x[0] * x[i], y[0] * x[i]}; }) == "");
    int sum = 0;
    for (const int k : n) sum += k;
    CHECK(total(ns) == sum);
    CHECK(total(streamOf<float>(device, {1, 2, 4.5f})) == 7.5f);
  });
}

TEST_CASE("one name may stand in several namespaces and files") {
  onGlAndNative([](sk::Device& device) {
    const auto xs = streamOf<float>(device, x);
    auto r = device.stream<float>({count}), s = device.stream<float>({count});
    scale(0.5f, xs, r);
    CHECK(difference(r.read(), [](std::size_t i) { return x[i] / 2; }) == "");
    again::scale(0.5f, xs, r);
    CHECK(difference(r.read(), [](std::size_t i) { return x[i] + 7; }) == "");
    outer::inner::scale(xs, r, s);
    CHECK(difference(r.read(), [](std::size_t i) { return x[i] * 5; }) == "");
    CHECK(difference(s.read(), [](std::size_t i) { return x[i] * 3; }) == "");
    outer::scale(xs, r);
    CHECK(difference(r.read(), [](std::size_t i) { return x[i] * 16; }) == "");
    CHECK(again::total(streamOf<float>(device, {2, 3, 4})) == 24);
    auto m = device.stream<int>({count});
    hidden(streamOf<int>(device, n), m);
    CHECK(difference(m.read(), [](std::size_t i) { return -n[i]; }) == "");

    auto p = device.stream<outer::inner::Pair>({1});
    p.write(std::vector<outer::inner::Pair>{{{4, 5}}});
    auto q = device.stream<outer::Pair>({1});
    q.write(std::vector<outer::Pair>{{0.5f, 7}});
    auto pOut = device.stream<outer::inner::Pair>({1});
    auto qOut = device.stream<outer::Pair>({1});
    outer::inner::pairs(p, q, qOut, pOut);
    CHECK(qOut.read()[0].a == 4.5f);
    CHECK(qOut.read()[0].b == 2);
    CHECK(pOut.read()[0].n == int2{35, 28});
    auto v = device.stream<again::Pair>({1});
    v.write(std::vector<again::Pair>{{{1, 2, 3}}});
    again::pairs(v, v);
    CHECK(v.read()[0].v == float3{3, 2, 1});
  });
}

TEST_CASE("a struct of a file that two .sk files include is one type") {
  onGlAndNative([](sk::Device& device) {
    auto shared = device.stream<Shared>({count});
    auto r = device.stream<float>({count});
    makeShared(streamOf<float>(device, x), shared);
    again::takeShared(shared, r);
    CHECK(difference(r.read(),
                     [](std::size_t i) { return x[i] + static_cast<float>(static_cast<int>(x[i])); }) == "");
  });
}

TEST_CASE("kernels call kernels and reduces, and know their streams within") {
  onSomeLayouts([](sk::Device& device) {
    const sk::Shape shape{7, 70};
    const HostArray<float> input(shape,
                                 [](std::size_t i) { return valueAt<float>(static_cast<std::uint32_t>(i)); });
    const HostArray<float> row({1, 70}, [](std::size_t i) { return i % 3 == 0 ? 0.0f : 0.5f; });
    auto r = device.stream<float>(shape);
    auto s = device.stream<int4>(shape);
    calls::chain(input.on(device), row.on(device), r, s);
    const auto join = [](float whole, float part, float gain) {
      return part == 0 ? whole : whole + gain * part;
    };
    // Exact in float: multiples of 1/512 up to 16000 need 23 bits.
    CHECK(difference(r.read(), [&](std::size_t i) {
            const float v = input.elements()[i], w = std::floor(v);
            const float half = join(w, v - w, 10) * 0.5f;
            return join(v, row.elements()[i % 70], 2) * 1000 + (half - std::floor(half)) * 100 +
                   std::floor(half) + 1;
          }) == "");
    CHECK(difference(s.read(), [](std::size_t i) {
            // numbered(x, ...) sets `size` to the domain's index and `s` to its extents.
            const int px = static_cast<int>(i % 70), py = static_cast<int>(i / 70);
            return int4{70 * 101 + px * 101, 7 * 101 + py * 101, 101, 101};
          }) == "");

    auto sums = device.stream<float>({7});
    calls::sumOfRow(input.on(device), sums);
    CHECK(difference(sums.read(), [&](std::size_t i) {
            float sum = 0.5f;
            for (std::size_t k = 0; k < 70; ++k) sum += input.elements()[i * 70 + k];
            return sum;
          }) == "");
  });
}

TEST_CASE("an element is converted to what the kernel that is called takes") {
  onGlAndNative([](sk::Device& device) {
    auto r = device.stream<float>({count});
    calls::converted(streamOf<int>(device, n), r);
    CHECK(difference(r.read(), [](std::size_t i) { return static_cast<float>(2 * n[i]); }) == "");
  });
}

TEST_CASE("an output may be read once it is written") {
  onGlAndNative([](sk::Device& device) {
    auto a = device.stream<float>({count});
    auto b = device.stream<float2>({count});
    calls::reads(streamOf<float>(device, x), a, b);
    CHECK(difference(a.read(), [](std::size_t i) { return x[i] * x[i]; }) == "");
    CHECK(difference(b.read(), [](std::size_t i) {
            const float square = x[i] * x[i], sum = x[i] + (square + x[i]);
            return float2{sum > 10 ? square : x[i], sum};
          }) == "");
  });
}
