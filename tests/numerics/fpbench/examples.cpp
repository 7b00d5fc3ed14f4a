// SPDX-License-Identifier: MIT
#include "fpbench/examples.hpp"

#include <fstream>
#include <sstream>
#include <utility>

#include <quadmath.h>

#include "fpbench.sk.hpp"

namespace fpbench_tests {
namespace {

using Streams = std::vector<sk::Stream<double>>;
using Quads = std::span<const Quad>;

// A literal is the double that it names, as in the kernels.
constexpr Quad q(double x) { return x; }

#define SK_RUN(kernel, ...) [](const Streams& s, sk::Stream<double>& r) { fpbench::kernel(__VA_ARGS__, r); }

std::vector<Range> alike(const char* names, double low, double high) {
  std::vector<Range> ranges;
  for (; *names != 0; ++names) ranges.push_back({std::string(1, *names), low, high});
  return ranges;
}

Quad doppler(Quads x) {
  const Quad speed = q(331.4) + q(0.6) * x[2];
  return (-speed * x[1]) / ((speed + x[0]) * (speed + x[0]));
}

Quad jet(Quads in) {
  const Quad x = in[0], y = in[1], s = x * x + 1, d = (3 * x * x + 2 * y - x) / s;
  return x + ((2 * x * d * (d - 3) + x * x * (4 * d - 6)) * s + 3 * x * x * d + x * x * x + x + 3 * d);
}

Quad kepler2(Quads x) {
  const Quad a = x[0], b = x[1], c = x[2], d = x[3], e = x[4], f = x[5];
  return a * d * (-a + b + c - d + e + f) + b * e * (a - b + c + d - e + f) +
         c * f * (a + b - c + d + e - f) - b * c * d - a * c * e - a * b * f - d * e * f;
}

Quad azimuth(Quads x) {
  const Quad d = x[3] - x[2], y = cosq(x[1]) * sinq(d);
  return atanq(y / (cosq(x[0]) * sinq(x[1]) - sinq(x[0]) * cosq(x[1]) * cosq(d)));
}

/// The sum of factors[i] * (x[i] - centers[i])^2.
Quad squares(Quads x, std::span<const double> factors, std::span<const double> centers) {
  Quad sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    sum += q(factors[i]) * (x[i] - q(centers[i])) * (x[i] - q(centers[i]));
  return sum;
}

Quad hartman3(Quads x) {
  constexpr double factors[4][3] = {{3, 10, 30}, {0.1, 10, 35}, {3, 10, 30}, {0.1, 10, 35}};
  constexpr double centers[4][3] = {
      {0.3689, 0.117, 0.2673}, {0.4699, 0.4387, 0.747}, {0.1091, 0.8732, 0.5547}, {0.03815, 0.5743, 0.8828}};
  constexpr double weights[4] = {1, 1.2, 3, 3.2};
  Quad sum = 0;
  for (int i = 0; i < 4; ++i) sum += q(weights[i]) * expq(-squares(x, factors[i], centers[i]));
  return -sum;
}

Quad hartman6(Quads x) {
  constexpr double factors[4][6] = {{10, 3, 17, 3.5, 1.7, 8},
                                    {0.05, 10, 17, 0.1, 8, 14},
                                    {3, 3.5, 1.7, 10, 17, 8},
                                    {17, 8, 0.05, 10, 0.1, 14}};
  constexpr double centers[4][6] = {{0.1312, 0.1696, 0.5569, 0.0124, 0.8283, 0.5886},
                                    {0.2329, 0.4135, 0.8307, 0.3736, 0.1004, 0.9991},
                                    {0.2348, 0.1451, 0.3522, 0.2883, 0.3047, 0.665},
                                    {0.4047, 0.8828, 0.8732, 0.5743, 0.1091, 0.0381}};
  constexpr double weights[4] = {1, 1.2, 3, 3.2};
  Quad sum = 0;
  for (int i = 0; i < 4; ++i) sum += q(weights[i]) * expq(-squares(x, factors[i], centers[i]));
  return -sum;
}

/// 3 + first / r^2 - factor / 8 * (w r)^2 / (1 - v) - last
Quad turbine(Quads x, Quad first, Quad factor, Quad last) {
  const Quad v = x[0], w = x[1], r = x[2];
  return 3 + first / (r * r) - factor / 8 * (w * w * r * r) / (1 - v) - last;
}

std::vector<Example> makeExamples() {
  const double halfPi = 1.57079632679, pi = 3.14159265;
  const auto kepler = [](const char* names) { return alike(names, 4, 6.36); };
  const std::vector<Range> turbineRanges = {{"v", -4.5, -0.3}, {"w", 0.4, 0.9}, {"q", 3.8, 7.8}};
  return {
      {"carbonGas",
       "carbonGas",
       {{"v", 0.1, 0.5}},
       8.09e-9,
       SK_RUN(carbonGas, s[0]),
       [](Quads x) {
         const Quad n = 1000 / x[0];
         return (q(3.5e7) + q(0.401) * n * n) * (x[0] - 1000 * q(42.7e-6)) - q(1.3806503e-23) * 1000 * 300;
       }},
      {"verhulst",
       "verhulst",
       {{"x", 0.1, 0.3}},
       2.47e-16,
       SK_RUN(verhulst, s[0]),
       [](Quads x) { return 4 * x[0] / (1 + x[0] / q(1.11)); }},
      {"predatorPrey",
       "predatorPrey",
       {{"x", 0.1, 0.3}},
       1.59e-16,
       SK_RUN(predatorPrey, s[0]),
       [](Quads x) {
         const Quad k = x[0] / q(1.11);
         return 4 * x[0] * x[0] / (1 + k * k);
       }},
      {"rigidBody1", "rigidBody1", alike("xyz", -15, 15), 2.95e-13, SK_RUN(rigidBody1, s[0], s[1], s[2]),
       [](Quads x) { return -x[0] * x[1] - 2 * x[1] * x[2] - x[0] - x[2]; }},
      {"rigidBody2", "rigidBody2", alike("xyz", -15, 15), 3.61e-11, SK_RUN(rigidBody2, s[0], s[1], s[2]),
       [](Quads x) { return 2 * x[0] * x[1] * x[2] + 6 * x[2] * x[2] - x[1] * x[0] * x[1] * x[2] - x[1]; }},
      {"doppler1",
       "doppler",
       {{"u", -100, 100}, {"v", 20, 20000}, {"t", -30, 50}},
       1.29e-13,
       SK_RUN(doppler, s[0], s[1], s[2]),
       doppler},
      {"doppler2",
       "doppler",
       {{"u", -125, 125}, {"v", 15, 25000}, {"t", -40, 60}},
       2.29e-13,
       SK_RUN(doppler, s[0], s[1], s[2]),
       doppler},
      {"doppler3",
       "doppler",
       {{"u", -30, 120}, {"v", 320, 20300}, {"t", -50, 30}},
       6.62e-14,
       SK_RUN(doppler, s[0], s[1], s[2]),
       doppler},
      {"turbine1", "turbine1", turbineRanges, 0, SK_RUN(turbine1, s[0], s[1], s[2]),
       [](Quads x) { return turbine(x, 2, 3 - 2 * x[0], q(4.5)); }},
      {"turbine2", "turbine2", turbineRanges, 0, SK_RUN(turbine2, s[0], s[1], s[2]),
       [](Quads x) { return 6 * x[0] - x[0] / 2 * (x[1] * x[1] * x[2] * x[2]) / (1 - x[0]) - q(2.5); }},
      {"turbine3", "turbine3", turbineRanges, 0, SK_RUN(turbine3, s[0], s[1], s[2]),
       [](Quads x) { return turbine(x, -2, 1 + 2 * x[0], q(0.5)); }},
      {"sine",
       "sine",
       {{"x", -halfPi, halfPi}},
       4.43e-16,
       SK_RUN(sine, s[0]),
       [](Quads in) {
         const Quad x = in[0], c = x * x * x;
         return x - c / 6 + c * x * x / 120 - c * c * x / 5040;
       }},
      {"sineOrder3",
       "sineOrder3",
       {{"x", -2, 2}},
       5.94e-16,
       SK_RUN(sineOrder3, s[0]),
       [](Quads x) { return q(0.954929658551372) * x[0] - q(0.12900613773279798) * x[0] * x[0] * x[0]; }},
      {"sqroot",
       "sqroot",
       {{"x", 0, 1}},
       5.02e-16,
       SK_RUN(sqroot, s[0]),
       [](Quads in) {
         const Quad x = in[0];
         return 1 + q(0.5) * x - q(0.125) * x * x + q(0.0625) * x * x * x - q(0.0390625) * x * x * x * x;
       }},
      {"himmelblau", "himmelblau", alike("xy", -5, 5), 0, SK_RUN(himmelblau, s[0], s[1]),
       [](Quads x) {
         const Quad a = x[0] * x[0] + x[1] - 11, b = x[0] + x[1] * x[1] - 7;
         return a * a + b * b;
       }},
      {"jet", "jet", {{"x", -5, 5}, {"y", -20, 5}}, 0, SK_RUN(jet, s[0], s[1]), jet},
      {"t / (t + 1)",
       "quotient",
       {{"t", 0, 999}},
       0,
       SK_RUN(quotient, s[0]),
       [](Quads x) { return x[0] / (x[0] + 1); }},
      {"kepler0", "kepler0", kepler("abcdef"), 7.44e-14, SK_RUN(kepler0, s[0], s[1], s[2], s[3], s[4], s[5]),
       [](Quads x) {
         return x[1] * x[4] + x[2] * x[5] - x[1] * x[2] - x[4] * x[5] +
                x[0] * (-x[0] + x[1] + x[2] - x[3] + x[4] + x[5]);
       }},
      {"kepler1", "kepler1", kepler("abcd"), 2.7e-13, SK_RUN(kepler1, s[0], s[1], s[2], s[3]),
       [](Quads x) {
         const Quad a = x[0], b = x[1], c = x[2], d = x[3];
         return a * d * (-a + b + c - d) + b * (a - b + c + d) + c * (a + b - c + d) - b * c * d - a * c -
                a * b - d;
       }},
      {"kepler2", "kepler2", kepler("abcdef"), 1.57e-12, SK_RUN(kepler2, s[0], s[1], s[2], s[3], s[4], s[5]),
       kepler2},
      {"floudas1",
       "floudas1",
       {{"a", 0, 6}, {"b", 0, 6}, {"c", 1, 5}, {"d", 0, 6}, {"e", 1, 5}, {"f", 0, 10}},
       4.71e-13,
       SK_RUN(floudas1, s[0], s[1], s[2], s[3], s[4], s[5]),
       [](Quads x) {
         constexpr int centers[6] = {2, 2, 1, 4, 1, 4};
         Quad sum = 0;
         for (std::size_t i = 0; i < 6; ++i)
           sum += (i == 0 ? 25 : 1) * (x[i] - centers[i]) * (x[i] - centers[i]);
         return -sum;
       }},
      {"floudas2",
       "floudas2",
       {{"x", 0, 3}, {"y", 0, 4}},
       8.88e-16,
       SK_RUN(floudas2, s[0], s[1]),
       [](Quads x) { return -x[0] - x[1]; }},
      {"floudas3",
       "floudas3",
       {{"x", 0, 2}, {"y", 0, 3}},
       1.32e-14,
       SK_RUN(floudas3, s[0], s[1]),
       [](Quads x) { return -12 * x[0] - 7 * x[1] + x[1] * x[1]; }},
      {"logexp",
       "logexp",
       {{"x", -8, 8}},
       1.525e-15,
       SK_RUN(logexp, s[0]),
       [](Quads x) { return logq(1 + expq(x[0])); }},
      {"sphere",
       "sphere",
       {{"x", -10, 10}, {"q", 0, 10}, {"lat", -1.570796, 1.570796}, {"lon", -pi, pi}},
       8.077e-15,
       SK_RUN(sphere, s[0], s[1], s[2], s[3]),
       [](Quads x) { return x[0] + x[1] * sinq(x[2]) * cosq(x[3]); }},
      {"azimuth",
       "azimuth",
       {{"lat1", 0, 0.4}, {"lat2", 0.5, 1}, {"lon1", 0, pi}, {"lon2", -pi, -0.5}},
       8.778e-15,
       SK_RUN(azimuth, s[0], s[1], s[2], s[3]),
       azimuth},
      {"hartman3", "hartman3", alike("xyz", 0, 1), 1.13e-14, SK_RUN(hartman3, s[0], s[1], s[2]), hartman3},
      {"hartman6", "hartman6", alike("abcdef", 0, 1), 3.78e-15,
       SK_RUN(hartman6, s[0], s[1], s[2], s[3], s[4], s[5]), hartman6},
  };
}

Quad current(Quads x) {
  const Quad pi = q(3.14159265359), im = 2 * pi * x[2] * x[3], d = x[1] * x[1] + im * im;
  const Quad re = x[4] * x[1] / d, ci = -x[4] * im / d;
  return sqrtq(re * re + ci * ci) * cosq(2 * pi * x[2] * x[0] + atanq(ci / re));
}

std::vector<Example> otherExamples() {
  return {
      {"smartRoot",
       "smartRoot",
       {{"c", -2, 1}},
       0,
       SK_RUN(smartRoot, s[0]),
       [](Quads x) {
         const Quad b = q(3.5), root = sqrtq(b * b - 12 * x[0]);
         return b * b - 3 * x[0] > 10 ? 2 * x[0] / (-b - root) : (root - b) / 6;
       }},
      {"cav10",
       "cav10",
       {{"x", 0, 10}},
       0,
       SK_RUN(cav10, s[0]),
       [](Quads x) { return x[0] * x[0] - x[0] >= 0 ? x[0] / 10 : x[0] * x[0] + 2; }},
      {"squareRoot3",
       "squareRoot3",
       {{"x", 0, 10}},
       0,
       SK_RUN(squareRoot3, s[0]),
       [](Quads x) { return x[0] < q(1e-5) ? 1 + x[0] / 2 : sqrtq(1 + x[0]); }},
      {"triangle",
       "triangle",
       {{"a", 9, 9}, {"b", 4.71, 4.89}, {"c", 4.71, 4.89}},
       0,
       SK_RUN(triangle, s[0], s[1], s[2]),
       [](Quads x) {
         const Quad h = (x[0] + x[1] + x[2]) / 2;
         return sqrtq(h * (h - x[0]) * (h - x[1]) * (h - x[2]));
       }},
      {"bspline3",
       "bspline3",
       {{"u", 0, 1}},
       0,
       SK_RUN(bspline3, s[0]),
       [](Quads x) { return -(x[0] * x[0] * x[0]) / 6; }},
      {"polarToCarthesian, x",
       "polarX",
       {{"radius", 1, 10}, {"theta", 0, 360}},
       0,
       SK_RUN(polarX, s[0], s[1]),
       [](Quads x) { return x[0] * cosq(x[1] * (q(3.14159265359) / 180)); }},
      {"instantaneousCurrent",
       "current",
       {{"t", 0, 300},
        {"resistance", 1, 50},
        {"frequency", 1, 100},
        {"inductance", 0.001, 0.004},
        {"voltage", 1, 12}},
       0,
       SK_RUN(current, s[0], s[1], s[2], s[3], s[4]),
       current},
      {"matrixDeterminant", "determinant9", alike("abcdefghi", -10, 10), 0,
       SK_RUN(determinant9, s[0], s[1], s[2], s[3], s[4], s[5], s[6], s[7], s[8]),
       [](Quads m) {
         return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) +
                m[2] * (m[3] * m[7] - m[4] * m[6]);
       }},
      {"delta", "delta", alike("abcdef", 4, 6.3504), 0, SK_RUN(delta, s[0], s[1], s[2], s[3], s[4], s[5]),
       kepler2},
      {"sqrt_add",
       "sqrtAdd",
       {{"x", 1, 1000}},
       0,
       SK_RUN(sqrtAdd, s[0]),
       [](Quads x) { return sqrtq(x[0] + 1) - sqrtq(x[0]); }},
      {"exp1x",
       "exp1x",
       {{"x", 0.01, 0.5}},
       0,
       SK_RUN(exp1x, s[0]),
       [](Quads x) { return expm1q(x[0]) / x[0]; }},
      {"exp1x_log",
       "exp1xLog",
       {{"x", 0.01, 0.5}},
       0,
       SK_RUN(exp1xLog, s[0]),
       [](Quads x) { return expm1q(x[0]) / x[0]; }},
      {"x_by_xy", "xByXy", alike("xy", 1, 4), 0, SK_RUN(xByXy, s[0], s[1]),
       [](Quads x) { return x[0] / (x[0] + x[1]); }},
      {"nonlin2", "nonlin2", alike("xy", 1.001, 2), 0, SK_RUN(nonlin2, s[0], s[1]),
       [](Quads x) { return 1 / (x[0] * x[1] + 1); }},
      {"i4",
       "i4",
       {{"x", 0.1, 10}, {"y", -5, 5}},
       0,
       SK_RUN(i4, s[0], s[1]),
       [](Quads x) { return sqrtq(x[0] + x[1] * x[1]); }},
      {"i6",
       "i6",
       {{"x", 0.1, 10}, {"y", -5, 5}},
       0,
       SK_RUN(i6, s[0], s[1]),
       [](Quads x) { return sinq(x[0] * x[1]); }},
  };
}

#undef SK_RUN

}  // namespace

const std::vector<Example>& examples() {
  static const std::vector<Example> all = [] {
    std::vector<Example> list = makeExamples();
    for (Example& example : otherExamples()) list.push_back(std::move(example));
    return list;
  }();
  return all;
}

std::string contents(const std::string& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

}  // namespace fpbench_tests
