// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numeric>

#include "classics/support/classic.hpp"
#include "sparse.sk.hpp"
#include "support/vec.hpp"

using examples::Vector;
using Reals = std::vector<double>;
constexpr float tolerance = 1e-6F;  // of conjugate gradients, relative to the right-hand side
constexpr double u = 0x1p-24;  // a rounding of floats
double norm(const Reals& v) { return std::sqrt(std::inner_product(v.begin(), v.end(), v.begin(), 0.0)); }

/// Texels whose rows have one length.
struct Rectangle {
  int length, y, x, height, width;
  auto of(auto& stream) const { return stream.domain({y, x}, {y + height, x + width}); }
};

/// Rows sorted by length fill the texture, so that those of one length are three rectangles at most.
std::vector<Rectangle> packed(const std::vector<int>& count, int n, int width) {
  std::vector<Rectangle> all;
  for (int t = 0, last = 0; t < n; t += all.back().height * all.back().width) {
    while (last < n && count[last] == count[t]) ++last;
    const int x = t % width, rows = x == 0 ? (last - t) / width : 0;
    all.push_back({count[t], t / width, x, std::max(rows, 1), rows ? width : std::min(last - t, width - x)});
  }
  return all;
}

/// The matrix in double. Texels have numbers here, and vectors three components for each.
struct Matrix {
  std::vector<int> count, Rx, Ca;
  Reals Ax, Aa;
  Reals residual(const Reals& x, Reals b) const {  // b - A x
    for (std::size_t k = 0; k < x.size(); ++k) {
      b[k] -= Ax[k / 3] * x[k];
      for (int j = Rx[k / 3]; j < Rx[k / 3] + count[k / 3]; ++j) b[k] -= Aa[j] * x[3 * Ca[j] + k % 3];
    }
    return b;
  }
};

/// A step of the flow in double, solved by damped Jacobi iterations.
Reals flowed(Matrix a, Reals x, double dt) {
  const auto cot = [](Vector p, Vector q) { return dot(p, q) / length(cross(p, q)); };
  Reals b(x.size()), r;
  a.Ax.assign(a.count.size(), 1e-99);  // not 0 where there is no row
  for (std::size_t i = 0; i < a.count.size(); ++i)
    for (int c = 0, n = a.count[i]; c < n; ++c) {
      const auto at = [&](int t) { return Vector{x[3 * t], x[3 * t + 1], x[3 * t + 2]}; };
      const Vector xi = at(i), xj = at(a.Ca[a.Rx[i] + c]);
      const Vector before = at(a.Ca[a.Rx[i] + (c + n - 1) % n]), after = at(a.Ca[a.Rx[i] + (c + 1) % n]);
      const double weight = dt / 2 * (cot(xi - before, xj - before) + cot(xi - after, xj - after));
      const double area = length(cross(before - xi, xj - xi)) / 6;
      a.Aa[a.Rx[i] + c] = -weight;
      a.Ax[i] += area + weight;
      for (std::size_t k = 3 * i; k < 3 * i + 3; ++k) b[k] += area * x[k];
    }
  while (norm(r = a.residual(x, b)) > 1e-10 * norm(b))
    for (std::size_t k = 0; k < x.size(); ++k) x[k] += 0.8 / a.Ax[k / 3] * r[k];
  return x;
}

/// Entries have equal twins across the diagonal, as each edge's triangles are those of both of its ends.
double asymmetryOf(const Matrix& a) {
  double largest = 0;
  for (int i = 0; i < std::ssize(a.count); ++i)
    for (int j = a.Rx[i]; j < a.Rx[i] + a.count[i]; ++j) {
      const int k = a.Ca[j];
      const auto row = a.Ca.begin() + a.Rx[k], end = row + a.count[k], twin = std::find(row, end, i);
      if (twin == end) return HUGE_VAL;
      largest = classics::larger(largest, std::abs(a.Aa[j] - a.Aa[twin - a.Ca.begin()]));
    }
  return largest;
}

int main(int argc, char** argv) {
  constexpr classics::Classic about{"sparse", "Bolz and others 2003", "vertices around a tube", 72, 24, 256};
  return classics::run(argc, argv, about, [](classics::Run& run) {
    using namespace sparse;
    const int around = run.size(), n = 8 * around * around, pixels = 480;
    const int width = 4 * int(std::ceil(std::sqrt(n) / 4)), height = (n + width - 1) / width;
    SparseStreams s(run.device(), height, width, 0, n, pixels);
    measure(around, s.lengths);
    s.vertex.fill(-1);
    sk::order(s.lengths).copyTo(s.vertex.reshape({height * width}).domain({0}, {n}));
    place(s.vertex, s.texel);
    connect(around, s.vertex, s.texel, s.count, s.Ca);
    point.with({.scan = sk::Scan::Exclusive})(s.count, s.Rx);
    s.Aa = run.device().stream<float>({s.Ca.size()});
    s.q.fill({0, 0, 0});  // where there is no row, it stays
    Matrix a{s.count.read(), s.Rx.read(), {}, {}, Reals(s.Ca.size())};
    for (const sk::int2& texel : s.Ca.read()) a.Ca.push_back(texel.y * width + texel.x);
    const std::vector<Rectangle> rectangles = packed(a.count, n, width);
    const auto product = [&](sk::Stream<sk::float3>& x) {
      for (const Rectangle& r : rectangles)
        multiply(r.length, r.of(s.Ax), r.of(s.Rx), s.Aa, s.Ca, x, r.of(x), r.of(s.q));
    };
    sk::Loop gradients = run.device().record([&] {
      product(s.p);
      inner(s.p, s.q, s.pq);
      advance(s.rr, s.pq, s.p, s.q, s.x, s.r, s.x, s.r, s.next);
      turn(s.next, s.rr, s.r, s.p, s.p);
      isSolved(tolerance, s.next, s.bb, s.rr, s.solved);
    });
    const auto picture = [&] {
      s.nearest.fill(~0U);
      draw(s.count, s.Rx, s.Ca, s.x, s.x, s.nearest);
      shadeOf(s.nearest, s.shade);
      return classics::fieldPicture(s.shade.read(), pixels, pixels, 0, 255, "dusk");
    };
    const float dt = 10.0F / (around * around);  // about the square of an edge's length
    knot(around, s.vertex, s.x);
    Reals expected = s.x.readReals();
    const examples::Image rough = picture();
    const auto step = [&] {
      assemble(dt, s.count, s.Rx, s.Ca, s.x, s.x, s.Ax, s.Aa, s.b);
      product(s.x);
      start(s.b, s.q, s.r, s.p, s.bb, s.rr);
      return gradients.until(s.solved, {.every = 8, .most = 500});
    };
    auto iterations = step();  // compiles the programs, too
    run.timed([&] { step(), step(), iterations = step(); });
    run.say("{} rows in {} rectangles; the last step took {} iterations", n, rectangles.size(), iterations);
    a.Ax = s.Ax.readReals(), a.Aa = s.Aa.readReals();
    const Reals x = s.x.readReals(), b = s.b.readReals();
    product(s.x);
    const double largest = classics::largestOf(a.Ax), rounding = 2 * u * largest * norm(x);  // of |A| |x|
    run.check("entries of a row, less 6", std::abs(double(a.Ca.size()) / n - 6), 0, "so it is on any torus");
    run.check("symmetry of A", asymmetryOf(a) / largest, 32 * u, "32 roundings");
    run.check("A x", norm(a.residual(x, s.q.readReals())), 9 * rounding, "9 roundings of |A| |x|");
    run.check("b - A x", norm(a.residual(x, b)), tolerance * norm(b) + 4 * rounding, "tolerance, roundings");
    for (int k = 0; k < 4; ++k) expected = flowed(a, expected, dt);
    for (std::size_t k = 0; k < x.size(); ++k) expected[k] -= x[k];
    run.check("x after 4 steps", norm(expected) / norm(x), 4 * 8 * tolerance, "tolerance, areas' ratio");
    sk::Loop all = run.device().record([&] { multiplyAny(s.count, s.Ax, s.Rx, s.Aa, s.Ca, s.x, s.x, s.q); });
    sk::Loop each = run.device().record([&] { product(s.x); });
    const auto called = [&] {
      for (int k = 0; k < 20; ++k) product(s.x);
    };
    run.ratio("all rows at once / rectangles", [&] { all.repeat(20); }, [&] { each.repeat(20); });
    run.ratio("rectangles call by call / in a recorded loop", called, [&] { each.repeat(20); });
    const std::vector<float> lengths(a.count.begin(), a.count.end());
    const auto parts = classics::fieldPicture(lengths, height, width, 3, 9, "dusk", std::max(1, 400 / width));
    run.picture("sparse.png", classics::sideBySide(std::vector{rough, picture(), parts}));
  });
}
