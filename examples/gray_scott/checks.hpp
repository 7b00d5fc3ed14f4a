// SPDX-License-Identifier: MIT
//
// What can honestly be asked of a device that steps through a chaotic field: to stay with double-precision
// loops for a while, to keep the balance of matter in every step however long it has run, and to add up right.
#pragma once

#include <span>

#include <sk/types.hpp>

#include "model.hpp"
#include "support/verification.hpp"

namespace examples {

/// Means over a field.
struct Means {
  double u;
  double v;
};
Means meansOf(std::span<const sk::float2> state);

/// The device's state after `steps` from `first` against double loops. Small differences grow as the
/// pattern does, so that no fixed bound holds for long: it may differ by 8 times what the same loops in
/// float on the CPU do, whose roundings are as many and as large but fall otherwise.
Verification checkSteps(int size, int steps, const Parameters& p, std::span<const sk::float2> first,
                        std::span<const sk::float2> device);

/// Diffusion moves matter and the reaction turns U into V, so that in one step the mean of u + v changes
/// by exactly dt (F (1 - mean u) - (F + k) mean v): true of every step, chaotic or not.
Verification checkBalance(const Parameters& p, std::span<const sk::float2> before,
                          std::span<const sk::float2> after);

/// Means that the device reduced against a double loop over the state that was read back.
Verification checkMeans(std::span<const sk::float2> state, sk::float2 deviceSum);

}  // namespace examples
