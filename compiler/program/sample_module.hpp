// SPDX-License-Identifier: MIT
//
// For tests: the IR that the frontend would produce for a small .sk file, after all transforms.
#pragma once

#include "ir/ir.hpp"

namespace skc::emit {

/// The module of this file:
///
///   1  struct Hit { float t; int id; };
///   2  const float scale = 0.25;
///   3
///   4  float average(float a[][], int2 p) {
///   5    float s = 0;
///   6    for (int i = -1; i <= 1; ++i) {
///   7      if (i == 0) continue;
///   8      s += a[p.y][p.x + i];
///   9    }
///  10    return s * scale;
///  11  }
///  12
///  13  namespace heat {
///  14  kernel void diffuse(float k, [[wrap]] float u[][], out float v<>) {
///  15    int2 p = indexof(v).xy;
///  16    v = average(u, p) + k * (neighbor(u, 1, 0) - 4 * neighbor(u, 0, 0));
///  17  }
///  18  }
///  19
///  20  reduce void sum(float x<>, reduce float total<> = 0) { total += x; }
///  21
///  22  reduce void nearest(Hit h<>, reduce Hit best<>) { if (h.t < best.t) best = h; }
///  23
///  24  reduce void power(float x<>, reduce float total<>) { total += x * x; }
ir::Module sampleModule();

}  // namespace skc::emit
