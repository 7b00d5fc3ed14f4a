// SPDX-License-Identifier: MIT
#include "native/library/link_library.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <map>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "ir/build.hpp"
#include "ir/call_graph.hpp"
#include "ir/walk.hpp"
#include "native/library/sources.hpp"
#include "transforms/fold_copy.hpp"

namespace skc::native {

using namespace ir;

namespace {

/// The files of the library that implement an intrinsic.
enum class In : std::uint8_t { None, Floats, Reals, Sums };

struct Row {
  Intrinsic intrinsic;
  In in;
  std::string_view function;
};

// The forms of the column `library`.
#define SKC_LIBRARY_None In::None, ""
#define SKC_LIBRARY_Floats(function) In::Floats, #function
#define SKC_LIBRARY_Reals(function) In::Reals, #function
#define SKC_LIBRARY_Sums(function) In::Sums, #function
constexpr Row rows[] = {
#define SKC_INTRINSIC(Name, spelling, signatures, library, native, glsl, polyfill) \
  {Intrinsic::Name, SKC_LIBRARY_##library},
#include "ir/intrinsics.def"
#undef SKC_INTRINSIC
};

struct Library {
  std::string_view file;
  std::string_view (*text)();
  bool (*has)(In in);
  std::optional<Scalar> scalar;  ///< type of the first argument that it is for; nullopt: any
};
constexpr Library libraries[] = {
    {"float_functions.sk", floatFunctions, [](In in) { return in == In::Floats || in == In::Reals; },
     Scalar::Float},
    {"double_functions.sk", doubleFunctions, [](In in) { return in == In::Reals; }, Scalar::Double},
    {"exact_sums.sk", exactSums, [](In in) { return in == In::Sums; }, std::nullopt},
};

/// The rows whose intrinsics kernels call with arguments of the type that the library is for.
std::vector<Row> wantedRows(const Library& library, const Module& module) {
  std::vector<bool> isWanted(std::size(rows));
  const auto look = [&](const Expr& expr) {
    const auto* call = std::get_if<IntrinsicCall>(&expr.node);
    if (call == nullptr) return;
    const auto index = static_cast<std::size_t>(call->intrinsic);
    const bool isForType = !library.scalar || call->args.front()->type.scalar == *library.scalar;
    if (isForType && library.has(rows[index].in)) isWanted[index] = true;
  };
  for (const Kernel& kernel : module.kernels) {
    for (const FunctionId id : functionsOf(module, kernel)) walkExprs(module.functions[id].body, look);
  }
  std::vector<Row> wanted;
  for (std::size_t i = 0; i < isWanted.size(); ++i) {
    if (isWanted[i]) wanted.push_back(rows[i]);
  }
  return wanted;
}

/// Compares names and types, because `atan` is two intrinsics.
bool implements(const Function& function, const Row& row) {
  std::vector<Type> parameters;
  for (std::uint32_t i = 0; i < function.parameterCount; ++i)
    parameters.push_back(function.variables[i].type);
  return function.name == row.function && resultType(row.intrinsic, parameters) == function.result;
}

FunctionId implementation(const Module& library, const Row& row) {
  const auto found = std::ranges::find_if(
      library.functions, [&](const Function& function) { return implements(function, row); });
  if (found == library.functions.end()) {
    throw std::logic_error(fmt::format("{} has no function {} with the types of the intrinsic {}",
                                       library.file, row.function, ir::row(row.intrinsic).name));
  }
  return static_cast<FunctionId>(found - library.functions.begin());
}

}  // namespace

std::optional<FunctionId> LinkedFunctions::find(Intrinsic intrinsic, Scalar scalar) const {
  const auto found = functions_.find({intrinsic, scalar});
  return found == functions_.end() ? std::nullopt : std::optional(found->second);
}

void LinkedFunctions::add(Intrinsic intrinsic, Scalar scalar, FunctionId function) {
  functions_[{intrinsic, scalar}] = function;
}

LinkedFunctions linkLibrary(Module& module, const CompileLibrary& compile) {
  LinkedFunctions linked;
  for (const Library& library : libraries) {
    const std::vector<Row> wanted = wantedRows(library, module);
    if (wanted.empty()) continue;
    const Module compiled = compile(library.file, library.text());
    FunctionImporter importer(module, compiled);
    for (const Row& row : wanted) {
      const FunctionId function = importer.import(implementation(compiled, row));
      linked.add(row.intrinsic, module.functions[function].variables[0].type.scalar, function);
    }
  }
  return linked;
}

FunctionId FunctionImporter::import(FunctionId id) {
  if (const auto known = functions_.find(id); known != functions_.end()) return known->second;
  Function copy = clone(from_.functions[id]);
  copy.loc = {};
  copy.isLibrary = true;
  copy.result = importType(copy.result);
  for (Variable& variable : copy.variables) {
    variable.type = importType(variable.type);
    variable.loc = {};
  }
  adapt(copy.body);
  to_.functions.push_back(std::move(copy));
  return functions_[id] = static_cast<FunctionId>(to_.functions.size() - 1);
}

ConstantId FunctionImporter::importConstant(ConstantId id) {
  if (const auto known = constants_.find(id); known != constants_.end()) return known->second;
  const Constant& constant = from_.constants[id];
  Constant copy{constant.name, importType(constant.type), clone(*constant.value), {}};
  walkExprs(*copy.value, [&](Expr& expr) { adapt(expr); });
  to_.constants.push_back(std::move(copy));  // after the constants that its value names
  return constants_[id] = static_cast<ConstantId>(to_.constants.size() - 1);
}

Type FunctionImporter::importType(Type type) {
  if (type.kind == Type::Kind::Struct) return Type::structType(importStruct(type.index));
  if (type.kind != Type::Kind::Array) return type;
  const Array& array = from_.arrays[type.index];
  return arrayOf(to_, importType(array.element), array.length);
}

std::uint32_t FunctionImporter::importStruct(std::uint32_t index) {
  if (const auto known = structs_.find(index); known != structs_.end()) return known->second;
  Struct copy = from_.structs[index];
  for (StructField& field : copy.fields) field.type = importType(field.type);
  copy.loc = {};
  copy.isSynthesized = true;  // not a type of the user's program
  to_.structs.push_back(std::move(copy));
  return structs_[index] = static_cast<std::uint32_t>(to_.structs.size() - 1);
}

void FunctionImporter::adapt(Expr& expr) {
  expr.loc = {};
  expr.type = importType(expr.type);
  if (auto* call = std::get_if<Call>(&expr.node)) call->callee = import(call->callee);
  if (auto* reference = std::get_if<ConstantRef>(&expr.node))
    reference->constant = importConstant(reference->constant);
}

void FunctionImporter::adapt(Block& block) {
  walkStmts(block, [&](Stmt& stmt) {
    stmt.loc = {};
    if (auto* call = std::get_if<CallStmt>(&stmt.node)) call->callee = import(call->callee);
    if (auto* choice = std::get_if<Switch>(&stmt.node)) {
      for (Case& one : choice->cases) one.loc = {};
    }
  });
  walkExprs(block, [&](Expr& expr) { adapt(expr); });
}

namespace {

class KernelCalls {
 public:
  KernelCalls(Module& module, const LinkedFunctions& linked) : module_(module), linked_(linked) {}

  void rewrite(const Kernel& kernel) {
    for (const FunctionId id : functionsOf(module_, kernel)) {
      // adding functions may move them all
      Block body = std::move(module_.functions[id].body);
      rewriteExprs(body, [&](ExprPtr& slot) { rewrite(slot); });
      module_.functions[id].body = std::move(body);
    }
  }

 private:
  void rewrite(ExprPtr& slot) {
    auto* n = std::get_if<IntrinsicCall>(&slot->node);
    if (n == nullptr) return;
    const Type type = n->args.front()->type;
    const auto function = linked_.find(n->intrinsic, type.scalar);
    if (!function) return;
    std::vector<Type> types;
    for (const ExprPtr& arg : n->args) types.push_back(arg->type);
    const bool isWhole = module_.functions[*function].variables[0].type == type;
    const FunctionId called = isWhole ? copyFunction(module_, *function, copies_)
                                      : ofVectors(n->intrinsic, *function, types, slot->type);
    slot = makeExpr(slot->type, Call{called, std::move(n->args)}, slot->loc);
  }

  /// A function of vectors that calls one of scalars for each component; a scalar argument serves for every
  /// call.
  FunctionId ofVectors(Intrinsic intrinsic, FunctionId scalars, const std::vector<Type>& types, Type result) {
    std::vector<std::uint8_t> widths;
    for (const Type& type : types) widths.push_back(type.width);
    const auto [known, isNew] = ofVectors_.try_emplace({intrinsic, types.front().scalar, widths}, 0);
    if (!isNew) return known->second;
    const FunctionId component = copyFunction(module_, scalars, copies_);
    Function wrapper;
    wrapper.name = fmt::format("{}_{}", module_.functions[component].name, result.width);
    wrapper.result = result;
    wrapper.loc = module_.functions[component].loc;
    for (const Type& type : types) addVariable(wrapper, "x", type, VarRole::In);
    std::vector<ExprPtr> components;
    for (std::uint8_t i = 0; i < result.width; ++i) {
      std::vector<ExprPtr> args;
      for (VarId var = 0; var < types.size(); ++var) {
        ExprPtr whole = varRef(wrapper, var);
        args.push_back(types[var].isScalar()
                           ? std::move(whole)
                           : makeExpr(types[var].component(), Swizzle{std::move(whole), {i}}));
      }
      components.push_back(call(module_, component, std::move(args)));
    }
    wrapper.body.push_back(returnStmt(construct(result, std::move(components))));
    module_.functions.push_back(std::move(wrapper));
    return known->second = static_cast<FunctionId>(module_.functions.size() - 1);
  }

  Module& module_;
  const LinkedFunctions& linked_;
  FunctionCopies copies_;
  std::map<std::tuple<Intrinsic, Scalar, std::vector<std::uint8_t>>, FunctionId> ofVectors_;
};

}  // namespace

void callLibrary(Module& module, const LinkedFunctions& linked) {
  if (linked.empty()) return;
  for (const Kernel& kernel : module.kernels) KernelCalls(module, linked).rewrite(kernel);
}

}  // namespace skc::native
