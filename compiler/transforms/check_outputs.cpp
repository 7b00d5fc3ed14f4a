// SPDX-License-Identifier: MIT
#include "transforms/check_outputs.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "ir/build.hpp"
#include "ir/walk.hpp"
#include "support/overloaded.hpp"
#include "transforms/condition.hpp"

namespace skc {

using namespace ir;

namespace {

// Finds reads of outputs that no path has written before:
//
//   kernel void f(float x<>, out float r<>) { r += 2 * x; }   // reads r, at the '+='
//
// Any write above the read, or in a loop around it, counts for the whole variable, so that every finding is
// certainly a mistake.

/// The InOut parameters of a function that it reads before writing, and where.
using UnwrittenReads = std::map<ir::VarId, Loc>;

/// Follows one function in source order, which is execution order except for loops.
class Reader {
 public:
  /// `callees` has the reads of the functions before this one.
  Reader(const Module& module, const Function& function, bool isKernel,
         const std::vector<UnwrittenReads>& callees)
      : module_(module), function_(function), isKernel_(isKernel), callees_(callees) {}

  UnwrittenReads run() {
    follow(function_.body);
    return std::move(reads_);
  }

 private:
  void read(VarId var, Loc loc) {
    if (var >= function_.parameterCount || function_.variables[var].role != VarRole::InOut) return;
    // A caller may know that a conditional read in a helper does not happen.
    const bool isCertain = isKernel_ || depth_ == 0;
    if (isCertain && !written_.contains(var)) reads_.try_emplace(var, loc);
  }
  void read(const Expr& expr) {
    walkExprs(expr, [&](const Expr& one) {
      if (const auto* reference = std::get_if<VarRef>(&one.node)) read(reference->var, one.loc);
    });
  }
  void read(const ExprPtr& expr) {
    if (expr) read(*expr);
  }
  /// Writing to `a[i].x` reads i.
  void readIndices(const Expr& place) {
    if (const auto* swizzle = std::get_if<Swizzle>(&place.node)) readIndices(*swizzle->base);
    if (const auto* member = std::get_if<Member>(&place.node)) readIndices(*member->base);
    if (const auto* index = std::get_if<Index>(&place.node)) {
      readIndices(*index->base);
      read(*index->index);
    }
  }

  void follow(const Block& block) {
    for (const Stmt& stmt : block) {
      match(stmt.node, [&](const auto& node) { step(node, stmt); });
    }
  }

  void step(const Declare& n, const Stmt&) { read(n.init); }
  void step(const Assign& n, const Stmt&) {
    read(*n.value);
    readIndices(*n.place);
    if (n.op) {
      read(rootOf(*n.place), n.place->loc);
    } else {
      written_.insert(rootOf(*n.place));
    }
  }
  void step(const CallStmt& n, const Stmt&) {
    const Function& callee = module_.functions[n.callee];
    for (VarId i = 0; i < callee.parameterCount; ++i) {
      const Expr& argument = *n.args[i];
      if (callee.variables[i].role != VarRole::InOut) {
        read(argument);
      } else {
        readIndices(argument);
        if (callees_[n.callee].contains(i)) read(rootOf(argument), argument.loc);
      }
    }
    markWritten(n);
  }
  void followConditional(const Block& block) {
    ++depth_;
    follow(block);
    --depth_;
  }

  void step(const If& n, const Stmt&) {
    read(*n.cond);
    followConditional(n.then);
    followConditional(n.otherwise);
  }
  void step(const Loop& n, const Stmt& stmt) {
    follow(n.init);
    forEachBlock(stmt, [&](const Block& block) { markWritten(block); });
    read(n.cond);
    followConditional(n.body);
    followConditional(n.step);
  }
  void step(const Switch& n, const Stmt&) {
    read(*n.value);
    for (const Case& one : n.cases) followConditional(one.body);
  }
  void step(const Break&, const Stmt&) {}
  void step(const Continue&, const Stmt&) {}
  void step(const Return& n, const Stmt&) { read(n.value); }
  void step(const Scope& n, const Stmt&) { follow(n.body); }
  void step(const Push& n, const Stmt&) { read(*n.value); }
  void step(const Scatter& n, const Stmt&) {
    read(*n.index);
    read(*n.value);
  }
  void step(const Print& n, const Stmt&) {
    for (const ExprPtr& value : n.values) read(*value);
  }

  void markWritten(const CallStmt& n) {
    const Function& callee = module_.functions[n.callee];
    for (VarId i = 0; i < callee.parameterCount; ++i) {
      if (callee.variables[i].role == VarRole::InOut) written_.insert(rootOf(*n.args[i]));
    }
    if (n.result) written_.insert(rootOf(*n.result));
  }
  void markWritten(const Block& block) {
    walkStmts(block, [&](const Stmt& stmt) {
      if (const auto* call = std::get_if<CallStmt>(&stmt.node)) markWritten(*call);
      const auto* assign = std::get_if<Assign>(&stmt.node);
      if (assign != nullptr && !assign->op) written_.insert(rootOf(*assign->place));
    });
  }

  const Module& module_;
  const Function& function_;
  const bool isKernel_;
  const std::vector<UnwrittenReads>& callees_;
  std::set<VarId> written_;
  UnwrittenReads reads_;
  int depth_ = 0;  ///< number of branches and loops around
};

/// The result for each function of the module.
std::vector<UnwrittenReads> unwrittenReads(const Module& module) {
  std::set<FunctionId> kernels;
  for (const Kernel& kernel : module.kernels) kernels.insert(kernel.entry);
  std::vector<UnwrittenReads> reads;  // callees precede their callers in the module
  for (const Function& function : module.functions) {
    const bool isKernel = kernels.contains(static_cast<FunctionId>(reads.size()));
    reads.push_back(Reader(module, function, isKernel, reads).run());
  }
  return reads;
}

using ir::VarId;

/// The definitely assigned components of each InOut parameter; nullopt if no path reaches this point.
using Written = std::map<VarId, std::vector<bool>>;
using Path = std::optional<Written>;

/// The components that both paths have written.
Path both(const Path& a, const Path& b) {
  if (!a) return b;
  if (!b) return a;
  Written result = *a;
  for (auto& [var, components] : result) {
    const std::vector<bool>& other = b->at(var);
    for (std::size_t i = 0; i < components.size(); ++i) components[i] = components[i] && other[i];
  }
  return result;
}

/// The components that either path has written.
Path either(const Path& a, const Path& b) {
  if (!a) return b;
  if (!b) return a;
  Written result = *a;
  for (auto& [var, components] : result) {
    const std::vector<bool>& other = b->at(var);
    for (std::size_t i = 0; i < components.size(); ++i) components[i] = components[i] || other[i];
  }
  return result;
}

/// Definite assignment in one function. `isSpec` marks spec parameters; `summaries` has what callees write.
class DefiniteAssignment {
 public:
  DefiniteAssignment(const ir::Module& module, const ir::Function& function, std::vector<bool> isSpec,
                     const std::vector<Written>& summaries)
      : module_(module), function_(function), isSpec_(std::move(isSpec)), summaries_(summaries) {}

  Written run() {
    Written start;
    for (VarId var = 0; var < function_.parameterCount; ++var) {
      if (function_.variables[var].role == ir::VarRole::InOut) {
        start[var].assign(width(function_.variables[var].type), false);
      }
    }
    const Path end = both(assigned(function_.body, start), returned_);
    if (end) return *end;
    neverReturns_ = true;
    for (auto& [var, components] : start) components.assign(components.size(), true);
    return start;
  }

  bool neverReturns() const { return neverReturns_; }

 private:
  struct Exits {
    Path broken, continued;
    bool isSpec = false;  ///< switch on spec parameters: each path is a different program
  };

  std::size_t width(ir::Type type) const { return static_cast<std::size_t>(ir::scalarCount(module_, type)); }

  /// The positions of an lvalue's components within its root variable.
  std::vector<std::size_t> components(const ir::Expr& place) const {
    const auto range = [](std::size_t first, std::size_t count) {
      std::vector<std::size_t> positions(count);
      for (std::size_t i = 0; i < count; ++i) positions[i] = first + i;
      return positions;
    };
    if (std::holds_alternative<ir::VarRef>(place.node)) return range(0, width(place.type));
    if (const auto* swizzle = std::get_if<ir::Swizzle>(&place.node)) {
      const std::vector<std::size_t> base = components(*swizzle->base);
      std::vector<std::size_t> positions;
      for (const std::uint8_t component : swizzle->components) positions.push_back(base[component]);
      return positions;
    }
    if (const auto* member = std::get_if<ir::Member>(&place.node)) {
      const std::vector<std::size_t> base = components(*member->base);
      const std::vector<ir::StructField>& fields = module_.structs[member->base->type.index].fields;
      std::size_t first = 0;
      for (std::uint32_t i = 0; i < member->field; ++i) first += width(fields[i].type);
      return {base.begin() + static_cast<std::ptrdiff_t>(first),
              base.begin() + static_cast<std::ptrdiff_t>(first + width(place.type))};
    }
    const auto& index = std::get<ir::Index>(place.node);
    const std::vector<std::size_t> base = components(*index.base);
    const std::optional<std::int64_t> number = integer(*index.index);
    const std::size_t size = width(place.type);
    if (!number) return base;
    const auto last = static_cast<std::int64_t>(base.size() / size) - 1;
    const std::int64_t nearest = std::clamp<std::int64_t>(*number, 0, last);  // as everywhere
    const auto first = static_cast<std::ptrdiff_t>(nearest) * static_cast<std::ptrdiff_t>(size);
    return {base.begin() + first, base.begin() + first + static_cast<std::ptrdiff_t>(size)};
  }

  void write(Path& path, const ir::Expr& place, const std::vector<bool>* which = nullptr) const {
    const auto entry = path->find(ir::rootOf(place));
    if (entry == path->end()) return;
    const std::vector<std::size_t> positions = components(place);
    for (std::size_t i = 0; i < positions.size(); ++i) {
      if (!which || i >= which->size() || (*which)[i]) entry->second[positions[i]] = true;
    }
  }

  static Path join(bool isSpec, const Path& a, const Path& b) { return isSpec ? either(a, b) : both(a, b); }

  Path assigned(const ir::Block& block, Path path) {
    for (const ir::Stmt& stmt : block) {
      if (!path) return path;
      path = match(stmt.node, [&](const auto& node) { return step(node, std::move(path)); });
    }
    return path;
  }

  Path step(const ir::Declare&, Path path) { return path; }
  Path step(const ir::Push&, Path path) { return path; }
  Path step(const ir::Scatter&, Path path) { return path; }
  Path step(const ir::Print&, Path path) { return path; }
  Path step(const ir::Assign& assign, Path path) {
    if (!assign.op) write(path, *assign.place);  // `v += x` does not initialise v
    return path;
  }
  Path step(const ir::CallStmt& call, Path path) {
    const ir::Function& callee = module_.functions[call.callee];
    for (VarId i = 0; i < callee.parameterCount; ++i) {
      if (callee.variables[i].role == ir::VarRole::InOut)
        write(path, *call.args[i], &summaries_[call.callee].at(i));
    }
    if (call.result) write(path, *call.result);
    return path;
  }
  Path step(const ir::If& branch, Path path) {
    const Path otherwise = assigned(branch.otherwise, path);
    const Path then = assigned(branch.then, std::move(path));
    // an output that spec parameters disable need not be written when disabled
    return join(isSpecOnly(*branch.cond, isSpec_), then, otherwise);
  }
  Path step(const ir::Scope& scope, Path path) { return assigned(scope.body, std::move(path)); }
  Path step(const ir::Return&, Path path) {
    returned_ = both(returned_, path);
    return std::nullopt;
  }
  Path step(const ir::Break&, Path path) {
    exits_->broken = join(exits_->isSpec, exits_->broken, path);
    return std::nullopt;
  }
  Path step(const ir::Continue&, Path path) {
    exits_->continued = both(exits_->continued, path);
    return std::nullopt;
  }

  Path step(const ir::Loop& loop, Path path) {
    path = assigned(loop.init, std::move(path));
    Exits exits;
    Exits* outer = std::exchange(exits_, &exits);
    const Path once = both(assigned(loop.body, path), exits.continued);
    exits_ = outer;
    if (isAlways(loop.cond)) return exits.broken;  // only `break` leaves it
    const bool entered = loop.kind == ir::LoopKind::DoWhile || entersAtOnce(loop);
    return both(entered ? once : both(path, once), exits.broken);
  }

  Path step(const ir::Switch& choice, Path path) {
    Exits exits;
    exits.isSpec = isSpecOnly(*choice.value, isSpec_);
    if (exits_) exits.continued = exits_->continued;
    Exits* outer = std::exchange(exits_, &exits);
    Path falling;
    bool hasDefault = false;
    for (const ir::Case& one : choice.cases) {
      hasDefault = hasDefault || one.isDefault;
      falling = assigned(one.body, both(path, falling));
    }
    exits_ = outer;
    if (exits_) exits_->continued = exits.continued;
    const Path end = join(exits.isSpec, falling, exits.broken);
    return hasDefault ? end : join(exits.isSpec, end, path);
  }

  static bool isAlways(const ir::ExprPtr& cond) {
    if (!cond) return true;
    const auto* literal = std::get_if<ir::Literal>(&cond->node);
    return literal && literal->bits != 0;
  }

  /// True for `for (int i = 0; i < 4; ...)`, whose first test succeeds.
  bool entersAtOnce(const ir::Loop& loop) const {
    if (loop.init.size() != 1) return false;
    const auto* declare = std::get_if<ir::Declare>(&loop.init.front().node);
    const auto* test = std::get_if<ir::Binary>(&loop.cond->node);
    if (!declare || !declare->init || !test) return false;
    const auto* tested = std::get_if<ir::VarRef>(&test->lhs->node);
    const std::optional<std::int64_t> first = integer(*declare->init);
    const std::optional<std::int64_t> bound = integer(*test->rhs);
    if (!tested || tested->var != declare->var || !first || !bound) return false;
    switch (test->op) {
      case ir::BinaryOp::Less: return *first < *bound;
      case ir::BinaryOp::LessEqual: return *first <= *bound;
      case ir::BinaryOp::Greater: return *first > *bound;
      case ir::BinaryOp::GreaterEqual: return *first >= *bound;
      case ir::BinaryOp::NotEqual: return *first != *bound;
      default: return false;
    }
  }

  std::optional<std::int64_t> integer(const ir::Expr& e) const {
    if (const auto* constant = std::get_if<ir::ConstantRef>(&e.node)) {
      return integer(*module_.constants[constant->constant].value);
    }
    const auto* literal = std::get_if<ir::Literal>(&e.node);
    if (!literal || !e.type.isInteger()) return std::nullopt;
    if (e.type.scalar == ir::Scalar::Uint) return literal->bits;
    return static_cast<std::int32_t>(literal->bits);
  }

  const ir::Module& module_;
  const ir::Function& function_;
  std::vector<bool> isSpec_;
  const std::vector<Written>& summaries_;
  Path returned_;
  Exits* exits_ = nullptr;
  bool neverReturns_ = false;
};

/// For each function that is an entry, which of its variables are spec parameters.
std::vector<std::vector<bool>> specVariables(const ir::Module& module) {
  std::vector<std::vector<bool>> marks(module.functions.size());
  for (const ir::Kernel& kernel : module.kernels) {
    for (const ir::KernelParam& param : kernel.params) {
      marks[kernel.entry].push_back(param.role == ir::ParamRole::Spec);
    }
  }
  return marks;
}

}  // namespace

void checkOutputs(const ir::Module& module, Diagnostics& diagnostics) {
  // callees precede their callers in the module
  std::vector<Written> summaries;
  std::vector<std::vector<bool>> spec = specVariables(module);
  for (const ir::Function& function : module.functions) {
    DefiniteAssignment analysis(module, function, std::move(spec[summaries.size()]), summaries);
    summaries.push_back(analysis.run());
    if (analysis.neverReturns()) diagnostics.report(Diag::NeverReturns, function.loc, {function.name});
  }
  const std::vector<UnwrittenReads> reads = unwrittenReads(module);
  for (const ir::Kernel& kernel : module.kernels) {
    if (kernel.isPart) continue;  // it checks the assertions of another one
    for (VarId i = 0; i < kernel.params.size(); ++i) {
      const ir::KernelParam& param = kernel.params[i];
      if (param.role != ir::ParamRole::Output) continue;
      if (const auto read = reads[kernel.entry].find(i); read != reads[kernel.entry].end()) {
        diagnostics.report(Diag::OutputRead, read->second, {param.name});
        continue;
      }
      const std::vector<bool>& written = summaries[kernel.entry].at(i);
      if (std::find(written.begin(), written.end(), false) != written.end()) {
        diagnostics.report(Diag::OutputNotWritten, param.loc, {param.name});
      }
    }
  }
}

}  // namespace skc
