// SPDX-License-Identifier: MIT
#include "frontend/advice.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include <clang/AST/DeclCXX.h>
#include <clang/Basic/DiagnosticSema.h>
#include <clang/Basic/SourceManager.h>
#include <clang/Lex/Lexer.h>
#include <fmt/format.h>

#include "frontend/diagnostic_parts.hpp"
#include "frontend/prelude.hpp"
#include "ir/intrinsics.hpp"
#include "support/diagnostics.hpp"

namespace skc::frontend {
namespace {

/// The class of variable outputs, in the prelude.
constexpr llvm::StringRef variableOutputClass = "variable_output";

// ---- indices of any rank ----------------------------------------------------------------------------

/// The position behind `word<...>` at the start of a text; 0 if it does not start like this.
std::size_t behindList(llvm::StringRef text, llvm::StringRef word) {
  if (!text.starts_with(word) || !text.drop_front(word.size()).starts_with("<")) return 0;
  const std::size_t close = text.find('>');
  return close == llvm::StringRef::npos ? 0 : close + 1;
}

/// True for `indexof<N>(v)` and its like.
bool makesIndex(llvm::StringRef text) {
  return std::ranges::any_of(std::array{"indexof", "extentof", "axis", "index"},
                             [&](llvm::StringRef word) { return behindList(text, word) != 0; });
}

/// True if the last function in a text declares the name as `index<N> p`, or by `auto p = indexof<N>(v)`.
bool declaresIndex(llvm::StringRef text, llvm::StringRef name) {
  if (const std::size_t end = text.rfind("\n}"); end != llvm::StringRef::npos) text = text.drop_front(end);
  for (std::size_t at = text.find(name); at != llvm::StringRef::npos; at = text.find(name, at + 1)) {
    const llvm::StringRef before = text.take_front(at).rtrim(" &");
    llvm::StringRef rest = text.drop_front(at);
    if (nameAt(rest) != name) continue;
    rest = rest.drop_front(name.size()).ltrim();
    if (rest.consume_front("=") && makesIndex(rest.ltrim())) return true;
    const std::size_t type = before.rfind("index<");
    if (type != llvm::StringRef::npos && type + behindList(before.drop_front(type), "index") == before.size())
      return true;
  }
  return false;
}

/// Advice on a component of an `index<1>`, in a template whose rank is 1.
Advice adviceOnRankOne(const clang::Diagnostic& diagnostic, llvm::StringRef value) {
  const llvm::StringRef name = nameAt(value);
  const bool isIndex =
      makesIndex(value) || (!name.empty() && name == value && declaresIndex(textBefore(diagnostic), name));
  return {isIndex ? format(Diag::IndexOfRankOne, {value.str()}) : std::string()};
}

// ---- streams --------------------------------------------------------------------------------------

/// The rank of the gather among the diagnostic's types; 0 if there is none.
int gatherRankIn(const clang::Diagnostic& diagnostic) {
  for (const clang::QualType type : typesIn(diagnostic)) {
    const clang::CXXRecordDecl* record = type.isNull() ? nullptr : type->getAsCXXRecordDecl();
    if (const int rank = gatherRank(record); rank != 0) return rank;
  }
  return 0;
}

/// Advice on a gather that stands where a value is meant. One with too few indices is a gather of lower rank.
Advice adviceOnGather(int rank, llvm::StringRef text) {
  const llvm::StringRef name = nameAt(text);
  if (name.empty() || !text.drop_front(name.size()).ltrim().starts_with("[") || !text.ends_with("]"))
    return {format(Diag::GatherAsValue, {})};
  constexpr std::array<std::string_view, 3> missing = {"[x]", "[y][x]", "[z][y][x]"};
  const auto count = static_cast<std::size_t>(rank);
  if (count == 0 || count > missing.size()) return {format(Diag::GatherAsValue, {})};
  return {format(Diag::IndexTooFew, {text.str(), rank == 1 ? "one index" : fmt::format("{} indices", rank),
                                     missing[count - 1]})};
}

/// The parameter that a name in a body stands for: the last one of that name above it.
const ParamSyntax* parameterNamed(const DeclarationSyntax& syntax, llvm::StringRef name,
                                  const clang::Diagnostic& diagnostic) {
  const ParamSyntax* found = nullptr;
  clang::SourceLocation last;
  const clang::SourceLocation use = diagnostic.getLocation();
  syntax.forEachParam([&](clang::SourceLocation location, const ParamSyntax& param) {
    if (location.isMacroID() || use.isMacroID() || !(location < use) || (last.isValid() && location < last))
      return;
    clang::SmallString<32> buffer;
    if (clang::Lexer::getSpelling(location, buffer, diagnostic.getSourceManager(), clang::LangOptions()) !=
        name)
      return;
    last = location;
    found = &param;
  });
  return found;
}

/// Advice on an index where there is none: `x[0]` of an element x, `a[1][2]` of a gather a of rank 1.
Advice adviceOnIndex(const clang::Diagnostic& diagnostic, const DeclarationSyntax* syntax) {
  const llvm::StringRef base = textOf(diagnostic), name = nameAt(base);
  if (name.empty()) return {};
  if (Advice advice = adviceOnRankOne(diagnostic, base); !advice.text.empty()) return advice;
  const std::size_t taken = base.count('[');
  const bool isIndexed = taken > 0 && base.drop_front(name.size()).ltrim().starts_with("[");
  if (!isIndexed || taken > 4) {
    const ParamSyntax* param = syntax == nullptr ? nullptr : parameterNamed(*syntax, name, diagnostic);
    const bool isOutput = param != nullptr && param->role == ir::ParamRole::Output;
    return {format(isOutput ? Diag::IndexedOutput : Diag::IndexedValue, {base.str(), name.str()})};
  }
  std::string brackets;
  for (std::size_t i = 0; i <= taken; ++i) brackets += "[]";
  return {format(Diag::IndexTooMany, {name.str(), fmt::format("{} ind{}", taken, taken == 1 ? "ex" : "ices"),
                                      fmt::format("{}", taken + 1), brackets})};
}

/// Advice on `x[f]`, where x is an array with a length and f a float.
Advice adviceOnArrayIndex(const clang::Diagnostic& diagnostic) {
  const llvm::StringRef index = textOf(diagnostic);
  if (index.empty()) return {};
  const clang::CharSourceRange range = diagnostic.getRange(0);
  std::vector<clang::FixItHint> fixIts;
  if (!range.getBegin().isMacroID() && !range.getEnd().isMacroID()) {
    fixIts = {clang::FixItHint::CreateReplacement(range, fmt::format("int({})", index.str()))};
  }
  return {format(Diag::ArrayIndexType, {index.str()}), std::move(fixIts)};
}

/// Advice on `a(1, 2)` of a gather, and on `r[0]` of a variable output.
Advice adviceOnCalledValue(const clang::Diagnostic& diagnostic) {
  for (const clang::QualType type : typesIn(diagnostic)) {
    if (isOfClass(type, variableOutputClass)) return {format(Diag::PushForm, {})};
  }
  const int rank = gatherRankIn(diagnostic);
  if (rank == 0) return {};
  std::string indices;
  for (int i = 0; i < rank; ++i) indices += fmt::format("[{}]", "ijkl"[i]);
  const llvm::StringRef name = nameAt(textAt(diagnostic));
  return {format(Diag::GatherCalled, {name.empty() ? "a" : name.str(), indices})};
}

/// Advice on `a[0] = 1`: only elements of gathers and rows of parameters are indexed and not assignable.
Advice adviceOnAssignment(const clang::Diagnostic& diagnostic) {
  const llvm::StringRef place = textOf(diagnostic), name = nameAt(place);
  const bool isIndexed = !name.empty() && place.drop_front(name.size()).ltrim().starts_with("[");
  return {isIndexed ? format(Diag::GatherAssigned, {place.str(), name.str()}) : std::string()};
}

/// Advice on `a.size()` of an element or a gather, and other members of containers.
Advice adviceOnMember(std::string_view member) {
  constexpr std::string_view ofContainers[] = {"size", "length", "begin", "end", "empty", "data"};
  const bool isKnown = std::ranges::find(ofContainers, member) != std::end(ofContainers);
  return {isKnown ? format(Diag::StreamMember, {member}) : std::string()};
}

/// Advice on `x.y`, where x is a number.
Advice adviceOnScalarMember(const clang::Diagnostic& diagnostic) {
  const llvm::StringRef value = textOf(diagnostic), member = textOf(diagnostic, 1);
  if (Advice advice = adviceOnMember(std::string_view(member)); !advice.text.empty()) return advice;
  const bool isComponent = !member.empty() && member.find_first_not_of("xyzwrgba") == llvm::StringRef::npos;
  if (!isComponent || value.empty()) return {};
  if (Advice advice = adviceOnRankOne(diagnostic, value); !advice.text.empty()) return advice;
  return {format(Diag::ScalarMember, {value.str(), member.str()})};
}

/// True for "float3x3".
bool isMatrixName(llvm::StringRef name) {
  return name.consume_front("float") && name.size() == 3 && name[1] == 'x' && name[0] == name[2];
}

/// Advice on a member that a class of the prelude does not have.
Advice adviceOnMissingMember(const clang::Diagnostic& diagnostic) {
  const auto* context = reinterpret_cast<const clang::DeclContext*>(diagnostic.getRawArg(1));
  const auto* type = llvm::dyn_cast_or_null<clang::NamedDecl>(context);
  if (type == nullptr || type->getIdentifier() == nullptr) return {};
  if (type->getName() == llvm::StringRef(gatherClass))
    return {format(Diag::StreamMember, {nameIn(diagnostic, 0)})};
  if (isMatrixName(type->getName())) return {format(Diag::MatrixMember, {nameIn(diagnostic, 0)})};
  return {type->getName() == variableOutputClass ? format(Diag::PushForm, {}) : std::string()};
}

/// Advice on `y = x`, where y is a variable output: the prelude deletes that operator, and gives its class as the reason.
Advice adviceOnDeleted(const clang::Diagnostic& diagnostic) {
  for (unsigned i = 0; i < diagnostic.getNumArgs(); ++i) {
    if (nameIn(diagnostic, i) == variableOutputClass) return {format(Diag::PushForm, {})};
  }
  return {};
}

// ---- vectors --------------------------------------------------------------------------------------

/// True for the type of a comparison of vectors, which has no name.
bool isMask(clang::QualType type) {
  const auto* vector = type.isNull() ? nullptr : llvm::dyn_cast<clang::ExtVectorType>(type.getTypePtr());
  return vector != nullptr && vector->getElementType()->isIntegerType();
}

/// True for an intrinsic that works by component, and for a type, whose vectors are as wide as their operand.
bool keepsWidth(llvm::StringRef callee) {
  if (callee.empty()) return true;  // parentheses
  const std::string name = callee.rtrim("234").str();
  constexpr std::string_view types[] = {"bool", "int", "uint", "long", "ulong", "float", "double", "half"};
  if (std::ranges::find(types, name) != std::end(types)) return true;
  return std::ranges::any_of(ir::intrinsicRows(), [&](const ir::IntrinsicRow& row) {
    return callee == llvm::StringRef(row.spelling);
  });
}

/// True if the place in a text is in the arguments of a function whose result has a width of its own.
bool isArgument(llvm::StringRef text, std::size_t at) {
  int depth = 0;
  for (std::size_t i = at; i-- > 0;) {
    if (text[i] == ')') ++depth;
    if (text[i] != '(' || --depth >= 0) continue;
    depth = 0;
    const llvm::StringRef before = text.take_front(i).rtrim();
    const std::size_t start =
        before.find_last_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_");
    if (!keepsWidth(before.drop_front(start == llvm::StringRef::npos ? 0 : start + 1))) return true;
  }
  return false;
}

/// `indexof(r)` or `extentof(a)` in a text, without a component behind it.
llvm::StringRef positionIn(llvm::StringRef text) {
  for (const llvm::StringRef word : {"indexof", "extentof"}) {
    for (std::size_t at = text.find(word); at != llvm::StringRef::npos; at = text.find(word, at + 1)) {
      const llvm::StringRef arguments = bracketedAt(text.drop_front(at + word.size()));
      const llvm::StringRef call = text.substr(at, word.size() + arguments.size());
      const llvm::StringRef rest = text.drop_front(at + call.size()).ltrim();
      const bool isWhole = !arguments.empty() && !rest.starts_with(".") && !rest.starts_with("[");
      if (isWhole && !isArgument(text, at)) return call;
    }
  }
  return {};
}

/// True for a name, a call or a member, which take a swizzle without parentheses.
bool isPrimary(llvm::StringRef text) {
  while (!text.empty()) {
    const llvm::StringRef brackets = bracketedAt(text);
    const std::size_t taken = !brackets.empty()        ? brackets.size()
                              : text.starts_with(".")  ? 1
                              : text.starts_with("::") ? 2
                                                       : nameAt(text).size();
    if (taken == 0) return false;
    text = text.drop_front(taken);
  }
  return true;
}

std::string components(llvm::StringRef text, unsigned count) {
  return fmt::format(fmt::runtime(isPrimary(text) ? "{}.{}" : "({}).{}"), std::string_view(text),
                     std::string_view("xyzw").substr(0, count));
}

std::string wantedNumbers(unsigned count) {
  return count == 1 ? "one number is wanted" : fmt::format("{} are wanted", count);
}

/// A fix-it that inserts a swizzle behind a part of a marked range; none inside macros.
std::vector<clang::FixItHint> swizzled(const clang::Diagnostic& diagnostic, unsigned range,
                                       llvm::StringRef part, std::string_view swizzle) {
  const clang::SourceLocation begin = diagnostic.getRange(range).getBegin();
  if (begin.isMacroID() || diagnostic.getRange(range).getEnd().isMacroID()) return {};
  const auto offset = part.end() - textOf(diagnostic, range).begin();
  return {clang::FixItHint::CreateInsertion(begin.getLocWithOffset(static_cast<int>(offset)), swizzle)};
}

/// Advice on `indexof(r)` and `extentof(a)` where `wanted` numbers are meant, the commonest slip.
Advice adviceOnPosition(const clang::Diagnostic& diagnostic, unsigned wanted) {
  for (unsigned range = 0; range < diagnostic.getNumRanges(); ++range) {
    const llvm::StringRef call = positionIn(textOf(diagnostic, range));
    if (call.empty()) continue;
    return {
        format(Diag::ComponentCount,
               {call.str(), "4 components, x first", wantedNumbers(wanted), components(call, wanted)}),
        swizzled(diagnostic, range, call, fmt::format(".{}", std::string_view("xyzw").substr(0, wanted)))};
  }
  return {};
}

/// Advice to take some of the components, or to add zeros for the missing ones.
Advice otherWidth(llvm::StringRef text, unsigned given, unsigned wanted, const std::string& type) {
  std::string instead = components(text, std::min(given, wanted));
  if (given < wanted) {
    instead = fmt::format("{}({}", type, std::string_view(text));
    for (unsigned i = given; i < wanted; ++i) instead += ", 0";
    instead += ")";
  }
  return {format(Diag::ComponentCount,
                 {text.str(), fmt::format("{} components", given), wantedNumbers(wanted), instead})};
}

/// Advice on a vector where a number, or a vector of another width or type, is meant.
Advice adviceOnWidth(clang::QualType from, clang::QualType to, llvm::StringRef text) {
  const unsigned given = widthOf(from), wanted = widthOf(to);
  if (given < 2 || wanted == 0 || text.empty()) return {};
  const bool isNumber = to->isArithmeticType() || wanted > 1;
  if (!isNumber) return {};
  if (given == wanted) return {format(Diag::VectorConversion, {spellingOf(to), text.str()})};
  return otherWidth(text, given, wanted, spellingOf(to));
}

/// Advice on initialising, assigning, passing or returning a value of another type.
Advice adviceOnConversion(const clang::Diagnostic& diagnostic, clang::QualType from, clang::QualType to) {
  const unsigned ranges = diagnostic.getNumRanges();
  const llvm::StringRef text = ranges == 0 ? llvm::StringRef() : textOf(diagnostic, ranges - 1);
  if (const int rank = gatherRankIn(diagnostic)) return adviceOnGather(rank, text);
  const auto* vector = to->getAs<clang::ExtVectorType>();
  const bool takesNumbers = vector != nullptr && !vector->getElementType()->isChar32Type();
  if (isMask(from) && takesNumbers && widthOf(from) == widthOf(to)) {
    const bool isShown = !text.empty() && !text.contains('?');
    return {format(Diag::MaskAsNumbers, {spellingOf(to), isShown ? text.str() : "mask"})};
  }
  if (isMask(from) && to->isBooleanType()) return {format(Diag::MaskAsCondition, {text.str()})};
  if (widthOf(to) < 4 && widthOf(from) == 4) {
    if (Advice advice = adviceOnPosition(diagnostic, widthOf(to)); !advice.text.empty()) return advice;
  }
  return adviceOnWidth(from, to, text);
}

/// What a conversion of an assignment or an initialiser is from and to, in Clang's order for its kind.
Advice adviceOnIncompatible(const clang::Diagnostic& diagnostic) {
  const std::vector<clang::QualType> types = typesIn(diagnostic);
  if (types.size() < 2) return {};
  bool isTargetFirst = true;
  if (diagnostic.getID() == clang::diag::err_typecheck_convert_incompatible) {
    constexpr std::uint64_t assigning = 0, initializing = 4;  // Sema::AssignmentAction
    const std::uint64_t action = diagnostic.getRawArg(2);
    isTargetFirst = action == assigning || action == initializing;
  }
  return adviceOnConversion(diagnostic, types[isTargetFirst ? 1 : 0], types[isTargetFirst ? 0 : 1]);
}

/// Advice on `float(v)` and `(int)v`, where the types come in the order of the conversion.
Advice adviceOnCast(const clang::Diagnostic& diagnostic) {
  const std::vector<clang::QualType> types = typesIn(diagnostic);
  if (types.size() < 2 || widthOf(types[0]) < 2 || !types[1]->isArithmeticType()) return {};
  if (Advice advice = adviceOnPosition(diagnostic, 1); !advice.text.empty()) return advice;
  llvm::StringRef text =
      textOf(diagnostic, diagnostic.getNumRanges() == 0 ? 0 : diagnostic.getNumRanges() - 1);
  const llvm::StringRef type = nameAt(text);  // `float(v)`, of which v is the operand
  if (text.drop_front(type.size()).starts_with("(") && text.ends_with(")"))
    text = text.drop_front(type.size() + 1).drop_back();
  return adviceOnWidth(types[0], types[1], text);
}

/// Advice on `if (a < b)` of vectors.
Advice adviceOnCondition(const clang::Diagnostic& diagnostic) {
  const std::vector<clang::QualType> types = typesIn(diagnostic);
  if (types.empty() || widthOf(types[0]) < 2) return {};
  if (Advice advice = adviceOnPosition(diagnostic, 1); !advice.text.empty()) return advice;
  const llvm::StringRef text = textOf(diagnostic);
  if (!isMask(types[0]) || text.empty()) return {};
  return {format(Diag::MaskAsCondition, {text.str()})};
}

// ---- operators ------------------------------------------------------------------------------------

/// The character at a diagnostic's location.
char characterAt(const clang::Diagnostic& diagnostic) {
  const llvm::StringRef text = textAt(diagnostic);
  return text.empty() ? '\0' : text.front();
}

/// Advice on `x ^ 2` and `x % 2` of floats, and on operators between a gather and something else.
Advice adviceOnOperands(const clang::Diagnostic& diagnostic) {
  if (const int rank = gatherRankIn(diagnostic)) {
    for (unsigned range = 0; range < diagnostic.getNumRanges(); ++range) {
      const llvm::StringRef text = textOf(diagnostic, range);
      if (text.ends_with("]")) return adviceOnGather(rank, text);
    }
    return {format(Diag::GatherAsValue, {})};
  }
  const std::vector<clang::QualType> types = typesIn(diagnostic);
  const bool isOfFloats = std::ranges::any_of(
      types, [](clang::QualType type) { return type.getCanonicalType()->hasFloatingRepresentation(); });
  if (characterAt(diagnostic) == '%' && isOfFloats) return {format(Diag::RemainderOfFloats, {"%"})};
  return {characterAt(diagnostic) == '^' ? format(Diag::PowerOperator, {"^"}) : std::string()};
}

/// Advice on operands of different widths: `indexof(r) * 0.5`, `float3 + float4`, `int3 * 0.5`.
Advice adviceOnWidths(const clang::Diagnostic& diagnostic) {
  const std::vector<clang::QualType> types = typesIn(diagnostic);
  if (types.size() < 2 || diagnostic.getNumRanges() < 2) return {};
  const unsigned left = widthOf(types[0]), right = widthOf(types[1]);
  const unsigned narrow = std::min(left, right);
  if (narrow < 4) {
    if (Advice advice = adviceOnPosition(diagnostic, narrow); !advice.text.empty()) return advice;
  }
  const auto component = [](clang::QualType type) {
    const auto* vector = type->getAs<clang::ExtVectorType>();
    return vector == nullptr ? clang::QualType() : vector->getElementType();
  };
  if (left == right && left > 1) {  // float3 and double3
    const clang::QualType first = component(types[0]);
    const bool hasLeftMoreBits = first->isSpecificBuiltinType(clang::BuiltinType::Double) ||
                                 first->isSpecificBuiltinType(clang::BuiltinType::Long) ||
                                 first->isSpecificBuiltinType(clang::BuiltinType::ULong);
    return adviceOnWidth(types[hasLeftMoreBits ? 1 : 0], types[hasLeftMoreBits ? 0 : 1],
                         textOf(diagnostic, hasLeftMoreBits ? 1 : 0));
  }
  const bool isLeftWider = left > right;
  const llvm::StringRef text = textOf(diagnostic, isLeftWider ? 0 : 1);
  const clang::QualType wide = types[isLeftWider ? 0 : 1], other = types[isLeftWider ? 1 : 0];
  if (text.empty()) return {};
  if (narrow > 1) return adviceOnWidth(wide, other, text);
  const bool isSafe = other->isSpecificBuiltinType(clang::BuiltinType::Float) ||
                      other->isSpecificBuiltinType(clang::BuiltinType::Double);
  if (!isSafe) return {};
  return {format(Diag::VectorConversion,
                 {fmt::format("{}{}", other.getUnqualifiedType().getAsString(), widthOf(wide)), text.str()})};
}

/// Advice on `v * m`, and on `m * v` where v has another width.
Advice adviceOnMatrix(const clang::Diagnostic& diagnostic) {
  const std::vector<clang::QualType> types = typesIn(diagnostic);
  if (types.size() == 2 && isOfClass(types[0], "float") && diagnostic.getNumRanges() > 1) {
    const llvm::StringRef name = types[0]->getAsCXXRecordDecl()->getName(), text = textOf(diagnostic, 1);
    const auto wanted = static_cast<unsigned>(name.back() - '0'), given = widthOf(types[1]);
    if (!isMatrixName(name) || given < 2 || given == wanted || text.empty()) return {};
    return otherWidth(text, given, wanted, fmt::format("float{}", wanted));
  }
  const bool isProduct = characterAt(diagnostic) == '*' && types.size() == 2 && widthOf(types[0]) > 1;
  if (!isProduct || !isOfClass(types[1], "float") || diagnostic.getNumRanges() < 2) return {};
  if (!isMatrixName(types[1]->getAsCXXRecordDecl()->getName())) return {};
  return {format(Diag::VectorTimesMatrix, {textOf(diagnostic, 0).str(), textOf(diagnostic, 1).str()})};
}

/// Advice on `x ** 2`, where the second star dereferences what is not a pointer.
Advice adviceOnIndirection(const clang::Diagnostic& diagnostic) {
  bool isInvalid = false;
  const clang::SourceLocation location = diagnostic.getLocation();
  if (location.isMacroID()) return {};
  const char* text =
      diagnostic.getSourceManager().getCharacterData(location.getLocWithOffset(-1), &isInvalid);
  return {!isInvalid && *text == '*' ? format(Diag::PowerOperator, {"**"}) : std::string()};
}

/// Advice on `a[p]` of a gather, where p is no index.
Advice adviceOnSubscript(const clang::Diagnostic& diagnostic) {
  const int rank = gatherRankIn(diagnostic);
  if (rank == 0) return {};
  if (rank < 4) {
    if (Advice advice = adviceOnPosition(diagnostic, static_cast<unsigned>(rank)); !advice.text.empty())
      return advice;
  }
  const std::string vectors =
      rank == 1 ? "" : fmt::format(", or an int{0} or float{0} for all dimensions, x first", rank);
  return {format(Diag::GatherIndex, {textOf(diagnostic).str(), vectors})};
}

// ---- calls ----------------------------------------------------------------------------------------

/// How many arguments each form of an intrinsic takes.
std::set<std::size_t> argumentCounts(llvm::StringRef name) {
  std::set<std::size_t> counts;
  for (const ir::IntrinsicRow& row : ir::intrinsicRows()) {
    if (name != llvm::StringRef(row.spelling)) continue;
    for (const ir::IntrinsicOverload& overload : ir::overloads(row.id))
      counts.insert(overload.arguments.size());
  }
  return counts;
}

std::size_t argumentsIn(llvm::StringRef call) {
  if (call.size() < 2 || call.drop_front().drop_back().trim().empty()) return 0;
  std::size_t count = 1;
  int depth = 0;
  for (const char c : call) {
    if (llvm::StringRef("([{").contains(c)) ++depth;
    if (llvm::StringRef(")]}").contains(c)) --depth;
    if (c == ',' && depth == 1) ++count;
  }
  return count;
}

Advice adviceOnCall(const clang::Diagnostic& diagnostic) {
  const std::string name = nameIn(diagnostic, 0);
  if (name == "push") return {format(Diag::PushForm, {})};
  if (name == "assert") return {format(Diag::AssertForm, {})};
  if (name == "indexof" || name == "extentof") return {format(Diag::IndexOfWithout, {name, "r"}), {}, true};
  if (name == "neighbor") return {format(Diag::GatherArguments, {name, "an offset in each"})};
  if (name == "sample")
    return {format(Diag::GatherArguments, {name, "a position with a component for each"})};
  const std::set<std::size_t> counts = argumentCounts(name);
  llvm::StringRef rest = textAt(diagnostic);
  if (counts.empty() || !rest.consume_front(name)) return {};
  const llvm::StringRef arguments = bracketedAt(rest.ltrim());
  const std::size_t given = argumentsIn(arguments);
  if (counts.contains(given)) return {format(Diag::IntrinsicOperands, {name, arguments.str()})};
  std::string taken;
  for (const std::size_t count : counts) taken += fmt::format("{}{}", taken.empty() ? "" : " or ", count);
  return {format(Diag::ArgumentCount,
                 {name, taken == "1" ? "1 argument" : taken + " arguments", std::to_string(given)})};
}

}  // namespace

std::string intrinsicCalledIn(llvm::StringRef text) {
  for (std::size_t at = 0; at < text.size();) {
    const llvm::StringRef name = nameAt(text.drop_front(at));
    if (name.empty()) {
      ++at;
      continue;
    }
    at += name.size();
    if (text.drop_front(at).ltrim().starts_with("(") && !argumentCounts(name).empty()) return name.str();
  }
  return {};
}

Advice adviceOnValues(const clang::Diagnostic& diagnostic, const DeclarationSyntax* syntax) {
  switch (diagnostic.getID()) {
    case clang::diag::err_typecheck_invalid_operands: return adviceOnOperands(diagnostic);
    case clang::diag::err_typecheck_indirection_requires_pointer: return adviceOnIndirection(diagnostic);
    case clang::diag::err_typecheck_subscript_value: return adviceOnIndex(diagnostic, syntax);
    case clang::diag::err_typecheck_subscript_not_integer: return adviceOnArrayIndex(diagnostic);
    case clang::diag::err_ovl_no_viable_subscript: return adviceOnSubscript(diagnostic);
    case clang::diag::err_ovl_no_oper:
    case clang::diag::err_ovl_no_viable_object_call: return adviceOnCalledValue(diagnostic);
    case clang::diag::err_init_conversion_failed:
    case clang::diag::err_typecheck_convert_incompatible: return adviceOnIncompatible(diagnostic);
    case clang::diag::err_bad_cxx_cast_generic:
    case clang::diag::err_bad_cxx_cast_vector_to_scalar_different_size: return adviceOnCast(diagnostic);
    case clang::diag::err_typecheck_bool_condition: return adviceOnCondition(diagnostic);
    case clang::diag::err_typecheck_vector_not_convertable:
    case clang::diag::err_typecheck_vector_lengths_not_equal: return adviceOnWidths(diagnostic);
    case clang::diag::err_typecheck_vector_not_convertable_non_scalar: return adviceOnMatrix(diagnostic);
    case clang::diag::err_ovl_no_viable_function_in_call: return adviceOnCall(diagnostic);
    case clang::diag::err_typecheck_expression_not_modifiable_lvalue: return adviceOnAssignment(diagnostic);
    case clang::diag::err_typecheck_member_reference_struct_union: return adviceOnScalarMember(diagnostic);
    case clang::diag::err_no_member: return adviceOnMissingMember(diagnostic);
    case clang::diag::err_ovl_deleted_oper: return adviceOnDeleted(diagnostic);
    case clang::diag::err_ext_vector_component_name_illegal:
      return adviceOnMember(std::string_view(textOf(diagnostic)));
    default: return {};
  }
}

}  // namespace skc::frontend
