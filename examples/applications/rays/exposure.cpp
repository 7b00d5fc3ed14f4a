// SPDX-License-Identifier: MIT
#include "exposure.hpp"

#include <stdexcept>

#include "exposure.sk.hpp"

namespace rays {

namespace {

examples::Space spaceOf(sk::Device& device, const Picture& picture) {
  if (picture.grid != nullptr) return examples::Space(*picture.grid);
  return {device, {picture.height, picture.width}};
}

}  // namespace

Exposure::Exposure(sk::Device& device, const Picture& picture)
    : space_(spaceOf(device, picture)),
      radiance(space_.stream<sk::float3>()),
      sum_(space_.stream<sk::double3>()),
      squares_(space_.stream<sk::double3>()),
      mean_(space_.stream<sk::float3>()),
      passCount_(space_.device().stream<int>({1, 1})) {
  clear();
}

void Exposure::clear() {
  passes_ = 0;
  sum_.fill({0, 0, 0});
  squares_.fill({0, 0, 0});
  counts_ = {};
  active_ = {};
  pixels_ = {};
  list_ = {};
}

void Exposure::deliver() { kernels::deliverSamples(pixels_, list_, radiance); }

void Exposure::add() {
  if (isSparse()) {
    kernels::accumulateActive(radiance, active_, sum_, squares_, counts_, sum_, squares_, counts_);
  } else {
    kernels::accumulate(radiance, sum_, squares_, sum_, squares_);
  }
  ++passes_;
}

std::int64_t Exposure::narrow(const Tolerance& tolerance) {
  if (space_.shape().size() == 0) return 0;
  auto uncertain = space_.device().stream<int>(space_.shape());
  kernels::isUncertain(sum_, squares_, countStream(), static_cast<float>(tolerance.error),
                       static_cast<float>(tolerance.least), uncertain);
  if (!isSparse()) {
    counts_ = space_.device().stream<int>(space_.shape());
    active_ = space_.device().stream<int>(space_.shape());
    counts_.fill(static_cast<int>(passes_));
    active_.fill(1);
  }
  kernels::staysActive(active_, uncertain, active_);
  listPixels();
  return pixels_.size();
}

void Exposure::listPixels() {
  pixels_ = space_.device().stream<sk::int2>({0});
  kernels::listActive(active_, pixels_);
  list_ = space_.device().stream<sk::float3>(pixels_.shape());
}

const sk::Stream<int>& Exposure::countStream() {
  if (isSparse()) return counts_;
  passCount_.fill(static_cast<int>(passes_));
  return passCount_;
}

std::vector<sk::float3> Exposure::image() {
  kernels::meanOf(sum_, countStream(), mean_);
  return mean_.read();
}

std::vector<sk::float3> Exposure::variance() {
  if (passes_ < 2) return {};
  kernels::varianceOf(sum_, squares_, countStream(), mean_);
  return mean_.read();
}

std::vector<int> Exposure::counts() {
  if (isSparse()) return counts_.read();
  return std::vector<int>(static_cast<std::size_t>(space_.shape().size()), static_cast<int>(passes_));
}

Gathered Exposure::gathered() {
  Gathered g{passes_, sum_.read(), squares_.read(), {}, {}};
  if (isSparse()) {
    g.counts = counts_.read();
    g.active = active_.read();
  }
  return g;
}

void Exposure::restore(const Gathered& gathered) {
  const auto size = static_cast<std::size_t>(space_.shape().size());
  const bool isSparse = !gathered.active.empty();
  if (gathered.sums.size() != size || gathered.squares.size() != size ||
      (isSparse && (gathered.active.size() != size || gathered.counts.size() != size)))
    throw std::logic_error("what was gathered is of another size");
  clear();
  passes_ = gathered.passes;
  sum_.write(gathered.sums);
  squares_.write(gathered.squares);
  if (!isSparse) return;
  counts_ = space_.device().stream<int>(space_.shape());
  active_ = space_.device().stream<int>(space_.shape());
  counts_.write(gathered.counts);
  active_.write(gathered.active);
  listPixels();
}

}  // namespace rays
