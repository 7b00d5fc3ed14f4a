// SPDX-License-Identifier: MIT
//
// Lowers leaves, casts, members and initialisers: expressions without effects of their own.
#include <algorithm>
#include <bit>

#include <clang/AST/ASTContext.h>
#include <clang/AST/DeclCXX.h>
#include <clang/AST/ExprCXX.h>
#include <fmt/format.h>

#include "frontend/clang_loc.hpp"
#include "frontend/lower/convert_literal.hpp"
#include "frontend/lower/function_lowering.hpp"
#include "frontend/prelude.hpp"
#include "ir/build.hpp"
#include "ir/lvalue.hpp"

namespace skc::frontend {

using clang::SourceLocation;
using ir::ExprPtr;

ExprPtr FunctionLowering::make(ir::Type type, SourceLocation where, ir::Expr::Node node) {
  return ir::makeExpr(type, std::move(node), module_.loc(where));
}

ExprPtr FunctionLowering::literal(ir::Type type, std::uint64_t bits, SourceLocation where) {
  return make(type, where,
              type.is64Bit() ? ir::Literal::wide(bits) : ir::Literal{static_cast<std::uint32_t>(bits)});
}

// ---- wrappers -------------------------------------------------------------------------------------

ExprPtr FunctionLowering::VisitParenExpr(const clang::ParenExpr* e) { return value(e->getSubExpr()); }
ExprPtr FunctionLowering::VisitConstantExpr(const clang::ConstantExpr* e) { return value(e->getSubExpr()); }
ExprPtr FunctionLowering::VisitExprWithCleanups(const clang::ExprWithCleanups* e) {
  return value(e->getSubExpr());
}
ExprPtr FunctionLowering::VisitMaterializeTemporaryExpr(const clang::MaterializeTemporaryExpr* e) {
  return value(e->getSubExpr());
}
ExprPtr FunctionLowering::VisitSubstNonTypeTemplateParmExpr(const clang::SubstNonTypeTemplateParmExpr* e) {
  return value(e->getReplacement());
}
/// `a != b` if only == is declared.
ExprPtr FunctionLowering::VisitCXXRewrittenBinaryOperator(const clang::CXXRewrittenBinaryOperator* e) {
  return value(e->getSemanticForm());
}
ExprPtr FunctionLowering::VisitCXXDefaultArgExpr(const clang::CXXDefaultArgExpr* e) {
  return value(e->getExpr());
}
/// In the initialiser of a member, `this` is the object that is being initialised.
ExprPtr FunctionLowering::VisitCXXDefaultInitExpr(const clang::CXXDefaultInitExpr* e) {
  const std::optional<ir::VarId> outer = std::exchange(this_, initialized_);
  ExprPtr result = value(e->getExpr());
  this_ = outer;
  return result;
}

// ---- leaves ---------------------------------------------------------------------------------------

ExprPtr FunctionLowering::VisitIntegerLiteral(const clang::IntegerLiteral* e) {
  const ir::Type type = module_.type(e->getType(), e->getLocation());
  return literal(type, e->getValue().getLimitedValue(), e->getLocation());
}

ExprPtr FunctionLowering::VisitCXXBoolLiteralExpr(const clang::CXXBoolLiteralExpr* e) {
  return literal(ir::Type::of(ir::Scalar::Bool), e->getValue() ? 1 : 0, e->getLocation());
}

ExprPtr FunctionLowering::VisitDeclRefExpr(const clang::DeclRefExpr* e) {
  const clang::ValueDecl* declared = e->getDecl();
  const SourceLocation where = e->getLocation();
  if (const auto found = variables_.find(declared); found != variables_.end())
    return read(found->second, e->getType(), where);
  if (module_.bundles().placeOf(e)) module_.refuseBundle(declared->getType(), where);
  if (const auto* enumerator = llvm::dyn_cast<clang::EnumConstantDecl>(declared)) {
    const ir::Type type = module_.type(e->getType(), where);
    return literal(type, lowBits(enumerator->getInitVal()), where);
  }
  if (const auto* variable = llvm::dyn_cast<clang::VarDecl>(declared)) {
    const bool isOutside = function_.name.empty();   // in a border or identity
    if (isOutside && llvm::isa<clang::ParmVarDecl>(variable)) module_.fail(Diag::NotConstant, where);
    abandonIfUnknown(e);
    return module_.constant(variable, where);
  }
  if (const auto* binding = llvm::dyn_cast<clang::BindingDecl>(declared))   // auto [p, q] = f(x);
    return value(binding->getBinding());
  if (llvm::isa<clang::FunctionDecl>(declared))
    module_.fail(Diag::Pointer, where, {declared->getType().getAsString()});
  return VisitExpr(e);
}

ExprPtr FunctionLowering::VisitCXXThisExpr(const clang::CXXThisExpr* e) {
  if (module_.bundles().placeOf(e)) module_.refuseBundle(e->getType()->getPointeeType(), e->getLocation());
  if (const auto part = aliases_.find(*this_); part != aliases_.end()) return ir::clone(part->second);
  return make(function_.variables[*this_].type, e->getLocation(), ir::VarRef{*this_});
}

namespace {

bool isKernelInteger(clang::QualType type) {
  if (type->isEnumeralType()) return true;
  const auto* builtin = type->getAs<clang::BuiltinType>();
  if (!builtin) return false;
  switch (builtin->getKind()) {
    case clang::BuiltinType::Bool:
    case clang::BuiltinType::Char32:
    case clang::BuiltinType::Char_S:
    case clang::BuiltinType::SChar:
    case clang::BuiltinType::UChar:
    case clang::BuiltinType::Short:
    case clang::BuiltinType::UShort:
    case clang::BuiltinType::Int:
    case clang::BuiltinType::UInt: return true;
    default: return false;
  }
}

}  // namespace

/// An integer constant such as sizeof or 'a'; null if `e` is not one, or does not fit in `type`.
ExprPtr FunctionLowering::integerConstant(const clang::Expr* e, ir::Type type) {
  clang::Expr::EvalResult result;
  if (e->isValueDependent() || !e->EvaluateAsInt(result, module_.context())) return nullptr;
  const llvm::APSInt& number = result.Val.getInt();
  const unsigned bits = type.is64Bit() ? 64 : 32;
  const bool fits = number.isNegative() ? number.isSignedIntN(bits) : number.isIntN(bits);
  if (!fits) return nullptr;
  return literal(type, lowBits(number), e->getBeginLoc());
}

/// The value of an integer constant of any type that fits in an int or a uint.
std::optional<double> FunctionLowering::integerValue(const clang::Expr* e) const {
  clang::Expr::EvalResult result;
  if (e->isValueDependent() || !e->EvaluateAsInt(result, module_.context())) return std::nullopt;
  const llvm::APSInt& number = result.Val.getInt();
  const bool fits = number.isNegative() ? number.isSignedIntN(32) : number.isIntN(32);
  return fits ? std::optional(static_cast<double>(number.getExtValue())) : std::nullopt;
}

// ---- casts ----------------------------------------------------------------------------------------

ExprPtr FunctionLowering::VisitCastExpr(const clang::CastExpr* e) {
  const clang::Expr* operand = e->getSubExpr();
  const SourceLocation where = e->getBeginLoc();
  switch (e->getCastKind()) {
    case clang::CK_NoOp:
    case clang::CK_LValueToRValue:
    case clang::CK_UserDefinedConversion:
    case clang::CK_ConstructorConversion: return value(operand);
    case clang::CK_PointerToBoolean:  // assert(x > 0 && "why")
      if (isInCondition_ && llvm::isa<clang::StringLiteral>(operand->IgnoreParenImpCasts()))
        return ir::literal(true, module_.loc(where));
      module_.fail(Diag::Pointer, where, {e->getType().getAsString()});
    case clang::CK_FloatingCast: {
      const ir::Scalar to = module_.type(e->getType(), where).scalar;
      return to == ir::Scalar::Double ? doubleValue(operand) : convert(value(operand), to);
    }
    case clang::CK_IntegralCast:
      if (!isKernelInteger(operand->getType())) {
        if (ExprPtr constant = integerConstant(e, module_.type(e->getType(), where))) return constant;
      }
      return convert(value(operand), module_.type(e->getType(), where).scalar);
    case clang::CK_IntegralToFloating:
      if (!isKernelInteger(operand->getType())) {
        const std::optional<double> number = integerValue(operand);
        const ir::Scalar to = module_.type(e->getType(), where).scalar;
        if (number && to == ir::Scalar::Float)
          return ir::literal(static_cast<float>(*number), *number, module_.loc(where));
        if (number) return convert(ir::literal(*number, module_.loc(where)), to);
      }
      return convert(value(operand), module_.type(e->getType(), where).scalar);
    case clang::CK_FloatingToIntegral: {
      const ir::Type to = module_.type(e->getType(), where);  // floats have too few bits for an integer of 64
      return convert(to.isLong() && isLiterals(operand) ? literalsAsDouble(operand) : value(operand),
                     to.scalar);
    }
    case clang::CK_IntegralToBoolean:
    case clang::CK_FloatingToBoolean:
    case clang::CK_BooleanToSignedIntegral:
      return convert(value(operand), module_.type(e->getType(), where).scalar);
    case clang::CK_VectorSplat: return splat(value(operand), module_.type(e->getType(), where).width);
    case clang::CK_BitCast: return vectorBitCast(e);
    case clang::CK_LValueToRValueBitCast:  // __builtin_bit_cast
      module_.fail(Diag::BitCast, where, {e->getType().getAsString()});
    case clang::CK_ToVoid: {
      discarded(operand);
      return ir::literal(false, module_.loc(where));
    }
    default: break;
  }
  if (e->getType()->isPointerType() || operand->getType()->isPointerType()) {
    module_.fail(Diag::Pointer, where, {e->getType().getAsString()});
  }
  return VisitExpr(e);
}

/// Casts between integer vectors of one width: int and uint keep their bits, masks and bools their truth.
ExprPtr FunctionLowering::vectorBitCast(const clang::CastExpr* e) {
  const ir::Type from = module_.type(e->getSubExpr()->getType(), e->getBeginLoc());
  const ir::Type to = module_.type(e->getType(), e->getBeginLoc());
  const bool isImplicit = llvm::isa<clang::ImplicitCastExpr>(e);
  const bool mixesSigns =
      isImplicit && !from.isBool() && !to.isBool();  // int4 / uint4 would get the left type
  const bool areIntegers = !from.arithmeticType().isFloat() && !to.arithmeticType().isFloat() &&
                           !from.isDouble() && !to.isDouble();
  if (!from.isVector() || !to.isVector() || from.width != to.width || !areIntegers || mixesSigns) {
    module_.fail(isImplicit ? Diag::MixedVectors : Diag::BitCast, e->getBeginLoc(), {module_.spelling(to)});
  }
  ExprPtr operand = value(e->getSubExpr());
  if (from.isBool() && !to.isBool()) return convert(mask(std::move(operand)), to.scalar);
  return convert(std::move(operand), to.scalar);
}

namespace {

/// -int4(b), the result of comparing vectors: 0 or -1 per component, possibly of a narrow or wide type.
ExprPtr* maskedBool(ir::Expr& e) {
  if (auto* kept = std::get_if<ir::Convert>(&e.node); kept && (e.type.isNarrow() || e.type.isLong()))
    return maskedBool(*kept->operand);
  auto* negate = std::get_if<ir::Unary>(&e.node);
  if (!negate || negate->op != ir::UnaryOp::Negate) return nullptr;
  auto* conversion = std::get_if<ir::Convert>(&negate->operand->node);
  return conversion && conversion->operand->type.isBool() && e.type.isVector() ? &conversion->operand
                                                                               : nullptr;
}

}  // namespace

ExprPtr FunctionLowering::convert(ExprPtr e, ir::Scalar scalar) {
  if (!e->type.isArithmetic() || e->type.scalar == scalar) return e;
  if (auto* narrowed = std::get_if<ir::Convert>(&e->node); narrowed && e->type.isNarrow()) {
    // an enumerator as a specialisation constant needs no wrapping, which would hide that it is one
    const auto* spec = std::get_if<ir::VarRef>(&narrowed->operand->node);
    if (spec && narrowSpecs_.contains(spec->var)) return convert(std::move(narrowed->operand), scalar);
  }
  if (scalar == ir::Scalar::Bool) return toBool(std::move(e));
  const Loc loc = e->loc;
  if (ir::isReal(ir::arithmeticScalar(scalar)) && maskedBool(*e)) {
    module_.diagnostics().report(Diag::MaskConverted, loc,
                                 {module_.spelling(ir::Type::of(scalar, e->type.width))});
  }
  // a double becomes a half in one step, which rounds once
  const bool isNarrowed =
      e->type.is64Bit() && ir::isNarrow(scalar) && !(e->type.isDouble() && scalar == ir::Scalar::Half);
  if ((e->type.isNarrow() && ir::is64Bit(scalar)) || isNarrowed) {
    const ir::Scalar arithmetic = ir::arithmeticScalar(e->type.isNarrow() ? e->type.scalar : scalar);
    return convert(convert(std::move(e), arithmetic), scalar);
  }
  if (auto* construct = std::get_if<ir::Construct>(&e->node);
      construct && e->type.isVector() && construct->args.size() == 1 && construct->args[0]->type.isScalar()) {
    return splat(convert(std::move(construct->args[0]), scalar), e->type.width);  // `2.0` with a vector
  }
  if (std::holds_alternative<ir::Literal>(e->node)) {
    if (ExprPtr converted = convertLiteral(*e, scalar)) return converted;
    const ir::Scalar arithmetic = ir::arithmeticScalar(ir::isNarrow(scalar) ? scalar : e->type.scalar);
    if (e->type.scalar != arithmetic && scalar != arithmetic)
      return convert(convert(std::move(e), arithmetic), scalar);
  }
  return ir::convert(scalar, std::move(e), loc);
}

ExprPtr FunctionLowering::splat(ExprPtr e, int width) {
  if (e->type.width == width) return e;
  const Loc loc = e->loc;
  const ir::Type type = ir::Type::of(e->type.scalar, width);
  return ir::construct(type, ir::exprs(std::move(e)), loc);
}

ExprPtr FunctionLowering::mask(ExprPtr boolVector) {
  const Loc loc = boolVector->loc;
  return ir::unary(ir::UnaryOp::Negate, ir::convert(ir::Scalar::Int, std::move(boolVector), loc), loc);
}

ExprPtr FunctionLowering::toBool(ExprPtr e) {
  if (e->type.isBool()) return e;
  if (ExprPtr* inner = maskedBool(*e)) return std::move(*inner);
  const Loc loc = e->loc;
  if (!e->type.isArithmetic()) throw Abandoned{};
  return ir::convert(ir::Scalar::Bool, std::move(e), loc);
}

// ---- parts ----------------------------------------------------------------------------------------

ExprPtr FunctionLowering::VisitExtVectorElementExpr(const clang::ExtVectorElementExpr* e) {
  llvm::SmallVector<std::uint32_t, 4> indices;
  e->getEncodedElementAccess(indices);
  ExprPtr base = value(e->getBase());
  ir::Swizzle swizzle;
  for (const std::uint32_t index : indices) swizzle.components.push_back(static_cast<std::uint8_t>(index));
  if (swizzle.components.size() > 4) module_.fail(Diag::SwizzleTooLong, e->getAccessorLoc());
  const ir::Type type = ir::Type::of(base->type.scalar, static_cast<int>(swizzle.components.size()));
  swizzle.base = std::move(base);
  return make(type, e->getAccessorLoc(), std::move(swizzle));
}

ExprPtr FunctionLowering::VisitMemberExpr(const clang::MemberExpr* e) {
  const auto* field = llvm::dyn_cast<clang::FieldDecl>(e->getMemberDecl());
  if (!field) {
    if (const auto* variable = llvm::dyn_cast<clang::VarDecl>(e->getMemberDecl())) {
      return module_.constant(variable, e->getMemberLoc());
    }
    return VisitExpr(e);
  }
  if (const std::optional<ir::VarId> member = variableNamed(e))
    return read(*member, e->getType(), e->getMemberLoc());
  if (module_.bundles().placeOf(e)) module_.refuseBundle(e->getType(), e->getMemberLoc());
  if (e->isArrow() && !llvm::isa<clang::CXXThisExpr>(e->getBase()->IgnoreParenImpCasts())) {
    module_.fail(Diag::Pointer, e->getOperatorLoc(), {e->getBase()->getType().getAsString()});
  }
  ExprPtr base = value(e->getBase());
  const ir::Type type = module_.structAt(base->type.index).fields[field->getFieldIndex()].type;
  return make(type, e->getMemberLoc(), ir::Member{std::move(base), field->getFieldIndex()});
}

/// The copy of a whole array that `auto [p, q] = array;` makes.
ExprPtr FunctionLowering::VisitArrayInitLoopExpr(const clang::ArrayInitLoopExpr* e) {
  return value(e->getCommonExpr()->getSourceExpr());
}

ExprPtr FunctionLowering::VisitArraySubscriptExpr(const clang::ArraySubscriptExpr* e) {
  const clang::Expr* array = e->getBase();
  if (const auto* decay = llvm::dyn_cast<clang::ImplicitCastExpr>(array);
      decay && decay->getCastKind() == clang::CK_ArrayToPointerDecay) {
    array = decay->getSubExpr();
  }
  return indexed(array, e->getIdx(), e->getBeginLoc());
}

/// array[index] for an array, a vector or a matrix.
ExprPtr FunctionLowering::indexed(const clang::Expr* array, const clang::Expr* index, SourceLocation where) {
  Exprs parts;
  parts.push_back(value(array));
  ir::Block effects;
  parts.push_back(valueInto(index, effects));
  if (!effects.empty()) {
    // the element is accessed after the index's effects; the array itself is not copied
    keepLocation(parts[0], ir::assignedIn(module_.module(), effects));
    append(std::move(effects));
  }
  const ir::Type outer = parts[0]->type;
  if (outer.kind != ir::Type::Kind::Array && !outer.isVector() && !outer.isMatrix()) {
    module_.fail(Diag::Pointer, where, {array->getType().getAsString()});
  }
  const bool isArray = outer.kind == ir::Type::Kind::Array;
  const ir::Type type = isArray ? module_.arrayAt(outer.index).element : outer.indexed();
  const ir::Scalar arithmetic = ir::arithmeticScalar(parts[1]->type.scalar);
  parts[1] = arithmetic == ir::Scalar::Uint ? convert(std::move(parts[1]), arithmetic)
                                            : intIndex(std::move(parts[1]));
  return make(type, where, ir::Index{std::move(parts[0]), std::move(parts[1])});
}

// ---- initialisers ---------------------------------------------------------------------------------

ExprPtr FunctionLowering::VisitInitListExpr(const clang::InitListExpr* e) {
  const clang::InitListExpr* list = e->isSemanticForm() || !e->getSemanticForm() ? e : e->getSemanticForm();
  if (list->isTransparent()) return value(list->getInit(0));
  const ir::Type type = module_.type(list->getType(), list->getBeginLoc());
  if (type.isScalar()) {
    return list->getNumInits() == 0 ? zero(type, list->getBeginLoc()) : value(list->getInit(0));
  }
  return aggregate(type, list->inits(), list->getArrayFiller(), list->getBeginLoc());
}

ExprPtr FunctionLowering::VisitCXXParenListInitExpr(const clang::CXXParenListInitExpr* e) {
  std::vector<const clang::Expr*> inits(e->getInitExprs().begin(), e->getInitExprs().end());
  return aggregate(module_.type(e->getType(), e->getBeginLoc()), inits, e->getArrayFiller(),
                   e->getBeginLoc());
}

namespace {

/// True if the initialiser of a member names the object: `int b = a + 1;` of a struct with a member a.
bool namesThis(const clang::Stmt* e) {
  if (e == nullptr) return false;
  if (llvm::isa<clang::CXXThisExpr>(e)) return true;
  return std::ranges::any_of(e->children(), [](const clang::Stmt* part) { return namesThis(part); });
}

bool needsObject(const clang::Expr* init) {
  const auto* given = llvm::dyn_cast_or_null<clang::CXXDefaultInitExpr>(init);
  return given != nullptr && namesThis(given->getExpr());
}

}  // namespace

/// A struct, array or vector from its parts. The elements of an array without an initialiser of their own have the
/// filler's value; other parts without one are zero.
ExprPtr FunctionLowering::aggregate(ir::Type type, llvm::ArrayRef<const clang::Expr*> inits,
                                    const clang::Expr* filler, SourceLocation where) {
  if (type.kind == ir::Type::Kind::Struct && std::ranges::any_of(inits, needsObject))
    return structInSteps(type, inits, where);
  Exprs args = valuesInOrder(inits);
  if (type.isVector()) {
    int width = 0;
    for (ExprPtr& arg : args) {
      arg = convert(std::move(arg), type.scalar);
      width += arg->type.width;
    }
    for (; width < type.width; ++width) args.push_back(zero(type.component(), where));
  } else if (type.isMatrix()) {
    for (std::size_t i = args.size(); i < type.width; ++i) args.push_back(zero(type.indexed(), where));
  } else if (type.kind == ir::Type::Kind::Struct) {
    const std::vector<ir::StructField> fields = module_.structAt(type.index).fields;
    for (std::size_t i = args.size(); i < fields.size(); ++i) args.push_back(zero(fields[i].type, where));
  } else {
    const ir::Array array = module_.arrayAt(type.index);
    fill(args, array.length, [&] { return filler ? value(filler) : zero(array.element, where); });
  }
  return make(type, where, ir::Construct{std::move(args)});
}

/// Adds elements to those of an array. Each is evaluated for itself if that has effects.
void FunctionLowering::fill(Exprs& elements, std::size_t length, FunctionRef<ExprPtr()> element) {
  const std::size_t first = elements.size();
  while (elements.size() < length) {
    ir::Block effects;
    ir::Block* outer = std::exchange(out_, &effects);
    ExprPtr added = element();
    out_ = outer;
    if (effects.empty()) {
      while (elements.size() + 1 < length) elements.push_back(ir::clone(*added));
    } else {
      const Variables changed = ir::assignedIn(module_.module(), effects);
      for (std::size_t i = first; i < elements.size(); ++i) keepValue(elements[i], changed);
      append(std::move(effects));
    }
    elements.push_back(std::move(added));
  }
}

/// Initialises a struct member by member, because an initialiser reads members before it.
ExprPtr FunctionLowering::structInSteps(ir::Type type, llvm::ArrayRef<const clang::Expr*> inits,
                                        SourceLocation where) {
  const Loc loc = module_.loc(where);
  const ir::VarId object = temporary(type, loc);
  emit(loc, ir::Declare{object, nullptr});
  const std::vector<ir::StructField> fields = module_.structAt(type.index).fields;
  for (std::uint32_t i = 0; i < fields.size(); ++i) {
    const std::optional<ir::VarId> outer = std::exchange(initialized_, object);
    ExprPtr given = i < inits.size() && inits[i] != nullptr ? value(inits[i]) : zero(fields[i].type, where);
    initialized_ = outer;
    ExprPtr member = make(fields[i].type, where, ir::Member{ir::varRef(function_, object, loc), i});
    emit(loc, ir::Assign{std::move(member), std::nullopt, std::move(given)});
  }
  return ir::varRef(function_, object, loc);
}

ExprPtr FunctionLowering::zero(ir::Type type, SourceLocation where) {
  if (type.isScalar()) return literal(type, 0, where);
  if (type.isVector()) return splat(literal(type.component(), 0, where), type.width);
  return aggregate(type, {}, nullptr, where);
}

ExprPtr FunctionLowering::VisitImplicitValueInitExpr(const clang::ImplicitValueInitExpr* e) {
  return zero(module_.type(e->getType(), e->getBeginLoc()), e->getBeginLoc());
}

ExprPtr FunctionLowering::VisitCXXScalarValueInitExpr(const clang::CXXScalarValueInitExpr* e) {
  return zero(module_.type(e->getType(), e->getBeginLoc()), e->getBeginLoc());
}

ExprPtr FunctionLowering::VisitCXXConstructExpr(const clang::CXXConstructExpr* e) {
  const clang::CXXConstructorDecl* constructor = e->getConstructor();
  if (constructor->isCopyOrMoveConstructor() && e->getNumArgs() == 1) return value(e->getArg(0));
  if (module_.isPrelude(constructor)) {
    const std::vector<const clang::Expr*> args(e->getArgs(), e->getArgs() + e->getNumArgs());
    return classValue(module_.type(e->getType(), e->getBeginLoc()), args, e->getBeginLoc());
  }
  if (constructor->isDefaultConstructor() && !constructor->isUserProvided()) {
    const SourceLocation where = e->getBeginLoc();
    const ir::Type type = module_.type(e->getType(), where);
    if (type.kind != ir::Type::Kind::Array) return defaultStruct(constructor, where);
    Exprs elements;
    fill(elements, module_.arrayAt(type.index).length, [&] { return defaultStruct(constructor, where); });
    return make(type, where, ir::Construct{std::move(elements)});
  }
  module_.fail(Diag::Constructor, e->getBeginLoc(), {constructor->getParent()->getNameAsString()});
}

/// A class of the prelude from its constructor's arguments: unorm8(x), the rows or elements of a matrix, the
/// elements of a row, or none.
ExprPtr FunctionLowering::classValue(ir::Type type, llvm::ArrayRef<const clang::Expr*> args,
                                     SourceLocation where) {
  if (args.empty()) return zero(type, where);
  if (type.isMatrix()) return matrix(type, valuesInOrder(args), where);
  if (args.size() > 1) return make(type, where, ir::Construct{valuesInOrder(args)});
  return convert(value(args[0]), type.scalar);
}

/// A matrix from its rows, from all elements row by row, or from one number for the diagonal.
ExprPtr FunctionLowering::matrix(ir::Type type, Exprs parts, SourceLocation where) {
  const std::size_t size = type.width;
  const bool areScalars =
      std::all_of(parts.begin(), parts.end(), [](const ExprPtr& part) { return part->type.isScalar(); });
  const bool areRows = std::all_of(parts.begin(), parts.end(), [&](const ExprPtr& part) {
    return part->type.isVector() && part->type.width == size;
  });
  if (parts.size() == 1 && parts[0]->type == type) return std::move(parts[0]);
  for (ExprPtr& part : parts) part = convert(std::move(part), ir::Scalar::Float);
  if (areRows && parts.size() == size) return make(type, where, ir::Construct{std::move(parts)});
  const bool isDiagonal = areScalars && parts.size() == 1;
  if (!isDiagonal && !(areScalars && parts.size() == size * size)) {
    module_.fail(Diag::MatrixParts, where,
                 {module_.spelling(type), std::to_string(size), std::to_string(size * size)});
  }
  if (isDiagonal) spill(parts[0]);
  Exprs rows;
  for (std::size_t row = 0; row < size; ++row) {
    Exprs elements;
    for (std::size_t column = 0; column < size; ++column) {
      if (!isDiagonal) {
        elements.push_back(std::move(parts[row * size + column]));
      } else {
        elements.push_back(row == column ? ir::clone(*parts[0]) : zero(type.component(), where));
      }
    }
    rows.push_back(make(type.indexed(), where, ir::Construct{std::move(elements)}));
  }
  return make(type, where, ir::Construct{std::move(rows)});
}

/// `Hit h;` if Hit's members have initialisers, and `Hit()`: the other members are zero.
ExprPtr FunctionLowering::defaultStruct(const clang::CXXConstructorDecl* constructor, SourceLocation where) {
  const clang::CXXRecordDecl* record = constructor->getParent();
  const ir::Type type = module_.type(module_.context().getRecordType(record), where);
  std::vector<const clang::Expr*> inits(module_.structAt(type.index).fields.size(), nullptr);
  for (const clang::CXXCtorInitializer* init : constructor->inits()) {
    if (init->isMemberInitializer()) inits[init->getMember()->getFieldIndex()] = init->getInit();
  }
  if (std::ranges::any_of(inits, needsObject)) return structInSteps(type, inits, where);
  Exprs args;
  for (std::size_t i = 0; i < inits.size(); ++i) {
    ir::Block effects;
    const ir::Type member = module_.structAt(type.index).fields[i].type;
    ExprPtr given = inits[i] != nullptr ? valueInto(inits[i], effects) : zero(member, where);
    const Variables changed = ir::assignedIn(module_.module(), effects);
    for (ExprPtr& earlier : args) keepValue(earlier, changed);
    append(std::move(effects));
    args.push_back(std::move(given));
  }
  return make(type, where, ir::Construct{std::move(args)});
}

// ---- everything else ------------------------------------------------------------------------------

ExprPtr FunctionLowering::VisitExpr(const clang::Expr* e) {
  const SourceLocation where = e->getBeginLoc();
  switch (e->getStmtClass()) {
    case clang::Stmt::LambdaExprClass: module_.fail(Diag::Lambda, where);
    case clang::Stmt::CXXNewExprClass:
    case clang::Stmt::CXXDeleteExprClass: module_.fail(Diag::DynamicAllocation, where);
    case clang::Stmt::StringLiteralClass: module_.fail(Diag::Expression, where, {"a string"});
    case clang::Stmt::BinaryConditionalOperatorClass:
      module_.fail(Diag::Expression, where, {"'?:' without a value between the signs"});
    case clang::Stmt::StmtExprClass: module_.fail(Diag::Expression, where, {"statements in parentheses"});
    default: break;
  }
  if (e->getType()->isIntegralOrEnumerationType()) {
    if (ExprPtr constant = integerConstant(e, module_.type(e->getType(), where))) return constant;
  }
  module_.fail(Diag::Expression, where, {fmt::format("'{}'", module_.textOf(e))});
}

ExprPtr FunctionLowering::VisitStmt(const clang::Stmt* s) {
  module_.fail(Diag::Statement, s->getBeginLoc(), {"this kind of statement"});
}

}  // namespace skc::frontend
