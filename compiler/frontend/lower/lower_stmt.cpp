// SPDX-License-Identifier: MIT
//
// Lowers functions and statements. Loops keep the form that their author wrote; only conditions and steps
// with effects, which GLSL's loop heads cannot hold, move into the body.
#include <clang/AST/ASTContext.h>
#include <clang/AST/DeclCXX.h>
#include <clang/AST/ExprCXX.h>
#include <clang/AST/Stmt.h>
#include <clang/AST/StmtCXX.h>
#include <llvm/ADT/ScopeExit.h>

#include "frontend/lower/convert_literal.hpp"
#include "frontend/lower/function_lowering.hpp"
#include "ir/build.hpp"
#include "ir/walk.hpp"

namespace skc::frontend {

using clang::SourceLocation;

namespace {

/// The function's name in the IR, an identifier: `operator+=` is `operator_plus_equal`.
std::string functionName(const clang::FunctionDecl* declaration) {
  if (!declaration->isOverloadedOperator()) return declaration->getNameAsString();
  std::string name = "operator";
  for (const char c : llvm::StringRef(clang::getOperatorSpelling(declaration->getOverloadedOperator()))) {
    switch (c) {
      case '+': name += "_plus"; break;
      case '-': name += "_minus"; break;
      case '*': name += "_times"; break;
      case '/': name += "_over"; break;
      case '%': name += "_mod"; break;
      case '<': name += "_less"; break;
      case '>': name += "_greater"; break;
      case '=': name += "_equal"; break;
      case '!': name += "_not"; break;
      case '&': name += "_and"; break;
      case '|': name += "_or"; break;
      case '^': name += "_xor"; break;
      case '~': name += "_complement"; break;
      case '[': name += "_index"; break;
      case '(': name += "_call"; break;
      default: break;   // the closing bracket
    }
  }
  return name;
}

}  // namespace

bool FunctionLowering::returnsThis(const clang::FunctionDecl* declaration) {
  const auto* method = llvm::dyn_cast<clang::CXXMethodDecl>(declaration);
  const clang::QualType result = declaration->getReturnType();
  return method && method->isInstance() && result->isLValueReferenceType() &&
         result->getPointeeType()->getAsCXXRecordDecl() == method->getParent();
}

ir::Function FunctionLowering::function(const clang::FunctionDecl* declaration, const Aliases& aliases) {
  function_.name = functionName(declaration);
  function_.loc = module_.loc(declaration->getLocation());
  returnsThis_ = returnsThis(declaration);
  if (declaration->getReturnType()->isReferenceType() && !returnsThis_) {
    module_.fail(Diag::ReturnedReference, declaration->getLocation());
  }
  function_.result = returnsThis_ ? ir::Type::voidType()
                                  : module_.type(declaration->getReturnType(), declaration->getLocation());
  parameters(declaration);
  aliasParameters(aliases);
  if (checks_) addFailed();
  function_.parameterCount = static_cast<std::uint32_t>(function_.variables.size());
  ir::Block body;
  out_ = &body;
  const auto* compound = llvm::dyn_cast<clang::CompoundStmt>(declaration->getBody());
  if (!compound)
    module_.fail(Diag::Statement, declaration->getBody()->getBeginLoc(), {"a function try block"});
  bool isClean = true;
  for (const clang::Stmt* inner : compound->body()) {
    if (!checkedStatement(inner)) isClean = false;
  }
  if (!isClean) throw Abandoned{};
  function_.body = std::move(body);
  return std::move(function_);
}

void FunctionLowering::parameters(const clang::FunctionDecl* declaration) {
  for (const Bundles::Source& source : module_.bundles().parametersOf(declaration)) {
    if (source.parameter == nullptr && source.member.empty()) {
      self(llvm::cast<clang::CXXMethodDecl>(declaration));
      continue;
    }
    const auto id = static_cast<ir::VarId>(function_.variables.size());
    std::string name = source.parameter ? source.parameter->getNameAsString() : "self";
    if (source.member.empty()) {
      function_.variables.push_back(parameter(source.parameter, std::move(name)));
      variables_[source.parameter] = id;
      continue;
    }
    for (const clang::FieldDecl* field : source.member) name += "_" + field->getNameAsString();
    ir::Variable variable = parameter(source.member.back(), std::move(name));
    variable.isConst = true;
    function_.variables.push_back(std::move(variable));
    members_[{source.parameter, source.member}] = id;
  }
}

/// Adds the parameter for the object of a member function.
void FunctionLowering::self(const clang::CXXMethodDecl* method) {
  ir::Variable self;
  self.name = "self";
  self.type = module_.type(module_.context().getRecordType(method->getParent()), method->getLocation());
  self.role = method->isConst() ? ir::VarRole::In : ir::VarRole::InOut;
  self.isConst = method->isConst();
  self.loc = function_.loc;
  this_ = static_cast<ir::VarId>(function_.variables.size());
  function_.variables.push_back(std::move(self));
}

/// The variable for a parameter, or for a member of one that is a bundle.
ir::Variable FunctionLowering::parameter(const clang::ValueDecl* declared, std::string name) {
  const SourceLocation where = declared->getLocation();
  ir::Variable variable;
  variable.name = std::move(name);
  variable.loc = module_.loc(where);
  const clang::QualType type = declared->getType();
  const ParamSyntax* syntax = module_.syntax().param(where);
  if (const int rank = module_.gatherRank(type, where, variable.type)) {
    const bool isGather =
        !syntax || syntax->role == ir::ParamRole::Uniform || syntax->role == ir::ParamRole::Gather;
    if (!isGather) module_.fail(Diag::GatherAsValue, where);
    variable.role = ir::VarRole::Gather;
    variable.rank = static_cast<std::uint8_t>(rank);
    variable.isConst = true;
    return variable;
  }
  if (const auto appendRank = module_.appendRank(type, where, variable.type)) {
    variable.role = ir::VarRole::AppendOutput;
    variable.rank = static_cast<std::uint8_t>(*appendRank);
    variable.isConst = true;
    return variable;
  }
  if (syntax && !syntax->attribute.empty())
    module_.fail(Diag::BoundaryWithoutGather, where, {syntax->attribute, declared->getNameAsString()});
  const clang::QualType value = type.getNonReferenceType();
  const auto* ofFunction = llvm::dyn_cast<clang::ParmVarDecl>(declared);
  const clang::QualType written = ofFunction ? ofFunction->getOriginalType() : type;
  const auto* array = module_.context().getAsConstantArrayType(written);
  if (array != nullptr && ofFunction != nullptr) {  // by an alias
    if (syntax && syntax->role == ir::ParamRole::Input)
      module_.fail(Diag::ArrayAsElement, where, {variable.name});
    module_.fail(Diag::ArrayDecays, where,
                 {variable.name, std::to_string(array->getSize().getZExtValue()),
                  array->getElementType().getUnqualifiedType().getAsString()});
  }
  variable.type = module_.type(value, where);
  const bool mutableReference = type->isLValueReferenceType() && !value.isConstQualified();
  if (type->isRValueReferenceType()) module_.fail(Diag::RvalueReference, where, {type.getAsString()});
  variable.isConst = !mutableReference && value.isConstQualified();
  variable.role = mutableReference ? ir::VarRole::InOut : ir::VarRole::In;
  if (syntax && syntax->role == ir::ParamRole::Input) variable.role = ir::VarRole::Element;
  if (syntax && syntax->role == ir::ParamRole::Spec && value->isEnumeralType() && variable.type.isNarrow()) {
    variable.type = variable.type.arithmeticType();
    narrowSpecs_.insert(static_cast<ir::VarId>(function_.variables.size()));
  }
  const bool byValue =
      syntax && syntax->role != ir::ParamRole::Output && syntax->role != ir::ParamRole::Accumulator;
  if (byValue && type->isReferenceType() && !value->isConstantArrayType())
    module_.fail(Diag::ReferenceType, where, {type.getAsString()});
  return variable;
}

namespace {

/// True for constant expressions of GLSL. Calls of intrinsics with polyfills are not constant.
bool isConstant(const ir::Expr& e) {
  if (const auto* call = std::get_if<ir::IntrinsicCall>(&e.node);
      call && !ir::row(call->intrinsic).polyfill.empty()) {
    return false;
  }
  if (const auto* n = std::get_if<ir::Binary>(&e.node);
      n && n->op == ir::BinaryOp::Rem && e.type.scalar == ir::Scalar::Int) {
    return false;
  }
  if (std::holds_alternative<ir::Call>(e.node) || std::holds_alternative<ir::VarRef>(e.node)) return false;
  bool constant = true;
  ir::forEachOperand(e, [&](const ir::ExprPtr& operand) { constant = constant && isConstant(*operand); });
  return constant;
}

}  // namespace

ir::ExprPtr FunctionLowering::constantInitializer(const clang::Expr* init) {
  ir::Block effects;
  out_ = &effects;
  ir::ExprPtr result = value(init);
  return effects.empty() && isConstant(*result) ? std::move(result) : nullptr;
}

/// Lowers into a block of its own; continues with the next statement after an error.
void FunctionLowering::body(const clang::Stmt* statement, ir::Block& into) {
  ir::Block* outer = std::exchange(out_, &into);
  if (const auto* compound = llvm::dyn_cast<clang::CompoundStmt>(statement)) {
    for (const clang::Stmt* inner : compound->body()) checkedStatement(inner);
  } else {
    checkedStatement(statement);
  }
  out_ = outer;
}

bool FunctionLowering::checkedStatement(const clang::Stmt* s) {
  ir::Block* outer = out_;
  try {
    statement(s);
    return true;
  } catch (const Abandoned&) {
    out_ = outer;   // the error is recorded, so the module is not used
    return false;
  }
}

void FunctionLowering::statement(const clang::Stmt* s) {
  const Level level(depth_);
  const SourceLocation where = s->getBeginLoc();
  checkDepth(where);
  const Loc loc = module_.loc(where);
  switch (s->getStmtClass()) {
    case clang::Stmt::NullStmtClass: return;
    case clang::Stmt::CompoundStmtClass: {
      ir::Block inner;
      body(s, inner);
      return emit(loc, ir::Scope{std::move(inner)});
    }
    case clang::Stmt::DeclStmtClass: return declaration(llvm::cast<clang::DeclStmt>(s));
    case clang::Stmt::IfStmtClass: return ifStatement(llvm::cast<clang::IfStmt>(s));
    case clang::Stmt::ForStmtClass: return forStatement(llvm::cast<clang::ForStmt>(s));
    case clang::Stmt::WhileStmtClass: return whileStatement(llvm::cast<clang::WhileStmt>(s));
    case clang::Stmt::DoStmtClass: return doStatement(llvm::cast<clang::DoStmt>(s));
    case clang::Stmt::SwitchStmtClass: return switchStatement(llvm::cast<clang::SwitchStmt>(s));
    case clang::Stmt::ReturnStmtClass: return returnStatement(llvm::cast<clang::ReturnStmt>(s));
    case clang::Stmt::BreakStmtClass: return emit(loc, ir::Break{});
    case clang::Stmt::ContinueStmtClass: return emit(loc, ir::Continue{});
    case clang::Stmt::AttributedStmtClass:
      return statement(llvm::cast<clang::AttributedStmt>(s)->getSubStmt());
    case clang::Stmt::GotoStmtClass:
    case clang::Stmt::IndirectGotoStmtClass:
    case clang::Stmt::LabelStmtClass: module_.fail(Diag::Goto, where);
    case clang::Stmt::CaseStmtClass:
    case clang::Stmt::DefaultStmtClass: module_.fail(Diag::CaseInsideStatement, where);
    case clang::Stmt::CXXForRangeStmtClass: module_.fail(Diag::RangeFor, where);
    case clang::Stmt::GCCAsmStmtClass:
    case clang::Stmt::MSAsmStmtClass: module_.fail(Diag::Statement, where, {"assembly"});
    default: break;
  }
  if (const auto* expression = llvm::dyn_cast<clang::Expr>(s)) return discarded(expression);
  module_.fail(Diag::Statement, where, {"this kind of statement"});
}

void FunctionLowering::declaration(const clang::DeclStmt* s) {
  for (const clang::Decl* declared : s->decls()) {
    const auto* one = llvm::dyn_cast<clang::VarDecl>(declared);
    if (one && !ModuleLowering::isGenerated(one)) variable(one);
    // types, aliases and static_asserts need no code
  }
}

void FunctionLowering::variable(const clang::VarDecl* declaration) {
  const SourceLocation where = declaration->getLocation();
  if (declaration->isStaticLocal() && !declaration->getType().isConstQualified()) {
    module_.fail(Diag::StaticLocal, where, {ModuleLowering::nameOf(declaration)});
  }
  if (declaration->hasExternalStorage())
    module_.fail(Diag::StaticLocal, where, {declaration->getNameAsString()});
  const clang::QualType type = declaration->getType();
  if (type->isReferenceType()) module_.fail(Diag::ReferenceType, where, {type.getAsString()});
  const ir::Type lowered = module_.type(type, where);
  ir::ExprPtr init;
  if (const clang::Expr* initializer = declaration->getInit()) {
    const auto* construct = llvm::dyn_cast<clang::CXXConstructExpr>(initializer->IgnoreImplicit());
    const bool uninitialised = construct && construct->getNumArgs() == 0 &&
                               construct->getConstructor()->isTrivial() &&
                               !construct->requiresZeroInitialization();
    if (!uninitialised) {
      initialising_.insert(declaration);
      const auto done =
          llvm::make_scope_exit([&] { initialising_.erase(declaration); });  // after errors, too
      init = value(initializer);
    }
  }
  ir::Variable variable;
  variable.name = ModuleLowering::nameOf(declaration);
  variable.type = lowered;
  variable.isConst = type.isConstQualified();
  variable.loc = module_.loc(where);
  const auto id = static_cast<ir::VarId>(function_.variables.size());
  variables_[declaration] = id;
  function_.variables.push_back(std::move(variable));
  emit(module_.loc(where), ir::Declare{id, std::move(init)});
}

/// Lowers what the head of an `if` or a `switch` declares to `scope`, where the statement goes, too; false if it declares nothing.
bool FunctionLowering::head(const clang::Stmt* init, const clang::VarDecl* declared, ir::Block& scope) {
  if (init == nullptr && declared == nullptr) return false;
  out_ = &scope;
  if (init) statement(init);
  if (declared) variable(declared);
  return true;
}

void FunctionLowering::ifStatement(const clang::IfStmt* s) {
  if (const auto kept = s->getNondiscardedCase(module_.context())) {  // `if constexpr`
    if (*kept) statement(*kept);
    return;
  }
  const Loc loc = module_.loc(s->getBeginLoc());
  ir::Block scope;
  ir::Block* outer = out_;
  const bool needsScope = head(s->getInit(), s->getConditionVariable(), scope);
  if (s->isConsteval()) module_.fail(Diag::Statement, s->getBeginLoc(), {"if consteval"});
  ir::If result;
  result.cond = condition(s->getCond());
  body(s->getThen(), result.then);
  if (s->getElse()) body(s->getElse(), result.otherwise);
  emit(loc, std::move(result));
  if (needsScope) {
    out_ = outer;
    emit(loc, ir::Scope{std::move(scope)});
  }
}

void FunctionLowering::forStatement(const clang::ForStmt* s) {
  ir::Block init;
  if (s->getInit()) body(s->getInit(), init);
  loop(ir::LoopKind::For, std::move(init), {s->getConditionVariable(), s->getCond()}, s->getInc(),
       s->getBody(), s->getBeginLoc());
}

void FunctionLowering::whileStatement(const clang::WhileStmt* s) {
  loop(ir::LoopKind::While, {}, {s->getConditionVariable(), s->getCond()}, nullptr, s->getBody(),
       s->getBeginLoc());
}

void FunctionLowering::doStatement(const clang::DoStmt* s) {
  loop(ir::LoopKind::DoWhile, {}, {nullptr, s->getCond()}, nullptr, s->getBody(), s->getBeginLoc());
}

namespace {

/// True for what fits in the init of a GLSL `for`: declarations of one type, or one assignment.
bool fitsLoopInit(const ir::Block& block, const ir::Function& function) {
  if (block.size() == 1) return !std::holds_alternative<ir::CallStmt>(block.front().node);
  const ir::Type* type = nullptr;
  for (const ir::Stmt& s : block) {
    const auto* declare = std::get_if<ir::Declare>(&s.node);
    if (!declare) return false;
    const ir::Type& declared = function.variables[declare->var].type;
    if (type && *type != declared) return false;
    type = &declared;
  }
  return true;
}

}  // namespace

void FunctionLowering::loop(ir::LoopKind kind, ir::Block init, LoopTest test, const clang::Expr* step,
                            const clang::Stmt* inner, SourceLocation where) {
  const Loc loc = module_.loc(where);
  ir::Loop result;
  result.kind = kind;
  ir::Block condEffects;
  if (test.value) {
    ir::Block* outer = std::exchange(out_, &condEffects);
    if (test.variable) variable(test.variable);
    result.cond = condition(test.value);
    out_ = outer;
    if (test.variable && step) {  // sees the variable, too
      function_.variables[variables_.at(test.variable)].isConst = false;
      hoistDeclarations(condEffects);
    }
  }
  if (step) {
    ir::Block* outer = std::exchange(out_, &result.step);
    discarded(step);
    out_ = outer;
  }
  body(inner, result.body);
  // otherwise it moves in front of the loop, in a scope of its own
  const bool hoistInit = !fitsLoopInit(init, function_);
  ir::Block scope;
  if (hoistInit)
    scope = std::move(init);
  else
    result.init = std::move(init);
  ir::Block* outer = out_;
  if (hoistInit) out_ = &scope;

  if (!condEffects.empty()) testInBody(result, std::move(condEffects), loc);
  emit(loc, std::move(result));
  if (hoistInit) {
    out_ = outer;
    emit(loc, ir::Scope{std::move(scope)});
  }
}

/// A condition with effects: loop { effects; if (!cond) break; body }. In a do loop, the test comes first in
/// every iteration but the first, so that `continue` still reaches it.
void FunctionLowering::testInBody(ir::Loop& loop, ir::Block effects, Loc loc) {
  ir::Block test = std::move(effects);
  test.push_back(ir::ifStmt(ir::unary(ir::UnaryOp::LogicalNot, std::move(loop.cond), loc),
                            ir::block(ir::breakStmt(loc)), {}, loc));
  ir::Block body;
  if (loop.kind == ir::LoopKind::DoWhile) {
    const ir::VarId first = temporary(ir::Type::of(ir::Scalar::Bool), loc);
    emit(loc, ir::Declare{first, ir::literal(true, loc)});
    body.push_back(ir::ifStmt(ir::unary(ir::UnaryOp::LogicalNot, ir::varRef(function_, first, loc), loc),
                              std::move(test), {}, loc));
    body.push_back(ir::assign(ir::varRef(function_, first, loc), ir::literal(false, loc), loc));
    loop.kind = ir::LoopKind::While;
  } else {
    body = std::move(test);
  }
  for (ir::Stmt& s : loop.body) body.push_back(std::move(s));
  loop.body = std::move(body);
  loop.cond = nullptr;
}

namespace {

/// `[[likely]] case 1:` is a label with an attribute.
const clang::Stmt* withoutAttributes(const clang::Stmt* s) {
  while (const auto* attributed = llvm::dyn_cast<clang::AttributedStmt>(s)) s = attributed->getSubStmt();
  return s;
}

}  // namespace

/// Turns a switch over an integer of 64 bits, which GLSL lacks, into one over the number of the value's case.
void FunctionLowering::numberCases(ir::Switch& result, Loc loc) {
  const ir::Type type = result.value->type;
  const ir::VarId value = temporary(type, loc), number = temporary(ir::Type::of(ir::Scalar::Int), loc);
  emit(loc, ir::Declare{value, std::move(result.value)});
  emit(loc, ir::Declare{number, ir::literal(std::int32_t{-1}, loc)});
  std::int32_t count = 0;
  for (ir::Case& one : result.cases) {
    for (std::int64_t& label : one.values) {
      ir::ExprPtr wanted = ir::makeExpr(type, ir::Literal::wide(static_cast<std::uint64_t>(label)), loc);
      ir::ExprPtr isHere =
          ir::binary(ir::BinaryOp::Equal, ir::varRef(function_, value, loc), std::move(wanted), loc);
      ir::Block found;
      found.push_back(ir::assign(ir::varRef(function_, number, loc), ir::literal(count, loc), loc));
      emit(loc, ir::If{std::move(isHere), std::move(found), {}});
      label = count++;
    }
  }
  result.value = ir::varRef(function_, number, loc);
}

void FunctionLowering::switchStatement(const clang::SwitchStmt* s) {
  ir::Block scope;
  ir::Block* outside = out_;
  const bool needsScope = head(s->getInit(), s->getConditionVariable(), scope);
  ir::Switch result;
  result.value = value(s->getCond());
  const bool isLong = result.value->type.isLong();
  if (!isLong && !result.value->type.isInteger())  // a bool, or a narrow enumeration
    result.value = convert(std::move(result.value), ir::Scalar::Int);
  const auto* compound = llvm::dyn_cast<clang::CompoundStmt>(s->getBody());
  if (!compound) module_.fail(Diag::CaseInsideStatement, s->getBody()->getBeginLoc());
  for (const clang::Stmt* inner : compound->body()) {
    bool opened = false;
    while (const auto* label = llvm::dyn_cast<clang::SwitchCase>(withoutAttributes(inner))) {
      if (!opened) {
        result.cases.emplace_back();
        result.cases.back().loc = module_.loc(label->getBeginLoc());
        opened = true;
      }
      if (const auto* one = llvm::dyn_cast<clang::CaseStmt>(label)) {
        if (one->getRHS())
          module_.fail(Diag::Statement, one->getBeginLoc(),
                       {"a range of case values; write a 'case' for each"});
        const llvm::APSInt label = one->getLHS()->EvaluateKnownConstInt(module_.context());
        result.cases.back().values.push_back(static_cast<std::int64_t>(lowBits(label)));
      } else {
        result.cases.back().isDefault = true;
      }
      inner = label->getSubStmt();
    }
    if (result.cases.empty()) module_.fail(Diag::CaseInsideStatement, inner->getBeginLoc());
    ir::Block* outer = std::exchange(out_, &result.cases.back().body);
    checkedStatement(inner);
    out_ = outer;
  }
  if (isLong) numberCases(result, module_.loc(s->getBeginLoc()));
  emit(module_.loc(s->getBeginLoc()), std::move(result));
  if (!needsScope) return;
  out_ = outside;
  emit(module_.loc(s->getBeginLoc()), ir::Scope{std::move(scope)});
}

namespace {

/// `*this`, or the implicit `this` of a member function call.
bool isThisObject(const clang::Expr* e) {
  e = e->IgnoreParenImpCasts();
  const auto* dereference = llvm::dyn_cast<clang::UnaryOperator>(e);
  if (dereference && dereference->getOpcode() == clang::UO_Deref) {
    e = dereference->getSubExpr()->IgnoreParenImpCasts();
  }
  return llvm::isa<clang::CXXThisExpr>(e);
}

/// `*this += 1` or `add(1)`, calling a function that returns its own object.
bool isCallOnThisObject(const clang::Expr* e) {
  const auto* call = llvm::dyn_cast<clang::CallExpr>(e->IgnoreParenImpCasts());
  const clang::FunctionDecl* callee = call ? call->getDirectCallee() : nullptr;
  if (!callee || !FunctionLowering::returnsThis(callee)) return false;
  if (const auto* member = llvm::dyn_cast<clang::CXXMemberCallExpr>(call)) {
    return isThisObject(member->getImplicitObjectArgument());
  }
  return isThisObject(call->getArg(0));
}

}  // namespace

void FunctionLowering::returnStatement(const clang::ReturnStmt* s) {
  ir::Return result;
  if (returnsThis_) {
    if (isCallOnThisObject(s->getRetValue())) {
      discarded(s->getRetValue());
    } else if (!isThisObject(s->getRetValue())) {
      module_.fail(Diag::ReturnedReference, s->getBeginLoc());
    }
  } else if (const clang::Expr* returned = s->getRetValue()) {
    if (returned->getType()->isVoidType()) {
      discarded(returned);
    } else {
      result.value = value(returned);
    }
  }
  emit(module_.loc(s->getBeginLoc()), std::move(result));
}

void FunctionLowering::emit(Loc loc, ir::Stmt::Node node) { out_->push_back(ir::Stmt{loc, std::move(node)}); }

}  // namespace skc::frontend
