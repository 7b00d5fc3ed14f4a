// SPDX-License-Identifier: MIT
//
// mandelbrot.sk against the same steps in double. A float cannot always tell in which step a point leaves the circle. The
// reference therefore follows how far the device's z may be off: by e before a step, and after it, with the unit
// roundoff u, by no more than
//
//   2 |z| e + e^2 + 5 u (|z| + e)^2 + 4 u (|c| + |corner|)
//
// The first two are what z^2 makes of e. The parts of z^2 have two and one roundings, together less than 3 u |z|^2; the sum with c
// has one, of |z|^2 + |c|; c itself has two. The step in which a point leaves is right if the squared distance, by its error,
// may have passed 4 there and need not have before.
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
  const double ofDistance = 1 + roundings(2);  // what its own roundings make of a squared distance
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
    if (error > 1e3) return {first, most};  // nothing is known any more
  }
  return {first, most};
}

/// The share of pixels whose step is known for certain; all must be right.
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
  onEveryLayout([](sk::Device& device) {
    for (const auto& [height, width] :
         {std::pair{0, 0}, {0, 5}, {1, 1}, {1, 67}, {61, 1}, {53, 71}, {64, 64}}) {
      const Window window{{-2.25f, -1.25f},
                          {3.0f / static_cast<float>(width + 1), 2.5f / static_cast<float>(height + 1)}};
      CHECK(check(device, window, height, width, 40) >= 0.9);
    }
  });
}

// -1 has the period 2 and 0 the period 1: neither is rounded, and neither gets away.
TEST_CASE("mandelbrot: long loops end when they should") {
  onEveryProfile([](sk::Device& device) {
    auto image = device.stream<int>({1, 2});
    mandelbrot::escape(Window{{-1.5f, -0.5f}, {1, 1}}, 65000, image);
    CHECK(image.read() == std::vector<int>{65000, 65000});
  });
}
