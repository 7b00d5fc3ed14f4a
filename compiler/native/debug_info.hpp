// SPDX-License-Identifier: MIT
//
// Describes the lines and variables of the .sk file for debuggers and profilers (DWARF). All functions of the
// IR are emitted into one LLVM function; they are described as inlined functions. A varying variable is a
// vector with one entry per lane; for a consecutive one, debuggers show the first lane's value. Code of the
// library is not described.
#pragma once

#include <map>
#include <string>
#include <vector>

#include <llvm/IR/DIBuilder.h>
#include <llvm/IR/IRBuilder.h>

#include "ir/ir.hpp"
#include "native/function_code.hpp"

namespace skc::native {

class DebugInfo {
 public:
  DebugInfo(llvm::Module& code, const ir::Module& module, bool isOptimized);

  /// Starts describing `code`, the LLVM function of `function`.
  void begin(llvm::IRBuilder<>& b, llvm::Function& code, const ir::Function& function);
  void end(llvm::IRBuilder<>& b);

  /// Marks the start and the end of the code that is emitted for a call of `function`.
  void enter(llvm::IRBuilder<>& b, const ir::Function& function);
  void leave(llvm::IRBuilder<>& b);

  /// Sets the source location of the code that follows.
  void moveTo(llvm::IRBuilder<>& b, const Loc& loc);
  /// Describes a variable of the current function whose leaves are in `memory`. `parameter` counts from 1; it
  /// is 0 for other variables.
  void declare(llvm::IRBuilder<>& b, const ir::Variable& variable, unsigned parameter,
               const std::vector<LeafMemory>& memory);

  void finish() { builder_.finalize(); }

 private:
  using Leaves = std::vector<LeafMemory>::const_iterator;
  struct Scope {
    llvm::DISubprogram* program;
    llvm::DILocation* calledAt;  ///< null in the LLVM function's own code
    llvm::DebugLoc before;  ///< location in the caller
  };
  struct Member {
    std::string name;
    llvm::DIType* type;
  };

  llvm::DIFile* file(std::uint32_t number);
  llvm::DISubprogram* makeProgram(const ir::Function& function);
  llvm::DIType* scalarType(ir::Scalar scalar, std::uint64_t bits);
  llvm::DIType* leafType(const LeafMemory& leaf);
  llvm::DIType* recordType(const std::string& name, const std::vector<Member>& members);
  /// The type of a value whose leaves begin at `next`. Advances `next` past them.
  llvm::DIType* typeOf(ir::Type type, Leaves& next);

  const ir::Module& module_;
  bool isOptimized_;
  llvm::DIBuilder builder_;
  std::vector<llvm::DIFile*> files_;
  llvm::DICompileUnit* unit_;
  const ir::Function* begun_ = nullptr;
  std::map<const ir::Function*, llvm::DISubprogram*> programs_;  ///< inlined into the current LLVM function
  std::vector<Scope> scopes_;
};

/// Enters a function and leaves it, if there is debug information to write.
class DebugScope {
 public:
  DebugScope(DebugInfo* debug, llvm::IRBuilder<>& b, const ir::Function& function) : debug_(debug), b_(b) {
    if (debug_ != nullptr) debug_->enter(b_, function);
  }
  ~DebugScope() {
    if (debug_ != nullptr) debug_->leave(b_);
  }
  DebugScope(const DebugScope&) = delete;
  DebugScope& operator=(const DebugScope&) = delete;

 private:
  DebugInfo* debug_;
  llvm::IRBuilder<>& b_;
};

}  // namespace skc::native
