// SPDX-License-Identifier: MIT
#include "glsl/expressions.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "analysis/stream_uses.hpp"
#include "glsl/float_intrinsics.hpp"
#include "glsl/known_values.hpp"
#include "glsl/wide_values.hpp"
#include "ir/build.hpp"
#include "ir/operators.hpp"
#include "ir/print.hpp"
#include "ir/walk.hpp"
#include "sk/arithmetic_marks.hpp"
#include "support/overloaded.hpp"
#include "support/text.hpp"

namespace skc::emit {
namespace {

using namespace ir;
namespace mark = sk::program::mark;

/// A printed expression.
struct Text {
  std::string text;
  Precedence precedence = Precedence::Primary;
  bool isOperation = false;  ///< of floats or vectors of them: it may need a barrier
  bool isKnown = false;  ///< a float whose value compilers may know
};

bool isFloats(Type type) {
  return (type.isScalar() || type.isVector() || type.isMatrix()) &&
         arithmeticScalar(type.scalar) == Scalar::Float;
}

/// True if GLSL's own function of floats adds or multiplies.
bool computes(Intrinsic intrinsic) {
  switch (intrinsic) {
    case Intrinsic::Radians:
    case Intrinsic::Degrees:
    case Intrinsic::InverseSqrt:
    case Intrinsic::Rsqrt:
    case Intrinsic::Dot:
    case Intrinsic::Cross:
    case Intrinsic::Faceforward:
    case Intrinsic::Reflect:
    case Intrinsic::Refract:
    case Intrinsic::Determinant:
    case Intrinsic::Inverse: return true;
    default: return false;
  }
}

Text signedText(std::string text) {
  const bool isNegative = text.front() == '-';
  return {std::move(text), isNegative ? Precedence::Unary : Precedence::Primary};
}

/// The mark of the literal 0, with its sign.
Text markedZero(std::uint32_t bits) { return signedText((bits == 0 ? "" : "-") + std::string(mark::zero)); }

/// True if the values of these functions are those of an argument, so that a literal 0 among them loses nothing.
bool chooses(Intrinsic intrinsic) {
  return intrinsic == Intrinsic::Min || intrinsic == Intrinsic::Max || intrinsic == Intrinsic::Clamp;
}

/// True for large numbers that read better in hexadecimal: 0x7f800000, 0x00ffffff.
bool isBitPattern(std::uint32_t bits) {
  const std::uint32_t low = bits & 0xffffU;
  return bits > 0xffffU && (low == 0 || low == 0xffffU);
}

Text literalText(Type type, std::uint32_t bits) {
  const Scalar scalar = arithmeticScalar(type.scalar);
  if (scalar == Scalar::Bool) return {bits != 0 ? "true" : "false"};
  if (scalar == Scalar::Int) {
    const auto value = static_cast<std::int32_t>(bits);
    // GLSL has no negative literals, and 2147483648 is no int
    if (value == std::numeric_limits<std::int32_t>::min()) return {"-2147483647 - 1", Precedence::Additive};
    if (isBitPattern(bits) && value > 0) return {fmt::format("0x{:08x}", bits)};
    return signedText(std::to_string(value));
  }
  if (scalar == Scalar::Uint) {
    return {isBitPattern(bits) ? fmt::format("0x{:08x}u", bits) : fmt::format("{}u", bits)};
  }
  const float value = std::bit_cast<float>(bits);
  if (!std::isfinite(value)) return {fmt::format("uintBitsToFloat(0x{:08x}u)", bits)};
  return signedText(shortestFloat(value));
}

/// True for what a sum or product loses. What it is added to loses so little that any order will do.
bool isRoundingError(const Expr& expr) {
  const auto* n = std::get_if<IntrinsicCall>(&expr.node);
  return n != nullptr && (n->intrinsic == Intrinsic::SumError || n->intrinsic == Intrinsic::ProductError);
}

/// True if the assembler has a function for it that computes what native code computes.
bool hasFormula(Intrinsic intrinsic) {
  return intrinsic == Intrinsic::Dot || intrinsic == Intrinsic::Cross || intrinsic == Intrinsic::Reflect ||
         intrinsic == Intrinsic::Refract || intrinsic == Intrinsic::Faceforward;
}

/// True for a comparison that is false of NaN, as is the opposite one.
bool ordersFloats(const Expr& expr) {
  const auto* n = std::get_if<Binary>(&expr.node);
  return n != nullptr && isComparison(n->op) && n->op != BinaryOp::Equal && n->op != BinaryOp::NotEqual &&
         isFloats(n->lhs->type);
}

bool isMatrixProduct(BinaryOp op, const Expr& lhs, const Expr& rhs) {
  return op == BinaryOp::Mul && (lhs.type.isMatrix() || rhs.type.isMatrix()) && !lhs.type.isScalar() &&
         !rhs.type.isScalar();
}

class GlslExpr {
 public:
  GlslExpr(const GlslContext& context, std::optional<FunctionId> function, bool isStored = false)
      : context_(context), function_(function), isStored_(isStored || !context.marks || !function) {}

  std::string text(const Expr& expr, Precedence around = Precedence::Lowest, bool isDivisor = false) const {
    if (!isStored_ && isComputed(expr)) {
      const Scope scope(isStored_, true);
      return fmt::format("{}{}{}{}", mark::value, digitOf(expr.type), text(expr, around), mark::valueEnd);
    }
    const Text whole = printed(expr);
    const bool isMarked = needsBarrier(expr) && whole.isOperation;
    if (needsBarrier(expr) && (whole.isKnown || mayBeKnownZero(context_.module, expr)))
      return fmt::format("{}{}{}", mark::known, whole.text, mark::knownEnd);
    if (isDivisor && !isMarked && needsBarrier(expr) &&
        mayBeKnownDivisor(context_.module, context_.kernel, *function_, expr)) {
      const bool isBare = whole.precedence >= around;
      return fmt::format("{}{}{}{}{}", mark::divisor, isBare ? "" : "(", whole.text, isBare ? "" : ")",
                         mark::divisorEnd);
    }
    if (whole.precedence < around) {
      return isMarked ? fmt::format("{}{}{}", mark::bracketed, whole.text, mark::bracketedEnd)
                      : "(" + whole.text + ")";
    }
    return isMarked ? fmt::format("{}{}{}", mark::operation, whole.text, mark::operationEnd) : whole.text;
  }

  /// "place += value".
  std::string combined(BinaryOp op, const Expr& lvalue, const Expr& value) const {
    if (!isStored_ && isFloats(lvalue.type)) {
      return fmt::format("{} = {}{}{}{}", text(lvalue), mark::value, digitOf(lvalue.type),
                         storedText(lvalue, op, value), mark::valueEnd);
    }
    if (context_.marks && isFloats(lvalue.type) && !lvalue.type.isMatrix() && !isRoundingError(value)) {
      return fmt::format("{}{}{}{}{}{}{}", mark::compound, text(lvalue), mark::compoundNext, spelling(op),
                         mark::compoundNext, text(value, Precedence::LogicalOr, op == BinaryOp::Div),
                         mark::compoundEnd);
    }
    return fmt::format("{} {}= {}", text(lvalue), spelling(op), text(value));
  }

 private:
  /// Sets a flag while it lives.
  class Scope {
   public:
    Scope(bool& flag, bool value) : flag_(flag), before_(std::exchange(flag, value)) {}
    ~Scope() { flag_ = before_; }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    bool& flag_;
    bool before_;
  };

  /// An operation whose value goes to a variable.
  std::string storedText(const Expr& lhs, BinaryOp op, const Expr& rhs) const {
    const Scope scope(isStored_, true);
    const Text whole = binary(lhs.type, op, lhs, rhs);
    return whole.isOperation ? fmt::format("{}{}{}", mark::operation, whole.text, mark::operationEnd)
                             : whole.text;
  }

  /// The text of an expression that a function gets, or that decides what is computed: what it computes goes to no variable.
  std::string passedText(const Expr& expr, Precedence around = Precedence::Lowest) const {
    const Scope scope(isStored_, !context_.marks || !function_);
    return text(expr, around);
  }

  /// The text of an operand that is compared: if it is a literal 0, no compiler can make anything else of it.
  std::string comparedText(const Expr& expr, Precedence around = Precedence::Lowest) const {
    const Scope scope(isCompared_, isLiteral(expr));
    return text(expr, around);
  }

  /// False where nothing is computed when the program runs, and for values that are only copied.
  bool needsBarrier(const Expr& expr) const {
    return context_.marks && function_ && (context_.copied == nullptr || context_.copied->count(&expr) == 0);
  }

  /// True if this node adds, multiplies or divides floats when the program runs.
  bool isComputed(const Expr& expr) const {
    if (!isFloats(expr.type)) return false;
    if (const auto* n = std::get_if<Binary>(&expr.node)) {
      return row(n->op).precedence >= Precedence::Additive && !isMatrixProduct(n->op, *n->lhs, *n->rhs);
    }
    if (const auto* n = std::get_if<Convert>(&expr.node)) {  // to the same floats
      return isFloats(n->operand->type) && !expr.type.isNarrow() && isComputed(*n->operand);
    }
    const auto* n = std::get_if<IntrinsicCall>(&expr.node);
    return n != nullptr && computes(n->intrinsic);
  }

  /// How the mark of a value says its type.
  static char digitOf(Type type) {
    return static_cast<char>('0' + (type.isMatrix() ? type.width + 3 : std::max<int>(type.width, 1)));
  }

  Text printed(const Expr& expr) const {
    return match(expr.node, [&](const auto& node) { return print(expr, node); });
  }
  Text print(const Expr& expr, const Literal& n) const {
    if (expr.type.is64Bit()) return {wideText(expr.type.scalar, n)};
    const bool isMarkedZero = isFloats(expr.type) && isZero(n.bits) && !isCompared_ && needsBarrier(expr);
    return isMarkedZero ? markedZero(n.bits) : literalText(expr.type, n.bits);
  }
  Text print(const Expr&, const VarRef& n) const { return {context_.names.variable(*function_, n.var)}; }
  Text print(const Expr&, const ConstantRef& n) const { return {context_.types.constantUse(n.constant)}; }
  Text print(const Expr& expr, const Unary& n) const {
    if (n.op == UnaryOp::LogicalNot && context_.marks && function_ && ordersFloats(*n.operand)) {
      const std::string_view name = expr.type.isVector() ? mark::vectorNegation : mark::negation;
      return {fmt::format("{}({})", name, text(*n.operand)), Precedence::Unary};
    }
    if (n.op == UnaryOp::LogicalNot && expr.type.isVector()) return {"not(" + text(*n.operand) + ")"};
    return {std::string(spelling(n.op)) + text(*n.operand, Precedence::Primary), Precedence::Unary};
  }
  Text print(const Expr& expr, const Binary& n) const { return binary(expr.type, n.op, *n.lhs, *n.rhs); }
  Text print(const Expr&, const Select& n) const {
    if (n.cond->type.isVector())
      return {fmt::format("mix({}, {}, {})", text(*n.no), text(*n.yes), text(*n.cond))};
    return {fmt::format("{} ? {} : {}", passedText(*n.cond, Precedence::LogicalOr),
                        text(*n.yes, Precedence::LogicalOr), text(*n.no, Precedence::Conditional)),
            Precedence::Conditional};
  }
  Text print(const Expr& expr, const Convert& n) const {
    const bool keepsArithmetic = arithmeticScalar(n.operand->type.scalar) == expr.type.scalar;
    if (keepsArithmetic) return printed(*n.operand);
    // an int may be a loop's, which compilers know where they unroll it
    const bool isKnown = expr.type.isFloat() && !n.operand->type.isBool() && !isUnknown(*n.operand);
    return {context_.types.glsl(expr.type) + "(" + passedText(*n.operand) + ")", Precedence::Primary,
            /*isOperation=*/false, isKnown};
  }
  Text print(const Expr& expr, const Construct& n) const {
    return {context_.types.glsl(expr.type) + list(n.args)};
  }
  Text print(const Expr&, const Swizzle& n) const {
    std::string components;
    for (std::uint8_t component : n.components) components += "xyzw"[component];
    return {text(*n.base, Precedence::Primary) + "." + components};
  }
  Text print(const Expr&, const Member& n) const {
    return {text(*n.base, Precedence::Primary) + "." + context_.types.fieldName(n.base->type.index, n.field)};
  }
  Text print(const Expr&, const Index& n) const {
    return {text(*n.base, Precedence::Primary) + "[" + passedText(*n.index) + "]"};
  }
  Text print(const Expr&, const Call& n) const {
    const Function& callee = context_.module.functions[n.callee];
    const std::string_view prefix = callee.table ? "sk_table_" : "";
    const Scope scope(isStored_, !context_.marks || !function_);
    return {fmt::format("{}{}{}", prefix, callee.isLibrary ? callee.name : context_.names.function(n.callee),
                        list(n.args))};
  }
  Text print(const Expr&, const IntrinsicCall& n) const {
    const IntrinsicRow& entry = row(n.intrinsic);
    const auto defined = definedIntrinsic(n);
    const bool isOurs = defined || !entry.polyfill.empty();
    const bool isMarked = hasFormula(n.intrinsic) && context_.marks && function_;
    const Scope scope(isStored_, isOurs || isMarked ? !context_.marks || !function_ : isStored_);
    return {
        fmt::format("{}{}{}", isMarked ? mark::function : "", defined ? functionName(*defined) : entry.glsl,
                    chooses(n.intrinsic) ? comparedList(n.args) : list(n.args)),
        Precedence::Primary, /*isOperation=*/mayCancel(n.intrinsic)};
  }
  Text print(const Expr&, const GatherRead& n) const {
    return {call("sk_at", n.stream) + "(" + passedText(*n.index) + ")"};
  }
  Text print(const Expr&, const NeighborRead& n) const {
    return {call("sk_near", n.stream) + "(" + passedText(*n.offset) + ")"};
  }
  Text print(const Expr&, const Sample& n) const {
    return {call("sk_sample", n.stream) + "(" + passedText(*n.position) + ")"};
  }
  Text print(const Expr&, const IndexOf& n) const {
    const bool isInput = n.stream.space == StreamRef::Space::KernelParameter &&
                         context_.kernel.params[n.stream.id].role == ParamRole::Input;
    return {(isInput ? call("sk_index", n.stream) : "sk_index") + "()"};
  }
  Text print(const Expr&, const ExtentOf& n) const { return {call("sk_extent", n.stream) + "()"}; }

  Text binary(Type type, BinaryOp op, const Expr& lhs, const Expr& rhs) const {
    if (isComparison(op)) return comparison(op, lhs, rhs);
    if (isMatrixProduct(op, lhs, rhs) && context_.marks && function_) return matrixProduct(lhs, rhs);
    const Precedence precedence = row(op).precedence;
    const auto tighter = static_cast<Precedence>(static_cast<int>(precedence) + 1);
    const std::string second = operand(op, rhs, tighter, op == BinaryOp::Div);
    const bool isOperation = isFloats(type) && !type.isMatrix() && precedence >= Precedence::Additive;
    std::string first = operand(op, lhs, precedence);
    // a difference with itself is not 0, nor a quotient 1, if it is infinite or NaN
    if (isOperation && first == second && (op == BinaryOp::Sub || op == BinaryOp::Div) && context_.marks)
      first = fmt::format("{}{}{}", mark::known, first, mark::knownEnd);
    return {fmt::format("{} {} {}", first, spelling(op), second), precedence, isOperation};
  }

  /// The device's own product adds in an order of its own.
  Text matrixProduct(const Expr& lhs, const Expr& rhs) const {
    return {fmt::format("{}{}{}{}{}", mark::product, passedText(lhs, Precedence::Multiplicative), mark::times,
                        passedText(rhs, Precedence::Unary), mark::productEnd),
            Precedence::Multiplicative};
  }

  Text comparison(BinaryOp op, const Expr& lhs, const Expr& rhs) const {
    if (const std::optional<Intrinsic> function = row(op).vectors; lhs.type.isVector() && function)
      return {fmt::format("{}({}, {})", row(*function).glsl, comparedText(lhs), comparedText(rhs))};
    const Precedence precedence = row(op).precedence;
    const auto tighter = static_cast<Precedence>(static_cast<int>(precedence) + 1);
    return {fmt::format("{} {} {}", comparedOperand(op, lhs, precedence), spelling(op),
                        comparedOperand(op, rhs, tighter)),
            precedence};
  }

  /// "sk_at_u"; the domain has the shape of the first output, if there is one.
  std::string call(std::string_view function, StreamRef stream) const {
    const bool isDomain = stream.space == StreamRef::Space::Domain;
    const std::uint32_t param = isDomain ? analysis::domainParam(context_.kernel) : stream.id;
    if (param == context_.kernel.params.size()) return std::string(function);
    return fmt::format("{}_{}", function, context_.names.symbol(param));
  }

  std::string operand(BinaryOp outer, const Expr& expr, Precedence around, bool isDivisor = false) const {
    const auto* inner = std::get_if<Binary>(&expr.node);
    const bool clearer =
        inner != nullptr && !inner->lhs->type.isVector() && bracketsForClarity(outer, inner->op);
    return text(expr, clearer ? Precedence::Unary : around, isDivisor);
  }

  std::string comparedOperand(BinaryOp outer, const Expr& expr, Precedence around) const {
    const Scope scope(isCompared_, isLiteral(expr));
    return operand(outer, expr, around);
  }

  std::string comparedList(const std::vector<ExprPtr>& items) const {
    std::vector<std::string> texts;
    for (const ExprPtr& item : items) texts.push_back(comparedText(*item));
    return "(" + join(texts, ", ") + ")";
  }
  std::string list(const std::vector<ExprPtr>& items) const {
    std::vector<std::string> texts;
    for (const ExprPtr& item : items) texts.push_back(text(*item));
    return "(" + join(texts, ", ") + ")";
  }

  const GlslContext& context_;
  std::optional<FunctionId> function_;
  /// What is printed goes to a variable that the assembler may declare `precise`. GLSL computes precisely only what such a
  /// variable of the same function gets, directly or from others.
  mutable bool isStored_;
  mutable bool isCompared_ = false;  ///< what is printed is a literal whose value goes into no operation
};

}  // namespace

bool isDeclaredPrecise(const Function& function, VarId var) {
  return var >= function.parameterCount || function.variables[var].role == VarRole::InOut;
}

bool holdsFloats(const Module& module, Type type) {
  if (type.kind == Type::Kind::Array) return holdsFloats(module, module.arrays[type.index].element);
  if (type.kind != Type::Kind::Struct) return isFloats(type);
  return std::ranges::any_of(module.structs[type.index].fields,
                             [&](const StructField& field) { return holdsFloats(module, field.type); });
}

std::string_view declarationMark(const GlslContext& context, Type type) {
  return context.marks && holdsFloats(context.module, type) ? mark::declared : std::string_view();
}

std::string glslExpr(const GlslContext& context, std::optional<FunctionId> function, const Expr& expr,
                     Precedence around, bool isStored) {
  return GlslExpr(context, function, isStored).text(expr, around);
}

std::string glslAssignment(const GlslContext& context, FunctionId function, const Expr& place,
                           std::optional<BinaryOp> op, const Expr& value) {
  const bool isStored = holdsFloats(context.module, place.type) &&
                        isDeclaredPrecise(context.module.functions[function], rootOf(place));
  const GlslExpr printer(context, function, isStored);
  return op ? printer.combined(*op, place, value) : printer.text(place) + " = " + printer.text(value);
}

}  // namespace skc::emit
