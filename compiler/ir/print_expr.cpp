// SPDX-License-Identifier: MIT
//
// Prints IR expressions, with as few brackets as a person would write.
#include <algorithm>
#include <bit>
#include <cmath>

#include "ir/operators.hpp"
#include "ir/print.hpp"
#include "support/overloaded.hpp"
#include "support/text.hpp"

namespace skc::ir {
namespace {

/// A variable's name, followed by its number if the function has several variables of that name.
std::string nameOf(const Function& function, VarId var) {
  if (var >= function.variables.size()) return "var#" + std::to_string(var);
  const std::string& name = function.variables[var].name;
  const auto count = std::count_if(function.variables.begin(), function.variables.end(),
                                   [&](const Variable& other) { return other.name == name; });
  return count == 1 ? name : name + "#" + std::to_string(var);
}

std::string literalText(Type type, std::uint32_t bits) {
  if (type.isNarrow()) return spelling(type.scalar) + "(" + literalText(type.arithmeticType(), bits) + ")";
  if (type.scalar == Scalar::Bool) return bits != 0 ? "true" : "false";
  if (type.scalar == Scalar::Int) return std::to_string(static_cast<std::int32_t>(bits));
  if (type.scalar == Scalar::Uint) return std::to_string(bits) + "u";
  const float value = std::bit_cast<float>(bits);
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value < 0 ? "-inf" : "inf";
  return shortestFloat(value);
}

/// "0.1d": C++ has no suffix for doubles, and no other suffix uses this letter.
std::string doubleText(const Literal& literal) {
  return shortestDouble(std::bit_cast<double>(std::uint64_t{literal.high} << 32 | literal.bits)) + "d";
}

class ExprPrinter {
 public:
  ExprPrinter(const Module& module, const Function& function) : module_(module), function_(function) {}

  std::string text(const Expr& expr, Precedence context = Precedence::Lowest) const {
    const auto [inner, precedence] = printed(expr);
    return precedence < context ? "(" + inner + ")" : inner;
  }

 private:
  struct Text {
    std::string text;
    Precedence precedence = Precedence::Primary;
  };

  Text printed(const Expr& expr) const {
    return match(
        expr.node,
        [&](const Literal& n) {
          return Text{expr.type.isDouble() ? doubleText(n) : literalText(expr.type, n.bits)};
        },
        [&](const VarRef& n) { return Text{nameOf(function_, n.var)}; },
        [&](const ConstantRef& n) { return Text{module_.constants[n.constant].name}; },
        [&](const Unary& n) {
          return Text{std::string(spelling(n.op)) + text(*n.operand, Precedence::Primary), Precedence::Unary};
        },
        [&](const Binary& n) { return binary(n); },
        [&](const Select& n) {
          return Text{text(*n.cond, Precedence::LogicalOr) + " ? " + text(*n.yes, Precedence::LogicalOr) +
                          " : " + text(*n.no, Precedence::Conditional),
                      Precedence::Conditional};
        },
        [&](const Convert& n) { return Text{print(module_, expr.type) + "(" + text(*n.operand) + ")"}; },
        [&](const Construct& n) { return Text{print(module_, expr.type) + list(n.args, '{', '}')}; },
        [&](const Swizzle& n) {
          std::string components;
          for (std::uint8_t component : n.components) components += "xyzw"[component];
          return Text{text(*n.base, Precedence::Primary) + "." + components};
        },
        [&](const Member& n) {
          const Struct& type = module_.structs[n.base->type.index];
          return Text{text(*n.base, Precedence::Primary) + "." + type.fields[n.field].name};
        },
        [&](const Index& n) { return Text{text(*n.base, Precedence::Primary) + "[" + text(*n.index) + "]"}; },
        [&](const Call& n) { return Text{module_.functions[n.callee].name + list(n.args, '(', ')')}; },
        [&](const IntrinsicCall& n) {
          const IntrinsicRow& entry = row(n.intrinsic);
          return Text{std::string(entry.spelling.empty() ? entry.name : entry.spelling) +
                      list(n.args, '(', ')')};
        },
        [&](const GatherRead& n) { return Text{stream(n.stream) + "[" + text(*n.index) + "]"}; },
        [&](const NeighborRead& n) {
          return Text{"neighbor(" + stream(n.stream) + ", " + text(*n.offset) + ")"};
        },
        [&](const Sample& n) { return Text{"sample(" + stream(n.stream) + ", " + text(*n.position) + ")"}; },
        [&](const IndexOf& n) { return Text{"indexof(" + stream(n.stream) + ")"}; },
        [&](const ExtentOf& n) { return Text{"extentof(" + stream(n.stream) + ")"}; });
  }

  Text binary(const Binary& n) const {
    const Precedence precedence = row(n.op).precedence;
    const auto tighter = static_cast<Precedence>(static_cast<int>(precedence) + 1);
    return {operand(n.op, *n.lhs, precedence) + " " + std::string(spelling(n.op)) + " " +
                operand(n.op, *n.rhs, tighter),
            precedence};
  }

  std::string operand(BinaryOp outer, const Expr& expr, Precedence context) const {
    const auto* inner = std::get_if<Binary>(&expr.node);
    const bool clearer = inner != nullptr && bracketsForClarity(outer, inner->op);
    return text(expr, clearer ? Precedence::Unary : context);
  }

  std::string list(const std::vector<ExprPtr>& items, char open, char close) const {
    std::vector<std::string> texts;
    for (const ExprPtr& item : items) texts.push_back(text(*item));
    return open + join(texts, ", ") + close;
  }

  std::string stream(StreamRef ref) const { return print(function_, ref); }

  const Module& module_;
  const Function& function_;
};

}  // namespace

std::string print(const Function& function, StreamRef stream) {
  switch (stream.space) {
    case StreamRef::Space::Variable: return nameOf(function, stream.id);
    case StreamRef::Space::KernelParameter: return "$" + std::to_string(stream.id);
    case StreamRef::Space::Domain: break;
  }
  return "domain";
}

std::string print(const Module& module, const Function& function, const Expr& expr) {
  return ExprPrinter(module, function).text(expr);
}

}  // namespace skc::ir
