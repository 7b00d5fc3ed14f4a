// SPDX-License-Identifier: MIT
//
// The table of intrinsics (intrinsics.def) as an enumeration and rows, and its signatures as types: the
// result type of a call, and every overload.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "ir/type.hpp"

namespace skc::ir {

enum class Intrinsic : std::uint16_t {
#define SKC_INTRINSIC(Name, spelling, signatures, library, native, glsl, polyfill) Name,
#include "ir/intrinsics.def"
#undef SKC_INTRINSIC
};

struct IntrinsicRow {
  Intrinsic id;
  std::string_view name, spelling, signatures, glsl, polyfill;
};
const IntrinsicRow& row(Intrinsic intrinsic);
/// All rows, in the order of the table.
std::span<const IntrinsicRow> intrinsicRows();

struct IntrinsicOverload {
  Type result;
  std::vector<Type> arguments;
  bool operator==(const IntrinsicOverload&) const = default;
};
/// Every overload that the row's signatures stand for, without duplicates.
std::vector<IntrinsicOverload> overloads(Intrinsic intrinsic);

/// The type of a call with arguments of exactly these types; nullopt if no signature matches.
std::optional<Type> resultType(Intrinsic intrinsic, std::span<const Type> arguments);

}  // namespace skc::ir
