// SPDX-License-Identifier: MIT
#include "frontend/clang_limits.hpp"

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include <clang/Basic/SourceManager.h>
#include <clang/Lex/MacroArgs.h>
#include <clang/Lex/PPCallbacks.h>
#include <clang/Lex/Preprocessor.h>
#include <clang/Sema/Sema.h>
#include <clang/Sema/TemplateInstCallback.h>

#include "frontend/clang_loc.hpp"
#include "support/diagnostics.hpp"

namespace skc::frontend {
namespace {

// Each takes Clang about a second.
constexpr std::size_t mostTokensToExpand = 10'000'000;
constexpr std::size_t tokensOfExpansion =
    10;   // as many tokens take as long as an expansion without arguments
constexpr int mostIncludes = 10'000;
constexpr int mostInstantiations = 100'000;
/// Bytes of the AST that instantiations add: types in types in types, each of which is small.
constexpr std::size_t mostInstantiatedMemory = std::size_t{192} << 20;

class PreprocessingLimits : public clang::PPCallbacks {
 public:
  PreprocessingLimits(clang::Preprocessor& preprocessor, Diagnostics& diagnostics)
      : preprocessor_(preprocessor), diagnostics_(diagnostics) {}

  void MacroExpands(const clang::Token& name, const clang::MacroDefinition&, clang::SourceRange,
                    const clang::MacroArgs* arguments) override {
    tokens_ += tokensOfExpansion;
    for (unsigned i = 0; arguments != nullptr && i < arguments->getNumMacroArguments(); ++i)
      tokens_ += clang::MacroArgs::getArgLength(arguments->getUnexpArgument(i));
    if (tokens_ > mostTokensToExpand) stop(Diag::TooManyExpansions, name.getLocation());
  }

  void InclusionDirective(clang::SourceLocation place, const clang::Token&, llvm::StringRef, bool,
                          clang::CharSourceRange, clang::OptionalFileEntryRef, llvm::StringRef,
                          llvm::StringRef, const clang::Module*, bool,
                          clang::SrcMgr::CharacteristicKind) override {
    if (++includes_ == mostIncludes) stop(Diag::TooManyIncludes, place, std::to_string(mostIncludes));
  }

 private:
  [[noreturn]] void stop(Diag diag, clang::SourceLocation place, std::string_view argument = {}) {
    const clang::SourceLocation written = preprocessor_.getSourceManager().getExpansionLoc(place);
    diagnostics_.report(diag, locOf(written), {argument});
    throw ClangStopped();
  }

  clang::Preprocessor& preprocessor_;
  Diagnostics& diagnostics_;
  std::size_t tokens_ = 0;
  int includes_ = 0;
};

class TemplateLimits : public clang::TemplateInstantiationCallback {
 public:
  explicit TemplateLimits(Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

  void initialize(const clang::Sema& sema) override { before_ = memoryOf(sema); }
  void finalize(const clang::Sema&) override {}
  void atTemplateBegin(const clang::Sema& sema,
                       const clang::Sema::CodeSynthesisContext& context) override {
    // what calls of the prelude's functions deduce is no instantiation, and costs little
    if (context.Kind != clang::Sema::CodeSynthesisContext::TemplateInstantiation) return;
    if (++instantiations_ < mostInstantiations && memoryOf(sema) - before_ < mostInstantiatedMemory) return;
    diagnostics_.report(Diag::TooManyInstantiations, locOf(context.PointOfInstantiation));
    throw ClangStopped();
  }
  void atTemplateEnd(const clang::Sema&, const clang::Sema::CodeSynthesisContext&) override {}

 private:
  static std::size_t memoryOf(const clang::Sema& sema) {
    return sema.getASTContext().getASTAllocatedMemory();
  }

  Diagnostics& diagnostics_;
  std::size_t before_ = 0;
  int instantiations_ = 0;
};

}  // namespace

void limitPreprocessing(clang::Preprocessor& preprocessor, Diagnostics& diagnostics) {
  preprocessor.addPPCallbacks(std::make_unique<PreprocessingLimits>(preprocessor, diagnostics));
}

void limitTemplates(clang::Sema& sema, Diagnostics& diagnostics) {
  sema.TemplateInstCallbacks.push_back(std::make_unique<TemplateLimits>(diagnostics));
}

}  // namespace skc::frontend
