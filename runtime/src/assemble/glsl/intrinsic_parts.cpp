// SPDX-License-Identifier: MIT
//
// Coefficients of sin, cos, tan, exp, log, sinh, tanh, acosh and atanh are from Cephes (Moshier, 1992); the
// others are our own minimax polynomials. Range reductions, and the logarithm of a power, must subtract
// exactly as written (exact_sums.hpp); everything else may be contracted or slightly reordered.
#include "assemble/glsl/intrinsic_parts.hpp"

#include <array>

#include "glsl_text/intrinsic_parts.hpp"

namespace sk::assemble {
namespace {

struct Row {
  Parts needs;
  std::string_view text;
};

// clang-format off
constexpr std::array<Row, partCount> rows = {{
    {{}, library::toggleSign},
    {{}, library::scale},
    {{}, library::mantissa},
    {{}, library::logLimit},
    {{}, library::logTail},
    {parts(Part::Mantissa, Part::LogLimit, Part::LogTail), library::log},
    {parts(Part::Scale), library::expScaled},
    {{}, library::exp2Part},
    {{}, library::cut},
    {parts(Part::Mantissa, Part::Scale, Part::Exp2Part, Part::Cut), library::power},
    {{}, library::productHigh},
    {parts(Part::ProductHigh), library::reduceLarge},
    {parts(Part::ReduceLarge), library::reduce},
    {parts(Part::Reduce), library::wave},
    {{}, library::asinPart},
    {{}, library::atanPart},
    {{}, library::order},
    {parts(Part::Order), library::min},
    {parts(Part::Order), library::max},
    {{}, library::saturate},
    {parts(Part::Scale, Part::WithSign), library::fmod},
    {{}, library::lengthScale},
}};
// clang-format on

}  // namespace

Parts withNeeded(Parts set) {
  for (unsigned i = partCount; i-- > 0;) {
    if (set >> i & 1u) set |= rows[i].needs;
  }
  return set;
}

bool useExactFloats(Parts set) {
  for (unsigned i = 0; i < partCount; ++i) {
    if ((set >> i & 1u) && rows[i].text.find("sk_keep") != std::string_view::npos) return true;
  }
  return false;
}

std::string_view text(Part part) { return rows[static_cast<std::size_t>(part)].text; }

}  // namespace sk::assemble
