// SPDX-License-Identifier: MIT
//
// Tests the shared GLSL functions by running them as C++: TRANSLITERATED defines both the code and its text,
// and the text must equal what the assembler emits, so that the tested code is what runs.
#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <catch2/catch.hpp>

#include "assemble/glsl/program_text.hpp"
#include "assemble/region_layout.hpp"

// NOLINTBEGIN(readability-identifier-naming): GLSL's names
namespace glsl {

using uint = std::uint32_t;
struct ivec2 {
  ivec2(int a, int b) : x(a), y(b) {}
  int x, y;
};
struct ivec4 {
  ivec4(int a, int b, int c, int d) : x(a), y(b), z(c), w(d) {}
  int x, y, z, w;
};

#define TRANSLITERATED(name, ...) \
  __VA_ARGS__                     \
  constexpr std::string_view name = #__VA_ARGS__;

TRANSLITERATED(
    wrapText, int sk_wrap(int sk_i, int sk_d, int sk_n) {
      uint sk_p = uint(sk_i) + uint(sk_d);
      if (sk_p < uint(sk_n)) return int(sk_p);
      bool sk_below = sk_d < -sk_i;
      int sk_r = int((sk_below ? ~sk_p : sk_p) % uint(sk_n));
      return sk_below ? sk_n - 1 - sk_r : sk_r;
    })

TRANSLITERATED(
    wrapOnceText, int sk_wrap(int sk_p, int sk_n) {
      return sk_p < 0 ? sk_p + sk_n : sk_p < sk_n ? sk_p : sk_p - sk_n;
    })

TRANSLITERATED(
    mirrorText, int sk_mirror(int sk_i, int sk_d, int sk_n) {
      uint sk_p = uint(sk_i) + uint(sk_d);
      if (sk_d < -sk_i) sk_p = ~sk_p;
      uint sk_turns = sk_p / uint(sk_n);
      int sk_r = int(sk_p - sk_turns * uint(sk_n));
      return (sk_turns & 1u) == 0u ? sk_r : sk_n - 1 - sk_r;
    })

TRANSLITERATED(
    mirrorOnceText, int sk_mirror(int sk_p, int sk_n) {
      return sk_p < 0 ? -1 - sk_p : sk_p < sk_n ? sk_p : sk_n - 1 - (sk_p - sk_n);
    })

TRANSLITERATED(
    texelText, ivec2 sk_texel(int sk_n, int sk_s) { return ivec2(sk_n & ((1 << sk_s) - 1), sk_n >> sk_s); })

TRANSLITERATED(
    pairedText, int sk_paired(int sk_n, int sk_h) {
      int sk_i = sk_n & ((2 << sk_h) - 1);
      return (sk_n - sk_i) | ((sk_i >> 2 & 1) << sk_h) | (sk_i >> 3 << 2) | (sk_i & 3);
    })

TRANSLITERATED(
    ravelText, int sk_ravel(ivec4 sk_i, ivec4 sk_s) {
      return sk_i.x * sk_s.x + sk_i.y * sk_s.y + sk_i.z * sk_s.z + sk_i.w * sk_s.w;
    })

namespace two {
TRANSLITERATED(
    text, ivec4 sk_unravel(int sk_n, ivec4 sk_s) {
      int sk_y = sk_n / sk_s.y;
      return ivec4(sk_n - sk_y * sk_s.y, sk_y, 0, 0);
    })
}  // namespace two

namespace three {
TRANSLITERATED(
    text, ivec4 sk_unravel(int sk_n, ivec4 sk_s) {
      int sk_z = sk_n / sk_s.z;
      sk_n -= sk_z * sk_s.z;
      int sk_y = sk_n / sk_s.y;
      return ivec4(sk_n - sk_y * sk_s.y, sk_y, sk_z, 0);
    })
}  // namespace three

namespace four {
TRANSLITERATED(
    text, ivec4 sk_unravel(int sk_n, ivec4 sk_s) {
      int sk_w = sk_n / sk_s.w;
      sk_n -= sk_w * sk_s.w;
      int sk_z = sk_n / sk_s.z;
      sk_n -= sk_z * sk_s.z;
      int sk_y = sk_n / sk_s.y;
      return ivec4(sk_n - sk_y * sk_s.y, sk_y, sk_z, sk_w);
    })
}  // namespace four

}  // namespace glsl
// NOLINTEND(readability-identifier-naming)

namespace {

using sk::assemble::Function;

/// The text without comment lines and white space.
std::string essence(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    if (line.starts_with("//")) continue;
    std::ranges::copy_if(line, std::back_inserter(result), [](char c) { return c != ' '; });
  }
  return result;
}

constexpr std::int64_t most = std::numeric_limits<std::int32_t>::max();
constexpr std::int64_t least = std::numeric_limits<std::int32_t>::min();
constexpr int largestExtent = 1 << 30;   // one more than sk::mostExtent

const std::vector<int> extents = {
    1, 2, 3, 5, 7, 64, 100, 8191, 8192, 16384, largestExtent - 1, largestExtent};

/// Offsets near every multiple of the extent that matters, and near the limits of the type.
std::vector<int> offsets(std::int64_t i, std::int64_t n) {
  std::vector<int> result;
  for (const std::int64_t centre :
       {std::int64_t{0}, -i, n - i, -n, n, 2 * n, -2 * n, 3 * n, least, most, most - i}) {
    for (std::int64_t d = centre - 3; d <= centre + 3; ++d) {
      if (d >= least && d <= most) result.push_back(static_cast<int>(d));
    }
  }
  return result;
}

std::int64_t wrapped(std::int64_t p, std::int64_t n) { return ((p % n) + n) % n; }

/// GL_MIRRORED_REPEAT for integers.
std::int64_t mirrored(std::int64_t p, std::int64_t n) {
  const std::int64_t q = wrapped(p, 2 * n);
  return q < n ? q : 2 * n - 1 - q;
}

template <class Check>
void forExtremes(Check check) {
  for (const int n : extents) {
    for (const int i : {0, 1, n / 2, n - 1, n, largestExtent - 1}) {
      for (const int d : offsets(i, n)) check(i, d, n);
    }
  }
}

}  // namespace

TEST_CASE("the functions tested here are those that the assembler emits") {
  using sk::assemble::text;
  CHECK(essence(text(Function::Wrap)) == essence(glsl::wrapText));
  CHECK(essence(text(Function::WrapOnce)) == essence(glsl::wrapOnceText));
  CHECK(essence(text(Function::Mirror)) == essence(glsl::mirrorText));
  CHECK(essence(text(Function::MirrorOnce)) == essence(glsl::mirrorOnceText));
  CHECK(essence(text(Function::Texel)) == essence(glsl::texelText));
  CHECK(essence(text(Function::Paired)) == essence(glsl::pairedText));
  CHECK(essence(text(Function::Ravel)) == essence(glsl::ravelText));
  CHECK(essence(text(Function::Unravel2)) == essence(glsl::two::text));
  CHECK(essence(text(Function::Unravel3)) == essence(glsl::three::text));
  CHECK(essence(text(Function::Unravel4)) == essence(glsl::four::text));
}

TEST_CASE("wrapping and mirroring are right for every int, and for sums that overflow") {
  forExtremes([](int i, int d, int n) {
    const std::int64_t sum = std::int64_t{i} + d;
    INFO("i " << i << " d " << d << " n " << n);
    REQUIRE(glsl::sk_wrap(i, d, n) == wrapped(sum, n));
    REQUIRE(glsl::sk_mirror(i, d, n) == mirrored(sum, n));
    if (sum >= -std::int64_t{n} && sum < 2 * std::int64_t{n}) {
      REQUIRE(glsl::sk_wrap(static_cast<int>(sum), n) == wrapped(sum, n));
      REQUIRE(glsl::sk_mirror(static_cast<int>(sum), n) == mirrored(sum, n));
    }
  });
}

// The formulas that gather.cpp emits inline, for one component; gather_test checks their text.
TEST_CASE("clamping and the border test are right for every int, and for sums that overflow") {
  forExtremes([](int i, int d, int n) {
    const std::int64_t sum = std::int64_t{i} + d;
    INFO("i " << i << " d " << d << " n " << n);
    REQUIRE(i + std::clamp(d, -i, n - 1 - i) == std::clamp<std::int64_t>(sum, 0, n - 1));
    const std::uint32_t overflowing = static_cast<std::uint32_t>(i) + static_cast<std::uint32_t>(d);
    REQUIRE((overflowing >= static_cast<std::uint32_t>(n)) == (sum < 0 || sum >= n));
  });
}

TEST_CASE("an index and its number give one another") {
  const sk::assemble::Index4 extent = {5, 3, 4, 2};
  const auto s = sk::assemble::stridesOf(extent);
  const glsl::ivec4 strides(s[0], s[1], s[2], s[3]);
  for (int n = 0; n < sk::assemble::elements(extent); ++n) {
    const glsl::ivec4 i = glsl::four::sk_unravel(n, strides);
    REQUIRE((i.x < 5 && i.y < 3 && i.z < 4 && i.w < 2));
    REQUIRE(glsl::sk_ravel(i, strides) == n);
    if (n < 60) REQUIRE(glsl::sk_ravel(glsl::three::sk_unravel(n, strides), strides) == n);
    if (n < 15) REQUIRE(glsl::sk_ravel(glsl::two::sk_unravel(n, strides), strides) == n);
    const glsl::ivec2 texel = glsl::sk_texel(n, 3);
    REQUIRE((texel.x < 8 && texel.y * 8 + texel.x == n));
  }
}

TEST_CASE("of eight numbers in pairs of rows, four are in either row, and all numbers are taken once") {
  for (const int shift : {2, 3, 7}) {
    const int width = 1 << shift, pair = 2 * width;
    std::vector<int> taken(static_cast<std::size_t>(3 * pair));
    for (int n = 0; n < 3 * pair; ++n) {
      const int number = glsl::sk_paired(n, shift);
      REQUIRE(number / pair == n / pair);
      ++taken[static_cast<std::size_t>(number)];
      CHECK(number / width % 2 == n / 4 % 2);
      CHECK(number % width == n % pair / 8 * 4 + n % 4);
    }
    CHECK(std::ranges::all_of(taken, [](int times) { return times == 1; }));
  }
}
