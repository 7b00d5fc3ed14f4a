// SPDX-License-Identifier: MIT
#include "native/debug_info.hpp"

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <llvm/BinaryFormat/Dwarf.h>
#include <llvm/IR/CFG.h>
#include <llvm/IR/Instructions.h>
#include <llvm/IR/Module.h>

namespace skc::native {

using namespace ir;

namespace {

/// Names the path as skc got it and the working directory, as C++ compilers do.
llvm::DIFile* makeFile(llvm::DIBuilder& builder, const std::string& path) {
  return builder.createFile(path, std::filesystem::current_path().string());
}

/// Debuggers show a narrow scalar as the integer that memory holds.
unsigned encodingOf(Scalar scalar) {
  switch (scalar) {
    case Scalar::Bool: return llvm::dwarf::DW_ATE_boolean;
    case Scalar::Float:
    case Scalar::Double:
    case Scalar::Half: return llvm::dwarf::DW_ATE_float;
    case Scalar::Int:
    case Scalar::Long:
    case Scalar::Char:
    case Scalar::Short:
    case Scalar::Snorm8:
    case Scalar::Snorm16: return llvm::dwarf::DW_ATE_signed;
    case Scalar::Uint:
    case Scalar::Ulong:
    case Scalar::Uchar:
    case Scalar::Ushort:
    case Scalar::Unorm8:
    case Scalar::Unorm16: break;
  }
  return llvm::dwarf::DW_ATE_unsigned;
}

/// DWARF cannot point to single bits in memory.
bool isDescribable(const LeafMemory& leaf) {
  return !leaf.element->isVectorTy() || !leaf.element->getScalarType()->isIntegerTy(1);
}

/// Puts blocks in the order of execution: then before else, the body of a loop before what follows. Debuggers stop once more
/// at a line whose code lies in two places.
void layOut(llvm::Function& function) {
  std::vector<llvm::BasicBlock*> finished;
  std::set<const llvm::BasicBlock*> seen = {&function.getEntryBlock()};
  std::vector<std::pair<llvm::BasicBlock*, unsigned>>
      open;  ///< and how many successors are left, the last one first
  const auto enter = [&](llvm::BasicBlock* block) {
    open.emplace_back(block, block->getTerminator()->getNumSuccessors());
  };
  enter(&function.getEntryBlock());
  while (!open.empty()) {
    auto& [block, left] = open.back();
    if (left == 0) {
      finished.push_back(block);
      open.pop_back();
      continue;
    }
    llvm::BasicBlock* const next = block->getTerminator()->getSuccessor(--left);
    if (seen.insert(next).second) enter(next);
  }
  for (std::size_t i = finished.size(); i-- > 1;) finished[i - 1]->moveAfter(finished[i]);
}

}  // namespace

DebugInfo::DebugInfo(llvm::Module& code, const Module& module, bool isOptimized)
    : module_(module), isOptimized_(isOptimized), builder_(code) {
  for (const std::string& source : module.sources) files_.push_back(makeFile(builder_, source));
  if (files_.empty()) files_.push_back(makeFile(builder_, module.file));
  // C, because debuggers show its functions by name, without the types of parameters
  unit_ = builder_.createCompileUnit(llvm::dwarf::DW_LANG_C99, files_[0], "skc", isOptimized, "", 0);
  code.addModuleFlag(llvm::Module::Warning, "Debug Info Version", llvm::DEBUG_METADATA_VERSION);
  code.addModuleFlag(llvm::Module::Warning, "Dwarf Version", 4);
}

llvm::DIFile* DebugInfo::file(std::uint32_t number) { return files_[number < files_.size() ? number : 0]; }

/// Sets no linkage name, because debuggers would show it in place of the kernel's name.
llvm::DISubprogram* DebugInfo::makeProgram(const Function& function) {
  llvm::DISubroutineType* const type = builder_.createSubroutineType(builder_.getOrCreateTypeArray({}));
  const auto optimized = isOptimized_ ? llvm::DISubprogram::SPFlagOptimized : llvm::DISubprogram::SPFlagZero;
  return builder_.createFunction(file(function.loc.file), function.name, "", file(function.loc.file),
                                 function.loc.line, type, function.loc.line, llvm::DINode::FlagPrototyped,
                                 llvm::DISubprogram::SPFlagDefinition | optimized);
}

// ---- scopes ---------------------------------------------------------------------------------------

void DebugInfo::begin(llvm::IRBuilder<>& b, llvm::Function& code, const Function& function) {
  llvm::DISubprogram* const program = makeProgram(function);
  code.setSubprogram(program);
  begun_ = &function;
  programs_.clear();
  scopes_ = {{program, nullptr, {}}};
  // what loads arguments and counts elements has no line, so that a breakpoint on the kernel stops behind it
  const unsigned line = isOptimized_ ? function.loc.line : 0;
  b.SetCurrentDebugLocation(llvm::DILocation::get(b.getContext(), line, 0, program));
}

void DebugInfo::end(llvm::IRBuilder<>& b) {
  if (!isOptimized_) layOut(*b.GetInsertBlock()->getParent());
  scopes_.clear();
  b.SetCurrentDebugLocation({});
}

/// The body of the function that begin() got is not an inlined function.
void DebugInfo::enter(llvm::IRBuilder<>& b, const Function& function) {
  const llvm::DebugLoc before = b.getCurrentDebugLocation();
  if (&function == begun_) {
    scopes_.push_back({scopes_[0].program, nullptr, before});
  } else {
    llvm::DISubprogram*& program = programs_[&function];
    if (program == nullptr) program = makeProgram(function);
    scopes_.push_back({program, before.get(), before});
  }
  if (isOptimized_ || &function != begun_) moveTo(b, function.loc);
}

void DebugInfo::leave(llvm::IRBuilder<>& b) {
  b.SetCurrentDebugLocation(scopes_.back().before);
  scopes_.pop_back();
}

void DebugInfo::moveTo(llvm::IRBuilder<>& b, const Loc& loc) {
  if (loc.line == 0) return;  // code that transforms added belongs to the line before it
  const Scope& scope = scopes_.back();
  b.SetCurrentDebugLocation(
      llvm::DILocation::get(b.getContext(), loc.line, 0, scope.program, scope.calledAt));
}

// ---- types ----------------------------------------------------------------------------------------

/// Names a float by the type that represents it, such as double in code for the reference. A bool of more
/// than 8 bits has all bits set if it is true.
llvm::DIType* DebugInfo::scalarType(Scalar scalar, std::uint64_t bits) {
  if (scalar == Scalar::Bool && bits > 8) {
    llvm::DINodeArray const values = builder_.getOrCreateArray(
        {builder_.createEnumerator("false", 0), builder_.createEnumerator("true", -1)});
    return builder_.createEnumerationType(unit_, "bool", nullptr, 0, bits, 0, values,
                                          builder_.createBasicType("int", bits, llvm::dwarf::DW_ATE_signed));
  }
  const std::string_view name = !isReal(scalar) ? row(scalar).spelling
                                : bits == 32    ? "float"
                                : bits == 64    ? "double"
                                                : "__float128";
  return builder_.createBasicType(name, bits, encodingOf(scalar));
}

llvm::DIType* DebugInfo::leafType(const LeafMemory& leaf) {
  const std::uint64_t bits = std::max<std::uint64_t>(leaf.element->getScalarSizeInBits(), 8);
  llvm::DIType* type = scalarType(leaf.scalar, bits);
  std::uint64_t size = bits;
  const auto counted = [&](std::int64_t count) { return builder_.getOrCreateSubrange(0, count); };
  if (const auto* lanes = llvm::dyn_cast<llvm::FixedVectorType>(leaf.element)) {
    size *= lanes->getNumElements();
    type = builder_.createVectorType(size, 0, type,
                                     builder_.getOrCreateArray({counted(lanes->getNumElements())}));
  }
  std::vector<llvm::Metadata*> dimensions;
  for (const std::uint32_t length : leaf.dimensions) {
    dimensions.push_back(counted(length));
    size *= length;
  }
  return dimensions.empty() ? type
                            : builder_.createArrayType(size, 0, type, builder_.getOrCreateArray(dimensions));
}

llvm::DIType* DebugInfo::recordType(const std::string& name, const std::vector<Member>& members) {
  std::vector<llvm::Metadata*> elements;
  std::uint64_t offset = 0;
  for (const Member& member : members) {
    const std::uint64_t size = member.type->getSizeInBits();
    elements.push_back(builder_.createMemberType(unit_, member.name, nullptr, 0, size, 0, offset,
                                                 llvm::DINode::FlagZero, member.type));
    offset += size;
  }
  return builder_.createStructType(unit_, name, nullptr, 0, offset, 0, llvm::DINode::FlagZero, nullptr,
                                   builder_.getOrCreateArray(elements));
}

llvm::DIType* DebugInfo::typeOf(Type type, Leaves& next) {
  static constexpr const char* components[] = {"x", "y", "z", "w"};
  std::vector<Member> members;
  switch (type.kind) {
    case Type::Kind::Void: break;
    case Type::Kind::Scalar: return leafType(*next++);
    case Type::Kind::Vector:
      for (int i = 0; i < type.width; ++i) members.push_back({components[i], leafType(*next++)});
      return recordType(fmt::format("{}{}", row(type.scalar).spelling, type.width), members);
    case Type::Kind::Matrix:
      for (int row = 0; row < type.width; ++row)
        members.push_back({fmt::format("row{}", row), typeOf(type.indexed(), next)});
      return recordType(fmt::format("float{0}x{0}", type.width), members);
    case Type::Kind::Struct:
      for (const StructField& field : module_.structs[type.index].fields) {
        members.push_back({field.name, typeOf(field.type, next)});
      }
      return recordType(module_.structs[type.index].name, members);
    case Type::Kind::Array:
      return typeOf(module_.arrays[type.index].element, next);  // leafType() adds the dimensions
  }
  return nullptr;
}

// ---- variables ------------------------------------------------------------------------------------

void DebugInfo::declare(llvm::IRBuilder<>& b, const Variable& variable, unsigned parameter,
                        const std::vector<LeafMemory>& memory) {
  if (variable.loc.line == 0 || memory.empty() || !std::ranges::all_of(memory, isDescribable)) return;
  const Scope& scope = scopes_.back();
  Leaves leaves = memory.begin();
  llvm::DIType* const type = typeOf(variable.type, leaves);
  llvm::DIFile* const source = file(variable.loc.file);
  const unsigned line = variable.loc.line;
  llvm::DILocalVariable* const declared =
      parameter != 0 ? builder_.createParameterVariable(scope.program, variable.name, parameter, source, line,
                                                        type, true)
                     : builder_.createAutoVariable(scope.program, variable.name, source, line, type, true);
  llvm::DILocation* const here =
      llvm::DILocation::get(b.getContext(), line, 0, scope.program, scope.calledAt);
  std::uint64_t offset = 0;
  for (const LeafMemory& leaf : memory) {
    const std::uint64_t size = leafType(leaf)->getSizeInBits();
    llvm::DIExpression* part = builder_.createExpression();
    if (memory.size() > 1) {
      part = *llvm::DIExpression::createFragmentExpression(part, static_cast<unsigned>(offset),
                                                           static_cast<unsigned>(size));
    }
    builder_.insertDeclare(leaf.memory, declared, part, here, b.GetInsertBlock());
    offset += size;
  }
}

}  // namespace skc::native
