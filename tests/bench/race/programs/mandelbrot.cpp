// SPDX-License-Identifier: MIT
//
// How many steps each pixel of the Mandelbrot set's picture takes to escape: pure arithmetic, and neighbours that
// part company. No inputs.
#include "programs/mandelbrot.sk.hpp"

#include "constants.hpp"
#include "our_task.hpp"
#include "programs/all.hpp"

namespace race {
namespace {

class Picture final : public OurTask {
 public:
  Picture(sk::Device& device, const sk::CallOptions& options, const Problem& p)
      : OurTask(device),
        escape_(kernels::escape.with(options)),
        perPixel_{mandelbrotExtent / static_cast<float>(p.columns),
                  mandelbrotExtent / static_cast<float>(p.rows)},
        steps_(device.stream<std::int32_t>({p.rows, p.columns})) {}

  std::vector<float> result() override {
    const std::vector<std::int32_t> steps = steps_.read();
    return {steps.begin(), steps.end()};
  }

 private:
  void once() override { escape_({mandelbrotLeft, mandelbrotTop}, perPixel_, mandelbrotSteps, steps_); }

  kernels::EscapeKernel escape_;
  sk::float2 perPixel_;
  sk::Stream<std::int32_t> steps_;
};

int stepsOf(float cx, float cy) {
  float x = 0, y = 0;
  int steps = 0;
  for (; steps < mandelbrotSteps && x * x + y * y <= 4; ++steps) {
    const float next = x * x - y * y + cx;
    y = 2 * x * y + cy;
    x = next;
  }
  return steps;
}

}  // namespace

// Near the set's border, how products and sums are contracted decides.
Check mandelbrotCheck(const Problem& p) {
  Check check{somePlaces(p.size()), {}, 0, 0.05};
  for (const std::int64_t i : check.places) {
    const auto at = [&](float low, std::int64_t place, std::int64_t of) {
      return low + mandelbrotExtent / static_cast<float>(of) * (static_cast<float>(place) + 0.5f);
    };
    check.values.push_back(
        stepsOf(at(mandelbrotLeft, i % p.columns, p.columns), at(mandelbrotTop, i / p.columns, p.rows)));
  }
  return check;
}

std::unique_ptr<Task> mandelbrotOurs(sk::Device& device, const sk::CallOptions& options, const Problem& p) {
  return std::make_unique<Picture>(device, options, p);
}

}  // namespace race
