// SPDX-License-Identifier: MIT
//
// What can honestly be asked of a cloth on a device: to stay with plain loops in higher precision for a while, though it may
// crumple as it likes later, and to add up right what it reduces.
#pragma once

#include <cstdint>
#include <span>

#include <sk/options.hpp>

#include "scene.hpp"
#include "simulation.hpp"
#include "support/verification.hpp"

namespace examples {

/// Positions (x, y, z, w of each point) after `steps` from the first state against the same steps as loops on the host.
/// Crumpling is chaotic, so that no fixed bound holds for long: the device may differ by 8 times what loops in its own precision
/// do, whose roundings are as many and as large but fall otherwise. Single is set against double, double against long double;
/// Extended may have the 2^8 times larger roundings of pairs of floats.
Verification checkSteps(const Scene& scene, std::int64_t steps, std::span<const double> device,
                        sk::Precision precision);

/// Strain and centre that the device reduced against a double loop over the positions and links that were read back.
Verification checkObservation(const Scene& scene, const Observation& device, const State& state);

}  // namespace examples
