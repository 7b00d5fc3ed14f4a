// SPDX-License-Identifier: MIT
#include "frontend/clang_limits.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <vector>

#include <clang/Basic/SourceManager.h>
#include <clang/Lex/MacroArgs.h>
#include <clang/Lex/MacroInfo.h>
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

  void MacroExpands(const clang::Token& name, const clang::MacroDefinition& macro, clang::SourceRange,
                    const clang::MacroArgs* arguments) override {
    // An expansion within an argument of another is repeated wherever that other names the argument.
    while (!enclosing_.empty() && !enclosing_.back().places.contains(name.getLocation().getRawEncoding()))
      enclosing_.pop_back();
    const std::size_t times = enclosing_.empty() ? 1 : enclosing_.back().times;
    tokens_ += times * tokensOfExpansion;
    if (arguments != nullptr) enter(*macro.getMacroInfo(), *arguments, times);
    if (tokens_ > mostTokensToExpand) stop(Diag::TooManyExpansions, name.getLocation());
  }

  void InclusionDirective(clang::SourceLocation location, const clang::Token&, llvm::StringRef, bool,
                          clang::CharSourceRange, clang::OptionalFileEntryRef, llvm::StringRef,
                          llvm::StringRef, const clang::Module*, bool,
                          clang::SrcMgr::CharacteristicKind) override {
    if (++includes_ == mostIncludes) stop(Diag::TooManyIncludes, location, std::to_string(mostIncludes));
  }

 private:
  /// An expansion whose arguments may hold others.
  struct Enclosing {
    std::unordered_set<clang::SourceLocation::UIntTy> places;  ///< of the arguments' tokens
    std::size_t times;  ///< how often what they expand to is copied
  };

  void enter(const clang::MacroInfo& macro, const clang::MacroArgs& arguments, std::size_t times) {
    std::vector<std::size_t> uses(macro.getNumParams());
    for (const clang::Token& token : macro.tokens()) {
      const int parameter = token.getIdentifierInfo() ? macro.getParameterNum(token.getIdentifierInfo()) : -1;
      if (parameter >= 0) ++uses[static_cast<std::size_t>(parameter)];
    }
    Enclosing entry{{}, 1};
    for (unsigned i = 0; i < arguments.getNumMacroArguments() && i < uses.size(); ++i) {
      const clang::Token* const first = arguments.getUnexpArgument(i);
      const unsigned length = clang::MacroArgs::getArgLength(first);
      tokens_ += times * std::max<std::size_t>(uses[i], 1) * length;
      for (unsigned k = 0; k < length; ++k) entry.places.insert(first[k].getLocation().getRawEncoding());
      entry.times = std::max(entry.times, uses[i]);
    }
    entry.times = std::min(entry.times * times, mostTokensToExpand);
    enclosing_.push_back(std::move(entry));
  }

  [[noreturn]] void stop(Diag diag, clang::SourceLocation location, std::string_view argument = {}) {
    const clang::SourceLocation written = preprocessor_.getSourceManager().getExpansionLoc(location);
    diagnostics_.report(diag, locOf(written), {argument});
    throw ClangStopped();
  }

  clang::Preprocessor& preprocessor_;
  Diagnostics& diagnostics_;
  std::vector<Enclosing> enclosing_;
  std::size_t tokens_ = 0;
  int includes_ = 0;
};

class TemplateLimits : public clang::TemplateInstantiationCallback {
 public:
  explicit TemplateLimits(Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

  void initialize(const clang::Sema& sema) override { before_ = memoryOf(sema); }
  void finalize(const clang::Sema&) override {}
  void atTemplateBegin(const clang::Sema& sema, const clang::Sema::CodeSynthesisContext& context) override {
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
