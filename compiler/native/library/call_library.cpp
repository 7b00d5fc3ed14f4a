// SPDX-License-Identifier: MIT
#include "native/library/call_library.hpp"

#include <map>
#include <tuple>

#include <fmt/format.h>

#include "ir/build.hpp"
#include "ir/call_graph.hpp"
#include "ir/walk.hpp"
#include "transforms/synthesized_kernel.hpp"

namespace skc::native {
namespace {

using namespace ir;

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
