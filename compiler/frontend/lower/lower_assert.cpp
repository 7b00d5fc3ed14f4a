// SPDX-License-Identifier: MIT
//
// Lowers assertions. Every function is lowered as if it had none; one that has some is lowered a second time, to a version
// that checks them and does nothing else that other elements or calls could see:
//
//   kernel void f(float x<>, out float r<>) { assert(x >= 0); r = sqrt(x); }
//
//   f                                            f's check
//     r = sqrt(x);                                 failed = 0;
//                                                  if (failed == 0 && !(x >= 0)) failed = 1;
//                                                  r = sqrt(x);
//
// slice-assertions leaves of the check what the conditions need. A call of a function that asserts passes `failed` on.
#include <algorithm>
#include <cctype>
#include <variant>

#include <clang/AST/ASTContext.h>
#include <clang/AST/ExprCXX.h>
#include <clang/AST/PrettyPrinter.h>
#include <clang/Basic/SourceManager.h>
#include <clang/Lex/Lexer.h>
#include <llvm/Support/raw_ostream.h>

#include "frontend/lower/function_lowering.hpp"
#include "ir/build.hpp"
#include "ir/lvalue.hpp"
#include "ir/walk.hpp"

namespace skc::frontend {

using ir::ExprPtr;

namespace {

constexpr std::string_view failedName = "failed";

ir::Variable failedVariable(Loc loc) {
  ir::Variable variable;
  variable.name = failedName;
  variable.type = ir::Type::of(ir::Scalar::Int);
  variable.role = ir::VarRole::InOut;
  variable.loc = loc;
  return variable;
}

/// Whether the statements write a stream, or call a function that may.
bool writesStreams(const ir::Block& block, const ir::Function& function) {
  bool writes = false;
  ir::walkStmts(block, [&](const ir::Stmt& stmt) {
    writes = writes || std::holds_alternative<ir::Push>(stmt.node) ||
             std::holds_alternative<ir::Scatter>(stmt.node);
    const auto* call = std::get_if<ir::CallStmt>(&stmt.node);
    if (call == nullptr) return;
    writes = writes || std::ranges::any_of(call->args, [&](const ExprPtr& argument) {
               const auto* variable = std::get_if<ir::VarRef>(&argument->node);
               return variable && function.variables[variable->var].role == ir::VarRole::AppendOutput;
             });
  });
  return writes;
}

}  // namespace

// ---- in a function ------------------------------------------------------------------------------

void FunctionLowering::addFailed() {
  failed_ = static_cast<ir::VarId>(function_.variables.size());
  function_.variables.push_back(failedVariable(function_.loc));
}

ExprPtr FunctionLowering::assertion(const clang::CallExpr* e) {
  const Loc loc = module_.loc(e->getBeginLoc());
  ExprPtr unused = ir::literal(false, loc);  // assert is void
  if (!checks_) return unused;
  const clang::Expr* condition = e->getArg(0);
  const auto first = static_cast<ir::VarId>(function_.variables.size());
  ir::Block effects;
  ir::Block* const outer = std::exchange(out_, &effects);
  isInCondition_ = true;
  ExprPtr holds = this->condition(condition);
  isInCondition_ = false;
  checkPure(condition, effects, first);
  ExprPtr fails = ir::unary(ir::UnaryOp::LogicalNot, std::move(holds), loc);
  const auto number = static_cast<std::int32_t>(module_.numberOf(e));
  const auto failed = [&] { return ir::varRef(function_, *failed_, loc); };
  ExprPtr isFirst = ir::binary(ir::BinaryOp::Equal, failed(), ir::literal(std::int32_t{0}, loc), loc);
  ir::If note;
  note.then.push_back(ir::assign(failed(), ir::literal(number, loc), loc));
  if (effects.empty()) {
    out_ = outer;
    note.cond = ir::binary(ir::BinaryOp::LogicalAnd, std::move(isFirst), std::move(fails), loc);
    emit(loc, std::move(note));
    return unused;
  }
  note.cond = std::move(fails);
  emit(loc, std::move(note));
  out_ = outer;
  emit(loc, ir::If{std::move(isFirst), std::move(effects), {}});
  return unused;
}

void FunctionLowering::checkPure(const clang::Expr* condition, const ir::Block& effects, ir::VarId first) {
  const Variables changed = ir::assignedIn(module_.module(), effects);
  const bool changesOther =
      std::ranges::any_of(changed, [&](ir::VarId var) { return var < first && var != *failed_; });
  if (changesOther || writesStreams(effects, function_))
    module_.fail(Diag::AssertEffect, condition->getBeginLoc(), {module_.conditionText(condition)});
}

// ---- in a module --------------------------------------------------------------------------------

const ModuleLowering::Marks& ModuleLowering::marksOf(const clang::FunctionDecl* declaration) {
  const clang::FunctionDecl* definition = declaration->getDefinition();
  if (definition == nullptr || isPrelude(definition)) definition = nullptr;
  const auto [known, isNew] =
      marks_.try_emplace(definition);  // empty while it is followed: recursion is an error
  if (!isNew || definition == nullptr) return known->second;
  Marks found;
  addMarks(definition->getBody(), found);
  return marks_[definition] = found;
}

void ModuleLowering::addMarks(const clang::Stmt* statement, Marks& marks) {
  if (statement == nullptr) return;
  if (const auto* call = llvm::dyn_cast<clang::CallExpr>(statement)) {
    const clang::FunctionDecl* callee = call->getDirectCallee();
    if (callee != nullptr && isPrelude(callee)) {
      const llvm::StringRef name = callee->getIdentifier() ? callee->getName() : llvm::StringRef();
      if (name == "assert" && marks.assertion == nullptr) marks.assertion = call;
      if (name == "printf" && marks.print == nullptr) marks.print = call;
    } else if (callee != nullptr) {
      const Marks inner = marksOf(callee);
      if (marks.assertion == nullptr) marks.assertion = inner.assertion;
      if (marks.print == nullptr) marks.print = inner.print;
    }
  }
  if (const auto* given = llvm::dyn_cast<clang::CXXDefaultArgExpr>(statement))
    addMarks(given->getExpr(), marks);
  if (const auto* given = llvm::dyn_cast<clang::CXXDefaultInitExpr>(statement))
    addMarks(given->getExpr(), marks);
  for (const clang::Stmt* part : statement->children()) addMarks(part, marks);
}

bool ModuleLowering::hasCheckedVersion(const clang::FunctionDecl* declaration) {
  const Marks& marks = marksOf(declaration);
  if (marks.assertion != nullptr || marks.print != nullptr) return true;
  return std::ranges::any_of(declaration->parameters(), [&](const clang::ParmVarDecl* parameter) {
    ir::Type element;
    return appendRank(parameter->getType(), parameter->getLocation(), element).has_value();
  });
}

std::string ModuleLowering::conditionText(const clang::Expr* condition) const {
  condition = condition->IgnoreImplicit();
  const auto range = clang::CharSourceRange::getTokenRange(condition->getSourceRange());
  std::string text = clang::Lexer::getSourceText(range, sources(), context().getLangOpts()).str();
  if (text.empty()) {  // a macro has put it together
    llvm::raw_string_ostream stream(text);
    condition->printPretty(stream, nullptr, context().getPrintingPolicy());
  }
  std::string line;
  for (const char c : text) {
    const bool isSpace = std::isspace(static_cast<unsigned char>(c)) != 0;
    if (!isSpace)
      line += c;
    else if (!line.empty() && line.back() != ' ')
      line += ' ';
  }
  return line;
}

std::uint32_t ModuleLowering::numberOf(const clang::CallExpr* assertion) {
  const Loc where = loc(assertion->getBeginLoc());
  std::string text = conditionText(assertion->getArg(0));
  const auto next = static_cast<std::uint32_t>(module_.assertions.size() + 1);
  const auto [known, isNew] = assertions_.emplace(std::pair(where.token, text), next);
  if (isNew) module_.assertions.push_back({std::move(text), where});
  return known->second;
}

/// Adds to each kernel that asserts the one that checks it. Outputs and accumulators are outputs there, none of which
/// slice-assertions keeps.
void ModuleLowering::addAssertionChecks() {
  const std::size_t declared = module_.kernels.size();
  for (ir::KernelId id = 0; id < declared; ++id) {
    const auto [declaration, checkOfPass] = kernelOrigins_[id];
    const bool asserts = declaration != nullptr && marksOf(declaration).assertion != nullptr;
    if (module_.kernels[id].isSynthesized || !(asserts || checkOfPass)) continue;
    const ir::FunctionId checked =
        checkOfPass ? *checkOfPass : function(declaration, declaration->getLocation(), {}, /*checks=*/true);
    ir::Function entry = ir::clone(module_.functions[checked]);
    const ir::VarId failed = entry.parameterCount - 1;
    entry.body.insert(entry.body.begin(), ir::assign(ir::varRef(entry, failed, entry.loc),
                                                     ir::literal(std::int32_t{0}, entry.loc), entry.loc));
    const ir::Kernel& kernel = module_.kernels[id];
    ir::Kernel check;
    check.name = kernel.name;
    check.scope = kernel.scope;
    check.choices = kernel.choices;
    check.choices.ahead = 0;
    check.isPart = true;
    check.loc = kernel.loc;
    check.entry = static_cast<ir::FunctionId>(module_.functions.size());
    for (const ir::KernelParam& param : kernel.params) {
      check.params.push_back(ir::clone(param));
      if (param.role != ir::ParamRole::Accumulator) continue;
      check.params.back().role = ir::ParamRole::Output;
      check.params.back().identity = nullptr;
    }
    ir::KernelParam output;
    output.name = failedName;
    output.role = ir::ParamRole::Output;
    output.type = ir::Type::of(ir::Scalar::Int);
    output.loc = kernel.loc;
    check.params.push_back(std::move(output));
    module_.functions.push_back(std::move(entry));
    module_.kernels[id].assertions = {static_cast<ir::KernelId>(module_.kernels.size()), {}};
    module_.kernels.push_back(std::move(check));
  }
}

}  // namespace skc::frontend
