// SPDX-License-Identifier: MIT
//
// Shared by C++ and kernels: both include it, and neither declares it again.
#pragma once

#include <sk/types.hpp>

#ifndef __SKC__   // what kernels have no use for
#include <string>
#endif

namespace parts {

enum Side { Front, Back };

struct Hit {
  float t;
  Side side;
  sk::float2 at;
};

inline float later(float t) { return t + 1; }

}  // namespace parts
