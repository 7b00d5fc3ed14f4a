// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <map>
#include <valarray>

#include "banded.sk.hpp"
#include "classics/support/classic.hpp"

namespace {

using namespace banded;
using clVector = sk::Stream<float>;

constexpr classics::Classic about{"banded", "Krueger, Westermann 2003", "points along a side", 512, 16, 1024};
constexpr int steps = 120, stepsPerDrop = 15;
constexpr float tolerance = 1e-6f;  ///< of a residual, beside the right-hand side
constexpr float least = 1e-30f;     ///< of divisors: what is solved to the last bit stays as it is

/// I - alpha L, where L is the Laplacian on w x w points of a ring: row after row of points, and the first again.
struct clMatrix {
  std::vector<sk::int2> offsets;  ///< of the diagonals, in texture coordinates
  std::vector<clVector> diagonals;

  clMatrix(sk::Device& device, int w, double alpha, bool shared) {
    const int n = w * w;
    std::map<int, std::vector<float>> notEmpty;
    for (const int step : {0, 1, -1, w, -w}) {
      for (int row = 0; row < n; ++row) {
        const int i = (row + step + n) % n - row;
        auto& diagonal = notEmpty.try_emplace(shared ? (i + n) % n : i, n).first->second;
        diagonal[static_cast<std::size_t>(row)] = static_cast<float>(step == 0 ? 1 + 4 * alpha : -alpha);
      }
    }
    for (const auto& [i, values] : notEmpty) {
      offsets.push_back({(i + n) % n % w, (i + n) % n / w});
      diagonals.push_back(device.stream<float>({w, w}));
      diagonals.back().write(values);
    }
  }

  /// Computes y = A x, adding one or up to four diagonals in each pass.
  void multiply(const clVector& x, clVector& y, bool four = true) const {
    const auto* i = offsets.data();
    const auto *d = diagonals.data(), *end = d + diagonals.size();
    clMatVec(false, *i++, *d++, x, sk::none, y);
    for (; four && d + 4 <= end; i += 4, d += 4)
      clMatVec4(std::array{i[0], i[1], i[2], i[3]}, d[0], d[1], d[2], d[3], x, y, y);
    while (d != end) clMatVec(true, *i++, *d++, x, y, y);
  }
};

using Reals = std::valarray<double>;  ///< whose elements shift around the ends, too
double dot(const Reals& x, const Reals& y) { return (x * y).sum(); }
double norm(const Reals& x) { return std::sqrt(dot(x, x)); }
Reals realsOf(const std::vector<double>& values) { return {values.data(), values.size()}; }

void water(classics::Run& run) {
  sk::Device& device = run.device();
  auto index = device.stream<float>({3, 4});
  clIndex(index);
  const std::vector<float> j = index.read();
  run.say("a vector of 12 elements lies in a texture of 4 x 3 as");
  for (auto row = 0u; row < 12; row += 4) run.say("  {:2}", fmt::join(&j[row], &j[row] + 4, " "));

  const int w = run.size();
  const double speed = w / 400.0, alpha = speed * speed / 2;  // of waves, in points a step
  const clMatrix a(device, w, alpha, true), unshared(device, w, alpha, false);
  run.say("the matrix of {0} x {0} unknowns takes {1} textures of {2:.3g} MB, and without sharing {3}", w,
          a.diagonals.size(), 4e-6 * w * w, unshared.diagonals.size());
  std::array<clVector, 7> vectors;
  for (clVector& v : vectors) (v = device.stream<float>({w, w})).fill(0);
  auto& [x, b, r, p, q, now, last] = vectors;
  auto rho = device.scalar<float>(), next = device.scalar<float>(), pq = device.scalar<float>(),
       rhs = device.scalar<float>();
  auto done = device.scalar<bool>();
  sk::Loop conjugateGradients = device.record([&] {
    a.multiply(p, q);
    clVecReduce(p, q, pq);
    const sk::Scalar<float> step = rho / max(pq, least);
    clVecOp(1.0f, step, x, p, x);
    clVecOp(1.0f, -step, r, q, r);
    clVecReduce(r, r, next);
    clVecOp(1.0f, next / max(rho, least), r, p, p);
    rho.assign(next);
    done = rho < tolerance * tolerance * rhs;
  });
  std::int64_t iterations = 0;
  std::array<Reals, 3> u;  // after the last three steps
  const double took = run.timed([&] {
    for (int step = 0; step < steps; ++step) {
      if (step % stepsPerDrop == 0) drop(static_cast<float>(step / stepsPerDrop), now, last, now, last);
      a.multiply(now, q);
      clVecOp(3.0f, -1.0f, now, q, b);
      clVecOp(1.0f, -1.0f, b, last, b);
      clVecOp(2.0f, -1.0f, now, last, x);
      a.multiply(x, r);
      clVecOp(1.0f, -1.0f, b, r, r);
      r.copyTo(p);
      clVecReduce(r, r, rho);
      clVecReduce(b, b, rhs);
      iterations += conjugateGradients.until(done, {.every = 4, .most = 200});
      now.copyTo(last);
      x.copyTo(now);
      if (step >= steps - 3) u[static_cast<std::size_t>(step - steps + 3)] = realsOf(now.readReals());
    }
  });
  run.say("{} steps, in each of which waves go {:.2f} points: {:.1f} iterations and {:.3g} ms a step", steps,
          speed, static_cast<double>(iterations) / steps, took / steps);

  const auto single = [&] { a.multiply(b, q, false); };
  run.ratio("a product without sharing / one with it", [&] { unshared.multiply(b, q, false); }, single);
  run.ratio("a product by one diagonal in a pass / one by four", single, [&] { a.multiply(b, q); });
  const auto watched = [&] {
    for (int i = 0; i < 4; ++i) conjugateGradients.repeat(1), rho.read();
  };
  run.ratio("4 iterations whose residuals are read / 4 in a loop on the device", watched,
            [&] { conjugateGradients.repeat(4); });

  // In double: the scheme's next step from the device's two last ones, by Jacobi's iteration, and the energy.
  const auto product = [&](const Reals& y) -> Reals {
    return (1 + 4 * alpha) * y - alpha * (y.cshift(1) + y.cshift(-1) + y.cshift(w) + y.cshift(-w));
  };
  const auto energy = [&](auto& v, auto& y) { return dot(v, v) / 2 + dot(y, product(y) - y); };
  const Reals v0 = u[1] - u[0], v1 = u[2] - u[1], dv = v1 - v0, right = 2.0 * u[1] + v0 - product(u[1]);
  Reals exact = right, left = right - product(u[2]);
  for (Reals e = right - product(exact); norm(e) > 1e-10 * norm(right); e = right - product(exact))
    exact += e / (1 + 4 * alpha);
  const double before = energy(v0, u[1]), lost = before - energy(v1, u[2]) - dot(dv, dv) / 2;
  const double rounding = 0x1p-24 * (1 + 8 * alpha), near = tolerance + 8 * rounding;
  double wrong = 0;
  for (const clMatrix* matrix : {&a, &unshared}) {
    for (const bool four : {true, false}) {
      matrix->multiply(now, q, four);
      wrong = classics::larger(wrong, norm(realsOf(q.readReals()) - product(u[2])) / norm(u[2]));
    }
  }
  run.check("products, shared or not, by four or one", wrong, 7 * rounding, "7 roundings of |A| |x|");
  run.check("a step's residual", norm(left) / norm(right), near, "the tolerance, and 8 roundings of |A| |x|");
  run.check("a step", norm(u[2] - exact) / norm(right), near, "the same, as no eigenvalue of A is below 1");
  run.check("energy", std::abs(lost) / before, near * norm(right) * norm(v1) / before, "the residual's work");

  auto colours = device.stream<sk::float3>({450, 800});
  shade({.height = now, .scale = static_cast<float>(w), .sun = {-0.30f, 0.87f, 0.39f}}, colours);
  run.picture("banded.png", examples::imageOf(800, 450, colours.read()));
}

}  // namespace

int main(int argc, char** argv) { return classics::run(argc, argv, about, water); }
