// SPDX-License-Identifier: MIT
//
// Counts wrong results of error-free sums and products, with each barrier between the compiler and these
// operations (sk/arithmetic.hpp), and without one.
#include <string>
#include <vector>

#include "info/device_info.hpp"
#include "info/numbers.hpp"
#include "info/raw_kernel.hpp"
#include "probe/probe.hpp"
#include "sk/error.hpp"

namespace sk_tool {

namespace {

constexpr std::size_t pairCount = 1 << 14;

const RawKernel& twoSumAndProduct() {
  static const RawKernel kernel = RawKernel::of<sk::float2, sk::float4>(
      "TwoSum and TwoProd",
      "void f(vec2 x, out vec4 r) {\n"
      "  float a = x.x, b = x.y;\n"
      "  sk_precise float s = sk_keep(a + b);\n"
      "  sk_precise float c = sk_keep(s - a);\n"
      "  sk_precise float d = sk_keep(s - c);\n"
      "  sk_precise float e = sk_keep(a - d);\n"
      "  sk_precise float g = sk_keep(b - c);\n"
      "  sk_precise float lost = sk_keep(e + g);\n"
      "  sk_precise float p = sk_keep(a * b);\n"
      "  float ah = uintBitsToFloat(floatBitsToUint(a) & 0xfffff000u);\n"
      "  float bh = uintBitsToFloat(floatBitsToUint(b) & 0xfffff000u);\n"
      "  sk_precise float al = sk_keep(a - ah);\n"
      "  sk_precise float bl = sk_keep(b - bh);\n"
      "  sk_precise float h = sk_keep(ah * bh);\n"
      "  sk_precise float i = sk_keep(h - p);\n"
      "  sk_precise float j = sk_keep(ah * bl);\n"
      "  sk_precise float k = sk_keep(i + j);\n"
      "  sk_precise float l = sk_keep(al * bh);\n"
      "  sk_precise float m = sk_keep(k + l);\n"
      "  sk_precise float n = sk_keep(al * bl);\n"
      "  sk_precise float rest = sk_keep(m + n);\n"
      "  r = vec4(s, lost, p, rest);\n"
      "}\n");
  return kernel;
}

/// The fractions of wrong sums and products; "not in the language" if the device does not have the barrier.
Json trial(const sk::Device& like, const std::string& barrier) {
  sk::DeviceOptions options = optionsOf(like);
  options.barrier = barrier;
  try {
    sk::Device device(options);
    const std::vector<sk::float2> pairs = sk::trialPairs(pairCount);
    const sk::Shape shape = squareOf(pairCount);
    auto x = device.stream<sk::float2>(shape);
    auto r = device.stream<sk::float4>(shape);
    x.write(pairs);
    twoSumAndProduct()(x, r);
    const std::vector<sk::float4> got = r.read();
    std::size_t sums = 0;
    std::size_t products = 0;
    for (std::size_t i = 0; i < pairCount; ++i) {
      const sk::float4 exact = sk::exactSumAndProduct(pairs[i]);
      sums += got[i].x != exact.x || got[i].y != exact.y;
      products += got[i].z != exact.z || got[i].w != exact.w;
    }
    const auto share = [](std::size_t wrong) { return rounded(static_cast<double>(wrong) / pairCount); };
    return {{"wrong_sums", share(sums)}, {"wrong_products", share(products)}};
  } catch (const sk::Error&) {
    return "not in the language";
  }
}

bool holds(const Json& trial) {
  return trial.is_object() && trial["wrong_sums"] == 0.0 && trial["wrong_products"] == 0.0;
}

}  // namespace

Json probeExactSums(sk::Device& device) {
  Json json = {{"pairs", pairCount},
               {"none", trial(device, "none")},
               {"xor", trial(device, "xor")},
               {"precise", trial(device, "precise")}};
  json["taken"] = holds(json["precise"]) ? "precise" : holds(json["xor"]) ? "xor" : "none";
  return json;
}

}  // namespace sk_tool
