// SPDX-License-Identifier: MIT
#include "ir/walk.hpp"

#include "support/overloaded.hpp"

namespace skc::ir {

// clang-format off: one node a line

template <MaybeConst<Expr> E>
void forEachOperand(E& expr, Visit<E, ExprPtr> fn) {
  const auto each = [&](auto& list) {
    for (auto& slot : list) fn(slot);
  };
  match(
      expr.node, [](const Literal&) {}, [](const VarRef&) {}, [](const ConstantRef&) {},
      [&](Like<E, Unary>& n) { fn(n.operand); },
      [&](Like<E, Binary>& n) { fn(n.lhs), fn(n.rhs); },
      [&](Like<E, Select>& n) { fn(n.cond), fn(n.yes), fn(n.no); },
      [&](Like<E, Convert>& n) { fn(n.operand); },
      [&](Like<E, Construct>& n) { each(n.args); },
      [&](Like<E, Swizzle>& n) { fn(n.base); },
      [&](Like<E, Member>& n) { fn(n.base); },
      [&](Like<E, Index>& n) { fn(n.base), fn(n.index); },
      [&](Like<E, Call>& n) { each(n.args); },
      [&](Like<E, IntrinsicCall>& n) { each(n.args); },
      [&](Like<E, GatherRead>& n) { fn(n.index); },
      [&](Like<E, NeighborRead>& n) { fn(n.offset); },
      [&](Like<E, Sample>& n) { fn(n.position); },
      [](const IndexOf&) {}, [](const ExtentOf&) {});
}

template <MaybeConst<Stmt> S>
void forEachOperand(S& stmt, Visit<S, ExprPtr> fn) {
  const auto optional = [&](auto& slot) {
    if (slot) fn(slot);
  };
  match(
      stmt.node, [&](Like<S, Declare>& n) { optional(n.init); },
      [&](Like<S, Assign>& n) { fn(n.place), fn(n.value); },
      [&](Like<S, CallStmt>& n) {
        for (auto& arg : n.args) fn(arg);
        optional(n.result);
      },
      [&](Like<S, If>& n) { fn(n.cond); },
      [&](Like<S, Loop>& n) { optional(n.cond); },
      [&](Like<S, Switch>& n) { fn(n.value); },
      [](const Break&) {}, [](const Continue&) {},
      [&](Like<S, Return>& n) { optional(n.value); },
      [](const Scope&) {},
      [&](Like<S, Push>& n) { fn(n.value), optional(n.mask); },
      [&](Like<S, Scatter>& n) { fn(n.index), fn(n.value), optional(n.mask); },
      [&](Like<S, Print>& n) {
        for (auto& value : n.values) fn(value);
        optional(n.mask);
      });
}

template <MaybeConst<Stmt> S>
void forEachBlock(S& stmt, Visit<S, Block> fn) {
  match(
      stmt.node, [](const Declare&) {}, [](const Assign&) {}, [](const CallStmt&) {},
      [&](Like<S, If>& n) { fn(n.then), fn(n.otherwise); },
      [&](Like<S, Loop>& n) { fn(n.init), fn(n.step), fn(n.body); },
      [&](Like<S, Switch>& n) {
        for (auto& one : n.cases) fn(one.body);
      },
      [](const Break&) {}, [](const Continue&) {}, [](const Return&) {},
      [&](Like<S, Scope>& n) { fn(n.body); },
      [](const Push&) {}, [](const Scatter&) {}, [](const Print&) {});
}

namespace {

template <MaybeConst<Expr> E>
Like<E, StreamRef>* streamIn(E& expr) {
  if (auto* n = std::get_if<GatherRead>(&expr.node)) return &n->stream;
  if (auto* n = std::get_if<NeighborRead>(&expr.node)) return &n->stream;
  if (auto* n = std::get_if<Sample>(&expr.node)) return &n->stream;
  if (auto* n = std::get_if<IndexOf>(&expr.node)) return &n->stream;
  if (auto* n = std::get_if<ExtentOf>(&expr.node)) return &n->stream;
  return nullptr;
}

}  // namespace

StreamRef* streamOf(Expr& expr) { return streamIn(expr); }
const StreamRef* streamOf(const Expr& expr) { return streamIn(expr); }

StreamRef* streamOf(Stmt& stmt) {
  if (auto* n = std::get_if<Push>(&stmt.node)) return &n->stream;
  if (auto* n = std::get_if<Scatter>(&stmt.node)) return &n->stream;
  return nullptr;
}

// clang-format on

template <MaybeConst<Block> B>
void walkStmts(B& block, Visit<B, Stmt> fn) {
  for (auto& stmt : block) {
    fn(stmt);
    forEachBlock(stmt, [&](Like<B, Block>& inner) { walkStmts(inner, fn); });
  }
}

template <MaybeConst<Expr> E>
void walkExprs(E& expr, Visit<E, Expr> fn) {
  fn(expr);
  forEachOperand(expr, [&](Like<E, ExprPtr>& slot) { walkExprs<E>(*slot, fn); });
}

template <MaybeConst<Block> B>
void walkExprs(B& block, Visit<B, Expr> fn) {
  walkStmts(block, [&](Like<B, Stmt>& stmt) {
    forEachOperand(stmt, [&](Like<B, ExprPtr>& slot) { walkExprs<Like<B, Expr>>(*slot, fn); });
  });
}

void rewriteExprs(ExprPtr& slot, FunctionRef<void(ExprPtr&)> fn) {
  forEachOperand(*slot, [&](ExprPtr& operand) { rewriteExprs(operand, fn); });
  fn(slot);
}

void rewriteExprs(Block& block, FunctionRef<void(ExprPtr&)> fn) {
  walkStmts(block, [&](Stmt& stmt) { forEachOperand(stmt, [&](ExprPtr& slot) { rewriteExprs(slot, fn); }); });
}

template void forEachOperand(Expr&, Visit<Expr, ExprPtr>);
template void forEachOperand(const Expr&, Visit<const Expr, ExprPtr>);
template void forEachOperand(Stmt&, Visit<Stmt, ExprPtr>);
template void forEachOperand(const Stmt&, Visit<const Stmt, ExprPtr>);
template void forEachBlock(Stmt&, Visit<Stmt, Block>);
template void forEachBlock(const Stmt&, Visit<const Stmt, Block>);
template void walkStmts(Block&, Visit<Block, Stmt>);
template void walkStmts(const Block&, Visit<const Block, Stmt>);
template void walkExprs(Expr&, Visit<Expr, Expr>);
template void walkExprs(const Expr&, Visit<const Expr, Expr>);
template void walkExprs(Block&, Visit<Block, Expr>);
template void walkExprs(const Block&, Visit<const Block, Expr>);

namespace {

/// Visits what declarations hold themselves. Each binding names all members, used or not.
template <class OnType, class OnExpr>
struct Visitor {
  OnType onType;
  OnExpr onExpr;

  void expression(const ExprPtr& expr) {
    if (expr) walkExprs(*expr, onExpr);
  }

  void visit(Constant& constant) {
    auto& [name, type, value, loc] = constant;
    onType(type);
    expression(value);
  }

  void visit(Variable& variable) {
    auto& [name, type, role, rank, isConst, loc] = variable;
    onType(type);
  }

  void visit(Function& function) {
    auto& [name, result, variables, parameterCount, body, loc, table, isLibrary] = function;
    onType(result);
    for (Variable& variable : variables) visit(variable);
    walkExprs(body, onExpr);
  }

  void visit(KernelParam& param) {
    auto& [name, role, type, held, rank, boundary, border, filter, identity, firstPlane, planeCount, loc,
           scatter, pushes, neededIf, reach, reachShapes, promise, range] = param;
    onType(type);
    if (held) onType(*held);
    expression(border);
    expression(identity);
    expression(neededIf);
  }

  void visit(Plan& plan) {
    auto& [limits, temporaries, stacks, passes, cost, costWithoutTemporaries] = plan;
    for (Temporary& temporary : temporaries) {
      auto& [name, type, computeCost, readers] = temporary;
      onType(type);
    }
    for (Stack& stack : stacks) {
      auto& [type, layers] = stack;
      onType(type);
    }
  }

  void visit(Kernel& kernel) {
    auto& [name, scope, signature, entry, params, bundles, reduction, isScan, isSynthesized, isNativeOnly,
           parts, isPart, isOfPipeline, assertions, plans, pass, variants, choices, loops, unrolled, loc] =
        kernel;
    for (KernelParam& param : params) visit(param);
    for (Plan& plan : plans) visit(plan);
  }

  void visit(DeclaredStream& stream) {
    auto& [name, scope, type, extents, loc] = stream;
    onType(type);
  }

  void visit(BundleType& bundle) {
    auto& [name, arguments, scope, members, loc] = bundle;
    for (BundleMember& member : members) {
      auto& [memberName, role, type, rank, inner] = member;
      onType(type);
    }
  }

  void visit(Pipeline& pipeline) {
    auto& [face, locals, passes, isKernel, bytesOfCalls, bytesOfPasses] = pipeline;
    visit(face);
    for (LocalStream& local : locals) {
      auto& [name, type] = local;
      onType(type);
    }
  }

  void visit(Module& module) {
    auto& [file, sources, structs, arrays, constants, functions, tables, kernels, streams, assertions,
           bundleTypes, pipelines] = module;
    for (Constant& constant : constants) visit(constant);
    for (Function& function : functions) visit(function);
    for (Kernel& kernel : kernels) visit(kernel);
    for (DeclaredStream& stream : streams) visit(stream);
    for (BundleType& bundle : bundleTypes) visit(bundle);
    for (Pipeline& pipeline : pipelines) visit(pipeline);
  }
};

}  // namespace

void walkExprs(Module& module, FunctionRef<void(Expr&)> fn) {
  Visitor{[](Type&) {}, fn}.visit(module);
}

void walkTypes(Module& module, FunctionRef<void(Type&)> fn) {
  Visitor{fn, [&](Expr& expr) { fn(expr.type); }}.visit(module);
}

void walkTypesInTypes(Module& module, FunctionRef<void(Type&)> fn) {
  for (Struct& type : module.structs) {
    auto& [name, scope, fields, loc, isSynthesized, aliases] = type;
    for (StructField& field : fields) {
      auto& [fieldName, fieldType] = field;
      fn(fieldType);
    }
  }
  for (Array& array : module.arrays) {
    auto& [element, length] = array;
    fn(element);
  }
}

}  // namespace skc::ir
