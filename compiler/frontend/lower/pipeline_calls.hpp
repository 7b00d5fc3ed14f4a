// SPDX-License-Identifier: MIT
//
// Reads the body of a pipeline: which streams it declares, and how each call uses them. Reports what a pipeline cannot do.
#pragma once

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include <clang/AST/Decl.h>
#include <clang/AST/Expr.h>
#include <clang/AST/Stmt.h>

#include "frontend/lower/bundles.hpp"
#include "frontend/tokens/syntax.hpp"
#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc::frontend {

class ModuleLowering;

/// A parameter of the pipeline, or a local stream.
using PipelineStream = const clang::VarDecl*;
using PipelineStreams = std::set<PipelineStream>;

/// How a call uses a stream.
struct StreamUse {
  PipelineStream stream;
  const clang::ParmVarDecl* parameter;  ///< of the kernel
  ir::ParamRole role;
};

struct PipelineCall {
  const clang::CallExpr* expr;
  const clang::FunctionDecl* callee;  ///< its definition
  const KernelSyntax* syntax;
  std::vector<StreamUse> uses = {};
  std::set<const clang::VarDecl*> values = {};  ///< parameters and values that its other arguments name
  bool isPlain = true;  ///< each argument is a parameter or a stream
  bool isLive = false;

  bool hasUse(PipelineStream stream, ir::ParamRole role) const {
    return std::ranges::any_of(
        uses, [&](const StreamUse& use) { return use.stream == stream && use.role == role; });
  }
  bool hasRole(ir::ParamRole role) const { return std::ranges::count(uses, role, &StreamUse::role) > 0; }
  bool appends() const { return hasRole(ir::ParamRole::VariableOutput) || hasRole(ir::ParamRole::Scatter); }
};

class PipelineCalls {
 public:
  /// `definition`: of the pipeline. Reads it whole; throws Abandoned after a mistake.
  PipelineCalls(ModuleLowering& module, const clang::FunctionDecl* definition);

  /// In order; those that are not live write what nothing reads.
  const std::vector<PipelineCall>& list() const { return calls_; }
  const std::vector<Bundles::Source>& parameters() const { return sources_; }
  /// The streams that the pipeline declares.
  const std::vector<PipelineStream>& locals() const { return locals_; }
  /// The values that it declares, in order.
  const std::vector<const clang::VarDecl*>& values() const { return order_; }
  /// What the initial value of one names.
  const std::set<const clang::VarDecl*>& namesIn(const clang::VarDecl* value) const {
    return values_.at(value);
  }
  /// The role of a parameter, and Output for local streams, which are written and read, too.
  ir::ParamRole roleOf(PipelineStream stream) const;
  bool isStream(const clang::VarDecl* variable) const;
  /// The outputs, which have the shape of the domain.
  PipelineStreams results() const;

 private:
  void readBody();
  [[noreturn]] void refuse(const clang::Stmt* statement, std::string_view what);
  void declaration(const clang::DeclStmt* statement);
  void refuseStream(const clang::VarDecl* variable, const clang::Expr* where);
  void call(const clang::Expr* expression);
  void argument(PipelineCall& made, const Bundles::Source& source);
  void note(const PipelineCall& made);
  void checkRank(const PipelineCall& made, const StreamUse& use);
  void checkResults();
  bool isSameParameter(const clang::Expr* given, const clang::ParmVarDecl* parameter, ir::ParamRole role);
  bool isSameType(const clang::VarDecl& own, const clang::ParmVarDecl& parameter);
  bool hasOwnIdentity(const clang::VarDecl& stream) const;
  void dropUnusedCalls();

  ModuleLowering& module_;
  const clang::FunctionDecl* definition_;
  std::vector<Bundles::Source> sources_;
  std::vector<PipelineStream> locals_;
  std::vector<const clang::VarDecl*> order_;
  std::map<const clang::VarDecl*, std::set<const clang::VarDecl*>> values_;
  std::vector<PipelineCall> calls_;
  PipelineStreams written_;  ///< by the calls so far
  std::map<PipelineStream, int> ranks_;  ///< in which kernels gather them
};

}  // namespace skc::frontend
