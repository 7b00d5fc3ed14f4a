// SPDX-License-Identifier: MIT
//
// The five operations that IEEE 754 rounds correctly, as the device does them; and what it makes of a * b + c.
#include <cmath>
#include <string>
#include <vector>

#include "info/error_statistics.hpp"
#include "info/numbers.hpp"
#include "info/operations.sk.hpp"
#include "info/probes.hpp"
#include "info/raw_kernel.hpp"
#include "sk/error.hpp"

namespace sk_tool {

namespace {

constexpr std::size_t count = 1 << 16;
constexpr sk::CallOptions fast{.intrinsics = sk::Intrinsics::Fast};

/// Numbers of all magnitudes whose products, quotients and sums are normal ones.
std::vector<float> operands(unsigned seed) {
  Numbers numbers(seed);
  std::vector<float> made(count);
  for (float& x : made) x = numbers.anySign(numbers.logarithmic(0x1p-30, 0x1p30));
  return made;
}

/// How results of an operation differ from those of the host, which computes them in double.
template <class Operation>
Json errorsOf(const char* name, const std::vector<float>& got, const std::vector<float>& a,
              const std::vector<float>& b, const Operation& operation) {
  ErrorStatistics errors;
  std::size_t right = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double reference = operation(double{a[i]}, double{b[i]});
    errors.add(got[i], reference, a[i]);
    right += got[i] == static_cast<float>(reference);
  }
  Json json = {{"name", name}};
  json.update(errors.json());
  json["correctly_rounded"] = right == count;
  return json;
}

/// Factors whose product is not a float, and its nearest float with the sign turned: what is left of
/// a * b + c is 0, or, where the product is not rounded, what rounding would have lost.
struct Products {
  std::vector<float> a, b, c;

  Products() {
    Numbers numbers(3);
    for (std::size_t i = 0; i < 4096; ++i) {
      a.push_back(numbers.linear(1, 2));
      b.push_back(numbers.linear(1, 2));
      c.push_back(-(a.back() * b.back()));
    }
  }
  /// "fused", "rounded twice" or how many are what.
  std::string judge(const std::vector<float>& got) const {
    std::size_t fused = 0;
    std::size_t twice = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      const auto lost = static_cast<float>(double{a[i]} * double{b[i]} + double{c[i]});
      fused += got[i] == lost;
      twice += got[i] == 0;
    }
    if (fused == a.size()) return "fused";
    if (twice == a.size()) return "rounded twice";
    return std::to_string(fused) + " of " + std::to_string(a.size()) + " fused";
  }
};

/// GLSL's own fma, where the language has it; skc writes a * b + c for it.
std::string judgeOwnFma(sk::Device& device, const Products& given) {
  static const RawKernel fma =
      RawKernel::of<sk::float3, float>("fma", "void f(vec3 x, out float r) { r = fma(x.x, x.y, x.z); }\n");
  std::vector<sk::float3> triples;
  for (std::size_t i = 0; i < given.a.size(); ++i) triples.push_back({given.a[i], given.b[i], given.c[i]});
  const sk::Shape shape = squareOf(triples.size());
  auto x = device.stream<sk::float3>(shape);
  auto r = device.stream<float>(shape);
  x.write(triples);
  try {
    fma(x, r);
  } catch (const sk::Error&) {
    return "not in the language";
  }
  return given.judge(r.read());
}

}  // namespace

Json probeOperations(sk::Device& device) {
  const std::vector<float> a = operands(1);
  const std::vector<float> b = operands(2);
  std::vector<float> magnitudes = a;
  for (float& x : magnitudes) x = std::fabs(x);
  auto x = streamOf(device, a);
  auto y = streamOf(device, b);
  auto m = streamOf(device, magnitudes);
  std::vector<sk::Stream<float>> results;
  for (int i = 0; i < 5; ++i) results.push_back(device.stream<float>(x.shape()));
  const auto run = probes::arithmetic.with(fast);
  Json list = Json::array();
  run(x, y, results[0], results[1], results[2], results[3], results[4]);
  list.push_back(errorsOf("+", results[0].read(), a, b, [](double p, double q) { return p + q; }));
  list.push_back(errorsOf("-", results[1].read(), a, b, [](double p, double q) { return p - q; }));
  list.push_back(errorsOf("*", results[2].read(), a, b, [](double p, double q) { return p * q; }));
  list.push_back(errorsOf("/", results[3].read(), a, b, [](double p, double q) { return p / q; }));
  run(m, y, results[0], results[1], results[2], results[3], results[4]);
  list.push_back(
      errorsOf("sqrt", results[4].read(), magnitudes, b, [](double p, double) { return std::sqrt(p); }));
  return list;
}

Json probeContraction(sk::Device& device) {
  const Products given;
  auto a = streamOf(device, given.a);
  auto b = streamOf(device, given.b);
  auto c = streamOf(device, given.c);
  auto r = device.stream<float>(a.shape());
  Json json;
  probes::multiplyAdd.with(fast)(a, b, c, r);
  json["a * b + c"] = given.judge(r.read());
  probes::fusedMultiplyAdd.with(fast)(a, b, c, r);
  json["fma of a kernel"] = given.judge(r.read());
  if (!isNative(device)) json["fma of GLSL"] = judgeOwnFma(device, given);
  return json;
}

}  // namespace sk_tool
