// SPDX-License-Identifier: MIT
//
// What an iteration on the device has come to: vectors.sk writes it, and solvers read it. Both include this file, which therefore
// has nothing else in it.
#pragma once

namespace sk::linear {

enum State {
  Running,
  ReachedLimit,  ///< the residual that the iteration computes has become small enough
  NotPositive,  ///< a product p . A p or r . M r is 0 or below
  NotFinite,  ///< a sum is infinite or NaN
  Breakdown,  ///< the method divides by a product that has become 0
};

}  // namespace sk::linear
