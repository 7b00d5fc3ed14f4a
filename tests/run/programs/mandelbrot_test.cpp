// SPDX-License-Identifier: MIT
//
// mandelbrot.sk against the same steps in double. In floats, the step in which a point leaves the circle is not always certain.
// The reference therefore bounds the error of the device's z: if it is e before a step, then after the step, with the unit
// roundoff u, it is at most
//
//   2 |z| e + e^2 + 5 u (|z| + e)^2 + 4 u (|c| + |corner|)
//
// The first two terms are the error e after squaring. The parts of z^2 have two and one roundings, together less than 3 u |z|^2;
// the sum with c has one, of |z|^2 + |c|; c itself has two. A device's step is right if the squared distance, within its error,
// may exceed 4 in that step and need not exceed it before.
#include "programs/mandelbrot.sk.hpp"

#include <algorithm>
#include <complex>

#include "programs/bounds.hpp"
#include "support/devices.hpp"

using namespace run_tests;
using mandelbrot::Window;

namespace {

/// The steps that a device may take: any in [first, last].
struct Steps {
  int first, last;
};

Steps expected(const Window& w, std::int64_t width, std::size_t pixel, int most) {
  const auto x = static_cast<double>(pixel % static_cast<std::size_t>(width));
  const auto y = static_cast<double>(pixel / static_cast<std::size_t>(width));
  const std::complex<double> c(w.corner.x + w.perPixel.x * (x + 0.5), w.corner.y + w.perPixel.y * (y + 0.5));
  const double ofC = 4 * unitRoundoff * (std::abs(c) + std::hypot(w.corner.x, w.corner.y));
  const double ofDistance = 1 + roundings(2);  // the roundings of the squared distance itself
  const auto squared = [](double v) { return v * v; };
  std::complex<double> z = 0;
  double error = 0;
  int first = most;
  for (int step = 0; step < most; ++step) {
    const double size = std::abs(z);
    const double farthest = size + error, nearest = std::max(size - error, 0.0);
    if (squared(farthest) * ofDistance > 4) first = std::min(first, step);
    if (squared(nearest) > 4 * ofDistance) return {first, step};
    error = 2 * size * error + squared(error) + 5 * unitRoundoff * squared(farthest) + ofC;
    z = z * z + c;
    if (error > 1e3) return {first, most};  // the error is too large to tell
  }
  return {first, most};
}

/// Checks all pixels. Returns the share of pixels with only one possible step.
double check(sk::Device& device, const Window& window, std::int64_t height, std::int64_t width, int most) {
  auto image = device.stream<int>({height, width});
  mandelbrot::escape(window, most, image);
  const auto steps = image.read();
  std::size_t certain = 0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const Steps wanted = expected(window, width, i, most);
    INFO("pixel " << i << " of " << height << " x " << width);
    CHECK((wanted.first <= steps[i] && steps[i] <= wanted.last));
    certain += wanted.first == wanted.last;
  }
  return steps.empty() ? 1 : static_cast<double>(certain) / static_cast<double>(steps.size());
}

}  // namespace

TEST_CASE("mandelbrot: pictures of every size") {
  onDrawnLayouts([](sk::Device& device) {
    for (const auto& [height, width] :
         {std::pair{0, 0}, {0, 5}, {1, 1}, {1, 67}, {61, 1}, {53, 71}, {64, 64}}) {
      const Window window{{-2.25f, -1.25f},
                          {3.0f / static_cast<float>(width + 1), 2.5f / static_cast<float>(height + 1)}};
      CHECK(check(device, window, height, width, 40) >= 0.9);
    }
  });
}

// The orbit of -1 has period 2 and that of 0 period 1: neither is rounded, and neither leaves the circle.
TEST_CASE("mandelbrot: long loops end when they should") {
  onGlAndNative([](sk::Device& device) {
    auto image = device.stream<int>({1, 2});
    mandelbrot::escape(Window{{-1.5f, -0.5f}, {1, 1}}, 65000, image);
    CHECK(image.read() == std::vector<int>{65000, 65000});
  });
}
