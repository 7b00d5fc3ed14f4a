// SPDX-License-Identifier: MIT
#include "assemble/glsl/double_polynomials.hpp"

#include <bit>
#include <cctype>
#include <charconv>
#include <cstdint>

#include <fmt/format.h>

namespace sk::assemble {
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
    lines +=
        fmt::format("  p = sk_step(p, x, {});\n", chosen(polynomial, i, pair, "sk_choose(other, {}, {})"));
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

}  // namespace sk::assemble
