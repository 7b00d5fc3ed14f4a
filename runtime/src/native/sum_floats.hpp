// SPDX-License-Identifier: MIT
//
// Sums and scans of floats, or of products of two, in doubles; most sums of floats are computed this way
// (program::SumTerm). The runtime adds them itself, in the same order as other reductions and on every CPU alike. Also the
// factors of a term as a kernel that has only slots and no code, so that the runtime's own sums, exact ones included, read
// floats the way object code does.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "native/call.hpp"
#include "native/entries.hpp"
#include "sk/native/code.hpp"
#include "sk/program.hpp"

namespace sk {

/// The frame of the runtime's own sums and scans.
struct SumFrame : native::Frame {
  double start;  ///< the identity; -0, which changes no term, if seeded
  double identity;
};

/// The function that scans terms of one or two factors, which are the slots, in a SumFrame: eight elements at a time, so that
/// one addition in eight waits for the one before it. `storesFloats`: the arrays of results hold floats, else doubles. The CPU
/// must have 256-bit vectors if `isWide` (levelOfCpu).
native::ScanFunction* floatScan(std::size_t factors, bool storesFloats, bool isWide);

/// Writes the identity of a SumFrame.
void storeIdentity(const native::Frame* frame, void* const* values);

class FactorKernel {
 public:
  /// `call` is a call of `fold`; `factors` are the numbers of the parameters that are factors.
  FactorKernel(const program::Kernel& fold, std::span<const std::uint8_t> factors, const native::Call& call);
  FactorKernel(const FactorKernel&) = delete;
  FactorKernel& operator=(const FactorKernel&) = delete;

  const program::Kernel& kernel() const { return kernel_; }
  const native::Call& call() const { return call_; }

 private:
  std::vector<native::Operand> operands_;
  std::vector<program::Parameter> parameters_;
  std::vector<native::Slot> slots_;
  native::Code code_{};
  program::Kernel kernel_;
  native::Call call_;
};

/// True if a call in doubles only sums the contents of float streams.
bool sumsFloats(const program::Reduction& reduction, const native::Call& fold, const CodeChoice& choice);

/// Sums each block of the domain to one element of the accumulator's operand, or scans it. No block is empty.
void sumFloats(const program::Reduction& reduction, const native::ReduceCall& call, const CodeChoice& choice);

}  // namespace sk
