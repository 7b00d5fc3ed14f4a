// SPDX-License-Identifier: MIT
//
// What the libraries of this test export. Each one's source includes this after the header of its own kernels.
#pragma once

#include <array>
#include <vector>

#include <sk/sk.hpp>

/// What the kernels make of 1: by scale, total, spread and curve. `recorded` gets a loop that runs scale, if it is not
/// null.
extern "C" [[gnu::visibility("default")]] void apply(sk::Device& device, std::array<float, 4>& results,
                                                     sk::Loop* recorded) {
  auto x = device.stream<float>({1}), r = device.stream<float>({1});
  auto place = device.stream<int>({1});
  x.fill(1);
  place.fill(0);
  scale(x, r);
  results[0] = r.read()[0];
  results[1] = total(x);
  r.fill(0);
  spread(place, r);
  results[2] = r.read()[0];
  curve.with({.tables = sk::Tables::On})(x, r);
  results[3] = r.read()[0];
  if (recorded != nullptr) *recorded = device.record([&] { scale(x, r); });
}
