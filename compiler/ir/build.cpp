// SPDX-License-Identifier: MIT
#include "ir/build.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <iterator>
#include <utility>

#include "ir/operators.hpp"
#include "support/overloaded.hpp"

namespace skc::ir {

// ---- expressions ------------------------------------------------------------------------------

ExprPtr makeExpr(Type type, Expr::Node node, Loc loc) {
  return std::make_unique<Expr>(Expr{type, loc, std::move(node)});
}

ExprPtr literal(float value, Loc loc) {
  return makeExpr(Type::of(Scalar::Float), Literal{std::bit_cast<std::uint32_t>(value)}, loc);
}
ExprPtr literal(double value, Loc loc) {
  return makeExpr(Type::of(Scalar::Double), Literal::wide(std::bit_cast<std::uint64_t>(value)), loc);
}
ExprPtr literal(std::int64_t value, Loc loc) {
  return makeExpr(Type::of(Scalar::Long), Literal::wide(static_cast<std::uint64_t>(value)), loc);
}
ExprPtr literal(std::uint64_t value, Loc loc) {
  return makeExpr(Type::of(Scalar::Ulong), Literal::wide(value), loc);
}
ExprPtr literal(std::int32_t value, Loc loc) {
  return makeExpr(Type::of(Scalar::Int), Literal{static_cast<std::uint32_t>(value)}, loc);
}
ExprPtr literal(std::uint32_t value, Loc loc) {
  return makeExpr(Type::of(Scalar::Uint), Literal{value}, loc);
}
ExprPtr literal(bool value, Loc loc) {
  return makeExpr(Type::of(Scalar::Bool), Literal{value ? 1U : 0U}, loc);
}

ExprPtr literal(float value, double text, Loc loc) {
  assert(std::isnan(text) || std::signbit(value) == std::signbit(text));
  ExprPtr result = literal(value, loc);
  std::get<Literal>(result->node).text = std::fabs(text);
  return result;
}

double wideValue(const Literal& literal) {
  const auto value = std::bit_cast<float>(literal.bits);
  return literal.text == 0 ? double{value} : std::copysign(literal.text, value);
}

ExprPtr literalOf(Type type, int value, Loc loc) {
  if (type.isVector()) return construct(type, exprs(literalOf(type.component(), value, loc)), loc);
  if (type.scalar == Scalar::Bool) return literal(value != 0, loc);
  if (type.scalar == Scalar::Uint) return literal(static_cast<std::uint32_t>(value), loc);
  if (type.scalar == Scalar::Double) return literal(static_cast<double>(value), loc);
  if (type.scalar == Scalar::Long) return literal(std::int64_t{value}, loc);
  if (type.scalar == Scalar::Ulong) return literal(static_cast<std::uint64_t>(value), loc);
  const bool isInt = arithmeticScalar(type.scalar) == Scalar::Int;
  ExprPtr result = isInt ? literal(std::int32_t{value}, loc) : literal(static_cast<float>(value), loc);
  result->type = type;
  return result;
}

ExprPtr varRef(const Function& function, VarId var, Loc loc) {
  return makeExpr(function.variables[var].type, VarRef{var}, loc);
}

ExprPtr constantRef(const Module& module, ConstantId constant, Loc loc) {
  return makeExpr(module.constants[constant].type, ConstantRef{constant}, loc);
}

ExprPtr unary(UnaryOp op, ExprPtr operand, Loc loc) {
  const Type type = operand->type;
  return makeExpr(type, Unary{op, std::move(operand)}, loc);
}

Type binaryType(BinaryOp op, Type lhs, Type rhs) {
  if (lhs.isMatrix() && rhs.isVector()) return rhs;
  if (rhs.isMatrix() && !isComparison(op)) return rhs;
  if (isComparison(op)) return lhs.isVector() ? lhs.withScalar(Scalar::Bool) : Type::of(Scalar::Bool);
  if (op == BinaryOp::ShiftLeft || op == BinaryOp::ShiftRight) return lhs;
  return rhs.isVector() ? rhs : lhs;
}

ExprPtr binary(BinaryOp op, ExprPtr lhs, ExprPtr rhs, Loc loc) {
  const Type type = binaryType(op, lhs->type, rhs->type);
  return makeExpr(type, Binary{op, std::move(lhs), std::move(rhs)}, loc);
}

ExprPtr select(ExprPtr cond, ExprPtr yes, ExprPtr no, Loc loc) {
  const Type type = yes->type;
  return makeExpr(type, Select{std::move(cond), std::move(yes), std::move(no)}, loc);
}

ExprPtr convert(Scalar scalar, ExprPtr operand, Loc loc) {
  const Type type = operand->type.withScalar(scalar);
  if (type == operand->type) return operand;
  return makeExpr(type, Convert{std::move(operand)}, loc);
}

ExprPtr construct(Type type, std::vector<ExprPtr> args, Loc loc) {
  return makeExpr(type, Construct{std::move(args)}, loc);
}

ExprPtr swizzle(ExprPtr base, std::string_view components, Loc loc) {
  constexpr std::string_view names = "xyzwrgbastpq";
  std::vector<std::uint8_t> numbers;
  for (char name : components) {
    assert(names.find(name) != std::string_view::npos);
    numbers.push_back(static_cast<std::uint8_t>(names.find(name) % 4));
  }
  return swizzle(std::move(base), std::move(numbers), loc);
}

ExprPtr swizzle(ExprPtr base, std::vector<std::uint8_t> components, Loc loc) {
  const Type type = Type::of(base->type.scalar, static_cast<int>(components.size()));
  return makeExpr(type, Swizzle{std::move(base), std::move(components)}, loc);
}

ExprPtr member(const Module& module, ExprPtr base, std::uint32_t field, Loc loc) {
  const Type type = module.structs[base->type.index].fields[field].type;
  return makeExpr(type, Member{std::move(base), field}, loc);
}

ExprPtr member(const Module& module, ExprPtr base, const std::vector<std::uint32_t>& path, Loc loc) {
  for (const std::uint32_t field : path) base = member(module, std::move(base), field, loc);
  return base;
}

ExprPtr index(const Module& module, ExprPtr base, ExprPtr index, Loc loc) {
  const bool isArray = base->type.kind == Type::Kind::Array;
  const Type type = isArray ? module.arrays[base->type.index].element : base->type.indexed();
  return makeExpr(type, Index{std::move(base), std::move(index)}, loc);
}

ExprPtr call(const Module& module, FunctionId callee, std::vector<ExprPtr> args, Loc loc) {
  return makeExpr(module.functions[callee].result, Call{callee, std::move(args)}, loc);
}

ExprPtr intrinsic(Intrinsic intrinsic, std::vector<ExprPtr> args, Loc loc) {
  std::vector<Type> types;
  for (const ExprPtr& arg : args) types.push_back(arg->type);
  const std::optional<Type> type = resultType(intrinsic, types);
  assert(type && "the arguments match no signature of the intrinsic");
  return makeExpr(type.value_or(Type::voidType()), IntrinsicCall{intrinsic, std::move(args)}, loc);
}

ExprPtr gatherRead(Type element, StreamRef stream, ExprPtr index, Loc loc) {
  return makeExpr(element, GatherRead{stream, std::move(index)}, loc);
}
ExprPtr neighborRead(Type element, StreamRef stream, ExprPtr offset, Loc loc) {
  return makeExpr(element, NeighborRead{stream, std::move(offset)}, loc);
}
ExprPtr indexOf(StreamRef stream, Loc loc) {
  return makeExpr(Type::of(Scalar::Int, 4), IndexOf{stream}, loc);
}
ExprPtr extentOf(StreamRef stream, Loc loc) {
  return makeExpr(Type::of(Scalar::Int, 4), ExtentOf{stream}, loc);
}

VarId rootOf(const Expr& place) {
  if (const auto* n = std::get_if<Member>(&place.node)) return rootOf(*n->base);
  if (const auto* n = std::get_if<Index>(&place.node)) return rootOf(*n->base);
  if (const auto* n = std::get_if<Swizzle>(&place.node)) return rootOf(*n->base);
  return std::get<VarRef>(place.node).var;
}

namespace {

std::vector<ExprPtr> cloneAll(const std::vector<ExprPtr>& list) {
  std::vector<ExprPtr> copy;
  copy.reserve(list.size());
  for (const ExprPtr& expr : list) copy.push_back(clone(expr));
  return copy;
}

Expr::Node cloneNode(const Expr::Node& node) {
  using N = Expr::Node;
  return match(
      node, [](const Literal& n) -> N { return n; }, [](const VarRef& n) -> N { return n; },
      [](const ConstantRef& n) -> N { return n; },
      [](const Unary& n) -> N { return Unary{n.op, clone(n.operand)}; },
      [](const Binary& n) -> N { return Binary{n.op, clone(n.lhs), clone(n.rhs)}; },
      [](const Select& n) -> N { return Select{clone(n.cond), clone(n.yes), clone(n.no)}; },
      [](const Convert& n) -> N { return Convert{clone(n.operand)}; },
      [](const Construct& n) -> N { return Construct{cloneAll(n.args)}; },
      [](const Swizzle& n) -> N { return Swizzle{clone(n.base), n.components}; },
      [](const Member& n) -> N { return Member{clone(n.base), n.field}; },
      [](const Index& n) -> N { return Index{clone(n.base), clone(n.index)}; },
      [](const Call& n) -> N { return Call{n.callee, cloneAll(n.args)}; },
      [](const IntrinsicCall& n) -> N { return IntrinsicCall{n.intrinsic, cloneAll(n.args)}; },
      [](const GatherRead& n) -> N { return GatherRead{n.stream, clone(n.index)}; },
      [](const NeighborRead& n) -> N { return NeighborRead{n.stream, clone(n.offset)}; },
      [](const Sample& n) -> N { return Sample{n.stream, clone(n.position)}; },
      [](const IndexOf& n) -> N { return n; }, [](const ExtentOf& n) -> N { return n; });
}

Stmt::Node cloneNode(const Stmt::Node& node) {
  using N = Stmt::Node;
  return match(
      node, [](const Declare& n) -> N { return Declare{n.var, clone(n.init)}; },
      [](const Assign& n) -> N { return Assign{clone(n.place), n.op, clone(n.value)}; },
      [](const CallStmt& n) -> N { return CallStmt{n.callee, cloneAll(n.args), clone(n.result)}; },
      [](const If& n) -> N { return If{clone(n.cond), clone(n.then), clone(n.otherwise)}; },
      [](const Loop& n) -> N {
        return Loop{n.kind, clone(n.init), clone(n.cond), clone(n.step), clone(n.body)};
      },
      [](const Switch& n) -> N {
        Switch copy{clone(n.value), {}};
        for (const Case& one : n.cases)
          copy.cases.push_back({one.values, one.isDefault, clone(one.body), one.loc});
        return copy;
      },
      [](const Break& n) -> N { return n; }, [](const Continue& n) -> N { return n; },
      [](const Return& n) -> N { return Return{clone(n.value)}; },
      [](const Scope& n) -> N { return Scope{clone(n.body)}; },
      [](const Push& n) -> N { return Push{n.stream, clone(n.value), clone(n.mask)}; },
      [](const Scatter& n) -> N {
        return Scatter{n.stream, n.op, clone(n.index), clone(n.value), clone(n.mask)};
      },
      [](const Print& n) -> N { return Print{n.format, cloneAll(n.values), clone(n.mask)}; });
}

}  // namespace

ExprPtr clone(const Expr& expr) { return makeExpr(expr.type, cloneNode(expr.node), expr.loc); }
ExprPtr clone(const ExprPtr& expr) { return expr ? clone(*expr) : nullptr; }

// ---- statements -------------------------------------------------------------------------------

Stmt declare(VarId var, ExprPtr init, Loc loc) { return {loc, Declare{var, std::move(init)}}; }
Stmt assign(ExprPtr place, ExprPtr value, Loc loc) {
  return {loc, Assign{std::move(place), std::nullopt, std::move(value)}};
}
Stmt assign(ExprPtr place, BinaryOp op, ExprPtr value, Loc loc) {
  return {loc, Assign{std::move(place), op, std::move(value)}};
}
Stmt callStmt(FunctionId callee, std::vector<ExprPtr> args, ExprPtr result, Loc loc) {
  return {loc, CallStmt{callee, std::move(args), std::move(result)}};
}
Stmt ifStmt(ExprPtr cond, Block then, Block otherwise, Loc loc) {
  return {loc, If{std::move(cond), std::move(then), std::move(otherwise)}};
}
Stmt forLoop(Block init, ExprPtr cond, Block step, Block body, Loc loc) {
  return {loc, Loop{LoopKind::For, std::move(init), std::move(cond), std::move(step), std::move(body)}};
}
Stmt whileLoop(ExprPtr cond, Block body, Loc loc) {
  return {loc, Loop{LoopKind::While, {}, std::move(cond), {}, std::move(body)}};
}
Stmt doWhileLoop(Block body, ExprPtr cond, Loc loc) {
  return {loc, Loop{LoopKind::DoWhile, {}, std::move(cond), {}, std::move(body)}};
}
Stmt switchStmt(ExprPtr value, std::vector<Case> cases, Loc loc) {
  return {loc, Switch{std::move(value), std::move(cases)}};
}
Stmt breakStmt(Loc loc) { return {loc, Break{}}; }
Stmt continueStmt(Loc loc) { return {loc, Continue{}}; }
Stmt returnStmt(ExprPtr value, Loc loc) { return {loc, Return{std::move(value)}}; }
Stmt scope(Block body, Loc loc) { return {loc, Scope{std::move(body)}}; }
Stmt push(StreamRef stream, ExprPtr value, Loc loc) { return {loc, Push{stream, std::move(value)}}; }
Stmt scatter(StreamRef stream, ScatterOp op, ExprPtr index, ExprPtr value, Loc loc) {
  return {loc, Scatter{stream, op, std::move(index), std::move(value)}};
}

void prepend(Block& block, Block statements) {
  std::ranges::move(block, std::back_inserter(statements));
  block = std::move(statements);
}

Stmt clone(const Stmt& stmt) { return {stmt.loc, cloneNode(stmt.node)}; }

Block clone(const Block& block) {
  Block copy;
  copy.reserve(block.size());
  for (const Stmt& stmt : block) copy.push_back(clone(stmt));
  return copy;
}

// ---- declarations -----------------------------------------------------------------------------

VarId addVariable(Function& function, std::string name, Type type, VarRole role, Loc loc) {
  const auto id = static_cast<VarId>(function.variables.size());
  function.variables.push_back({.name = std::move(name), .type = type, .role = role, .loc = loc});
  if (role != VarRole::Local) {
    assert(function.parameterCount == id && "parameters come before locals");
    ++function.parameterCount;
  }
  return id;
}

Type arrayOf(Module& module, Type element, std::uint32_t length) {
  const Array array{element, length};
  const auto found = std::find(module.arrays.begin(), module.arrays.end(), array);
  const auto id = static_cast<std::uint32_t>(found - module.arrays.begin());
  if (found == module.arrays.end()) module.arrays.push_back(array);
  return Type::arrayType(id);
}

KernelParam clone(const KernelParam& param) {
  KernelParam copy;
  copy.name = param.name;
  copy.role = param.role;
  copy.type = param.type;
  copy.held = param.held;
  copy.rank = param.rank;
  copy.boundary = param.boundary;
  copy.border = clone(param.border);
  copy.filter = param.filter;
  copy.identity = clone(param.identity);
  copy.firstPlane = param.firstPlane;
  copy.planeCount = param.planeCount;
  copy.loc = param.loc;
  copy.scatter = param.scatter;
  copy.pushes = param.pushes;
  copy.neededIf = clone(param.neededIf);
  copy.promise = param.promise;
  copy.range = param.range;
  return copy;
}

Function clone(const Function& function) {
  return {.name = function.name,
          .result = function.result,
          .variables = function.variables,
          .parameterCount = function.parameterCount,
          .body = clone(function.body),
          .loc = function.loc,
          .table = function.table,
          .isLibrary = function.isLibrary};
}

namespace {

ExprPtr ofConstruct(const Construct& n, std::uint8_t number) {
  if (n.args.size() == 1) return componentOf(*n.args.front(), number);
  std::uint8_t first = 0;
  for (const ExprPtr& arg : n.args) {
    if (number < first + arg->type.width) return componentOf(*arg, static_cast<std::uint8_t>(number - first));
    first = static_cast<std::uint8_t>(first + arg->type.width);
  }
  return nullptr;
}

/// False for products of a matrix and a vector.
bool isByComponent(const Binary& n) { return n.lhs->type.isArithmetic() && n.rhs->type.isArithmetic(); }

}  // namespace

ExprPtr componentOf(const Expr& expr, std::uint8_t number) {
  if (!expr.type.isVector()) return clone(expr);
  if (const auto* n = std::get_if<Construct>(&expr.node)) return ofConstruct(*n, number);
  if (const auto* n = std::get_if<Swizzle>(&expr.node)) return componentOf(*n->base, n->components[number]);
  if (const auto* n = std::get_if<Unary>(&expr.node)) {
    return unary(n->op, componentOf(*n->operand, number), expr.loc);
  }
  if (const auto* n = std::get_if<Binary>(&expr.node); n != nullptr && isByComponent(*n)) {
    return binary(n->op, componentOf(*n->lhs, number), componentOf(*n->rhs, number), expr.loc);
  }
  if (const auto* n = std::get_if<Convert>(&expr.node)) {
    return convert(expr.type.scalar, componentOf(*n->operand, number), expr.loc);
  }
  return makeExpr(expr.type.component(), Swizzle{clone(expr), {number}}, expr.loc);
}

namespace {

Constant clone(const Constant& constant) {
  return {
      .name = constant.name, .type = constant.type, .value = ir::clone(constant.value), .loc = constant.loc};
}

Kernel clone(const Kernel& kernel) {
  Kernel copy{.name = kernel.name,
              .scope = kernel.scope,
              .signature = kernel.signature,
              .entry = kernel.entry,
              .params = {},
              .bundles = kernel.bundles,
              .reduction = kernel.reduction,
              .isScan = kernel.isScan,
              .isSynthesized = kernel.isSynthesized,
              .isNativeOnly = kernel.isNativeOnly,
              .parts = kernel.parts,
              .isPart = kernel.isPart,
              .isOfPipeline = kernel.isOfPipeline,
              .assertions = kernel.assertions,
              .plans = kernel.plans,
              .pass = kernel.pass,
              .variants = kernel.variants,
              .choices = kernel.choices,
              .loops = kernel.loops,
              .unrolled = kernel.unrolled,
              .loc = kernel.loc};
  for (const KernelParam& param : kernel.params) {
    KernelParam& made = copy.params.emplace_back(ir::clone(param));
    made.reach = param.reach;  // which the parameter of another kernel would not have
    made.reachShapes = param.reachShapes;
  }
  return copy;
}

}  // namespace

Module clone(const Module& module) {
  Module copy{.file = module.file,
              .sources = module.sources,
              .structs = module.structs,
              .arrays = module.arrays,
              .constants = {},
              .functions = {},
              .tables = module.tables,
              .kernels = {},
              .streams = module.streams,
              .assertions = module.assertions,
              .bundleTypes = module.bundleTypes,
              .pipelines = {}};
  for (const Constant& constant : module.constants) copy.constants.push_back(clone(constant));
  for (const Function& function : module.functions) copy.functions.push_back(ir::clone(function));
  for (const Kernel& kernel : module.kernels) copy.kernels.push_back(clone(kernel));
  for (const Pipeline& pipeline : module.pipelines) {
    copy.pipelines.push_back({clone(pipeline.face), pipeline.locals, pipeline.passes, pipeline.isKernel,
                              pipeline.bytesOfCalls, pipeline.bytesOfPasses});
  }
  return copy;
}

bool holds(const Module& module, Type type, Scalar scalar) {
  if (type.kind == Type::Kind::Array) return holds(module, module.arrays[type.index].element, scalar);
  if (type.kind != Type::Kind::Struct) return type.isArithmetic() && type.scalar == scalar;
  return std::ranges::any_of(module.structs[type.index].fields,
                             [&](const StructField& field) { return holds(module, field.type, scalar); });
}

std::uint64_t scalarCount(const Module& module, Type type) {
  switch (type.kind) {
    case Type::Kind::Void: return 0;
    case Type::Kind::Scalar:
    case Type::Kind::Vector: return type.width;
    case Type::Kind::Matrix: return std::uint64_t{type.width} * type.width;
    case Type::Kind::Struct: {
      std::uint64_t sum = 0;
      for (const StructField& field : module.structs[type.index].fields)
        sum += scalarCount(module, field.type);
      return sum;
    }
    case Type::Kind::Array: {
      const Array& array = module.arrays[type.index];
      return array.length * scalarCount(module, array.element);
    }
  }
  return 0;
}

std::uint64_t memoryBytes(const Module& module, Type type) {
  if (type.kind == Type::Kind::Struct) {
    std::uint64_t sum = 0;
    for (const StructField& field : module.structs[type.index].fields) sum += memoryBytes(module, field.type);
    return sum;
  }
  if (type.kind == Type::Kind::Array) {
    const Array& array = module.arrays[type.index];
    return array.length * memoryBytes(module, array.element);
  }
  return scalarCount(module, type) * std::max<unsigned>(row(type.scalar).bits, 8) / 8;
}

std::size_t scalarOffset(const Module& module, Type structType, std::uint32_t field) {
  std::uint64_t sum = 0;
  for (std::uint32_t i = 0; i < field; ++i)
    sum += scalarCount(module, module.structs[structType.index].fields[i].type);
  return static_cast<std::size_t>(sum);
}

}  // namespace skc::ir
