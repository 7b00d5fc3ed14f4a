// SPDX-License-Identifier: MIT
//
// Errors of functions, by range. The device and the host use the same float arguments; the host computes in
// double, whose own error (1 ulp of double) is negligible.
#include <cmath>
#include <cstdint>
#include <vector>

#include <fmt/format.h>

#include "info/device_info.hpp"
#include "info/functions.sk.hpp"
#include "info/numbers.hpp"

namespace sk_tool {

namespace {

constexpr std::size_t samples = 1 << 15;

enum class Spread { Linear, Logarithmic };

struct Range {
  Spread spread = Spread::Linear;
  double low = 1, high = 1;

  float draw(Numbers& numbers) const {
    return spread == Spread::Linear ? numbers.linear(low, high) : numbers.logarithmic(low, high);
  }
  std::string text() const { return fmt::format("[{:.6g}, {:.6g}]", low, high); }
};

namespace reference {
double sin(double x) { return std::sin(x); }
double cos(double x) { return std::cos(x); }
double tan(double x) { return std::tan(x); }
double asin(double x) { return std::asin(x); }
double acos(double x) { return std::acos(x); }
double atan(double x) { return std::atan(x); }
double sinh(double x) { return std::sinh(x); }
double cosh(double x) { return std::cosh(x); }
double tanh(double x) { return std::tanh(x); }
double asinh(double x) { return std::asinh(x); }
double acosh(double x) { return std::acosh(x); }
double atanh(double x) { return std::atanh(x); }
double exp(double x) { return std::exp(x); }
double exp2(double x) { return std::exp2(x); }
double log(double x) { return std::log(x); }
double log2(double x) { return std::log2(x); }
double log10(double x) { return std::log10(x); }
double log1p(double x) { return std::log1p(x); }
double expm1(double x) { return std::expm1(x); }
double cbrt(double x) { return std::cbrt(x); }
double erf(double x) { return std::erf(x); }
double erfc(double x) { return std::erfc(x); }
double sqrt(double x) { return std::sqrt(x); }
double inversesqrt(double x) { return 1 / std::sqrt(x); }
double fract(double x) { return x - std::floor(x); }
double pow(double x, double y) { return std::pow(x, y); }
double atan2(double y, double x) { return std::atan2(y, x); }
double hypot(double x, double y) { return std::hypot(x, y); }
double mod(double x, double y) { return x - y * std::floor(x / y); }
}  // namespace reference

struct FunctionRow {
  const char* name;
  Function function;
  double (*one)(double);  ///< null: it has two arguments
  double (*two)(double, double);
  Range x, y;
};

const std::vector<FunctionRow>& functionRows() {
  static const std::vector<FunctionRow> table{
#define SK_FUNCTION(name)
#define SK_RANGE(name, spread, low, high) \
  {#name, f_##name, reference::name, nullptr, {Spread::spread, low, high}, {}},
#define SK_FUNCTION2(name)
#define SK_RANGE2(name, spread, low, high, spread2, low2, high2) \
  {#name, f_##name, nullptr, reference::name, {Spread::spread, low, high}, {Spread::spread2, low2, high2}},
#include "info/functions.def"
  };
  return table;
}

Json errorsOf(sk::Device& device, const FunctionRow& row) {
  Numbers numbers(static_cast<unsigned>(&row - functionRows().data()));
  std::vector<float> x(samples);
  std::vector<float> y(samples, 1.0F);
  for (std::size_t i = 0; i < samples; ++i) {
    x[i] = row.x.draw(numbers);
    if (row.two != nullptr) y[i] = row.y.draw(numbers);
  }
  auto a = streamOf(device, x);
  auto b = streamOf(device, y);
  auto r = device.stream<float>(a.shape());
  probes::function.with({.intrinsics = sk::Intrinsics::Fast})(row.function, a, b, r);
  const std::vector<float> got = r.read();
  ErrorStatistics errors;
  for (std::size_t i = 0; i < samples; ++i) {
    errors.add(got[i], row.one != nullptr ? row.one(x[i]) : row.two(x[i], y[i]), x[i]);
  }
  Json json = {{"name", row.name}, {"range", row.x.text()}};
  if (row.two != nullptr) json["range2"] = row.y.text();
  json.update(errors.json());
  return json;
}

}  // namespace

Json probeFunctions(sk::Device& device) {
  Json list = Json::array();
  for (const FunctionRow& row : functionRows()) list.push_back(errorsOf(device, row));
  return list;
}

}  // namespace sk_tool
