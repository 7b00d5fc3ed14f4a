// SPDX-License-Identifier: MIT
#include "frontend/lower/pipeline_calls.hpp"

#include <clang/AST/ExprCXX.h>
#include <clang/AST/StmtCXX.h>

#include "frontend/lower/module_lowering.hpp"

namespace skc::frontend {

using clang::SourceLocation;

namespace {

/// All variables that an expression names.
void addNames(const clang::Stmt* statement, std::set<const clang::VarDecl*>& names) {
  if (statement == nullptr) return;
  if (const auto* reference = llvm::dyn_cast<clang::DeclRefExpr>(statement)) {
    if (const auto* variable = llvm::dyn_cast<clang::VarDecl>(reference->getDecl());
        variable != nullptr && variable->isLocalVarDeclOrParm()) {
      names.insert(variable);
    }
  }
  for (const clang::Stmt* part : statement->children()) addNames(part, names);
}

}  // namespace

const clang::VarDecl* streamNamed(const ModuleLowering& module, const clang::Expr* argument) {
  const auto* reference = llvm::dyn_cast<clang::DeclRefExpr>(withoutCopies(argument));
  const auto* variable = reference ? llvm::dyn_cast<clang::VarDecl>(reference->getDecl()) : nullptr;
  if (variable == nullptr) return nullptr;
  if (module.syntax().isLocalStream(variable->getLocation())) return variable;
  if (!llvm::isa<clang::ParmVarDecl>(variable)) return nullptr;
  const ir::ParamRole role = module.roleOf(variable);
  const bool isValue =
      role == ir::ParamRole::Uniform || role == ir::ParamRole::Spec || role == ir::ParamRole::Iterator;
  return isValue ? nullptr : variable;
}

PipelineCalls::PipelineCalls(ModuleLowering& module, const clang::FunctionDecl* definition)
    : module_(module), definition_(definition), sources_(module.bundles().parametersOf(definition)) {
  readBody();
  checkResults();
  dropUnusedCalls();
}

void PipelineCalls::readBody() {
  for (const clang::Stmt* statement : llvm::cast<clang::CompoundStmt>(definition_->getBody())->body()) {
    if (const auto* declared = llvm::dyn_cast<clang::DeclStmt>(statement)) {
      declaration(declared);
    } else if (const auto* expression = llvm::dyn_cast<clang::Expr>(statement)) {
      call(expression);
    } else if (!llvm::isa<clang::NullStmt>(statement)) {
      const bool isBranch = llvm::isa<clang::IfStmt>(statement) || llvm::isa<clang::SwitchStmt>(statement);
      const bool isLoop = llvm::isa<clang::ForStmt>(statement) || llvm::isa<clang::WhileStmt>(statement) ||
                          llvm::isa<clang::DoStmt>(statement);
      refuse(statement, isBranch ? "a branch" : isLoop ? "a loop" : "this statement");
    }
  }
}

void PipelineCalls::refuse(const clang::Stmt* statement, std::string_view what) {
  module_.fail(Diag::PipelineStatement, statement->getBeginLoc(), {definition_->getNameAsString(), what});
}

void PipelineCalls::declaration(const clang::DeclStmt* statement) {
  for (const clang::Decl* declared : statement->decls()) {
    const auto* variable = llvm::dyn_cast<clang::VarDecl>(declared);
    if (variable == nullptr || ModuleLowering::isGenerated(variable)) continue;
    if (module_.syntax().isLocalStream(variable->getLocation())) {
      module_.checkElement(module_.type(variable->getType(), variable->getLocation()),
                           variable->getNameAsString(), variable->getLocation());
      locals_.push_back(variable);
      continue;
    }
    if (variable->getInit() == nullptr)
      module_.fail(Diag::PipelineValue, variable->getLocation(), {variable->getNameAsString()});
    std::set<const clang::VarDecl*>& names = values_[variable];
    addNames(variable->getInit(), names);
    for (const clang::VarDecl* named : names) refuseStream(named, variable->getInit());
    order_.push_back(variable);
  }
}

bool PipelineCalls::isStream(const clang::VarDecl* variable) const {
  if (std::ranges::find(locals_, variable) != locals_.end()) return true;
  const auto* parameter = llvm::dyn_cast<clang::ParmVarDecl>(variable);
  if (parameter == nullptr || module_.bundles().isBundle(parameter->getType())) return false;
  const ir::ParamRole role = module_.roleOf(parameter);
  return role != ir::ParamRole::Uniform && role != ir::ParamRole::Spec && role != ir::ParamRole::Iterator;
}

void PipelineCalls::refuseStream(const clang::VarDecl* variable, const clang::Expr* where) {
  if (isStream(variable))
    module_.fail(Diag::PipelineStreamAsValue, where->getBeginLoc(), {variable->getNameAsString()});
}

void PipelineCalls::call(const clang::Expr* expression) {
  if (const auto* cleanups = llvm::dyn_cast<clang::ExprWithCleanups>(expression))
    expression = cleanups->getSubExpr();
  const auto* called = llvm::dyn_cast<clang::CallExpr>(expression->IgnoreParenImpCasts());
  const clang::FunctionDecl* callee = called ? called->getDirectCallee() : nullptr;
  if (callee == nullptr || llvm::isa<clang::CXXOperatorCallExpr>(called)) {
    const auto* operation = llvm::dyn_cast<clang::BinaryOperator>(expression);
    refuse(expression, operation && operation->isAssignmentOp() ? "an assignment" : "this expression");
  }
  const clang::FunctionDecl* definition = callee->getDefinition();
  const KernelSyntax* kind = definition ? module_.syntax().kernel(definition->getLocation()) : nullptr;
  if (kind == nullptr || kind->kind == FunctionKind::Pipeline) {
    module_.fail(Diag::PipelineCallee, called->getBeginLoc(),
                 {callee->getNameAsString(), wordOf(kind ? kind->kind : FunctionKind::Helper)});
  }
  module_.function(definition, called->getBeginLoc());  // its mistakes come before those of the call
  PipelineCall made{called, definition, kind};
  for (const Bundles::Source& source : module_.bundles().parametersOf(definition)) argument(made, source);
  note(made);
  calls_.push_back(std::move(made));
}

void PipelineCalls::argument(PipelineCall& made, const Bundles::Source& source) {
  const clang::Expr* given = argumentFor(made.expr, made.callee, source.parameter);
  const ir::ParamRole role =
      source.member.empty() ? module_.roleOf(source.parameter) : ir::ParamRole::Uniform;
  const PipelineStream stream = streamNamed(module_, given);
  const bool isValue = role == ir::ParamRole::Uniform || role == ir::ParamRole::Spec ||
                       role == ir::ParamRole::Iterator || (role == ir::ParamRole::Input && stream == nullptr);
  if (isValue) {
    std::set<const clang::VarDecl*> names;
    addNames(given, names);
    for (const clang::VarDecl* named : names) refuseStream(named, given);
    made.isPlain = made.isPlain && source.member.empty() && role != ir::ParamRole::Input &&
                   isSameParameter(given, source.parameter, role);
    made.values.insert(names.begin(), names.end());
    return;
  }
  const auto fails = [&](Diag diag, std::string_view wanted = {}) {
    module_.fail(diag, given->getBeginLoc(),
                 {source.parameter->getNameAsString(), made.callee->getNameAsString(), wanted});
  };
  if (stream == nullptr) fails(Diag::PipelineValueAsStream);
  const ir::ParamRole held = roleOf(stream);
  const bool isReadable = held == ir::ParamRole::Input || held == ir::ParamRole::Output;
  switch (role) {
    case ir::ParamRole::Input:
      if (!isReadable) fails(Diag::PipelineParameter, "an input, an output or a local stream");
      break;
    case ir::ParamRole::Gather:
      if (!isReadable && held != ir::ParamRole::Gather)
        fails(Diag::PipelineParameter, "an input, an output, a gather or a local stream");
      break;
    case ir::ParamRole::Output:
      if (held != ir::ParamRole::Output) fails(Diag::PipelineParameter, "an output or a local stream");
      break;
    case ir::ParamRole::Accumulator:
      if (made.syntax->kind == FunctionKind::Scan) {
        if (held != ir::ParamRole::Output) fails(Diag::PipelineParameter, "an output or a local stream");
      } else if (held != ir::ParamRole::Accumulator) {
        fails(Diag::PipelineParameter, "an accumulator, 'reduce T r<>',");
      }
      break;
    default:
      if (held != role) fails(Diag::PipelineParameter, "such an output");
      break;
  }
  made.isPlain = made.isPlain && isSameType(*stream, *source.parameter) && !hasOwnIdentity(*stream);
  const bool writesStream = made.syntax->kind == FunctionKind::Scan && role == ir::ParamRole::Accumulator;
  made.uses.push_back({stream, source.parameter, writesStream ? ir::ParamRole::Output : role});
}

/// True if an argument is a parameter of the pipeline that C++ could pass to the kernel instead.
bool PipelineCalls::isSameParameter(const clang::Expr* given, const clang::ParmVarDecl* parameter,
                                    ir::ParamRole role) {
  const auto* reference = llvm::dyn_cast<clang::DeclRefExpr>(withoutCopies(given));
  const auto* own = reference ? llvm::dyn_cast<clang::ParmVarDecl>(reference->getDecl()) : nullptr;
  if (own == nullptr || module_.bundles().isBundle(own->getType())) return false;
  const bool isIterator = role == ir::ParamRole::Iterator;
  return isSameType(*own, *parameter) && (module_.roleOf(own) == ir::ParamRole::Iterator) == isIterator;
}

/// True if no argument of one needs a conversion to the other; a gather reads elements as they are.
bool PipelineCalls::isSameType(const clang::VarDecl& own, const clang::ParmVarDecl& parameter) {
  const auto elementOf = [&](const clang::VarDecl& variable) {
    ir::Type element;
    const clang::QualType type = variable.getType().getNonReferenceType().getUnqualifiedType();
    const SourceLocation where = variable.getLocation();
    if (module_.gatherRank(type, where, element) != 0 || module_.appendRank(type, where, element))
      return element;
    return module_.type(type, where);
  };
  return elementOf(own) == elementOf(parameter);
}

/// True if the pipeline declares an identity for an accumulator, which may differ from that of a reduce.
bool PipelineCalls::hasOwnIdentity(const clang::VarDecl& stream) const {
  const ParamSyntax* syntax = module_.syntax().param(stream.getLocation());
  return syntax != nullptr && !syntax->identity.empty();
}

/// The role of a parameter, and Output for local streams, which are one and read, too.
ir::ParamRole PipelineCalls::roleOf(PipelineStream stream) const {
  return llvm::isa<clang::ParmVarDecl>(stream) ? module_.roleOf(stream) : ir::ParamRole::Output;
}

/// Notes what a call writes, after checking that what it reads was written.
void PipelineCalls::note(const PipelineCall& made) {
  for (const StreamUse& use : made.uses) {
    const bool isRead = use.role == ir::ParamRole::Input || use.role == ir::ParamRole::Gather;
    if (isRead && roleOf(use.stream) == ir::ParamRole::Output && !written_.contains(use.stream)) {
      module_.fail(Diag::PipelineUnwritten, argumentFor(made.expr, made.callee, use.parameter)->getBeginLoc(),
                   {use.stream->getNameAsString()});
    }
    const bool isWritten = !isRead;
    for (const StreamUse& other : made.uses) {
      const bool isSame = &other != &use && other.stream == use.stream && isWritten &&
                          other.role != ir::ParamRole::Input && other.role != ir::ParamRole::Gather;
      if (!isSame) continue;
      module_.fail(Diag::PipelineSameOutput, made.expr->getBeginLoc(),
                   {use.parameter->getNameAsString(), other.parameter->getNameAsString(),
                    made.callee->getNameAsString(), use.stream->getNameAsString()});
    }
    if (use.role == ir::ParamRole::Gather) checkRank(made, use);
    if (use.role == ir::ParamRole::Accumulator && written_.contains(use.stream)) {
      module_.fail(Diag::PipelineFoldedTwice,
                   argumentFor(made.expr, made.callee, use.parameter)->getBeginLoc(),
                   {use.stream->getNameAsString()});
    }
  }
  for (const StreamUse& use : made.uses) {
    if (use.role != ir::ParamRole::Input && use.role != ir::ParamRole::Gather) written_.insert(use.stream);
  }
}

/// Reports a stream that kernels read in different ranks: no stream has two.
void PipelineCalls::checkRank(const PipelineCall& made, const StreamUse& use) {
  ir::Type element;
  const int rank = module_.gatherRank(use.parameter->getType(), use.parameter->getLocation(), element);
  const auto [known, isNew] = ranks_.emplace(use.stream, rank);
  if (isNew || known->second == rank) return;
  module_.fail(Diag::PipelineRank, argumentFor(made.expr, made.callee, use.parameter)->getBeginLoc(),
               {use.stream->getNameAsString(), made.callee->getNameAsString(), std::to_string(rank),
                std::to_string(known->second)});
}

void PipelineCalls::checkResults() {
  bool hasShape = false, hasResult = false;
  for (const Bundles::Source& source : sources_) {
    if (!source.member.empty()) continue;
    const ir::ParamRole role = module_.roleOf(source.parameter);
    hasShape = hasShape || role == ir::ParamRole::Output || role == ir::ParamRole::Input;
    const bool isResult = role == ir::ParamRole::Output || role == ir::ParamRole::Accumulator ||
                          role == ir::ParamRole::VariableOutput || role == ir::ParamRole::Scatter;
    hasResult = hasResult || isResult;
    if (isResult && !written_.contains(source.parameter)) {
      module_.fail(Diag::PipelineOutput, source.parameter->getLocation(),
                   {definition_->getNameAsString(), source.parameter->getNameAsString()});
    }
  }
  if (!hasResult)
    module_.fail(Diag::PipelineWithoutResult, definition_->getLocation(), {definition_->getNameAsString()});
  if (!hasShape)
    module_.fail(Diag::PipelineWithoutDomain, definition_->getLocation(), {definition_->getNameAsString()});
}

PipelineStreams PipelineCalls::results() const {
  PipelineStreams list;
  for (const Bundles::Source& source : sources_) {
    if (source.member.empty() && module_.roleOf(source.parameter) == ir::ParamRole::Output)
      list.insert(source.parameter);
  }
  return list;
}

/// Leaves out calls whose outputs nothing reads.
void PipelineCalls::dropUnusedCalls() {
  PipelineStreams live = results();
  for (auto made = calls_.rbegin(); made != calls_.rend(); ++made) {
    made->isLive = made->hasRole(ir::ParamRole::Accumulator) || made->appends() ||
                   module_.marksOf(made->callee).print != nullptr ||
                   module_.marksOf(made->callee).assertion != nullptr;
    for (const StreamUse& use : made->uses) {
      if (use.role == ir::ParamRole::Output && live.contains(use.stream)) made->isLive = true;
    }
    if (!made->isLive) continue;
    for (const StreamUse& use : made->uses) {
      if (use.role == ir::ParamRole::Output) live.erase(use.stream);
    }
    for (const StreamUse& use : made->uses) {
      if (use.role == ir::ParamRole::Input || use.role == ir::ParamRole::Gather) live.insert(use.stream);
    }
  }
  for (const PipelineCall& made : calls_) {
    if (!made.isLive) {
      module_.diagnostics().report(Diag::PipelineUnused, module_.loc(made.expr->getBeginLoc()),
                                   {made.callee->getNameAsString()});
    }
  }
}

}  // namespace skc::frontend
