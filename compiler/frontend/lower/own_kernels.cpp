// SPDX-License-Identifier: MIT
//
// Decides which kernels a file's stubs offer: those that are written in it, not those of .sk files that it includes. Names the
// instances of templates.
#include <algorithm>
#include <filesystem>

#include <clang/AST/DeclTemplate.h>
#include <clang/AST/Expr.h>
#include <clang/Basic/SourceManager.h>
#include <clang/Sema/Sema.h>
#include <fmt/format.h>
#include <llvm/ADT/SmallBitVector.h>
#include <llvm/ADT/StringExtras.h>

#include "frontend/lower/module_lowering.hpp"
#include "support/header_files.hpp"

namespace skc::frontend {

using clang::SourceLocation;

/// True if the declaration is in the main file, or in a file that this includes and that is no .sk file.
bool ModuleLowering::isOwn(SourceLocation where) const {
  clang::FileID file = sources().getFileID(sources().getExpansionLoc(where));
  while (file != sources().getMainFileID()) {
    const clang::OptionalFileEntryRef entry = sources().getFileEntryRefForID(file);
    const SourceLocation includedAt = sources().getIncludeLoc(file);
    if ((entry && isKernelFile(entry->getName())) || includedAt.isInvalid()) return false;
    file = sources().getFileID(includedAt);
  }
  return true;
}

/// Removes the kernels of included .sk files, which the stubs of those files offer. What combines partial results of this file's
/// own kernels stays, as if synthesized. So does what combines results of a reduce without inputs: C++ could not tell a call of it from
/// one of the reduce, whose only streams are results.
void ModuleLowering::keepOwnKernels() {
  const auto fileOf = [&](const ir::Kernel& kernel) {
    return std::filesystem::path(module_.sources[kernel.loc.file]).lexically_normal().string();
  };
  std::vector<bool> stays = isOwn_, isOffered = isOwn_;
  for (ir::KernelId id = 0; id < module_.kernels.size(); ++id) {
    const ir::Kernel& kernel = module_.kernels[id];
    if (!isOwn_[id] || !kernel.reduction || !kernel.reduction->combine) continue;
    stays[*kernel.reduction->combine] = true;
    const bool hasElements = std::ranges::any_of(kernel.params, [](const ir::KernelParam& param) {
      return param.role == ir::ParamRole::Input || param.role == ir::ParamRole::Output;
    });
    if (!hasElements) isOffered[*kernel.reduction->combine] = false;
  }
  const bool hasOwn = std::ranges::find(isOwn_, true) != isOwn_.end();
  if (!isOwn_.empty() && !hasOwn && module_.streams.empty()) {
    const ir::Kernel& first = module_.kernels.front();
    diagnostics_.report(Diag::NoOwnKernels, first.loc, {module_.file, first.name, fileOf(first)});
  }
  for (ir::KernelId id = 0; id < module_.kernels.size(); ++id) {
    const ir::Kernel& kernel = module_.kernels[id];
    for (ir::KernelId other = 0; isOwn_[id] && other < module_.kernels.size(); ++other) {
      const ir::Kernel& included = module_.kernels[other];
      if (isOwn_[other] || included.name != kernel.name || included.scope != kernel.scope) continue;
      diagnostics_.report(Diag::OverloadOfIncluded, kernel.loc, {kernel.name, fileOf(included)});
      break;
    }
  }
  std::vector<ir::KernelId> numbers;
  std::vector<ir::Kernel> kernels;
  std::vector<Origin> origins;
  for (ir::KernelId id = 0; id < module_.kernels.size(); ++id) {
    numbers.push_back(static_cast<ir::KernelId>(kernels.size()));
    if (!stays[id]) continue;
    kernels.push_back(std::move(module_.kernels[id]));
    origins.push_back(kernelOrigins_[id]);
    kernels.back().isSynthesized = !isOffered[id];
  }
  for (ir::Kernel& kernel : kernels) {
    if (kernel.reduction && kernel.reduction->combine)
      kernel.reduction->combine = numbers[*kernel.reduction->combine];
  }
  module_.kernels = std::move(kernels);
  kernelOrigins_ = std::move(origins);
  for (ir::Pipeline& pipeline : module_.pipelines) {
    for (ir::PipelinePass& pass : pipeline.passes) pass.kernel = numbers[pass.kernel];
  }
}

namespace {

/// Whether an expression names a template's parameter.
bool namesParameter(const clang::Stmt* expression, unsigned index) {
  if (expression == nullptr) return false;
  if (const auto* reference = llvm::dyn_cast<clang::DeclRefExpr>(expression)) {
    const auto* parameter = llvm::dyn_cast<clang::NonTypeTemplateParmDecl>(reference->getDecl());
    if (parameter != nullptr && parameter->getIndex() == index) return true;
  }
  return std::ranges::any_of(expression->children(),
                             [&](const clang::Stmt* part) { return namesParameter(part, index); });
}

/// Whether the rank of a gather, such as gather<T, N + 1>, depends on a template's parameter: then calls choose by rank.
bool isOfRank(const clang::FunctionTemplateDecl* pattern, unsigned index) {
  for (const clang::ParmVarDecl* parameter : pattern->getTemplatedDecl()->parameters()) {
    const auto* type = parameter->getType()->getAs<clang::TemplateSpecializationType>();
    const clang::TemplateDecl* made = type ? type->getTemplateName().getAsTemplateDecl() : nullptr;
    if (made == nullptr || made->getName() != "gather" || type->template_arguments().size() != 2) continue;
    const clang::TemplateArgument& rank = type->template_arguments()[1];
    if (rank.getKind() == clang::TemplateArgument::Expression && namesParameter(rank.getAsExpr(), index))
      return true;
  }
  return false;
}

}  // namespace

/// If an instance's parameter types do not distinguish it in C++, appends the template's arguments to its
/// name: blur<3> is blur_3.
void ModuleLowering::nameInstance(const clang::FunctionDecl* instance, ir::Kernel& kernel) {
  const SourceLocation where = instance->getLocation();
  const clang::FunctionTemplateDecl* pattern = instance->getPrimaryTemplate();
  const clang::TemplateParameterList* parameters = pattern->getTemplateParameters();
  const clang::TemplateArgumentList* arguments = instance->getTemplateSpecializationArgs();
  llvm::SmallBitVector deduced;
  sema_.MarkDeducedTemplateParameters(pattern, deduced);
  std::string explicitArgs;
  for (unsigned i = 0; i < arguments->size(); ++i) {
    const std::string argument = spelling(arguments->get(i), where);
    explicitArgs +=
        fmt::format("{}{} = {}", i == 0 ? "" : ", ", parameters->getParam(i)->getNameAsString(), argument);
    if (deduced[i] || isOfRank(pattern, i)) continue;
    kernel.name += '_' + argument;
    std::replace(kernel.name.begin(), kernel.name.end(), '-', 'm');
  }
  kernel.signature += fmt::format("  [{}]", explicitArgs);
}

/// "float", "3", "-1", "true".
std::string ModuleLowering::spelling(const clang::TemplateArgument& argument, SourceLocation use) {
  const bool isType = argument.getKind() == clang::TemplateArgument::Type;
  if (const clang::CXXRecordDecl* record = isType ? bundles_.bundle(argument.getAsType()) : nullptr)
    return structName(record);
  if (argument.getKind() == clang::TemplateArgument::Type) return spelling(type(argument.getAsType(), use));
  if (argument.getKind() != clang::TemplateArgument::Integral) fail(Diag::TemplateArgumentKind, use);
  if (argument.getIntegralType()->isBooleanType())
    return argument.getAsIntegral().isZero() ? "false" : "true";
  return llvm::toString(argument.getAsIntegral(), 10);
}

}  // namespace skc::frontend
