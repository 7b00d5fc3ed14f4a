// SPDX-License-Identifier: MIT
//
// Makes tokens that the user did not write, at source locations of tokens that the user wrote.
#pragma once

#include <string>
#include <vector>

#include <clang/Lex/Token.h>

namespace clang {
class Preprocessor;
}

namespace skc::frontend {

class TokenBuilder {
 public:
  explicit TokenBuilder(clang::Preprocessor& preprocessor) : preprocessor_(preprocessor) {}

  clang::Token make(clang::tok::TokenKind kind, clang::SourceLocation place) const;
  /// An identifier or keyword with this spelling.
  clang::Token word(llvm::StringRef name, clang::SourceLocation place) const;
  /// Appends `static const T NAME __attribute__((unused)) = value;` to `out`.
  void constant(const std::string& name, const std::vector<clang::Token>& type,
                const std::vector<clang::Token>& value, clang::SourceLocation place,
                std::vector<clang::Token>& out) const;

 private:
  clang::Preprocessor& preprocessor_;
};

}  // namespace skc::frontend
