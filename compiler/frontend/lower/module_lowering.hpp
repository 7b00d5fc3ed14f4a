// SPDX-License-Identifier: MIT
//
// The state of lowering one translation unit: types, constants and functions, each lowered at its first use
// and cached. FunctionLowering lowers the bodies.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <unordered_set>

#include <clang/AST/Decl.h>
#include <clang/AST/Type.h>
#include <clang/Basic/SourceLocation.h>
#include <llvm/ADT/SmallPtrSet.h>

#include "frontend/lower/aliases.hpp"
#include "frontend/lower/bundles.hpp"
#include "frontend/tokens/syntax.hpp"
#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace clang {
class ASTContext;
class CXXRecordDecl;
class FunctionDecl;
class FunctionTemplateDecl;
class TemplateArgument;
class Sema;
class SourceManager;
}  // namespace clang

namespace skc::frontend {

/// Thrown after an error was reported: abandons the enclosing statement or declaration; lowering continues
/// with the next one. It never leaves lowerModule.
struct Abandoned {};

class ModuleLowering {
 public:
  ModuleLowering(clang::Sema& sema, const DeclarationSyntax& syntax, Diagnostics& diagnostics)
      : sema_(sema), syntax_(syntax), diagnostics_(diagnostics), bundles_(syntax) {}

  ir::Module run(const std::string& file);

  /// The IR's type for a Clang type. Reports and throws for types that kernels do not support.
  ir::Type type(clang::QualType type, clang::SourceLocation use);
  /// The rank of a gather class, 0 for any other type; sets `element` to its element type.
  int gatherRank(clang::QualType type, clang::SourceLocation use, ir::Type& element);
  /// The same for the class of a scatter output; 0 for the class of a variable output.
  std::optional<int> appendRank(clang::QualType type, clang::SourceLocation use, ir::Type& element);
  /// The role of a kernel's parameter, or of a member of a bundle.
  ir::ParamRole roleOf(const clang::ValueDecl* declared) const;
  /// Checks an element type of a stream, which may not contain arrays.
  void checkElement(ir::Type type, std::string_view name, clang::SourceLocation where);
  /// Reports a bundle where a value is needed.
  [[noreturn]] void refuseBundle(clang::QualType type, clang::SourceLocation use);

  /// Lowers the definition of `declaration` at its first use. Reports recursion at `use`.
  /// `aliases`: the version for calls whose references name parts of one object. `checks`: the version that checks its assertions.
  ir::FunctionId function(const clang::FunctionDecl* declaration, clang::SourceLocation use,
                          const Aliases& aliases = {}, bool checks = false);
  /// The first call of `assert`, and of `printf`, in a function and those that it calls; null if there is none.
  struct Marks {
    const clang::CallExpr* assertion = nullptr;
    const clang::CallExpr* print = nullptr;
  };
  const Marks& marksOf(const clang::FunctionDecl* declaration);
  /// Whether the check of a kernel calls another version of a function: one that asserts, prints, or may write append outputs.
  bool hasCheckedVersion(const clang::FunctionDecl* declaration);
  /// The whole condition of an assertion as the user wrote it, on one line.
  std::string conditionText(const clang::Expr* condition) const;
  /// The number of an assertion, from 1 on.
  std::uint32_t numberOf(const clang::CallExpr* assertion);
  /// The reference is valid until another function is lowered.
  const ir::Function& functionAt(ir::FunctionId id) const { return module_.functions[id]; }
  const ir::Module& module() const { return module_; }

  /// A reference to a namespace-scope constant, which is lowered at its first use.
  ir::ExprPtr constant(const clang::VarDecl* declaration, clang::SourceLocation use);
  const ir::Struct& structAt(std::uint32_t index) const { return module_.structs[index]; }
  ir::Type arrayType(ir::Type element, std::uint64_t length, clang::SourceLocation use);
  const ir::Array& arrayAt(std::uint32_t index) const { return module_.arrays[index]; }

  bool isPrelude(const clang::Decl* declaration) const;
  /// True if it holds the value of a border or identity (parameter_editor.hpp).
  static bool isGenerated(const clang::VarDecl* declaration);
  /// The variable's name; of `auto [p, q]`, which has none, "p_q".
  static std::string nameOf(const clang::VarDecl* declaration);
  /// The name of a type as the user writes it, for messages.
  std::string spelling(ir::Type type) const;
  /// The expression as the user wrote it, on one line, and cut if it is long.
  std::string textOf(const clang::Expr* e) const;

  const DeclarationSyntax& syntax() const { return syntax_; }
  Bundles& bundles() { return bundles_; }
  clang::ASTContext& context() const;
  clang::SourceManager& sources() const;
  Diagnostics& diagnostics() { return diagnostics_; }

  Loc loc(clang::SourceLocation location);
  [[noreturn]] void fail(Diag diag, clang::SourceLocation where,
                         std::initializer_list<std::string_view> arguments = {});

 private:
  friend class PipelineLowering;
  enum class Progress : std::uint8_t { Lowering, Done, Failed };
  struct FunctionEntry {
    ir::FunctionId id;
    Progress progress;
  };

  void declarations(const clang::DeclContext* scope);
  void kernel(const clang::FunctionDecl* declaration, const KernelSyntax& syntax);
  void declared(const clang::FunctionDecl* declaration, const KernelSyntax& syntax,
                clang::SourceLocation where);
  void noteGenerated(const clang::FunctionDecl* kernel);
  void kernelTemplate(const clang::FunctionTemplateDecl* declaration);
  void nameInstance(const clang::FunctionDecl* instance, ir::Kernel& kernel);
  std::string spelling(const clang::TemplateArgument& argument, clang::SourceLocation use);
  void parameters(const clang::FunctionDecl* definition, ir::Kernel& kernel);
  std::uint32_t bundleType(const clang::CXXRecordDecl* record);
  ir::KernelParam kernelParam(const clang::ValueDecl* declaration, std::string name,
                              const ir::Variable& variable);
  void checkFoldedOutputs(const ir::Kernel& kernel, const KernelSyntax& syntax);
  void checkKernelShape(const ir::Kernel& kernel, clang::SourceLocation where);
  void pairReductions();
  bool isOwn(clang::SourceLocation where) const;
  void keepOwnKernels();
  void addMarks(const clang::Stmt* statement, Marks& marks);
  void addAssertionChecks();
  void stream(const clang::VarDecl* declaration, const StreamSyntax& syntax);
  ir::TableId table(const clang::FunctionDecl* declaration, const TableSyntax& syntax);
  std::uint32_t generatedNumber(const std::string& name);
  ir::DeclaredExtent streamExtent(const ExtentSyntax& syntax, const clang::VarDecl* stream);
  const clang::ValueDecl* visibleValue(const clang::VarDecl* stream, const clang::IdentifierInfo* name);
  ir::ValueRange range(const RangeSyntax& syntax, const ir::KernelParam& param, clang::SourceLocation where);
  ir::Scalar scalarInRange(const ir::KernelParam& param, clang::SourceLocation where);
  double rangeEnd(const std::string& constant, const ir::KernelParam& param, ir::Scalar scalar);
  const clang::VarDecl* generatedVariable(const std::string& name);
  ir::ExprPtr generatedConstant(const std::string& name);
  ir::ExprPtr constantValue(const clang::VarDecl* declaration, bool inlined);
  ir::ExprPtr evaluated(const clang::VarDecl* declaration);
  ir::ExprPtr evaluated(const clang::APValue& value, ir::Type type, Loc loc) const;
  std::string structName(const clang::CXXRecordDecl* record) const;
  std::string cppName(const clang::CXXRecordDecl* record) const;
  void addAlias(const clang::TypedefNameDecl* alias);
  void addAliases(const clang::DeclContext* scope);
  ir::Type elementType(clang::QualType type, clang::SourceLocation use);
  ir::Type structType(const clang::CXXRecordDecl* declaration, clang::SourceLocation use);
  void checkPlain(const clang::CXXRecordDecl* record);
  void checkSize(ir::Type type, clang::SourceLocation use);
  bool isInCppHeader(const clang::Decl* declaration) const;
  std::vector<std::string> scopeOf(const clang::Decl* declaration) const;

  clang::Sema& sema_;
  const DeclarationSyntax& syntax_;
  Diagnostics& diagnostics_;
  Bundles bundles_;
  ir::Module module_;
  std::unordered_map<const clang::Decl*, std::uint32_t> structs_, bundleTypes_;
  llvm::SmallPtrSet<const clang::CXXRecordDecl*, 4> refusedStructs_;  ///< reported, or in progress
  std::unordered_map<const clang::Decl*, ir::ConstantId> constants_;
  using Version =
      std::tuple<const clang::Decl*, std::string, bool>;  ///< Aliases::key, and whether it checks assertions
  std::map<Version, FunctionEntry> functions_;
  std::map<const clang::Decl*, Marks> marks_;
  std::map<std::pair<std::uint32_t, std::string>, std::uint32_t>
      assertions_;  ///< numbers by location and text
  std::unordered_map<std::string, std::uint32_t> sourceIndex_;
  std::unordered_map<std::string, const clang::VarDecl*> generated_, generatedGlobals_;
  std::unordered_set<const clang::Decl*> failedConstants_, constantsInProgress_;
  bool inlineConstants_ = false;
  std::vector<bool> isOwn_;  ///< by kernel: the main file's stubs offer it
  /// What a kernel was lowered from: a declaration or, for null, a pipeline, of which some passes have a version that checks assertions.
  struct Origin {
    const clang::FunctionDecl* declaration;
    std::optional<ir::FunctionId> check = {};
  };
  std::vector<Origin> kernelOrigins_;  ///< by kernel
};

}  // namespace skc::frontend
