// SPDX-License-Identifier: MIT
//
// The machine that code is generated for: LLVM's description of it, and the levels of its CPU. A level is a
// set of instructions. One object file has functions for all levels, and the runtime chooses when the program
// starts.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <llvm/IR/Function.h>
#include <llvm/Target/TargetMachine.h>

#include "native/native.hpp"
#include "sk/native/code.hpp"

namespace skc::native {

struct CpuLevel {
  /// The name in --levels, and LLVM's name of the CPU; empty if the target has no levels.
  std::string_view name;
  sk::native::Level level;
  std::uint32_t vectorBits;
  std::uint32_t vectorRegisters;
  bool hasMaskRegisters;
  bool hasFusedMultiplyAdd;
  bool convertsHalves;  ///< converts whole vectors between float and half
};

class Target {
 public:
  /// Throws Error for a triple that LLVM does not know or levels that the CPU does not have.
  explicit Target(const Options& options);

  llvm::TargetMachine& machine() const { return *machine_; }
  const std::string& triple() const { return triple_; }
  /// The levels to compile for, lowest first.
  const std::vector<CpuLevel>& levels() const { return levels_; }

 private:
  std::string triple_;
  std::unique_ptr<llvm::TargetMachine> machine_;
  std::vector<CpuLevel> levels_;
};

/// Compiles the function for CPUs of this level.
void setLevel(llvm::Function& function, const CpuLevel& level);

}  // namespace skc::native
