// SPDX-License-Identifier: MIT
//
// Lowers calls of intrinsics (selected from the table by argument types) and of gathers. Those of the user's
// functions are in lower_user_call.cpp.
#include <algorithm>
#include <cassert>
#include <utility>
#include <variant>
#include <vector>

#include <clang/AST/DeclCXX.h>
#include <clang/AST/ExprCXX.h>

#include "frontend/lower/function_lowering.hpp"
#include "frontend/lower/locations.hpp"
#include "frontend/prelude.hpp"
#include "ir/build.hpp"
#include "ir/evaluate.hpp"
#include "ir/lvalue.hpp"

namespace skc::frontend {

using clang::SourceLocation;
using ir::ExprPtr;
using ir::Scalar;

ExprPtr FunctionLowering::VisitCallExpr(const clang::CallExpr* e) {
  const clang::FunctionDecl* callee = e->getDirectCallee();
  if (!callee) module_.fail(Diag::Pointer, e->getBeginLoc(), {e->getCallee()->getType().getAsString()});
  if (const auto* conversion = llvm::dyn_cast<clang::CXXMemberCallExpr>(e);
      conversion && llvm::isa<clang::CXXConversionDecl>(callee) && module_.isPrelude(callee)) {
    ExprPtr object = value(conversion->getImplicitObjectArgument());
    return convert(std::move(object), module_.type(e->getType(), e->getBeginLoc()).scalar);
  }
  return module_.isPrelude(callee) ? intrinsicCall(e, callee) : userCall(e, callee);
}

/// a[i] of a gather, or a struct's operator: assignment copies, others are functions of the user.
ExprPtr FunctionLowering::VisitCXXOperatorCallExpr(const clang::CXXOperatorCallExpr* e) {
  const clang::FunctionDecl* callee = e->getDirectCallee();
  if (!callee) return VisitExpr(e);
  const bool isCopy = e->getOperator() == clang::OO_Equal && callee->isTrivial();
  if (module_.isPrelude(callee) && !isCopy) return classOperator(e);
  if (isCopy) {
    return store(sidesOf(e->getArg(0), value(e->getArg(1))), std::nullopt, module_.loc(e->getBeginLoc()),
                 /*wantValue=*/true);
  }
  return userCall(e, callee);
}

/// An operator that the prelude declares: for gathers, matrices, and assignments to normalized values.
ExprPtr FunctionLowering::classOperator(const clang::CXXOperatorCallExpr* e) {
  const SourceLocation where = e->getOperatorLoc();
  const auto infix = [&](ir::BinaryOp op) {
    Exprs operands = valuesInOrder({e->getArg(0), e->getArg(1)});
    return ir::binary(op, std::move(operands[0]), std::move(operands[1]), module_.loc(where));
  };
  switch (e->getOperator()) {
    case clang::OO_Subscript: {
      ir::Type element;
      if (module_.gatherRank(e->getArg(0)->getType(), where, element) != 0) return gatherRead(e);
      return indexed(e->getArg(0), e->getArg(1), e->getBeginLoc());
    }
    case clang::OO_Minus: {
      if (e->getNumArgs() == 2) return infix(ir::BinaryOp::Sub);
      return ir::unary(ir::UnaryOp::Negate, value(e->getArg(0)), module_.loc(where));
    }
    case clang::OO_Plus: return infix(ir::BinaryOp::Add);
    case clang::OO_Star: return infix(ir::BinaryOp::Mul);
    case clang::OO_Slash: return infix(ir::BinaryOp::Div);
    case clang::OO_EqualEqual: return infix(ir::BinaryOp::Equal);
    case clang::OO_PlusEqual: return classAssignment(ir::BinaryOp::Add, e);
    case clang::OO_MinusEqual: return classAssignment(ir::BinaryOp::Sub, e);
    case clang::OO_StarEqual: return classAssignment(ir::BinaryOp::Mul, e);
    case clang::OO_SlashEqual: return classAssignment(ir::BinaryOp::Div, e);
    default: return VisitExpr(e);   // the prelude declares no others
  }
}

/// `u += x` for a normalized value, `m *= n` for a matrix: the operation, then an assignment.
ExprPtr FunctionLowering::classAssignment(ir::BinaryOp op, const clang::CXXOperatorCallExpr* e) {
  const Loc loc = module_.loc(e->getBeginLoc());
  auto [target, right] = sidesOf(e->getArg(0), value(e->getArg(1)));
  const ir::Type type = target->type;
  ExprPtr left = convert(ir::clone(*target), ir::arithmeticScalar(type.scalar));
  ExprPtr result = ir::binary(op, std::move(left), std::move(right), loc);
  emit(loc, ir::Assign{std::move(target), std::nullopt, convert(std::move(result), type.scalar)});
  return ir::literal(false, loc);   // never used: the call is void
}

// ---- intrinsics -----------------------------------------------------------------------------------

ExprPtr FunctionLowering::intrinsicCall(const clang::CallExpr* e, const clang::FunctionDecl* callee) {
  const llvm::StringRef name = callee->getName();
  if (name.starts_with("__sk_make_"))
    return vectorConstructor(e, module_.type(e->getType(), e->getBeginLoc()));
  if (name == "indexof") return indexOrExtent(e, true);
  if (name == "extentof") return indexOrExtent(e, false);
  if (name == "axis") return axis(e);
  if (name == "neighbor") return neighbor(e);
  if (name == "sample") return sample(e);
  if (name == "push") return push(e);
  if (name == "assert") return assertion(e);
  if (name == "printf") return print(e);
  if (name == "sincos" || name == "modf" || name == "frexp") return outParameterIntrinsic(e, name);
  if (name == "select") {
    const ir::Type type = module_.type(e->getType(), e->getBeginLoc());
    Exprs args =
        valuesInOrder({e->getArg(0), e->getArg(1), e->getArg(2)}, type.isDouble() ? allArguments : 0);
    ExprPtr cond = toBool(std::move(args[0]));
    for (std::size_t i = 1; i < 3; ++i) {
      const ir::Type given = args[i]->type;
      if (given.isVector() && given.width != type.width) {
        module_.fail(Diag::NoIntrinsic, e->getBeginLoc(),
                     {"select", module_.spelling(args[1]->type) + ", " + module_.spelling(args[2]->type)});
      }
      if (type.isArithmetic()) args[i] = splat(convert(std::move(args[i]), type.scalar), type.width);
    }
    if (cond->type.isVector() && (!type.isVector() || cond->type.width != type.width)) {
      module_.fail(Diag::NoIntrinsic, e->getBeginLoc(),
                   {"select", module_.spelling(cond->type) + ", " + module_.spelling(type)});
    }
    return select(std::move(cond), std::move(args[1]), std::move(args[2]), e->getBeginLoc());
  }
  return tableIntrinsic(e, name);
}

/// float4(v.xy, 0, 1): components that add up to the width, or one scalar for all.
ExprPtr FunctionLowering::vectorConstructor(const clang::CallExpr* e, ir::Type type) {
  const SourceLocation where = e->getBeginLoc();
  Exprs args = valuesInOrder(std::vector<const clang::Expr*>(e->arg_begin(), e->arg_end()),
                             type.isDouble() ? allArguments : 0);
  if (type.isMatrix()) return matrix(type, std::move(args), where);
  int width = 0;
  for (std::size_t i = 0; i < args.size(); ++i) {
    if (!args[i]->type.isArithmetic()) {
      module_.fail(Diag::VectorComponent, e->getArg(static_cast<unsigned>(i))->getBeginLoc(),
                   {module_.spelling(type), module_.spelling(args[i]->type)});
    }
    width += args[i]->type.width;
    args[i] = convert(std::move(args[i]), type.scalar);
  }
  if (args.size() == 1 && args[0]->type == type) return std::move(args[0]);
  const bool isSplat = args.size() == 1 && width == 1;
  if (width != type.width && !isSplat) {
    module_.fail(Diag::VectorWidth, where,
                 {module_.spelling(type), std::to_string(type.width), std::to_string(width)});
  }
  return make(type, where, ir::Construct{std::move(args)});
}

namespace {

constexpr int impossible = 1000;

/// The cost of converting an argument; as in C++, a conversion may lose no more than a rounding error.
int conversionCost(ir::Type from, ir::Type to) {
  from = from.arithmeticType();
  if (from == to) return 0;
  if (!from.isArithmetic() || !to.isArithmetic()) return impossible;
  int cost = 0;
  if (from.width != to.width) {
    if (from.width != 1) return impossible;
    cost += 20;
  }
  if (from.scalar == to.scalar) return cost;
  if (from.scalar == Scalar::Double) return impossible;
  if (to.scalar == Scalar::Double) return cost + (from.scalar == Scalar::Bool ? 3 : 1);
  if (to.scalar == Scalar::Float) return cost + (from.scalar == Scalar::Bool ? 3 : 1);
  if (to.scalar == Scalar::Bool)
    return (from.scalar == Scalar::Int || from.isLong()) && from.isVector() ? cost
                                                                            : impossible;  // mask to bools
  if (from.scalar == Scalar::Float) return impossible;
  if (to.isLong()) return cost + (from.scalar == Scalar::Bool || from.isLong() ? 1 : 2);
  if (from.isLong()) return impossible;
  if (to.scalar == Scalar::Uint) return cost + 2;
  return cost + (from.scalar == Scalar::Bool ? 1 : 3);
}

struct Match {
  ir::Intrinsic intrinsic;
  ir::IntrinsicOverload overload;
};

/// The cheapest overload with the result type that Clang's prelude declares.
std::optional<Match> bestMatch(llvm::StringRef name, ir::Type result, const std::vector<ExprPtr>& args) {
  std::optional<Match> best;
  int bestCost = impossible;
  for (const ir::IntrinsicRow& row : ir::intrinsicRows()) {
    if (row.spelling != std::string_view(name)) continue;
    for (ir::IntrinsicOverload& overload : ir::overloads(row.id)) {
      if (overload.result != result || overload.arguments.size() != args.size()) continue;
      int cost = 0;
      for (std::size_t i = 0; i < args.size() && cost < impossible; ++i) {
        cost += conversionCost(args[i]->type, overload.arguments[i]);
      }
      if (cost < bestCost) {
        bestCost = cost;
        best = Match{row.id, std::move(overload)};
      }
    }
  }
  return best;
}

}  // namespace

namespace {

bool isOfDoubles(const clang::Expr* e) {
  const clang::QualType type = e->getType().getCanonicalType();
  const auto* vector = type->getAs<clang::ExtVectorType>();
  return (vector ? vector->getElementType() : type)->isSpecificBuiltinType(clang::BuiltinType::Double);
}

/// True if a version of the intrinsic takes floats.
bool takesFloats(llvm::StringRef name) {
  return llvm::any_of(ir::intrinsicRows(), [&](const ir::IntrinsicRow& row) {
    if (row.spelling != std::string_view(name)) return false;
    const std::vector<ir::IntrinsicOverload> overloads = ir::overloads(row.id);
    return llvm::any_of(overloads,
                        [](const ir::IntrinsicOverload& one) { return one.arguments[0].isFloat(); });
  });
}

}  // namespace

ExprPtr FunctionLowering::tableIntrinsic(const clang::CallExpr* e, llvm::StringRef name) {
  const bool areDoubles = std::any_of(e->arg_begin(), e->arg_end(), isOfDoubles);
  const unsigned doubles = name == "ldexp" ? 1U : allArguments;  // its exponent is an integer
  Exprs args =
      valuesInOrder(std::vector<const clang::Expr*>(e->arg_begin(), e->arg_end()), areDoubles ? doubles : 0);
  if ((name == "mod" || name == "fmod") && llvm::all_of(args, [](const ExprPtr& arg) {
        return arg->type.arithmeticType().isInteger() || arg->type.isLong();
      })) {
    module_.fail(Diag::IntegerRemainder, e->getBeginLoc(), {std::string_view(name)});
  }
  std::optional<Match> match = bestMatch(name, module_.type(e->getType(), e->getBeginLoc()), args);
  if (!match) {
    std::string types;
    for (const ExprPtr& arg : args) types += (types.empty() ? "" : ", ") + module_.spelling(arg->type);
    module_.fail(areDoubles && takesFloats(name) ? Diag::DoubleIntrinsic : Diag::NoIntrinsic,
                 e->getBeginLoc(), {std::string_view(name), types});
  }
  for (std::size_t i = 0; i < args.size(); ++i) {
    const ir::Type wanted = match->overload.arguments[i];
    args[i] = splat(convert(std::move(args[i]), wanted.scalar), wanted.width);
  }
  return intrinsic(match->intrinsic, match->overload.result, e->getBeginLoc(), std::move(args));
}

ExprPtr FunctionLowering::intrinsic(ir::Intrinsic which, ir::Type result, SourceLocation where, Exprs args) {
  return make(result, where, ir::IntrinsicCall{which, std::move(args)});
}

/// Lowers sincos(x, s, c), modf(x, whole) and frexp(x, e) to assignments of values without effects, after all
/// arguments have been evaluated.
ExprPtr FunctionLowering::outParameterIntrinsic(const clang::CallExpr* e, llvm::StringRef name) {
  const SourceLocation where = e->getBeginLoc();
  const Loc loc = module_.loc(where);
  ExprPtr x = value(e->getArg(0));
  if (!x->type.isFloat() && !x->type.isDouble())
    module_.fail(Diag::NoIntrinsic, where, {std::string_view(name), module_.spelling(x->type)});
  // the argument is read twice, and an out argument may be the same variable
  const ir::VarId kept = temporary(x->type, loc);
  const ir::Type type = x->type;
  emit(loc, ir::Declare{kept, std::move(x)});
  Exprs targets;
  Variables written;
  for (unsigned i = 1; i < e->getNumArgs(); ++i) {
    ir::Block effects;
    ir::Block* outer = std::exchange(out_, &effects);
    targets.push_back(place(e->getArg(i)));
    out_ = outer;
    const Variables changed = ir::assignedIn(module_.module(), effects);
    for (std::size_t k = 0; k + 1 < targets.size(); ++k) keepLocation(targets[k], changed);
    append(std::move(effects));
  }
  for (const ExprPtr& target : targets) std::ranges::copy(rootsOf(*target), std::back_inserter(written));
  std::ranges::sort(written);
  for (ExprPtr& target : targets) keepLocation(target, written);
  const auto apply = [&](ir::Intrinsic which, ir::Type result) {
    return intrinsic(which, result, where, ir::exprs(ir::varRef(function_, kept, loc)));
  };
  const auto store = [&](unsigned target, ExprPtr stored) {
    assign({std::move(targets[target]), std::move(stored)}, std::nullopt, loc);
  };
  if (name == "sincos") {
    store(0, apply(ir::Intrinsic::Sin, type));
    store(1, apply(ir::Intrinsic::Cos, type));
    return ir::literal(false, loc);
  }
  if (name == "modf") {
    store(0, apply(ir::Intrinsic::Trunc, type));
    return apply(ir::Intrinsic::ModfFraction, type);
  }
  store(0, apply(ir::Intrinsic::FrexpExponent, type.withScalar(Scalar::Int)));
  return apply(ir::Intrinsic::FrexpMantissa, type);
}

// ---- streams --------------------------------------------------------------------------------------

/// The variable that `e` names, which may be a member of a bundle; nullopt for any other expression.
std::optional<ir::VarId> FunctionLowering::variableNamed(const clang::Expr* e) const {
  e = withoutCopies(e);
  if (const auto* reference = llvm::dyn_cast<clang::DeclRefExpr>(e)) {
    const auto found = variables_.find(reference->getDecl());
    return found == variables_.end() ? std::nullopt : std::optional(found->second);
  }
  const std::optional<Bundles::Place> place = module_.bundles().placeOf(e);
  const auto found = place ? members_.find(*place) : members_.end();
  return found == members_.end() ? std::nullopt : std::optional(found->second);
}

/// The value of a variable, whose type in C++ is `type`.
ExprPtr FunctionLowering::read(ir::VarId id, clang::QualType type, SourceLocation where) {
  const ir::Variable& variable = function_.variables[id];
  if (variable.role == ir::VarRole::Gather) module_.fail(Diag::GatherAsValue, where);
  if (variable.role == ir::VarRole::AppendOutput) module_.fail(Diag::AppendRead, where, {variable.name});
  if (const auto part = aliases_.find(id); part != aliases_.end()) return ir::clone(part->second);
  ExprPtr read = make(variable.type, where, ir::VarRef{id});
  if (!narrowSpecs_.contains(id)) return read;
  return ir::convert(module_.type(type, where).scalar, std::move(read), module_.loc(where));
}

/// The Gather, Element or output variable that `e` names; nullopt for any other expression.
std::optional<ir::VarId> FunctionLowering::streamVariable(const clang::Expr* e) const {
  const std::optional<ir::VarId> named = variableNamed(e);
  if (!named) return std::nullopt;
  const ir::VarRole role = function_.variables[*named].role;
  const bool isStream =
      role == ir::VarRole::Gather || role == ir::VarRole::Element || role == ir::VarRole::AppendOutput;
  return isStream ? named : std::nullopt;
}

ir::VarId FunctionLowering::gatherVariable(const clang::Expr* e) {
  const auto stream = streamVariable(e);
  if (!stream || function_.variables[*stream].role != ir::VarRole::Gather) {
    abandonIfUnknown(withoutCopies(e));
    module_.fail(Diag::NotAGather, e->getBeginLoc());
  }
  return *stream;
}

/// A parameter of the same kernel that has a current element, or what to declare, for a message.
std::string FunctionLowering::elementBeside(const clang::ValueDecl* parameter) {
  const auto* kernel = llvm::dyn_cast<clang::FunctionDecl>(parameter->getDeclContext());
  if (kernel != nullptr) {
    for (const clang::ParmVarDecl* other : kernel->parameters()) {
      const ParamSyntax* syntax = module_.syntax().param(other->getLocation());
      const bool isElement = syntax != nullptr &&
                             (syntax->role == ir::ParamRole::Output || syntax->role == ir::ParamRole::Input ||
                              syntax->role == ir::ParamRole::Iterator);
      if (isElement) return "'" + other->getName().str() + "'";
    }
  }
  return "the domain, 'indexof()'";
}

/// indexof(p) and extentof(p) of a stream parameter, and those of the domain, indexof() and extentof().
ExprPtr FunctionLowering::indexOrExtent(const clang::CallExpr* e, bool isIndex) {
  const SourceLocation where = e->getBeginLoc();
  const ir::StreamRef stream = e->getNumArgs() == 0 ? ir::StreamRef{ir::StreamRef::Space::Domain, 0}
                                                    : streamOfIndexOrExtent(e, isIndex);
  const ir::Type type = ir::Type::of(Scalar::Int, 4);
  ExprPtr all = isIndex ? make(type, where, ir::IndexOf{stream}) : make(type, where, ir::ExtentOf{stream});
  const int rank = module_.type(e->getType(), where).width;  // of indexof<2>(r), 2
  if (rank == type.width) return all;
  return ir::swizzle(std::move(all), std::string_view("xyzw").substr(0, static_cast<std::size_t>(rank)),
                     module_.loc(where));
}

/// The argument of indexof or extentof; an output, an iterator or an accumulator stands for the domain.
ir::StreamRef FunctionLowering::streamOfIndexOrExtent(const clang::CallExpr* e, bool isIndex) {
  const clang::Expr* argument = withoutCopies(e->getArg(0));
  const SourceLocation where = argument->getBeginLoc();
  const std::string_view name = isIndex ? "indexof" : "extentof";
  const auto* reference = llvm::dyn_cast<clang::DeclRefExpr>(argument);
  const std::optional<Bundles::Place> place = module_.bundles().placeOf(argument);
  const clang::ValueDecl* declared = nullptr;
  if (reference != nullptr) declared = reference->getDecl();
  if (place && !place->path.empty()) declared = place->path.back();
  const ir::ParamRole role = declared ? module_.roleOf(declared) : ir::ParamRole::Uniform;
  if (role == ir::ParamRole::Uniform || role == ir::ParamRole::Spec)
    module_.fail(Diag::NotAStream, where, {name});
  const std::optional<ir::VarId> found = variableNamed(argument);
  if (!found) throw Abandoned{};
  std::string parameter = function_.variables[*found].name;
  if (place && !place->path.empty()) parameter = module_.textOf(argument);
  if (isIndex && role == ir::ParamRole::Gather)
    module_.fail(Diag::IndexOfGather, where, {parameter, elementBeside(declared)});
  const bool isAppendOutput = function_.variables[*found].role == ir::VarRole::AppendOutput;
  if (isIndex && isAppendOutput)
    module_.fail(Diag::IndexOfAppendOutput, where, {parameter, elementBeside(declared)});
  if (role == ir::ParamRole::VariableOutput) module_.fail(Diag::ExtentOfAppendOutput, where, {parameter});
  const bool isDomain =
      role == ir::ParamRole::Output || role == ir::ParamRole::Iterator || role == ir::ParamRole::Accumulator;
  if (isDomain) return {ir::StreamRef::Space::Domain, 0};
  return {ir::StreamRef::Space::Variable, *found};
}

/// axis<3>(d): the offset of the next element in a dimension, x first.
ExprPtr FunctionLowering::axis(const clang::CallExpr* e) {
  const SourceLocation where = e->getBeginLoc();
  const Loc loc = module_.loc(where);
  const int rank = module_.type(e->getType(), where).width;
  ExprPtr dimension = value(e->getArg(0));
  const bool isSimple = std::holds_alternative<ir::Literal>(dimension->node) ||
                        std::holds_alternative<ir::VarRef>(dimension->node);
  if (rank > 1 && !isSimple) spill(dimension);
  Exprs components;
  for (int d = 0; d < rank; ++d) {
    ExprPtr chosen =
        ir::binary(ir::BinaryOp::Equal, ir::clone(*dimension), ir::literal(std::int32_t{d}, loc), loc);
    components.push_back(ir::convert(Scalar::Int, std::move(chosen), loc));
  }
  if (rank == 1) return std::move(components[0]);
  return ir::construct(ir::Type::of(Scalar::Int, rank), std::move(components), loc);
}

namespace {

/// Writes an offset whose components are known with literals, by which later phases tell near elements: -axis<2>(1) is (0, -1).
void foldOffset(const ir::Module& module, ExprPtr& offset) {
  if (!offset->type.isVector() || std::holds_alternative<ir::Construct>(offset->node)) return;
  std::vector<ExprPtr> components;
  for (std::uint8_t i = 0; i < offset->type.width; ++i) {
    const auto bits = ir::evaluate(module, *ir::componentOf(*offset, i), ir::Constants::LookThrough);
    if (!bits) return;
    components.push_back(ir::literal(static_cast<std::int32_t>(*bits), offset->loc));
  }
  offset = ir::construct(offset->type, std::move(components), offset->loc);
}

}  // namespace

namespace {

/// The operand of a conversion from an integer of 64 bits, which would cut its upper word off.
const clang::Expr* withoutLoss(const clang::Expr* e) {
  const auto* cast = llvm::dyn_cast<clang::ImplicitCastExpr>(e);
  if (cast == nullptr || cast->getCastKind() != clang::CK_IntegralCast) return e;
  const auto* from = cast->getSubExpr()->getType()->getAs<clang::BuiltinType>();
  if (from == nullptr) return e;
  const auto kind = from->getKind();
  const bool isLong = kind == clang::BuiltinType::Long || kind == clang::BuiltinType::LongLong ||
                      kind == clang::BuiltinType::ULong || kind == clang::BuiltinType::ULongLong;
  return isLong ? cast->getSubExpr() : e;
}

}  // namespace

/// neighbor(a, dx), neighbor(a, dx, dy) ..., neighbor(a, int2) ...
ExprPtr FunctionLowering::neighbor(const clang::CallExpr* e) {
  const SourceLocation where = e->getBeginLoc();
  const ir::VarId stream = gatherVariable(e->getArg(0));
  const ir::Variable gather = function_.variables[stream];
  constexpr std::int64_t farthest = 1 << 30;  // its sum with an index is an int
  std::vector<const clang::Expr*> given(e->arg_begin() + 1, e->arg_end());
  std::ranges::transform(given, given.begin(), withoutLoss);
  Exprs offsets = valuesInOrder(given);
  for (ExprPtr& offset : offsets) {
    if (offset->type.isLong()) offset = intIndex(std::move(offset), -farthest, farthest);
  }
  ExprPtr offset;
  if (offsets.size() == 1) {
    offset = std::move(offsets[0]);
    foldOffset(module_.module(), offset);
  } else {
    offset = make(ir::Type::of(Scalar::Int, gather.rank), where, ir::Construct{std::move(offsets)});
  }
  return make(gather.type, where,
              ir::NeighborRead{{ir::StreamRef::Space::Variable, stream}, std::move(offset)});
}

/// sample(a, position), of any gather with a floating-point arithmetic type.
ExprPtr FunctionLowering::sample(const clang::CallExpr* e) {
  const SourceLocation where = e->getBeginLoc();
  const ir::VarId stream = gatherVariable(e->getArg(0));
  const ir::Variable gather = function_.variables[stream];
  const ir::Type type = gather.type.arithmeticType();
  if (!type.isFloat()) module_.fail(Diag::SampleType, where, {gather.name, module_.spelling(gather.type)});
  return make(type, where, ir::Sample{{ir::StreamRef::Space::Variable, stream}, value(e->getArg(1))});
}

/// a[i], a[i][j], a[int2], a[float2]
ExprPtr FunctionLowering::gatherRead(const clang::CXXOperatorCallExpr* e) {
  const Subscripts subscripts = subscriptsOf(e);
  if (const auto stream = streamVariable(subscripts.object);
      stream && function_.variables[*stream].role == ir::VarRole::AppendOutput) {
    module_.fail(Diag::AppendRead, e->getBeginLoc(), {function_.variables[*stream].name});
  }
  const ir::VarId stream = gatherVariable(subscripts.object);
  const ir::Type type = function_.variables[stream].type;
  return make(type, e->getBeginLoc(),
              ir::GatherRead{{ir::StreamRef::Space::Variable, stream}, indexFrom(subscripts, stream)});
}

FunctionLowering::Subscripts FunctionLowering::subscriptsOf(const clang::CXXOperatorCallExpr* e) {
  Subscripts result{nullptr, {e->getArg(1)}, e->getBeginLoc()};
  const clang::Expr* object = e->getArg(0)->IgnoreParenImpCasts();
  if (const auto* temporary = llvm::dyn_cast<clang::MaterializeTemporaryExpr>(object)) {
    object = temporary->getSubExpr()->IgnoreParenImpCasts();
  }
  while (const auto* outer = llvm::dyn_cast<clang::CXXOperatorCallExpr>(object)) {
    result.written.insert(result.written.begin(), outer->getArg(1));
    object = outer->getArg(0)->IgnoreParenImpCasts();
  }
  result.object = object;
  return result;
}

/// An index as an int. One of 64 bits becomes the nearest number from `least` to `most`.
ExprPtr FunctionLowering::intIndex(ExprPtr index, std::int64_t least, std::int64_t most) {
  if (!index->type.isLong()) return convert(std::move(index), Scalar::Int);
  const Loc loc = index->loc;
  const bool isSigned = index->type.scalar == Scalar::Long;
  if (const auto* known = std::get_if<ir::Literal>(&index->node)) {
    const std::uint64_t bits = known->wide();
    const auto number =
        static_cast<std::int64_t>(isSigned ? bits : std::min(bits, static_cast<std::uint64_t>(most)));
    return ir::literal(static_cast<std::int32_t>(std::clamp(number, least, most)), loc);
  }
  ExprPtr last = convert(ir::literal(most, loc), index->type.scalar);
  if (isSigned)
    index = ir::intrinsic(ir::Intrinsic::Max, ir::exprs(std::move(index), ir::literal(least, loc)), loc);
  index = ir::intrinsic(ir::Intrinsic::Min, ir::exprs(std::move(index), std::move(last)), loc);
  return convert(std::move(index), Scalar::Int);
}

/// An int index with x, the fastest dimension, first. A float index selects the nearest element.
ExprPtr FunctionLowering::indexFrom(const Subscripts& subscripts, ir::VarId stream) {
  const ir::Variable variable = function_.variables[stream];
  for (const clang::Expr* index : subscripts.written) {
    const auto* comma = llvm::dyn_cast<clang::BinaryOperator>(index->IgnoreParenImpCasts());
    if (comma && comma->getOpcode() == clang::BO_Comma)
      module_.fail(Diag::CommaIndex, comma->getOperatorLoc(), {variable.name});
  }
  Exprs values = valuesInOrder(subscripts.written);
  for (ExprPtr& index : values) {
    const Loc loc = index->loc;
    if (index->type.isFloat()) {
      const ir::Type type = index->type.withScalar(Scalar::Int);
      index = ir::makeExpr(type, ir::IntrinsicCall{ir::Intrinsic::Nearest, ir::exprs(std::move(index))}, loc);
    }
    index = intIndex(std::move(index));
  }
  ExprPtr index;
  if (values.size() == 1) {
    index = std::move(values[0]);
  } else {
    std::reverse(values.begin(), values.end());
    index =
        make(ir::Type::of(Scalar::Int, variable.rank), subscripts.where, ir::Construct{std::move(values)});
  }
  assert(index->type.width == variable.rank);  // the prelude declares no others
  return index;
}

}  // namespace skc::frontend
