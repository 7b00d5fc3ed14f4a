// SPDX-License-Identifier: MIT
#include "transforms/passes.hpp"

#include <algorithm>
#include <bit>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "ir/build.hpp"
#include "ir/call_graph.hpp"
#include "ir/ir.hpp"
#include "ir/walk.hpp"
#include "ir/walk_module.hpp"
#include "split/cost.hpp"
#include "transforms/check_limits.hpp"
#include "transforms/synthesized_kernel.hpp"

namespace skc {

using namespace ir;

namespace {

// Types with double instead of float, and conversions between the two.

class WideTypes {
 public:
  explicit WideTypes(ir::Module& module) : module_(module) {}

  /// True if the type contains a float or a vector of floats; matrices and half do not count.
  bool holdsFloat(ir::Type type) const;
  /// The wide type; the type itself if it contains no float. Structs get a second one, "Hit_wide".
  ir::Type of(ir::Type type);

  /// Converts a value to its wide type, and back.
  ir::ExprPtr widened(ir::ExprPtr value);
  ir::ExprPtr narrowed(ir::ExprPtr value, ir::Type to);

 private:
  ir::ExprPtr converted(ir::ExprPtr value, ir::Type to);

  ir::Module& module_;
  std::map<std::uint32_t, std::uint32_t> structs_;   ///< original to synthesized struct
};

bool WideTypes::holdsFloat(Type type) const {
  if (type.kind == Type::Kind::Array) return holdsFloat(module_.arrays[type.index].element);
  if (type.kind != Type::Kind::Struct) return type.isFloat();
  return std::ranges::any_of(module_.structs[type.index].fields,
                             [&](const StructField& field) { return holdsFloat(field.type); });
}

Type WideTypes::of(Type type) {
  if (!holdsFloat(type)) return type;
  if (type.kind == Type::Kind::Array) {
    const Array array = module_.arrays[type.index];
    return arrayOf(module_, of(array.element), array.length);
  }
  if (type.kind != Type::Kind::Struct) return type.withScalar(Scalar::Double);
  if (const auto known = structs_.find(type.index); known != structs_.end()) {
    return Type::structType(known->second);
  }
  Struct wide = module_.structs[type.index];
  wide.name += "_wide";
  wide.isSynthesized = true;
  for (StructField& field : wide.fields) field.type = of(field.type);
  module_.structs.push_back(std::move(wide));
  const auto index = static_cast<std::uint32_t>(module_.structs.size() - 1);
  structs_[type.index] = index;
  return Type::structType(index);
}

ExprPtr WideTypes::widened(ExprPtr value) {
  const Type to = of(value->type);
  return converted(std::move(value), to);
}

ExprPtr WideTypes::narrowed(ExprPtr value, Type to) { return converted(std::move(value), to); }

/// The value is evaluated once per part, since expressions have no side effects.
ExprPtr WideTypes::converted(ExprPtr value, Type to) {
  if (value->type == to) return value;
  const Loc loc = value->loc;
  if (to.isArithmetic()) return convert(to.scalar, std::move(value), loc);
  std::vector<ExprPtr> parts;
  if (to.kind == Type::Kind::Array) {
    const Array array = module_.arrays[to.index];
    for (std::uint32_t i = 0; i < array.length; ++i) {
      parts.push_back(
          converted(index(module_, clone(value), literal(static_cast<std::int32_t>(i)), loc), array.element));
    }
  } else {
    for (std::uint32_t i = 0; i < module_.structs[to.index].fields.size(); ++i) {
      parts.push_back(
          converted(member(module_, clone(value), i, loc), module_.structs[to.index].fields[i].type));
    }
  }
  return construct(to, std::move(parts), loc);
}

bool isStreamOfValues(ParamRole role) {
  return role == ParamRole::Input || role == ParamRole::Output || role == ParamRole::Gather ||
         role == ParamRole::Accumulator;
}

bool isAppendOutput(ParamRole role) {
  return role == ParamRole::VariableOutput || role == ParamRole::Scatter;
}

/// True for intrinsics that take a float's bits, or produce a float from bits.
bool isOfBits(Intrinsic intrinsic) {
  switch (intrinsic) {
    case Intrinsic::FloatBitsToInt:
    case Intrinsic::FloatBitsToUint:
    case Intrinsic::IntBitsToFloat:
    case Intrinsic::UintBitsToFloat:
    case Intrinsic::AsInt:
    case Intrinsic::AsUint:
    case Intrinsic::AsFloatInt:
    case Intrinsic::AsFloatUint:
    case Intrinsic::Nearest: return true;
    default: return false;
  }
}

// ---- what has no wide variant -------------------------------------------------------------------

/// Looks for operations that doubles do not support.
class UnsupportedOperations {
 public:
  UnsupportedOperations(const Module& module, WideTypes& types) : module_(module), types_(types) {}

  /// Returns the first obstacle, or "".
  std::string of(const Kernel& kernel) {
    found_.clear();
    for (const FunctionId id : functionsOf(module_, kernel)) {
      const Function& function = module_.functions[id];
      function_ = &function;
      kernel_ = &kernel;
      for (const Variable& variable : function.variables) check(variable.type, variable.loc);
      walkExprs(function.body, [&](const Expr& expr) { check(expr); });
    }
    return found_;
  }

 private:
  void check(const Expr& expr) {
    check(expr.type, expr.loc);
    if (const auto* n = std::get_if<Sample>(&expr.node); n != nullptr && gatherType(n->stream).isNarrow())
      note("sample() of a type with fewer bits interpolates in floats", expr.loc);
    const auto* call = std::get_if<IntrinsicCall>(&expr.node);
    if (call == nullptr || isOfBits(call->intrinsic)) return;
    std::vector<Type> arguments;
    for (const ExprPtr& argument : call->args) arguments.push_back(types_.of(argument->type));
    if (!resultType(call->intrinsic, arguments)) {
      note(fmt::format("{}() is one of floats alone", ir::row(call->intrinsic).spelling), expr.loc);
    }
  }

  Type gatherType(StreamRef stream) const {
    return stream.space == StreamRef::Space::Variable ? function_->variables[stream.id].type
                                                      : kernel_->params[stream.id].type;
  }

  void check(Type type, Loc loc) {
    if (type.isMatrix()) note("matrices are of floats", loc);
    if (type.kind == Type::Kind::Array) check(module_.arrays[type.index].element, loc);
    if (type.kind == Type::Kind::Struct) {
      for (const StructField& field : module_.structs[type.index].fields) check(field.type, loc);
    }
  }

  void note(const std::string& what, Loc loc) {
    if (!found_.empty()) return;
    found_ = loc.line == 0 ? what : fmt::format("{} ({}:{})", what, module_.sources[loc.file], loc.line);
  }

  const Module& module_;
  WideTypes& types_;
  const Kernel* kernel_ = nullptr;
  const Function* function_ = nullptr;  ///< the function being examined
  std::string found_;
};

// ---- the variant --------------------------------------------------------------------------------

/// Builds one kernel's wide variant; the kernel must have no obstacle.
class FloatWidener {
 public:
  FloatWidener(Module& module, WideTypes& types, std::map<ConstantId, ConstantId>& constants)
      : module_(module), types_(types), constants_(constants) {}

  /// `holdsFloats`: its inputs and outputs are streams of floats, not partial results of a reduce.
  KernelId widen(KernelId id, bool holdsFloats) {
    FunctionCopies copies;
    const FunctionId entry = copyFunction(module_, module_.kernels[id].entry, copies);
    Kernel variant = synthesizedFor(module_.kernels[id]);
    variant.signature = module_.kernels[id].signature;
    variant.entry = entry;
    if (const std::optional<Reduction>& plain = module_.kernels[id].reduction) {
      variant.reduction = Reduction{{}, plain->operands, plain->seeded};
    }
    for (std::size_t i = 0; i < module_.kernels[id].params.size(); ++i) {
      variant.params.push_back(param(module_.kernels[id].params[i], holdsFloats));
    }
    dropTables(module_, copies);
    for (const auto& [from, to] : copies) function(to, variant);
    module_.kernels.push_back(std::move(variant));
    return static_cast<KernelId>(module_.kernels.size() - 1);
  }

  /// A kernel that converts a reduce's accumulators, in order, from doubles to floats.
  KernelId finish(KernelId id) {
    SynthesizedKernel synthesized(module_.kernels[id], "_finish");
    std::vector<VarId> inputs;
    for (const bool isResult : {false, true}) {
      for (const KernelParam& accumulator : module_.kernels[id].params) {
        if (accumulator.role != ParamRole::Accumulator) continue;
        KernelParam param = makeParam(isResult ? "r_" + accumulator.name : accumulator.name,
                                      isResult ? ParamRole::Output : ParamRole::Input,
                                      types_.of(accumulator.type), accumulator.loc);
        if (isResult && param.type != accumulator.type) param.held = accumulator.type;
        const VarId var = synthesized.add(std::move(param));
        if (isResult) {
          synthesized.entry.body.push_back(
              assign(varRef(synthesized.entry, var), varRef(synthesized.entry, inputs[var - inputs.size()])));
        } else {
          inputs.push_back(var);
        }
      }
    }
    return synthesized.finish(module_);
  }

 private:
  KernelParam param(const KernelParam& plain, bool holdsFloats) {
    KernelParam wide = clone(plain);
    wide.type = isStreamOfValues(plain.role) ? types_.of(plain.type) : plain.type;
    const bool isPartial = plain.role == ParamRole::Accumulator || !holdsFloats;
    if (wide.type != plain.type && (!isPartial || plain.role == ParamRole::Gather)) wide.held = plain.type;
    wide.filter = false;
    wide.border = wideConstant(plain.border);
    wide.identity = wideConstant(plain.identity);
    return wide;
  }

  ExprPtr wideConstant(const ExprPtr& plain) {
    ExprPtr wide = clone(plain);
    if (wide) rewrite(wide, {});
    return wide;
  }

  /// Rewrites a function of `kernel`. The entry converts its non-stream values at its start.
  void function(FunctionId id, const Kernel& kernel) {
    std::map<VarId, VarId> wideOf;
    Block start;
    std::vector<VarId> kept;
    for (VarId i = 0; id == kernel.entry && i < kernel.params.size(); ++i) {
      if (isStreamOfValues(kernel.params[i].role)) continue;
      kept.push_back(i);
      Function& entry = module_.functions[id];
      const Variable plain = entry.variables[i];
      if (isAppendOutput(kernel.params[i].role) || !types_.holdsFloat(plain.type)) continue;
      const Type wide = types_.of(plain.type);
      const VarId local = addVariable(entry, plain.name + "_wide", wide, VarRole::Local, plain.loc);
      kept.push_back(local);
      wideOf[i] = local;
      start.push_back(declare(local, types_.widened(varRef(entry, i)), plain.loc));
    }
    for (VarId i = 0; i < module_.functions[id].variables.size(); ++i) {
      if (std::ranges::find(kept, i) != kept.end()) continue;
      const Type wide = types_.of(module_.functions[id].variables[i].type);
      module_.functions[id].variables[i].type = wide;
    }
    module_.functions[id].result = types_.of(module_.functions[id].result);
    Block body = std::move(module_.functions[id].body);
    const Function& function = module_.functions[id];
    walkStmts(body, [&](Stmt& stmt) {
      forEachOperand(stmt, [&](ExprPtr& slot) { rewrite(slot, {&function, &wideOf}); });
      // append outputs keep their element types
      if (auto* n = std::get_if<Push>(&stmt.node))
        n->value = toAppendOutput(function, n->stream, std::move(n->value), kernel);
      if (auto* n = std::get_if<Scatter>(&stmt.node))
        n->value = toAppendOutput(function, n->stream, std::move(n->value), kernel);
    });
    body.insert(body.begin(), std::make_move_iterator(start.begin()), std::make_move_iterator(start.end()));
    module_.functions[id].body = std::move(body);
  }

  ExprPtr toAppendOutput(const Function& function, StreamRef stream, ExprPtr value, const Kernel& kernel) {
    const Type type = stream.space == StreamRef::Space::Variable ? function.variables[stream.id].type
                                                                 : kernel.params[stream.id].type;
    return types_.narrowed(std::move(value), type);
  }

  struct Within {
    const Function* function = nullptr;
    const std::map<VarId, VarId>* wideOf = nullptr;
  };

  /// Rewrites operands first: a node's type follows from its operands'.
  void rewrite(ExprPtr& slot, const Within& within) {
    forEachOperand(*slot, [&](ExprPtr& operand) { rewrite(operand, within); });
    Expr& expr = *slot;
    if (auto* n = std::get_if<VarRef>(&expr.node)) {
      if (const auto wide = within.wideOf->find(n->var); wide != within.wideOf->end()) n->var = wide->second;
      expr.type = within.function->variables[n->var].type;
    } else if (std::holds_alternative<Literal>(expr.node) && expr.type.isFloat()) {
      slot = literal(wideValue(std::get<Literal>(expr.node)), expr.loc);
    } else if (auto* constant = std::get_if<ConstantRef>(&expr.node)) {
      constant->constant = wideOf(constant->constant);
      expr.type = types_.of(expr.type);
    } else if (std::holds_alternative<Convert>(expr.node)) {
      conversion(slot);
    } else if (auto* call = std::get_if<IntrinsicCall>(&expr.node);
               call != nullptr && isOfBits(call->intrinsic)) {
      ofBits(slot);
    } else {
      expr.type = types_.of(expr.type);
    }
  }

  /// Converts to and from narrow types through float, which represents all their values; a double to half in one step, which
  /// rounds once.
  static void conversion(ExprPtr& slot) {
    ExprPtr& operand = std::get<Convert>(slot->node).operand;
    const Type to = slot->type.isFloat() ? slot->type.withScalar(Scalar::Double) : slot->type;
    if (operand->type.isNarrow() && to.isDouble()) {
      const Scalar arithmetic = operand->type.arithmeticType().scalar;
      operand = convert(arithmetic, std::move(operand), slot->loc);
    } else if (operand->type.isDouble() && to.isNarrow() && to.scalar != Scalar::Half) {
      operand = convert(to.arithmeticType().scalar, std::move(operand), slot->loc);
    }
    if (operand->type == to) {
      ExprPtr value = std::move(operand);
      slot = std::move(value);
    } else {
      slot->type = to;
    }
  }

  static void ofBits(ExprPtr& slot) {
    for (ExprPtr& argument : std::get<IntrinsicCall>(slot->node).args) {
      if (argument->type.isDouble()) argument = convert(Scalar::Float, std::move(argument), slot->loc);
    }
    const Loc loc = slot->loc;
    if (slot->type.isFloat()) slot = convert(Scalar::Double, std::move(slot), loc);
  }

  ConstantId wideOf(ConstantId plain) {
    if (!types_.holdsFloat(module_.constants[plain].type)) return plain;
    if (const auto known = constants_.find(plain); known != constants_.end()) return known->second;
    Constant wide;
    wide.name = module_.constants[plain].name + "_wide";
    wide.type = types_.of(module_.constants[plain].type);
    wide.loc = module_.constants[plain].loc;
    wide.value = wideConstant(module_.constants[plain].value);
    module_.constants.push_back(std::move(wide));
    return constants_[plain] = static_cast<ConstantId>(module_.constants.size() - 1);
  }

  Module& module_;
  WideTypes& types_;
  std::map<ConstantId, ConstantId>& constants_;  ///< original to synthesized constant
};

/// True if a kernel computes any float.
bool computesFloats(const Module& module, const WideTypes& types, const Kernel& kernel) {
  for (const FunctionId id : functionsOf(module, kernel)) {
    bool found = std::ranges::any_of(module.functions[id].variables, [&](const Variable& variable) {
      return types.holdsFloat(variable.type);
    });
    walkExprs(module.functions[id].body,
              [&](const Expr& expr) { found = found || types.holdsFloat(expr.type); });
    if (found) return true;
  }
  return false;
}

/// True if the results of a fold, as doubles, fit into the kernel that combines them.
bool resultsFit(const Module& module, const Kernel& combine) {
  KernelSize size = sizeOf(module, combine);
  for (const KernelParam& param : combine.params) {
    if (param.role != ParamRole::Input && param.role != ParamRole::Accumulator) continue;
    for (const Type plane : split::planesOf(module, param.type)) {
      if (plane.isFloat() && plane.width > 2) ++size.planes;  // a plane holds two doubles
    }
  }
  return fits(size);
}

}  // namespace

void widenFloats(Module& module, Diagnostics&) {
  WideTypes types(module);
  std::map<ConstantId, ConstantId> constants;
  FloatWidener widener(module, types, constants);
  forEachDeclaredKernel(module, [&](KernelId id) {
    const bool readsOutputs = module.kernels[id].isPart && module.kernels[id].reduction;  // those are rounded
    if (module.kernels[id].isSynthesized || readsOutputs ||
        !computesFloats(module, types, module.kernels[id]))
      return;
    UnsupportedOperations obstacles(module, types);
    std::string obstacle = obstacles.of(module.kernels[id]);
    const std::optional<KernelId> combine =
        module.kernels[id].reduction ? module.kernels[id].reduction->combine : std::nullopt;
    if (combine && obstacle.empty()) obstacle = obstacles.of(module.kernels[*combine]);
    if (combine && obstacle.empty() && !resultsFit(module, module.kernels[*combine]))
      obstacle = "its results have too many members as doubles";
    if (!obstacle.empty()) {
      module.kernels[id].variants.whyNotWide = std::move(obstacle);
      return;
    }
    const KernelId wide = widener.widen(id, true);
    module.kernels[id].variants.wide = wide;
    if (!combine) return;
    // partial results are doubles, so even a fold that combines its own results has another variant for them
    const KernelId wideCombine = widener.widen(*combine, false);
    module.kernels[wide].reduction->combine = wideCombine;
    module.kernels[wideCombine].reduction->combine = wideCombine;
    const KernelId finish = widener.finish(id);
    module.kernels[wide].reduction->finish = finish;
  });
}

}  // namespace skc
