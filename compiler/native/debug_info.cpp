// SPDX-License-Identifier: MIT
#include "native/debug_info.hpp"

#include <filesystem>

#include <llvm/BinaryFormat/Dwarf.h>
#include <llvm/IR/Module.h>

namespace skc::native {

using namespace ir;

DebugInfo::DebugInfo(llvm::Module& code, const Module& module) : module_(module), builder_(code) {
  for (const std::string& source : module.sources) {
    const std::filesystem::path path = std::filesystem::absolute(source);
    files_.push_back(builder_.createFile(path.filename().string(), path.parent_path().string()));
  }
  if (files_.empty()) files_.push_back(builder_.createFile(module.file, "."));
  unit_ = builder_.createCompileUnit(llvm::dwarf::DW_LANG_C_plus_plus_14, files_[0], "skc", true, "", 0);
  code.addModuleFlag(llvm::Module::Warning, "Debug Info Version", llvm::DEBUG_METADATA_VERSION);
  code.addModuleFlag(llvm::Module::Warning, "Dwarf Version", 4);
}

llvm::DIFile* DebugInfo::file(std::uint32_t number) { return files_[number < files_.size() ? number : 0]; }

llvm::DISubprogram* DebugInfo::makeProgram(const Function& function, llvm::StringRef linkage) {
  llvm::DISubroutineType* const type = builder_.createSubroutineType(builder_.getOrCreateTypeArray({}));
  return builder_.createFunction(file(function.loc.file), function.name, linkage, file(function.loc.file),
                                 function.loc.line, type, function.loc.line, llvm::DINode::FlagPrototyped,
                                 llvm::DISubprogram::SPFlagDefinition | llvm::DISubprogram::SPFlagOptimized);
}

llvm::DISubprogram* DebugInfo::programOf(const Function& function) {
  llvm::DISubprogram*& program = programs_[&function];
  if (program == nullptr) program = makeProgram(function, "");
  return program;
}

void DebugInfo::begin(llvm::IRBuilder<>& b, llvm::Function& code, const Function& function) {
  llvm::DISubprogram* const program = makeProgram(function, code.getName());
  code.setSubprogram(program);
  scopes_ = {{program, nullptr}};
  moveTo(b, function.loc);
}

void DebugInfo::end(llvm::IRBuilder<>& b) {
  scopes_.clear();
  b.SetCurrentDebugLocation({});
}

void DebugInfo::enter(llvm::IRBuilder<>& b, const Function& function) {
  scopes_.push_back({programOf(function), b.getCurrentDebugLocation().get()});
  moveTo(b, function.loc);
}

void DebugInfo::leave(llvm::IRBuilder<>& b) {
  b.SetCurrentDebugLocation(scopes_.back().calledAt);
  scopes_.pop_back();
}

void DebugInfo::moveTo(llvm::IRBuilder<>& b, const Loc& loc) {
  if (loc.line == 0) return;  // what transforms have added belongs to the line before it
  const Scope& scope = scopes_.back();
  b.SetCurrentDebugLocation(
      llvm::DILocation::get(b.getContext(), loc.line, 0, scope.program, scope.calledAt));
}

llvm::DIType* DebugInfo::scalarType(Scalar scalar, llvm::Type* memory) {
  const std::uint64_t bits = memory->getScalarSizeInBits();
  switch (carrierOf(scalar)) {
    case Scalar::Bool:
      return builder_.createBasicType("bool", std::max<std::uint64_t>(bits, 8), llvm::dwarf::DW_ATE_boolean);
    case Scalar::Int: return builder_.createBasicType("int", bits, llvm::dwarf::DW_ATE_signed);
    case Scalar::Uint: return builder_.createBasicType("uint", bits, llvm::dwarf::DW_ATE_unsigned);
    default: break;
  }
  const bool isReal = scalar == Scalar::Float || scalar == Scalar::Double;
  return builder_.createBasicType(bits == 32   ? "float"
                                  : bits == 64 ? "double"
                                               : "half",
                                  bits, isReal ? llvm::dwarf::DW_ATE_float : llvm::dwarf::DW_ATE_unsigned);
}

void DebugInfo::declare(llvm::IRBuilder<>& b, const Variable& variable, llvm::Value* memory) {
  const auto* allocation = llvm::dyn_cast<llvm::AllocaInst>(memory);
  if (allocation == nullptr || variable.type.kind != Type::Kind::Scalar || scopes_.empty()) return;
  llvm::DILocation* const here = b.getCurrentDebugLocation().get();
  if (here == nullptr) return;
  llvm::DIType* const type = scalarType(variable.type.scalar, allocation->getAllocatedType());
  const std::uint32_t line = variable.loc.line == 0 ? here->getLine() : variable.loc.line;
  llvm::DILocalVariable* const declared = builder_.createAutoVariable(
      scopes_.back().program, variable.name, file(variable.loc.file), line, type, true);
  builder_.insertDeclare(memory, declared, builder_.createExpression(), here, b.GetInsertBlock());
}

}  // namespace skc::native
