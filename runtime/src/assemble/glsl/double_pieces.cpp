// SPDX-License-Identifier: MIT
//
// One text over the functions of doubles.hpp for both representations, except for the few functions that use
// bits. Coefficients are of minimax polynomials for the error of the final function (Remez' exchange in 60
// digits, then rounded to double), which is at most 2^-57. `D(x)` is a constant (double_polynomials.hpp).
// Range reductions must subtract exactly as written: sk_sum() is sk_add() with a barrier.
#include "assemble/glsl/double_pieces.hpp"

#include <array>
#include <string_view>

#include "assemble/glsl/double_polynomials.hpp"
#include "glsl_text/double_pieces.hpp"

namespace sk::assemble {
namespace {

// (exp(r) - 1 - r) / r^2 for |r| <= ln(2) / 2
constexpr double expCoefficients[] = {0.5,
                                      0.16666666666666677,
                                      0.041666666666666512,
                                      0.0083333333333216793,
                                      0.0013888888888962422,
                                      0.00019841269885999336,
                                      2.4801587172460202e-05,
                                      2.7557244336990327e-06,
                                      2.7557402679516866e-07,
                                      2.5108992987628992e-08,
                                      2.0875329194054101e-09};
// (log((1 + s) / (1 - s)) / s - 2 - 2/3 s^2) / s^4 for |s| <= 3 - sqrt(8), in s^2
constexpr double logCoefficients[] = {0.4000000000000225,  0.28571428570100721, 0.22222222519779192,
                                      0.18181784375566337, 0.15386757082812325, 0.13256821145347827,
                                      0.13196313322258743};
// (sin(r) - r) / r^3 and (cos(r) - 1 + r^2 / 2) / r^4 for |r| <= pi/4, in r^2
constexpr double sinCoefficients[] = {-0.16666666666666632,   0.008333333333322427,   -0.00019841269829817568,
                                      2.7557313694704543e-06, -2.505075846063303e-08, 1.5896810995247941e-10};
constexpr double cosCoefficients[] = {0.041666666666666595,   -0.0013888888888873043,
                                      2.4801587288842397e-05, -2.7557314176374995e-07,
                                      2.0875700419717656e-09, -1.1358513583716001e-11};
// (atan(t) - t) / t^3 for |t| <= sqrt(5) - 2, in t^2
constexpr double atanCoefficients[] = {-0.3333333333333301,  0.19999999999809875,   -0.14285714247710074,
                                       0.11111107431917366,  -0.090907115707177022, 0.076861018543203777,
                                       -0.06552573663308453, 0.047297067497184535};

struct PieceRow {
  Pieces needs;
  Polynomial polynomial;  ///< precedes the text; may have no coefficients
  std::string_view text;
};

// clang-format off: in the order of Piece
constexpr std::array pieceRows = {
    PieceRow{{}, {"sk_exp_polynomial", 6, expCoefficients}, library::expLimit},
    PieceRow{pieces(Piece::ExpTail), {}, library::expReduced},
    PieceRow{{}, {"sk_log_polynomial", 4, logCoefficients}, library::logOf},
    PieceRow{pieces(Piece::LogTail), {}, library::logLimited},
    PieceRow{pieces(Piece::LogTail), {}, library::logPlus},
    PieceRow{pieces(Piece::ExpTail, Piece::LogTail), {}, library::power},
    PieceRow{{}, {}, library::reduceLarge},
    PieceRow{pieces(Piece::ReduceLarge), {"sk_wave_polynomial", 4, sinCoefficients, cosCoefficients}, library::wave},
    PieceRow{{}, {"sk_atan_polynomial", 4, atanCoefficients}, library::angle},
};
// clang-format on

Pieces withNeeded(Pieces set) {
  for (std::size_t i = pieceRows.size(); i-- > 0;) {
    if (set >> i & 1U) set |= pieceRows[i].needs;
  }
  return set;
}

std::string basics(Doubles form, Barrier barrier) {
  std::string text;
  if (form == Doubles::Native && barrier == Barrier::Xor) text += library::nativeKeep;
  text += form == Doubles::Native ? library::nativeBasics : library::pairBasics;
  return text.append(library::commonBasics);
}

}  // namespace

std::string doublePieces(Pieces set, Doubles form, Barrier barrier) {
  std::string text = basics(form, barrier);
  set = withNeeded(set);
  for (std::size_t i = 0; i < pieceRows.size(); ++i) {
    if (!(set >> i & 1U)) continue;
    if (!pieceRows[i].polynomial.coefficients.empty())
      text += '\n' + polynomialText(form, pieceRows[i].polynomial);
    text += withConstants(form, pieceRows[i].text);
  }
  return text;
}

}  // namespace sk::assemble
