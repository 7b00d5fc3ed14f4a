// SPDX-License-Identifier: MIT
//
// Sorts streams by dispatches (assemble/sort/radix_program.hpp): keys become words, which are sorted with the places
// that they come from; then each plane of a stream is brought into this order.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "assemble/sort/radix_program.hpp"
#include "device/device_state.hpp"
#include "gl_device/program/integer_program.hpp"

namespace sk {

class GlDevice;
class GlPrograms;

/// The programs of sorts, which are compiled on first use and kept as long as the device.
class SortPrograms {
 public:
  explicit SortPrograms(GlPrograms& owner) : owner_(owner) {}
  /// Throws sk::Error if the driver rejects it.
  IntegerProgram& of(assemble::RadixStep step, assemble::RadixStorage storage = {});

 private:
  GlPrograms& owner_;
  std::array<std::unique_ptr<IntegerProgram>, 4 * assemble::radixSteps> programs_;  ///< for each RadixStorage
};

/// Whether streams can be sorted by dispatches: the keys are stored as they are declared, or as halves, and temporaries
/// for all of them fit into textures without layers.
bool maySortByDispatches(const GlDevice& device, const Reordering& reordering);

/// Carries it out. Returns the number of elements that come first, if it chooses them. Throws sk::Error if memory is
/// exhausted or the driver rejects a program; nothing has moved then. A DeviceScope must be open, and compute programs
/// selected.
std::int64_t sortByDispatches(GlDevice& device, const Reordering& reordering);

}  // namespace sk
