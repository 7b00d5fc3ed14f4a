// SPDX-License-Identifier: MIT
#include "frontend/diagnostic_parts.hpp"

#include <cctype>

#include <clang/AST/DeclCXX.h>
#include <clang/AST/DeclarationName.h>
#include <clang/Basic/IdentifierTable.h>
#include <clang/Basic/SourceManager.h>
#include <clang/Lex/Lexer.h>
#include <fmt/format.h>

namespace skc::frontend {

using clang::DiagnosticsEngine;

std::string nameIn(const clang::Diagnostic& diagnostic, unsigned argument) {
  switch (diagnostic.getArgKind(argument)) {
    case DiagnosticsEngine::ak_identifierinfo: return diagnostic.getArgIdentifier(argument)->getName().str();
    case DiagnosticsEngine::ak_declarationname:
      return clang::DeclarationName::getFromOpaqueInteger(diagnostic.getRawArg(argument)).getAsString();
    case DiagnosticsEngine::ak_std_string: return diagnostic.getArgStdStr(argument);
    default: return {};
  }
}

std::vector<clang::QualType> typesIn(const clang::Diagnostic& diagnostic) {
  std::vector<clang::QualType> types;
  for (unsigned i = 0; i < diagnostic.getNumArgs(); ++i) {
    if (diagnostic.getArgKind(i) != DiagnosticsEngine::ak_qualtype) continue;
    void* pointer = reinterpret_cast<void*>(diagnostic.getRawArg(i));   // how Clang passes types
    types.push_back(clang::QualType::getFromOpaquePtr(pointer));
  }
  return types;
}

llvm::StringRef textOf(const clang::Diagnostic& diagnostic, unsigned range) {
  if (diagnostic.getNumRanges() <= range) return {};
  return clang::Lexer::getSourceText(diagnostic.getRange(range), diagnostic.getSourceManager(),
                                     clang::LangOptions());
}

namespace {

/// The file's text before a diagnostic's location and from there on.
std::pair<llvm::StringRef, llvm::StringRef> textAround(const clang::Diagnostic& diagnostic) {
  const clang::SourceLocation location = diagnostic.getLocation();
  if (location.isInvalid() || location.isMacroID()) return {};
  const auto [file, offset] = diagnostic.getSourceManager().getDecomposedLoc(location);
  bool isInvalid = false;
  const llvm::StringRef text = diagnostic.getSourceManager().getBufferData(file, &isInvalid);
  if (isInvalid) return {};
  return {text.take_front(offset), text.drop_front(offset)};
}

}  // namespace

llvm::StringRef textAt(const clang::Diagnostic& diagnostic) { return textAround(diagnostic).second; }

llvm::StringRef textBefore(const clang::Diagnostic& diagnostic) { return textAround(diagnostic).first; }

llvm::StringRef nameAt(llvm::StringRef text) {
  return text.take_while([](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; });
}

llvm::StringRef bracketedAt(llvm::StringRef text) {
  int depth = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (llvm::StringRef("([{").contains(text[i])) ++depth;
    if (llvm::StringRef(")]}").contains(text[i])) --depth;
    if (depth == 0) return text.take_front(i == 0 ? 0 : i + 1);
  }
  return {};
}

bool isOfClass(clang::QualType type, llvm::StringRef name) {
  const clang::CXXRecordDecl* record = type.isNull() ? nullptr : type->getAsCXXRecordDecl();
  return record != nullptr && record->getIdentifier() != nullptr && record->getName().starts_with(name);
}

unsigned widthOf(clang::QualType type) {
  if (type.isNull()) return 0;
  const auto* vector = type->getAs<clang::ExtVectorType>();
  return vector == nullptr ? 1 : vector->getNumElements();
}

std::string spellingOf(clang::QualType type) {
  const clang::QualType value = type.getNonReferenceType().getUnqualifiedType();
  const auto* vector = value->getAs<clang::ExtVectorType>();
  if (vector == nullptr || value->getAs<clang::TypedefType>() != nullptr) return value.getAsString();
  const clang::QualType component = vector->getElementType();
  std::string name = component->isChar32Type() ? "bool" : component.getAsString();
  if (name == "unsigned int") name = "uint";
  return fmt::format("{}{}", name, vector->getNumElements());
}

}  // namespace skc::frontend
