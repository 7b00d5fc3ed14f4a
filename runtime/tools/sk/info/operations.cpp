// SPDX-License-Identifier: MIT
//
// The device's results for operations that IEEE 754 rounds correctly, and for a * b + c.
#include <cmath>
#include <string>
#include <vector>

#include "info/device_info.hpp"
#include "info/numbers.hpp"
#include "info/operations.sk.hpp"
#include "info/raw_kernel.hpp"
#include "sk/error.hpp"

namespace sk_tool {

namespace {

constexpr std::size_t operandCount = 1 << 16;
constexpr sk::CallOptions fast{.intrinsics = sk::Intrinsics::Fast};

/// Numbers of all magnitudes whose products, quotients and sums are normal.
std::vector<float> floatOperands(unsigned seed) {
  Numbers numbers(seed);
  std::vector<float> operands(operandCount);
  for (float& x : operands) x = numbers.anySign(numbers.logarithmic(0x1p-30, 0x1p30));
  return operands;
}

/// The errors of an operation's results relative to `reference(i)`, which the host computes in double.
template <class Reference>
Json errorsOf(const char* name, const std::vector<float>& got, const std::vector<float>& first,
              const Reference& reference) {
  ErrorStatistics errors;
  std::size_t right = 0;
  for (std::size_t i = 0; i < operandCount; ++i) {
    const double exact = reference(i);
    errors.add(got[i], exact, first[i]);
    right += got[i] == static_cast<float>(exact);
  }
  Json json = {{"name", name}};
  json.update(errors.json());
  json["correctly_rounded"] = right == operandCount;
  return json;
}

/// Factors whose product is not a float, and its nearest float, negated: a * b + c is 0 or, if the product is
/// not rounded, the rounding error of the product.
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
  /// "fused", "rounded twice", or the counts of each.
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

/// Tests GLSL's own fma, if the language has it; skc generates a * b + c for it.
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
  const std::vector<float> a = floatOperands(1);
  const std::vector<float> b = floatOperands(2);
  std::vector<float> p = a;  // without the sign, hence without cancellation
  std::vector<float> q = b;
  for (float& x : p) x = std::fabs(x);
  for (float& x : q) x = std::fabs(x);
  auto x = streamOf(device, a);
  auto y = streamOf(device, b);
  auto u = streamOf(device, p);
  auto v = streamOf(device, q);
  std::vector<sk::Stream<float>> r;
  for (int i = 0; i < 5; ++i) r.push_back(device.stream<float>(x.shape()));
  const auto run = probes::arithmetic.with(fast);
  Json list = Json::array();
  run(x, y, r[0], r[1], r[2], r[3], r[4]);
  list.push_back(errorsOf("+", r[0].read(), a, [&](std::size_t i) { return double{a[i]} + b[i]; }));
  list.push_back(errorsOf("-", r[1].read(), a, [&](std::size_t i) { return double{a[i]} - b[i]; }));
  list.push_back(errorsOf("*", r[2].read(), a, [&](std::size_t i) { return double{a[i]} * b[i]; }));
  list.push_back(errorsOf("/", r[3].read(), a, [&](std::size_t i) { return double{a[i]} / b[i]; }));
  run(u, v, r[0], r[1], r[2], r[3], r[4]);
  list.push_back(errorsOf("sqrt", r[4].read(), p, [&](std::size_t i) { return std::sqrt(double{p[i]}); }));
  probes::fusedMultiplyAdd.with(fast)(u, v, u, r[0]);
  list.push_back(errorsOf("fma", r[0].read(), p, [&](std::size_t i) { return double{p[i]} * q[i] + p[i]; }));
  return list;
}

Json probeContraction(sk::Device& device) {
  const Products given;
  sk::CallOptions free = fast;  // as the driver likes; native code would fuse where it is asked to
  if (!isNative(device)) free.contraction = sk::Contraction::Fast;
  auto a = streamOf(device, given.a);
  auto b = streamOf(device, given.b);
  auto c = streamOf(device, given.c);
  auto r = device.stream<float>(a.shape());
  Json json;
  probes::multiplyAdd.with(free)(a, b, c, r);
  json["a * b + c"] = given.judge(r.read());
  probes::fusedMultiplyAdd.with(free)(a, b, c, r);
  json["fma of a kernel"] = given.judge(r.read());
  if (!isNative(device)) json["fma of GLSL"] = judgeOwnFma(device, given);
  return json;
}

Json probeOwnOperations(sk::Device& device) {
  Numbers numbers(4);
  std::vector<float> a;
  for (std::size_t i = 0; i < 4096; ++i) a.push_back(numbers.linear(1, 100));
  const auto x = streamOf(device, a);
  auto r = device.stream<sk::float4>(x.shape());
  const auto differ = [&](sk::Contraction contraction) {
    probes::combined.with({.contraction = contraction})(x, r);
    const std::vector<sk::float4> got = r.read();
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      volatile float tenth = a[i] * 0.1F, third = a[i] * 0.3F, sum = a[i] + 1e6F;
      wrong += (got[i].x != tenth * 10) + (got[i].y != third * 0.7F) + (got[i].z != sum + 3.3F) +
               (got[i].w != sum - 1e6F);
    }
    return static_cast<double>(wrong) / static_cast<double>(4 * a.size());
  };
  const sk::Arithmetic& arithmetic = device.arithmetic();
  const sk::Barrier barrier = arithmetic.asWritten ? sk::Barrier::None : arithmetic.barrier;
  return {{"differ_exact", differ(sk::Contraction::Exact)},
          {"differ_fast", differ(sk::Contraction::Fast)},
          {"by", barrier == sk::Barrier::Precise ? "precise"
                 : barrier == sk::Barrier::Xor   ? "xor"
                                                 : "none"}};
}

}  // namespace sk_tool
