// SPDX-License-Identifier: MIT
#include "simulation.hpp"

#include "gray_scott.sk.hpp"
#include "support/image.hpp"
#include "support/stopwatch.hpp"

namespace examples {

Simulation::Simulation(sk::Device& device, int size, const Parameters& p, std::span<const sk::float2> first)
    : device_(device),
      parameters_(p),
      field_(device.stream<sk::float2>({size, size})),
      palette_(device.stream<sk::float3>({1})) {
  field_.write(first);
}

void Simulation::paintWith(std::span<const sk::float3> palette, float relief) {
  palette_ = device_.stream<sk::float3>({palette.size()});
  palette_.write(palette);
  relief_ = relief;
}

void Simulation::advance(int steps) {
  const Parameters& p = parameters_;
  const gray_scott::Medium medium{p.feed, p.kill, p.spreadU, p.spreadV, p.dt};
  milliseconds_ += millisecondsOf(device_, [&] {
    for (int i = 0; i < steps; ++i) gray_scott::advance(medium, field_, field_);
  });
}

FieldBounds Simulation::bounds() {
  auto each = device_.stream<gray_scott::Bounds>(field_.shape());
  gray_scott::boundsOf(field_, each);
  const gray_scott::Bounds all = gray_scott::widen(each);
  return {all.low, all.high};
}

sk::float2 Simulation::sum() const { return gray_scott::sum(field_); }

void Simulation::savePicture(const std::filesystem::path& file) {
  const FieldBounds b = bounds();
  auto colour = device_.stream<sk::float3>(field_.shape());
  gray_scott::shade(field_, palette_, b.low.y, b.high.y, relief_, colour);
  savePng(file, static_cast<int>(colour.shape()[1]), static_cast<int>(colour.shape()[0]), colour.read());
}

}  // namespace examples
