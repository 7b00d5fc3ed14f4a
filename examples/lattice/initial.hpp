// SPDX-License-Identifier: MIT
//
// First states: computed on the host, the same on every device.
#pragma once

#include "lattice.hpp"
#include "scene.hpp"

namespace examples {

/// Writes what the scene begins with. Random numbers are of its seed alone.
void writeInitial(const Model& model, const Initial& initial, Lattice& lattice);

}  // namespace examples
