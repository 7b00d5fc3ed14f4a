// SPDX-License-Identifier: MIT
//
// The table of functions, which use only functions of doubles.hpp and double_pieces.hpp, so that one text
// serves both representations. `D(x)` is a constant (double_polynomials.hpp). NaN is tested first, because
// devices compare it differently.
#include "assemble/glsl/double_intrinsics.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "assemble/glsl/double_pieces.hpp"
#include "assemble/glsl/double_polynomials.hpp"
#include "glsl_text/double_intrinsics.hpp"

namespace sk::assemble {
namespace {

using program::Intrinsic;
using program::IntrinsicUse;

struct Row {
  Pieces needs;
  std::string_view text;
};

// clang-format off: in the order of program::Intrinsic
constexpr std::array rows = {
    Row{pieces(Piece::Wave), library::sin},
    Row{pieces(Piece::Wave), library::cos},
    Row{pieces(Piece::Wave), library::tan},
    Row{pieces(Piece::Angle), library::asin},
    Row{pieces(Piece::Angle), library::acos},
    Row{pieces(Piece::Angle), library::atan},
    Row{pieces(Piece::Angle), library::atan2},
    Row{pieces(Piece::ExpReduced), library::sinh},
    Row{pieces(Piece::ExpReduced), library::cosh},
    Row{pieces(Piece::ExpReduced), library::tanh},
    Row{pieces(Piece::LogPlus), library::asinh},
    Row{pieces(Piece::LogPlus), library::acosh},
    Row{pieces(Piece::LogPlus), library::atanh},
    Row{pieces(Piece::ExpReduced), library::exp},
    Row{pieces(Piece::ExpTail), library::exp2},
    Row{pieces(Piece::Log), library::log},
    Row{pieces(Piece::Log), library::log2},
    Row{pieces(Piece::Log), library::log10},
    Row{pieces(Piece::Power), library::pow},
};
// clang-format on
static_assert(rows.size() == static_cast<std::size_t>(Intrinsic::Pow) + 1);

}  // namespace

bool callDoubleIntrinsics(std::span<const IntrinsicUse> uses) {
  return std::ranges::any_of(uses, &IntrinsicUse::ofDouble);
}

std::string doubleIntrinsicDefinitions(std::span<const IntrinsicUse> uses, Doubles form, Barrier barrier) {
  if (!callDoubleIntrinsics(uses)) return {};
  Pieces used = 0;
  for (const IntrinsicUse& use : uses) {
    if (use.ofDouble) used |= rows[static_cast<std::size_t>(use.intrinsic)].needs;
  }
  std::string text = doublePieces(used, form, barrier);
  for (const IntrinsicUse& use : uses) {
    if (use.ofDouble) text += withConstants(form, rows[static_cast<std::size_t>(use.intrinsic)].text);
  }
  return text;
}

}  // namespace sk::assemble
