// SPDX-License-Identifier: MIT
//
// One Fourier transform of n complex numbers. floats: their parts, real and imaginary in turn, as in the result.
#include <cmath>
#include <numbers>

#include "fft.sk.hpp"
#include "our_task.hpp"
#include "programs/all.hpp"

namespace race {
namespace {

std::vector<sk::float2> rootsOfUnity(std::int64_t n) {
  std::vector<sk::float2> roots;
  for (std::int64_t k = 0; k < n; ++k) {
    const double angle = -2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(n);
    roots.push_back({static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))});
  }
  return roots;
}

class Transform final : public OurTask {
 public:
  Transform(sk::Device& device, const sk::CallOptions& options, const Problem& p)
      : OurTask(device),
        join_(fft::join.with(options)),
        size_(static_cast<int>(p.size())),
        roots_(filled<sk::float2>({p.size()}, rootsOfUnity(p.size()))),
        x_(filled<sk::float2>({1, p.size()}, pairsOf(p.floats[0]))),
        y_(device.stream<sk::float2>({1, p.size()})) {}

  std::vector<float> result() override { return flat(y_.read()); }

 private:
  void once() override {
    join_(2, roots_, x_, y_);
    for (int size = 4; size <= size_; size *= 2) join_(size, roots_, y_, y_);
  }

  fft::JoinKernel join_;
  int size_;
  sk::Stream<sk::float2> roots_, x_, y_;
};

}  // namespace

Problem fourierProblem(int log2) {
  Problem p = grid(log2);
  p.floats = {numbers(2 * p.size(), 1, -1, 1)};
  return p;
}

// Some frequencies, by the definition.
Check fourierCheck(const Problem& p) {
  Check check{{}, {}, 1e-5};
  const auto n = static_cast<std::size_t>(p.size());
  std::vector<double> cosines(n);
  for (std::size_t k = 0; k < n; ++k) {
    cosines[k] = std::cos(2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(n));
  }
  for (const std::int64_t place : somePlaces(p.size(), 16)) {
    const auto frequency = static_cast<std::size_t>(place);
    double real = 0, imaginary = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t turn = frequency * i % n;
      const double c = cosines[turn], s = -cosines[(turn + 3 * n / 4) % n];
      real += p.floats[0][2 * i] * c - p.floats[0][2 * i + 1] * s;
      imaginary += p.floats[0][2 * i] * s + p.floats[0][2 * i + 1] * c;
    }
    check.places.insert(check.places.end(), {2 * place, 2 * place + 1});
    check.values.insert(check.values.end(), {real, imaginary});
  }
  return check;
}

std::unique_ptr<Task> fourierOurs(sk::Device& device, const sk::CallOptions& options, const Problem& p) {
  return std::make_unique<Transform>(device, options, p);
}

}  // namespace race
