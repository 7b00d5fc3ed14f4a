// SPDX-License-Identifier: MIT
//
// Lines and variables of the .sk file for debuggers and profilers (DWARF). Functions of the IR are written into one LLVM
// function; here they are inlined functions of it, as after any compiler's inliner. A variable that varies from lane to
// lane is a vector with one entry for each lane; of consecutive numbers, the first lane's is shown. What the library has added
// is not shown.
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

  /// The LLVM function is the code of this function of the IR.
  void begin(llvm::IRBuilder<>& b, llvm::Function& code, const ir::Function& function);
  void end(llvm::IRBuilder<>& b);

  /// A call of `function` is written from here on, or has been.
  void enter(llvm::IRBuilder<>& b, const ir::Function& function);
  void leave(llvm::IRBuilder<>& b);

  /// What follows belongs to this source location.
  void moveTo(llvm::IRBuilder<>& b, const Loc& loc);
  /// A variable of the current function, whose leaves are in `memory`. Parameters count from 1; 0 is no parameter.
  void declare(llvm::IRBuilder<>& b, const ir::Variable& variable, unsigned parameter,
               const std::vector<LeafMemory>& memory);

  void finish() { builder_.finalize(); }

 private:
  using Leaves = std::vector<LeafMemory>::const_iterator;
  struct Scope {
    llvm::DISubprogram* program;
    llvm::DILocation* calledAt;  ///< null in the LLVM function's own code
    llvm::DebugLoc before;  ///< where the caller was
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
  std::map<const ir::Function*, llvm::DISubprogram*> programs_;  ///< of the current LLVM function
  std::vector<Scope> scopes_;
};

/// Enters a function where there is debug information to write.
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
