// SPDX-License-Identifier: MIT
//
// Lines and variables of the .sk file for debuggers and profilers (DWARF). Functions of the IR are written into one LLVM
// function; here they are inlined functions of it, as after any compiler's inliner.
#pragma once

#include <map>
#include <string>
#include <vector>

#include <llvm/IR/DIBuilder.h>
#include <llvm/IR/IRBuilder.h>

#include "ir/ir.hpp"

namespace skc::native {

class DebugInfo {
 public:
  DebugInfo(llvm::Module& code, const ir::Module& module);

  /// The LLVM function is the code of this function of the IR.
  void begin(llvm::IRBuilder<>& b, llvm::Function& code, const ir::Function& function);
  void end(llvm::IRBuilder<>& b);

  /// A call of `function` is written from here on, or has been.
  void enter(llvm::IRBuilder<>& b, const ir::Function& function);
  void leave(llvm::IRBuilder<>& b);

  /// What follows belongs to this source location.
  void moveTo(llvm::IRBuilder<>& b, const Loc& loc);
  /// A variable that `memory` holds: of the element in the first lane where lanes have their own.
  void declare(llvm::IRBuilder<>& b, const ir::Variable& variable, llvm::Value* memory);

  void finish() { builder_.finalize(); }

 private:
  struct Scope {
    llvm::DISubprogram* program;
    llvm::DILocation* calledAt;
  };

  llvm::DIFile* file(std::uint32_t number);
  llvm::DISubprogram* programOf(const ir::Function& function);
  llvm::DISubprogram* makeProgram(const ir::Function& function, llvm::StringRef linkage);
  llvm::DIType* scalarType(ir::Scalar scalar, llvm::Type* memory);

  const ir::Module& module_;
  llvm::DIBuilder builder_;
  std::vector<llvm::DIFile*> files_;
  llvm::DICompileUnit* unit_;
  std::map<const ir::Function*, llvm::DISubprogram*> programs_;
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
