// SPDX-License-Identifier: MIT
#include "transforms/passes.hpp"

#include <algorithm>
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
#include "split/cost.hpp"
#include "transforms/check_limits.hpp"
#include "transforms/fold_copy.hpp"

namespace skc {

using namespace ir;

namespace {

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

Type widened(Type type) { return type.withScalar(Scalar::Double); }

// ---- what has no wide variant -------------------------------------------------------------------

/// Looks for operations that doubles do not support.
class UnsupportedOperations {
 public:
  explicit UnsupportedOperations(const Module& module) : module_(module) {}

  /// Returns the first obstacle, or "".
  std::string of(const Kernel& kernel) {
    found_.clear();
    for (const FunctionId id : functionsOf(module_, kernel)) {
      const Function& function = module_.functions[id];
      for (const Variable& variable : function.variables) check(variable.type, variable.loc);
      walkExprs(function.body, [&](const Expr& expr) { check(kernel, expr); });
    }
    return found_;
  }

 private:
  void check(const Kernel& kernel, const Expr& expr) {
    check(expr.type, expr.loc);
    const auto* sample = std::get_if<Sample>(&expr.node);
    if (sample != nullptr && kernel.params[sample->stream.id].type.isNarrow())
      note("sample() of a type with fewer bits interpolates in floats", expr.loc);
    const auto* call = std::get_if<IntrinsicCall>(&expr.node);
    if (call == nullptr || isOfBits(call->intrinsic)) return;
    std::vector<Type> arguments;
    for (const ExprPtr& argument : call->args)
      arguments.push_back(argument->type.isFloat() ? widened(argument->type) : argument->type);
    if (!resultType(call->intrinsic, arguments)) {
      note(fmt::format("{}() is one of floats alone", ir::row(call->intrinsic).spelling), expr.loc);
    }
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
  std::string found_;
};

// ---- the variant --------------------------------------------------------------------------------

/// Builds wide variants of kernels that have no obstacle.
class FloatWidener {
 public:
  explicit FloatWidener(Module& module) : module_(module) {}

  /// `holdsFloats`: its inputs and outputs are streams of floats, not partial results of a reduce.
  KernelId widen(KernelId id, bool holdsFloats) {
    FunctionCopies copies;
    Kernel variant = variantOf(module_, id, copies);
    for (KernelParam& param : variant.params) widen(param, holdsFloats);
    dropTables(module_, copies);
    for (const auto& [from, to] : copies) widen(to, variant);
    module_.kernels.push_back(std::move(variant));
    return static_cast<KernelId>(module_.kernels.size() - 1);
  }

  /// A kernel that converts a reduce's accumulators, in order, from doubles to floats.
  KernelId finish(KernelId id) {
    const Kernel& plain = module_.kernels[id];
    SynthesizedKernel synthesized(plain, "_finish");
    const std::vector<VarId> accumulators = paramsOf(plain, ParamRole::Accumulator);
    const auto wide = [&](VarId i) { return typeOf(plain.params[i].type); };
    const auto inputs = synthesized.addEach(plain, accumulators, ParamRole::Input, "", "", wide);
    const auto results = synthesized.addEach(plain, accumulators, ParamRole::Output, "r_", "", wide);
    Function& entry = synthesized.entry;
    for (std::size_t i = 0; i < results.size(); ++i) {
      KernelParam& result = synthesized.kernel.params[results[i]];
      const Type held = plain.params[accumulators[i]].type;
      if (result.type != held) result.held = held;
      entry.body.push_back(assign(varRef(entry, results[i]), varRef(entry, inputs[i])));
    }
    return synthesized.finish(module_);
  }

 private:
  void widen(KernelParam& param, bool holdsFloats) {
    const Type plain = param.type;
    if (isStreamOfValues(param.role)) param.type = typeOf(plain);
    const bool isPartial = param.role == ParamRole::Accumulator || !holdsFloats;
    if (param.type != plain && (!isPartial || param.role == ParamRole::Gather)) param.held = plain;
    param.filter = false;
    if (param.border) rewrite(param.border, {});
    if (param.identity) rewrite(param.identity, {});
  }

  /// The type with double instead of float. Structs get a second one, "Hit_wide".
  Type typeOf(Type type) {
    if (!holds(module_, type, Scalar::Float)) return type;
    if (type.kind == Type::Kind::Array) {
      const Array array = module_.arrays[type.index];
      return arrayOf(module_, typeOf(array.element), array.length);
    }
    if (type.kind != Type::Kind::Struct) return widened(type);
    if (const auto known = structs_.find(type.index); known != structs_.end()) return known->second;
    Struct wide = module_.structs[type.index];
    wide.name += "_wide";
    wide.isSynthesized = true;
    for (StructField& field : wide.fields) field.type = typeOf(field.type);
    module_.structs.push_back(std::move(wide));
    return structs_[type.index] = Type::structType(static_cast<std::uint32_t>(module_.structs.size() - 1));
  }

  /// Converts a value to or from its wide type. It is evaluated once per part, since expressions have no side effects.
  ExprPtr converted(ExprPtr value, Type to) const {
    if (value->type == to) return value;
    const Loc loc = value->loc;
    if (to.isArithmetic()) return convert(to.scalar, std::move(value), loc);
    std::vector<ExprPtr> parts;
    if (to.kind == Type::Kind::Array) {
      const Array& array = module_.arrays[to.index];
      for (std::uint32_t i = 0; i < array.length; ++i) {
        ExprPtr element = index(module_, clone(value), literal(static_cast<std::int32_t>(i)), loc);
        parts.push_back(converted(std::move(element), array.element));
      }
    } else {
      const std::vector<StructField>& fields = module_.structs[to.index].fields;
      for (std::uint32_t i = 0; i < fields.size(); ++i)
        parts.push_back(converted(member(module_, clone(value), i, loc), fields[i].type));
    }
    return construct(to, std::move(parts), loc);
  }

  /// Rewrites a function of `kernel`. The entry converts its non-stream values at its start. Values of append outputs keep
  /// their types.
  void widen(FunctionId id, const Kernel& kernel) {
    Function function = std::move(module_.functions[id]);
    std::map<VarId, VarId> wideOf;
    Block start;
    const std::size_t count = function.variables.size();
    for (VarId i = 0; i < count; ++i) {
      const Variable plain = function.variables[i];
      const bool isParam = id == kernel.entry && i < kernel.params.size();
      if (isParam && isAppendOutput(kernel.params[i].role)) continue;
      const Type wide = typeOf(plain.type);
      if (!isParam || isStreamOfValues(kernel.params[i].role)) {
        function.variables[i].type = wide;
      } else if (wide != plain.type) {
        wideOf[i] = addVariable(function, plain.name + "_wide", wide, VarRole::Local, plain.loc);
        start.push_back(declare(wideOf[i], converted(varRef(function, i), wide), plain.loc));
      }
    }
    function.result = typeOf(function.result);
    walkStmts(function.body, [&](Stmt& stmt) {
      forEachOperand(stmt, [&](ExprPtr& slot) { rewrite(slot, {&function, &wideOf}); });
      const auto narrow = [&](StreamRef stream, ExprPtr& value) {
        value = converted(std::move(value), kernel.params[stream.id].type);
      };
      if (auto* n = std::get_if<Push>(&stmt.node)) narrow(n->stream, n->value);
      if (auto* n = std::get_if<Scatter>(&stmt.node)) narrow(n->stream, n->value);
    });
    prepend(function.body, std::move(start));
    module_.functions[id] = std::move(function);
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
      expr.type = typeOf(expr.type);
    } else if (std::holds_alternative<Convert>(expr.node)) {
      conversion(slot);
    } else if (auto* call = std::get_if<IntrinsicCall>(&expr.node);
               call != nullptr && isOfBits(call->intrinsic)) {
      ofBits(slot);
    } else {
      expr.type = typeOf(expr.type);
    }
  }

  /// Converts to and from narrow types through float, which represents all their values; a double to half in one step, which
  /// rounds once.
  static void conversion(ExprPtr& slot) {
    ExprPtr& operand = std::get<Convert>(slot->node).operand;
    const Type to = slot->type.isFloat() ? widened(slot->type) : slot->type;
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
    return copyConstant(module_, plain, constants_, "_wide", [&](Constant& wide) {
      wide.type = typeOf(wide.type);
      rewrite(wide.value, {});
    });
  }

  Module& module_;
  std::map<std::uint32_t, Type> structs_;  ///< the wide type of each
  ConstantCopies constants_;
};

/// True if a kernel computes or stores any float.
bool usesFloats(const Module& module, const Kernel& kernel) {
  for (const FunctionId id : functionsOf(module, kernel)) {
    bool found = std::ranges::any_of(module.functions[id].variables, [&](const Variable& variable) {
      return holds(module, variable.type, Scalar::Float);
    });
    walkExprs(module.functions[id].body,
              [&](const Expr& expr) { found = found || holds(module, expr.type, Scalar::Float); });
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
  FloatWidener widener(module);
  forEachDeclaredKernel(module, [&](KernelId id) {
    const bool readsOutputs = module.kernels[id].isPart && module.kernels[id].reduction;  // those are rounded
    if (module.kernels[id].isSynthesized || readsOutputs || !usesFloats(module, module.kernels[id])) return;
    UnsupportedOperations obstacles(module);
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
