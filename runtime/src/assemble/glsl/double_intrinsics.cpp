// SPDX-License-Identifier: MIT
//
// The table of functions, and their pieces, which use only functions of doubles.hpp, so that one text serves both
// representations, except for the few functions that use bits. `D(x)` is a constant. NaN is tested first, because devices
// compare it differently. Coefficients are of minimax polynomials for the error of the final function (Remez' exchange in
// 60 digits, then rounded to double), which is at most 2^-57. Range reductions must subtract exactly as written: sk_sum()
// is sk_add() with a barrier.
// Selects the definitions of doubles for a representation (doubles.glsl).
#include "assemble/glsl/double_intrinsics.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <string_view>

#include <fmt/format.h>

#include "glsl_text/double_intrinsics.hpp"
#include "glsl_text/double_pieces.hpp"
#include "glsl_text/doubles.hpp"

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

// erf(x) / x for |x| <= 3/4, in x^2, and (a + 3) exp(a^2) erfc(a) for 3/4 <= a <= 27.3, in (a - 3) / (a + 3)
constexpr double erfCoefficients[] = {
    1.1283791670955126,     -0.37612638903183715,    0.11283791670952596,    -0.026866170644428485,
    0.0052239776154205386,  -0.00085483261887597524, 0.00012055289567541706, -1.4924196305569617e-05,
    1.6430684179741549e-06, -1.5940066854661717e-07, 1.1472499701094691e-08};
constexpr double erfcCoefficients[] = {
    1.0740069070883398,      -0.88339445316988374,    0.59022835710410182,    -0.31046726190054758,
    0.11952776128728719,     -0.026827234625346214,   -0.0012124166268258853, 0.0030340620183166066,
    -0.00054830970381621177, -0.00027677802855757182, 0.00010756166244996292, 3.0399291464730035e-05,
    -1.7471963258409251e-05, -4.7533326821420759e-06, 2.7718270460712723e-06, 1.0070921519559962e-06,
    -4.2518903987141428e-07, -2.3985135613298567e-07, 7.1077086500964285e-08, 4.6189584288969557e-08,
    -1.669627716629178e-08};

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
    PieceRow{{}, {"sk_erf_polynomial", 8, erfCoefficients}, ""},
    PieceRow{pieces(Piece::ExpReduced), {"sk_erfc_polynomial", 15, erfcCoefficients, {}, true}, library::errorTail},
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

namespace {

/// Formats with a decimal point, which makes it a float.
std::string floatText(double value) { return fmt::format("{:#.9g}", static_cast<float>(value)); }

/// A coefficient, or the choice between two by `form`, each formatted by `text`.
template <class Text>
std::string chosen(const Polynomial& polynomial, std::size_t i, const Text& text,
                   fmt::format_string<std::string, const std::string&> form = "(other ? {} : {})") {
  const std::string one = text(polynomial.coefficients[i]);
  return polynomial.others.empty() ? one : fmt::format(form, text(polynomial.others[i]), one);
}

std::string nativeText(const Polynomial& polynomial) {
  const auto text = [](double value) { return fmt::format("{:#.17g}lf", value); };
  std::size_t i = polynomial.coefficients.size() - 1;
  std::string lines = fmt::format("  double y = sk_value(x), p = {};\n", chosen(polynomial, i, text));
  while (i-- > 0) lines += fmt::format("  p = p * y + {};\n", chosen(polynomial, i, text));
  return lines + "  return sk_of(p);\n";
}

std::string pairText(const Polynomial& polynomial) {
  const auto pair = [](double value) { return doubleConstant(Doubles::Pairs, value); };
  std::size_t i = polynomial.coefficients.size() - 1;
  std::string lines = fmt::format("  float t = {};\n", chosen(polynomial, i, floatText));
  while (i-- > polynomial.exact)
    lines += fmt::format("  t = t * x.hi + {};\n", chosen(polynomial, i, floatText));
  lines += "  sk_double p = sk_to_double(t);\n";
  for (++i; i-- > 0;)
    lines += fmt::format(
        "  p = {};\n",
        fmt::format(fmt::runtime(polynomial.isUneven ? "sk_add(sk_mul(p, x), {})" : "sk_step(p, x, {})"),
                    chosen(polynomial, i, pair, "sk_choose(other, {}, {})")));
  return lines + "  return p;\n";
}

}  // namespace

std::string doubleConstant(Doubles form, double value) {
  if (form == Doubles::Native) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    return fmt::format("sk_double(uvec2(0x{:08x}u, 0x{:08x}u))", bits & 0xffffffffU, bits >> 32);
  }
  const auto high = static_cast<float>(value);
  return fmt::format("sk_double({}, {})", floatText(high), floatText(value - double{high}));
}

std::string withConstants(Doubles form, std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool begins =
        text[i] == 'D' && text.substr(i, 2) == "D(" &&
        (i == 0 || !(std::isalnum(static_cast<unsigned char>(text[i - 1])) || text[i - 1] == '_'));
    if (!begins) {
      result += text[i];
      continue;
    }
    const std::size_t end = text.find(')', i);
    double value = 0;
    std::from_chars(text.data() + i + 2, text.data() + end, value);
    result += doubleConstant(form, value);
    i = end;
  }
  return result;
}

std::string polynomialText(Doubles form, const Polynomial& polynomial) {
  return fmt::format("sk_double {}(sk_double x{}) {{\n{}}}\n", polynomial.name,
                     polynomial.others.empty() ? "" : ", bool other",
                     form == Doubles::Native ? nativeText(polynomial) : pairText(polynomial));
}

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
    Row{{}, library::hypot},
    Row{pieces(Piece::LogPlus), library::log1p},
    Row{pieces(Piece::ExpReduced), library::expm1},
    Row{{}, library::cbrt},
    Row{pieces(Piece::ErrorNear0, Piece::ErrorTail), library::erf},
    Row{pieces(Piece::ErrorNear0, Piece::ErrorTail), library::erfc},
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

std::string_view doubleExtensions(Doubles form) {
  return form == Doubles::Native ? "#extension GL_ARB_gpu_shader_fp64 : require\n" : "";
}

std::string doubleDefinitions(Doubles form, Barrier own) {
  if (form == Doubles::Pairs) return std::string(library::pair).append(library::common);
  const std::string_view definition =
      own == Barrier::Precise ? "#define sk_written precise\n" : "#define sk_written\n";
  return std::string(definition).append(library::native).append(library::common);
}

}  // namespace sk::assemble
