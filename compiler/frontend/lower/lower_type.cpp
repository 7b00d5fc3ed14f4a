// SPDX-License-Identifier: MIT
//
// Converts Clang's types to the IR's, and reports types that kernels do not support.
#include <algorithm>

#include <fmt/format.h>

#include <clang/AST/ASTContext.h>
#include <clang/AST/DeclCXX.h>
#include <clang/AST/DeclTemplate.h>
#include <clang/AST/PrettyPrinter.h>
#include <llvm/Support/raw_ostream.h>

#include "frontend/lower/module_lowering.hpp"
#include "frontend/prelude.hpp"
#include "ir/build.hpp"
#include "ir/print.hpp"

namespace skc::frontend {

using clang::SourceLocation;

namespace {

std::optional<ir::Scalar> scalarOf(const clang::BuiltinType* builtin) {
  switch (builtin->getKind()) {
    case clang::BuiltinType::Bool:
    case clang::BuiltinType::Char32: return ir::Scalar::Bool;  // components of bool vectors
    case clang::BuiltinType::Char_S:
    case clang::BuiltinType::SChar: return ir::Scalar::Char;
    case clang::BuiltinType::UChar: return ir::Scalar::Uchar;
    case clang::BuiltinType::Short: return ir::Scalar::Short;
    case clang::BuiltinType::UShort: return ir::Scalar::Ushort;
    case clang::BuiltinType::Half: return ir::Scalar::Half;
    case clang::BuiltinType::Int: return ir::Scalar::Int;
    case clang::BuiltinType::UInt: return ir::Scalar::Uint;
    case clang::BuiltinType::Float: return ir::Scalar::Float;
    case clang::BuiltinType::Double: return ir::Scalar::Double;
    case clang::BuiltinType::Long:
    case clang::BuiltinType::LongLong: return ir::Scalar::Long;
    case clang::BuiltinType::ULong:
    case clang::BuiltinType::ULongLong: return ir::Scalar::Ulong;
    default: return std::nullopt;
  }
}

}  // namespace

ir::Type ModuleLowering::type(clang::QualType qualified, SourceLocation use) {
  const clang::QualType canonical = qualified.getCanonicalType().getUnqualifiedType();
  if (canonical->isVoidType()) return ir::Type::voidType();
  if (canonical->isPointerType() || canonical->isMemberPointerType() || canonical->isNullPtrType() ||
      canonical->isFunctionType()) {
    fail(Diag::Pointer, use, {qualified.getUnqualifiedType().getAsString()});
  }
  if (canonical->isReferenceType()) fail(Diag::ReferenceType, use, {qualified.getAsString()});
  if (const auto* enumeration = canonical->getAs<clang::EnumType>()) {
    return type(enumeration->getDecl()->getIntegerType(), use);
  }
  if (const auto* builtin = canonical->getAs<clang::BuiltinType>()) {
    if (const auto scalar = scalarOf(builtin)) return ir::Type::of(*scalar);
    if (builtin->isInteger() && context().getIntWidth(canonical) > 64)
      fail(Diag::WideInteger, use, {qualified.getUnqualifiedType().getAsString()});
    fail(Diag::ScalarType, use, {qualified.getUnqualifiedType().getAsString()});
  }
  if (const auto* vector = canonical->getAs<clang::ExtVectorType>()) {
    const auto* element = vector->getElementType()->getAs<clang::BuiltinType>();
    const auto scalar = element ? scalarOf(element) : std::nullopt;
    const unsigned width = vector->getNumElements();
    if (scalar && width >= 2 && width <= 4) return ir::Type::of(*scalar, static_cast<int>(width));
    fail(Diag::ScalarType, use, {qualified.getAsString()});
  }
  if (const auto* array = context().getAsConstantArrayType(canonical)) {
    return arrayType(type(array->getElementType(), use), array->getSize().getZExtValue(), use);
  }
  if (canonical->isVariableArrayType()) fail(Diag::ArrayLengthVaries, use);
  if (const clang::CXXRecordDecl* record = canonical->getAsCXXRecordDecl()) {
    if (isPrelude(record)) {
      if (const auto known = classType(record->getName())) return *known;
    }
    return structType(record, use);
  }
  fail(Diag::ScalarType, use, {qualified.getAsString()});
}

namespace {

/// The specialization of a prelude class template that a type is.
const clang::ClassTemplateSpecializationDecl* instanceOf(clang::QualType qualified) {
  const clang::CXXRecordDecl* record = qualified.getNonReferenceType()->getAsCXXRecordDecl();
  return llvm::dyn_cast_or_null<clang::ClassTemplateSpecializationDecl>(record);
}

}  // namespace

/// The type of a gather's or scatter's elements, of which Clang instantiates templates even for `void`.
ir::Type ModuleLowering::elementType(clang::QualType qualified, SourceLocation use) {
  const ir::Type element = type(qualified, use);
  if (element.isVoid()) fail(Diag::ScalarType, use, {qualified.getAsString()});
  return element;
}

int ModuleLowering::gatherRank(clang::QualType qualified, SourceLocation use, ir::Type& element) {
  const auto* instance = instanceOf(qualified);
  const int rank = instance && isPrelude(instance) ? frontend::gatherRank(instance) : 0;
  if (rank != 0) element = elementType(instance->getTemplateArgs()[0].getAsType(), use);
  return rank;
}

std::optional<int> ModuleLowering::appendRank(clang::QualType qualified, SourceLocation use,
                                              ir::Type& element) {
  const auto* instance = instanceOf(qualified);
  if (!instance || !isPrelude(instance)) return std::nullopt;
  for (int rank = 0; rank <= 4; ++rank) {
    if (instance->getName() != appendTemplateName(rank)) continue;
    element = elementType(instance->getTemplateArgs()[0].getAsType(), use);
    return rank;
  }
  return std::nullopt;
}

/// A struct's name as C++ writes it: "Pair<float>".
std::string ModuleLowering::cppName(const clang::CXXRecordDecl* record) const {
  std::string name;
  llvm::raw_string_ostream stream(name);
  clang::PrintingPolicy policy(context().getLangOpts());
  policy.FullyQualifiedName = true;
  record->getNameForDiagnostic(stream, policy, /*Qualified=*/false);
  return name;
}

/// The struct's name; for `typedef struct { ... } A;`, A; for one without a name, an unused name.
std::string ModuleLowering::structName(const clang::CXXRecordDecl* record) const {
  if (const std::string name = record->getNameAsString(); !name.empty()) return name;
  if (const clang::TypedefNameDecl* name = record->getTypedefNameForAnonDecl())
    return name->getNameAsString();
  std::string name = "Anonymous";
  const auto isTaken = [&](const ir::Struct& other) { return other.name == name; };
  for (int i = 2; std::ranges::any_of(module_.structs, isTaken); ++i) name = fmt::format("Anonymous{}", i);
  return name;
}

/// Records `typedef struct Pair_t { ... } Pair;` and `using Pair = Pair_t;` for structs that kernels use.
void ModuleLowering::addAlias(const clang::TypedefNameDecl* alias) {
  const auto found = structs_.find(alias->getUnderlyingType()->getAsCXXRecordDecl());  // keyed by definition
  if (found == structs_.end() || isPrelude(alias)) return;
  ir::Struct& known = module_.structs[found->second];
  if (known.name == alias->getNameAsString() || known.scope != scopeOf(alias)) return;
  known.aliases.push_back(alias->getNameAsString());
}

/// Reports what keeps a struct from being copied member by member, and initialised by a list.
void ModuleLowering::checkPlain(const clang::CXXRecordDecl* record) {
  const std::string name = structName(record);
  const auto reject = [&](SourceLocation where, std::string_view what) {
    fail(Diag::StructNotPlain, where, {name, what});
  };
  if (record->getNumBases() != 0) reject(record->bases_begin()->getBeginLoc(), "it has a base");
  for (const clang::CXXConstructorDecl* constructor : record->ctors()) {
    if (!constructor->isImplicit()) reject(constructor->getLocation(), "it has a constructor");
  }
  for (const clang::Decl* member : record->decls()) {  // constructors of any type
    const auto* pattern = llvm::dyn_cast<clang::FunctionTemplateDecl>(member);
    if (pattern && llvm::isa<clang::CXXConstructorDecl>(pattern->getTemplatedDecl()))
      reject(pattern->getLocation(), "it has a constructor");
  }
  const clang::CXXDestructorDecl* destructor = record->getDestructor();
  if (destructor && record->hasNonTrivialDestructor())
    reject(destructor->getLocation(), "it has a destructor");
  if (!record->hasTrivialCopyConstructor())
    reject(record->getLocation(), "its members are not copied bit by bit");
}

ir::Type ModuleLowering::structType(const clang::CXXRecordDecl* declaration, SourceLocation use) {
  const clang::CXXRecordDecl* record = declaration->getDefinition();
  if (!record) fail(Diag::IncompleteType, use, {declaration->getNameAsString()});
  const auto found = structs_.find(record);
  if (found != structs_.end()) return ir::Type::structType(found->second);
  if (record->isLambda()) fail(Diag::Lambda, use);
  if (isPrelude(record)) fail(Diag::GatherAsValue, use);
  if (bundles_.reasonFor(record) != nullptr) refuseBundle(context().getRecordType(record), use);
  const std::string name = structName(record);
  if (record->isUnion()) fail(Diag::Union, use, {name});
  if (record->isPolymorphic()) fail(Diag::VirtualFunction, use, {name});
  if (!refusedStructs_.insert(record).second) throw Abandoned{};  // already reported; removed on success
  checkPlain(record);
  if (record->field_empty()) fail(Diag::StructEmpty, use, {name});
  ir::Struct entry;
  const bool isInstance = llvm::isa<clang::ClassTemplateSpecializationDecl>(record);
  entry.name = isInstance && isInCppHeader(record) ? cppName(record) : structName(record);
  entry.scope = scopeOf(record);
  entry.loc = loc(record->getLocation());
  for (const clang::FieldDecl* field : record->fields()) {
    if (field->isBitField())
      fail(Diag::StructNotPlain, field->getLocation(),
           {name, fmt::format("'{}' is a bit-field", field->getNameAsString())});
    if (field->getName().empty())
      fail(Diag::StructNotPlain, field->getLocation(), {name, "this member has no name"});
    if (field->isMutable()) fail(Diag::MutableMember, field->getLocation(), {field->getNameAsString()});
    if (const ParamSyntax* syntax = syntax_.param(field->getLocation()); syntax != nullptr && syntax->range)
      fail(Diag::RangeOfMember, field->getLocation(), {field->getNameAsString(), name});
    entry.fields.push_back({field->getNameAsString(), type(field->getType(), field->getLocation())});
  }
  const auto index = static_cast<std::uint32_t>(module_.structs.size());
  module_.structs.push_back(std::move(entry));
  structs_[record] = index;
  refusedStructs_.erase(record);
  checkSize(ir::Type::structType(index), record->getLocation());
  return ir::Type::structType(index);
}

void ModuleLowering::refuseBundle(clang::QualType type, SourceLocation use) {
  const clang::CXXRecordDecl* record = bundles_.bundle(type);
  fail(Diag::BundleAsValue, use, {structName(record), bundles_.reasonFor(record)->getNameAsString()});
}

ir::ParamRole ModuleLowering::roleOf(const clang::ValueDecl* declared) const {
  const clang::CXXRecordDecl* record = declared->getType().getNonReferenceType()->getAsCXXRecordDecl();
  if (frontend::gatherRank(record) != 0) return ir::ParamRole::Gather;
  const ParamSyntax* syntax = syntax_.param(declared->getLocation());
  return syntax ? syntax->role : ir::ParamRole::Uniform;
}

/// The type of a bundle, for C++, with the types of its members.
std::uint32_t ModuleLowering::bundleType(const clang::CXXRecordDecl* record) {
  if (const auto known = bundleTypes_.find(record); known != bundleTypes_.end()) return known->second;
  checkPlain(record);
  ir::BundleType bundle;
  bundle.name = structName(record);
  if (const auto* instance = llvm::dyn_cast<clang::ClassTemplateSpecializationDecl>(record)) {
    for (const clang::TemplateArgument& argument : instance->getTemplateArgs().asArray())
      bundle.arguments += '_' + spelling(argument, record->getLocation());
    std::ranges::replace(bundle.arguments, '-', 'm');
  }
  bundle.scope = scopeOf(record);
  bundle.loc = loc(record->getLocation());
  for (const clang::FieldDecl* field : record->fields()) {
    const SourceLocation where = field->getLocation();
    if (field->hasInClassInitializer())
      fail(Diag::BundleDefault, where, {field->getNameAsString(), bundle.name});
    ir::BundleMember member{field->getNameAsString(), roleOf(field), {}, {}, {}};
    if (const clang::CXXRecordDecl* inner = bundles_.bundle(field->getType())) {
      member.bundle = bundleType(inner);
    } else if (const int rank = gatherRank(field->getType(), where, member.type)) {
      member.rank = static_cast<std::uint8_t>(rank);
    } else {
      member.type = type(field->getType(), where);
      const bool isEnum = field->getType()->isEnumeralType();  // an int in C++, as for other parameters
      if (member.role == ir::ParamRole::Spec && isEnum && member.type.isNarrow())
        member.type = member.type.arithmeticType();
    }
    bundle.members.push_back(std::move(member));
  }
  const auto index = static_cast<std::uint32_t>(module_.bundleTypes.size());
  module_.bundleTypes.push_back(std::move(bundle));
  bundleTypes_[record] = index;
  return index;
}

ir::Type ModuleLowering::arrayType(ir::Type element, std::uint64_t length, SourceLocation use) {
  constexpr std::uint64_t longest = 4096;
  if (length == 0 || length > longest)
    fail(Diag::ArrayLength, use, {std::to_string(length), std::to_string(longest)});
  if (element.kind == ir::Type::Kind::Array) fail(Diag::ArrayOfArrays, use);
  const ir::Array entry{element, static_cast<std::uint32_t>(length)};
  const auto found = std::find(module_.arrays.begin(), module_.arrays.end(), entry);
  const auto index = static_cast<std::uint32_t>(found - module_.arrays.begin());
  if (found == module_.arrays.end()) module_.arrays.push_back(entry);
  checkSize(ir::Type::arrayType(index), use);
  return ir::Type::arrayType(index);
}

void ModuleLowering::checkSize(ir::Type type, SourceLocation use) {
  constexpr std::uint64_t largest = 16384;
  const std::uint64_t size = ir::scalarCount(module_, type);
  if (size > largest) {
    fail(Diag::ValueTooLarge, use, {ir::print(module_, type), std::to_string(size), std::to_string(largest)});
  }
}

std::string ModuleLowering::spelling(ir::Type type) const {
  switch (type.kind) {
    case ir::Type::Kind::Void:
    case ir::Type::Kind::Scalar:
    case ir::Type::Kind::Vector:
    case ir::Type::Kind::Matrix: return ir::print(module_, type);
    case ir::Type::Kind::Struct: return module_.structs[type.index].name;
    case ir::Type::Kind::Array: {
      const ir::Array& array = module_.arrays[type.index];
      return fmt::format("{}[{}]", spelling(array.element), array.length);
    }
  }
  return {};
}

}  // namespace skc::frontend
