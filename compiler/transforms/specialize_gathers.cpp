// SPDX-License-Identifier: MIT
#include "transforms/passes.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ir/build.hpp"
#include "ir/ir.hpp"
#include "ir/walk.hpp"

namespace skc {

using namespace ir;

namespace {

// After specialize-gathers, only entries have stream parameters, because GLSL functions cannot have any.

/// True for a parameter to be removed.
bool isDropped(const Variable& var) {
  return var.role == VarRole::Gather || var.role == VarRole::AppendOutput;
}

/// Removes stream parameters from a function whose body no longer uses them; elements become values.
void dropStreams(Function& function) {
  constexpr VarId dropped = std::numeric_limits<VarId>::max();
  std::vector<VarId> renumbered;
  std::vector<Variable> kept;
  std::uint32_t parameters = 0;
  for (std::size_t i = 0; i < function.variables.size(); ++i) {
    Variable& var = function.variables[i];
    const bool isGone = isDropped(var);
    if (var.role == VarRole::Element) var.role = VarRole::In;
    renumbered.push_back(isGone ? dropped : static_cast<VarId>(kept.size()));
    if (isGone) continue;
    if (i < function.parameterCount) ++parameters;
    kept.push_back(std::move(var));
  }
  function.variables = std::move(kept);
  function.parameterCount = parameters;
  walkExprs(function.body, [&](Expr& expr) {
    if (auto* n = std::get_if<VarRef>(&expr.node)) n->var = renumbered[n->var];
  });
  walkStmts(function.body, [&](Stmt& stmt) {
    if (auto* n = std::get_if<Declare>(&stmt.node)) n->var = renumbered[n->var];
  });
}

constexpr StreamRef domain = {StreamRef::Space::Domain, 0};

bool isStream(const Variable& var) {
  return var.role == VarRole::Gather || var.role == VarRole::Element || var.role == VarRole::AppendOutput;
}

/// fn(callee, arguments) for every call in a block.
template <class Fn>
void forEachCall(Block& block, Fn&& fn) {
  walkStmts(block, [&](Stmt& stmt) {
    if (auto* n = std::get_if<CallStmt>(&stmt.node)) fn(n->callee, n->args);
  });
  walkExprs(block, [&](Expr& expr) {
    if (auto* n = std::get_if<Call>(&expr.node)) fn(n->callee, n->args);
  });
}

class GatherSpecializer {
 public:
  explicit GatherSpecializer(Module& module) : module_(module), uses_(module.functions.size()) {}

  void run() {
    for (Kernel& kernel : module_.kernels) specialize(kernel);
    module_.functions = std::move(functions_);
  }

 private:
  /// The stream that each parameter of a function is bound to; `domain` for other parameters.
  using Binding = std::vector<StreamRef>;
  /// What an instance is made from.
  struct Instance {
    FunctionId source;
    Binding binding;
    bool operator<(const Instance& other) const {
      if (source != other.source) return source < other.source;
      const auto keyOf = [](StreamRef stream) { return std::pair(stream.space, stream.id); };
      return std::ranges::lexicographical_compare(binding, other.binding, {}, keyOf, keyOf);
    }
  };

  void specialize(Kernel& kernel) {
    instances_.clear();
    const FunctionId source = kernel.entry;
    Binding binding(kernel.params.size(), domain);
    for (std::uint32_t i = 0; i < binding.size(); ++i) {
      if (isStream(module_.functions[source].variables[i]))
        binding[i] = {StreamRef::Space::KernelParameter, i};
    }
    kernel.entry = make(source, binding, true);
    nameInstances(kernel);
  }

  FunctionId instantiate(FunctionId source, Binding binding) {
    const std::vector<bool>& uses = usesOf(source);
    for (std::size_t i = 0; i < binding.size(); ++i) {
      if (!uses[i]) binding[i] = domain;
    }
    Instance instance{source, std::move(binding)};
    if (const auto known = instances_.find(instance); known != instances_.end()) return known->second;
    const FunctionId specialized = make(source, instance.binding, false);
    instances_.emplace(std::move(instance), specialized);
    return specialized;
  }

  /// Copies a function with its streams bound. An entry keeps its parameters, other functions lose gathers
  /// and append outputs.
  FunctionId make(FunctionId source, const Binding& binding, bool isEntry) {
    Function function = clone(module_.functions[source]);
    walkExprs(function.body, [&](Expr& expr) {
      StreamRef* stream = streamOf(expr);
      if (stream == nullptr || stream->space != StreamRef::Space::Variable) return;
      const bool isGather = function.variables[stream->id].role == VarRole::Gather;
      // a gather has no index of its own: neighbours are relative to the domain's
      *stream = isGather && std::holds_alternative<IndexOf>(expr.node) ? domain : binding[stream->id];
    });
    walkStmts(function.body, [&](Stmt& stmt) {
      if (StreamRef* stream = streamOf(stmt)) *stream = binding[stream->id];
    });
    forEachCall(function.body, [&](FunctionId& callee, std::vector<ExprPtr>& args) {
      callee = bindCall(function, binding, callee, args);
    });
    if (!isEntry) dropStreams(function);
    functions_.push_back(std::move(function));
    return static_cast<FunctionId>(functions_.size() - 1);
  }

  /// The instance that a call needs; removes gathers and append outputs from its arguments.
  FunctionId bindCall(const Function& caller, const Binding& binding, FunctionId callee,
                      std::vector<ExprPtr>& args) {
    const Function& function = module_.functions[callee];
    Binding bound(args.size(), domain);
    std::vector<ExprPtr> kept;
    for (std::size_t i = 0; i < args.size(); ++i) {
      const auto* ref = std::get_if<VarRef>(&args[i]->node);
      if (isStream(function.variables[i]) && ref != nullptr && isStream(caller.variables[ref->var])) {
        bound[i] = binding[ref->var];
      }
      if (!isDropped(function.variables[i])) kept.push_back(std::move(args[i]));
    }
    args = std::move(kept);
    return instantiate(callee, std::move(bound));
  }

  /// For each parameter, whether the function depends on which stream it is bound to.
  const std::vector<bool>& usesOf(FunctionId id) {
    if (uses_[id]) return *uses_[id];
    Function& function = module_.functions[id];
    std::vector<bool> uses(function.variables.size(), false);
    walkExprs(function.body, [&](Expr& expr) {
      const StreamRef* stream = streamOf(expr);
      if (stream != nullptr && stream->space == StreamRef::Space::Variable) uses[stream->id] = true;
    });
    walkStmts(function.body, [&](Stmt& stmt) {
      if (const StreamRef* stream = streamOf(stmt)) uses[stream->id] = true;
    });
    forEachCall(function.body, [&](FunctionId callee, std::vector<ExprPtr>& args) {
      const std::vector<bool>& inner = usesOf(callee);
      for (std::size_t i = 0; i < args.size(); ++i) {
        const auto* ref = std::get_if<VarRef>(&args[i]->node);
        if (inner[i] && ref != nullptr) uses[ref->var] = true;
      }
    });
    uses_[id] = std::move(uses);
    return *uses_[id];
  }

  /// If a kernel has several copies of one function, names them after the streams that they read.
  void nameInstances(const Kernel& kernel) {
    std::map<FunctionId, std::size_t> copies;
    for (const auto& [instance, specialized] : instances_) ++copies[instance.source];
    for (const auto& [instance, specialized] : instances_) {
      if (copies[instance.source] == 1) continue;
      std::string& name = functions_[specialized].name;
      const std::vector<bool>& uses = usesOf(instance.source);
      for (std::size_t i = 0; i < instance.binding.size(); ++i) {
        const StreamRef stream = instance.binding[i];
        if (!uses[i]) continue;
        name += stream == domain ? "_here" : "_" + kernel.params[stream.id].name;
      }
    }
  }

  Module& module_;
  std::vector<Function> functions_;
  std::map<Instance, FunctionId> instances_;              ///< of the current kernel, without its entry
  std::vector<std::optional<std::vector<bool>>> uses_;    ///< per function, computed at first use
};

}  // namespace

void specializeGathers(Module& module, Diagnostics&) { GatherSpecializer(module).run(); }

}  // namespace skc
