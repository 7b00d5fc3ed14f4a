// SPDX-License-Identifier: MIT
#include <algorithm>

#include <fmt/format.h>

#include "ir/build.hpp"
#include "ir/lvalue.hpp"
#include "ir/print.hpp"
#include "ir/validate_rules.hpp"
#include "ir/walk.hpp"
#include "support/overloaded.hpp"

namespace skc::ir {

void require(bool holds, const std::string& text) {
  if (!holds) throw Violation{text};
}

void checkType(const Module& module, Type type) {
  switch (type.kind) {
    case Type::Kind::Void: return;
    case Type::Kind::Scalar: return require(type.width == 1, "a scalar has width 1");
    case Type::Kind::Vector: return require(type.width >= 2 && type.width <= 4, "a vector has width 2 to 4");
    case Type::Kind::Matrix:
      return require(type.width >= 2 && type.width <= 4 && type.scalar == Scalar::Float,
                     "a matrix has float rows and columns, 2 to 4");
    case Type::Kind::Struct:
      return require(type.index < module.structs.size(), "a struct type is not in the table");
    case Type::Kind::Array:
      return require(type.index < module.arrays.size(), "an array type is not in the table");
  }
}

namespace {

bool isIndex(Type type) { return type.isScalar() && type.isInteger(); }

/// True for equal types, and for a scalar with a vector of that component type.
bool fitTogether(Type lhs, Type rhs) {
  return lhs == rhs || (lhs.isArithmetic() && rhs.isArithmetic() && lhs.scalar == rhs.scalar &&
                        (lhs.isScalar() || rhs.isScalar()));
}

class ExprChecker {
 public:
  explicit ExprChecker(const ExprContext& context) : context_(context), module_(context.module) {}

  void check(const Expr& expr) const {
    checkType(module_, expr.type);
    require(!expr.type.isVoid(), "an expression has no type");
    const bool isCall = std::holds_alternative<Call>(expr.node);
    if (!isCall) {   // arguments of a call may be streams
      forEachOperand(expr, [&](const ExprPtr& operand) {
        require(operand != nullptr, "an operand is missing");
        check(*operand);
      });
    }
    match(expr.node, [&](const auto& node) { rule(expr.type, node); });
  }

  /// Checks that `stream` is an append output with this element type; rank 0 is a variable output.
  void appendOutput(StreamRef stream, Type value, std::uint8_t rank) const {
    checkStream(stream);
    const bool isVariable = stream.space == StreamRef::Space::Variable;
    const Type element =
        isVariable ? context_.function->variables[stream.id].type : context_.kernel->params[stream.id].type;
    const std::uint8_t declared =
        isVariable ? context_.function->variables[stream.id].rank : context_.kernel->params[stream.id].rank;
    const bool isAppendOutput = isVariable
                                    ? context_.function->variables[stream.id].role == VarRole::AppendOutput
                                    : context_.kernel->params[stream.id].role == ParamRole::VariableOutput ||
                                          context_.kernel->params[stream.id].role == ParamRole::Scatter;
    require(isAppendOutput, "a stream that is no append output is written to");
    require(declared == rank, "an append output is written with another rank than its own");
    require(element == value, "a value of another type is written to an append output");
  }

 private:
  void rule(Type type, const Literal& n) const {
    require(type.isScalar(), "a literal is a scalar");
    require(!type.isBool() || n.bits <= 1, "a bool literal is 0 or 1");
  }
  void rule(Type type, const VarRef& n) const {
    require(context_.function != nullptr, "a constant expression names a variable");
    require(n.var < context_.function->variables.size(), "a variable is not in the function's table");
    const Variable& var = context_.function->variables[n.var];
    require(var.role != VarRole::Gather && var.role != VarRole::AppendOutput,
            fmt::format("{} '{}' is used as a value", spelling(var.role), var.name));
    require((*context_.visible)[n.var], fmt::format("'{}' is not visible here", var.name));
    require(var.type == type, fmt::format("'{}' has another type than its variable", var.name));
  }
  void rule(Type type, const ConstantRef& n) const {
    require(n.constant < context_.constantLimit, "a constant is used before it is declared");
    require(module_.constants[n.constant].type == type,
            "a constant's name has another type than the constant");
  }
  void rule(Type type, const Unary& n) const {
    const Type operand = n.operand->type;
    require(operand == type, fmt::format("'{}' changes its operand's type", spelling(n.op)));
    switch (n.op) {
      case UnaryOp::Negate:
        return require(type.isNumber() || type.isMatrix(), "'-' of something that is no number");
      case UnaryOp::BitNot:
        return require(type.isInteger() || type.isLong(), "'~' of something that is no integer");
      case UnaryOp::LogicalNot: return require(type.isBool(), "'!' of something that is no bool");
    }
  }
  void rule(Type type, const Binary& n) const { checkBinary(n.op, n.lhs->type, n.rhs->type, type); }
  void rule(Type type, const Select& n) const {
    require(n.yes->type == type && n.no->type == type, "the sides of '?:' have other types than the whole");
    const Type cond = n.cond->type;
    const bool byComponent = cond.isVector() && type.isVector() && cond.width == type.width;
    require(cond.isBool() && (cond.isScalar() || byComponent),
            "the condition of '?:' is no bool of its width");
  }
  void rule(Type type, const Convert& n) const {
    const Type operand = n.operand->type;
    require(type.isArithmetic() && operand.isArithmetic() && type.width == operand.width,
            "a conversion changes more than the component type");
    require(type.scalar != operand.scalar, "a conversion changes nothing");
  }
  void rule(Type type, const Construct& n) const {
    if (type.isVector()) return constructVector(type, n.args);
    std::vector<Type> members;
    if (type.isMatrix()) {
      members.assign(type.width, type.indexed());
    } else if (type.kind == Type::Kind::Struct) {
      for (const StructField& field : module_.structs[type.index].fields) members.push_back(field.type);
    } else {
      require(type.kind == Type::Kind::Array, "a scalar is constructed");
      const Array& array = module_.arrays[type.index];
      members.assign(array.length, array.element);
    }
    require(n.args.size() == members.size(),
            "a matrix, struct or array is constructed from too many or too few values");
    for (std::size_t i = 0; i < members.size(); ++i) {
      require(n.args[i]->type == members[i], fmt::format("member {} is constructed from another type", i));
    }
  }
  void constructVector(Type type, const std::vector<ExprPtr>& args) const {
    int components = 0;
    for (const ExprPtr& arg : args) {
      require(arg->type.isArithmetic() && arg->type.scalar == type.scalar,
              "a vector is constructed from values of another component type");
      components += arg->type.width;
    }
    const bool isSplat = args.size() == 1 && components == 1;
    require(isSplat || components == type.width,
            "a vector is constructed from too many or too few components");
  }
  void rule(Type type, const Swizzle& n) const {
    const Type base = n.base->type;
    require(base.isVector(), "a swizzle of something that is no vector");
    require(!n.components.empty() && n.components.size() <= 4, "a swizzle has 1 to 4 components");
    for (std::uint8_t component : n.components)
      require(component < base.width, "a swizzle leaves its vector");
    require(type == Type::of(base.scalar, static_cast<int>(n.components.size())),
            "a swizzle has a wrong type");
  }
  void rule(Type type, const Member& n) const {
    const Type base = n.base->type;
    require(base.kind == Type::Kind::Struct, "a member of something that is no struct");
    const std::vector<StructField>& fields = module_.structs[base.index].fields;
    require(n.field < fields.size(), "a struct has no such member");
    require(fields[n.field].type == type, "a member has another type than its field");
  }
  void rule(Type type, const Index& n) const {
    const Type base = n.base->type;
    const bool isArray = base.kind == Type::Kind::Array;
    require(base.isVector() || base.isMatrix() || isArray,
            "an index into something that is no vector, matrix or array");
    require(isIndex(n.index->type), "an index is no int or uint");
    const Type element = isArray ? module_.arrays[base.index].element : base.indexed();
    require(element == type, "an indexed element has a wrong type");
  }
  void rule(Type type, const Call& n) const {
    require(context_.function != nullptr, "a constant expression calls a function");
    checkArguments(context_, n.callee, n.args, false);
    require(module_.functions[n.callee].result == type, "a call has another type than its function's result");
  }
  void rule(Type type, const IntrinsicCall& n) const {
    require(n.intrinsic != Intrinsic::AnyLane || context_.stage == Stage::Predicated,
            "lanes are asked about before predicate");
    std::vector<Type> types;
    for (const ExprPtr& arg : n.args) types.push_back(arg->type);
    const std::optional<Type> result = resultType(n.intrinsic, types);
    require(result.has_value(),
            fmt::format("no signature of '{}' has these arguments", row(n.intrinsic).name));
    require(*result == type, fmt::format("'{}' has a wrong type", row(n.intrinsic).name));
  }
  void rule(Type type, const GatherRead& n) const { read(type, n.stream, n.index->type); }
  void rule(Type type, const NeighborRead& n) const { read(type, n.stream, n.offset->type); }
  void rule(Type type, const Sample& n) const {
    const GatherType gather = gatherType(n.stream);
    require(gather.element.arithmeticType().isFloat() || gather.element.isDouble(),
            "a gather that holds no floats is interpolated");
    require(n.position->type == Type::of(type.isDouble() ? Scalar::Double : Scalar::Float, gather.rank),
            "the position in a gather is not of the interpolated type and its rank");
    require(gather.element.arithmeticType() == type,
            "an interpolated value has another type than the stream's element");
  }
  void rule(Type type, const IndexOf& n) const { shape(type, n.stream); }
  void rule(Type type, const ExtentOf& n) const { shape(type, n.stream); }

  struct GatherType {
    Type element;
    int rank;
  };
  GatherType gatherType(StreamRef stream) const {
    require(stream.space != StreamRef::Space::Domain, "the domain is read");
    checkStream(stream);
    constexpr const char* noGather = "a stream that is no gather is read by index";
    if (stream.space == StreamRef::Space::Variable) {
      const Variable& var = context_.function->variables[stream.id];
      require(var.role == VarRole::Gather, noGather);
      return {var.type, var.rank};
    }
    const KernelParam& param = context_.kernel->params[stream.id];
    require(param.role == ParamRole::Gather, noGather);
    return {param.type, param.rank};
  }

  void read(Type type, StreamRef stream, Type index) const {
    const GatherType gather = gatherType(stream);
    require(index == Type::of(Scalar::Int, gather.rank), "the index of a gather is not int of its rank");
    require(gather.element == type, "a read has another type than the stream's element");
  }

  void shape(Type type, StreamRef stream) const {
    require(type == Type::of(Scalar::Int, 4), "indexof and extentof are int4");
    if (stream.space != StreamRef::Space::Domain) checkStream(stream);
  }

  void checkStream(StreamRef stream) const {
    require(context_.function != nullptr, "a constant expression uses a stream");
    if (context_.stage == Stage::Lowered) {
      require(stream.space == StreamRef::Space::Variable,
              "a stream is named as a kernel's parameter too early");
      require(stream.id < context_.function->variables.size(), "a stream is not in the function's table");
      const VarRole role = context_.function->variables[stream.id].role;
      require(role == VarRole::Gather || role == VarRole::Element || role == VarRole::AppendOutput,
              "a stream is no gather, element or append output");
      return;
    }
    require(stream.space == StreamRef::Space::KernelParameter, "a stream is no parameter of a kernel");
    require(context_.kernel != nullptr, "a function that no kernel reaches uses a stream");
    require(stream.id < context_.kernel->params.size(), "a stream is not among the kernel's parameters");
    const ParamRole role = context_.kernel->params[stream.id].role;
    require(role != ParamRole::Uniform && role != ParamRole::Iterator && role != ParamRole::Spec,
            "a value is used as a stream");
  }

  const ExprContext& context_;
  const Module& module_;
};

/// True for a VarRef of this function's own Gather or Element variable, as a stream parameter needs.
bool isStreamArgument(const ExprContext& context, const Expr& arg, const Variable& parameter) {
  const auto* ref = std::get_if<VarRef>(&arg.node);
  if (ref == nullptr || ref->var >= context.function->variables.size()) return false;
  const Variable& var = context.function->variables[ref->var];
  return var.role == parameter.role && var.rank == parameter.rank;
}

}  // namespace

namespace {

/// True if the operator accepts these operands, at least one of which is a matrix.
bool isMatrixOp(BinaryOp op, Type lhs, Type rhs) {
  const Type scalar = Type::of(Scalar::Float);
  switch (op) {
    case BinaryOp::Add:
    case BinaryOp::Sub:
    case BinaryOp::Equal:
    case BinaryOp::NotEqual: return lhs == rhs;
    case BinaryOp::Mul: return lhs == rhs || lhs == scalar || rhs == scalar || rhs == lhs.indexed();
    case BinaryOp::Div: return rhs == scalar;
    case BinaryOp::Rem:
    case BinaryOp::BitAnd:
    case BinaryOp::BitOr:
    case BinaryOp::BitXor:
    case BinaryOp::ShiftLeft:
    case BinaryOp::ShiftRight:
    case BinaryOp::Less:
    case BinaryOp::LessEqual:
    case BinaryOp::Greater:
    case BinaryOp::GreaterEqual:
    case BinaryOp::LogicalAnd:
    case BinaryOp::LogicalOr: break;
  }
  return false;
}

}  // namespace

void checkBinary(BinaryOp op, Type lhs, Type rhs, Type result) {
  const std::string where = fmt::format("'{}'", spelling(op));
  require(binaryType(op, lhs, rhs) == result, where + " has a wrong type");
  if (lhs.isMatrix() || rhs.isMatrix()) {
    return require(isMatrixOp(op, lhs, rhs), where + " of a matrix and something that it does not know");
  }
  switch (op) {
    case BinaryOp::Add:
    case BinaryOp::Sub:
    case BinaryOp::Mul:
    case BinaryOp::Div:
      require(lhs.isNumber(), where + " of something that is no number");
      return require(fitTogether(lhs, rhs), where + " has operands of different types");
    case BinaryOp::Rem:
    case BinaryOp::BitAnd:
    case BinaryOp::BitOr:
    case BinaryOp::BitXor:
      require(lhs.isInteger() || lhs.isLong(), where + " of something that is no integer");
      return require(fitTogether(lhs, rhs), where + " has operands of different types");
    case BinaryOp::ShiftLeft:
    case BinaryOp::ShiftRight:
      require((lhs.isInteger() || lhs.isLong()) && rhs.isInteger(),
              where + " of something that is no integer");
      return require(rhs.isScalar() || rhs.width == lhs.width, where + " has a count of another width");
    case BinaryOp::Less:
    case BinaryOp::LessEqual:
    case BinaryOp::Greater:
    case BinaryOp::GreaterEqual:
      require(lhs.isNumber(), where + " of something that is no number");
      return require(lhs == rhs, where + " has operands of different types");
    case BinaryOp::Equal:
    case BinaryOp::NotEqual:
      require(!lhs.isNarrow(), where + " of a narrow type, whose arithmetic type is compared");
      return require(lhs == rhs, where + " has operands of different types");
    case BinaryOp::LogicalAnd:
    case BinaryOp::LogicalOr:
      return require(lhs.isBool() && lhs == rhs, where + " of something that is no bool");
  }
}

void checkExpr(const ExprContext& context, const Expr& expr) { ExprChecker(context).check(expr); }

void checkAppendOutput(const ExprContext& context, StreamRef stream, Type value, std::uint8_t rank) {
  ExprChecker(context).appendOutput(stream, value, rank);
}

VarId checkLValue(const ExprContext& context, const Expr& expr) {
  checkExpr(context, expr);
  if (const auto* n = std::get_if<Member>(&expr.node)) return checkLValue(context, *n->base);
  if (const auto* n = std::get_if<Index>(&expr.node)) return checkLValue(context, *n->base);
  if (const auto* n = std::get_if<Swizzle>(&expr.node)) {
    unsigned seen = 0;
    for (std::uint8_t component : n->components) {
      require((seen & (1U << component)) == 0, "a component is assigned twice");
      seen |= 1U << component;
    }
    return checkLValue(context, *n->base);
  }
  const auto* ref = std::get_if<VarRef>(&expr.node);
  require(ref != nullptr, "a value that is no place is assigned to");
  const Variable& var = context.function->variables[ref->var];
  require(isAssignable(var), fmt::format("constant '{}' is assigned to", var.name));
  return ref->var;
}

/// Checks the lvalues that one statement writes: none overlaps with another or moves it.
void checkWritten(const Module& module, const std::vector<const Expr*>& written, const std::string& where) {
  std::vector<VarId> roots;
  for (const Expr* lvalue : written) roots.push_back(rootOf(*lvalue));
  std::ranges::sort(roots);
  for (std::size_t i = 0; i < written.size(); ++i) {
    require(!hasIndexOf(*written[i], roots),
            where + "an index of an lvalue is a variable that the call writes");
    for (std::size_t k = 0; k < i; ++k)
      require(areDisjoint(module, *written[i], *written[k]),
              where + "two of the lvalues that it writes overlap");
  }
}

void checkArguments(const ExprContext& context, FunctionId callee, const std::vector<ExprPtr>& args,
                    bool allowInOut, const Expr* result) {
  require(callee < context.module.functions.size(), "a callee is not in the table");
  const Function& function = context.module.functions[callee];
  const std::string where = fmt::format("call of '{}': ", function.name);
  require(args.size() == function.parameterCount, where + "too many or too few arguments");
  std::vector<const Expr*> written;
  for (std::size_t i = 0; i < args.size(); ++i) {
    const Variable& parameter = function.variables[i];
    require(args[i]->type == parameter.type, fmt::format("{}argument {} has another type", where, i));
    if (parameter.role == VarRole::Gather || parameter.role == VarRole::AppendOutput) {
      require(isStreamArgument(context, *args[i], parameter),
              fmt::format("{}argument {} is no {}", where, i, spelling(parameter.role)));
      require(parameter.role == VarRole::Gather || allowInOut, where + "an expression writes a stream");
    } else if (parameter.role == VarRole::InOut) {
      require(allowInOut, where + "an expression has an effect");
      checkLValue(context, *args[i]);
      written.push_back(args[i].get());
    } else {
      checkExpr(context, *args[i]);
    }
  }
  if (result != nullptr) {
    checkLValue(context, *result);
    written.push_back(result);
  }
  checkWritten(context.module, written, where);
}

}  // namespace skc::ir
