// SPDX-License-Identifier: MIT
#include "native/function_code.hpp"

#include <llvm/IR/Constants.h>

#include "ir/build.hpp"
#include "native/arithmetic.hpp"
#include "native/debug_info.hpp"
#include "support/overloaded.hpp"

namespace skc::native {

using namespace ir;

CallResult inlineCall(const KernelContext& context, FunctionId function,
                      const std::vector<Parts>& arguments) {
  return FunctionCode(context, function).write(arguments);
}

Parts constantParts(const KernelContext& context, const Expr& expr) {
  return FunctionCode(context, context.kernel.entry).expression(expr);
}

FunctionCode::FunctionCode(const KernelContext& context, FunctionId function)
    : k(context),
      l(context.lanes),
      b(context.lanes.b),
      function_(context.module.functions[function]),
      id_(function) {}

CallResult FunctionCode::write(const std::vector<Parts>& arguments) {
  const DebugScope scope(k.debug, b, function_);
  declareAll();
  exit_ = newBlock("return");
  for (VarId i = 0; i < function_.parameterCount; ++i) {
    if (!variables_[i].empty()) store(variable(i), arguments[i]);
  }
  block(function_.body);
  branch(exit_);
  b.SetInsertPoint(exit_);
  CallResult called;
  Place result{function_.result, {}};
  for (const LeafMemory& memory : result_) result.leaves.push_back({&memory, {l.integer(l.int32(), 0)}, 0});
  called.result = load(result);
  for (VarId i = 0; i < function_.parameterCount; ++i) {
    if (function_.variables[i].role == VarRole::InOut) called.outputs.push_back(load(variable(i)));
  }
  return called;
}

// ---- statements -----------------------------------------------------------------------------------

llvm::BasicBlock* FunctionCode::newBlock(const char* name) const {
  return llvm::BasicBlock::Create(b.getContext(), name, b.GetInsertBlock()->getParent());
}

void FunctionCode::branch(llvm::BasicBlock* to) { b.CreateBr(to); }

/// What follows a jump is never reached.
void FunctionCode::startUnreachable() { b.SetInsertPoint(newBlock("unreachable")); }

void FunctionCode::block(const Block& statements) {
  for (const Stmt& stmt : statements) {
    if (k.debug != nullptr) k.debug->moveTo(b, stmt.loc);
    match(stmt.node, [&](const auto& node) { write(node); });
  }
}

llvm::Value* FunctionCode::condition(const Expr& expr) { return expression(expr)[0].value; }

void FunctionCode::write(const Declare& n) {
  const Place place = variable(n.var);
  if (n.init) return store(place, expression(*n.init));
  Parts zero;
  for (const Scalar scalar : scalarsOf(k.module, place.type)) {
    zero.push_back({llvm::Constant::getNullValue(l.type(scalar))});
  }
  store(place, zero);
}

void FunctionCode::write(const Assign& n) {
  if (!n.op) return assign(*n.place, expression(*n.value));
  const ExprPtr combined = ir::binary(*n.op, clone(*n.place), clone(*n.value), n.place->loc);
  assign(*n.place, expression(*combined));
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

void FunctionCode::write(const Loop& n) {
  block(n.init);
  llvm::BasicBlock* const test = newBlock("loop");
  llvm::BasicBlock* const body = newBlock("body");
  llvm::BasicBlock* const step = newBlock("step");
  llvm::BasicBlock* const end = newBlock("endloop");
  branch(n.kind == LoopKind::DoWhile ? body : test);
  b.SetInsertPoint(test);
  if (n.cond) {
    b.CreateCondBr(condition(*n.cond), body, end);
  } else {
    branch(body);
  }
  b.SetInsertPoint(body);
  targets_.push_back({end, step});
  block(n.body);
  targets_.pop_back();
  branch(step);
  b.SetInsertPoint(step);
  block(n.step);
  branch(test);
  b.SetInsertPoint(end);
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
    Place result{function_.result, {}};
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

/// The lanes in which a statement runs: all where there is no mask.
llvm::Value* FunctionCode::maskOf(const ExprPtr& mask) {
  return l.spread(mask ? expression(*mask)[0] : Part{b.getTrue()});
}

}  // namespace skc::native
