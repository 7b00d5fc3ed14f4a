// SPDX-License-Identifier: MIT
#include "ir/validate.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "ir/build.hpp"
#include "ir/call_graph.hpp"
#include "ir/operators.hpp"
#include "ir/validate_rules.hpp"
#include "ir/walk.hpp"
#include "support/overloaded.hpp"

namespace skc::ir {
namespace {

/// Prefixes a violation that `check` throws with its location.
template <class Fn>
void within(const std::string& place, Fn&& check) {
  try {
    check();
  } catch (const Violation& violation) {
    throw Violation{place + ": " + violation.text};
  }
}

// ---- statements -------------------------------------------------------------------------------

class FunctionChecker {
 public:
  FunctionChecker(const Module& module, Stage stage, const Function& function, const Kernel* kernel)
      : function_(function),
        visible_(function.variables.size(), false),
        declared_(function.variables.size(), false),
        context_{.module = module,
                 .stage = stage,
                 .function = &function,
                 .visible = &visible_,
                 .kernel = kernel,
                 .constantLimit = module.constants.size()} {}

  void check() {
    require(function_.parameterCount <= function_.variables.size(),
            "there are more parameters than variables");
    for (std::size_t i = 0; i < function_.variables.size(); ++i) {
      const Variable& var = function_.variables[i];
      within(fmt::format("'{}'", var.name), [&] { checkVariable(var, i < function_.parameterCount); });
      visible_[i] = i < function_.parameterCount;
    }
    block(function_.body);
  }

 private:
  void checkVariable(const Variable& var, bool isParameter) const {
    checkType(context_.module, var.type);
    require(!var.type.isVoid(), "a variable has no type");
    require(isParameter == (var.role != VarRole::Local),
            "parameters are the first variables, locals the others");
    const bool isGather = var.role == VarRole::Gather;
    const bool isAppendOutput = var.role == VarRole::AppendOutput;
    require(var.rank <= 4 && (isGather ? var.rank >= 1 : isAppendOutput || var.rank == 0),
            "gathers have rank 1 to 4, variable outputs and all but streams none");
  }

  void block(const Block& statements) {
    const std::vector<bool> outside = visible_;
    for (const Stmt& stmt : statements) checkStmt(stmt);
    visible_ = outside;
  }

  void checkStmt(const Stmt& stmt) {
    within(fmt::format("line {}", stmt.loc.line), [&] { match(stmt.node, [&](const auto& n) { rule(n); }); });
  }

  void rule(const Declare& n) {
    require(n.var < function_.variables.size(), "a declared variable is not in the table");
    const Variable& var = function_.variables[n.var];
    require(var.role == VarRole::Local, fmt::format("parameter '{}' is declared", var.name));
    require(!declared_[n.var], fmt::format("'{}' is declared twice", var.name));
    require(n.init != nullptr || !var.isConst, fmt::format("constant '{}' has no value", var.name));
    if (n.init) {
      checkExpr(context_, *n.init);
      require(n.init->type == var.type, fmt::format("'{}' is initialised with another type", var.name));
    }
    declared_[n.var] = true;
    visible_[n.var] = true;
  }
  void rule(const Assign& n) {
    checkLValue(context_, *n.place);
    checkExpr(context_, *n.value);
    if (!n.op) return require(n.place->type == n.value->type, "a value of another type is assigned");
    const bool isPlain =
        !isComparison(*n.op) && *n.op != BinaryOp::LogicalAnd && *n.op != BinaryOp::LogicalOr;
    require(isPlain, "a comparison is no compound assignment");
    checkBinary(*n.op, n.place->type, n.value->type, n.place->type);
  }
  void rule(const CallStmt& n) {
    checkArguments(context_, n.callee, n.args, true, n.result.get());
    if (!n.result) return;
    require(n.result->type == context_.module.functions[n.callee].result, "a call's result has another type");
  }
  void rule(const If& n) {
    condition(*n.cond);
    block(n.then);
    block(n.otherwise);
  }
  void rule(const Loop& n) {
    const bool isFor = n.kind == LoopKind::For;
    require(isFor || (n.init.empty() && n.step.empty()), "only a for loop has an init and a step");
    const std::vector<bool> outside = visible_;
    for (const Stmt& stmt : n.init) checkStmt(stmt);
    if (n.cond) condition(*n.cond);
    ++loops_;
    block(n.body);
    --loops_;
    block(n.step);
    visible_ = outside;
  }
  void rule(const Switch& n) {
    checkExpr(context_, *n.value);
    require(n.value->type.isScalar() && n.value->type.isInteger(), "the value of a switch is no int or uint");
    std::vector<std::int64_t> seen;
    int defaults = 0;
    const std::vector<bool> outside = visible_;   // the cases of a switch share one scope
    ++switches_;
    for (const Case& one : n.cases) {
      defaults += one.isDefault ? 1 : 0;
      for (std::int64_t value : one.values) {
        require(std::find(seen.begin(), seen.end(), value) == seen.end(), "a switch has a case twice");
        seen.push_back(value);
      }
      for (const Stmt& stmt : one.body) checkStmt(stmt);
    }
    --switches_;
    visible_ = outside;
    require(defaults <= 1, "a switch has two defaults");
  }
  void rule(const Break&) const { require(loops_ + switches_ > 0, "a break is in no loop or switch"); }
  void rule(const Continue&) const { require(loops_ > 0, "a continue is in no loop"); }
  void rule(const Return& n) const {
    const Type type = n.value ? n.value->type : Type::voidType();
    if (n.value) checkExpr(context_, *n.value);
    require(type == function_.result, "a return has another type than the function");
  }
  void rule(const Scope& n) { block(n.body); }
  void rule(const Push& n) const {
    checkExpr(context_, *n.value);
    checkAppendOutput(context_, n.stream, n.value->type, 0);
    mask(n.mask);
  }
  void rule(const Scatter& n) const {
    checkExpr(context_, *n.index);
    checkExpr(context_, *n.value);
    require(n.index->type.isArithmetic() && n.index->type.scalar == Scalar::Int,
            "a scatter's index is no int");
    checkAppendOutput(context_, n.stream, n.value->type, n.index->type.width);
    const bool isNumber = n.value->type.isFloat() || n.value->type.isInteger();
    require(n.op == ScatterOp::Store || isNumber, "something that is no number is combined");
    mask(n.mask);
  }
  void rule(const Print& n) const {
    for (const ExprPtr& value : n.values) {
      checkExpr(context_, *value);
      const Type type = value->type;
      require(type.isScalar() && !type.isNarrow() && !type.isBool(), "a printed value is no number");
    }
    mask(n.mask);
  }
  void mask(const ExprPtr& expr) const {
    if (!expr) return;
    require(context_.stage == Stage::Predicated, "there is a mask before predicate");
    condition(*expr);
  }

  void condition(const Expr& expr) const {
    checkExpr(context_, expr);
    require(expr.type == Type::of(Scalar::Bool), "a condition is no bool");
  }

  const Function& function_;
  std::vector<bool> visible_;
  std::vector<bool> declared_;
  ExprContext context_;
  int loops_ = 0;
  int switches_ = 0;
};

// ---- kernels ----------------------------------------------------------------------------------

VarRole roleInEntry(ParamRole role) {
  switch (role) {
    case ParamRole::Uniform:
    case ParamRole::Iterator:
    case ParamRole::Spec: return VarRole::In;
    case ParamRole::Input: return VarRole::Element;
    case ParamRole::Gather: return VarRole::Gather;
    case ParamRole::VariableOutput:
    case ParamRole::Scatter: return VarRole::AppendOutput;
    case ParamRole::Output:
    case ParamRole::Accumulator: break;
  }
  return VarRole::InOut;
}

void checkConstant(const Module& module, Stage stage, const Expr& expr, Type type) {
  checkExpr({.module = module, .stage = stage, .constantLimit = module.constants.size()}, expr);
  require(expr.type == type, "a constant has another type than its parameter");
}

void checkParam(const Module& module, Stage stage, const KernelParam& param, const Variable& var) {
  require(var.role == roleInEntry(param.role), "the entry's variable has another role");
  require(var.type == param.type && var.rank == param.rank, "the entry's variable has another type or rank");
  const bool wantsBorder = param.role == ParamRole::Gather && param.boundary == Boundary::Border;
  require((param.role == ParamRole::Scatter || param.role == ParamRole::Gather) == (param.rank > 0),
          "gathers and scatter outputs have a rank, others none");
  require(wantsBorder == (param.border != nullptr), "a border value and the border mode go together");
  require(!param.held || param.role == ParamRole::Input || param.role == ParamRole::Output ||
              param.role == ParamRole::Gather,
          "a parameter that is no stream holds another type");
  require(param.role == ParamRole::Accumulator || !param.identity, "only an accumulator has an identity");
  if (param.border) checkConstant(module, stage, *param.border, param.type);
  if (param.identity) checkConstant(module, stage, *param.identity, param.type);
}

/// A neededIf names only Spec parameters, and belongs to a parameter that can be left out.
void checkNeed(const Module& module, Stage stage, const Kernel& kernel, const KernelParam& param) {
  if (!param.neededIf) return;
  require(
      param.role == ParamRole::Input || param.role == ParamRole::Output || param.role == ParamRole::Gather,
      "a condition stands at a parameter that is no stream");
  const Function& entry = module.functions[kernel.entry];
  const std::vector<bool> visible(entry.variables.size(), true);
  checkExpr({.module = module,
             .stage = stage,
             .function = &entry,
             .visible = &visible,
             .constantLimit = module.constants.size()},
            *param.neededIf);
  require(param.neededIf->type == Type::of(Scalar::Bool), "a condition is no bool");
  walkExprs(*param.neededIf, [&](const Expr& expr) {
    const auto* ref = std::get_if<VarRef>(&expr.node);
    require(ref == nullptr ||
                (ref->var < kernel.params.size() && kernel.params[ref->var].role == ParamRole::Spec),
            "a condition names more than spec parameters");
  });
}

std::vector<Type> typesOf(const Kernel& kernel, ParamRole role) {
  std::vector<Type> types;
  for (const KernelParam& param : kernel.params) {
    if (param.role == role) types.push_back(param.type);
  }
  return types;
}

void checkReduction(const Module& module, const Kernel& kernel) {
  const std::vector<Type> accumulators = typesOf(kernel, ParamRole::Accumulator);
  for (const KernelParam& param : kernel.params) {
    require(param.role != ParamRole::VariableOutput && param.role != ParamRole::Scatter,
            "a reduce has an append output");
  }
  if (kernel.reduction->pattern) {
    for (const FoldTarget& target : kernel.reduction->pattern->targets) {
      require(target.accumulator < kernel.params.size() &&
                  kernel.params[target.accumulator].role == ParamRole::Accumulator,
              "a fold's target is no accumulator");
    }
  }
  if (!kernel.reduction->combine) return;
  require(*kernel.reduction->combine < module.kernels.size(), "the combining kernel is not in the table");
  const Kernel& combine = module.kernels[*kernel.reduction->combine];
  require(typesOf(combine, ParamRole::Input) == accumulators &&
              typesOf(combine, ParamRole::Accumulator) == accumulators,
          "the combining kernel does not fold accumulators");
  require(typesOf(combine, ParamRole::Output).empty(), "the combining kernel has an output");
  const std::vector<std::uint32_t>& operands = kernel.reduction->operands;
  require(operands.size() == combine.params.size(), "the combining kernel has too many or too few operands");
  for (std::size_t i = 0; i < operands.size(); ++i) {
    const ParamRole role = combine.params[i].role;
    if (role == ParamRole::Input || role == ParamRole::Accumulator) continue;
    require(operands[i] < kernel.params.size() && kernel.params[operands[i]].role == role &&
                kernel.params[operands[i]].type == combine.params[i].type,
            "an operand of the combining kernel is not there, or of another kind");
  }
}

void checkParts(const Module& module, const Kernel& kernel) {
  const auto check = [&](KernelId id, const std::vector<std::uint32_t>& operands) {
    require(id < module.kernels.size() && module.kernels[id].isPart, "a part of a fold is not in the table");
    const Kernel& part = module.kernels[id];
    require(part.params.size() == operands.size(), "a part of a fold has too many or too few operands");
    for (std::size_t i = 0; i < operands.size(); ++i) {
      require(operands[i] < kernel.params.size() && kernel.params[operands[i]].type == part.params[i].type,
              "an operand of a part of a fold is not there, or has another type");
    }
  };
  require(foldsBesideOutputs(kernel), "a kernel that does not fold beside outputs has parts");
  check(kernel.parts->map, kernel.parts->mapOperands);
  if (kernel.parts->after) check(*kernel.parts->after, kernel.parts->afterOperands);
}

/// slice-assertions sets the operands.
void checkAssertions(const Module& module, const Kernel& kernel) {
  const AssertionCheck& assertions = *kernel.assertions;
  require(assertions.check < module.kernels.size() && module.kernels[assertions.check].isPart,
          "a check of assertions is not in the table");
  const Kernel& check = module.kernels[assertions.check];
  require(!check.params.empty() && check.params.back().role == ParamRole::Output &&
              check.params.back().type == Type::of(Scalar::Int),
          "a check of assertions has no output for their numbers");
  for (std::size_t i = 0; i < assertions.operands.size(); ++i) {
    require(assertions.operands.size() + 1 == check.params.size() &&
                assertions.operands[i] < kernel.params.size() &&
                kernel.params[assertions.operands[i]].type == check.params[i].type,
            "an operand of a check of assertions is not there, or has another type");
  }
}

void checkPlan(const Module& module, const Kernel& kernel, const Plan& plan) {
  for (const Pass& pass : plan.passes) {
    require(pass.kernel < module.kernels.size(), "a pass is not in the table");
    const Kernel& passKernel = module.kernels[pass.kernel];
    require(passKernel.pass && &module.kernels[passKernel.pass->whole] == &kernel,
            "a pass belongs to another kernel");
    require(passKernel.params.size() == pass.operands.size(), "a pass has too many or too few operands");
    for (std::size_t i = 0; i < passKernel.params.size(); ++i) {
      const PassOperand& operand = pass.operands[i];
      require(operand.index < (operand.isTemporary ? plan.temporaries.size() : kernel.params.size()),
              "an operand of a pass is not there");
      const Type type =
          operand.isTemporary ? plan.temporaries[operand.index].type : kernel.params[operand.index].type;
      require(type == passKernel.params[i].type, "an operand of a pass has another type");
    }
  }
}

/// predicate appends a mask to the parameters of some functions.
void checkParameterCount(Stage stage, const Function& function, std::size_t expected) {
  const bool isLonger = stage == Stage::Predicated && function.parameterCount == expected + 1;
  require(isLonger || function.parameterCount == expected, "it has too many or too few parameters");
  if (!isLonger) return;
  const Variable& mask = function.variables[expected];
  require(mask.role == VarRole::In && mask.type == Type::of(Scalar::Bool), "its last parameter is no mask");
}

void checkKernel(const Module& module, Stage stage, const Kernel& kernel) {
  require(kernel.entry < module.functions.size(), "the entry is not in the table");
  const Function& entry = module.functions[kernel.entry];
  require(entry.result.isVoid(), "the entry returns a value");
  checkParameterCount(stage, entry, kernel.params.size());
  bool hasAccumulator = false;
  for (std::size_t i = 0; i < kernel.params.size(); ++i) {
    hasAccumulator = hasAccumulator || kernel.params[i].role == ParamRole::Accumulator;
    within(kernel.params[i].name, [&] {
      checkParam(module, stage, kernel.params[i], entry.variables[i]);
      checkNeed(module, stage, kernel, kernel.params[i]);
    });
  }
  require(hasAccumulator == kernel.reduction.has_value(), "a reduce and an accumulator go together");
  if (kernel.reduction) checkReduction(module, kernel);
  if (kernel.parts) checkParts(module, kernel);
  if (kernel.assertions) checkAssertions(module, kernel);
  for (const Plan& plan : kernel.plans) checkPlan(module, kernel, plan);
}

// ---- module -----------------------------------------------------------------------------------

/// After specialize-gathers: the kernel that owns each function, at most one.
std::vector<const Kernel*> owners(const Module& module) {
  std::vector<const Kernel*> owner(module.functions.size(), nullptr);
  for (const Kernel& kernel : module.kernels) {
    for (FunctionId id : functionsOf(module, kernel)) {
      require(owner[id] == nullptr, fmt::format("function @{} belongs to two kernels", id));
      owner[id] = &kernel;
      const Function& function = module.functions[id];
      for (std::size_t i = 0; id != kernel.entry && i < function.parameterCount; ++i) {
        const VarRole role = function.variables[i].role;
        require(role != VarRole::Gather && role != VarRole::Element && role != VarRole::AppendOutput,
                fmt::format("function @{} still takes a stream", id));
      }
    }
  }
  return owner;
}

void checkTables(const Module& module, Stage stage) {
  for (const Struct& type : module.structs) {
    for (const StructField& field : type.fields) {
      within("struct " + type.name, [&] { checkType(module, field.type); });
    }
  }
  for (const Array& array : module.arrays) {
    within("array", [&] { checkType(module, array.element); });
    require(array.length > 0, "an array has no elements");
  }
  for (const DeclaredStream& stream : module.streams) {
    within("stream " + stream.name, [&] {
      checkType(module, stream.type);
      require(!stream.extents.empty() && stream.extents.size() <= 4, "it has no rank of 1 to 4");
      for (const DeclaredExtent& extent : stream.extents) {
        require(extent.name.empty() == (extent.value > 0), "an extent is no constant and no name");
      }
    });
  }
  for (std::size_t i = 0; i < module.constants.size(); ++i) {
    const Constant& constant = module.constants[i];
    within("constant " + constant.name, [&] {
      require(constant.value != nullptr, "it has no value");
      checkExpr({.module = module, .stage = stage, .constantLimit = i}, *constant.value);
      require(constant.value->type == constant.type, "its value has another type");
    });
  }
}

void checkTabulated(const Module& module, Stage stage, const Function& function) {
  require(*function.table < module.tables.size(), "its values have no table in the module");
  checkParameterCount(stage, function, 1);
  require(function.result.isFloat() && function.result.isScalar() &&
              function.variables[0].role == VarRole::In && function.variables[0].type == function.result,
          "it has a table, but does not take one float and give one");
}

}  // namespace

std::string validate(const Module& module, Stage stage) {
  try {
    checkTables(module, stage);
    require(!findRecursion(module), "a function calls itself");
    for (const Kernel& kernel : module.kernels) {
      within("kernel " + kernel.name, [&] { checkKernel(module, stage, kernel); });
    }
    std::vector<const Kernel*> owner(module.functions.size(), nullptr);
    if (stage != Stage::Lowered) owner = owners(module);
    for (std::size_t i = 0; i < module.functions.size(); ++i) {
      const Function& function = module.functions[i];
      // functions cut off by folding may name streams, but have no kernel to check them against
      if (stage != Stage::Lowered && owner[i] == nullptr) continue;
      within(fmt::format("function @{} '{}'", i, function.name), [&] {
        FunctionChecker(module, stage, function, owner[i]).check();
        if (function.table) checkTabulated(module, stage, function);
      });
    }
  } catch (const Violation& violation) {
    return violation.text;
  }
  return {};
}

}  // namespace skc::ir
