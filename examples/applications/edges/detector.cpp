// SPDX-License-Identifier: MIT
#include "detector.hpp"

#include <cmath>

#include "edges.sk.hpp"

namespace examples {

std::vector<float> gaussianWeights(double sigma) {
  const int radius = static_cast<int>(std::ceil(3.0 * sigma));
  std::vector<double> bell;
  double sum = 0.0;
  for (int i = 0; i <= radius; ++i) {
    bell.push_back(sigma > 0.0 ? std::exp(-0.5 * (i / sigma) * (i / sigma)) : 1.0);
    sum += i == 0 ? bell.back() : 2.0 * bell.back();
  }
  std::vector<float> weights;
  for (double height : bell) weights.push_back(static_cast<float>(height / sum));
  return weights;
}

Detector::Detector(sk::Device& device, const Picture& picture, std::span<const float> linear,
                   std::span<const float> weights, std::optional<Thresholds> thresholds)
    : thresholds_(thresholds),
      radius_(static_cast<std::int32_t>(weights.size()) - 1),
      pixels_(device.stream<sk::int3>({picture.height, picture.width})),
      linear_(device.stream<float>({linear.size()})),
      weights_(device.stream<float>({weights.size()})),
      grey_(device.stream<float>(pixels_.shape())),
      halfBlurred_(device.stream<float>(pixels_.shape())),
      blurred_(device.stream<float>(pixels_.shape())),
      slope_(device.stream<sk::float2>(pixels_.shape())),
      steepness_(device.stream<float>(pixels_.shape())),
      ridge_(device.stream<float>(pixels_.shape())),
      mark_(device.stream<std::int32_t>(pixels_.shape())),
      edge_(device.stream<float>(pixels_.shape())) {
  pixels_.write(picture.pixels);
  linear_.write(linear);
  weights_.write(weights);
}

void Detector::detect() {
  edges::luminance(pixels_, linear_, grey_);
  edges::blur(false, radius_, weights_, grey_, halfBlurred_);
  edges::blur(true, radius_, weights_, halfBlurred_, blurred_);
  edges::sobel(blurred_, slope_, steepness_);
  edges::thin(slope_, steepness_, ridge_);
  if (thresholds_) linkEdges();
}

void Detector::linkEdges() {
  constexpr int stepsBetweenQuestions = 16;
  edges::classify(ridge_, thresholds_->low, thresholds_->high, mark_);
  if (classified_.empty()) classified_ = mark_.read();
  // A mark only ever rises, so that an unchanged sum means that nothing changed.
  for (std::int32_t before = -1, after = edges::sum(mark_); after != before;) {
    for (int i = 0; i < stepsBetweenQuestions; ++i) edges::link(mark_, mark_);
    before = after;
    after = edges::sum(mark_);
  }
  edges::keep(ridge_, mark_, edge_);
}

float Detector::inkPerSlope() const {
  if (thresholds_) return 1.0f / thresholds_->high;
  const float steepest = edges::largest(ridge_);
  return steepest > 0.0f ? 3.0f / steepest : 0.0f;
}

std::vector<sk::float3> Detector::paint(sk::Device& device, sk::float3 paper,
                                        std::span<const sk::float3> wheel) {
  auto inks = device.stream<sk::float3>({wheel.size()});
  auto colour = device.stream<sk::float3>(pixels_.shape());
  inks.write(wheel);
  const sk::Stream<float>& edge = thresholds_ ? edge_ : ridge_;
  edges::paint(slope_, edge, inkPerSlope(), paper, inks, colour);
  return colour.read();
}

}  // namespace examples
