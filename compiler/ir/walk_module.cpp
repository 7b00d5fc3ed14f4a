// SPDX-License-Identifier: MIT
#include "ir/walk_module.hpp"

#include "ir/walk.hpp"

namespace skc::ir {
namespace {

/// Visits what declarations hold themselves. Each binding names all members, used or not.
template <class OnType, class OnExpr>
struct Visitor {
  OnType onType;
  OnExpr onExpr;

  void expression(const ExprPtr& expr) {
    if (expr) walkExprs(*expr, onExpr);
  }

  void visit(Constant& constant) {
    auto& [name, type, value, loc] = constant;
    onType(type);
    expression(value);
  }

  void visit(Variable& variable) {
    auto& [name, type, role, rank, isConst, loc] = variable;
    onType(type);
  }

  void visit(Function& function) {
    auto& [name, result, variables, parameterCount, body, loc, table, isLibrary] = function;
    onType(result);
    for (Variable& variable : variables) visit(variable);
    walkExprs(body, onExpr);
  }

  void visit(KernelParam& param) {
    auto& [name, role, type, held, rank, boundary, border, filter, identity, firstPlane, planeCount, loc,
           scatter, pushes, neededIf, reach, reachShapes, promise] = param;
    onType(type);
    if (held) onType(*held);
    expression(border);
    expression(identity);
    expression(neededIf);
  }

  void visit(Plan& plan) {
    auto& [limits, temporaries, bundles, passes, cost, costWithoutTemporaries] = plan;
    for (Temporary& temporary : temporaries) {
      auto& [name, type, computeCost, readers] = temporary;
      onType(type);
    }
    for (Bundle& bundle : bundles) {
      auto& [type, layers] = bundle;
      onType(type);
    }
  }

  void visit(Kernel& kernel) {
    auto& [name, scope, signature, entry, params, reduction, isScan, isSynthesized, isNativeOnly, parts,
           isPart, plans, pass, variants, choices, loops, unrolled, loc] = kernel;
    for (KernelParam& param : params) visit(param);
    for (Plan& plan : plans) visit(plan);
  }

  void visit(DeclaredStream& stream) {
    auto& [name, scope, type, extents, loc] = stream;
    onType(type);
  }

  void visit(Module& module) {
    auto& [file, sources, structs, arrays, constants, functions, tables, kernels, streams] = module;
    for (Constant& constant : constants) visit(constant);
    for (Function& function : functions) visit(function);
    for (Kernel& kernel : kernels) visit(kernel);
    for (DeclaredStream& stream : streams) visit(stream);
  }
};

}  // namespace

void walkExprs(Module& module, FunctionRef<void(Expr&)> fn) {
  Visitor{[](Type&) {}, fn}.visit(module);
}

void walkTypes(Module& module, FunctionRef<void(Type&)> fn) {
  Visitor{fn, [&](Expr& expr) { fn(expr.type); }}.visit(module);
}

void walkTypesInTypes(Module& module, FunctionRef<void(Type&)> fn) {
  for (Struct& type : module.structs) {
    auto& [name, scope, fields, loc, isSynthesized, aliases] = type;
    for (StructField& field : fields) {
      auto& [fieldName, fieldType] = field;
      fn(fieldType);
    }
  }
  for (Array& array : module.arrays) {
    auto& [element, length] = array;
    fn(element);
  }
}

}  // namespace skc::ir
