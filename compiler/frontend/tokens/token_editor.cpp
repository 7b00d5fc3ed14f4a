// SPDX-License-Identifier: MIT
#include "frontend/tokens/token_editor.hpp"

#include <fmt/format.h>

#include <clang/Basic/SourceManager.h>
#include <clang/Lex/Preprocessor.h>

#include "frontend/choices.hpp"
#include "frontend/clang_loc.hpp"
#include "frontend/prelude.hpp"
#include "frontend/tokens/bundle_editor.hpp"
#include "frontend/tokens/comma_indices.hpp"
#include "frontend/tokens/declaration_editors.hpp"
#include "frontend/tokens/parameter_editor.hpp"
#include "frontend/tokens/token_cursor.hpp"

namespace skc::frontend {
namespace {

using clang::Token;
namespace tok = clang::tok;

/// Walks the file's declarations; one function for each kind that needs a change.
class Editor {
 public:
  Editor(const std::vector<Token>& tokens, clang::Preprocessor& preprocessor, Diagnostics& diagnostics)
      : preprocessor_(preprocessor),
        diagnostics_(diagnostics),
        cursor_(tokens),
        constructors_(TokenBuilder(preprocessor)) {}

  EditedTokens run() {
    copyPrelude();
    while (!cursor_.at(tok::eof)) editDeclaration();
    out_.push_back(cursor_.take());
    return {std::move(out_), std::move(syntax_)};
  }

 private:
  void copyPrelude() {
    const clang::SourceManager& sources = preprocessor_.getSourceManager();
    while (!cursor_.at(tok::eof) && sources.isInSystemHeader(cursor_.peek().getLocation())) {
      out_.push_back(cursor_.take());
    }
    const llvm::StringSet<> declared = declaredInPlace(cursor_);
    if (!hasListsOnly(cursor_, "index")) constructors_.keepIndex();
    for (Token& token : out_) {
      if (token.isNot(tok::identifier) || !declared.contains(nameOf(token))) continue;
      token = TokenBuilder(preprocessor_).word("__sk_hidden_" + nameOf(token), token.getLocation());
    }
  }

  bool atWord(llvm::StringRef word) const { return isWord(cursor_.peek(), word); }

  /// `kernel` is a keyword only where a declaration starts with it: `kernel void f`.
  bool atDeclarationWord(llvm::StringRef word) const { return atWord(word) && startsType(cursor_.peek(1)); }
  bool atKernel() const { return isKernelWord(cursor_.peek()) && startsType(cursor_.peek(1)); }
  static bool isKernelWord(const Token& token) {
    return isWord(token, "kernel") || isWord(token, "reduce") || isWord(token, "scan") ||
           isWord(token, "pipeline");
  }
  static FunctionKind kindOf(const Token& word) {
    return isWord(word, "reduce")     ? FunctionKind::Reduce
           : isWord(word, "scan")     ? FunctionKind::Scan
           : isWord(word, "pipeline") ? FunctionKind::Pipeline
                                      : FunctionKind::Kernel;
  }
  void editDeclaration() {
    if (!std::exchange(isBehindTemplate_, false)) declarationBegin_ = out_.size();
    if (const std::size_t behind = endOfChoices(cursor_); behind != 0) return editChoices(behind);
    if (atKernel()) return editKernel();
    if (atDeclarationWord("stream")) return editStream();
    if (atWord("iter") && listedName() > 1) return rejectIterator();
    if (cursor_.at(tok::kw_namespace)) return copyUntilBodyOrEnd();
    if (cursor_.at(tok::kw_template)) return editTemplate();
    if (const std::size_t name = brookStream(); name != 0) return rejectStream(name);
    if (const std::size_t kernel = kernelBehindSpecifiers(); kernel != 0) return rejectSpecifiers(kernel);
    copyDeclaration();
  }

  /// The index of `kernel` in `static inline kernel void f` and `extern "C" kernel void f`; 0 in other declarations.
  std::size_t kernelBehindSpecifiers() const {
    std::size_t at = 0;
    while (cursor_.peek(at).isOneOf(tok::kw_static, tok::kw_inline, tok::kw_extern, tok::kw_constexpr,
                                    tok::string_literal)) {
      ++at;
    }
    return isKernelAt(at) ? at : 0;
  }

  bool isKernelAt(std::size_t at) const {
    return isKernelWord(cursor_.peek(at)) && cursor_.peek(at + 1).is(tok::kw_void);
  }

  void rejectSpecifiers(std::size_t kernel) {
    const Token first = cursor_.peek();
    std::string specifiers;
    Token last = first;
    for (std::size_t i = 0; i < kernel; ++i) {
      last = cursor_.take();
      specifiers += (i == 0 ? "" : " ") + preprocessor_.getSpelling(last);
    }
    diagnostics_.report(Diag::KernelSpecifier, locOf(first), {specifiers, nameOf(cursor_.peek())},
                        {FixIt::replace(locOf(first), locOf(last), "")});
    editKernel();
  }

  /// `namespace a {` opens a scope whose declarations are edited like any others; its `}` is copied as an
  /// empty declaration.
  void copyUntilBodyOrEnd() {
    while (!cursor_.at(tok::eof)) {
      const bool last = cursor_.at(tok::l_brace) || cursor_.at(tok::semi);
      copyToken();
      if (last) return;
    }
  }

  /// Edits the `template <...> requires ...` of the declaration that follows, or `template kernel void f<float>(...);`.
  void editTemplate() {
    copyToken();
    if (atKernel()) return editInstantiation();
    if (!cursor_.at(tok::less)) return copyDeclaration();  // `template struct Pair<float>;`
    copyTemplateParameters();
    isBehindTemplate_ = true;
    if (atDeclarationWord("stream")) diagnostics_.report(Diag::StreamTemplate, locOf(cursor_.peek()));
  }

  /// Copies `<...> requires ...`.
  void copyTemplateParameters() {
    copyTokens(cursor_.templateParameters(templates_));
    if (cursor_.at(tok::kw_requires)) copyConstraint();
    noteTemplate();
  }

  /// Remembers the name that a template declares.
  void noteTemplate() {
    constexpr std::size_t longest = 64;  // tokens of a function's result
    std::size_t at = 1;
    if (!cursor_.peek().isOneOf(tok::kw_struct, tok::kw_class, tok::kw_using, tok::kw_concept)) {
      while (at < longest && !cursor_.peek(at).isOneOf(tok::l_paren, tok::equal, tok::semi, tok::l_brace))
        ++at;
      --at;
    }
    if (cursor_.at(at, tok::identifier)) templates_.insert(cursor_.peek(at).getIdentifierInfo());
  }

  /// Copies `requires Small<T> && (sizeof(T) == 4)`.
  void copyConstraint() {
    do {
      copyToken();  // `requires`, `&&` or `||`
      if (cursor_.at(tok::l_paren)) {
        copyParentheses();
      } else if (cursor_.at(tok::kw_requires)) {
        copyToken();
        if (cursor_.at(tok::l_paren)) copyParentheses();
        if (cursor_.at(tok::l_brace)) copyBraces();
      } else {
        copyConcept();
      }
    } while (cursor_.at(tok::ampamp) || cursor_.at(tok::pipepipe));
  }

  /// Copies `true` or a name such as `space::Small<T>::value`.
  void copyConcept() {
    if (cursor_.at(tok::coloncolon)) copyToken();
    while (cursor_.peek().getIdentifierInfo() != nullptr) {
      copyToken();
      if (const std::size_t end = cursor_.at(tok::less) ? cursor_.endOfList(0) : 0; end != 0)
        copyTokens(end + 1);
      if (!cursor_.at(tok::coloncolon)) return;
      copyToken();
      if (cursor_.at(tok::kw_template)) copyToken();
    }
  }

  /// Clang instantiates; lowering checks that the template is a kernel's.
  void editInstantiation() {
    const Token start = cursor_.take();
    const std::vector<Token> head = takeHead();
    const std::vector<Token> declared =
        cursor_.at(tok::l_paren) ? cursor_.takeParenthesized() : std::vector<Token>();
    if (head.size() < 2 || declared.empty() || !cursor_.at(tok::semi)) {
      diagnostics_.report(Diag::KernelInstantiation, locOf(cursor_.at(tok::l_brace) ? cursor_.peek() : start),
                          {nameOf(start)});
      return copyDeclaration();
    }
    for (const Token& token : head) syntax_.addInstantiation(token.getLocation());
    std::vector<Token> constants;  // unused: the template declares them
    ParameterEditor parameters(preprocessor_, diagnostics_, syntax_, constants_, constants);
    const std::vector<Token> edited = parameters.edit(declared, kindOf(start));
    out_.insert(out_.end(), head.begin(), head.end());
    out_.insert(out_.end(), edited.begin(), edited.end());
    copyToken();
  }

  /// Takes what precedes the parameters of a function: `void f` or, for a specialisation, `void f<(1 > 0)>`.
  std::vector<Token> takeHead() {
    std::vector<Token> head;
    while (!cursor_.at(tok::l_paren) && !cursor_.atEndOfDeclaration()) {
      const std::size_t end = cursor_.at(tok::less) ? cursor_.endOfList(0) : 0;
      for (std::size_t i = 0; i <= end; ++i) head.push_back(cursor_.take());
    }
    return head;
  }

  void editStream() {
    StreamEditor(TokenBuilder(preprocessor_), diagnostics_, syntax_, constants_).edit(cursor_, out_);
  }

  /// Reports Brook's `iter float x<100> = iter(0, 1);`
  void rejectIterator() {
    diagnostics_.report(Diag::IteratorDeclaration, locOf(cursor_.peek()));
    skipDeclaration();
  }

  /// The index of `name` in `T name<`; 0 if the declaration does not begin like this.
  std::size_t listedName() const {
    std::size_t at = 0;
    while (startsType(cursor_.peek(at)) && cursor_.peek(at + 1).isNot(tok::less)) ++at;
    return cursor_.peek(at).is(tok::identifier) ? at : 0;
  }

  /// The index of `a` in Brook's `float a<100>;`; 0 for other declarations. In C++, a name would follow the
  /// template arguments.
  std::size_t brookStream() const {
    const std::size_t at = listedName();
    if (at == 0) return 0;
    for (std::size_t i = 0; i < at; ++i) {  // `extern template struct Pair<float>;`
      if (cursor_.peek(i).isOneOf(tok::kw_template, tok::kw_struct, tok::kw_class)) return 0;
    }
    for (std::size_t i = at + 2; !cursor_.peek(i).isOneOf(tok::eof, tok::semi, tok::l_brace, tok::less);
         ++i) {
      if (cursor_.peek(i).is(tok::greater))
        return cursor_.peek(i + 1).isOneOf(tok::semi, tok::comma) ? at : 0;
    }
    return 0;
  }

  void rejectStream(std::size_t name) {
    diagnostics_.report(Diag::StreamKeyword, locOf(cursor_.peek(name)), {nameOf(cursor_.peek(name))},
                        {FixIt::insertBefore(locOf(cursor_.peek()), "stream ")});
    skipDeclaration();
  }

  void skipDeclaration() {
    while (!cursor_.atEndOfDeclaration()) cursor_.take();
    if (cursor_.at(tok::semi)) cursor_.take();
  }

  /// `[[table(lo, hi, n, linear)]] float f(float x) { ... }`
  void editTable(std::size_t behind) {
    const Token attribute = cursor_.peek(2);
    const bool isTemplate = !out_.empty() && closedLists(out_.back()) > 0;
    const std::optional<TableSyntax> table =
        takeTable(cursor_, behind, TokenBuilder(preprocessor_), diagnostics_, constants_, out_);
    const bool isKernel = atKernel();
    const std::optional<Token> name = isKernel || isTemplate ? std::nullopt : copyNamed();
    if (!name) {
      diagnostics_.report(Diag::TablePlace, locOf(attribute));
    } else if (table) {
      syntax_.add(name->getLocation(), *table);
    }
  }

  /// `[[precision(extended)]] kernel void f...`; attributes of other declarations are C++'s.
  void editChoices(std::size_t behind) {
    if (namesTable(cursor_)) return editTable(behind);
    if (isKernelWord(cursor_.peek(behind))) {
      const ir::Choices choices = takeChoices(cursor_, behind, diagnostics_);
      return atKernel() ? editKernel(choices) : copyDeclaration();
    }
    if (namesChoice(cursor_))
      diagnostics_.report(Diag::ChoicePlace, locOf(cursor_.peek(2)), {nameOf(cursor_.peek(2))});
    copyDeclaration();
  }

  void editKernel(const ir::Choices& choices = {}) {
    const Token start = cursor_.take();
    KernelSyntax kernel;
    kernel.choices = choices;
    kernel.kind = kindOf(start);
    kernel.keyword = start.getLocation();
    const std::vector<Token> head = takeHead();  // result type and name
    const std::size_t at = nameAtEnd(head);
    if (at == 0 || !cursor_.at(tok::l_paren)) {
      const Token& location = head.empty() || cursor_.at(tok::l_paren) ? start : cursor_.peek();
      diagnostics_.report(Diag::KernelHead, locOf(location), {wordOf(kernel.kind)});
      return copyDeclaration();
    }
    std::vector<Token> constants;
    ParameterEditor parameters(preprocessor_, diagnostics_, syntax_, constants_, constants);
    const std::vector<Token> declared = cursor_.takeParenthesized();
    if (declared.empty()) {
      diagnostics_.report(Diag::UnclosedParameters, locOf(head[at]), {nameOf(head[at])});
      return;
    }
    const std::vector<Token> edited = parameters.edit(declared, kernel.kind);
    kernel.signature = signature(start, head, declared);
    const bool isPipeline = kernel.kind == FunctionKind::Pipeline;
    syntax_.add(head[at].getLocation(), std::move(kernel));
    out_.insert(out_.end(), head.begin(), head.end());
    out_.insert(out_.end(), edited.begin(), edited.end());
    if (cursor_.at(tok::kw_requires)) copyConstraint();
    if (cursor_.at(tok::l_brace)) {
      for (const ParameterEditor::Input& input : parameters.inputs()) rejectIfOnlyAssigned(input);
      rejectCommaIndices(cursor_.peekBraced(), parameters.indexed(), diagnostics_);
      return copyBody(constants, isPipeline);
    }
    if (cursor_.at(tok::semi)) return copyToken();
    diagnostics_.report(Diag::KernelBody, locOf(cursor_.peek()), {nameOf(head[at])});
    copyDeclaration();
  }

  /// Reports an input that the body only assigns to: an output was meant.
  void rejectIfOnlyAssigned(const ParameterEditor::Input& input) {
    bool isNamed = false;
    int depth = 0;
    for (std::size_t i = 0; cursor_.peek(i).isNot(tok::eof); ++i) {
      const Token& token = cursor_.peek(i);
      if (token.is(tok::l_brace)) ++depth;
      if (token.is(tok::r_brace) && --depth == 0) break;
      const bool isMember = i > 0 && cursor_.peek(i - 1).isOneOf(tok::period, tok::coloncolon);
      if (isMember || token.isNot(tok::identifier) ||
          token.getIdentifierInfo() != input.name.getIdentifierInfo()) {
        continue;
      }
      if (!isAssignedAt(i)) return;
      isNamed = true;
    }
    if (!isNamed) return;
    diagnostics_.report(Diag::InputAssigned, locOf(input.name), {nameOf(input.name)},
                        {FixIt::insertBefore(locOf(input.first), "out ")});
  }

  /// True for `x = ` or `x.y = ` at the start of a statement.
  bool isAssignedAt(std::size_t at) const {
    const Token& before = cursor_.peek(at - 1);
    if (!before.isOneOf(tok::l_brace, tok::r_brace, tok::semi, tok::r_paren, tok::kw_else)) return false;
    while (cursor_.peek(at + 1).is(tok::period)) at += 2;
    return cursor_.peek(at + 1).is(tok::equal);
  }

  void copyDeclaration() { copyNamed(); }

  /// Copies any other declaration, and edits the parameter list of a function, whose name it returns. The `}` of a struct
  /// ends a member, but is not a part of it.
  std::optional<Token> copyNamed(bool isMember = false) {
    bool initializer = false;
    bool record = false;
    std::optional<Token> function;
    std::vector<IndexedParameter> indexed;
    while (!cursor_.at(tok::eof)) {
      if (isMember) checkInner();
      const Token& token = cursor_.peek();
      if (token.isOneOf(tok::semi, tok::r_brace)) {
        if (!isMember || token.is(tok::semi)) copyToken();
        return function;
      }
      const bool isOperator = !out_.empty() && out_.back().is(tok::kw_operator);  // `operator=`
      initializer = initializer || (token.is(tok::equal) && !isOperator) || isValueAhead();
      if (token.isOneOf(tok::kw_struct, tok::kw_class, tok::kw_union, tok::kw_enum)) record = true;
      if (token.is(tok::l_brace)) {
        if (function) rejectCommaIndices(cursor_.peekBraced(), indexed, diagnostics_);
        record && !initializer && !function ? copyRecord() : copyBraces();
        if (!initializer && (function || !record)) return function;
        continue;
      }
      if (!initializer && !function && (function = functionAhead())) {
        const std::vector<Token> declared = takeParameters();
        if (declared.empty()) {
          diagnostics_.report(Diag::UnclosedParameters, locOf(*function), {nameOf(*function)});
          return function;
        }
        ParameterEditor parameters(preprocessor_, diagnostics_, syntax_, constants_, out_);
        const std::vector<Token> edited = parameters.edit(declared, FunctionKind::Helper);
        out_.insert(out_.end(), edited.begin(), edited.end());
        indexed = parameters.indexed();
        continue;
      }
      // `static_assert(f(a[0]))` names no function that is declared here
      const bool isBeforeName = !initializer && !function && cursor_.at(tok::l_paren);
      isBeforeName ? copyParentheses() : copyToken();
    }
    return function;
  }

  /// The name of the function whose parameters come next; of `operator+` and `operator()`, the last token.
  std::optional<Token> functionAhead() const {
    if (!cursor_.at(tok::l_paren)) return std::nullopt;
    for (const std::size_t back : {2U, 3U}) {
      if (out_.size() >= back && out_[out_.size() - back].is(tok::kw_operator)) return out_.back();
    }
    const std::size_t name = nameAtEnd(out_);
    return name != 0 ? std::optional(out_[name]) : std::nullopt;
  }

  /// Takes `( ... )`, and edits the constructors in default arguments. Empty if nothing closes the parentheses.
  std::vector<Token> takeParameters() {
    std::vector<Token> declared = cursor_.takeParenthesized(), copied;
    if (declared.empty()) return declared;
    declared.push_back(TokenBuilder(preprocessor_).make(tok::eof, declared.back().getLocation()));
    TokenCursor parameters(declared);
    while (!parameters.at(tok::eof)) constructors_.copy(parameters, copied);
    return copied;
  }

  /// True after `const float2 a`, if the constructor editor turned its parentheses into a value.
  bool isValueAhead() const { return out_.size() > 1 && out_[out_.size() - 2].is(tok::equal); }

  /// The parameters' constants go first in the body, where a template's own types are known.
  void copyBody(const std::vector<Token>& constants, bool isPipeline) {
    copyToken();
    out_.insert(out_.end(), constants.begin(), constants.end());
    for (int depth = 1; depth > 0 && !cursor_.at(tok::eof); copyToken()) {
      checkInner();
      while (isPipeline && takesLocalStream()) {
      }
      if (cursor_.at(tok::l_brace)) ++depth;
      if (cursor_.at(tok::r_brace)) --depth;
    }
  }

  /// Turns `t<>` in `float t<>, u<>;`, which declares streams of a pipeline, into `t{}`: Clang sees elements.
  bool takesLocalStream() {
    if (!atLocalStream(cursor_, out_.back(), diagnostics_)) return false;
    const TokenBuilder builder(preprocessor_);
    syntax_.addLocalStream(cursor_.peek().getLocation());
    copyToken();
    for (const tok::TokenKind bracket :
         {tok::l_brace, tok::r_brace})  // no warning of values that are not there
      out_.push_back(builder.make(bracket, cursor_.take().getLocation()));
    return true;
  }

  void copyTokens(std::size_t count) {
    for (; count > 0; --count) copyToken();
  }

  void copyParentheses() {
    int depth = 0;
    do {
      if (cursor_.at(tok::l_paren)) ++depth;
      if (cursor_.at(tok::r_paren)) --depth;
      copyToken();
    } while (depth > 0 && !cursor_.at(tok::eof));
  }

  void copyBraces() {
    int depth = 0;
    do {
      checkInner();
      if (cursor_.at(tok::l_brace)) ++depth;
      if (cursor_.at(tok::r_brace)) --depth;
      copyToken();
    } while (depth > 0 && !cursor_.at(tok::eof));
  }

  /// Copies the `{ ... }` of a struct, and edits the members that make it a bundle and the parameters of its functions.
  void copyRecord() {
    std::vector<Token> constants;
    ParameterEditor parameters(preprocessor_, diagnostics_, syntax_, constants_, constants);
    BundleEditor members(parameters);
    copyToken();
    while (!cursor_.at(tok::r_brace) && !cursor_.at(tok::eof)) {
      const bool isLabel = cursor_.peek().isOneOf(tok::kw_public, tok::kw_protected, tok::kw_private);
      if (isLabel && cursor_.at(1, tok::colon)) copyTokens(2);
      members.edit(cursor_, out_);
      copyMember();
    }
    if (cursor_.at(tok::r_brace)) copyToken();
    out_.insert(out_.begin() + static_cast<std::ptrdiff_t>(declarationBegin_), constants.begin(),
                constants.end());
  }

  void copyMember() {
    if (cursor_.at(tok::kw_template)) {
      copyToken();
      copyTemplateParameters();
    }
    copyNamed(/*isMember=*/true);
  }

  /// Reports `stream float a<n>` and Brook's `indexof a` in a body or a struct, and kernels there, which it skips.
  void checkInner() {
    while (rejectInnerKernel()) {
    }
    checkCast();
    checkOperator("indexof");
    checkOperator("extentof");
    const bool starts = out_.back().isOneOf(tok::l_brace, tok::r_brace, tok::semi);
    const bool names = cursor_.peek(2).is(tok::identifier) && cursor_.peek(3).is(tok::less);
    if (starts && names && atDeclarationWord("stream")) {
      diagnostics_.report(Diag::StreamInside, locOf(cursor_.peek()), {nameOf(cursor_.peek(2))});
    }
  }

  /// Reports `kernel void f(...) { ... }` within braces; returns true if it was there.
  bool rejectInnerKernel() {
    const bool starts = out_.back().isOneOf(tok::l_brace, tok::r_brace, tok::semi);
    const bool isDeclared =
        isKernelAt(0) && cursor_.peek(2).is(tok::identifier) && cursor_.at(3, tok::l_paren);
    if (!starts || !isDeclared) return false;
    diagnostics_.report(Diag::KernelInside, locOf(cursor_.peek()), {nameOf(cursor_.peek(2))});
    int depth = 0;
    while (!cursor_.at(tok::eof)) {
      const Token token = cursor_.take();
      if (token.is(tok::l_brace)) ++depth;
      if (token.is(tok::r_brace)) --depth;
      if (depth <= 0 && token.isOneOf(tok::r_brace, tok::semi)) break;
    }
    return true;
  }

  /// Reports OpenCL's `(float4)(1, 2, 3, 4)`, which C++ takes for a cast of the last number.
  void checkCast() {
    const Token& type = cursor_.peek(1);
    if (!cursor_.at(tok::l_paren) || type.isNot(tok::identifier)) return;
    if (cursor_.peek(2).isNot(tok::r_paren) || cursor_.peek(3).isNot(tok::l_paren)) return;
    if (!isVectorTypeName(nameOf(type))) return;
    int depth = 0;
    for (std::size_t i = 3; cursor_.peek(i).isNot(tok::eof); ++i) {
      const Token& token = cursor_.peek(i);
      if (token.isOneOf(tok::l_paren, tok::l_square, tok::l_brace)) ++depth;
      if (token.isOneOf(tok::r_paren, tok::r_square, tok::r_brace) && --depth == 0) return;
      if (token.isNot(tok::comma) || depth != 1) continue;
      return diagnostics_.report(
          Diag::VectorCast, locOf(type), {nameOf(type)},
          {FixIt::replace(locOf(cursor_.peek()), locOf(cursor_.peek(2)), nameOf(type))});
    }
  }

  void checkOperator(llvm::StringRef word) {
    const Token& operand = cursor_.peek(1);
    if (!atWord(word) || operand.isNot(tok::identifier)) return;
    diagnostics_.report(Diag::IndexOfWithout, locOf(cursor_.peek()), {word.str(), nameOf(operand)},
                        {FixIt::replace(locOf(cursor_.peek()), locOf(operand),
                                        fmt::format("{}({})", word.str(), nameOf(operand)))});
  }

  void copyToken() { constructors_.copy(cursor_, out_); }

  std::string signature(const Token& start, const std::vector<Token>& head,
                        const std::vector<Token>& declared) {
    std::string text = preprocessor_.getSpelling(start);
    for (const std::vector<Token>* part : {&head, &declared}) {
      for (const Token& token : *part) {
        if (token.hasLeadingSpace() || token.isAtStartOfLine()) text += ' ';
        text += preprocessor_.getSpelling(token);
      }
    }
    return text;
  }

  clang::Preprocessor& preprocessor_;
  Diagnostics& diagnostics_;
  TokenCursor cursor_;
  ConstructorEditor constructors_;
  std::vector<Token> out_;
  DeclarationSyntax syntax_;
  llvm::SmallPtrSet<const clang::IdentifierInfo*, 16>
      templates_;  ///< names of templates, which `<` may follow
  int constants_ = 0;
  std::size_t declarationBegin_ = 0;  ///< in out_, of the current declaration with its template's head
  bool isBehindTemplate_ = false;
};

/// Reports `a<b<c<d`: Clang tries each `<` as a bracket and as an operator, which doubles the time.
void rejectDeepAngles(const std::vector<Token>& tokens, Diagnostics& diagnostics) {
  constexpr int deepest = 12;
  int depth = 0;
  for (std::size_t i = 1; i < tokens.size(); ++i) {
    if (tokens[i].is(tok::less) && tokens[i - 1].is(tok::identifier)) {
      if (++depth <= deepest) continue;
      return diagnostics.report(Diag::NestedTooDeep, locOf(tokens[i]), {std::to_string(deepest)});
    }
    if (tokens[i].isNot(tok::identifier)) depth = 0;
  }
}

}  // namespace

EditedTokens editTokens(const std::vector<Token>& tokens, clang::Preprocessor& preprocessor,
                        Diagnostics& diagnostics) {
  rejectDeepAngles(tokens, diagnostics);
  return Editor(tokens, preprocessor, diagnostics).run();
}

}  // namespace skc::frontend
