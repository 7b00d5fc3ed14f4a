// SPDX-License-Identifier: MIT
//
// Whether a device has the memory that a solve needs, before anything is copied to it.
#pragma once

#include <cstdint>
#include <string_view>

#include <sk/sk.hpp>

#include "method.hpp"
#include "operator.hpp"
#include "preconditioner.hpp"

namespace sk::linear {

/// What is to be solved with.
struct MemoryChoices {
  const MethodKind& method;
  const PreconditionerKind& preconditioner;
  std::string_view layout;
  const Arithmetic& arithmetic;
  int restart = 30;  ///< of gmres
  int devices = 1;  ///< that share all of it alike
};

/// Bytes on each device.
struct MemoryNeed {
  std::int64_t matrix = 0;  ///< for "auto", of the smallest layout that suits it
  std::int64_t method = 0;
  std::int64_t preconditioner = 0;  ///< an estimate where that depends on more than sizes
  std::int64_t residual =
      0;  ///< in double precision, and a copy of the matrix if its entries are rounded; 0 if the host computes it

  std::int64_t total() const { return matrix + method + preconditioner + residual; }
};

/// `hasDoubles` says whether the device computes residuals (residual.hpp). Throws sk::Error for an unknown layout.
MemoryNeed memoryNeed(const Operator& a, const MemoryChoices& choices, bool hasDoubles);

/// Throws sk::Error, with what is needed and what there is, if the device is known to have less memory available. Does nothing if it does not tell. `what`
/// names the matrix.
void checkMemory(sk::Device& device, const Operator& a, std::string_view what, const MemoryChoices& choices);

}  // namespace sk::linear
