// SPDX-License-Identifier: MIT
//
// Promises: on a GL device, too, a loop that runs several iterations at once in tiles computes the bits that its calls compute one by
// one, in all of its streams; Loop::plan() says whether it does. The test program sets SK_LOOP_TILES, so that tiles are small, and
// are not tried out first.
#include <array>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "sk/sk.hpp"
#include "support/devices.hpp"
#include "support/same_bits.hpp"
#include "tiled_loops.sk.hpp"

namespace run_tests {
namespace gl_tiles {
namespace {

using Catch::Matchers::Contains;
using Field = sk::Stream<float>;

using Fields = std::array<Field, 4>;

Fields fieldsOf(sk::Device& device, const sk::Shape& shape) {
  Fields fields;
  for (unsigned i = 0; i < 4; ++i) {
    fields[i] = device.stream<float>(shape);
    fields[i].write(drawn(shape.size(), i));
  }
  return fields;
}

struct Drawn {
  int kernel;
  std::size_t a, b, c, d;
};

/// Kernels with one boundary mode: those that wrap, and all others.
void run(const Drawn& call, bool wraps, Fields& f) {
  Field &a = f[call.a], &b = f[call.b], &c = f[call.c], &d = f[call.d];
  switch (call.kernel) {
    case 0: return wraps ? tiled::around(a, b) : tiled::heat(0.2f, a, b);
    case 1: return wraps ? tiled::around(a, a) : tiled::mirrored(a, b);
    case 2: return wraps ? tiled::react(a, b, c, d) : tiled::bordered(a, c, b);
    case 3: return wraps ? tiled::react(a, b, a, b) : tiled::heat(0.1f, a, a);
    case 4: return tiled::damp(0.1f, a, a);
    case 5: return tiled::damp(0.1f, a, b);
    case 6: return tiled::place(a, b);
    case 7: return tiled::twice(a, b);
    case 9: return wraps ? tiled::jumpAround(a, b) : tiled::jump(a, b);
    case 10: return wraps ? tiled::jumpAround(a, a) : tiled::jumpMirrored(a, b);
    case 11: return wraps ? tiled::around(b, a) : tiled::jumpBordered(a, b);
    default: return std::swap(a, b);
  }
}

TEST_CASE("loops of any calls in tiles on a GPU compute the bits of their calls one by one") {
  sk::Device& device = run_tests::device("glsl430");
  std::mt19937 engine(3);
  const auto draw = [&](int most) { return static_cast<int>(engine() % static_cast<unsigned>(most)); };
  int inTiles = 0;
  for (int trial = 0; trial < 70; ++trial) {
    const bool wraps = draw(2) == 0;
    const sk::Shape shape{64 + draw(40), 64 + 4 * draw(16)};
    std::vector<Drawn> calls;
    for (int i = 1 + draw(3); i > 0; --i) {
      Drawn call{draw(12), static_cast<std::size_t>(draw(4)), 0, 0, 0};
      call.b = (call.a + 1 + static_cast<std::size_t>(draw(3))) % 4;
      do call.c = static_cast<std::size_t>(draw(4));
      while (call.c == call.a || call.c == call.b);
      call.d = 6 - call.a - call.b - call.c;
      calls.push_back(call);
    }
    calls.push_back({8, calls.back().a, calls.back().b, 0, 0});
    const int times = 1 + draw(20), again = draw(3) == 0 ? draw(9) : 0;
    std::string named;
    for (const Drawn& call : calls)
      named += std::to_string(call.kernel) + "(" + std::to_string(call.a) + std::to_string(call.b) + ") ";
    INFO("trial " << trial << (wraps ? ": wrapping kernels " : ": kernels ") << named << "over " << shape[0]
                  << " x " << shape[1] << ", " << times << " + " << again << " iterations");
    Fields one = fieldsOf(device, shape), loop = fieldsOf(device, shape);
    for (int i = 0; i < times + again; ++i) {
      for (const Drawn& call : calls) run(call, wraps, one);
    }
    sk::Loop recorded = device.record([&] {
      for (const Drawn& call : calls) run(call, wraps, loop);
    });
    INFO(recorded.plan());
    inTiles += recorded.plan().find("iterations at once") != std::string::npos ? 1 : 0;
    recorded.repeat(times);
    recorded.repeat(again);
    for (std::size_t i = 0; i < 4; ++i) {
      INFO("field " << i);
      REQUIRE(haveSameBits(loop[i].read(), one[i].read()));
    }
  }
  CHECK(inTiles > 20);
}

}  // namespace
}  // namespace gl_tiles
}  // namespace run_tests
