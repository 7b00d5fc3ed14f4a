// SPDX-License-Identifier: MIT
#include <bit>
#include <cstddef>
#include <utility>

#include <llvm/IR/Constants.h>
#include <llvm/IR/Intrinsics.h>

#include "ir/build.hpp"
#include "ir/call_graph.hpp"
#include "ir/walk.hpp"
#include "native/arithmetic.hpp"
#include "native/function_code.hpp"
#include "sk/native/table.hpp"
#include "support/overloaded.hpp"

namespace skc::native {

using namespace ir;

Parts FunctionCode::expression(const Expr& expr) {
  if (shared_ && std::holds_alternative<GatherRead>(expr.node) && plan_->isShared(expr)) return shared(expr);
  if (const auto read = fromBlocks_.find(&expr); read != fromBlocks_.end()) return read->second;
  return match(expr.node, [&](const auto& node) { return parts(expr, node); });
}

/// Emits a read that all rows share once.
Parts FunctionCode::shared(const Expr& expr) {
  const auto known = shared_->find(&expr);
  if (known != shared_->end()) return known->second;
  const Parts value = parts(expr, std::get<GatherRead>(expr.node));
  shared_->emplace(&expr, value);
  return value;
}

std::vector<Parts> FunctionCode::expressions(const std::vector<ExprPtr>& list) {
  std::vector<Parts> all;
  for (const ExprPtr& expr : list) {
    const auto* var = std::get_if<VarRef>(&expr->node);
    const bool isStream = var != nullptr && variables_[0][var->var].empty();
    all.push_back(isStream ? Parts() : expression(*expr));
  }
  return all;
}

// ---- values ---------------------------------------------------------------------------------------

Parts FunctionCode::parts(const Expr& expr, const Literal& n) {
  const Scalar scalar = expr.type.scalar;
  switch (arithmeticScalar(scalar)) {
    case Scalar::Bool: return {{b.getInt1(n.bits != 0)}};
    case Scalar::Double: {
      const auto value = std::bit_cast<double>(n.wide());
      return {{l.number(l.type(scalar), value)}};
    }
    case Scalar::Float: {
      const bool isFloat = l.real()->isFloatTy();
      const Part value = {l.number(l.real(), isFloat ? double{std::bit_cast<float>(n.bits)} : wideValue(n))};
      return {convert(l, Scalar::Float, scalar, value)};
    }
    case Scalar::Long:
    case Scalar::Ulong: return {{b.getInt64(n.wide())}};
    default: return {convert(l, arithmeticScalar(scalar), scalar, {b.getInt32(n.bits)})};
  }
}

Parts FunctionCode::parts(const Expr&, const VarRef& n) { return load(variable(n.var)); }
Parts FunctionCode::parts(const Expr&, const ConstantRef& n) {
  return expression(*k.module.constants[n.constant].value);
}

// ---- operators ------------------------------------------------------------------------------------

Parts FunctionCode::parts(const Expr& expr, const Unary& n) {
  Parts all = expression(*n.operand);
  for (Part& part : all) part = unary(l, n.op, expr.type.scalar, part);
  return all;
}

/// True if an operand is worth a branch: it reads streams or calls functions.
bool FunctionCode::isCostly(const Expr& expr) const {
  bool is = false;
  walkExprs(expr, [&](const Expr& inner) {
    is = is || std::holds_alternative<Call>(inner.node) || std::holds_alternative<GatherRead>(inner.node) ||
         std::holds_alternative<Sample>(inner.node);
  });
  return is;
}

Parts FunctionCode::either(llvm::Value* condition, const std::function<Parts()>& yes,
                           const std::function<Parts()>& no) {
  llvm::BasicBlock* const yesBlock = newBlock("yes");
  llvm::BasicBlock* const noBlock = newBlock("no");
  llvm::BasicBlock* const end = newBlock("either");
  b.CreateCondBr(condition, yesBlock, noBlock);
  const auto outer = std::exchange(shared_, std::nullopt);  // reads in a branch do not dominate the end
  b.SetInsertPoint(yesBlock);
  Parts a = yes();
  llvm::BasicBlock* const yesEnd = b.GetInsertBlock();
  b.SetInsertPoint(noBlock);
  Parts c = no();
  llvm::BasicBlock* const noEnd = b.GetInsertBlock();
  shared_ = outer;
  const auto isSame = [&](const Part& x, const Part& y) {
    return x.isConsecutive == y.isConsecutive && l.isVector(x.value) == l.isVector(y.value);
  };
  std::vector<bool> areSame;
  for (std::size_t i = 0; i < a.size(); ++i) areSame.push_back(isSame(a[i], c[i]));
  const auto close = [&](llvm::BasicBlock* block, Parts& all) {
    b.SetInsertPoint(block);
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (!areSame[i]) all[i] = {l.broadcast(all[i])};
    }
    branch(end);
  };
  close(yesEnd, a);
  close(noEnd, c);
  b.SetInsertPoint(end);
  Parts result;
  for (std::size_t i = 0; i < a.size(); ++i) {
    llvm::PHINode* const phi = b.CreatePHI(a[i].value->getType(), 2);
    phi->addIncoming(a[i].value, yesEnd);
    phi->addIncoming(c[i].value, noEnd);
    result.push_back({phi, a[i].isConsecutive});
  }
  return result;
}

llvm::FastMathFlags FunctionCode::flagsOfText() const {
  llvm::FastMathFlags flags;
  flags.setAllowContract(l.options().isContracted && !function_.isLibrary);
  return flags;
}

Parts FunctionCode::matrixProduct(const Parts& a, const Parts& c, std::size_t n, bool isVector) {
  const auto product = [&](const Part& x, const Part& y) {
    return binary(l, BinaryOp::Mul, Scalar::Float, x, y);
  };
  const auto sum = [&](const Part& x, const Part& y) {
    return binary(l, BinaryOp::Add, Scalar::Float, x, y);
  };
  const std::size_t columns = isVector ? 1 : n;
  Parts result;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < columns; ++j) {
      Part total = product(a[i * n], c[j]);
      for (std::size_t m = 1; m < n; ++m) total = sum(total, product(a[i * n + m], c[m * columns + j]));
      result.push_back(total);
    }
  }
  return result;
}

Parts FunctionCode::parts(const Expr& expr, const Binary& n) {
  const bool isLogical = n.op == BinaryOp::LogicalAnd || n.op == BinaryOp::LogicalOr;
  const Parts lhs = expression(*n.lhs);
  if (isLogical && lhs.size() == 1 && l.isUniform(lhs[0]) && isCostly(*n.rhs)) {
    const auto known = [&]() -> Parts { return {{b.getInt1(n.op == BinaryOp::LogicalOr)}}; };
    const auto evaluated = [&] { return expression(*n.rhs); };
    return n.op == BinaryOp::LogicalAnd ? either(lhs[0].value, evaluated, known)
                                        : either(lhs[0].value, known, evaluated);
  }
  return arithmetic(n.op, expr.type, n.lhs->type, lhs, n.rhs->type, expression(*n.rhs));
}

Parts FunctionCode::arithmetic(BinaryOp op, Type type, Type left, const Parts& lhs, Type right,
                               const Parts& rhs) {
  const llvm::IRBuilderBase::FastMathFlagGuard guard(b);
  b.setFastMathFlags(flagsOfText());
  if (op == BinaryOp::Mul && left.isMatrix() && !right.isScalar()) {
    return matrixProduct(lhs, rhs, left.width, right.isVector());
  }
  Parts all;
  const std::size_t width = std::max(lhs.size(), rhs.size());
  for (std::size_t i = 0; i < width; ++i) {
    all.push_back(binary(l, op, left.scalar, lhs[lhs.size() == 1 ? 0 : i], rhs[rhs.size() == 1 ? 0 : i]));
  }
  if (all.size() == 1 || !type.isScalar()) return all;
  // matrices are compared as a whole
  const BinaryOp join = op == BinaryOp::Equal ? BinaryOp::LogicalAnd : BinaryOp::LogicalOr;
  Part whole = all[0];
  for (std::size_t i = 1; i < all.size(); ++i) whole = binary(l, join, Scalar::Bool, whole, all[i]);
  return {whole};
}

Parts FunctionCode::parts(const Expr&, const Select& n) {
  const Parts cond = expression(*n.cond);
  const bool isOne = cond.size() == 1 && l.isUniform(cond[0]);
  if (isOne && (isCostly(*n.yes) || isCostly(*n.no))) {
    return either(cond[0].value, [&] { return expression(*n.yes); }, [&] { return expression(*n.no); });
  }
  const Parts yes = expression(*n.yes), no = expression(*n.no);
  Parts all;
  for (std::size_t i = 0; i < yes.size(); ++i)
    all.push_back(l.select(cond[cond.size() == 1 ? 0 : i], yes[i], no[i]));
  return all;
}

Parts FunctionCode::parts(const Expr& expr, const Convert& n) {
  // converting to half and back only rounds
  const auto* inner = std::get_if<Convert>(&n.operand->node);
  const bool isRounding = inner != nullptr && n.operand->type.scalar == Scalar::Half &&
                          expr.type.scalar == Scalar::Float && inner->operand->type.scalar == Scalar::Float;
  if (isRounding && l.real()->isFloatTy()) {
    Parts all = expression(*inner->operand);
    for (Part& part : all) part = roundedToHalf(l, part);
    return all;
  }
  Parts all = expression(*n.operand);
  for (Part& part : all) part = convert(l, n.operand->type.scalar, expr.type.scalar, part);
  return all;
}

Parts FunctionCode::parts(const Expr& expr, const Construct& n) {
  Parts all;
  for (const ExprPtr& arg : n.args) {
    const Parts one = expression(*arg);
    all.insert(all.end(), one.begin(), one.end());
  }
  if (all.size() == 1) all.resize(componentCount(k.module, expr.type), all[0]);
  return all;
}

// ---- parts of values ------------------------------------------------------------------------------

Parts FunctionCode::parts(const Expr& expr, const Swizzle& n) {
  if (const std::optional<LValue> lvalue = lvalueOf(expr)) return load(*lvalue);
  const Parts base = expression(*n.base);
  Parts all;
  for (const std::uint8_t component : n.components) all.push_back(base[component]);
  return all;
}

Parts FunctionCode::parts(const Expr& expr, const Member& n) {
  if (const std::optional<LValue> lvalue = lvalueOf(expr)) return load(*lvalue);
  const Parts base = expression(*n.base);
  const auto begin = base.begin() + componentsBefore(k.module, n.base->type, n.field);
  return {begin, begin + componentCount(k.module, expr.type)};
}

namespace {

bool areConstants(const Parts& parts) {
  return std::ranges::all_of(parts, [](const Part& part) { return llvm::isa<llvm::Constant>(part.value); });
}

}  // namespace

Parts FunctionCode::parts(const Expr& expr, const Index& n) {
  if (const std::optional<LValue> lvalue = lvalueOf(expr)) return load(*lvalue);
  const Parts base = expression(*n.base);
  const Type type = n.base->type;
  const std::uint32_t length =
      type.kind == Type::Kind::Array ? k.module.arrays[type.index].length : type.width;
  const std::size_t size = base.size() / length;
  const Part index = indexInside(*n.index, length);
  if (const auto* known = llvm::dyn_cast<llvm::ConstantInt>(index.value)) {
    const auto begin = base.begin() + static_cast<std::ptrdiff_t>(known->getZExtValue() * size);
    return {begin, begin + static_cast<std::ptrdiff_t>(size)};
  }
  const std::vector<Scalar> scalars = scalarsOf(k.module, expr.type);
  Parts all;
  for (std::size_t c = 0; c < size; ++c) {
    Parts column;
    for (std::uint32_t i = 0; i < length; ++i) column.push_back(base[i * size + c]);
    if (length > 4 && areConstants(column)) {  // reads a global array
      std::vector<llvm::Constant*> values;
      for (const Part& part : column)
        values.push_back(llvm::cast<llvm::Constant>(l.toStored(scalars[c], part.value)));
      llvm::Type* const stored = l.stored(scalars[c]);
      auto* const data = llvm::ConstantArray::get(llvm::ArrayType::get(stored, length), values);
      auto* const global = new llvm::GlobalVariable(*b.GetInsertBlock()->getModule(), data->getType(), true,
                                                    llvm::GlobalValue::PrivateLinkage, data);
      all.push_back(l.isVector(index.value) ? l.gather(scalars[c], global, index.value)
                                            : l.loadOne(scalars[c], l.at(stored, global, index.value)));
      continue;
    }
    Part value = column[0];
    for (std::uint32_t i = 1; i < length; ++i) {
      const Part isHere = binary(l, BinaryOp::Equal, Scalar::Int, index, {l.integer(l.int32(), i)});
      value = l.select(isHere, column[i], value);
    }
    all.push_back(value);
  }
  return all;
}

// ---- calls ----------------------------------------------------------------------------------------

Parts FunctionCode::parts(const Expr&, const Call& n) {
  const std::vector<Parts> arguments = expressions(n.args);
  const bool isTabulated = k.module.functions[n.callee].table && l.real()->isFloatTy();
  return isTabulated ? lookUp(n.callee, arguments[0]) : inlineCall(k, n.callee, arguments).result;
}

/// The value of a tabulated function, from its table if the call has one.
Parts FunctionCode::lookUp(FunctionId function, const Parts& argument) {
  const std::vector<FunctionId> tabulated = tabulatedFunctionsOf(k.module, k.kernel);
  const auto number = std::ranges::find(tabulated, function) - tabulated.begin();
  llvm::Value* const tables = k.streams.tables();
  return either(
      b.CreateIsNull(tables), [&] { return inlineCall(k, function, {argument}).result; },
      [&]() -> Parts {
        constexpr auto bytes = static_cast<std::int64_t>(sizeof(sk::native::Table));
        llvm::Value* const table =
            b.CreateConstGEP1_64(b.getInt8Ty(), tables, static_cast<std::uint64_t>(number * bytes));
        return {tableValue(table, argument[0])};
      });
}

/// Emits sk::native::Table::at().
Part FunctionCode::tableValue(llvm::Value* table, const Part& x) {
  using sk::native::Table;
  const auto field = [&](std::size_t offset, llvm::Type* type) {
    return b.CreateLoad(type, b.CreateConstGEP1_64(b.getInt8Ty(), table, offset));
  };
  const auto real = [&](BinaryOp op, const Part& a, const Part& c) {
    return binary(l, op, Scalar::Float, a, c);
  };
  const auto integer = [&](BinaryOp op, const Part& a, const Part& c) {
    return binary(l, op, Scalar::Int, a, c);
  };
  const Part intervals = {field(offsetof(Table, intervals), l.int32())};
  const Part end = convert(l, Scalar::Int, Scalar::Float, intervals);
  const Part low = {field(offsetof(Table, low), l.real())};
  const Part perUnit = {field(offsetof(Table, perUnit), l.real())};
  const Part zero = {l.number(l.real(), 0)};
  Part position = real(BinaryOp::Mul, real(BinaryOp::Sub, x, low), perUnit);
  position = l.select(real(BinaryOp::Less, position, zero), zero, position);
  position = l.select(real(BinaryOp::Less, end, position), end, position);
  const Part isNan = real(BinaryOp::NotEqual, x, x);
  const Part safe = l.select(isNan, zero, position);
  const Part whole = convert(l, Scalar::Float, Scalar::Int, safe);
  const Part last = integer(BinaryOp::Sub, intervals, {l.integer(l.int32(), 1)});
  const Part interval = l.select(integer(BinaryOp::Less, last, whole), last, whole);
  const Part t = real(BinaryOp::Sub, safe, convert(l, Scalar::Int, Scalar::Float, interval));
  llvm::Value* const coefficients = field(offsetof(Table, coefficients), b.getPtrTy());
  llvm::Value* const isCubic = b.CreateTrunc(field(offsetof(Table, isCubic), b.getInt8Ty()), b.getInt1Ty());
  const auto polynomial = [&](std::int64_t count) -> Parts {
    const Part first = integer(BinaryOp::Mul, interval, {l.integer(l.int32(), count)});
    const auto coefficient = [&](std::int64_t i) {
      const Part at = integer(BinaryOp::Add, first, {l.integer(l.int32(), i)});
      return l.isVector(at.value) ? l.gather(Scalar::Float, coefficients, at.value)
                                  : l.loadOne(Scalar::Float, l.at(l.real(), coefficients, at.value));
    };
    Part value = coefficient(count - 1);
    for (std::int64_t i = count - 1; i-- > 0;)
      value = real(BinaryOp::Add, coefficient(i), real(BinaryOp::Mul, t, value));
    return {value};
  };
  const Parts value = either(isCubic, [&] { return polynomial(4); }, [&] { return polynomial(2); });
  return l.select(isNan, x, value[0]);
}

namespace {

/// The exponent of a power of floats if it is a literal 3 or 4; else 0.
int smallExponent(const IntrinsicCall& n) {
  if (n.intrinsic != Intrinsic::Pow || n.args[0]->type.scalar != Scalar::Float) return 0;
  const auto* literal = std::get_if<Literal>(&n.args[1]->node);
  if (literal == nullptr || n.args[1]->type.scalar != Scalar::Float) return 0;
  return literal->bits == 0x40400000U ? 3 : literal->bits == 0x40800000U ? 4 : 0;
}

}  // namespace

/// A small power of floats, by doubles: their products lose next to nothing, and the result is rounded to a float once.
Parts FunctionCode::smallPower(const Parts& base, int exponent) {
  Parts result;
  for (const Part& part : base) {
    const Part x = convert(l, Scalar::Float, Scalar::Double, {l.value(part)});
    const Part square = binary(l, BinaryOp::Mul, Scalar::Double, x, x);
    const Part power = binary(l, BinaryOp::Mul, Scalar::Double, square, exponent == 3 ? x : square);
    result.push_back(convert(l, Scalar::Double, Scalar::Float, power));
  }
  return result;
}

Parts FunctionCode::parts(const Expr&, const IntrinsicCall& n) {
  if (const int exponent = smallExponent(n); exponent != 0)
    return smallPower(expression(*n.args[0]), exponent);
  std::vector<IntrinsicArgument> arguments;
  for (const ExprPtr& arg : n.args) arguments.push_back({arg->type, expression(*arg)});
  const llvm::IRBuilderBase::FastMathFlagGuard guard(b);
  if (n.intrinsic == Intrinsic::Fma || n.intrinsic == Intrinsic::Dot) b.setFastMathFlags(flagsOfText());
  return intrinsic(l, n.intrinsic, arguments);
}

// ---- streams --------------------------------------------------------------------------------------

Parts FunctionCode::parts(const Expr& expr, const GatherRead& n) {
  if (const auto walk = walks_.find(&expr); walk != walks_.end())
    return k.streams.elementOf(walk->second.size() == 1 ? walk->second[0] : walk->second[row_], iteration_);
  return k.streams.gather(n.stream.id, expression(*n.index));
}
Parts FunctionCode::parts(const Expr&, const NeighborRead& n) {
  return k.streams.neighbor(n.stream.id, expression(*n.offset), constantOffset(k.module, *n.offset));
}
Parts FunctionCode::parts(const Expr&, const Sample& n) {
  return k.streams.sample(n.stream.id, expression(*n.position));
}
Parts FunctionCode::parts(const Expr&, const IndexOf& n) { return k.streams.index(n.stream); }
Parts FunctionCode::parts(const Expr&, const ExtentOf& n) { return k.streams.extent(n.stream); }

}  // namespace skc::native
