// SPDX-License-Identifier: MIT
#include "ir/intrinsics.hpp"

#include <algorithm>
#include <cstddef>

namespace skc::ir {
namespace {

constexpr IntrinsicRow rows[] = {
#define SKC_INTRINSIC(Name, spelling, signatures, library, native, glsl, polyfill) \
  {Intrinsic::Name, #Name, spelling, signatures, glsl, polyfill},
#include "ir/intrinsics.def"
#undef SKC_INTRINSIC
};

/// One assignment of types to the generic letters of a signature.
struct Choice {
  int width;
  Scalar generic;   ///< the type of N, S, Z, Q and R, or of their components; n is this scalar
};

/// The type that a letter stands for; nullopt if the letter excludes the choice.
std::optional<Type> typeOf(char letter, Choice choice) {
  using enum Scalar;
  const bool isVector = choice.width > 1;
  const auto only = [](bool admitted, Scalar scalar, int width) {
    return admitted ? std::optional(Type::of(scalar, width)) : std::nullopt;
  };
  switch (letter) {
    case 'F': return Type::of(Float, choice.width);
    case 'I': return Type::of(Int, choice.width);
    case 'U': return Type::of(Uint, choice.width);
    case 'B':
    case 'M': return Type::of(Bool, choice.width);
    case 'f': return Type::of(Float);
    case 'i': return Type::of(Int);
    case 'J': return Type::of(Int, 4);
    case 'b': return Type::of(Bool);
    case 'w': return only(choice.width == 3, Float, 3);
    case 'D': return Type::of(Double, choice.width);
    case 'd': return Type::of(Double);
    case 'k': return only(choice.width == 3, Double, 3);
    case 'V': return only(isVector, Float, choice.width);
    case 'X': return isVector ? std::optional(Type::matrix(choice.width)) : std::nullopt;
    case 'C': return only(isVector, Bool, choice.width);
    case 'N': return only(choice.generic != Bool, choice.generic, choice.width);
    case 'n': return only(choice.generic != Bool, choice.generic, 1);
    case 'S':
      return only(choice.generic != Bool && choice.generic != Uint && choice.generic != Ulong, choice.generic,
                  choice.width);
    case 'Z': return only(choice.generic != Bool && !isReal(choice.generic), choice.generic, choice.width);
    case 'Q': return only(isVector && choice.generic != Bool, choice.generic, choice.width);
    case 'R': return only(isVector, choice.generic, choice.width);
    default: break;   // not a letter of the table
  }
  return std::nullopt;
}

/// Resolves a signature such as "F(F,f)" under one choice.
std::optional<IntrinsicOverload> resolve(std::string_view signature, Choice choice) {
  IntrinsicOverload overload;
  for (std::size_t i = 0; i < signature.size(); ++i) {
    const char letter = signature[i];
    if (letter == '(' || letter == ',' || letter == ')') continue;
    const std::optional<Type> type = typeOf(letter, choice);
    if (!type) return std::nullopt;
    if (i == 0) {
      overload.result = *type;
    } else {
      overload.arguments.push_back(*type);
    }
  }
  return overload;
}

}  // namespace

const IntrinsicRow& row(Intrinsic intrinsic) { return rows[static_cast<std::size_t>(intrinsic)]; }

std::span<const IntrinsicRow> intrinsicRows() { return rows; }

std::vector<IntrinsicOverload> overloads(Intrinsic intrinsic) {
  std::vector<IntrinsicOverload> all;
  std::string_view signatures = row(intrinsic).signatures;
  while (!signatures.empty()) {
    const std::string_view signature = signatures.substr(0, signatures.find(' '));
    signatures.remove_prefix(std::min(signatures.size(), signature.size() + 1));
    for (Scalar generic : {Scalar::Float, Scalar::Int, Scalar::Uint, Scalar::Double, Scalar::Long,
                           Scalar::Ulong, Scalar::Bool}) {
      for (int width = 1; width <= 4; ++width) {
        std::optional<IntrinsicOverload> one = resolve(signature, {width, generic});
        if (one && std::find(all.begin(), all.end(), *one) == all.end()) all.push_back(std::move(*one));
      }
    }
  }
  return all;
}

std::optional<Type> resultType(Intrinsic intrinsic, std::span<const Type> arguments) {
  for (const IntrinsicOverload& one : overloads(intrinsic)) {
    if (std::equal(one.arguments.begin(), one.arguments.end(), arguments.begin(), arguments.end())) {
      return one.result;
    }
  }
  return std::nullopt;
}

}  // namespace skc::ir
