// SPDX-License-Identifier: MIT
//
// The calls of layouts.mjs in native code.
#include <sk/sk.hpp>

#include "calls/layouts.sk.hpp"
#include "reference.hpp"

namespace {

struct Layouts {
  sk::Device device = sk::Device::native();

  sk::Stream<float> random(const sk::Shape& shape, std::uint32_t seed) {
    auto stream = device.stream<float>(shape);
    stream.write(floats(static_cast<std::size_t>(shape.size()), seed));
    return stream;
  }
  template <class T>
  sk::Stream<T> zeros(const sk::Shape& shape) {
    auto stream = device.stream<T>(shape);
    stream.fill(T{});
    return stream;
  }
  sk::Stream<int> numbers(const sk::Shape& shape, std::uint32_t seed) {
    auto stream = device.stream<int>(shape);
    stream.write(randomIntegers<int>(static_cast<std::size_t>(shape.size()), seed, 1000));
    return stream;
  }
  template <class S>
  static void shown(const std::string& name, const S& stream) {
    std::vector<double> all;
    for (const auto& element : stream.read()) add(all, element);
    print(name, all);
  }
  static void add(std::vector<double>& all, float value) { all.push_back(value); }
  static void add(std::vector<double>& all, int value) { all.push_back(value); }
  static void add(std::vector<double>& all, const sk::float2& v) { all.insert(all.end(), {v.x, v.y}); }
  static void add(std::vector<double>& all, const sk::float3& v) { all.insert(all.end(), {v.x, v.y, v.z}); }
  static void add(std::vector<double>& all, const sk::int4& v) {
    for (const int one : {v.x, v.y, v.z, v.w}) all.push_back(one);
  }
  static void add(std::vector<double>& all, const Point& p) {
    all.insert(all.end(), {p.at.x, p.at.y, double(p.kind)});
  }

  /// Boxes and strides as inputs and outputs, read and written.
  void views() {
    const auto shapes = {sk::Shape{24, 32}, sk::Shape{600}, sk::Shape{6, 4, 10}, sk::Shape{4, 6, 6, 8}};
    for (const sk::Shape& shape : shapes) {
      const std::string rank = std::to_string(shape.rank());
      auto x = random(shape, 1), y = random(shape, 2), r = random(shape, 3);
      sk::Index begin = sk::Index::origin(shape.rank()), end = begin, other = begin, steps = begin;
      for (int d = 0; d < shape.rank(); ++d) {
        begin[d] = 1;
        end[d] = shape[d] - 1;
        other[d] = 2;
        steps[d] = 2;
      }
      sk::Index last = end;
      for (int d = 0; d < shape.rank(); ++d) last[d] = end[d] + 1;
      mixed(2.5F, x.domain(begin, end), y.domain(other, last), r.domain(begin, end));
      shown("box " + rank, r);
      shown("box read " + rank, r.domain(begin, end));
      mixed(0.5F, sk::stride(x, steps), sk::stride(y, steps, begin), sk::stride(r, steps));
      shown("strides " + rank, r);
      mixed(3, r.domain(begin, end), y.domain(other, last), r.domain(begin, end));  // read and written
      shown("in place " + rank, r);
      const auto part = sk::stride(r.domain(begin, end), steps);
      part.write(floats(static_cast<std::size_t>(part.shape().size()), 4));
      shown("written " + rank, r);
      shown("strides read " + rank, part);
      print("sums of views " + rank, {squares(x.domain(begin, end)), squares(sk::stride(x, steps))});
    }
  }

  void fits() {
    auto x = random({24, 32}, 5), row = random({1, 32}, 6), column = random({24, 1}, 7),
         one = random({1, 1}, 8);
    auto r = zeros<float>({24, 32});
    mixed(2, row, column, r);
    shown("row and column", r);
    mixed(2, one, x, r);
    shown("one", r);
    auto small = random({6, 16}, 9), large = random({48, 96}, 10);
    mixed(2, sk::stretch(small), x, r);
    shown("stretched", r);
    mixed(2, sk::stride(large), x, r);
    shown("strided", r);
    auto both = random({12, 64}, 11);
    mixed(2, sk::stretch(sk::stride(both)), row, r.domain({0, 0}, {24, 32}));
    shown("both", r);
    auto deep = random({3, 1, 8}, 12), out = zeros<float>({3, 5, 8});
    mixed(2, deep, sk::stretch(random({1, 5, 4}, 13)), out);
    shown("deep", out);
  }

  void gathers() {
    auto u = random({20, 24}, 14), b = random({9}, 15), v = random({30, 40}, 16);
    smooth(u, b, v);  // smaller than the domain
    shown("small gathers", v);
    smooth(u.domain({2, 3}, {18, 21}), sk::stride(b, {2}), v.domain({1, 1}, {17, 19}));
    shown("views of gathers", v);
    auto w = random({1, 3}, 17);
    smooth(w, b, v);
    shown("tiny gathers", v);
    auto l = random({50}, 18), m = random({80}, 19);
    line(sk::stride(l, {3}, {1}), m);
    shown("line", m);
    auto s = random({6, 5, 8}, 20), t = random({4, 4, 4}, 21);
    space(s.domain({1, 0, 2}, {5, 4, 7}), random({4, 1, 4}, 22), t);
    shown("space", t);
  }

  void indices() {
    auto x = numbers({12, 16}, 23), a = numbers({16, 12}, 24);
    auto r = zeros<sk::int4>({12, 16});
    auto s = zeros<float>({12, 16});
    places(x.domain({2, 3}, {8, 11}), a.domain({0, 2}, {12, 12}), sk::iter(0, 96),
           sk::iter(sk::float2{0, 0}, sk::float2{16, 3}), r.domain({1, 4}, {7, 12}),
           s.domain({1, 4}, {7, 12}));
    shown("places r", r);
    shown("places s", s);
    places(sk::stretch(numbers({3, 4}, 25)), a, sk::iter(0, 192),
           sk::iter(sk::float2{0, 0}, sk::float2{16, 3}), r, s);
    shown("stretched places", r);
    places(numbers({1, 16}, 26), a, sk::iter(0, 192), sk::iter(sk::float2{0, 0}, sk::float2{16, 3}), r, s);
    shown("repeated places", r);
    auto steps = zeros<int>({12, 16});
    loops(sk::stride(x, {2, 2}), sk::stride(steps, {2, 2}, {1, 0}));
    shown("loops", steps);
    auto f = random({7}, 27), g = random({9}, 28), h = random({9}, 29);
    chosen(true, f.domain({1}, {6}), g.domain({4}, {9}), h.domain({2}, {7}));
    chosen(false, f.domain({0}, {2}), sk::none, h.domain({7}, {9}));
    shown("chosen", h);
  }

  void records() {
    std::vector<Point> points(10 * 12);
    const std::vector<float> f = floats(3 * points.size(), 30);
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = {{f[i], f[i + 1]}, static_cast<int>(i)};
    auto b = zeros<Point>({10, 12}), r = zeros<Point>({10, 12});
    b.write(points);
    auto s = zeros<sk::float2>({10, 12});
    moved({1, 2}, b.domain({1, 1}, {5, 7}), r.domain({2, 0}, {6, 6}), s.domain({2, 0}, {6, 6}));
    shown("moved r", r);
    shown("moved s", s);
    moved({1, 2}, b.domain({1, 1}, {5, 7}), b.domain({2, 0}, {6, 6}), s.domain({0, 5}, {4, 11}));
    shown("moved in place", b);
    shown("moved aside", s);
    auto x = random({10, 12}, 31);
    auto a = random({10, 12}, 33), d = random({10, 12}, 34);
    auto c = zeros<sk::float3>({10, 12});
    std::vector<sk::float3> three(120);
    for (std::size_t i = 0; i < 120; ++i) three[i] = {f[i], f[2 * i], f[3 * i]};
    c.write(three);
    auto two = zeros<sk::float2>({10, 12});
    auto e = zeros<int>({10, 12});
    passes(0.5F, x.domain({2, 0}, {8, 12}), c.domain({0, 0}, {5, 6}), a.domain({1, 1}, {6, 7}),
           two.domain({0, 0}, {5, 6}), c.domain({5, 6}, {10, 12}), d.domain({1, 1}, {6, 7}),
           e.domain({1, 1}, {6, 7}));
    shown("passes a", a);
    shown("passes b", two);
    shown("passes c", c);
    shown("passes d", d);
    shown("passes e", e);
  }

  void stacks() {
    const sk::Shape shape{16, 20};
    std::vector<sk::Stream<float>> f;
    for (std::uint32_t i = 0; i < 18; ++i) f.push_back(random(shape, 40 + i));
    auto i = numbers(shape, 60), j = numbers(shape, 61), s = zeros<int>(shape);
    auto l = zeros<sk::float2>(shape), m = zeros<sk::float2>(shape);
    std::vector<sk::float2> two(320);
    const std::vector<float> g = floats(640, 62);
    for (std::size_t n = 0; n < 320; ++n) two[n] = {g[2 * n], g[2 * n + 1]};
    l.write(two);
    m.write(two);
    auto r = zeros<float>(shape);
    many(0.5F, f[0], f[1], f[2], f[3], f[4], f[5], f[6], f[7], i, j, l, m, f[8], f[9], f[10], f[11], f[12],
         f[13], f[14], r, s);
    shown("many r", r);
    shown("many s", s);
    const sk::Index a{1, 2}, b{9, 13}, c{0, 0}, d{8, 11};
    many(0.5F, f[0].domain(a, b), f[1].domain(c, d), f[2].domain(a, b), f[3].domain(c, d), f[4].domain(a, b),
         f[5].domain(c, d), f[6].domain(a, b), f[7].domain(a, b), i.domain(a, b), j.domain(c, d),
         l.domain(a, b), m.domain(c, d), f[8].domain(a, b), f[9].domain(a, b), f[10].domain(a, b),
         f[11].domain(a, b), f[12].domain(a, b), random({1, 11}, 63), f[14].domain(a, b), r.domain(a, b),
         s.domain(a, b));
    shown("many views r", r);
    shown("many views s", s);
  }

  void values() {
    auto x = random({5, 8}, 64);
    auto r = zeros<sk::float2>({5, 8});
    auto a = random({1}, 65), row = random({8}, 66);
    auto b = zeros<sk::float2>({1, 1});
    b.write(std::vector<sk::float2>{{3, 4}});
    auto c = zeros<Point>({2, 2});
    c.write(std::vector<Point>{{{1, 2}, 3}, {{4, 5}, 6}, {{7, 8}, 9}, {{10, 11}, 12}});
    auto n = numbers({3}, 67);
    auto flips = zeros<bool>({1});
    flips.write(std::array<bool, 1>{true});
    const sk::float2x2 m{{{1, 2}, {3, 4}}};
    auto matrix = zeros<sk::float2x2>({1});
    matrix.write(std::vector<sk::float2x2>{m});
    held(a, b, c.domain({1, 0}, {2, 1}), n.domain({2}, {3}), flips, matrix, x, r);
    shown("held by streams", r);
    held(row.domain({5}, {6}), sk::float2{1, 2}, Point{{1, 2}, 3}, n.domain({0}, {1}), false, m, x, r);
    shown("held by some", r);
    auto v = random({5, 8}, 68);
    mixed(row.domain({3}, {4}), x.domain({0, 1}, {5, 2}), x, v);
    shown("held beside views", v);
  }

  void dials() {
    std::vector<float> values = floats(64, 69);
    auto x = random({64}, 69), r = zeros<float>({64});
    const auto dialled = [&](const std::string& name, const auto& kernel) {
      kernel(0.75F, sk::float2{1.5F, 0.25F}, x, r);
      shown(name, r);
    };
    dialled("single", curve);
    dialled("half", curve.with({.precision = sk::Precision::Half}));
    steady.with({.precision = sk::Precision::Double})(0.75F, sk::float2{1.5F, 0.25F}, x, r);
    shown("extended", r);
    thirds(x, r);
    shown("thirds", r);
    auto i = numbers({9}, 70), j = zeros<int>({9});
    integers(i, j);
    shown("integers", j);
  }
};

}  // namespace

void callLayouts() {
  Layouts layouts;
  layouts.views();
  layouts.fits();
  layouts.gathers();
  layouts.indices();
  layouts.records();
  layouts.stacks();
  layouts.values();
  layouts.dials();
}
