// SPDX-License-Identifier: MIT
#include "frontend/frontend.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <ostream>
#include <system_error>
#include <vector>

#include <clang/AST/ASTConsumer.h>
#include <clang/AST/ASTContext.h>
#include <clang/Basic/TargetInfo.h>
#include <clang/Frontend/CompilerInstance.h>
#include <clang/Frontend/CompilerInvocation.h>
#include <clang/Frontend/Utils.h>
#include <clang/Lex/Preprocessor.h>
#include <clang/Lex/PreprocessorOptions.h>
#include <clang/Parse/Parser.h>
#include <clang/Sema/Sema.h>
#include <llvm/Support/MemoryBuffer.h>
#include <llvm/Support/VirtualFileSystem.h>
#include <llvm/Support/raw_os_ostream.h>

#include "frontend/clang_diagnostics.hpp"
#include "frontend/clang_limits.hpp"
#include "frontend/clang_loc.hpp"
#include "frontend/lower/lower_module.hpp"
#include "frontend/prelude.hpp"
#include "frontend/quotient_warnings.hpp"
#include "frontend/tokens/float_literals.hpp"
#include "frontend/tokens/token_editor.hpp"
#include "support/crash_recovery.hpp"

#if defined(__SANITIZE_ADDRESS__)
// LLVM's headers poison memory that their allocators have not handed out; libclang-cpp, built without the
// sanitizer, hands it out without removing the poison.
extern "C" const char* __asan_default_options() {   // NOLINT(bugprone-reserved-identifier)
  return "allow_user_poisoning=0";
}
#endif

namespace skc::frontend {
namespace {

/// Nobody writes larger kernels by hand; Clang would take minutes for them.
constexpr std::uintmax_t largestFile = std::uintmax_t{4} << 20;
/// A few lines of nested macros can expand to more tokens than fit in memory.
constexpr std::size_t mostTokens = 1'000'000;
/// Where the headers are that skc has in memory.
constexpr const char* ownHeaders = "/sk-headers";

std::vector<std::string> compilerArguments(const Options& options, const std::string& path) {
  std::vector<std::string> arguments = {
      "-fsyntax-only", "-triple", "x86_64-unknown-linux-gnu", "-x", "c++", "-std=c++20", "-nostdsysteminc",
      "-nobuiltininc", "-fno-builtin", "-fno-rtti", "-flax-vector-conversions=all",
      "-fnative-half-arguments-and-returns", "-Wno-undefined-internal", "-Wno-undefined-inline",
      narrowingArgument,
      "-Wno-literal-range",   // lowering warns, because it knows which literals are doubles
      "-Wtautological-unsigned-zero-compare",   // a loop that counts down past 0 never ends
      "-Wfor-loop-analysis",   // a loop whose step is missing never ends
      "-Wuninitialized",   // a value of any kind, and another one on each device
      "-Wno-vla-cxx-extension",   // lowering refuses them
      "-Werror=format",   // native code would read values that printf was not given
      // a bad -W or a long cascade must not bury the first message
      "-ferror-limit", "20", "-fmessage-length=0"};
  // Programs' headers ask for the macro where they differ; the folder comes before that of the runtime's own header.
  arguments.insert(arguments.end(), {"-D__SKC__=1", std::string("-I") + ownHeaders});
  for (const std::string& directory : options.includeDirectories) arguments.push_back("-I" + directory);
  for (const std::string& definition : options.definitions) arguments.push_back("-D" + definition);
  for (const std::string& warning : options.warnings) {
    if (!warning.ends_with("performance")) arguments.push_back("-W" + warning);  // the driver's
  }
  if (options.fixIts) arguments.push_back("-fdiagnostics-parseable-fixits");
  if (options.color) arguments.push_back("-fcolor-diagnostics");
  arguments.push_back(path);
  return arguments;
}

}  // namespace

class Frontend::Unit {
 public:
  explicit Unit(Options options) : options_(std::move(options)) {
    if (options_.messages != nullptr) {
      messages_ = std::make_unique<llvm::raw_os_ostream>(*options_.messages);
    }
    createDiagnostics();
  }

  ~Unit() {
    if (wasStopped_) {
      static_cast<void>(owned_.release());
    } else if (parsing_) {
      compiler_.getDiagnosticClient().EndSourceFile();
    }
  }

  std::optional<ir::Module> compile(const std::string& path, std::optional<std::string> text) {
    try {
      return compileUnlimited(path, std::move(text));
    } catch (const ClangStopped&) {
      abandon();
      return std::nullopt;
    }
  }

  void dumpAst(std::ostream& out) const {
    // Clang takes quadratic time to print a deep tree
    if (wasStopped_ || !compiler_.hasASTContext() || diagnostics_->hasReported(Diag::NestedTooDeep)) return;
    llvm::raw_os_ostream stream(out);
    const clang::SourceManager& sources = compiler_.getSourceManager();
    for (const clang::Decl* declaration : compiler_.getASTContext().getTranslationUnitDecl()->decls()) {
      if (declaration->isImplicit() || sources.isInSystemHeader(declaration->getLocation())) continue;
      declaration->dump(stream);
    }
  }

  std::vector<std::string> dependencies() const {
    std::vector<std::string> files{path_};
    for (const std::string& file : dependencyCollector_->getDependencies()) {
      if (file != path_ && !llvm::StringRef(file).starts_with(ownHeaders)) files.push_back(file);
    }
    return files;
  }

  Diagnostics& diagnostics() { return *diagnostics_; }

 private:
  std::optional<ir::Module> compileUnlimited(const std::string& path, std::optional<std::string> text) {
    path_ = path;
    text_ = text ? llvm::MemoryBuffer::getMemBufferCopy(*text, path) : readFile(path);
    const bool isInMemory = text.has_value() || options_.isIsolated;
    if (text_ == nullptr || !isProgram(text_->getBuffer()) || !setUp(isInMemory)) return std::nullopt;
    std::vector<clang::Token> tokens = lex();
    if (tokens.empty()) return std::nullopt;
    suffixFloats(tokens, compiler_.getPreprocessor());
    edited_ = editTokens(tokens, compiler_.getPreprocessor(), *diagnostics_);
    if (diagnostics_->hasErrors()) return std::nullopt;
    printer_->setSyntax(&edited_.syntax);
    parse(edited_.tokens);
    if (diagnostics_->hasErrors()) return std::nullopt;
    warnOfQuotients(compiler_.getASTContext(), *diagnostics_);
    ir::Module module = lowerModule(compiler_.getSema(), edited_.syntax, path, *diagnostics_);
    if (diagnostics_->hasErrors()) return std::nullopt;
    if (module.kernels.empty() && module.streams.empty() && !options_.isLibrary) {
      fail(Diag::NoKernels, path);
      return std::nullopt;
    }
    return module;
  }

  /// Leaves the memory of Clang as it is after ClangStopped; only the diagnostics still work.
  void abandon() {
    static std::vector<clang::CompilerInstance*> abandoned;
    abandoned.push_back(&compiler_);
    wasStopped_ = true;
  }

  void createDiagnostics() {
    llvm::raw_ostream* messages = messages_.get();
    if (messages == nullptr) messages = &llvm::errs();
    auto printer = std::make_unique<DiagnosticPrinter>(*messages, &compiler_.getDiagnosticOpts());
    printer_ = printer.get();
    compiler_.createDiagnostics(printer.release());  // takes ownership
    diagnostics_ = std::make_unique<ClangDiagnostics>(compiler_.getDiagnostics());
  }

  /// Returns null after reporting an error.
  std::unique_ptr<llvm::MemoryBuffer> readFile(const std::string& path) {
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status)) {
      fail(Diag::FileMissing, path);
    } else if (std::filesystem::is_directory(status)) {
      fail(Diag::FileIsDirectory, path);
    } else if (auto buffer = llvm::MemoryBuffer::getFile(path)) {
      return std::move(*buffer);
    } else {
      diagnostics_->report(Diag::FileUnreadable, {}, {path, buffer.getError().message()});
    }
    return nullptr;
  }

  bool isProgram(llvm::StringRef text) {
    if (text.size() > largestFile) {
      diagnostics_->report(Diag::FileTooLarge, {}, {path_, std::to_string(text.size())});
      return false;
    }
    if (text.contains('\0')) return fail(Diag::FileIsBinary, path_);
    if (text.trim().empty()) return fail(Diag::FileIsEmpty, path_);
    return true;
  }

  bool fail(Diag diag, const std::string& path) {
    diagnostics_->report(diag, {}, {path});
    return false;
  }

  bool setUp(bool isInMemory) {
    const std::vector<std::string> arguments = compilerArguments(options_, path_);
    std::vector<const char*> pointers;
    for (const std::string& argument : arguments) pointers.push_back(argument.c_str());
    if (!clang::CompilerInvocation::CreateFromArgs(compiler_.getInvocation(), pointers,
                                                   compiler_.getDiagnostics())) {
      return false;
    }
    // again, with the options of the command line
    createDiagnostics();
    compiler_.setTarget(clang::TargetInfo::CreateTargetInfo(compiler_.getDiagnostics(),
                                                            compiler_.getInvocation().TargetOpts));
    compiler_.createFileManager(isInMemory ? filesWithText() : nullptr);
    compiler_.createSourceManager(compiler_.getFileManager());
    dependencyCollector_ = std::make_shared<clang::DependencyCollector>();
    compiler_.addDependencyCollector(dependencyCollector_);
    addHeader("sk/types.hpp", typesHeaderText());
    addHeader("sk/random.sk", randomHeaderText());
    compiler_.createPreprocessor(clang::TU_Complete);
    clang::Preprocessor& preprocessor = compiler_.getPreprocessor();
    // Clang assigns an array, as a member of a struct, by __builtin_memcpy.
    preprocessor.getBuiltinInfo().initializeBuiltins(preprocessor.getIdentifierTable(),
                                                     compiler_.getLangOpts());
    preprocessor.setPredefines(preprocessor.getPredefines() + preludeText());
    compiler_.createASTContext();
    compiler_.setASTConsumer(std::make_unique<clang::ASTConsumer>());
    compiler_.createSema(clang::TU_Complete, nullptr);
    limitPreprocessing(preprocessor, *diagnostics_);
    limitTemplates(compiler_.getSema(), *diagnostics_);
    compiler_.getDiagnosticClient().BeginSourceFile(compiler_.getLangOpts(), &preprocessor);
    parsing_ = true;
    return compiler_.InitializeSourceManager(compiler_.getFrontendOpts().Inputs.front());
  }

  /// Lets programs include a header that is only in memory.
  void addHeader(const std::string& name, std::string_view text) {
    compiler_.getPreprocessorOpts().addRemappedFile(
        std::string(ownHeaders) + "/" + name,
        llvm::MemoryBuffer::getMemBufferCopy(llvm::StringRef(text), name).release());
  }

  /// The real file system, with the main file in memory over it; only the main file if it is isolated.
  llvm::IntrusiveRefCntPtr<llvm::vfs::FileSystem> filesWithText() {
    auto memory = llvm::makeIntrusiveRefCnt<llvm::vfs::InMemoryFileSystem>();
    auto files = llvm::makeIntrusiveRefCnt<llvm::vfs::OverlayFileSystem>(
        options_.isIsolated ? memory : llvm::vfs::getRealFileSystem());
    if (!options_.isIsolated) files->pushOverlay(memory);  // sets its working directory
    memory->addFile(path_, 0, std::move(text_));
    return files;
  }

  /// Returns no tokens after reporting that there are too many, or that brackets or names nest too deep.
  std::vector<clang::Token> lex() {
    clang::Preprocessor& preprocessor = compiler_.getPreprocessor();
    preprocessor.EnterMainSourceFile();
    std::vector<clang::Token> tokens;
    int depth = 0;  // of brackets
    int qualifiers = 0;  // in a name such as a::b::c
    const auto stop = [&](Diag diag, std::size_t most) -> std::vector<clang::Token> {
      const auto location = compiler_.getSourceManager().getExpansionLoc(tokens.back().getLocation());
      diagnostics_->report(diag, locOf(location), {std::to_string(most)});
      return {};
    };
    do {
      preprocessor.Lex(tokens.emplace_back());
      if (tokens.size() > mostTokens) return stop(Diag::TooManyTokens, mostTokens);
      const clang::Token& token = tokens.back();
      if (token.isOneOf(clang::tok::l_brace, clang::tok::l_paren, clang::tok::l_square)) ++depth;
      if (token.isOneOf(clang::tok::r_brace, clang::tok::r_paren, clang::tok::r_square)) --depth;
      if (token.is(clang::tok::coloncolon)) ++qualifiers;
      if (!token.isOneOf(clang::tok::coloncolon, clang::tok::identifier)) qualifiers = 0;
      if (std::max(depth, qualifiers) > deepestNesting) return stop(Diag::NestedTooDeep, deepestNesting);
    } while (tokens.back().isNot(clang::tok::eof));
    return tokens;
  }

  /// Does what clang::ParseAST does, but from tokens instead of the main file.
  void parse(const std::vector<clang::Token>& tokens) {
    clang::Preprocessor& preprocessor = compiler_.getPreprocessor();
    auto owned =
        std::make_unique<clang::Parser>(preprocessor, compiler_.getSema(), /*SkipFunctionBodies=*/false);
    clang::Parser& parser = *owned;
    preprocessor.EnterTokenStream(tokens, /*DisableMacroExpansion=*/true, /*IsReinject=*/false);
    clang::SourceLocation reached;
    preprocessor.setTokenWatcher([&](const clang::Token& token) { reached = token.getLocation(); });
    const bool isParsed = survivesCrash([&] {
      parser.Initialize();
      clang::Parser::DeclGroupPtrTy group;
      clang::Sema::ModuleImportState imports;
      bool atEnd = parser.ParseFirstTopLevelDecl(group, imports);
      // nobody sees what comes after the last message
      while (!atEnd && !compiler_.getDiagnostics().hasFatalErrorOccurred())
        atEnd = parser.ParseTopLevelDecl(group, imports);
    });
    preprocessor.setTokenWatcher(nullptr);
    if (isParsed) return;
    static_cast<void>(owned.release());
    diagnostics_->report(Diag::ClangCrashed, locOf(reached));
    throw ClangStopped();
  }

  Options options_;
  std::string path_;
  std::unique_ptr<llvm::MemoryBuffer> text_;
  std::unique_ptr<llvm::raw_os_ostream> messages_;
  EditedTokens edited_;
  std::unique_ptr<clang::CompilerInstance> owned_ = std::make_unique<clang::CompilerInstance>();
  clang::CompilerInstance& compiler_ = *owned_;
  DiagnosticPrinter* printer_ = nullptr;  ///< of the current engine
  std::unique_ptr<ClangDiagnostics> diagnostics_;
  std::shared_ptr<clang::DependencyCollector> dependencyCollector_;
  bool parsing_ = false;
  bool wasStopped_ = false;  ///< by ClangStopped
};

Frontend::Frontend(const Options& options) : unit_(std::make_unique<Unit>(options)) {}
Frontend::~Frontend() = default;

std::optional<ir::Module> Frontend::compile(const std::string& path, std::optional<std::string> text) {
  return unit_->compile(path, std::move(text));
}
void Frontend::dumpAst(std::ostream& out) const { unit_->dumpAst(out); }
std::vector<std::string> Frontend::dependencies() const { return unit_->dependencies(); }
Diagnostics& Frontend::diagnostics() { return unit_->diagnostics(); }

}  // namespace skc::frontend
