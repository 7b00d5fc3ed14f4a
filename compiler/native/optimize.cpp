// SPDX-License-Identifier: MIT
#include "native/optimize.hpp"

#include <llvm/Analysis/CGSCCPassManager.h>
#include <llvm/Analysis/LoopAnalysisManager.h>
#include <llvm/Passes/PassBuilder.h>
#include <llvm/Support/Error.h>

#include "native/llvm_passes.hpp"

namespace skc::native {

namespace {

/// The pipeline of clang -O2 takes three times as long for the same code. Calls are inlined and vectors
/// formed as code is emitted, and loops are unrolled in our own IR.
constexpr char pipeline[] =
    "function("
    "sroa<modify-cfg>,early-cse<memssa>,simplifycfg,instcombine<no-verify-fixpoint>,"  // variables become registers
    "loop-mssa(loop-rotate,licm),"
    "gvn,carried-values,instcombine<no-verify-fixpoint>,simplifycfg,adce,wide-masks,split-masks)";

}  // namespace

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

}  // namespace skc::native
