// SPDX-License-Identifier: MIT
//
// A pipeline becomes passes: kernels that each call some of its kernels, element by element, and that C++ calls one after the other.
#pragma once

#include <string>
#include <vector>

#include <clang/AST/Decl.h>
#include <clang/AST/Expr.h>

#include "frontend/lower/bundles.hpp"
#include "ir/ir.hpp"

namespace skc::frontend {

class ModuleLowering;
struct KernelSyntax;

/// What a pass is lowered from.
struct PassSource {
  /// A parameter of its kernel.
  struct Parameter {
    enum class Kind : std::uint8_t {
      Declared,  ///< a parameter of the pipeline, or a member of one, in its own role
      Input,  ///< the element of a stream that an earlier pass has written, or that the pipeline was given
      Output,  ///< the element of a stream that the pass stores
      Gather,  ///< a stream, as a gather
    };
    Kind kind;
    Bundles::Source declared = {};  ///< Declared
    const clang::VarDecl* stream = nullptr;  ///< otherwise
    const clang::ParmVarDecl* reader = nullptr;  ///< Gather: the parameter of the kernel that reads it
    std::string name;
  };
  /// A declaration of a value, or a call: the other one is null.
  struct Step {
    const clang::VarDecl* value = nullptr;
    const clang::CallExpr* call = nullptr;
  };

  std::string name;
  clang::SourceLocation where;
  std::vector<Parameter> parameters;
  std::vector<const clang::VarDecl*>
      unstored;  ///< streams of which the pass writes elements that nothing else reads
  std::vector<Step> steps;
};

/// Lowers a pipeline: adds the kernels of its passes to the module, and the pipeline. Reports mistakes, and throws
/// Abandoned after one.
void lowerPipeline(ModuleLowering& module, const clang::FunctionDecl* declaration,
                   const KernelSyntax& syntax);

/// The stream that an argument names; null for any other expression.
const clang::VarDecl* streamNamed(const ModuleLowering& module, const clang::Expr* argument);

}  // namespace skc::frontend
