// SPDX-License-Identifier: MIT
//
// Bundles: structs whose members are parameters of kernels. The IR has none of them. A function has a parameter for each
// member that it, or a function that it calls, reads of a bundle; kernels get the same code as with flat parameters.
//
//   struct Scene { float4 corner[]; int count; };
//   float4 first(Scene scene)      ->      float4 first(float4 scene_corner[])
#pragma once

#include <map>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include <clang/AST/Type.h>

#include "frontend/tokens/syntax.hpp"

namespace clang {
class CallExpr;
class CXXRecordDecl;
class Expr;
class FieldDecl;
class FunctionDecl;
class ParmVarDecl;
class Stmt;
}  // namespace clang

namespace skc::frontend {

/// The expression whose value is passed: without the copies and casts that C++ puts around it.
const clang::Expr* withoutCopies(const clang::Expr* e);

/// The argument that a call passes for a parameter of its callee, or, for null, the object of a member function.
const clang::Expr* argumentFor(const clang::CallExpr* call, const clang::FunctionDecl* callee,
                               const clang::ParmVarDecl* parameter);

class Bundles {
 public:
  explicit Bundles(const DeclarationSyntax& syntax) : syntax_(syntax) {}

  /// Members within members, outermost first; the last one is no bundle.
  using Path = std::vector<const clang::FieldDecl*>;

  /// A parameter that is a bundle, or the object of a member function of one, and a member of it or all of it.
  struct Place {
    const clang::ParmVarDecl* parameter;  ///< null: the object
    Path path;

    auto operator<=>(const Place&) const = default;
  };

  /// What a parameter in the IR stands for: a parameter of a function, or a member of one.
  struct Source {
    const clang::ParmVarDecl* parameter;  ///< null: the object
    Path member;  ///< empty: the parameter itself
  };

  /// The struct of a bundle, or of a reference to one; null for other types.
  const clang::CXXRecordDecl* bundle(clang::QualType type);
  bool isBundle(clang::QualType type) { return bundle(type) != nullptr; }
  /// The first member that makes a struct a bundle.
  const clang::FieldDecl* reasonFor(const clang::CXXRecordDecl* record);

  /// What an expression names; nullopt for one that is neither a bundle nor a member of one.
  std::optional<Place> placeOf(const clang::Expr* e);

  /// The parameters in the IR of a function that has a body, in order.
  std::vector<Source> parametersOf(const clang::FunctionDecl* definition);

 private:
  bool isBundleParameter(const clang::ParmVarDecl* parameter);
  const std::vector<Path>& read(const clang::FunctionDecl* definition, const clang::ParmVarDecl* parameter);
  void findReads(const clang::FunctionDecl* definition);
  void findReads(const clang::Stmt* statement, const clang::FunctionDecl* reader);
  void note(const clang::FunctionDecl* reader, Place place);

  const DeclarationSyntax& syntax_;
  std::unordered_map<const clang::CXXRecordDecl*, const clang::FieldDecl*> reasons_;
  std::unordered_set<const clang::FunctionDecl*> searched_;
  std::map<std::pair<const clang::FunctionDecl*, const clang::ParmVarDecl*>, std::vector<Path>> reads_;
};

}  // namespace skc::frontend
