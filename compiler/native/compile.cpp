// SPDX-License-Identifier: MIT
#include <algorithm>
#include <map>

#include <llvm/Analysis/CGSCCPassManager.h>
#include <llvm/Analysis/LoopAnalysisManager.h>
#include <llvm/IR/LLVMContext.h>
#include <llvm/IR/LegacyPassManager.h>
#include <llvm/IR/Module.h>
#include <llvm/IR/Verifier.h>
#include <llvm/Passes/PassBuilder.h>
#include <llvm/Support/Error.h>
#include <llvm/Support/ErrorHandling.h>
#include <llvm/Support/raw_ostream.h>
#include <llvm/Target/TargetMachine.h>

#include "analysis/stream_uses.hpp"
#include "analysis/uniformity.hpp"
#include "ir/build.hpp"
#include "ir/call_graph.hpp"
#include "ir/ir.hpp"
#include "ir/op_weight.hpp"
#include "ir/walk.hpp"
#include "native/debug_info.hpp"
#include "native/entries.hpp"
#include "native/lane_count.hpp"
#include "native/library/link_library.hpp"
#include "native/llvm_passes.hpp"
#include "native/native.hpp"
#include "native/row_plan.hpp"
#include "native/slots.hpp"
#include "native/target.hpp"
#include "support/internal_error.hpp"
#include "transforms/predicate.hpp"

namespace skc::native {

namespace {

// What the runtime must know about the records of a kernel's variable and scatter outputs
// (sk/native/code.hpp).

using namespace ir;
using sk::native::EntryKind;
using sk::native::Real;

/// Counts how often a group of lanes may append records for one parameter, up to `many`.
class RecordCounter {
 public:
  static constexpr std::uint32_t many = 2;

  RecordCounter(const Module& module, std::uint32_t param) : module_(module), param_(param) {}

  std::uint32_t function(FunctionId id) {
    const auto known = functions_.find(id);
    if (known != functions_.end()) return known->second;
    return functions_[id] = block(module_.functions[id].body);
  }

 private:
  /// Adds up all branches of a statement, because lanes may take different ones.
  std::uint32_t block(const Block& statements) {
    std::uint32_t sum = 0;
    for (const Stmt& stmt : statements) {
      std::uint32_t count = own(stmt);
      forEachBlock(stmt, [&](const Block& inner) { count += block(inner); });
      const bool repeats = count > 0 && std::holds_alternative<Loop>(stmt.node);
      sum = std::min(many, sum + (repeats ? many : count));
    }
    return sum;
  }
  std::uint32_t own(const Stmt& stmt) {
    if (const auto* n = std::get_if<Push>(&stmt.node)) return n->stream.id == param_ ? 1 : 0;
    if (const auto* n = std::get_if<Scatter>(&stmt.node)) return n->stream.id == param_ ? 1 : 0;
    if (const auto* n = std::get_if<CallStmt>(&stmt.node)) return function(n->callee);
    return 0;
  }

  const Module& module_;
  std::uint32_t param_;
  std::map<FunctionId, std::uint32_t> functions_;
};

/// True if a group of lanes may append records more than once for one output. The records of one statement
/// are in the order of lanes, but all of them precede those of the next statement.
bool isReordered(const Module& module, const Kernel& kernel) {
  for (std::uint32_t i = 0; i < kernel.params.size(); ++i) {
    const ParamRole role = kernel.params[i].role;
    if (role != ParamRole::VariableOutput && role != ParamRole::Scatter) continue;
    if (RecordCounter(module, i).function(kernel.entry) >= RecordCounter::many) return true;
  }
  return false;
}

/// True if computing an element takes less time than storing a record and carrying it out.
bool isLight(const Module& module, const Kernel& kernel) {
  // large, because elements are computed several at a time, and records are moved one by one
  constexpr std::uint32_t limit = 192;
  constexpr OpWeights weights = {
      .operation = 1, .intrinsic = 8, .gather = 4, .sample = 16, .countsCalls = false};
  return weigh(module, module.functions[kernel.entry].body, weights, limit) < limit;
}

/// True if elements print. That takes long, and an element must not be computed twice.
bool prints(const Module& module, const Kernel& kernel) {
  return std::ranges::any_of(functionsOf(module, kernel), [&](FunctionId id) {
    bool found = false;
    walkStmts(module.functions[id].body,
              [&](const Stmt& stmt) { found = found || std::holds_alternative<Print>(stmt.node); });
    return found;
  });
}

// Runs LLVM's passes on a module of kernels. Their code consists of vectors already: no pass looks for loops
// to vectorise.

/// The pipeline of clang -O2 takes three times as long for the same code. Calls are inlined and vectors
/// formed as code is emitted, and loops are unrolled in our own IR.
constexpr char pipeline[] =
    "function("
    "sroa<modify-cfg>,early-cse<memssa>,simplifycfg,instcombine<no-verify-fixpoint>,"  // variables become registers
    "loop-mssa(loop-rotate,licm),"
    "gvn,carried-values,instcombine<no-verify-fixpoint>,simplifycfg,adce,wide-masks,split-masks)";

void optimize(llvm::Module& module, llvm::TargetMachine& machine) {
  llvm::LoopAnalysisManager loops;
  llvm::FunctionAnalysisManager functions;
  llvm::CGSCCAnalysisManager components;
  llvm::ModuleAnalysisManager modules;
  llvm::PassBuilder builder(&machine);
  builder.registerModuleAnalyses(modules);
  builder.registerCGSCCAnalyses(components);
  builder.registerFunctionAnalyses(functions);
  builder.registerLoopAnalyses(loops);
  builder.crossRegisterProxies(loops, functions, components, modules);
  builder.registerPipelineParsingCallback([](llvm::StringRef name, llvm::FunctionPassManager& list,
                                             llvm::ArrayRef<llvm::PassBuilder::PipelineElement>) {
    if (name == "carried-values") return list.addPass(CarriedValues()), true;
    if (name == "wide-masks") return list.addPass(WideMasks()), true;
    if (name == "split-masks") return list.addPass(SplitMasks()), true;
    return false;
  });
  llvm::ModulePassManager passes;
  llvm::cantFail(builder.parsePassPipeline(passes, pipeline));
  passes.run(module, modules);
}

// Contraction fuses a product and the sum that it feeds into one multiply-add, which rounds once. A kernel
// may be called with or without contraction, which takes two entries; this file decides for which kernels the
// second entry is worth compiling.

bool isSum(BinaryOp op) { return op == BinaryOp::Add || op == BinaryOp::Sub; }

bool isProduct(const Expr& expr) {
  const auto* n = std::get_if<Binary>(&expr.node);
  return n != nullptr && n->op == BinaryOp::Mul && isReal(expr.type.scalar);
}

/// Counts the operations of a kernel that contraction may fuse.
class Operations {
 public:
  bool hasPair() const { return !isExact_ && sums_ > 0 && products_ > 0; }

  void add(const Block& body) {
    walkStmts(body, [&](const Stmt& stmt) {
      const auto* n = std::get_if<Assign>(&stmt.node);
      if (n == nullptr || !n->op || !isReal(n->place->type.scalar)) return;
      if (isSum(*n->op)) ++sums_;
      if (*n->op == BinaryOp::Mul) ++products_;
    });
    walkExprs(body, [&](const Expr& expr) { add(expr); });
  }

 private:
  void add(const Expr& expr) {
    if (const auto* n = std::get_if<IntrinsicCall>(&expr.node)) return add(n->intrinsic, expr.type);
    if (const auto* n = std::get_if<Convert>(&expr.node)) {
      // a product that is rounded to half, as are all in half precision, feeds no sum
      if (expr.type.scalar == Scalar::Half && isProduct(*n->operand)) --products_;
    }
    if (isProduct(expr)) ++products_;
    const auto* n = std::get_if<Binary>(&expr.node);
    if (n == nullptr || !isReal(expr.type.scalar)) return;
    if (isSum(n->op)) ++sums_;
    if (isProduct(expr) && n->lhs->type.isMatrix() && !n->rhs->type.isScalar()) ++sums_;
  }

  void add(Intrinsic intrinsic, const Type& type) {
    const bool isExactSum = intrinsic >= Intrinsic::RoundedSum && intrinsic <= Intrinsic::ExactRounded;
    isExact_ = isExact_ || isExactSum;
    if (!isReal(type.scalar) || (intrinsic != Intrinsic::Fma && intrinsic != Intrinsic::Dot)) return;
    ++products_;
    ++sums_;
  }

  int products_ = 0, sums_ = 0;
  bool isExact_ = false;
};

/// True if contraction may change what the kernel computes: it has products and sums of real numbers. False
/// for kernels that compute rounding errors or exact sums, where each rounding counts. The module must not
/// have library functions yet.
bool canContract(const Module& module, const Kernel& kernel) {
  Operations operations;
  for (const FunctionId id : functionsOf(module, kernel)) operations.add(module.functions[id].body);
  return operations.hasPair();
}

}  // namespace

namespace {

/// The module that code of some real type is compiled from. Code for floats calls the functions of
/// native/library; other code calls the C library.
struct PreparedModule {
  Module plain;
  Module predicated;  ///< for code with several lanes

  explicit PreparedModule(Module module) : plain(std::move(module)), predicated(clone(plain)) {
    predicate(predicated);
  }
};

Module withLibrary(const Module& module, const CompileLibrary& compileLibrary) {
  Module linked = clone(module);
  callLibrary(linked, linkLibrary(linked, compileLibrary));
  return linked;
}

class Compilation {
 public:
  Compilation(const Module& module, const CompileLibrary& compileLibrary, const Options& options)
      : options_(options),
        target_(options),
        plain_(module),
        ofFloats_(withLibrary(module, compileLibrary)),
        code_(module.file, context_) {
    code_.setTargetTriple(target_.triple());
    code_.setDataLayout(target_.machine().createDataLayout());
    code_.setPICLevel(llvm::PICLevel::BigPIC);
    if (options.debugInfo) debug_.emplace(code_, plain_, options.optimizes);
  }

  /// Only readers of LLVM IR need the names of values.
  void discardNames() { context_.setDiscardValueNames(true); }

  void add(const KernelRequest& request) {
    const Kernel& kernel = plain_.kernels[request.kernel];
    noteActivity("native code", kernel.name);
    const SlotPlan slots = planSlots(plain_, kernel);
    CodeTable table{.symbol = request.symbol,
                    .entries = {},
                    .slots = slots.slots,
                    .isUneven = analysis::streamUses(plain_, kernel).loops || prints(plain_, kernel),
                    .isReordered = isReordered(plain_, kernel),
                    .isLight = isLight(plain_, kernel)};
    for (const EntryKind kind : entriesOf(plain_, kernel, request.scans)) {
      if (request.onlyCombines && kind != EntryKind::Combine) continue;
      const auto addEntries = [&](Real real) {
        for (const CpuLevel& level : levelsFor(request, kind, real))
          addEntry(table, request, slots, {kind, real, level});
      };
      addEntries(Real::Float);
      if (mayContract(request, kind)) addContracted(table, request, slots, kind);
      if (kind == EntryKind::Run) addRows(table, request, slots);
      if (request.inDoubles) addEntries(Real::Double);
      if (request.inDoubles && kind == EntryKind::FoldRows && mayHoldFloats(plain_, kernel))
        addEntry(table, request, slots, {EntryKind::FoldFloatRows, Real::Double, target_.levels().front()});
      if (request.inQuads) addEntries(Real::Quad);
    }
    writeCodeTable(code_, table);
  }

  std::string write(Output output) {
    if (debug_) debug_->finish();
    verify();
    noteActivity("native code, in LLVM");
    if (options_.optimizes) optimize(code_, target_.machine());
    llvm::SmallVector<char, 0> bytes;
    llvm::raw_svector_ostream stream(bytes);
    if (output == Output::Llvm) {
      code_.print(stream, nullptr);
    } else {
      llvm::legacy::PassManager passes;
      const auto type =
          output == Output::Object ? llvm::CodeGenFileType::ObjectFile : llvm::CodeGenFileType::AssemblyFile;
      target_.machine().addPassesToEmitFile(passes, stream, nullptr, type, /*DisableVerify=*/true);
      passes.run(code_);
    }
    return {bytes.begin(), bytes.end()};
  }

 private:
  /// The kind of an entry, and what it is compiled for.
  struct EntryVariant {
    EntryKind kind;
    Real real;
    const CpuLevel& level;
    bool isContracted = false;
    const RowPlan* rowPlan = nullptr;  ///< RunRows only
  };

  /// Returns only the lowest level for code that is seldom run, that computes in another real type than
  /// float, or that has no lanes.
  std::vector<CpuLevel> levelsFor(const KernelRequest& request, EntryKind kind, Real real) const {
    const bool hasLanes = kind != EntryKind::Apply && kind != EntryKind::Scan && kind != EntryKind::FoldRows;
    if (!request.isCold && real == Real::Float && hasLanes) return target_.levels();
    return {target_.levels().front()};
  }

  /// Identities and borders are constants, and Apply has no products; cold code is not worth a second entry.
  bool mayContract(const KernelRequest& request, EntryKind kind) const {
    const bool computes = kind == EntryKind::Run || kind == EntryKind::RunRows || kind == EntryKind::Fold ||
                          kind == EntryKind::Combine || kind == EntryKind::Scan ||
                          kind == EntryKind::FoldRows;
    return computes && !request.isCold && canContract(plain_, plain_.kernels[request.kernel]);
  }
  void addContracted(CodeTable& table, const KernelRequest& request, const SlotPlan& slots, EntryKind kind) {
    for (const CpuLevel& level : target_.levels()) {
      if (level.hasFusedMultiplyAdd)
        addEntry(table, request, slots, {kind, Real::Float, level, /*isContracted=*/true});
    }
  }

  /// Adds entries that compute several rows at once, if that saves loads.
  void addRows(CodeTable& table, const KernelRequest& request, const SlotPlan& slots) {
    const Module& module = ofFloats_.predicated;
    const Kernel& kernel = module.kernels[request.kernel];
    if (request.isCold || !options_.optimizes || options_.lanes == 1 || prints(module, kernel)) return;
    const RowPlan plan(module, kernel);
    const std::set<std::uint32_t> shared = plan.sharedGathers(analysis::Uniformity(module, kernel));
    if (shared.empty()) return;
    for (const std::uint32_t gather : shared)
      table.sharedGathers |= gather < 64 ? std::uint64_t{1} << gather : 0;
    const bool contracts = mayContract(request, EntryKind::RunRows);
    for (const CpuLevel& level : target_.levels()) {
      if (blockFor(level, plan.carried()).rows == 1) continue;
      addEntry(table, request, slots, {EntryKind::RunRows, Real::Float, level, false, &plan});
      if (contracts && level.hasFusedMultiplyAdd)
        addEntry(table, request, slots, {EntryKind::RunRows, Real::Float, level, true, &plan});
    }
  }

  void addEntry(CodeTable& table, const KernelRequest& request, const SlotPlan& slots,
                const EntryVariant& variant) {
    const auto& [kind, real, level, isContracted, rowPlan] = variant;
    const Kernel& kernel = plain_.kernels[request.kernel];
    // debuggers cannot show vectors of single bits
    const bool hasMaskRegisters = level.hasMaskRegisters && options_.optimizes;
    CodegenOptions codegen{.lanes = 1,
                           .real = real,
                           .hasMaskRegisters = hasMaskRegisters,
                           .convertsHalves = level.convertsHalves,
                           .isContracted = isContracted,
                           .holdsFloats = kind == EntryKind::FoldFloatRows};
    const RowBlock block = rowPlan != nullptr ? blockFor(level, rowPlan->carried()) : RowBlock{1, 1};
    if (rowPlan != nullptr) {
      codegen.lanes = options_.lanes != 0 ? options_.lanes : block.lanes;
    } else if (isInLanes(kind, real)) {
      codegen.lanes = options_.lanes != 0 ? options_.lanes : laneCount(plain_, kernel, kind, real, level);
    }
    const bool isPredicated = codegen.lanes > 1;
    if (codegen.lanes >= 4 && real == Real::Float && options_.optimizes)
      codegen.blockWidth = std::min(level.vectorBits / 32, codegen.lanes);
    const PreparedModule& version = versionFor(real);
    const Module& module = isPredicated ? version.predicated : version.plain;
    std::optional<analysis::Uniformity> uniformity;
    if (isPredicated) uniformity.emplace(module, module.kernels[request.kernel]);
    const EntrySource source{module,
                             module.kernels[request.kernel],
                             slots,
                             uniformity ? &*uniformity : nullptr,
                             rowPlan,
                             block.rows,
                             table.isReordered,
                             codegen,
                             level,
                             debug_ ? &*debug_ : nullptr};
    const std::string name = request.symbol + suffix(variant);
    table.entries.push_back({writeEntry(code_, source, kind, name), kind, real, level.level, isContracted,
                             codegen.lanes, block.rows});
  }

  /// A violation is a bug of skc: tells the first one.
  void verify() const {
    std::string violations;
    llvm::raw_string_ostream stream(violations);
    if (llvm::verifyModule(code_, &stream))
      internalError("invalid LLVM IR: " + violations.substr(0, violations.find('\n')));
  }

  const PreparedModule& versionFor(Real real) {
    if (real == Real::Float) return ofFloats_;
    if (!ofOthers_) ofOthers_.emplace(clone(plain_));
    return *ofOthers_;
  }

  static bool isInLanes(EntryKind kind, Real real) {
    if (real == Real::Quad) return false;
    return kind == EntryKind::Run || kind == EntryKind::Fold || kind == EntryKind::Combine;
  }

  static std::string suffix(const EntryVariant& variant) {
    static constexpr const char* kinds[] = {".run",   ".fold", ".combine", ".identity", ".borders",
                                            ".apply", ".rows", ".scan",    ".foldrows", ".floatrows"};
    static constexpr const char* reals[] = {"", ".double", ".quad"};
    static constexpr const char* levels[] = {"", ".v3", ".v4"};
    return std::string(kinds[static_cast<std::size_t>(variant.kind)]) +
           reals[static_cast<std::size_t>(variant.real)] +
           levels[static_cast<std::size_t>(variant.level.level)] +
           (variant.isContracted ? ".contracted" : "");
  }

  const Options& options_;
  Target target_;
  const Module& plain_;
  PreparedModule ofFloats_;
  std::optional<PreparedModule> ofOthers_;
  llvm::LLVMContext context_;
  llvm::Module code_;
  std::optional<DebugInfo> debug_;
};

}  // namespace

std::string compile(const Module& module, const std::vector<KernelRequest>& kernels,
                    const CompileLibrary& compileLibrary, const Options& options, Output output) {
  Compilation compilation(module, compileLibrary, options);
  if (output != Output::Llvm) compilation.discardNames();
  for (const KernelRequest& request : kernels) compilation.add(request);
  return compilation.write(output);
}

void setNoMemoryHandler(void (*handler)()) {
  static void (*called)() = nullptr;
  called = handler;
  llvm::install_bad_alloc_error_handler([](void*, const char*, bool) { called(); });
}

}  // namespace skc::native
