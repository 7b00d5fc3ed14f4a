// SPDX-License-Identifier: MIT
//
// A polynomial of degree 9 in each precision, and natively with fused multiply-adds: at harmless arguments,
// and near a root of multiplicity 9, where the result is far below the rounding errors of its terms.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "accuracy/accuracy.sk.hpp"
#include "accuracy/experiment.hpp"
#include "accuracy/programs.hpp"
#include "info/numbers.hpp"

namespace sk_tool {

namespace {

using Coefficients = std::array<float, 10>;

struct Case {
  const char* name;
  const char* about;
  Coefficients coefficients;
  double low, high;
  /// The right value, nearly to the last bit of a double: doubles must not be judged by Horner's rule in doubles.
  double (*right)(const Coefficients& coefficients, double x);
};

/// Evaluates a polynomial whose terms do not cancel, by Horner's rule in long double.
double byHorner(const Coefficients& coefficients, double x) {
  long double value = 0;
  for (std::size_t k = coefficients.size(); k-- > 0;) value = value * x + coefficients[k];
  return static_cast<double>(value);
}

/// The difference of floats is exact in double.
double byRoot(const Coefficients&, double x) { return std::pow(x - 2, 9); }

constexpr Case cases[] = {
    {"exponential",
     "x in [-1, 1], of the Taylor series of exp",
     {1, 1, 1.F / 2, 1.F / 6, 1.F / 24, 1.F / 120, 1.F / 720, 1.F / 5040, 1.F / 40320, 1.F / 362880},
     -1,
     1,
     byHorner},
    {"root",
     "x in [1.95, 2.05], of (x - 2)^9",
     {-512, 2304, -4608, 5376, -4032, 2016, -672, 144, -18, 1},
     1.95,
     2.05,
     byRoot},
};

struct PolynomialMode {
  const char* name;
  sk::Precision precision;
  double unit;  ///< relative error of an operation
  sk::Contraction contraction = sk::Contraction::Exact;
};

constexpr PolynomialMode polynomialModes[] = {
    {"single", sk::Precision::Single, 0x1p-24},
    {"contracted", sk::Precision::Single, 0x1p-24, sk::Contraction::Fast},
    {"extended", sk::Precision::Extended, 0x1p-44},
    {"double", sk::Precision::Double, 0x1p-53},
    {"half", sk::Precision::Half, 0x1p-11},
};

/// GL devices ignore contraction.
bool isOf(const sk::Device& device, const PolynomialMode& mode) {
  return mode.contraction == sk::Contraction::Exact || device.shadingLanguage().empty();
}

/// Bound of the error of Horner's rule in ulp of the results: 2 n + 1 roundings of the terms' magnitudes
/// (Higham, Accuracy and Stability of Numerical Algorithms, section 5.1), and the rounding of the result to
/// float.
double boundOf(const PolynomialMode& mode, const Case& polynomial, const std::vector<float>& x,
               const std::vector<double>& reference) {
  double bound = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    double magnitude = 0;
    for (std::size_t k = polynomial.coefficients.size(); k-- > 0;) {
      magnitude = magnitude * std::fabs(x[i]) + std::fabs(polynomial.coefficients[k]);
    }
    bound = std::max(bound, 0.5 + 19 * mode.unit * magnitude / ulpOf(reference[i]));
  }
  return bound;
}

Experiment measureCase(sk::Device& device, const Measurement& measurement, const Case& polynomial) {
  Numbers numbers(inputSeed);
  std::vector<float> x(measurement.size);
  for (float& value : x) value = numbers.linear(polynomial.low, polynomial.high);
  const sk::Shape shape{static_cast<std::int64_t>(x.size())};

  std::vector<double> reference(x.size());
  std::ranges::transform(x, reference.begin(),
                         [&](float value) { return polynomial.right(polynomial.coefficients, value); });

  auto xs = device.stream<float>(shape);
  auto rs = device.stream<float>(shape);
  xs.write(x);
  std::vector<Mode> candidates;
  for (const PolynomialMode& mode : polynomialModes) {
    if (!isOf(device, mode)) continue;
    candidates.push_back({mode.name, [&] {
                            return Trial{[&] {
                                           accuracy::polynomial.with({.precision = mode.precision,
                                                                      .contraction = mode.contraction})(
                                               polynomial.coefficients, xs, rs);
                                         },
                                         [&] {
                                           Grade grade = gradeElements(rs.read(), reference, {{"x", &x}});
                                           if (mode.precision == sk::Precision::Half)
                                             return grade;  // it has another range
                                           grade.bound = boundOf(mode, polynomial, x, reference);
                                           grade.isWithinBound = grade.metrics[1].value <= *grade.bound;
                                           return grade;
                                         }};
                          }});
  }
  return {.program = "polynomial",
          .data = polynomial.name,
          .about = fmt::format("{} numbers {}", x.size(), polynomial.about),
          .bounded = "max ulp",
          .rows = compareModes(device, candidates, measurement.rounds)};
}

}  // namespace

std::vector<Experiment> measurePolynomial(sk::Device& device, const Measurement& measurement) {
  std::vector<Experiment> experiments;
  for (const Case& polynomial : cases) experiments.push_back(measureCase(device, measurement, polynomial));
  return experiments;
}

}  // namespace sk_tool
