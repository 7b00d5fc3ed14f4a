// SPDX-License-Identifier: MIT
#include "glsl/body.hpp"

#include <algorithm>
#include <set>
#include <vector>

#include <fmt/format.h>

#include "analysis/copied_values.hpp"
#include "glsl/constants.hpp"
#include "glsl/line_writer.hpp"
#include "glsl/statements.hpp"
#include "ir/call_graph.hpp"
#include "ir/walk.hpp"

namespace skc::emit {
namespace {

using namespace ir;

/// The structs and constants that functions and expressions use.
class Used {
 public:
  explicit Used(const Module& module)
      : module_(module), structs_(module.structs.size(), false), constants_(module.constants.size(), false) {}

  void mark(const Function& function) {
    mark(function.result);
    for (const Variable& var : function.variables) mark(var.type);
    walkExprs(function.body, [&](const Expr& expr) { markOne(expr); });
  }
  void mark(const ExprPtr& expr) {
    if (expr) walkExprs(*expr, [&](const Expr& inner) { markOne(inner); });
  }

  /// True if this includes everything that `other` uses.
  bool includes(const Used& other) const {
    return isWithin(other.structs_, structs_) && isWithin(other.constants_, constants_);
  }
  bool hasStruct(std::size_t index) const { return structs_[index]; }
  bool hasConstant(std::size_t index) const { return constants_[index]; }

 private:
  static bool isWithin(const std::vector<bool>& few, const std::vector<bool>& many) {
    for (std::size_t i = 0; i < few.size(); ++i) {
      if (few[i] && !many[i]) return false;
    }
    return true;
  }

  void markOne(const Expr& expr) {
    mark(expr.type);
    const auto* n = std::get_if<ConstantRef>(&expr.node);
    if (n == nullptr || constants_[n->constant]) return;
    constants_[n->constant] = true;
    mark(module_.constants[n->constant].value);
  }

  void mark(Type type) {
    if (type.kind == Type::Kind::Array) mark(module_.arrays[type.index].element);
    if (type.kind != Type::Kind::Struct || structs_[type.index]) return;
    structs_[type.index] = true;
    for (const StructField& field : module_.structs[type.index].fields) mark(field.type);
  }

  const Module& module_;
  std::vector<bool> structs_;
  std::vector<bool> constants_;
};

std::string structText(const GlslContext& context, std::uint32_t index) {
  std::string text = fmt::format("struct {} {{\n", context.types.structName(index));
  const std::vector<StructField>& fields = context.module.structs[index].fields;
  for (std::uint32_t i = 0; i < fields.size(); ++i) {
    text +=
        fmt::format("  {};\n", context.types.declaration(fields[i].type, context.types.fieldName(index, i)));
  }
  return text + "};\n\n";
}

/// Adds a struct after the structs that it contains.
void addStructs(const GlslContext& context, const Used& used, std::uint32_t index, std::vector<bool>& done,
                std::string& text) {
  if (done[index] || !used.hasStruct(index)) return;
  done[index] = true;
  for (const StructField& field : context.module.structs[index].fields) {
    Type type = field.type;
    if (type.kind == Type::Kind::Array) type = context.module.arrays[type.index].element;
    if (type.kind == Type::Kind::Struct) addStructs(context, used, type.index, done, text);
  }
  text += structText(context, index);
}

std::string structsText(const GlslContext& context, const Used& used) {
  std::string text;
  std::vector<bool> done(context.module.structs.size(), false);
  for (std::uint32_t i = 0; i < done.size(); ++i) addStructs(context, used, i, done, text);
  return text;
}

/// Everything that a kernel uses.
Used usedBy(const GlslContext& context) {
  Used used(context.module);
  for (const KernelParam& param : context.kernel.params) {
    used.mark(param.border);
    used.mark(param.identity);
  }
  for (const FunctionId id : functionsOf(context.module, context.kernel))
    used.mark(context.module.functions[id]);
  return used;
}

/// True if `program` has all intrinsics that `others` needs from the assembler.
bool hasIntrinsics(const Polyfills& program, const Polyfills& others) {
  return std::ranges::all_of(others.intrinsics(), [&](const sk::program::IntrinsicUse& wanted) {
    return std::ranges::any_of(program.intrinsics(), [&](const sk::program::IntrinsicUse& use) {
      return use.intrinsic == wanted.intrinsic && use.ofDouble == wanted.ofDouble &&
             (use.widths & wanted.widths) == wanted.widths;
    });
  });
}

template <class Predicate>
std::string constantsText(const GlslContext& context, Predicate&& isWanted) {
  std::string text;
  for (ConstantId i = 0; i < context.module.constants.size(); ++i) {
    if (isWanted(i)) text += constantText(context, i);
  }
  return text.empty() ? text : text + "\n";
}

}  // namespace

GlslBody glslBody(const GlslContext& given) {
  const analysis::CopiedValues copied = analysis::copiedValues(given.module, given.kernel);
  GlslContext context = given;
  context.copied = &copied;
  Used byParams(context.module);
  for (const KernelParam& param : context.kernel.params) {
    for (const ExprPtr* expr : {&param.border, &param.identity}) {
      byParams.mark(*expr);
      if (*expr) glslExpr(context, std::nullopt, **expr);   // collects the polyfills that it needs
    }
  }
  const std::string paramConstants =
      constantsText(context, [&](ConstantId id) { return byParams.hasConstant(id); });
  const std::size_t paramPolyfills = context.polyfills.functions().size();

  const std::vector<FunctionId> functions = functionsOf(context.module, context.kernel);
  Used used = byParams;
  LineWriter writer;
  for (FunctionId id : functions) {
    used.mark(context.module.functions[id]);
    if (id != functions.front()) writer.raw("\n");
    writeFunction(context, id, writer);
  }
  const std::string constants = constantsText(
      context, [&](ConstantId id) { return used.hasConstant(id) && !byParams.hasConstant(id); });

  // assembled last, because only printing finds out which polyfills are needed
  GlslBody text{structsText(context, used), ""};
  const std::vector<std::string>& polyfills = context.polyfills.functions();
  for (std::size_t i = 0; i < polyfills.size(); ++i) {
    (i < paramPolyfills ? text.declarations : text.body) += polyfills[i] + "\n";
  }
  text.declarations += paramConstants;
  text.body += constants + writer.take();
  return text;
}

std::optional<std::string> glslAddition(const GlslContext& first, const GlslContext& second) {
  if (!usedBy(first).includes(usedBy(second)) || !hasIntrinsics(first.polyfills, second.polyfills))
    return std::nullopt;
  std::string text;
  for (const std::string& polyfill : second.polyfills.functions()) {
    const bool isThere = std::ranges::count(first.polyfills.functions(), polyfill) > 0;
    if (!isThere) text += polyfill + "\n";
  }
  const std::vector<FunctionId> functions = functionsOf(first.module, first.kernel);
  const std::set<FunctionId> there(functions.begin(), functions.end());
  std::set<std::string> taken;
  for (const FunctionId id : functions) taken.insert(first.names.function(id));
  LineWriter writer;
  for (const FunctionId id : functionsOf(second.module, second.kernel)) {
    const std::string& name = second.names.function(id);
    if (there.contains(id)) {
      if (first.names.function(id) != name) return std::nullopt;
    } else {
      if (taken.contains(name) || first.types.isConstantName(name)) return std::nullopt;
      writeFunction(second, id, writer);
    }
  }
  return text + writer.take();
}

}  // namespace skc::emit
