// SPDX-License-Identifier: MIT
#include "emit/native_code.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include <fmt/format.h>

#include "emit/cpp_names.hpp"
#include "emit/lanes_choice.hpp"
#include "emit/native_lanes.hpp"
#include "emit/native_stmt.hpp"
#include "emit/stream_uses.hpp"
#include "ir/reach.hpp"
#include "ir/walk.hpp"
#include "support/text.hpp"

namespace skc::emit {
namespace {

using namespace ir;

/// The constants that a kernel names, and those that these name, earlier ones first.
std::set<ConstantId> constantsOf(const Module& module, const Kernel& kernel) {
  std::set<ConstantId> found;
  const auto look = [&](const Expr& expr, const auto& again) -> void {
    walkExprs(expr, [&](const Expr& inner) {
      const auto* n = std::get_if<ConstantRef>(&inner.node);
      if (n != nullptr && found.insert(n->constant).second)
        again(*module.constants[n->constant].value, again);
    });
  };
  for (const FunctionId id : functionsOf(module, kernel)) {
    walkExprs(module.functions[id].body, [&](const Expr& expr) {
      if (std::holds_alternative<ConstantRef>(expr.node)) look(expr, look);
    });
  }
  for (const KernelParam& param : kernel.params) {
    for (const ExprPtr* expr : {&param.border, &param.identity}) {
      if (*expr) look(**expr, look);
    }
  }
  return found;
}

/// Overloads after the first get numbers.
std::map<FunctionId, std::string> functionNames(const Module& module, const Kernel& kernel,
                                                const KernelNames& names) {
  std::map<std::string, int> counts;
  std::map<FunctionId, std::string> result;
  for (const FunctionId id : functionsOf(module, kernel)) {
    const std::string& name = names.function(id);
    const int number = ++counts[name];
    result[id] = number == 1 ? name : fmt::format("sk_overload{}_{}", number, name);
  }
  return result;
}

bool hasIdentities(const Kernel& reduce) {
  return std::ranges::none_of(reduce.params, [](const KernelParam& param) {
    return param.role == ParamRole::Accumulator && param.identity == nullptr;
  });
}

/// Whether a kernel's struct may have its form for lanes, too.
enum class Lanes : std::uint8_t { No, IfGain };

class KernelWriter {
 public:
  KernelWriter(const Module& module, const Kernel& kernel, std::string_view name, Lanes lanes = Lanes::No)
      : module_(module),
        kernel_(kernel),
        types_(module),
        names_(module, kernel, types_),
        functions_(functionNames(module, kernel, names_)),
        context_{module, types_, names_, kernel, functions_},
        uses_(streamUses(module, kernel)),
        name_(fmt::format("sk_{}", name)),
        lanes_(lanes) {}

  /// Of a reduce that sums exactly: what an element adds where it does no more, one input or the product of two.
  KernelWriter& withExactTerm(std::vector<VarId> inputs) {
    exactTerm_ = std::move(inputs);
    return *this;
  }

  std::string write() {
    text_ = fmt::format("template <class sk_real{}>\nstruct {} {{\n",
                        hasInside()       ? ", bool sk_isInside = false"
                        : !term().empty() ? ", bool sk_isOfFloats = false"
                                          : "",
                        name_);
    members();
    forLoops();
    for (const ConstantId id : constantsOf(module_, kernel_)) constant(id);
    for (const FunctionId id : functionsOf(module_, kernel_)) text_ += nativeFunction(context_, id) + "\n";
    for (const FunctionId id : tabulatedFunctionsOf(module_, kernel_)) lookUp(functions_.at(id));
    if (kernel_.reduction) {
      reduction();
    } else {
      element();
      if (lanes_ == Lanes::IfGain) lanes();
    }
    return std::move(text_) + "};\n\n";
  }

 private:
  // ---- parameters -------------------------------------------------------------------------------

  void members() {
    std::vector<std::string> inits;
    for (std::uint32_t i = 0; i < kernel_.params.size(); ++i) {
      const KernelParam& param = kernel_.params[i];
      const std::string border = param.border ? ", " + nativeExpr(context_, std::nullopt, *param.border) : "";
      line(1, fmt::format("{} {};", memberType(i), member(i)));
      inits.push_back(fmt::format("{}(sk_call, {}{})", member(i), i, border));
    }
    std::size_t tables = 0;
    for (const FunctionId id : tabulatedFunctionsOf(module_, kernel_)) {
      const std::string& function = functions_.at(id);
      line(1, fmt::format("native::TableOf<sk_real> sk_values_{};", function));
      inits.push_back(fmt::format("sk_values_{}(sk_call.tables, {})", function, tables++));
    }
    line(1, "native::Index sk_index{}, sk_extent{};");
    line(1, "int sk_i = 0;\n");
    line(1, fmt::format("explicit {}(const native::Call& sk_call) : {} {{}}\n", name_, join(inits, ", ")));
  }

  std::string memberType(std::uint32_t i) const {
    static constexpr std::string_view boundaries[] = {"Clamp", "Wrap", "Mirror", "Border"};
    const KernelParam& param = kernel_.params[i];
    const std::string element = type(param.type);
    switch (param.role) {
      case ParamRole::Uniform:
      case ParamRole::Spec: return fmt::format("native::Uniform<{}>", element);
      case ParamRole::Input:
        return fmt::format("native::Input<{}{}>", element, !term().empty() ? ", sk_isOfFloats" : "");
      case ParamRole::Output:
      case ParamRole::Accumulator: return fmt::format("native::Output<{}>", element);
      case ParamRole::Gather:
        return fmt::format(
            "native::Gather<{}, {}, native::Boundary::{}{}>", element, param.rank,
            boundaries[static_cast<std::size_t>(param.boundary)],
            isInRow(i) ? fmt::format(", {}{}", uses_.params[i].reach, hasInside() ? ", sk_isInside" : "")
                       : "");
      case ParamRole::VariableOutput: return fmt::format("native::VariableOutput<{}>", element);
      case ParamRole::Scatter: return fmt::format("native::Scatter<{}, {}>", element, param.rank);
      case ParamRole::Iterator: return fmt::format("native::Iterator<{}>", element);
    }
    return {};
  }

  /// What run.hpp and fold.hpp want to know.
  void forLoops() {
    if (hasInside()) line(1, fmt::format("using sk_Inside = {}<sk_real, true>;", name_));
    const auto has = [&](ParamRole role) { return !paramsOf(role).empty(); };
    if (!kernel_.reduction) {
      const bool isOrdered = has(ParamRole::VariableOutput) || has(ParamRole::Scatter);
      line(1, fmt::format("static constexpr bool sk_isOrdered = {};", isOrdered));
    } else {
      line(1, fmt::format("static constexpr bool sk_isCommutative = {};", kernel_.reduction->commutative));
      if (!term().empty()) sumsOfFloats();
      if (!exactTerm_.empty()) sumsExactly();
    }
    line(1, fmt::format("static constexpr bool sk_isUneven = {};", uses_.loops));
    std::vector<std::string> placed;
    for (std::uint32_t i = 0; i < kernel_.params.size(); ++i) {
      switch (kernel_.params[i].role) {
        case ParamRole::Input:
        case ParamRole::Output:
        case ParamRole::Gather:
        case ParamRole::Iterator: placed.push_back(member(i)); break;
        case ParamRole::Uniform:
        case ParamRole::Spec:
        case ParamRole::Accumulator:
        case ParamRole::VariableOutput:
        case ParamRole::Scatter: break;
      }
    }
    line(1, fmt::format("auto sk_streams() {{ return std::tie({}); }}\n", join(placed, ", ")));
  }

  /// What an element adds where it does no more: one input, or the product of two.
  std::vector<VarId> term() const {
    const bool isSum = kernel_.reduction && kernel_.reduction->compensated;
    return isSum ? kernel_.reduction->compensated->term : std::vector<VarId>();
  }
  /// The form that sums what streams of floats hold in doubles.
  void sumsOfFloats() {
    line(1, "static constexpr bool sk_sumsFloats = std::is_same_v<sk_real, double>;");
    line(1, "static constexpr bool sk_readsFloats = sk_isOfFloats;");
    line(1, fmt::format("using sk_OfFloats = {}<sk_real, true>;", name_));
    termLine(term());
  }
  void sumsExactly() {
    line(1, "static constexpr bool sk_sumsExactly = std::is_same_v<sk_real, float>;");
    termLine(exactTerm_);
  }
  void termLine(const std::vector<VarId>& inputs) {
    line(1, fmt::format("auto sk_term() {{ return std::tie({}); }}",
                        list(inputs, [&](VarId i) { return member(i); })));
  }

  /// Whether a gather's neighbours are so near that most elements have them in their own row.
  bool isInRow(std::uint32_t param) const {
    constexpr std::int32_t farthest = 8;
    const std::int32_t reach = uses_.params[param].reach;
    return reach >= 0 && reach <= farthest;
  }
  bool hasInside() const {
    for (std::uint32_t i = 0; i < kernel_.params.size(); ++i) {
      if (isInRow(i) && !kernel_.reduction) return true;
    }
    return false;
  }

  void constant(ConstantId id) {
    const Constant& constant = module_.constants[id];
    line(1, fmt::format("static {} {}() {{ return {}; }}\n", type(constant.type),
                        nativeConstant(context_, id), nativeExpr(context_, std::nullopt, *constant.value)));
  }

  /// A function's value, from its table where the call has one.
  void lookUp(const std::string& function) {
    line(1, fmt::format("sk_real sk_table_{}(sk_real sk_x) {{", function));
    line(2, fmt::format("return sk_values_{0}.isGiven() ? sk_values_{0}.at(sk_x) : {0}(sk_x);", function));
    line(1, "}\n");
  }

  // ---- kernels ----------------------------------------------------------------------------------

  void element() {
    line(1, "void sk_element() {");
    for (std::uint32_t i = 0; i < kernel_.params.size(); ++i) {
      if (kernel_.params[i].role == ParamRole::Output) {
        line(2, fmt::format("{} sk_value_{}{{}};", type(kernel_.params[i].type), names_.symbol(i)));
      }
    }
    entryCall([&](std::uint32_t i) { return elementArgument(i); });
    for (std::uint32_t i = 0; i < kernel_.params.size(); ++i) {
      if (kernel_.params[i].role == ParamRole::Output) {
        line(2, fmt::format("{}.store(sk_i, sk_value_{});", member(i), names_.symbol(i)));
      }
    }
    line(1, "}");
  }

  /// The form of native_lanes.hpp.
  void lanes() {
    const Divergence divergence(module_, kernel_);
    if (!hasLanesForm(module_, kernel_, divergence) || !gainsByLanes(module_, kernel_, divergence)) return;
    const NativeContext context{module_, types_, names_, kernel_, functions_, &divergence};
    text_ += "\n";
    line(1, "static constexpr bool sk_hasLanes = std::is_same_v<sk_real, float>;\n");
    for (const FunctionId id : functionsOf(module_, kernel_)) {
      if (id == kernel_.entry || divergence.of(id).differs()) text_ += lanesFunctionText(context, id) + "\n";
    }
    line(1, "void sk_lanes() {");
    const std::vector<std::uint32_t> outputs = paramsOf(ParamRole::Output);
    for (const std::uint32_t i : outputs) {
      line(2,
           fmt::format("{} sk_value_{}{{}};", lanesType(context, kernel_.params[i].type), names_.symbol(i)));
    }
    std::vector<std::string> args;
    forEachArgument([&](std::uint32_t i) {
      const ParamRole role = kernel_.params[i].role;
      const bool isPlaced = role == ParamRole::Input || role == ParamRole::Iterator;
      const std::string value = isPlaced ? member(i) + ".lanesAt(sk_i)" : elementArgument(i);
      const bool isSpread = role == ParamRole::Uniform || role == ParamRole::Spec;
      args.push_back(isSpread && divergence.differs(kernel_.entry, i)
                         ? fmt::format("native::spread({})", value)
                         : value);
    });
    line(2, fmt::format("{}({});", lanesFunction(context, kernel_.entry), join(args, ", ")));
    for (const std::uint32_t i : outputs) {
      line(2, fmt::format("{}.storeLanes(sk_i, sk_value_{});", member(i), names_.symbol(i)));
    }
    line(1, "}");
  }

  std::string elementArgument(std::uint32_t i) const {
    switch (kernel_.params[i].role) {
      case ParamRole::Uniform:
      case ParamRole::Spec: return member(i) + ".get()";
      case ParamRole::Input:
      case ParamRole::Iterator: return member(i) + ".at(sk_i)";
      case ParamRole::Output: return "sk_value_" + names_.symbol(i);
      case ParamRole::Gather:
      case ParamRole::VariableOutput:
      case ParamRole::Scatter:
      case ParamRole::Accumulator: break;  // no arguments, or not of a kernel
    }
    return {};
  }

  /// visit(i) for every parameter that the entry takes.
  template <class Visit>
  void forEachArgument(Visit&& visit) const {
    for (std::uint32_t i = 0; i < kernel_.params.size(); ++i) {
      const VarRole role = module_.functions[kernel_.entry].variables[i].role;
      if (role != VarRole::Gather && role != VarRole::Sink) visit(i);
    }
  }
  template <class Argument>
  void entryCall(Argument&& argument) {
    std::vector<std::string> args;
    forEachArgument([&](std::uint32_t i) { args.push_back(argument(i)); });
    line(2, fmt::format("{}({});", functions_.at(kernel_.entry), join(args, ", ")));
  }

  // ---- reduces ----------------------------------------------------------------------------------

  void reduction() {
    const std::vector<std::uint32_t> accumulators = paramsOf(ParamRole::Accumulator);
    const std::vector<std::uint32_t> inputs = paramsOf(ParamRole::Input);
    line(1, fmt::format("using sk_State = std::tuple<{}>;",
                        list(accumulators, [&](std::uint32_t i) { return type(kernel_.params[i].type); })));
    line(1, fmt::format("static constexpr bool sk_isSeeded = {};\n", kernel_.reduction->seeded));
    if (kernel_.reduction->seeded) {
      line(1, fmt::format("sk_State sk_seed() const {{ return sk_State({}); }}",
                          list(inputs, [&](std::uint32_t i) { return member(i) + ".at(sk_i)"; })));
    }
    if (hasIdentities(kernel_)) {
      line(1, fmt::format("sk_State sk_identity() const {{ return sk_State({}); }}",
                          list(accumulators, [&](std::uint32_t i) {
                            return nativeExpr(context_, std::nullopt, *kernel_.params[i].identity);
                          })));
    }
    line(1, "void sk_fold([[maybe_unused]] sk_State& sk_state) {");
    entryCall([&](std::uint32_t i) {
      const bool isAccumulator = kernel_.params[i].role == ParamRole::Accumulator;
      return isAccumulator ? ofState("sk_state", accumulators, i) : elementArgument(i);
    });
    line(1, "}");
    if (combines(inputs, accumulators)) {
      line(1, "void sk_combine(sk_State& sk_state, const sk_State& sk_later) {");
      entryCall([&](std::uint32_t i) {
        const ParamRole role = kernel_.params[i].role;
        if (role == ParamRole::Accumulator) return ofState("sk_state", accumulators, i);
        return role == ParamRole::Input ? ofState("sk_later", inputs, i) : elementArgument(i);
      });
      line(1, "}");
    }
    line(1, "void sk_store(const native::Index& sk_at, const sk_State& sk_state) const {");
    for (const std::uint32_t i : accumulators) {
      line(2, fmt::format("{}.store(sk_at, {});", member(i), ofState("sk_state", accumulators, i)));
    }
    line(1, "}");
  }

  /// Whether the inputs are of the accumulators' types.
  bool combines(const std::vector<std::uint32_t>& inputs,
                const std::vector<std::uint32_t>& accumulators) const {
    return std::ranges::equal(inputs, accumulators, [&](std::uint32_t a, std::uint32_t b) {
      return kernel_.params[a].type == kernel_.params[b].type;
    });
  }

  static std::string ofState(std::string_view state, const std::vector<std::uint32_t>& params,
                             std::uint32_t param) {
    return fmt::format("std::get<{}>({})", std::ranges::find(params, param) - params.begin(), state);
  }

  std::vector<std::uint32_t> paramsOf(ParamRole role) const {
    std::vector<std::uint32_t> found;
    for (std::uint32_t i = 0; i < kernel_.params.size(); ++i) {
      if (kernel_.params[i].role == role) found.push_back(i);
    }
    return found;
  }

  template <class Text>
  static std::string list(const std::vector<std::uint32_t>& params, Text&& text) {
    std::vector<std::string> items;
    for (const std::uint32_t i : params) items.push_back(text(i));
    return join(items, ", ");
  }

  void line(int depth, const std::string& text) {
    const std::size_t indent = static_cast<std::size_t>(depth) * 2;
    text_ += wrapLine(std::string(indent, ' ') + text, 110, indent + 4) + "\n";
  }

  std::string member(std::uint32_t param) const { return nativeParameter(context_, param); }
  std::string type(Type t) const { return nativeType(module_, types_, t); }

  const Module& module_;
  const Kernel& kernel_;
  TypeNames types_;
  KernelNames names_;
  std::map<FunctionId, std::string> functions_;
  NativeContext context_;
  StreamUses uses_;
  std::string name_;
  Lanes lanes_;
  std::vector<VarId> exactTerm_;
  std::string text_;
};

/// A struct, after those that are members of it.
void addStruct(const Module& module, const TypeNames& types, std::uint32_t index, std::vector<bool>& isDone,
               std::string& text) {
  if (isDone[index]) return;
  isDone[index] = true;
  const std::vector<StructField>& fields = module.structs[index].fields;
  const std::string& name = types.structName(index);
  std::string declarations;
  std::vector<std::string> members;
  for (std::uint32_t i = 0; i < fields.size(); ++i) {
    Type inner = fields[i].type;
    if (inner.kind == Type::Kind::Array) inner = module.arrays[inner.index].element;
    if (inner.kind == Type::Kind::Struct) addStruct(module, types, inner.index, isDone, text);
    declarations +=
        fmt::format("  {} {};\n", nativeType(module, types, fields[i].type), types.fieldName(index, i));
    members.push_back(fmt::format("&{}::{}", name, types.fieldName(index, i)));
  }
  text += fmt::format("template <class sk_real>\nstruct {} {{\n{}", name, declarations);
  text += wrapLine(fmt::format("  static constexpr auto sk_members() {{ return std::tuple({}); }}\n}};\n\n",
                               join(members, ", ")),
                   110, 6);
}

std::string structs(const Module& module) {
  const TypeNames types(module);
  std::string text;
  std::vector<bool> isDone(module.structs.size(), false);
  for (std::uint32_t i = 0; i < isDone.size(); ++i) addStruct(module, types, i, isDone, text);
  return text;
}

std::span<const std::string_view> realTypes(Reals reals) {
  static constexpr std::string_view all[] = {"float", "double", "native::Quad"};
  return std::span(all).first(static_cast<std::size_t>(reals) + 1);
}

/// The functions around the loops of a kernel, one for each real type.
class Loops {
 public:
  Loops(std::string name, Speed speed, std::string parameters, std::string arguments)
      : name_(std::move(name)),
        speed_(speed),
        parameters_(std::move(parameters)),
        arguments_(std::move(arguments)) {}

  /// What to call: `loop` itself, or a function that is added to `text`.
  std::string define(const std::string& loop, std::string_view real, std::string& text) const {
    const bool isFloat = real == "float";
    const bool isDouble = real == "double" && speed_ == Speed::Best;
    if (speed_ == Speed::Any || !(isFloat || isDouble)) return loop;
    const std::string function = name_ + (isFloat ? "Loop" : "DoubleLoop");
    text += fmt::format("{} void {}({}) {{\n  {}({});\n}}\n", isFloat ? "SK_NATIVE_HOT" : "SK_NATIVE_INLINED",
                        function, parameters_, loop, arguments_);
    return function;
  }

 private:
  std::string name_;
  Speed speed_;
  std::string parameters_, arguments_;
};

/// The form of a kernel in half precision, if it has one, and what combines it, where that is another.
std::string halfForm(const Module& module, const Kernel& kernel, const std::string& name) {
  if (!kernel.forms.half) return {};
  const Kernel& half = module.kernels[*kernel.forms.half];
  std::string text = KernelWriter(module, half, name + "Half").write();
  if (half.reduction && *half.reduction->combine != *kernel.forms.half) {
    text += KernelWriter(module, module.kernels[*half.reduction->combine], name + "HalfCombine").write();
  }
  return text;
}

/// A reduce's term (Compensated), by the parameters of its exact form, which has none of its accumulators.
std::vector<VarId> exactTerm(const Kernel& reduce) {
  std::vector<VarId> inputs;
  if (reduce.reduction->compensated) inputs = reduce.reduction->compensated->term;
  for (VarId& input : inputs) {
    input -= static_cast<VarId>(std::ranges::count(reduce.params.begin(), reduce.params.begin() + input,
                                                   ParamRole::Accumulator, &KernelParam::role));
  }
  return inputs;
}

/// The kernels of a reduce's exact sums, and what combines them, unless that is among `combinations` already.
std::string exactSums(const Module& module, const Kernel& reduce, const std::string& name,
                      std::set<KernelId>& combinations) {
  const Reduction& reduction = *reduce.reduction;
  std::string text;
  for (std::size_t k = 0; k < reduction.exact.size(); ++k) {
    const Kernel& fold = module.kernels[reduction.exact[k].fold];
    const KernelId combine = *fold.reduction->combine;
    const ExactNames made(name, k);
    if (combinations.insert(combine).second) {
      const Kernel& kernel = module.kernels[combine];
      text += KernelWriter(module, kernel, exactCombinationName(kernel)).write();
    }
    text += KernelWriter(module, fold, made.fold).withExactTerm(exactTerm(reduce)).write();
    text += KernelWriter(module, module.kernels[reduction.exact[k].finish], made.finish).write();
  }
  return text;
}

}  // namespace

std::string nativeListing(const Module& module, const Program& program, Reals reals) {
  const std::vector<std::string> names = descriptorNames(module, program);
  const auto isUnit = [&](KernelId id) {
    return std::ranges::any_of(program.units(), [&](const Unit& unit) { return unit.id == id; });
  };
  std::string text = fmt::format(
      "#include <limits>\n\n#include <sk/native/native.hpp>\n{}\nnamespace sk::generated {{\nnamespace {{\n\n"
      "using namespace native::literals;\n\n{}",
      reals == Reals::Quad ? "#include <sk/native/quad.hpp>\n" : "", structs(module));
  const std::vector<std::string> tables = tableNames(module);
  for (TableId id = 0; id < tables.size(); ++id) {
    if (const std::optional<KernelId> values = module.tables[id].kernel) {
      text += KernelWriter(module, module.kernels[*values], tables[id]).write();
    }
  }
  std::set<KernelId> combinations;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const Kernel& kernel = module.kernels[program.units()[i].id];
    text += KernelWriter(module, kernel, names[i], Lanes::IfGain).write();
    if (kernel.reduction && !isUnit(*kernel.reduction->combine)) {
      text += KernelWriter(module, module.kernels[*kernel.reduction->combine], names[i] + "Combine").write();
    }
    if (kernel.reduction && kernel.reduction->compensated) {
      const Compensated& second = *kernel.reduction->compensated;
      const Kernel& fold = module.kernels[second.fold];
      const CompensatedNames made(names[i]);
      text += KernelWriter(module, fold, made.fold).write();
      text += KernelWriter(module, module.kernels[*fold.reduction->combine], made.combine).write();
      text += KernelWriter(module, module.kernels[second.finish], made.finish).write();
    }
    text += halfForm(module, kernel, names[i]);
    if (kernel.reduction) text += exactSums(module, kernel, names[i], combinations);
  }
  return text + "}  // namespace\n}  // namespace sk::generated\n";
}

std::string nativeKernelDescriptor(const std::string& name, NativeForm form) {
  const Loops loops(name, form.speed, "const native::Call& call, native::Range pieces", "call, pieces");
  std::string text;
  std::vector<std::string> code;
  for (const std::string_view real : realTypes(form.reals)) {
    const std::string kernel = fmt::format("generated::sk_{}<{}>", name, real);
    const std::string loop = loops.define(fmt::format("native::runPieces<{}>", kernel), real, text);
    code.push_back(fmt::format("&native::runKernel<{}, &{}>", kernel, loop));
  }
  if (form.reals == Reals::Single) code.emplace_back("nullptr");
  return fmt::format("{}constexpr NativeKernel {}Native = {{{}}};\n\n", text, name, join(code, ",\n    "));
}

std::string nativeReductionDescriptor(const std::string& name, const std::string& combine,
                                      const Kernel& reduce, NativeForm form) {
  std::string text;
  std::vector<std::string> code;
  for (const std::string_view real : realTypes(form.reals)) {
    const std::string fold = fmt::format("generated::sk_{}<{}>", name, real);
    const std::string both = fmt::format("{}, generated::sk_{}<{}>", fold, combine, real);
    const Loops loops(
        name, form.speed,
        fmt::format("const native::ReduceCall& call, native::Range pieces, {}::sk_State* states", fold),
        "call, pieces, states");
    const std::string loop = loops.define(fmt::format("native::foldPieces<{}>", both), real, text);
    const std::string identity =
        hasIdentities(reduce) ? fmt::format(", &native::storeIdentity<{}>", fold) : "";
    code.push_back(fmt::format("{{&native::runReduction<{}, &{}>{}}}", both, loop, identity));
  }
  return fmt::format("{}constexpr NativeReduction {}Native = {{\n    {}}};\n\n", text, name,
                     join(code, ",\n    "));
}

}  // namespace skc::emit
