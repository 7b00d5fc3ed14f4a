// SPDX-License-Identifier: MIT
//
// Emits a function of the IR into an LLVM function in place of each call: statements here, expressions in
// expression_code.cpp, variables in lvalues.cpp. Control flow must be uniform, which `predicate` ensures; with
// one lane, it always is.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "analysis/uniformity.hpp"
#include "ir/ir.hpp"
#include "native/block_gathers.hpp"
#include "native/intrinsics.hpp"
#include "native/lanes.hpp"
#include "native/leaves.hpp"
#include "native/row_plan.hpp"
#include "native/streams.hpp"
#include "native/unchecked_gathers.hpp"

namespace skc::native {

class DebugInfo;

/// The context that all functions of a kernel share.
struct KernelContext {
  Lanes& lanes;
  const ir::Module& module;
  const ir::Kernel& kernel;
  Streams& streams;
  const analysis::Uniformity* uniformity;  ///< null with one lane
  DebugInfo* debug = nullptr;
};

/// The result of a call, and the final values of its InOut parameters in their order.
struct CallResult {
  Parts result;
  std::vector<Parts> outputs;
};

/// Emits the body of a function at the insertion point, which moves behind it. There is one argument per
/// parameter; those of streams are empty.
CallResult inlineCall(const KernelContext& context, ir::FunctionId function,
                      const std::vector<Parts>& arguments);

/// Likewise emits the kernel's entry for several rows at once, with arguments and results for each row.
/// Afterwards, the first row of the streams is selected.
std::vector<CallResult> inlineRows(const KernelContext& context, const RowPlan& plan,
                                   const std::vector<std::vector<Parts>>& arguments);

/// The value of an expression without variables: a constant, a border value, an identity.
Parts constantParts(const KernelContext& context, const ir::Expr& expr);

// ---- shared by function_code.cpp, expression_code.cpp and lvalues.cpp ---------------------------------

/// The memory of one leaf of a variable; an array if arrays contain the leaf.
struct LeafMemory {
  llvm::Value* memory;
  llvm::Type* element;  ///< a scalar, or a vector of lanes
  ir::Scalar scalar;
  std::vector<std::uint32_t> dimensions;
  analysis::Shape shape;
};

/// An lvalue: leaves of a variable, and how far into their arrays it is.
struct LValue {
  struct Leaf {
    const LeafMemory* memory;
    Part offset;  ///< an int, in elements
    std::size_t dimensions;  ///< number of dimensions indexed so far
  };
  ir::Type type;
  std::vector<Leaf> leaves;
};

class FunctionCode {
 public:
  /// With a `plan`, emits code for several rows.
  FunctionCode(const KernelContext& context, ir::FunctionId function, const RowPlan* plan = nullptr);

  /// Emits the function for each row of arguments.
  std::vector<CallResult> write(const std::vector<std::vector<Parts>>& arguments);
  Parts expression(const ir::Expr& expr);

 private:
  // ---- variables and lvalues (lvalues.cpp)
  void declareAll(std::size_t rows);
  LeafMemory memoryOf(const std::string& name, const Leaf& leaf, analysis::Shape shape) const;
  const std::vector<LeafMemory>& memoryOf(ir::VarId var) const;
  std::optional<LValue> lvalueOf(const ir::Expr& expr);
  LValue variable(ir::VarId var) const;
  Part indexInside(const ir::Expr& index, std::uint32_t length);
  Parts load(const LValue& lvalue);
  void store(const LValue& lvalue, const Parts& value);
  Part loadComponent(const LValue::Leaf& leaf, std::uint32_t offset);
  void storeComponent(const LValue::Leaf& leaf, std::uint32_t offset, const Part& value);
  llvm::Value* addressOf(const LValue::Leaf& leaf, std::uint32_t offset, bool* isScattered);
  void assign(const ir::Expr& lvalue, const Parts& value);
  void assignComponent(const ir::Index& lvalue, const Parts& value);

  // ---- statements (function_code.cpp)
  void block(const ir::Block& statements);
  void write(const ir::Stmt& stmt);
  void writeInEachRow(const ir::Stmt& stmt);
  void selectRow(std::size_t row);
  void write(const ir::Declare& n);
  void write(const ir::Assign& n);
  void write(const ir::CallStmt& n);
  void write(const ir::If& n);
  void write(const ir::Loop& n);
  void iteration(const ir::Loop& n, llvm::BasicBlock* end);
  void writeBlocks(const ir::Loop& n, llvm::BasicBlock* test, llvm::BasicBlock* end);
  void writeIterations(const ir::Loop& n, const std::vector<BlockGather>& gathers,
                       const std::vector<Streams::Block>& blocks, llvm::BasicBlock* end);
  void writeUnchecked(const ir::Loop& n, llvm::BasicBlock* end);
  void writeWalks(const ir::Loop& n, const UncheckedLoop& loop,
                  const std::vector<std::vector<Parts>>& indices, llvm::Value* iterations,
                  llvm::BasicBlock* end);
  void write(const ir::Switch& n);
  void write(const ir::Break& n);
  void write(const ir::Continue& n);
  void write(const ir::Return& n);
  void write(const ir::Scope& n);
  void write(const ir::Push& n);
  void write(const ir::Scatter& n);
  void write(const ir::Print& n);
  llvm::Value* maskOf(const ir::ExprPtr& mask);
  llvm::BasicBlock* newBlock(const char* name) const;
  void branch(llvm::BasicBlock* to);
  void startUnreachable();
  llvm::Value* condition(const ir::Expr& expr);

  // ---- expressions (expression_code.cpp)
  /// The flags for products and sums in the source, unlike those in library functions and conversions.
  llvm::FastMathFlags flagsOfText() const;
  Parts shared(const ir::Expr& expr);
  Parts arithmetic(ir::BinaryOp op, ir::Type type, ir::Type left, const Parts& lhs, ir::Type right,
                   const Parts& rhs);
  Parts parts(const ir::Expr& expr, const ir::Literal& n);
  Parts parts(const ir::Expr& expr, const ir::VarRef& n);
  Parts parts(const ir::Expr& expr, const ir::ConstantRef& n);
  Parts parts(const ir::Expr& expr, const ir::Unary& n);
  Parts parts(const ir::Expr& expr, const ir::Binary& n);
  Parts parts(const ir::Expr& expr, const ir::Select& n);
  Parts parts(const ir::Expr& expr, const ir::Convert& n);
  Parts parts(const ir::Expr& expr, const ir::Construct& n);
  Parts parts(const ir::Expr& expr, const ir::Swizzle& n);
  Parts parts(const ir::Expr& expr, const ir::Member& n);
  Parts parts(const ir::Expr& expr, const ir::Index& n);
  Parts parts(const ir::Expr& expr, const ir::Call& n);
  Parts parts(const ir::Expr& expr, const ir::IntrinsicCall& n);
  Parts smallPower(const Parts& base, int exponent);
  Parts parts(const ir::Expr& expr, const ir::GatherRead& n);
  Parts parts(const ir::Expr& expr, const ir::NeighborRead& n);
  Parts parts(const ir::Expr& expr, const ir::Sample& n);
  Parts parts(const ir::Expr& expr, const ir::IndexOf& n);
  Parts parts(const ir::Expr& expr, const ir::ExtentOf& n);
  Parts matrixProduct(const Parts& a, const Parts& c, std::size_t width, bool isVector);
  std::vector<Parts> expressions(const std::vector<ir::ExprPtr>& list);
  /// Branches on a uniform condition.
  Parts either(llvm::Value* condition, const std::function<Parts()>& yes, const std::function<Parts()>& no);
  bool isCostly(const ir::Expr& expr) const;
  Parts lookUp(ir::FunctionId function, const Parts& argument);
  Part tableValue(llvm::Value* table, const Part& argument);

  const KernelContext& k;
  Lanes& l;
  llvm::IRBuilder<>& b;
  const ir::Function& function_;
  ir::FunctionId id_;
  const RowPlan* plan_;
  std::size_t row_ = 0;  ///< the row that code is emitted for
  bool isInAllRows_;  ///< all rows execute the statement that is emitted
  /// While a statement is emitted in each row: what the first row has read for all of them.
  std::optional<std::map<const ir::Expr*, Parts>> shared_;
  /// The values of gathers in the current iteration of a block (block_gathers.hpp).
  std::map<const ir::Expr*, Parts> fromBlocks_;
  /// The gathers that the current loop reads without tests, in each row or, if rows share them, in the first.
  std::map<const ir::Expr*, std::vector<Streams::Walk>> walks_;
  llvm::Value* iteration_ = nullptr;  ///< of that loop
  /// By row and variable. Rows after the first have only the variables that differ between rows.
  std::vector<std::vector<std::vector<LeafMemory>>> variables_;
  std::vector<LeafMemory> result_;
  llvm::BasicBlock* exit_ = nullptr;
  /// The targets of `break` and `continue`. In a Switch, `next` is that of the loop around it.
  struct Target {
    llvm::BasicBlock* end;
    llvm::BasicBlock* next;
  };
  std::vector<Target> targets_;
};

}  // namespace skc::native
