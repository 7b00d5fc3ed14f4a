// SPDX-License-Identifier: MIT
//
// sgemm.sk against three plain loops in double. Each product is rounded once, and each element has as many sums as products:
// one adds the two products of a block, one adds each block; blocks at odd extents are padded with zeros.
#include "programs/sgemm.sk.hpp"

#include <algorithm>

#include "programs/bounds.hpp"
#include "support/devices.hpp"

using namespace run_tests;
using sk::float4;

namespace {

/// A matrix as blocks of 2 x 2.
sk::Stream<float4> packed(sk::Device& device, std::int64_t height, std::int64_t width,
                          const std::vector<float>& a) {
  auto blocks = device.stream<float4>({(height + 1) / 2, (width + 1) / 2});
  sgemm::pack(streamOf<float>(device, {height, width}, a), blocks);
  return blocks;
}

/// c += a b in blocks; each pass takes `strip` blocks of the inner dimension.
void multiplyAdd(const sk::Stream<float4>& a, const sk::Stream<float4>& b, sk::Stream<float4>& c, int strip) {
  const auto inner = static_cast<int>(a.shape()[1]);
  for (int begin = 0; begin < inner; begin += strip) {
    sgemm::multiply(begin, std::min(begin + strip, inner), a, b, c, c);
  }
}

struct Row {
  std::int64_t height, inner, width;
  int strip;
};

}  // namespace

TEST_CASE("sgemm: matrices of even and odd extents, in strips") {
  onDrawnLayouts([](sk::Device& device) {
    for (const Row& row : {Row{1, 1, 1, 1},
                           {1, 9, 1, 2},
                           {5, 1, 4, 8},
                           {17, 31, 13, 4},
                           {32, 32, 32, 16},
                           {3, 700, 2, 64},
                           {67, 20, 61, 7}}) {
      INFO(row.height << " x " << row.inner << " times " << row.inner << " x " << row.width);
      const auto a = noises(row.height * row.inner, 1), b = noises(row.inner * row.width, 2),
                 c = noises(row.height * row.width, 3);
      auto blocks = packed(device, row.height, row.width, c);
      multiplyAdd(packed(device, row.height, row.inner, a), packed(device, row.inner, row.width, b), blocks,
                  row.strip);
      auto result = device.stream<float>({row.height, row.width});
      sgemm::unpack(blocks, result);
      CHECK(outside(result.read(), [&](std::size_t i) {
              const auto n = static_cast<std::size_t>(row.inner), w = static_cast<std::size_t>(row.width);
              double sum = c[i], size = std::fabs(c[i]);
              for (std::size_t k = 0; k < n; ++k) {
                const double product = double{a[i / w * n + k]} * b[k * w + i % w];
                sum += product;
                size += std::fabs(product);
              }
              return Bounded{sum, roundings(static_cast<double>(n) + 2) * size};
            }) == "");
    }
  });
}
