// SPDX-License-Identifier: MIT
//
// Calls kernels of two libraries and of its own, which share a header, structs and helpers.
#include "hit.h"

#include <cstdio>
#include <exception>
#include <vector>

#include "parts/base.sk.hpp"
#include "parts/far.sk.hpp"
#include "parts/near/near.sk.hpp"

float nearest(const parts::Hit& hit);
float farthest(const parts::Hit& hit);

int main() try {
  sk::Device device;
  auto rays = device.stream<parts::Ray>({1});
  auto hits = device.stream<parts::Hit>({1});
  auto nearer = device.stream<near::Choice>({1});
  auto farther = device.stream<far::Choice>({1});
  rays.write(std::vector<parts::Ray>{{{1, 2}, {3, 4}}});
  parts::advance(2, rays, rays);
  const Limits limits{5, 7};
  near::pick(limits, rays, hits, nearer);
  const parts::Hit first = hits.read().front();
  far::pick(limits, rays, hits, farther);
  const parts::Hit second = hits.read().front();
  std::printf("%g %g %g %d %g %g %d", first.at.x, first.at.y, nearer.read().front().t,
              farther.read().front().t, nearest(first), farthest(second), second.side == parts::Front);
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
