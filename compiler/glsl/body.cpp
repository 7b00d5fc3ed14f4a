// SPDX-License-Identifier: MIT
#include "glsl/body.hpp"

#include <algorithm>
#include <set>
#include <vector>

#include <fmt/format.h>

#include "analysis/copied_values.hpp"
#include "glsl/constants.hpp"
#include "glsl/float_intrinsics.hpp"
#include "glsl/line_writer.hpp"
#include "glsl/statements.hpp"
#include "ir/walk.hpp"

namespace skc::emit {
namespace {

using namespace ir;

/// What a kernel uses beside its functions.
class Used {
 public:
  /// Begins with what borders and identities use.
  explicit Used(const GlslContext& context)
      : module_(context.module),
        polyfills_(context.polyfills),
        structs_(module_.structs.size(), false),
        constants_(module_.constants.size(), false) {
    for (const KernelParam& param : context.kernel.params) {
      if (param.border) mark(*param.border);
      if (param.identity) mark(*param.identity);
    }
  }

  void mark(const Function& function) {
    mark(function.result);
    for (const Variable& var : function.variables) mark(var.type);
    walkStmts(function.body, [&](const Stmt& stmt) {
      forEachOperand(stmt, [&](const ExprPtr& operand) { mark(*operand); });
    });
  }

  /// True if this includes everything that `other` uses, but for polyfills.
  bool includes(const Used& other) const {
    return isWithin(other.structs_, structs_) && isWithin(other.constants_, constants_) &&
           std::ranges::all_of(other.intrinsics_, [&](const sk::program::IntrinsicUse& wanted) {
             return std::ranges::any_of(intrinsics_, [&](const sk::program::IntrinsicUse& use) {
               return use.intrinsic == wanted.intrinsic && use.ofDouble == wanted.ofDouble &&
                      (use.widths & wanted.widths) == wanted.widths;
             });
           });
  }
  bool hasStruct(std::size_t index) const { return structs_[index]; }
  bool hasConstant(std::size_t index) const { return constants_[index]; }
  bool hasPolyfill(const std::string& text) const { return std::ranges::count(polyfillTexts_, text) > 0; }
  /// Their definitions, callees before callers.
  const std::vector<std::string>& polyfillTexts() const { return polyfillTexts_; }
  const std::vector<sk::program::IntrinsicUse>& intrinsics() const { return intrinsics_; }

 private:
  static bool isWithin(const std::vector<bool>& few, const std::vector<bool>& many) {
    for (std::size_t i = 0; i < few.size(); ++i) {
      if (few[i] && !many[i]) return false;
    }
    return true;
  }

  void mark(const Expr& expr) {
    forEachOperand(expr, [&](const ExprPtr& operand) { mark(*operand); });
    mark(expr.type);
    if (const auto* n = std::get_if<ConstantRef>(&expr.node)) {
      if (!constants_[n->constant]) mark(*module_.constants[n->constant].value);
      constants_[n->constant] = true;
    } else if (const auto* call = std::get_if<Call>(&expr.node)) {
      if (module_.functions[call->callee].isLibrary) markPolyfill(call->callee);
    } else if (const auto* intrinsic = std::get_if<IntrinsicCall>(&expr.node)) {
      if (const auto defined = definedIntrinsic(*intrinsic)) {
        std::uint8_t& widths = use(*defined).widths;
        widths = static_cast<std::uint8_t>(widths | 1U << (intrinsic->args[0]->type.width - 1U));
      }
      const std::string_view polyfill = row(intrinsic->intrinsic).polyfill;
      if (!polyfill.empty()) add(withTypes(polyfill, intrinsic->args[0]->type) + "\n");
    }
  }

  void mark(Type type) {
    if (type.kind == Type::Kind::Array) mark(module_.arrays[type.index].element);
    if (type.kind != Type::Kind::Struct || structs_[type.index]) return;
    structs_[type.index] = true;
    for (const StructField& field : module_.structs[type.index].fields) mark(field.type);
  }

  void markPolyfill(FunctionId id) {
    const Polyfill& polyfill = polyfills_[id];
    for (const FunctionId callee : polyfill.callees) markPolyfill(callee);
    if (polyfill.ofDouble) use(*polyfill.ofDouble).ofDouble = true;
    add(polyfill.text);
  }

  void add(std::string text) {
    if (!text.empty() && !hasPolyfill(text)) polyfillTexts_.push_back(std::move(text));
  }

  sk::program::IntrinsicUse& use(sk::program::Intrinsic intrinsic) {
    const auto found = std::ranges::find(intrinsics_, intrinsic, &sk::program::IntrinsicUse::intrinsic);
    return found != intrinsics_.end() ? *found : intrinsics_.emplace_back(intrinsic, std::uint8_t{0});
  }

  const Module& module_;
  const Polyfills& polyfills_;
  std::vector<bool> structs_;
  std::vector<bool> constants_;
  std::vector<std::string> polyfillTexts_;
  std::vector<sk::program::IntrinsicUse> intrinsics_;
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
  Used used(context);
  for (const FunctionId id : ownFunctionsOf(context.module, context.kernel))
    used.mark(context.module.functions[id]);
  return used;
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
  const Used byParams(context), used = usedBy(context);
  GlslBody text{structsText(context, used), "", used.intrinsics()};
  for (const std::string& polyfill : used.polyfillTexts()) {
    const bool isOfParams = byParams.hasPolyfill(polyfill);
    (isOfParams ? text.declarations : text.body) += polyfill + "\n";
    if (!isOfParams) text.helpers.push_back(polyfill.size() + 1);
  }
  text.declarations += constantsText(context, [&](ConstantId id) { return byParams.hasConstant(id); });
  text.body += constantsText(context, [&](ConstantId id) {
    const bool isWanted = used.hasConstant(id) && !byParams.hasConstant(id);
    if (isWanted) text.names.push_back(context.types.constantName(id));
    return isWanted;
  });
  LineWriter writer;
  const std::vector<FunctionId> functions = ownFunctionsOf(context.module, context.kernel);
  for (const FunctionId id : functions) {
    if (id != functions.front()) writer.raw("\n");
    writeFunction(context, id, writer);
    const std::string& name = context.names.function(id);
    if (std::ranges::find(text.names, name) == text.names.end()) text.names.push_back(name);
  }
  text.body += writer.take();
  return text;
}

std::optional<std::string> glslAddition(const GlslContext& first, const GlslContext& second) {
  const Used program = usedBy(first), more = usedBy(second);
  if (!program.includes(more)) return std::nullopt;
  std::string text;
  for (const std::string& polyfill : more.polyfillTexts()) {
    if (!program.hasPolyfill(polyfill)) text += polyfill + "\n";
  }
  const std::vector<FunctionId> functions = ownFunctionsOf(first.module, first.kernel);
  const std::set<FunctionId> there(functions.begin(), functions.end());
  std::set<std::string> taken;
  for (const FunctionId id : functions) taken.insert(first.names.function(id));
  LineWriter writer;
  for (const FunctionId id : ownFunctionsOf(second.module, second.kernel)) {
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
