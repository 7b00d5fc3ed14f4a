// SPDX-License-Identifier: MIT
//
// Runs kernels that skc compiled to object code over their domains.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "native/call.hpp"
#include "native/entries.hpp"
#include "sk/program.hpp"

namespace sk {

/// `kernel.code` must not be null. Throws sk::Error if it has no code that runs on this CPU.
void runCode(const program::Kernel& kernel, const native::Call& call, const CodeChoice& choice);

/// A call that runs again and again, with streams whose arrays alternate between a few states, as swaps leave them. It
/// keeps what runCode() finds out for each state.
class RepeatedCode {
 public:
  /// The kernel must outlive it. `hasNewValues`: the values of uniforms may change from call to call.
  RepeatedCode(const program::Kernel& kernel, const CodeChoice& choice, bool hasNewValues);
  ~RepeatedCode();
  RepeatedCode(const RepeatedCode&) = delete;
  RepeatedCode& operator=(const RepeatedCode&) = delete;

  /// Like runCode(). Nothing else may change from call to call but the arrays of the operands.
  void run(const native::Call& call);

 private:
  struct State;

  /// The state with the arrays of the call.
  State& stateOf(const native::Call& call);

  const program::Kernel& kernel_;
  CodeChoice choice_;
  bool hasNewValues_;
  std::vector<std::unique_ptr<State>> states_;
  std::size_t last_ = 0;
};

/// A kernel's call of which threads compute boxes, each in its own order (native/time_tiles.hpp). It has neither variable nor
/// scatter outputs.
class BoxCode {
 public:
  /// Copies the operands, which name arrays that must outlive it. Dimensions of the call must not have been coalesced.
  BoxCode(const program::Kernel& kernel, const native::Call& call, const CodeChoice& choice);
  ~BoxCode();
  BoxCode(const BoxCode&) = delete;
  BoxCode& operator=(const BoxCode&) = delete;

  /// True if the operands of the call have the same arrays as here.
  bool hasArraysOf(const native::Call& call) const;
  /// True if gathers have border values, which were read when this was made.
  bool hasBorders() const;
  /// Computes the elements of a box of the domain. May be called by several threads at once.
  void run(const native::Part& box) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace sk
