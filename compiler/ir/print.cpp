// SPDX-License-Identifier: MIT
//
// Prints IR expressions, with as few brackets as a person would write.
#include "ir/print.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "ir/operators.hpp"
#include "support/overloaded.hpp"
#include "support/text.hpp"

namespace skc::ir {
namespace {

class StmtPrinter {
 public:
  StmtPrinter(const Module& module, const Function& function) : module_(module), function_(function) {}

  std::string text(const Block& block, int depth) const {
    std::string result;
    for (const Stmt& stmt : block) result += text(stmt, depth);
    return result;
  }

 private:
  std::string text(const Stmt& stmt, int depth) const {
    const std::string indent(static_cast<std::size_t>(2 * depth), ' ');
    return match(
        stmt.node, [&](const Declare&) { return indent + simple(stmt) + ";\n"; },
        [&](const Assign&) { return indent + simple(stmt) + ";\n"; },
        [&](const CallStmt&) { return indent + simple(stmt) + ";\n"; },
        [&](const If& n) {
          const std::string otherwise = n.otherwise.empty() ? "" : " else " + braces(n.otherwise, depth);
          return fmt::format("{}if ({}) {}{}\n", indent, expr(n.cond), braces(n.then, depth), otherwise);
        },
        [&](const Loop& n) { return indent + loop(n, depth) + "\n"; },
        [&](const Switch& n) {
          std::string cases;
          for (const Case& one : n.cases) cases += label(one, indent) + text(one.body, depth + 2);
          return fmt::format("{0}switch ({1}) {{\n{2}{0}}}\n", indent, expr(n.value), cases);
        },
        [&](const Break&) { return indent + "break;\n"; },
        [&](const Continue&) { return indent + "continue;\n"; },
        [&](const Return& n) { return indent + (n.value ? "return " + expr(n.value) : "return") + ";\n"; },
        [&](const Scope& n) { return indent + braces(n.body, depth) + "\n"; },
        [&](const Push& n) {
          return fmt::format("{}{}push({}, {});\n", indent, where(n.mask), print(function_, n.stream),
                             expr(n.value));
        },
        [&](const Scatter& n) { return indent + where(n.mask) + scatter(n) + ";\n"; },
        [&](const Print& n) {
          std::string values;
          for (const ExprPtr& value : n.values) values += ", " + expr(value);
          return fmt::format("{}{}printf({}{});\n", indent, where(n.mask), quoted(n.format), values);
        });
  }

  /// The text of a C string literal for it.
  static std::string quoted(std::string_view format) {
    std::string text = "\"";
    for (const char c : format) {
      if (c == '\n') {
        text += "\\n";
      } else if (c == '"' || c == '\\') {
        text += {'\\', c};
      } else {
        text += c;
      }
    }
    return text + '"';
  }

  /// "where (mask) ": shorter than an If, and cannot be mistaken for one.
  std::string where(const ExprPtr& mask) const { return mask ? fmt::format("where ({}) ", expr(mask)) : ""; }

  /// "$1[i] += v", "$1[i] = min($1[i], v)".
  std::string scatter(const Scatter& n) const {
    const std::string place = fmt::format("{}[{}]", print(function_, n.stream), expr(n.index));
    const bool isFunction = n.op == ScatterOp::Min || n.op == ScatterOp::Max;
    return isFunction ? fmt::format("{0} = {1}({0}, {2})", place, spelling(n.op), expr(n.value))
                      : fmt::format("{} {} {}", place, spelling(n.op), expr(n.value));
  }

  /// A statement for the head of a `for`, without its semicolon; in braces if it does not fit there.
  std::string simple(const Stmt& stmt) const {
    if (const auto* n = std::get_if<Declare>(&stmt.node)) {
      const Variable& var = function_.variables[n->var];
      const std::string name = print(module_, function_, *nameExpr(n->var, var.type));
      const std::string init = n->init ? " = " + expr(n->init) : "";
      return (var.isConst ? "const " : "") + print(module_, var.type) + " " + name + init;
    }
    if (const auto* n = std::get_if<Assign>(&stmt.node)) {
      return fmt::format("{} {}= {}", expr(n->place), n->op ? spelling(*n->op) : "", expr(n->value));
    }
    if (const auto* n = std::get_if<CallStmt>(&stmt.node)) {
      std::vector<std::string> args;
      for (const ExprPtr& arg : n->args) args.push_back(expr(arg));
      return fmt::format("{}{}({})", n->result ? expr(n->result) + " = " : "",
                         module_.functions[n->callee].name, join(args, ", "));
    }
    return "{ " + text(stmt, 0) + " }";
  }

  std::string loop(const Loop& n, int depth) const {
    const std::string cond = n.cond ? expr(n.cond) : "true";
    switch (n.kind) {
      case LoopKind::While: return fmt::format("while ({}) {}", cond, braces(n.body, depth));
      case LoopKind::DoWhile: return fmt::format("do {} while ({});", braces(n.body, depth), cond);
      case LoopKind::For: break;
    }
    return fmt::format("for ({}; {}; {}) {}", simpleList(n.init), cond, simpleList(n.step),
                       braces(n.body, depth));
  }

  std::string simpleList(const Block& block) const {
    std::vector<std::string> texts;
    for (const Stmt& stmt : block) texts.push_back(simple(stmt));
    return join(texts, ", ");
  }

  std::string label(const Case& one, const std::string& indent) const {
    std::string text;
    for (std::int64_t value : one.values) text += fmt::format("{}  case {}:\n", indent, value);
    return one.isDefault ? text + indent + "  default:\n" : text;
  }

  std::string braces(const Block& block, int depth) const {
    if (block.empty()) return "{}";
    return "{\n" + text(block, depth + 1) + std::string(static_cast<std::size_t>(2 * depth), ' ') + "}";
  }

  static ExprPtr nameExpr(VarId var, Type type) {
    return std::make_unique<Expr>(Expr{type, {}, VarRef{var}});
  }
  std::string expr(const ExprPtr& e) const { return print(module_, function_, *e); }

  const Module& module_;
  const Function& function_;
};

std::string printVariable(const Module& module, const Variable& var) {
  return fmt::format("  {}: {} {}{}\n", var.name, spelling(var.role), print(module, var.type),
                     var.rank > 0 ? fmt::format(" rank {}", var.rank) : "");
}

std::string printParam(const Module& module, const Function& entry, const KernelParam& param,
                       std::size_t number) {
  const auto constant = [&](const ExprPtr& e) { return print(module, Function{}, *e); };
  std::string text =
      fmt::format("  ${} {}: {} {}", number, param.name, spelling(param.role), print(module, param.type));
  if (param.held) text += " held as " + print(module, *param.held);
  if (param.role == ParamRole::Gather) {
    text += fmt::format(" rank {} {}", param.rank, spelling(param.boundary));
  }
  if (param.role == ParamRole::Scatter)
    text += fmt::format(" rank {} {}", param.rank, spelling(param.scatter));
  if (param.pushes >= 0) text += fmt::format(" at most {}", param.pushes);
  if (param.border) text += "(" + constant(param.border) + ")";
  if (param.identity) text += " = " + constant(param.identity);
  if (param.range) text += fmt::format(" in [{}, {}]", param.range->low, param.range->high);
  if (param.neededIf) text += " if " + print(module, entry, *param.neededIf);
  if (param.planeCount != 0) {
    text += fmt::format(" planes {} to {}", param.firstPlane, param.firstPlane + param.planeCount - 1);
  }
  return text + "\n";
}

std::string printKernel(const Module& module, const Kernel& kernel) {
  std::string text =
      fmt::format("{} {}{}: entry @{}", wordOf(kernel), qualifier(kernel.scope), kernel.name, kernel.entry);
  if (kernel.reduction && kernel.reduction->combine) {
    const Kernel& combine = module.kernels[*kernel.reduction->combine];
    text += fmt::format(", combined by {}", &combine == &kernel ? "itself" : combine.name);
    if (combine.name == kernel.name && &combine != &kernel) text += fmt::format(" @{}", combine.entry);
  }
  if (kernel.reduction && kernel.reduction->seeded) text += ", seeded";
  if (kernel.reduction && kernel.reduction->compensated) {
    const Compensated& second = *kernel.reduction->compensated;
    text += fmt::format(", compensated by @{}, @{}{}", module.kernels[second.fold].entry,
                        module.kernels[second.finish].entry, second.term.empty() ? "" : " or in doubles");
  }
  if (kernel.reduction && kernel.reduction->finish) {
    text += fmt::format(", finished by @{}", module.kernels[*kernel.reduction->finish].entry);
  }
  for (const UnrolledVariant& variant : kernel.unrolled) {
    text += fmt::format(", unrolled @{} if ${} is {}", module.kernels[variant.kernel].entry, variant.spec,
                        variant.value);
  }
  if (kernel.variants.wide) text += fmt::format(", wide @{}", module.kernels[*kernel.variants.wide].entry);
  if (kernel.variants.half) text += fmt::format(", half @{}", module.kernels[*kernel.variants.half].entry);
  if (kernel.reduction) {
    for (const ExactSum& sum : kernel.reduction->exact) {
      text += fmt::format(", exactly by @{}, @{}", module.kernels[sum.fold].entry,
                          module.kernels[sum.finish].entry);
      if (sum.term.kernel) text += fmt::format(" or @{}", module.kernels[*sum.term.kernel].entry);
    }
  }
  if (kernel.parts && kernel.parts->inDoubles)
    text += fmt::format(", natively by @{}", module.kernels[*kernel.parts->inDoubles].entry);
  if (kernel.parts) {
    text += fmt::format(", outputs by @{}", module.kernels[kernel.parts->map].entry);
    if (kernel.parts->after)
      text += fmt::format(" and folded after by @{}", module.kernels[*kernel.parts->after].entry);
  }
  if (kernel.assertions)
    text += fmt::format(", checked by @{}", module.kernels[kernel.assertions->check].entry);
  if (kernel.pass) text += fmt::format(", pass {} of {}", kernel.pass->number, kernel.pass->count);
  text += "\n";
  for (std::size_t i = 0; i < kernel.params.size(); ++i) {
    text += printParam(module, module.functions[kernel.entry], kernel.params[i], i);
  }
  return text + "\n";
}

std::string printStream(const Module& module, const DeclaredStream& stream) {
  std::vector<std::string> extents;
  for (const DeclaredExtent& extent : stream.extents) {
    extents.push_back(extent.name.empty() ? std::to_string(extent.value) : extent.name);
  }
  return fmt::format("stream {} {}{}<{}>;\n\n", print(module, stream.type), qualifier(stream.scope),
                     stream.name, join(extents, ", "));
}

/// " table -5 to 5 in 1024, linear".
std::string printTable(const Table& table) {
  return fmt::format(" table {} to {} in {}, {}", table.low, table.high, table.intervals,
                     table.isCubic ? "cubic" : "linear");
}

std::string printStruct(const Module& module, const Struct& type) {
  std::string text = fmt::format("struct {}{} {{\n", qualifier(type.scope), type.name);
  for (const StructField& field : type.fields) {
    text += fmt::format("  {} {};\n", print(module, field.type), field.name);
  }
  return text + "};\n\n";
}

}  // namespace

std::string print(const Module& module, const Function& function) {
  std::string text;
  for (const Variable& var : function.variables) text += printVariable(module, var);
  return text + "{\n" + StmtPrinter(module, function).text(function.body, 1) + "}\n";
}

std::string print(const Module& module) {
  std::string text = fmt::format("module {}\n\n", module.file);
  for (const Struct& type : module.structs) text += printStruct(module, type);
  for (const DeclaredStream& stream : module.streams) text += printStream(module, stream);
  for (const Constant& constant : module.constants) {
    text += fmt::format("const {} {} = {};\n\n", print(module, constant.type), constant.name,
                        print(module, Function{}, *constant.value));
  }
  for (const Kernel& kernel : module.kernels) text += printKernel(module, kernel);
  for (std::size_t i = 0; i < module.functions.size(); ++i) {
    const Function& function = module.functions[i];
    text += fmt::format("function @{} {} -> {}{}\n{}\n", i, function.name, print(module, function.result),
                        function.table ? printTable(module.tables[*function.table]) : "",
                        print(module, function));
  }
  return text;
}

namespace {

std::vector<std::string_view> specNames(const Kernel& kernel) {
  std::vector<std::string_view> names;
  for (const KernelParam& param : kernel.params) {
    if (param.role == ParamRole::Spec) names.push_back(param.name);
  }
  return names;
}

/// "2 * radius + 1".
std::string text(const Kernel& kernel, const Distance& distance) {
  const std::vector<std::string_view> names = specNames(kernel);
  std::string result;
  const auto add = [&](std::int64_t number, const std::string& term) {
    result += result.empty() ? (number < 0 ? "-" : "") : (number < 0 ? " - " : " + ");
    result += term;
  };
  for (std::size_t s = 0; s < names.size(); ++s) {
    const int factor = distance.perSpec[s];
    if (factor == 0) continue;
    add(factor,
        std::abs(factor) == 1 ? std::string(names[s]) : fmt::format("{} * {}", std::abs(factor), names[s]));
  }
  if (result.empty() || distance.constant != 0)
    add(distance.constant, fmt::format("{}", std::abs(distance.constant)));
  return result;
}

/// The largest of several distances.
std::string farthest(const Kernel& kernel, const std::vector<Distance>& distances) {
  std::vector<std::string> texts;
  for (const Distance& distance : distances) {
    std::string one = text(kernel, distance);
    if (std::ranges::find(texts, one) == texts.end()) texts.push_back(std::move(one));
  }
  if (texts.size() > 1) std::erase(texts, "0");
  return texts.size() == 1 ? texts.front() : fmt::format("max({})", fmt::join(texts, ", "));
}

}  // namespace

std::string printReach(const Kernel& kernel, const KernelParam& param) {
  std::vector<std::string> texts;
  for (std::uint8_t d = 0; d < param.rank; ++d) {
    std::vector<Distance> below, above;
    Reach::Kind kind = Reach::Kind::Near;
    for (const Reach& reach : param.reach) {
      if (reach.dimension != d) continue;
      kind = std::max(kind, reach.kind);
      below.push_back(reach.below);
      above.push_back(reach.above);
    }
    std::string& one = texts.emplace_back(1, "xyzw"[d]);
    if (kind != Reach::Kind::Near) {
      one += kind == Reach::Kind::Whole ? " whole" : " computed";
      continue;
    }
    const std::string low = farthest(kernel, below), high = farthest(kernel, above);
    const bool isSum = low.find(' ') != std::string::npos && !low.starts_with("max");
    one += low == "0" ? " 0" : isSum ? fmt::format(" -({})", low) : " -" + low;
    if (low != "0" || high != "0") one += " to " + high;
  }
  return fmt::format("{}{}", fmt::join(texts, ", "), param.promise.empty() ? "" : ", as promised");
}

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
  return shortestDouble(std::bit_cast<double>(literal.wide())) + "d";
}

std::string wideText(Type type, const Literal& literal) {
  if (type.scalar == Scalar::Long) return std::to_string(static_cast<std::int64_t>(literal.wide())) + "l";
  return type.isDouble() ? doubleText(literal) : std::to_string(literal.wide()) + "ul";
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
          return Text{expr.type.is64Bit() ? wideText(expr.type, n) : literalText(expr.type, n.bits)};
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
