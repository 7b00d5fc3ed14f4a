// SPDX-License-Identifier: MIT
//
// The machine that code is generated for: LLVM's description of it, and the levels of its CPU. A level is a set of
// instructions; functions for all of them stand in one object file, and the runtime chooses when the program starts.
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
  std::string_view
      name;  ///< as --levels has it; also LLVM's name of the CPU. Empty: the target has no levels
  sk::native::Level level;
  std::uint32_t vectorBits;
  std::uint32_t vectorRegisters;
  bool hasMaskRegisters;
  bool hasFusedMultiplyAdd;
  bool convertsHalves;  ///< between float and half, whole vectors
};

class Target {
 public:
  /// Throws Error for a triple that LLVM does not know or levels that the CPU does not have.
  explicit Target(const Options& options);

  llvm::TargetMachine& machine() const { return *machine_; }
  const std::string& triple() const { return triple_; }
  /// The levels that are asked for, lowest first.
  const std::vector<CpuLevel>& levels() const { return levels_; }

 private:
  std::string triple_;
  std::unique_ptr<llvm::TargetMachine> machine_;
  std::vector<CpuLevel> levels_;
};

/// The function is for CPUs of this level.
void setLevel(llvm::Function& function, const CpuLevel& level);

}  // namespace skc::native
