// SPDX-License-Identifier: MIT
//
// The calls of calls.mjs in native code. Prints what they compute as JSON, a list of numbers for each case.
#include <array>
#include <cstdint>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include <sk/sk.hpp>

#include "calls/calls.sk.hpp"
#include "reference.hpp"

inline void number(const Spot& s) {
  std::printf("%.17g,%.17g,%.17g", double(s.at.x), double(s.at.y), double(s.heat));
}

namespace {

struct Calls : Streams {
  template <class T>
  sk::Stream<T> zeros(const sk::Shape& shape) {
    return filled(shape, std::vector<T>(static_cast<std::size_t>(shape.size())));
  }

  void heat() {
    std::vector<float> start(256 * 256, 0.0F);
    start[128 * 256 + 128] = 1000;
    auto u = filled<float>({256, 256}, start);
    for (int step = 0; step < 100; ++step) diffuse(0.2F, u, u);
    print("heat", u.read());
    print("heat sum", {sum(u), sum.with({.accumulate = sk::Accumulate::Tree})(u)});
  }

  void elements() {
    for (const std::int64_t n : {1LL, 7LL, 256LL, 1000LL, 100003LL}) {
      auto x = random({n}, 1), y = random({n}, 2), r = device.stream<float>({n});
      saxpy(2.5F, x, y, r);
      print(("saxpy " + std::to_string(n)).c_str(), r.read());
      print(("sums " + std::to_string(n)).c_str(), {sum(r), last(r), dot(x, y)});
    }
  }

  void arithmetic() {
    constexpr std::int64_t n = 4096;
    auto x = random({n}, 14), y = random({n}, 15), r = device.stream<float>({n});
    auto p = device.stream<sk::float4>({n}), q = device.stream<sk::float4>({n}),
         s = device.stream<sk::float4>({n});
    written(x, y, p, q, s);
    print("written p", p.read());
    print("written q", q.read());
    print("written r", s.read());
    divided(x, p, q);
    print("divided p", p.read());
    print("divided q", q.read());
    loose(x, r);
    print("loose", r.read());
  }

  void boundaries() {
    for (const auto& [h, w] : {std::pair{29, 37}, {48, 64}, {1, 8}, {3, 3}}) {
      auto a = random({h, w}, 3), b = random({h, w}, 4), c = random({h, w}, 5), d = random({w}, 6);
      auto r = device.stream<float>({h, w});
      if (w >= 8) {
        edges(a, b, c, d, r);
        print(("edges " + std::to_string(w)).c_str(), r.read());
      }
      print(("far " + std::to_string(w)).c_str(), {farthest(a)});
    }
    for (const std::int64_t n : {6LL, 8LL}) {
      auto a = random({5, 7, n}, 7), r = device.stream<float>({5, 7, n});
      blur3(a, r);
      print(("space " + std::to_string(n)).c_str(), r.read());
      print(("space sum " + std::to_string(n)).c_str(), {sum(r), farthest(r)});
    }
  }

  void exact() {
    for (const std::int64_t w : {64LL, 61LL}) {
      const auto count = static_cast<std::size_t>(64 * w);
      auto cells = filled<int>({64, w}, randomIntegers<int>(count, 8, 2));
      for (int step = 0; step < 10; ++step) life(cells, cells);
      print(("life " + std::to_string(w)).c_str(), cells.read());
      print(("alive " + std::to_string(w)).c_str(), {double(::count(cells)), double(largest(cells))});
      auto x = filled<unsigned>({64, w}, randomIntegers<unsigned>(count, 9, 1u << 24)),
           r = device.stream<unsigned>({64, w});
      auto s = device.stream<int>({64, w}), steps = device.stream<int>({64, w});
      mix_bits(0xdeadbeefu, x, r, s);
      print(("bits " + std::to_string(w)).c_str(), r.read());
      print(("quotients " + std::to_string(w)).c_str(), s.read());
      print(("totals " + std::to_string(w)).c_str(), {double(::count(s)), double(largest(s))});
      collatz(300, cells, steps);  // has a loop: elements are not packed
      collatz(300, steps, steps);
      print(("collatz " + std::to_string(w)).c_str(), steps.read());
    }
    auto x = random({300, 300}, 10);
    const auto [low, high] = bounds(x);
    print("bounds", {low, high});
  }

  void records() {
    std::vector<sk::float4> four(40 * 31);
    std::vector<Body> bodies(40 * 31);
    std::vector<sk::float2> two(40 * 31);
    const std::vector<float> f = floats(4 * four.size(), 11);
    for (std::size_t i = 0; i < four.size(); ++i) {
      four[i] = {f[4 * i], f[4 * i + 1], f[4 * i + 2], f[4 * i + 3]};
      two[i] = {f[2 * i], f[2 * i + 1]};
      bodies[i] = {{{f[i], f[i + 1]}, f[i + 2]}, static_cast<int>(i), {f[i + 3], f[i + 4], f[i + 5]}};
    }
    auto v = filled<sk::float4>({40, 31}, four);
    auto r = device.stream<sk::float3>({40, 31});
    auto s = device.stream<sk::float2>({40, 31});
    turn({1, 2, 3}, true, v, r, s);
    print("turn r", r.read());
    print("turn s", s.read());
    auto b = filled<Body>({40, 31}, bodies);
    move(Spot{{1, 2}, 3}, b, b);
    std::vector<double> members;
    for (const Body& one : b.read()) {
      members.insert(members.end(), {one.spot.at.x, one.spot.at.y, one.spot.heat, double(one.kind),
                                     one.color.x, one.color.y, one.color.z});
    }
    print("move", members);
    const Spot most = heaviest(b);
    print("heaviest", {most.at.x, most.at.y, most.heat});
    auto q = filled<sk::float2>({40, 31}, two);
    field::scale(sk::float2{2, 3}, q, q);
    print("scale2", q.read());
  }

  void choices() {
    for (const std::int64_t n : {100LL, 300LL, 1024LL}) {
      auto x = random({n}, 12), w = random({n}, 13), r = device.stream<float>({n});
      choose(2, true, x, w, r);
      print(("choose 2 " + std::to_string(n)).c_str(), r.read());
      choose(5, false, x, sk::none, r);
      print(("choose 5 " + std::to_string(n)).c_str(), r.read());
    }
    auto r = device.stream<float>({6, 8});
    ramp(sk::iter(sk::float2{0, 0}, sk::float2{8, 3}), sk::iter(0, 96), r);
    print("ramp", r.read());
    bundles();
  }

  void bundles() {
    auto i = device.stream<int>({6, 8});
    std::vector<int> indices(48);
    for (int k = 0; k < 48; ++k) indices[static_cast<std::size_t>(k)] = k * 5 % 16;
    i.write(indices);
    auto color = random({16}, 31), height = random({6, 8}, 32), r = device.stream<float>({6, 8});
    auto line = device.stream<float>({16});
    const Scene scene{.color = color,
                      .ground = {.height = height, .level = 0.25F},
                      .doubled = true,
                      .weights = {sk::float2{0, 0}, sk::float2{0.5F, 0}}};
    shaded(i, scene, r);
    print("bundle", r.read());
    print("bundle total", std::vector<float>{lifted(height, scene.ground)});
    around(height, r);
    print("around 2", r.read());
    around(color, line);
    print("around 1", line.read());
  }

  void passes() {
    constexpr std::size_t n = 24 * 36;
    std::vector<sk::float3> three(n);
    for (std::size_t i = 0; i < n; ++i) {
      for (float* part : {&three[i].x, &three[i].y, &three[i].z})
        *part = static_cast<float>(random24(3 * i + static_cast<std::size_t>(part - &three[i].x), 22)) /
                16777216.0F;
    }
    auto x = random({24, 36}, 23), a = device.stream<float>({24, 36}), d = device.stream<float>({24, 36});
    auto y = filled<sk::float3>({24, 36}, three), c = device.stream<sk::float3>({24, 36});
    auto b = device.stream<sk::float2>({24, 36});
    auto e = device.stream<int>({24, 36});
    auto f = device.stream<Spot>({24, 36});
    spread(true, 0.5F, x, y, x, b, y, d, e, f);  // in place
    print("spread a", x.read());
    print("spread b", b.read());
    print("spread c", y.read());
    print("spread d", d.read());
    std::vector<double> spots;
    for (const Spot& one : f.read()) spots.insert(spots.end(), {one.at.x, one.at.y, one.heat});
    print("spread f", spots);
  }

  void filters() {
    auto a = random({20, 28}, 24), r = device.stream<float>({20, 28});
    zoom_clamp(0.37F, a, r);
    print("zoom clamp", r.read());
    zoom_wrap(0.37F, a, r);
    print("zoom wrap", r.read());
  }

  void types() {
    constexpr std::size_t n = 60;
    auto a = filled<std::uint8_t>({n}, randomIntegers<std::uint8_t>(n, 14, 256));
    auto b = filled<std::int16_t>({n}, randomIntegers<std::int16_t>(n, 15, 1000));
    auto c = device.stream<sk::unorm8>({n});
    auto d = device.stream<sk::snorm16>({n});
    auto e = device.stream<sk::half>({n});
    auto f = device.stream<bool>({n});
    std::vector<sk::unorm8> unorms;
    std::vector<sk::snorm16> snorms;
    std::vector<sk::half> halves;
    std::array<bool, n> bools{};
    for (std::size_t i = 0; i < n; ++i) {
      unorms.push_back(sk::unorm8::fromInteger(static_cast<std::uint8_t>(random24(i, 16) % 256)));
      snorms.push_back(sk::snorm16::fromInteger(static_cast<std::int16_t>(random24(i, 17) % 32768)));
      halves.push_back(sk::half(static_cast<float>(random24(i, 18) % 1024) / 64.0F));
      bools[i] = random24(i, 19) % 2 == 1;
    }
    c.write(unorms);
    d.write(snorms);
    e.write(halves);
    f.write(bools);
    auto g = device.stream<std::uint16_t>({n});
    auto h = device.stream<float>({n});
    narrow(a, b, c, d, e, f, g, h);
    print("narrow g", g.read());
    print("narrow h", h.read());
    std::vector<double> values(n);
    for (std::size_t i = 0; i < n; ++i) values[i] = random24(i, 20) / 16777216.0 + random24(i, 21) * 0x1p-44;
    auto x = filled<double>({n}, values);
    doubles(1.0 / 3.0, x, x);
    print("doubles", x.read());
  }

  void pushes() {
    for (const std::int64_t n : {1LL, 7LL, 256LL, 1000LL, 100003LL}) {
      auto x = random({n}, 40), r = device.stream<float>({3});
      positive(x, r);
      print(("positive " + std::to_string(n)).c_str(), r.read());
    }
    for (const auto& [shape, most] :
         {std::pair{sk::Shape{500}, 9}, {sk::Shape{20, 25}, 3}, {sk::Shape{5, 10, 10}, 0}}) {
      auto x = filled<int>(shape, randomIntegers<int>(500, 41, 6)), twice = device.stream<int>(shape);
      auto odd = device.stream<int>({0});
      auto even = device.stream<Spot>({10000});
      sieve(most, x, twice, odd, even);
      print(("sieve twice " + std::to_string(most)).c_str(), twice.read());
      print(("sieve odd " + std::to_string(most)).c_str(), odd.read());
      print(("sieve even " + std::to_string(most)).c_str(), even.read());
    }
    auto a = random({37, 52}, 42);
    auto at = device.stream<sk::int3>({1});
    corners(a, a, sk::iter(0, 37 * 52 * 2), at);
    print("corners", at.read());
    auto x = random({1000}, 43);
    positive(x, x);
    print("positive of itself", x.read());
    auto r = device.stream<float>(x.shape());
    saxpy(1.0F, x, x, r);
    print("twice what is pushed", r.read());
    print("sum of what is pushed", {sum(x)});
  }

  void scatters() {
    const std::int64_t n = 3000;
    auto to = filled<int>({n}, randomIntegers<int>(n, 44, 2000));
    auto r = random({1500}, 45);
    permute(to, random({n}, 46), r);
    print("permute", r.read());
    const std::vector<float> at = floats(80, 47), heat = floats(40, 48);
    std::vector<Spot> values(40);
    for (std::size_t i = 0; i < 40; ++i) values[i] = {{at[2 * i], at[2 * i + 1]}, heat[i]};
    auto spots = filled<Spot>({40}, values), places = zeros<Spot>({6, 7});
    place(filled<int>({40}, randomIntegers<int>(40, 49, 45)), spots, places);
    print("place", places.read());
    auto x = filled<int>({100, 1000}, randomIntegers<int>(100000, 50, 1000));
    auto w = random({100, 1000}, 51), total = zeros<float>({16});
    auto counts = filled<int>({16}, std::vector<int>(16, -7));
    auto most = filled<unsigned>({12}, std::vector<unsigned>(12, 3999999999u));
    auto least = filled<sk::int2>({16}, std::vector<sk::int2>(16, sk::int2{5, 5}));
    histogram(x, w, counts, total, most, least);
    print("histogram n", counts.read());
    print("histogram total", total.read());
    print("histogram most", most.read());
    print("histogram least", least.read());
    std::vector<sk::float2> points(300);
    for (std::size_t i = 0; i < 300; ++i)
      points[i] = {static_cast<float>(random24(2 * i, 52) % 30),
                   static_cast<float>(random24(2 * i + 1, 52) % 30)};
    auto p = filled<sk::float2>({300}, points);
    auto image = random({30, 30}, 53);
    for (const int radius : {1, 2}) {
      auto sums = random({30, 30}, 54), peak = zeros<float>({2, 25, 25});
      splat(radius, p, image, sums, peak);
      print(("splat sum " + std::to_string(radius)).c_str(), sums.read());
      print(("splat peak " + std::to_string(radius)).c_str(), peak.read());
    }
    auto peak = zeros<float>({2, 25, 25});
    splat(1, p, image, image, peak);
    print("splat of itself", image.read());
  }
};

}  // namespace

int main() {
  std::puts("{");
  Calls calls;
  calls.heat();
  calls.elements();
  calls.arithmetic();
  calls.boundaries();
  calls.exact();
  calls.records();
  calls.choices();
  calls.passes();
  calls.filters();
  calls.types();
  calls.pushes();
  calls.scatters();
  printReductions();
  callLayouts();
  std::puts("}");
}
