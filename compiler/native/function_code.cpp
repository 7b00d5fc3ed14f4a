// SPDX-License-Identifier: MIT
#include "native/function_code.hpp"

#include <algorithm>
#include <utility>

#include <llvm/IR/Constants.h>
#include <llvm/IR/MDBuilder.h>

#include "ir/build.hpp"
#include "native/arithmetic.hpp"
#include "native/debug_info.hpp"
#include "support/overloaded.hpp"

namespace skc::native {

using namespace ir;

namespace {

/// True if a condition is `uniform && AnyLane(mask)`.
bool endsInAnyLane(const Expr& condition) {
  const auto* const both = std::get_if<Binary>(&condition.node);
  if (both == nullptr || both->op != BinaryOp::LogicalAnd) return false;
  const auto* const any = std::get_if<IntrinsicCall>(&both->rhs->node);
  return any != nullptr && any->intrinsic == Intrinsic::AnyLane;
}

}  // namespace

CallResult inlineCall(const KernelContext& context, FunctionId function,
                      const std::vector<Parts>& arguments) {
  return FunctionCode(context, function).write({arguments}).front();
}

std::vector<CallResult> inlineRows(const KernelContext& context, const RowPlan& plan,
                                   const std::vector<std::vector<Parts>>& arguments) {
  return FunctionCode(context, context.kernel.entry, &plan).write(arguments);
}

Parts constantParts(const KernelContext& context, const Expr& expr) {
  return FunctionCode(context, context.kernel.entry).expression(expr);
}

FunctionCode::FunctionCode(const KernelContext& context, FunctionId function, const RowPlan* plan)
    : k(context),
      l(context.lanes),
      b(context.lanes.b),
      function_(context.module.functions[function]),
      id_(function),
      plan_(plan),
      isInAllRows_(plan != nullptr) {}

std::vector<CallResult> FunctionCode::write(const std::vector<std::vector<Parts>>& arguments) {
  const DebugScope scope(k.debug, b, function_);
  const std::size_t rows = arguments.size();
  declareAll(rows);
  exit_ = newBlock("return");
  for (std::size_t row = 0; row < rows; ++row) {
    selectRow(row);
    for (VarId i = 0; i < function_.parameterCount; ++i) {
      if (!variables_[0][i].empty()) store(variable(i), arguments[row][i]);
    }
  }
  selectRow(0);
  block(function_.body);
  branch(exit_);
  b.SetInsertPoint(exit_);
  std::vector<CallResult> called(rows);
  for (std::size_t row = 0; row < rows; ++row) {
    selectRow(row);
    LValue result{function_.result, {}};
    for (const LeafMemory& memory : result_) result.leaves.push_back({&memory, {l.integer(l.int32(), 0)}, 0});
    called[row].result = load(result);
    for (VarId i = 0; i < function_.parameterCount; ++i) {
      if (function_.variables[i].role == VarRole::InOut) called[row].outputs.push_back(load(variable(i)));
    }
  }
  selectRow(0);
  return called;
}

/// Does nothing in functions that the entry calls: they are emitted for the row that calls them.
void FunctionCode::selectRow(std::size_t row) {
  if (plan_ == nullptr) return;
  row_ = row;
  k.streams.selectRow(row);
}

// ---- statements -----------------------------------------------------------------------------------

llvm::BasicBlock* FunctionCode::newBlock(const char* name) const {
  return llvm::BasicBlock::Create(b.getContext(), name, b.GetInsertBlock()->getParent());
}

void FunctionCode::branch(llvm::BasicBlock* to) { b.CreateBr(to); }

/// Starts a block for the statements after a jump, which never run.
void FunctionCode::startUnreachable() { b.SetInsertPoint(newBlock("unreachable")); }

void FunctionCode::block(const Block& statements) {
  for (const Stmt& stmt : statements) {
    if (k.debug != nullptr) k.debug->moveTo(b, stmt.loc);
    write(stmt);
  }
}

void FunctionCode::write(const Stmt& stmt) {
  if (isInAllRows_ && !plan_->isEmittedOnce(stmt)) return writeInEachRow(stmt);
  match(stmt.node, [&](const auto& node) { write(node); });
}

/// Emits a statement once per row. Rows share reads only in statements without control flow.
void FunctionCode::writeInEachRow(const Stmt& stmt) {
  const bool branches = std::holds_alternative<If>(stmt.node) || std::holds_alternative<Loop>(stmt.node) ||
                        std::holds_alternative<Switch>(stmt.node);
  isInAllRows_ = false;
  if (!branches) shared_.emplace();
  for (std::size_t row = 0; row < variables_.size(); ++row) {
    selectRow(row);
    match(stmt.node, [&](const auto& node) { write(node); });
  }
  shared_.reset();
  isInAllRows_ = true;
  selectRow(0);
}

llvm::Value* FunctionCode::condition(const Expr& expr) { return expression(expr)[0].value; }

void FunctionCode::write(const Declare& n) {
  const LValue lvalue = variable(n.var);
  if (n.init) return store(lvalue, expression(*n.init));
  Parts zero;
  for (const Scalar scalar : scalarsOf(k.module, lvalue.type)) {
    zero.push_back({llvm::Constant::getNullValue(l.type(scalar))});
  }
  store(lvalue, zero);
}

void FunctionCode::write(const Assign& n) {
  if (!n.op) return assign(*n.place, expression(*n.value));
  const Type type = n.place->type;
  assign(*n.place, arithmetic(*n.op, type, type, expression(*n.place), n.value->type, expression(*n.value)));
}

void FunctionCode::write(const CallStmt& n) {
  const CallResult called = inlineCall(k, n.callee, expressions(n.args));
  if (n.result) assign(*n.result, called.result);
  const Function& callee = k.module.functions[n.callee];
  std::size_t next = 0;
  for (std::size_t i = 0; i < n.args.size(); ++i) {
    if (callee.variables[i].role == VarRole::InOut) assign(*n.args[i], called.outputs[next++]);
  }
}

void FunctionCode::write(const If& n) {
  llvm::BasicBlock* const then = newBlock("then");
  llvm::BasicBlock* const end = newBlock("endif");
  llvm::BasicBlock* const otherwise = n.otherwise.empty() ? end : newBlock("else");
  b.CreateCondBr(condition(*n.cond), then, otherwise);
  b.SetInsertPoint(then);
  block(n.then);
  branch(end);
  if (otherwise != end) {
    b.SetInsertPoint(otherwise);
    block(n.otherwise);
    branch(end);
  }
  b.SetInsertPoint(end);
}

/// Emits the body and the step of a loop.
void FunctionCode::iteration(const Loop& n, llvm::BasicBlock* end) {
  llvm::BasicBlock* const step = newBlock("step");
  targets_.push_back({end, step});
  block(n.body);
  targets_.pop_back();
  branch(step);
  b.SetInsertPoint(step);
  block(n.step);
}

void FunctionCode::write(const Loop& n) {
  block(n.init);
  llvm::BasicBlock* const test = newBlock("loop");
  llvm::BasicBlock* const body = newBlock("body");
  llvm::BasicBlock* const end = newBlock("endloop");
  writeUnchecked(n, end);
  branch(n.kind == LoopKind::DoWhile ? body : test);
  b.SetInsertPoint(test);
  if (n.cond) {
    llvm::BranchInst* const jump = b.CreateCondBr(condition(*n.cond), body, end);
    // without this, LLVM makes two jumps of `count < most && AnyLane(live)`, and tests the lanes' words one by one
    if (endsInAnyLane(*n.cond))
      jump->setMetadata(llvm::LLVMContext::MD_unpredictable, llvm::MDNode::get(b.getContext(), {}));
  } else {
    branch(body);
  }
  b.SetInsertPoint(body);
  writeBlocks(n, test, end);
  iteration(n, end);
  branch(test);
  b.SetInsertPoint(end);
}

/// If gathers of the loop can be read in blocks, emits code that does so while the elements of a block are in
/// bounds, and then continues at `test`. Afterwards, the insertion point is where they are not.
void FunctionCode::writeBlocks(const Loop& n, llvm::BasicBlock* test, llvm::BasicBlock* end) {
  if (l.options().blockWidth == 0 || plan_ != nullptr) return;
  const std::vector<BlockGather> gathers = blockGathers(k.module, k.kernel, *k.uniformity, id_, n);
  if (gathers.empty()) return;
  llvm::Value* const counter = expression(*std::get<Assign>(n.step.front().node).place)[0].value;
  llvm::Value* areInside = b.CreateICmpSGE(counter, l.integer(l.int32(), 0));
  std::vector<Parts> indices;
  for (const BlockGather& gather : gathers) {
    indices.push_back(expression(*gather.index));
    areInside = b.CreateAnd(areInside, k.streams.isBlockInside(gather.stream(), indices.back()));
  }
  llvm::BasicBlock* const inside = newBlock("block");
  llvm::BasicBlock* const outside = newBlock("one");
  b.CreateCondBr(areInside, inside, outside);
  b.SetInsertPoint(inside);
  std::vector<Streams::Block> blocks;
  for (std::size_t g = 0; g < gathers.size(); ++g)
    blocks.push_back(k.streams.readBlock(gathers[g].stream(), indices[g], counter));
  writeIterations(n, gathers, blocks, end);
  branch(test);
  b.SetInsertPoint(outside);
}

/// Emits the iterations of a block, which end early if the loop does.
void FunctionCode::writeIterations(const Loop& n, const std::vector<BlockGather>& gathers,
                                   const std::vector<Streams::Block>& blocks, llvm::BasicBlock* end) {
  llvm::BasicBlock* const before = b.GetInsertBlock();
  llvm::BasicBlock* const body = newBlock("body");
  llvm::BasicBlock* const next = newBlock("next");
  llvm::BasicBlock* const done = newBlock("endblock");
  branch(body);
  b.SetInsertPoint(body);
  llvm::PHINode* const number = b.CreatePHI(l.int64(), 2);
  number->addIncoming(l.integer(l.int64(), 0), before);
  for (std::size_t g = 0; g < gathers.size(); ++g)
    fromBlocks_[gathers[g].read] = k.streams.elementOf(blocks[g], number);
  iteration(n, end);
  fromBlocks_.clear();
  llvm::Value* const following = b.CreateAdd(number, l.integer(l.int64(), 1));
  b.CreateCondBr(b.CreateICmpULT(following, l.integer(l.int64(), Streams::blockLength)), next, done);
  b.SetInsertPoint(next);
  llvm::Value* const goesOn = n.cond ? condition(*n.cond) : b.getTrue();
  number->addIncoming(following, b.GetInsertBlock());
  b.CreateCondBr(goesOn, body, end);
  b.SetInsertPoint(done);
}

/// If all rows run through a loop together, and the indices of gathers can be tested before it, emits code that does so and
/// the loop without tests. Afterwards, the insertion point is where some index is out of bounds.
void FunctionCode::writeUnchecked(const Loop& n, llvm::BasicBlock* end) {
  if (plan_ == nullptr || !isInAllRows_) return;
  UncheckedLoop loop = uncheckedGathers(k.module, *k.uniformity, id_, n);
  if (loop.gathers.empty()) return;
  const auto isSigned = loop.counter->type.scalar == Scalar::Int;
  const auto wide = [&](const Expr& expr) {
    llvm::Value* const value = expression(expr)[0].value;
    return isSigned ? b.CreateSExt(value, l.int64()) : b.CreateZExt(value, l.int64());
  };
  llvm::Value* iterations = b.CreateSub(wide(*loop.limit), wide(*loop.counter));
  if (loop.includesLimit) iterations = b.CreateAdd(iterations, l.integer(l.int64(), 1));
  llvm::Value* areInside = b.CreateICmpSGT(iterations, l.integer(l.int64(), 0));
  std::vector<std::vector<Parts>> indices;
  std::erase_if(loop.gathers, [&](const UncheckedGather& gather) {
    std::vector<Parts> ofRows;
    for (std::size_t row = 0; row < (plan_->isShared(*gather.read) ? 1 : variables_.size()); ++row) {
      selectRow(row);
      ofRows.push_back(expression(*gather.index));
      const Parts& index = ofRows.back();
      if (l.isVarying(index[0]) ||
          !std::all_of(index.begin() + 1, index.end(), [&](const Part& part) { return l.isUniform(part); }))
        return true;
      areInside =
          b.CreateAnd(areInside, k.streams.isWalkInside(gather.stream(), index, gather.grows, iterations));
    }
    indices.push_back(std::move(ofRows));
    return false;
  });
  selectRow(0);
  if (loop.gathers.empty()) return;
  llvm::BasicBlock* const inside = newBlock("unchecked");
  llvm::BasicBlock* const outside = newBlock("checked");
  // so that values of the loop without tests stay in registers
  b.CreateCondBr(areInside, inside, outside, llvm::MDBuilder(b.getContext()).createLikelyBranchWeights());
  b.SetInsertPoint(inside);
  writeWalks(n, loop, indices, iterations, end);
  b.SetInsertPoint(outside);
}

/// Emits a loop of at least one iteration, which reads gathers without tests.
void FunctionCode::writeWalks(const Loop& n, const UncheckedLoop& loop,
                              const std::vector<std::vector<Parts>>& indices, llvm::Value* iterations,
                              llvm::BasicBlock* end) {
  for (std::size_t g = 0; g < loop.gathers.size(); ++g) {
    const UncheckedGather& gather = loop.gathers[g];
    for (const Parts& index : indices[g])
      walks_[gather.read].push_back(k.streams.walk(gather.stream(), index, gather.grows));
  }
  llvm::BasicBlock* const before = b.GetInsertBlock();
  llvm::BasicBlock* const body = newBlock("body");
  branch(body);
  b.SetInsertPoint(body);
  llvm::PHINode* const number = b.CreatePHI(l.int64(), 2);
  number->addIncoming(l.integer(l.int64(), 0), before);
  iteration_ = number;
  iteration(n, end);
  walks_.clear();
  llvm::Value* const next = b.CreateAdd(number, l.integer(l.int64(), 1));
  number->addIncoming(next, b.GetInsertBlock());
  b.CreateCondBr(b.CreateICmpEQ(next, iterations), end, body);
}

void FunctionCode::write(const Switch& n) {
  llvm::BasicBlock* const end = newBlock("endswitch");
  llvm::SwitchInst* const jump = b.CreateSwitch(condition(*n.value), end);
  std::vector<llvm::BasicBlock*> blocks;
  for (const Case& one : n.cases) {
    blocks.push_back(newBlock("case"));
    if (one.isDefault) jump->setDefaultDest(blocks.back());
    for (const std::int64_t value : one.values) {
      jump->addCase(b.getInt32(static_cast<std::uint32_t>(value)), blocks.back());
    }
  }
  targets_.push_back({end, targets_.empty() ? nullptr : targets_.back().next});
  for (std::size_t i = 0; i < n.cases.size(); ++i) {
    b.SetInsertPoint(blocks[i]);
    block(n.cases[i].body);
    branch(i + 1 < blocks.size() ? blocks[i + 1] : end);
  }
  targets_.pop_back();
  b.SetInsertPoint(end);
}

void FunctionCode::write(const Break&) {
  branch(targets_.back().end);
  startUnreachable();
}
void FunctionCode::write(const Continue&) {
  branch(targets_.back().next);
  startUnreachable();
}

void FunctionCode::write(const Return& n) {
  if (n.value) {
    LValue result{function_.result, {}};
    for (const LeafMemory& memory : result_) result.leaves.push_back({&memory, {l.integer(l.int32(), 0)}, 0});
    store(result, expression(*n.value));
  }
  branch(exit_);
  startUnreachable();
}

void FunctionCode::write(const Scope& n) { block(n.body); }

void FunctionCode::write(const Push& n) {
  const Parts value = expression(*n.value);
  k.streams.push(n.stream.id, value, maskOf(n.mask));
}

void FunctionCode::write(const Scatter& n) {
  const Parts index = expression(*n.index);
  const Parts value = expression(*n.value);
  k.streams.scatter(n.stream.id, index, value, maskOf(n.mask));
}

/// The lanes in which a statement runs; all lanes without a mask.
llvm::Value* FunctionCode::maskOf(const ExprPtr& mask) {
  return l.broadcast(mask ? expression(*mask)[0] : Part{b.getTrue()});
}

}  // namespace skc::native
