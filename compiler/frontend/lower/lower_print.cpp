// SPDX-License-Identifier: MIT
//
// Lowers printf. Clang's -Wformat, whose warnings are errors here, compares a format with its values; this file does so once
// more, because that can be switched off, and native code passes on to the C library whatever the IR says.
#include <string>
#include <string_view>
#include <vector>

#include <clang/AST/Expr.h>
#include <fmt/format.h>

#include "frontend/lower/function_lowering.hpp"
#include "ir/build.hpp"

namespace skc::frontend {

using ir::ExprPtr;

namespace {

constexpr std::string_view ofIntegers = "diuoxXc";
constexpr std::string_view ofFloats = "fFeEgGaA";

bool isOneOf(std::string_view characters, char c) { return characters.find(c) != std::string_view::npos; }

/// The parts of a format that each print, or use, one value: "%-8.3f", and "*" for a width or a precision that is given.
std::vector<std::string> conversionsOf(std::string_view format) {
  std::vector<std::string> conversions;
  for (std::size_t i = 0; i < format.size(); ++i) {
    if (format[i] != '%') continue;
    if (i + 1 < format.size() && format[i + 1] == '%') {
      ++i;
      continue;
    }
    std::string one = "%";
    while (++i < format.size() && isOneOf("-+ #0123456789.*hlLqjzt", format[i])) {
      if (format[i] == '*') conversions.emplace_back("*");
      one += format[i];
    }
    if (i < format.size()) one += format[i];
    conversions.push_back(std::move(one));
  }
  return conversions;
}

bool printsInteger(std::string_view conversion) {
  return conversion == "*" ||
         (isOneOf(ofIntegers, conversion.back()) && conversion.find_first_of("Lqjzt") == conversion.npos);
}
/// True for "%ld": an integer of 64 bits.
bool printsLong(std::string_view conversion) {
  return printsInteger(conversion) && conversion.find('l') != conversion.npos;
}
bool printsFloat(std::string_view conversion) {
  return isOneOf(ofFloats, conversion.back()) && conversion.find_first_of("hLqjzt") == conversion.npos;
}

/// C promotes floats to doubles on the way, which would make doubles of the kernel's floats.
const clang::Expr* withoutPromotion(const clang::Expr* e) {
  const auto* cast = llvm::dyn_cast<clang::ImplicitCastExpr>(e);
  return cast != nullptr && cast->getCastKind() == clang::CK_FloatingCast ? cast->getSubExpr() : e;
}

}  // namespace

ExprPtr FunctionLowering::print(const clang::CallExpr* e) {
  const Loc loc = module_.loc(e->getBeginLoc());
  const auto* format = llvm::dyn_cast<clang::StringLiteral>(e->getArg(0)->IgnoreParenImpCasts());
  if (format == nullptr || !(format->isOrdinary() || format->isUTF8()))
    module_.fail(Diag::PrintFormat, e->getArg(0)->getBeginLoc());
  const std::vector<std::string> conversions = conversionsOf(format->getString());
  std::vector<const clang::Expr*> given;
  for (unsigned i = 1; i < e->getNumArgs(); ++i) given.push_back(withoutPromotion(e->getArg(i)));
  for (const std::string& conversion : conversions) {
    if (!printsInteger(conversion) && !printsFloat(conversion))
      module_.fail(Diag::PrintConversion, e->getArg(0)->getBeginLoc(), {conversion});
  }
  if (conversions.size() != given.size()) {
    module_.fail(Diag::PrintCount, e->getBeginLoc(),
                 {fmt::format("{} value{}", conversions.size(), conversions.size() == 1 ? "" : "s"),
                  std::to_string(given.size())});
  }
  Exprs values = valuesInOrder(given);
  for (std::size_t i = 0; i < given.size(); ++i)
    values[i] = printed(given[i], std::move(values[i]), conversions[i]);
  if (!checks_) emit(loc, ir::Print{format->getString().str(), std::move(values)});
  return ir::literal(false, loc);  // never used: printf is void
}

/// A value in a type that printf knows.
ExprPtr FunctionLowering::printed(const clang::Expr* e, ExprPtr value, std::string_view conversion) {
  const ir::Type type = value->type;
  const ir::Type number = type.isArithmetic() && type.isScalar() ? type.arithmeticType() : type;
  const bool isInteger =
      number.isScalar() && (printsLong(conversion) ? number.isLong() : number.isBool() || number.isInteger());
  const bool isFloat = number.isScalar() && (number.isFloat() || number.isDouble());
  if (printsInteger(conversion) ? !isInteger : !isFloat) {
    module_.fail(Diag::PrintValue, e->getBeginLoc(),
                 {conversion,
                  printsLong(conversion)      ? "a long or a ulong"
                  : printsInteger(conversion) ? "an integer"
                                              : "a float or a double",
                  module_.textOf(e), module_.spelling(type)});
  }
  return convert(std::move(value), number.isBool() ? ir::Scalar::Int : number.scalar);
}

}  // namespace skc::frontend
