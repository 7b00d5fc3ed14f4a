// SPDX-License-Identifier: MIT
//
// Lowers one function's body. C++ expressions have side effects, the IR's do not: an expression's effects
// become statements in front of its statement. The order is C++17's, and left to right where C++ leaves it open.
// A value that is needed after a later effect is saved in a temporary, and so are the indices of an lvalue, but
// only if the effect could change them (docs/ir.md, "Lvalues and the order of evaluation").
//
//   v = u[i++] * 2;     ->     int t = i; i += 1; v = u[t] * 2;
//   if (a && f(b))      ->     if (a && f(b))              if f has no effects (it takes values)
//   while (next(i))     ->     while (true) { bool t; t = next(i); if (!t) break; ... }
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <unordered_map>
#include <unordered_set>

#include <clang/AST/StmtVisitor.h>

#include "frontend/clang_limits.hpp"
#include "frontend/lower/aliases.hpp"
#include "frontend/lower/module_lowering.hpp"
#include "frontend/lower/pipeline.hpp"
#include "frontend/tokens/float_literals.hpp"
#include "support/function_ref.hpp"

namespace skc::frontend {

/// Counts one level of nesting during its lifetime.
class Level {
 public:
  explicit Level(int& depth) : depth_(depth) { ++depth_; }
  ~Level() { --depth_; }
  Level(const Level&) = delete;
  Level& operator=(const Level&) = delete;

 private:
  int& depth_;
};

class FunctionLowering : public clang::ConstStmtVisitor<FunctionLowering, ir::ExprPtr> {
 public:
  /// `checks`: the version of a function that checks its assertions. It has one more parameter, an int that becomes the number of
  /// the first assertion that fails, unless it has one already; and it writes no append outputs. All other versions are as if
  /// the assertions were not there.
  explicit FunctionLowering(ModuleLowering& module, bool checks = false) : module_(module), checks_(checks) {}

  /// `aliases`: the version for calls whose references name parts of one object.
  ir::Function function(const clang::FunctionDecl* declaration, const Aliases& aliases = {});
  /// The function of a pass, whose steps call kernels.
  ir::Function pass(const PassSource& source);
  /// True for a member function that returns `S&`, which can only end with `return *this;`. It is void in the
  /// IR, and a call's value is the object.
  static bool returnsThis(const clang::FunctionDecl* declaration);
  /// Lowers an initialiser outside any function; returns null if it has effects.
  ir::ExprPtr constantInitializer(const clang::Expr* init);

  // ---- expressions: one function for each kind that kernels support; others are errors ----------
  ir::ExprPtr VisitParenExpr(const clang::ParenExpr* e);
  ir::ExprPtr VisitConstantExpr(const clang::ConstantExpr* e);
  ir::ExprPtr VisitExprWithCleanups(const clang::ExprWithCleanups* e);
  ir::ExprPtr VisitMaterializeTemporaryExpr(const clang::MaterializeTemporaryExpr* e);
  ir::ExprPtr VisitSubstNonTypeTemplateParmExpr(const clang::SubstNonTypeTemplateParmExpr* e);
  ir::ExprPtr VisitCXXRewrittenBinaryOperator(const clang::CXXRewrittenBinaryOperator* e);
  ir::ExprPtr VisitCXXDefaultArgExpr(const clang::CXXDefaultArgExpr* e);
  ir::ExprPtr VisitCXXDefaultInitExpr(const clang::CXXDefaultInitExpr* e);
  ir::ExprPtr VisitIntegerLiteral(const clang::IntegerLiteral* e);
  ir::ExprPtr VisitFloatingLiteral(const clang::FloatingLiteral* e);
  ir::ExprPtr VisitCXXBoolLiteralExpr(const clang::CXXBoolLiteralExpr* e);
  ir::ExprPtr VisitDeclRefExpr(const clang::DeclRefExpr* e);
  ir::ExprPtr VisitCXXThisExpr(const clang::CXXThisExpr* e);
  ir::ExprPtr VisitCastExpr(const clang::CastExpr* e);
  ir::ExprPtr VisitUnaryOperator(const clang::UnaryOperator* e);
  ir::ExprPtr VisitBinaryOperator(const clang::BinaryOperator* e);
  ir::ExprPtr VisitCompoundAssignOperator(const clang::CompoundAssignOperator* e);
  ir::ExprPtr VisitConditionalOperator(const clang::ConditionalOperator* e);
  ir::ExprPtr VisitExtVectorElementExpr(const clang::ExtVectorElementExpr* e);
  ir::ExprPtr VisitMemberExpr(const clang::MemberExpr* e);
  ir::ExprPtr VisitArrayInitLoopExpr(const clang::ArrayInitLoopExpr* e);
  ir::ExprPtr VisitArraySubscriptExpr(const clang::ArraySubscriptExpr* e);
  ir::ExprPtr VisitInitListExpr(const clang::InitListExpr* e);
  ir::ExprPtr VisitCXXParenListInitExpr(const clang::CXXParenListInitExpr* e);
  ir::ExprPtr VisitImplicitValueInitExpr(const clang::ImplicitValueInitExpr* e);
  ir::ExprPtr VisitCXXScalarValueInitExpr(const clang::CXXScalarValueInitExpr* e);
  ir::ExprPtr VisitCXXConstructExpr(const clang::CXXConstructExpr* e);
  ir::ExprPtr VisitCallExpr(const clang::CallExpr* e);
  ir::ExprPtr VisitCXXOperatorCallExpr(const clang::CXXOperatorCallExpr* e);
  ir::ExprPtr VisitExpr(const clang::Expr* e);
  ir::ExprPtr VisitStmt(const clang::Stmt* s);

 private:
  using Exprs = std::vector<ir::ExprPtr>;

  // ---- statements (lower_stmt.cpp) --------------------------------------------------------------
  void parameters(const clang::FunctionDecl* declaration);
  ir::Variable parameter(const clang::ValueDecl* declared, std::string name);
  void self(const clang::CXXMethodDecl* method);
  void aliasParameters(const Aliases& aliases);
  void body(const clang::Stmt* statement, ir::Block& into);
  void statement(const clang::Stmt* statement);
  bool checkedStatement(const clang::Stmt* statement);  ///< false after an error
  void declaration(const clang::DeclStmt* statement);
  void variable(const clang::VarDecl* declaration);
  bool head(const clang::Stmt* init, const clang::VarDecl* declared, ir::Block& scope);
  void ifStatement(const clang::IfStmt* statement);
  void forStatement(const clang::ForStmt* statement);
  void whileStatement(const clang::WhileStmt* statement);
  void doStatement(const clang::DoStmt* statement);
  void numberCases(ir::Switch& result, Loc loc);
  void switchStatement(const clang::SwitchStmt* statement);
  void returnStatement(const clang::ReturnStmt* statement);
  /// A loop's condition, and the variable that it declares, or null: `while (int left = n - i)`.
  struct LoopTest {
    const clang::VarDecl* variable;
    const clang::Expr* value;
  };
  void loop(ir::LoopKind kind, ir::Block init, LoopTest test, const clang::Expr* step,
            const clang::Stmt* body, clang::SourceLocation where);
  void testInBody(ir::Loop& loop, ir::Block effects, Loc loc);

  // ---- effects (lower_expr.cpp) -----------------------------------------------------------------
  ir::ExprPtr value(const clang::Expr* e);
  void discarded(const clang::Expr* e);
  ir::ExprPtr valueInto(const clang::Expr* e, ir::Block& block, bool asDouble = false);
  static constexpr unsigned allArguments = ~0U;
  /// `asDoubles`: a bit for each expression whose literals are doubles, because another one is a double.
  Exprs valuesInOrder(llvm::ArrayRef<const clang::Expr*> expressions, unsigned asDoubles = 0);
  void spill(ir::ExprPtr& e);
  using Variables = std::vector<ir::VarId>;  ///< in ascending order
  void keepValue(ir::ExprPtr& e, const Variables& changed);
  void keepLocation(ir::ExprPtr& e, const Variables& changed);
  void append(ir::Block effects);
  ir::ExprPtr place(const clang::Expr* e);
  struct Sides {
    ir::ExprPtr target, right;
  };
  Sides sidesOf(const clang::Expr* left, ir::ExprPtr right);
  ir::ExprPtr store(Sides sides, std::optional<ir::BinaryOp> op, Loc loc, bool wantValue);
  void withObject(ir::ExprPtr location, FunctionRef<void(ir::ExprPtr)> use);
  void assign(Sides sides, std::optional<ir::BinaryOp> op, Loc loc);
  ir::ExprPtr assign(const clang::BinaryOperator* e, bool wantValue);
  ir::ExprPtr compoundAssign(const clang::CompoundAssignOperator* e, bool wantValue);
  ir::ExprPtr increment(const clang::UnaryOperator* e, bool wantValue);
  ir::ExprPtr condition(const clang::Expr* e) { return toBool(value(e)); }
  void hoistDeclarations(ir::Block& block);
  void checkDepth(clang::SourceLocation where);
  void emit(Loc loc, ir::Stmt::Node node);
  ir::VarId temporary(ir::Type type, Loc loc);

  // ---- values (lower_value.cpp, lower_literal.cpp) ----------------------------------------------
  ir::ExprPtr make(ir::Type type, clang::SourceLocation where, ir::Expr::Node node);
  ir::ExprPtr read(ir::VarId variable, clang::QualType type, clang::SourceLocation where);
  ir::ExprPtr literal(ir::Type type, std::uint64_t bits, clang::SourceLocation where);
  /// True for an expression of literals only (lower_literal.cpp), whose precision depends on its context.
  bool isLiterals(const clang::Expr* e) const;
  ir::ExprPtr literalsAsDouble(const clang::Expr* e);
  ir::ExprPtr doubleValue(const clang::Expr* e);
  ir::ExprPtr doubleLiteral(const clang::FloatingLiteral* e);
  llvm::APFloat literalValue(const clang::FloatingLiteral* e, const llvm::fltSemantics& semantics,
                             std::string_view type);
  LiteralParts partsOf(const clang::FloatingLiteral* e) const;
  bool isOfContext(const clang::FloatingLiteral* e) const;
  double textValue(const clang::FloatingLiteral* e) const;
  ir::ExprPtr integerConstant(const clang::Expr* e, ir::Type type);
  std::optional<double> integerValue(const clang::Expr* e) const;
  ir::ExprPtr zero(ir::Type type, clang::SourceLocation where);
  ir::ExprPtr convert(ir::ExprPtr e, ir::Scalar scalar);
  ir::ExprPtr splat(ir::ExprPtr e, int width);
  ir::ExprPtr shiftCount(ir::ExprPtr count);
  ir::ExprPtr mask(ir::ExprPtr boolVector);
  ir::ExprPtr toBool(ir::ExprPtr e);
  ir::ExprPtr vectorBitCast(const clang::CastExpr* e);
  ir::ExprPtr logical(const clang::BinaryOperator* e);
  ir::ExprPtr binary(ir::BinaryOp op, ir::ExprPtr lhs, ir::ExprPtr rhs, clang::SourceLocation where);
  ir::ExprPtr select(ir::ExprPtr cond, ir::ExprPtr yes, ir::ExprPtr no, clang::SourceLocation where);
  ir::ExprPtr aggregate(ir::Type type, llvm::ArrayRef<const clang::Expr*> inits, const clang::Expr* filler,
                        clang::SourceLocation where);
  ir::ExprPtr indexed(const clang::Expr* array, const clang::Expr* index, clang::SourceLocation where);
  ir::ExprPtr classValue(ir::Type type, llvm::ArrayRef<const clang::Expr*> args, clang::SourceLocation where);
  ir::ExprPtr matrix(ir::Type type, Exprs parts, clang::SourceLocation where);
  ir::ExprPtr structInSteps(ir::Type type, llvm::ArrayRef<const clang::Expr*> inits,
                            clang::SourceLocation where);
  ir::ExprPtr defaultStruct(const clang::CXXConstructorDecl* constructor, clang::SourceLocation where);
  void fill(Exprs& elements, std::size_t length, FunctionRef<ir::ExprPtr()> element);

  // ---- calls (lower_call.cpp) -------------------------------------------------------------------
  ir::ExprPtr userCall(const clang::CallExpr* e, const clang::FunctionDecl* callee);
  ir::ExprPtr intrinsicCall(const clang::CallExpr* e, const clang::FunctionDecl* callee);
  ir::ExprPtr tableIntrinsic(const clang::CallExpr* e, llvm::StringRef name);
  ir::ExprPtr intrinsic(ir::Intrinsic intrinsic, ir::Type result, clang::SourceLocation where, Exprs args);
  ir::ExprPtr vectorConstructor(const clang::CallExpr* e, ir::Type type);
  ir::ExprPtr outParameterIntrinsic(const clang::CallExpr* e, llvm::StringRef name);
  ir::ExprPtr neighbor(const clang::CallExpr* e);
  ir::ExprPtr sample(const clang::CallExpr* e);
  std::string elementBeside(const clang::ValueDecl* parameter);
  ir::ExprPtr indexOrExtent(const clang::CallExpr* e, bool isIndex);
  ir::StreamRef streamOfIndexOrExtent(const clang::CallExpr* e, bool isIndex);
  ir::ExprPtr axis(const clang::CallExpr* e);
  ir::ExprPtr gatherRead(const clang::CXXOperatorCallExpr* e);
  ir::ExprPtr classOperator(const clang::CXXOperatorCallExpr* e);
  ir::ExprPtr classAssignment(ir::BinaryOp op, const clang::CXXOperatorCallExpr* e);
  /// The base of `a[i][j]`, and the indices in source order.
  struct Subscripts {
    const clang::Expr* object;
    std::vector<const clang::Expr*> written;
    clang::SourceLocation where;
  };
  static Subscripts subscriptsOf(const clang::CXXOperatorCallExpr* e);
  ir::ExprPtr intIndex(ir::ExprPtr index, std::int64_t least = std::numeric_limits<std::int32_t>::min(),
                       std::int64_t most = std::numeric_limits<std::int32_t>::max());
  ir::ExprPtr indexFrom(const Subscripts& subscripts, ir::VarId stream);
  ir::ExprPtr argument(const clang::Expr* e, const ir::Variable& parameter);
  /// True if a reference to `e` refers to an object of the caller, not to a temporary.
  static bool namesObject(const clang::Expr* e);
  struct Argument {
    const clang::Expr* source;
    bool isReference;  ///< bound to an object, not to a copy of its value
    ir::ExprPtr value = nullptr;
    std::optional<ir::VarId> member = {};  ///< the variable, if the parameter is a member of a bundle
  };
  std::vector<Argument> argumentsOf(const clang::CallExpr* e, const clang::FunctionDecl* callee) const;
  ir::ExprPtr memberArgument(ir::VarId member, const clang::Expr* bundle) const;
  void lowerArguments(std::vector<Argument>& arguments, const std::vector<ir::Variable>& parameters,
                      bool rightToLeft);
  void keepWritten(std::vector<Argument>& arguments, const std::vector<ir::Variable>& parameters);
  /// Parameters of a call that may name parts of one object, by their numbers.
  using Group = std::vector<std::uint32_t>;
  std::vector<Group> aliasedGroups(const std::vector<Argument>& arguments, ir::FunctionId callee);
  bool needsBranch(const std::vector<Argument>& arguments, std::size_t i, ir::FunctionId callee) const;
  struct UserCall {
    const clang::FunctionDecl* callee;
    clang::SourceLocation where;
    ir::FunctionId id;
    std::optional<ir::VarId> result;
    bool checks = false;  ///< it is the version that checks assertions
  };
  void emitCall(const UserCall& call, std::vector<Argument> arguments);
  void joinAliases(const Group& group, std::vector<Argument>& arguments, Aliases& aliases);
  ir::Type indexType(std::size_t count, clang::SourceLocation where);
  ir::ExprPtr packed(Exprs indices, clang::SourceLocation where);
  void abandonIfUnknown(const clang::Stmt* s) const;
  std::optional<ir::VarId> variableNamed(const clang::Expr* e) const;
  std::optional<ir::VarId> streamVariable(const clang::Expr* e) const;
  ir::VarId gatherVariable(const clang::Expr* e);

  // ---- append outputs (lower_append.cpp) --------------------------------------------------------
  ir::VarId appendVariable(const clang::Expr* e);
  ir::ExprPtr push(const clang::CallExpr* e);
  /// Lowers the expression if it writes an element of a scatter output; returns whether it does.
  bool scatters(const clang::Expr* e);
  struct ScatterTarget {
    Subscripts subscripts;
    ir::VarId stream;
  };
  std::optional<ScatterTarget> scatterTarget(const clang::Expr* e) const;
  void scatterStore(const ScatterTarget& target, const clang::Expr* left, const clang::Expr* right);
  void scatterCompound(const ScatterTarget& target, const clang::CompoundAssignOperator* e);
  void scatter(const ScatterTarget& target, ir::ScatterOp op, ir::ExprPtr value);
  ir::ExprPtr combinedValue(const ScatterTarget& target, ir::ExprPtr value, clang::SourceLocation where);

  // ---- printf (lower_print.cpp) -----------------------------------------------------------------
  ir::ExprPtr print(const clang::CallExpr* e);
  ir::ExprPtr printed(const clang::Expr* e, ir::ExprPtr value, std::string_view conversion);

  // ---- assertions (lower_assert.cpp) ------------------------------------------------------------
  ir::ExprPtr assertion(const clang::CallExpr* e);
  /// Reports a condition that changes more than its own temporaries, those from `first` on.
  void checkPure(const clang::Expr* condition, const ir::Block& effects, ir::VarId first);
  void addFailed();

  ModuleLowering& module_;
  const bool checks_;
  std::optional<ir::VarId> failed_;  ///< the last parameter of a version that checks assertions
  bool isInCondition_ = false;  ///< of an assertion
  ir::Function function_;
  std::unordered_map<const clang::Decl*, ir::VarId> variables_;
  std::map<Bundles::Place, ir::VarId> members_;  ///< of bundles
  /// The gathers of a pass, by stream and by the kernel's parameter that reads it.
  std::map<std::pair<const clang::VarDecl*, const clang::ParmVarDecl*>, ir::VarId> gathers_;
  std::unordered_set<const clang::Decl*> initialising_;  ///< variables whose initial values are being lowered
  std::unordered_map<ir::VarId, ir::ExprPtr> aliases_;  ///< what parameters name that are parts of others
  std::optional<ir::VarId> this_;
  std::optional<ir::VarId> initialized_;  ///< `this` in the initialisers of its members
  std::unordered_set<ir::VarId> narrowSpecs_;  ///< ints that stand for values of narrow enumerations
  bool returnsThis_ = false;
  ir::Block* out_ = nullptr;  ///< receives statements
  int depth_ = 0;  ///< nesting of expressions and statements
};

}  // namespace skc::frontend
