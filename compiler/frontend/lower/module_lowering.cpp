// SPDX-License-Identifier: MIT
#include "frontend/lower/module_lowering.hpp"

#include <algorithm>

#include <fmt/format.h>

#include <clang/AST/APValue.h>
#include <clang/AST/ASTContext.h>
#include <clang/AST/DeclCXX.h>
#include <clang/AST/DeclTemplate.h>
#include <clang/Basic/SourceManager.h>
#include <clang/Lex/Lexer.h>
#include <clang/Sema/Sema.h>

#include "frontend/clang_loc.hpp"
#include "frontend/lower/convert_literal.hpp"
#include "frontend/lower/function_lowering.hpp"
#include "frontend/lower/lower_module.hpp"
#include "frontend/lower/pipeline.hpp"
#include "frontend/prelude.hpp"
#include "ir/build.hpp"
#include "ir/call_graph.hpp"
#include "ir/print.hpp"
#include "ir/walk.hpp"
#include "support/header_files.hpp"
#include "support/internal_error.hpp"

namespace skc::frontend {

using clang::SourceLocation;

namespace {

/// The kernels of this one's kind if [[variants]] adds no programs to them; else empty.
std::string_view withoutVariants(const ir::Kernel& kernel) {
  const auto isAppended = [](const ir::KernelParam& param) {
    return param.role == ir::ParamRole::VariableOutput || param.role == ir::ParamRole::Scatter;
  };
  if (std::ranges::any_of(kernel.params, isAppended)) return "kernels that push or scatter";
  if (!kernel.reduction) return {};
  return kernel.isScan ? "scans" : ir::foldsBesideOutputs(kernel) ? "kernels with folded outputs" : "reduces";
}

/// True if the place of an element in the domain decides what it does.
bool asksWhere(const ir::Module& module, const ir::Kernel& kernel) {
  bool asks = false;
  for (const ir::FunctionId id : ir::functionsOf(module, kernel)) {
    ir::walkExprs(module.functions[id].body, [&](const ir::Expr& expr) {
      asks = asks || std::holds_alternative<ir::IndexOf>(expr.node) ||
             std::holds_alternative<ir::NeighborRead>(expr.node);
    });
  }
  return asks;
}

}  // namespace

ir::Module lowerModule(clang::Sema& sema, const DeclarationSyntax& syntax, const std::string& file,
                       Diagnostics& diagnostics) {
  return ModuleLowering(sema, syntax, diagnostics).run(file);
}

ir::Module ModuleLowering::run(const std::string& file) {
  module_.file = file;
  module_.sources.push_back(file);
  sourceIndex_[file] = 0;
  declarations(context().getTranslationUnitDecl());
  addAliases(context().getTranslationUnitDecl());
  if (!diagnostics_.hasErrors()) pairReductions();
  if (!diagnostics_.hasErrors()) keepOwnKernels();
  if (!diagnostics_.hasErrors()) addAssertionChecks();
  return std::move(module_);
}

/// Call after all structs that kernels use are known.
void ModuleLowering::addAliases(const clang::DeclContext* scope) {
  for (const clang::Decl* declaration : scope->decls()) {
    if (const auto* inner = llvm::dyn_cast<clang::NamespaceDecl>(declaration)) addAliases(inner);
    if (const auto* alias = llvm::dyn_cast<clang::TypedefNameDecl>(declaration)) addAlias(alias);
  }
}

/// Lowers in file order, so that the stub lists kernels as written.
void ModuleLowering::declarations(const clang::DeclContext* scope) {
  for (const clang::Decl* declaration : scope->decls()) {
    if (declaration->isImplicit() || isPrelude(declaration)) continue;
    try {
      if (const auto* inner = llvm::dyn_cast<clang::NamespaceDecl>(declaration)) {
        declarations(inner);
      } else if (const auto* linkage = llvm::dyn_cast<clang::LinkageSpecDecl>(declaration)) {
        declarations(linkage);
      } else if (const auto* variable = llvm::dyn_cast<clang::VarDecl>(declaration)) {
        if (isGenerated(variable)) {
          generatedGlobals_[variable->getName().str()] = variable;
        } else if (const StreamSyntax* declared = syntax_.stream(variable->getLocation())) {
          stream(variable, *declared);
        } else {
          constant(variable, variable->getLocation());
        }
      } else if (const auto* pattern = llvm::dyn_cast<clang::FunctionTemplateDecl>(declaration)) {
        kernelTemplate(pattern);
      } else if (const auto* function = llvm::dyn_cast<clang::FunctionDecl>(declaration)) {
        const KernelSyntax* kernelSyntax = syntax_.kernel(function->getLocation());
        if (kernelSyntax && !function->getDefinition() && isOwn(function->getLocation()))
          fail(Diag::KernelBody, function->getLocation(), {function->getNameAsString()});
        if (!function->isThisDeclarationADefinition() || function->isDependentContext()) continue;
        if (kernelSyntax) {
          declared(function, *kernelSyntax, function->getLocation());
        } else {
          this->function(function, function->getLocation());
          if (marksOf(function).assertion != nullptr)
            this->function(function, function->getLocation(), {}, /*checks=*/true);
        }
      }
    } catch (const Abandoned&) {  // already reported; continue with the other declarations
      if (!diagnostics_.hasErrors()) internalError("a declaration was left out, and no error says why");
    }
  }
}

// ---- kernels ------------------------------------------------------------------------------------

/// `where`: what decides whether it is this file's.
void ModuleLowering::declared(const clang::FunctionDecl* declaration, const KernelSyntax& syntax,
                              SourceLocation where) {
  if (!declaration->getReturnType()->isVoidType())
    fail(Diag::KernelResult, declaration->getLocation(),
         {wordOf(syntax.kind), declaration->getNameAsString()});
  if (syntax.kind != FunctionKind::Pipeline) return kernel(declaration, syntax);
  if (isOwn(where)) lowerPipeline(*this, declaration, syntax);
}

/// Remembers the constants that hold what a kernel's parameters declare.
void ModuleLowering::noteGenerated(const clang::FunctionDecl* kernel) {
  generated_.clear();
  const auto* body = llvm::dyn_cast_or_null<clang::CompoundStmt>(kernel->getBody());
  if (body == nullptr) return;
  for (const clang::Stmt* stmt : body->body()) {
    const auto* declared = llvm::dyn_cast<clang::DeclStmt>(stmt);
    const auto* variable = declared && declared->isSingleDecl()
                               ? llvm::dyn_cast<clang::VarDecl>(declared->getSingleDecl())
                               : nullptr;
    if (variable && isGenerated(variable)) generated_[variable->getName().str()] = variable;
  }
}

void ModuleLowering::kernel(const clang::FunctionDecl* declaration, const KernelSyntax& syntax) {
  const SourceLocation where = declaration->getLocation();
  noteGenerated(declaration);
  ir::Kernel kernel;
  kernel.name = declaration->getNameAsString();
  kernel.scope = scopeOf(declaration);
  kernel.signature = syntax.signature;
  kernel.choices = syntax.choices;
  if (declaration->getPrimaryTemplate()) nameInstance(declaration, kernel);
  kernel.loc = loc(where);
  kernel.entry = function(declaration, where);
  parameters(declaration->getDefinition(), kernel);
  const auto isAccumulator = [](const ir::KernelParam& param) {
    return param.role == ir::ParamRole::Accumulator;
  };
  const bool folds = std::ranges::any_of(kernel.params, isAccumulator);
  if (isFold(syntax.kind) || folds) kernel.reduction.emplace();
  kernel.isScan = syntax.kind == FunctionKind::Scan;
  if (const clang::CallExpr* print = marksOf(declaration).print; print != nullptr && kernel.reduction)
    fail(Diag::PrintInFold, print->getBeginLoc(), {ir::wordOf(kernel), kernel.name});
  if (folds && !isFold(syntax.kind)) checkFoldedOutputs(kernel, syntax);
  checkKernelShape(kernel, where);
  if (const std::string_view kind = withoutVariants(kernel); kernel.choices.ahead != 0 && !kind.empty())
    diagnostics_.report(Diag::VariantsUnused, kernel.loc, {kernel.name, std::string(kind)});
  const bool isInstance =
      declaration->getTemplateSpecializationKind() == clang::TSK_ExplicitInstantiationDefinition;
  isOwn_.push_back(isOwn(isInstance ? declaration->getPointOfInstantiation() : where));
  kernelOrigins_.push_back({declaration});
  if (isOwn_.back() && marksOf(declaration).assertion != nullptr)
    function(declaration, where, {}, /*checks=*/true);  // its mistakes come here, in the order of the file
  module_.kernels.push_back(std::move(kernel));
}

/// Turns the instances that `template kernel void f<...>(...);` requests into kernels.
void ModuleLowering::kernelTemplate(const clang::FunctionTemplateDecl* declaration) {
  if (!declaration->isThisDeclarationADefinition()) return;
  const KernelSyntax* kernelSyntax = syntax_.kernel(declaration->getLocation());
  bool isUsed = false;
  for (const clang::FunctionDecl* instance : declaration->specializations()) {
    isUsed = true;
    if (instance->getTemplateSpecializationKind() != clang::TSK_ExplicitInstantiationDefinition) continue;
    const SourceLocation point = instance->getPointOfInstantiation();
    if (kernelSyntax) {
      declared(instance, *kernelSyntax, point);
    } else if (syntax_.isInstantiation(point)) {
      fail(Diag::NotAKernelTemplate, point, {declaration->getNameAsString()});
    }
  }
  if (kernelSyntax && !isUsed && sources().isInMainFile(declaration->getLocation())) {
    diagnostics_.report(Diag::KernelTemplateUnused, locOf(declaration->getLocation()),
                        {declaration->getNameAsString(), wordOf(kernelSyntax->kind)});
  }
}

/// Adds the parameters of a kernel whose entry has been lowered.
void ModuleLowering::parameters(const clang::FunctionDecl* definition, ir::Kernel& kernel) {
  const std::vector<Bundles::Source> sources = bundles_.parametersOf(definition);
  for (const clang::ParmVarDecl* parameter : definition->parameters()) {
    const clang::CXXRecordDecl* record = bundles_.bundle(parameter->getType());
    const auto first = static_cast<std::uint32_t>(kernel.params.size());
    for (const Bundles::Source& source : sources) {
      if (source.parameter != parameter) continue;
      std::string name = parameter->getNameAsString();
      for (const clang::FieldDecl* field : source.member) name += "." + field->getNameAsString();
      const clang::ValueDecl* declared = parameter;
      if (record != nullptr) declared = source.member.back();
      const ir::Variable& variable = functionAt(kernel.entry).variables[kernel.params.size()];
      kernel.params.push_back(kernelParam(declared, std::move(name), variable));
    }
    if (record == nullptr) continue;
    const auto count = static_cast<std::uint32_t>(kernel.params.size()) - first;
    kernel.bundles.push_back({parameter->getNameAsString(), bundleType(record), first, count});
  }
}

ir::KernelParam ModuleLowering::kernelParam(const clang::ValueDecl* declaration, std::string name,
                                            const ir::Variable& variable) {
  const ParamSyntax* syntax = syntax_.param(declaration->getLocation());
  ir::KernelParam param;
  param.name = std::move(name);
  param.role = roleOf(declaration);
  param.rank = variable.rank;
  param.type = variable.type;
  param.loc = loc(declaration->getLocation());
  if (param.role != ir::ParamRole::Uniform) {
    checkElement(param.type, param.name, declaration->getLocation());
  }
  if (param.role == ir::ParamRole::Iterator && (!param.type.isNumber() || param.type.is64Bit())) {
    fail(Diag::IteratorType, declaration->getLocation(), {param.name, spelling(param.type)});
  }
  if (param.role == ir::ParamRole::Spec &&
      (!param.type.isScalar() || param.type.isNarrow() || param.type.is64Bit())) {
    fail(Diag::SpecType, declaration->getLocation(), {param.name, spelling(param.type)});
  }
  if (syntax) {
    param.boundary = syntax->boundary;
    param.filter = syntax->filter;
    param.promise = syntax->halo;
    if (param.promise.size() == 1) param.promise.assign(param.rank, param.promise.front());
    if (!param.promise.empty() && param.promise.size() != param.rank) {
      fail(Diag::HaloRank, declaration->getLocation(),
           {std::to_string(param.promise.size()), param.name, std::to_string(param.rank)});
    }
    if (!syntax->border.empty()) param.border = generatedConstant(syntax->border);
    if (!syntax->identity.empty()) param.identity = generatedConstant(syntax->identity);
    if (syntax->range) param.range = range(*syntax->range, param, declaration->getLocation());
  }
  return param;
}

void ModuleLowering::checkElement(ir::Type type, std::string_view name, SourceLocation where) {
  if (type.kind == ir::Type::Kind::Array) fail(Diag::ArrayAsElement, where, {name});
  if (type.kind != ir::Type::Kind::Struct) return;
  for (const ir::StructField& field : module_.structs[type.index].fields) {
    if (field.type.kind == ir::Type::Kind::Array) fail(Diag::ArrayInElement, where, {name, field.name});
    checkElement(field.type, fmt::format("{}.{}", name, field.name), where);
  }
}

void ModuleLowering::checkKernelShape(const ir::Kernel& kernel, SourceLocation where) {
  const auto count = [&](ir::ParamRole role) {
    return std::count_if(kernel.params.begin(), kernel.params.end(),
                         [&](const ir::KernelParam& param) { return param.role == role; });
  };
  // The program's key holds their values (runtime/src/gl_device/program/variant.hpp).
  if (count(ir::ParamRole::Spec) > static_cast<std::ptrdiff_t>(ir::mostSpecs))
    fail(Diag::SpecCount, where, {kernel.name, std::to_string(ir::mostSpecs)});
  if (!kernel.reduction) {
    const bool hasAppendOutputs = count(ir::ParamRole::VariableOutput) + count(ir::ParamRole::Scatter) > 0;
    if (count(ir::ParamRole::Output) > 0) return;
    if (!hasAppendOutputs) fail(Diag::KernelWithoutOutput, where, {kernel.name});
  } else if (ir::foldsBesideOutputs(kernel)) {
    return;
  } else if (count(ir::ParamRole::Accumulator) == 0) {
    fail(Diag::ReduceParameters, where, {kernel.name, ir::wordOf(kernel)});
  }
  const bool hasElements = count(ir::ParamRole::Input) + count(ir::ParamRole::Iterator) > 0;
  if (!hasElements && !asksWhere(module_, kernel)) {
    fail(Diag::SameForAllElements, where,
         {ir::wordOf(kernel), kernel.name, kernel.reduction ? "'T x<>'" : "'T x<>' or 'out T r<>'"});
  }
}

/// Checks the parameters of a kernel that has accumulators.
void ModuleLowering::checkFoldedOutputs(const ir::Kernel& kernel, const KernelSyntax& syntax) {
  const auto first = [&](std::initializer_list<ir::ParamRole> roles) -> const ir::KernelParam* {
    const auto found = std::ranges::find_if(kernel.params, [&](const ir::KernelParam& param) {
      return std::ranges::find(roles, param.role) != roles.end();
    });
    return found == kernel.params.end() ? nullptr : &*found;
  };
  const ir::KernelParam& folded = *first({ir::ParamRole::Accumulator});
  const auto abandon = [&](Diag diag, std::initializer_list<std::string_view> arguments,
                           const std::vector<FixIt>& fixIts = {}) {
    diagnostics_.report(diag, folded.loc, arguments, fixIts);
    throw Abandoned{};
  };
  if (const auto* appended = first({ir::ParamRole::VariableOutput, ir::ParamRole::Scatter}))
    abandon(Diag::FoldBesideAppend, {kernel.name, folded.name, appended->name});
  if (first({ir::ParamRole::Output}) == nullptr) {
    abandon(Diag::FoldWithoutOutput, {kernel.name, folded.name},
            {FixIt::replace(locOf(syntax.keyword), std::string(wordOf(FunctionKind::Reduce)))});
  }
}

namespace {

std::vector<ir::Type> typesOf(const ir::Kernel& kernel, ir::ParamRole role) {
  std::vector<ir::Type> types;
  for (const ir::KernelParam& param : kernel.params) {
    if (param.role == role) types.push_back(param.type);
  }
  return types;
}

/// For each parameter of `combine` that is no element and no accumulator, the index of the same one of
/// `kernel`; nullopt if a name or kind does not match.
std::optional<std::vector<std::uint32_t>> operandsOf(const ir::Kernel& combine, const ir::Kernel& kernel) {
  std::vector<std::uint32_t> operands;
  for (const ir::KernelParam& param : combine.params) {
    operands.push_back(0);
    if (param.role == ir::ParamRole::Input || param.role == ir::ParamRole::Accumulator) continue;
    const auto found =
        std::find_if(kernel.params.begin(), kernel.params.end(), [&](const ir::KernelParam& other) {
          return other.name == param.name && other.role == param.role && other.type == param.type &&
                 other.rank == param.rank;
        });
    if (found == kernel.params.end()) return std::nullopt;
    operands.back() = static_cast<std::uint32_t>(found - kernel.params.begin());
  }
  return operands;
}

}  // namespace

/// Pairs a reduce whose accumulators differ in type from its elements with the overload that folds
/// accumulators, and so combines partial results. That may take uniforms and gathers of the reduce, too.
void ModuleLowering::pairReductions() {
  for (ir::Kernel& kernel : module_.kernels) {
    if (!kernel.reduction) continue;
    const std::vector<ir::Type> accumulators = typesOf(kernel, ir::ParamRole::Accumulator);
    if (typesOf(kernel, ir::ParamRole::Input) == accumulators && !ir::foldsBesideOutputs(kernel)) continue;
    for (ir::KernelId id = 0; id < module_.kernels.size(); ++id) {
      const ir::Kernel& other = module_.kernels[id];
      if (!other.reduction || other.isScan != kernel.isScan) continue;
      if (other.name != kernel.name || other.scope != kernel.scope || ir::foldsBesideOutputs(other)) continue;
      if (typesOf(other, ir::ParamRole::Input) != accumulators ||
          typesOf(other, ir::ParamRole::Accumulator) != accumulators) {
        continue;
      }
      std::optional<std::vector<std::uint32_t>> operands = operandsOf(other, kernel);
      if (operands) kernel.reduction = ir::Reduction{id, std::move(*operands), false};
    }
  }
}

const clang::VarDecl* ModuleLowering::generatedVariable(const std::string& name) {
  const clang::VarDecl* found = nullptr;
  for (const auto* constants : {&generated_, &generatedGlobals_}) {
    if (const auto at = constants->find(name); at != constants->end() && found == nullptr) found = at->second;
  }
  if (found == nullptr) throw Abandoned{};
  return found;
}

ir::ExprPtr ModuleLowering::generatedConstant(const std::string& name) {
  return constantValue(generatedVariable(name), /*inlined=*/true);
}

// ---- constants ----------------------------------------------------------------------------------

ir::ExprPtr ModuleLowering::constant(const clang::VarDecl* declaration, SourceLocation use) {
  const clang::VarDecl* definition = declaration->getCanonicalDecl();
  if (failedConstants_.contains(definition)) {
    if (constantsInProgress_.contains(declaration)) fail(Diag::NotConstant, use);  // refers to itself
    throw Abandoned{};  // already reported
  }
  if (syntax_.stream(definition->getLocation())) {
    fail(Diag::StreamInBody, use, {definition->getNameAsString()});
  }
  if (!definition->getType().isConstQualified()) {
    failedConstants_.insert(definition);
    fail(Diag::MutableGlobal, use, {nameOf(definition)});
  }
  auto found = constants_.find(definition);
  if (found == constants_.end()) {
    failedConstants_.insert(definition);  // removed on success
    ir::ExprPtr value = constantValue(declaration, inlineConstants_);
    failedConstants_.erase(definition);
    ir::Constant entry{nameOf(definition), value->type, std::move(value), loc(definition->getLocation())};
    found = constants_.emplace(definition, static_cast<ir::ConstantId>(module_.constants.size())).first;
    module_.constants.push_back(std::move(entry));
  }
  const ir::Constant& entry = module_.constants[found->second];
  if (inlineConstants_) return ir::clone(*entry.value);
  auto reference = std::make_unique<ir::Expr>();
  reference->type = entry.type;
  reference->loc = loc(use);
  reference->node = ir::ConstantRef{found->second};
  return reference;
}

/// `inlined`: the value must not name other constants, because it is used outside the kernel's body.
ir::ExprPtr ModuleLowering::constantValue(const clang::VarDecl* declaration, bool inlined) {
  const clang::Expr* init = declaration->getAnyInitializer();
  constantsInProgress_.insert(declaration);
  if (!init) fail(Diag::ConstantWithoutValue, declaration->getLocation(), {declaration->getNameAsString()});
  const bool before = std::exchange(inlineConstants_, inlined);
  FunctionLowering lowering(*this);
  ir::ExprPtr value;
  try {
    value = lowering.constantInitializer(init);
  } catch (const Abandoned&) {
    inlineConstants_ = before;
    throw;
  }
  inlineConstants_ = before;
  constantsInProgress_.erase(declaration);
  if (!value) value = evaluated(declaration);
  if (!value) fail(Diag::NotConstant, init->getBeginLoc());
  return value;
}

/// Values that Clang can compute and GLSL could not, such as calls of constexpr functions.
ir::ExprPtr ModuleLowering::evaluated(const clang::VarDecl* declaration) {
  const clang::Expr* init = declaration->getAnyInitializer(declaration);
  const clang::APValue* value = declaration->evaluateValue();
  if (!value) return nullptr;
  const ir::Type wanted = type(declaration->getType(), init->getBeginLoc());
  // in the functions called, Clang has read literals as floats
  if (ir::holdsDouble(module_, wanted)) {
    const std::string name = isGenerated(declaration) ? textOf(init) : declaration->getNameAsString();
    fail(Diag::DoubleConstant, init->getBeginLoc(), {name});
  }
  return evaluated(*value, wanted, loc(init->getBeginLoc()));
}

/// Returns null if kernels do not support the kind of value.
ir::ExprPtr ModuleLowering::evaluated(const clang::APValue& value, ir::Type type, Loc loc) const {
  if (value.isFloat()) {
    llvm::APFloat rounded = value.getFloat();
    bool inexact = false;
    rounded.convert(llvm::APFloat::IEEEsingle(), llvm::APFloat::rmNearestTiesToEven, &inexact);
    return ir::makeExpr(
        type, ir::Literal{static_cast<std::uint32_t>(rounded.bitcastToAPInt().getZExtValue())}, loc);
  }
  if (value.isInt()) {
    const auto wide = lowBits(value.getInt());
    if (type.isLong()) return ir::makeExpr(type, ir::Literal::wide(wide), loc);
    const auto bits = static_cast<std::uint32_t>(wide);
    return ir::makeExpr(type, ir::Literal{type.isBool() ? bits != 0 : bits}, loc);
  }
  std::vector<ir::ExprPtr> parts;
  if (value.isVector()) {
    const ir::Type component = ir::Type::of(type.scalar);
    for (unsigned i = 0; i < value.getVectorLength(); ++i) {
      parts.push_back(evaluated(value.getVectorElt(i), component, loc));
    }
  } else if (value.isArray()) {
    const ir::Type element = module_.arrays[type.index].element;
    for (unsigned i = 0; i < value.getArraySize(); ++i) {
      const bool isGiven = i < value.getArrayInitializedElts();
      parts.push_back(
          evaluated(isGiven ? value.getArrayInitializedElt(i) : value.getArrayFiller(), element, loc));
    }
  } else if (value.isStruct() && type.kind == ir::Type::Kind::Struct) {   // not a class of the prelude
    const std::vector<ir::StructField>& fields = module_.structs[type.index].fields;
    for (unsigned i = 0; i < value.getStructNumFields(); ++i) {
      parts.push_back(evaluated(value.getStructField(i), fields[i].type, loc));
    }
  }
  const bool isWhole = !parts.empty() && std::ranges::all_of(parts, [](const auto& part) { return !!part; });
  return isWhole ? ir::construct(type, std::move(parts), loc) : nullptr;
}

// ---- functions ----------------------------------------------------------------------------------

ir::FunctionId ModuleLowering::function(const clang::FunctionDecl* declaration, SourceLocation use,
                                        const Aliases& aliases, bool checks) {
  const clang::FunctionDecl* definition = declaration->getDefinition();
  if (!definition) fail(Diag::FunctionWithoutBody, use, {declaration->getNameAsString()});
  if (const KernelSyntax* kernel = syntax_.kernel(definition->getLocation());
      kernel != nullptr && kernel->kind == FunctionKind::Pipeline) {
    fail(Diag::PipelineCalled, use, {declaration->getNameAsString()});
  }
  const Version key{definition, aliases.key(), checks};
  const auto found = functions_.find(key);
  if (found != functions_.end()) {
    switch (found->second.progress) {
      case Progress::Lowering: fail(Diag::Recursion, use, {declaration->getNameAsString()});
      case Progress::Failed: throw Abandoned{};
      case Progress::Done: return found->second.id;
    }
  }
  if (const auto* method = llvm::dyn_cast<clang::CXXMethodDecl>(definition)) {
    if (llvm::isa<clang::CXXConstructorDecl>(method) || llvm::isa<clang::CXXDestructorDecl>(method)) {
      fail(Diag::Constructor, use, {method->getParent()->getNameAsString()});
    }
    if (method->isVirtual()) fail(Diag::VirtualFunction, use, {method->getNameAsString()});
  }
  functions_[key] = {0, Progress::Lowering};
  try {
    if (definition->isVariadic())
      fail(Diag::Variadic, definition->getLocation(), {definition->getNameAsString()});
    FunctionLowering lowering(*this, checks);
    ir::Function lowered = lowering.function(definition, aliases);
    if (const TableSyntax* declared = syntax_.table(definition->getLocation()); declared && !checks) {
      lowered.table = table(definition, *declared);
    }
    // lowering added its callees first, so the table is in order of definition before use
    const auto id = static_cast<ir::FunctionId>(module_.functions.size());
    module_.functions.push_back(std::move(lowered));
    functions_[key] = {id, Progress::Done};
    return id;
  } catch (const Abandoned&) {
    functions_[key].progress = Progress::Failed;
    throw;
  }
}

// ---- source locations ---------------------------------------------------------------------------

std::string ModuleLowering::textOf(const clang::Expr* e) const {
  constexpr std::size_t longest = 60;
  const auto range = clang::CharSourceRange::getTokenRange(e->getSourceRange());
  std::string text = clang::Lexer::getSourceText(range, sources(), context().getLangOpts()).str();
  std::ranges::replace(text, '\n', ' ');
  return text.size() > longest ? text.substr(0, longest) + "..." : text;
}

clang::ASTContext& ModuleLowering::context() const { return sema_.getASTContext(); }
clang::SourceManager& ModuleLowering::sources() const { return sema_.getSourceManager(); }

bool ModuleLowering::isGenerated(const clang::VarDecl* declaration) {
  return declaration->getName().starts_with("__sk_constant");
}

std::string ModuleLowering::nameOf(const clang::VarDecl* declaration) {
  const auto* parts = llvm::dyn_cast<clang::DecompositionDecl>(declaration);
  if (parts == nullptr) return declaration->getNameAsString();
  std::string name;
  for (const clang::BindingDecl* binding : parts->bindings())
    name += (name.empty() ? "" : "_") + binding->getNameAsString();
  return name;
}

bool ModuleLowering::isPrelude(const clang::Decl* declaration) const {
  return sources().isInSystemHeader(declaration->getLocation());
}

/// True if C++ programs include the file that has the declaration.
bool ModuleLowering::isInCppHeader(const clang::Decl* declaration) const {
  const clang::PresumedLoc presumed =
      sources().getPresumedLoc(sources().getExpansionLoc(declaration->getLocation()));
  return presumed.isValid() && isCppHeader(presumed.getFilename());
}

std::vector<std::string> ModuleLowering::scopeOf(const clang::Decl* declaration) const {
  std::vector<std::string> scope;
  for (const clang::DeclContext* outer = declaration->getDeclContext(); outer; outer = outer->getParent()) {
    const auto* space = llvm::dyn_cast<clang::NamespaceDecl>(outer);
    if (space && !space->isAnonymousNamespace()) scope.push_back(space->getNameAsString());
    const auto* record = llvm::dyn_cast<clang::CXXRecordDecl>(outer);
    if (record && isInCppHeader(declaration)) scope.push_back(cppName(record));
  }
  std::reverse(scope.begin(), scope.end());
  return scope;
}

Loc ModuleLowering::loc(SourceLocation location) {
  Loc result = locOf(location);
  const clang::PresumedLoc presumed = sources().getPresumedLoc(sources().getExpansionLoc(location));
  if (presumed.isInvalid()) return result;
  result.line = presumed.getLine();
  const auto [entry, isNew] =
      sourceIndex_.emplace(presumed.getFilename(), static_cast<std::uint32_t>(module_.sources.size()));
  if (isNew) module_.sources.push_back(entry->first);
  result.file = entry->second;
  return result;
}

void ModuleLowering::fail(Diag diag, SourceLocation where,
                          std::initializer_list<std::string_view> arguments) {
  diagnostics_.report(diag, locOf(where), arguments);
  throw Abandoned{};
}

}  // namespace skc::frontend
