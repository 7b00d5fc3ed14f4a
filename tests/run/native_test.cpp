// SPDX-License-Identifier: MIT
//
// Promises: native code needs no GL; the reference computes in double and takes the same calls. tests/numerics tests
// arithmetic at its extremes.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include <sys/resource.h>
#include <unistd.h>

#include <catch2/catch.hpp>

#include "native.sk.hpp"
#include "sk/narrow.hpp"
#include "sk/native/parallel.hpp"
#include "sk/sk.hpp"
#include "support/devices.hpp"

namespace run_tests {
namespace {

using namespace native_code;

template <class T>
sk::Stream<T> streamOf(sk::Device& device, const std::vector<T>& values) {
  auto stream = device.stream<T>({static_cast<std::int64_t>(values.size())});
  stream.write(values);
  return stream;
}

TEST_CASE("a byte that is not 0 is a bool that is true") {
  sk::Device native = sk::Device::native();
  auto stream = native.stream<bool>({4});
  stream.write(std::vector<std::uint8_t>{0, 1, 7, 255});
  CHECK(stream.read() == std::vector<std::uint8_t>{0, 1, 1, 1});
}

TEST_CASE("the native device says what it is") {
  sk::Device device = sk::Device::native();
  CHECK(device.name() == "native");
  CHECK(device.profile() == "native");
  CHECK(device.isSoftware());
  CHECK(sk::Device("reference").name() == "reference (native, double)");
  auto stream = device.stream<float>({3});
  CHECK_THROWS_WITH(stream.texture(),
                    Catch::Matchers::Contains("no textures") && Catch::Matchers::Contains("read()"));
}

TEST_CASE("native passes are counted, too") {
  sk::Device device = sk::Device::native();
  const auto in = streamOf<float>(device, std::vector<float>(64, 1.0F));
  auto r = device.stream<float>({64});
  device.countPasses(true);
  cancel(in, r);
  CHECK(sum(r) == 64 * 1e-12F);  // 1 + 1e-9 is 1 in float, and sums of equal numbers by pairs are exact
  const sk::PassCount count = device.passCount();
  CHECK(count.passes == 2);
  CHECK(count.bytesRead == 2 * 64 * 4);
  CHECK(count.bytesWritten == 64 * 4);
}

TEST_CASE("the reference computes in double, of the floats that it is given and the texts of literals") {
  sk::Device device = sk::Device::reference();
  const std::vector<float> x{0.1F, 3.0F, 1e6F};
  const auto in = streamOf(device, x);
  auto r = device.stream<float>({3});
  cancel(in, r);
  const std::vector<double> exact = r.readReals();
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double v = x[i];
    CHECK(exact[i] == (v + 1e-9) - v + v * v * 1e-12);
    CHECK(r.read()[i] == static_cast<float>(exact[i]));
  }
  auto twice = device.stream<float>({3});
  cancel(r, twice);  // streams hold doubles between calls
  CHECK(twice.readReals()[0] == (exact[0] + 1e-9) - exact[0] + exact[0] * exact[0] * 1e-12);
}

TEST_CASE("sums have the error of a tree, not of a loop") {
  const std::int64_t n = (1 << 20) + 7;
  const std::vector<float> x(static_cast<std::size_t>(n), 0.1F);
  sk::Device device = sk::Device::native();
  sk::Device reference = sk::Device::reference();
  const double exact = 0.1F * static_cast<double>(n);
  const float total = sum(streamOf(device, x));
  // 16 elements in sequence, then a tree of pairs: 15 + 17 roundings of half an ulp.
  CHECK(std::fabs(total - exact) <= 32 * 0x1p-24 * exact);
  CHECK(sum(streamOf(reference, x)) == static_cast<float>(exact));
}

TEST_CASE("results have the same bits on one thread as on many") {
  sk::Device device = sk::Device::native();
  std::vector<float> values((1 << 18) + 7);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::sin(static_cast<float>(i));
  const auto x = streamOf(device, values);
  const auto sums = [&] {
    return std::vector<float>{sum.with({.accumulate = sk::Accumulate::Tree})(x),
                              sum.with({.accumulate = sk::Accumulate::Compensated})(x),
                              sum.with({.accumulate = sk::Accumulate::Extended})(x)};
  };
  const std::vector<float> onMany = sums();
  std::vector<float> onOne;
  sk::native::inParallel(2, 1 << 20, sk::native::Deal::Evenly, [&](sk::native::Range range) {
    if (range.begin == 0) onOne = sums();  // inside a parallel region, no further threads are started
  });
  CHECK(onOne == onMany);
}

TEST_CASE("sums of floats in doubles are the same whether streams are read where they lie or laid out") {
  constexpr std::size_t n = (1 << 17) + 77;
  std::vector<float> x(n);
  std::vector<float> y(2 * n);
  for (std::size_t i = 0; i < n; ++i) {
    x[i] = std::sin(static_cast<float>(i)) * std::ldexp(1.0F, static_cast<int>(i % 40));
    y[2 * i] = std::cos(static_cast<float>(3 * i));
  }
  double expected = 0;
  double magnitude = 0;
  std::vector<float> dense(n);
  for (std::size_t i = 0; i < n; ++i) {
    dense[i] = y[2 * i];
    const double product = double{x[i]} * double{dense[i]};  // exact
    expected += product;
    magnitude += std::fabs(product);
  }
  sk::Device device = sk::Device::native();
  const auto column = [&](const std::vector<float>& values, std::int64_t columns) {
    auto stream = device.stream<float>({static_cast<std::int64_t>(n), columns});
    stream.write(values);
    return stream;
  };
  const auto a = column(x, 1);
  const auto b = column(dense, 1);
  const auto whole = column(y, 2);
  const auto compensated = dot.with({.accumulate = sk::Accumulate::Compensated});
  const float total = compensated(a, b);
  CHECK(compensated(a, whole.domain({0, 0}, {static_cast<std::int64_t>(n), 1})) == total);
  CHECK(dot(a, b) == total);
  // The result is rounded to float once; the loop above has n roundings to double.
  CHECK(std::fabs(total - expected) <= 0x1p-24 * std::fabs(expected) + 0x1p-53 * n * magnitude);
}

TEST_CASE("partial sums of floats do not overflow where doubles hold them") {
  sk::Device device = sk::Device::native();
  std::vector<float> x(1000, 3e38F);
  std::fill(x.begin() + 500, x.end(), -3e38F);
  x.push_back(0x1p100F);
  CHECK(sum(streamOf(device, x)) == 0x1p100F);
  CHECK(std::isinf(
      sum.with({.accumulate = sk::Accumulate::Tree})(streamOf(device, std::vector<float>(2, 3e38F)))));
  CHECK(sum(streamOf(device, std::vector<float>(2, -3e38F))) == -std::numeric_limits<float>::infinity());
}

TEST_CASE("a sum of floats sees no bits beyond them") {
  sk::Device device = sk::Device::native();
  auto x = device.stream<float>({1000}, sk::Storage::Double);
  x.writeReals(std::vector<double>(1000, 1 + 0x1p-25));
  CHECK(sum.with({.accumulate = sk::Accumulate::Compensated})(x) == 1000.0F);
  CHECK(sum.with({.precision = sk::Precision::Double})(x) == static_cast<float>(1000 * (1 + 0x1p-25)));
}

TEST_CASE("folds know the index of each element, in blocks of any width") {
  constexpr int columns = 37, rows = 3;
  sk::Device device = sk::Device::native();
  for (const int width : {1, 2, 3, 5, 8, 16}) {
    CAPTURE(width);
    auto x = device.stream<float>({2 * rows, width * columns});
    x.write(std::vector<float>(static_cast<std::size_t>(2 * rows * width * columns)));
    auto totals = device.stream<std::int32_t>({rows, columns});
    auto ramps = device.stream<float>({rows, columns});
    addIndices(x, sk::iter(0.0F, static_cast<float>(2 * rows * width * columns)), totals, ramps);
    std::vector<std::int32_t> expected(rows * columns);
    std::vector<float> numbers(rows * columns);  // whole numbers below 2^24, so that no sum rounds
    for (int row = 0; row < 2 * rows; ++row) {
      for (int k = 0; k < width * columns; ++k) {
        const auto block = static_cast<std::size_t>(row / 2 * columns + k / width);
        expected[block] += 3 * k + row;
        numbers[block] += static_cast<float>(row * width * columns + k);
      }
    }
    CHECK(totals.read() == expected);
    CHECK(ramps.read() == numbers);
  }
}

TEST_CASE("floats are rounded to halves as the host does it") {
  std::vector<float> x;
  for (std::uint64_t bits = 0; bits < 1ULL << 32U; bits += 0x1000) {  // all halves, and values between them
    for (const int beside : {-1, 0, 1, 77})
      x.push_back(std::bit_cast<float>(static_cast<std::uint32_t>(bits + beside)));
  }
  sk::Device device = sk::Device::native();
  auto r = device.stream<float>({std::ssize(x)});
  toHalfAndBack(streamOf(device, x), r);
  const std::vector<float> rounded = r.read();
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    wrong += std::bit_cast<std::uint32_t>(rounded[i]) ==
                     std::bit_cast<std::uint32_t>(static_cast<float>(sk::half(x[i])))
                 ? 0
                 : 1;
  }
  CHECK(wrong == 0);
}

/// The expected folds of each block of a stream of lines: the sum of the slopes, and the composition of the lines.
struct Folded {
  std::vector<std::int32_t> sums;
  std::vector<Line> lines;
};
Folded foldedBlocks(const std::vector<Line>& x, std::size_t width, std::size_t blockHeight,
                    std::size_t blockWidth) {
  Folded folded;
  const std::size_t height = x.size() / width;
  for (std::size_t y = 0; y < height; y += blockHeight) {
    for (std::size_t left = 0; left < width; left += blockWidth) {
      std::uint32_t sum = 0;
      Line all{1, 0};
      for (std::size_t i = 0; i < blockHeight * blockWidth; ++i) {
        const Line& l = x[(y + i / blockWidth) * width + left + i % blockWidth];
        sum += static_cast<std::uint32_t>(l.slope);
        all = {all.slope * l.slope, all.offset * l.slope + l.offset};
      }
      folded.sums.push_back(static_cast<std::int32_t>(sum));
      folded.lines.push_back(all);
    }
  }
  return folded;
}

TEST_CASE("blocks of every width are folded, each in its order") {
  sk::Device device = sk::Device::native();
  const std::size_t height = 36;
  const std::size_t width = 1200;
  std::vector<Line> x(height * width);
  std::vector<std::int32_t> slopes;
  for (std::size_t i = 0; i < x.size(); ++i) {
    x[i] = {i % 7 == 3 ? -1 : 1, static_cast<std::int32_t>(i % 11)};
    slopes.push_back(x[i].slope);
  }
  auto lines = device.stream<Line>({height, width});
  auto ints = device.stream<std::int32_t>({height, width});
  lines.write(x);
  ints.write(slopes);
  for (const std::size_t blockHeight : {1U, 2U, 36U}) {
    for (const std::size_t blockWidth : {1U, 2U, 8U, 10U, 80U, 150U, 600U, 1200U}) {
      INFO("blocks of " << blockHeight << " rows of " << blockWidth);
      const sk::Shape shape{static_cast<std::int64_t>(height / blockHeight),
                            static_cast<std::int64_t>(width / blockWidth)};
      auto sums = device.stream<std::int32_t>(shape);
      auto composed = device.stream<Line>(shape);
      add(ints, sums);
      compose(lines, composed);
      const Folded expected = foldedBlocks(x, width, blockHeight, blockWidth);
      CHECK(sums.read() == expected.sums);
      const std::vector<Line> got = composed.read();
      CHECK(std::equal(got.begin(), got.end(), expected.lines.begin(), [](const Line& a, const Line& b) {
        return a.slope == b.slope && a.offset == b.offset;
      }));
    }
  }
}

TEST_CASE("a stream that is read at other places is read as it was") {
  sk::Device device = sk::Device::native();
  auto a = streamOf<float>(device, {1, 2, 3, 4});
  shift(a, 0.5F, a);
  CHECK(a.read() == std::vector<float>{2.5F, 3.5F, 4.5F, 1.5F});
}

// A whole stream gets a new array for its results; a part of a stream is read from a copy.
TEST_CASE("streams that are read while they are written are right step after step, whole and in part") {
  sk::Device device = sk::Device::native();
  for (const std::int64_t n : {1, 5, 1000, 1 << 17}) {
    INFO(n << " elements");
    std::vector<float> expected(static_cast<std::size_t>(n));
    for (std::size_t i = 0; i < expected.size(); ++i) expected[i] = static_cast<float>(i % 97);
    auto a = streamOf(device, expected);
    const auto step = [&](std::int64_t begin, std::int64_t count) {
      const std::vector<float> old = expected;
      for (std::int64_t i = 0; i < count; ++i) {
        expected[static_cast<std::size_t>(begin + i)] = old[static_cast<std::size_t>((i + 1) % n)] + 0.5F;
      }
    };
    for (int round = 0; round < 3; ++round) {
      shift(a, 0.5F, a);
      step(0, n);
      const std::int64_t begin = n / 3, count = n - 2 * begin;
      shift(a, 0.5F, a.domain({begin}, {begin + count}));
      step(begin, count);
      shift.with({.precision = sk::Precision::Extended})(a, 0.5F, a);
      step(0, n);
      CHECK(a.read() == expected);
    }
  }
}

TEST_CASE("reals are read of floats alone") {
  sk::Device device = sk::Device::native();
  auto ints = device.stream<std::int32_t>({2});
  CHECK_THROWS_WITH(ints.readReals(),
                    Catch::Matchers::Contains("int") && Catch::Matchers::Contains("read()"));
  CHECK(device.stream<sk::float2>({0}).readReals().empty());
  sk::Device& gl = run_tests::device("glsl330");
  CHECK(streamOf<sk::float2>(gl, {{1, 2}, {3, 4}}).readReals() == std::vector<double>{1, 2, 3, 4});
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
/// Limits how many bytes of address space the process may add while this object lives.
class LittleMemory {
 public:
  explicit LittleMemory(rlim_t more) {
    getrlimit(RLIMIT_AS, &before_);
    rlim_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    rlimit little = before_;
    little.rlim_cur = pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + more;
    setrlimit(RLIMIT_AS, &little);
  }
  ~LittleMemory() { setrlimit(RLIMIT_AS, &before_); }
  LittleMemory(const LittleMemory&) = delete;
  LittleMemory& operator=(const LittleMemory&) = delete;

 private:
  rlimit before_{};
};

template <class Call>
std::string errorWithLittleMemory(Call call) {
  const LittleMemory little(rlim_t{16} << 20);
  try {
    call();
  } catch (const sk::Error& error) {
    return error.what();
  }
  return "no error";
}

TEST_CASE("a call that finds no memory throws sk::Error, and the next one may succeed") {
  constexpr std::size_t count = std::size_t{1} << 24;  // 64 MiB of floats
  sk::Device device = sk::Device::native();
  auto x = device.stream<float>({count}), r = device.stream<float>({count});
  x.write(std::vector<float>(count, 1.0f));
  const auto inDoubles = cancel.with({.precision = sk::Precision::Double});
  CHECK_THAT(errorWithLittleMemory([&] { inDoubles(x, r); }),
             Catch::Matchers::Contains("cancel") && Catch::Matchers::Contains("134217728 bytes"));
  CHECK_THAT(errorWithLittleMemory([&] { shift(x, 1.0f, x); }),
             Catch::Matchers::Contains("shift") && Catch::Matchers::Contains("67108864 bytes"));
  CHECK_THAT(errorWithLittleMemory([&] { x.read(); }),
             Catch::Matchers::Contains("16777216 element(s) of 4 byte(s)"));
  CHECK_THAT(errorWithLittleMemory([&] { x.readReals(); }),
             Catch::Matchers::Contains("16777216 element(s) of 8 byte(s)"));
  CHECK_THAT(errorWithLittleMemory([&] { device.stream<float>({count}); }),
             Catch::Matchers::Contains("67108864 bytes"));
  CHECK(x.domain({0}, {3}).read() == std::vector<float>(3, 1.0f));
  inDoubles(x, r);
  shift(x, 1.0f, x);
  CHECK(x.domain({0}, {3}).read() == std::vector<float>(3, 2.0f));
}
#endif

}  // namespace
}  // namespace run_tests
