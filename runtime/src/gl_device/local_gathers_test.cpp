// SPDX-License-Identifier: MIT
//
// Promises: a placed gather is local, so that its program is that of a plain stream, where the kernel only reads it near each
// element and boundary modes give the same at the ends of what it holds; and only there. tests/run/local_gathers_test.cpp tests the
// results.
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <catch2/catch.hpp>

#include "device/stream_state.hpp"
#include "gl/open_context.hpp"
#include "gl_device/gl_device.hpp"
#include "gl_device/pass/kernel_operands.hpp"
#include "gl_device/program/variant.hpp"
#include "sk/types.hpp"

namespace sk {
namespace {

using assemble::StreamAccess;
using program::Boundary;
using program::Kernel;
using program::Parameter;
using program::Reach;
using program::Role;

/// Reads `u` up to one element before and two after the current one in each of two dimensions.
struct Near {
  explicit Near(Boundary boundary) {
    parameters[0].boundary = boundary;
    kernel.parameters = parameters;
  }
  Near(const Near&) = delete;
  Near& operator=(const Near&) = delete;

  std::array<Reach, 2> halo{{{0, Reach::Kind::Near, {1}, {2}}, {1, Reach::Kind::Near, {1}, {2}}}};
  std::array<Parameter, 2> parameters{{{.name = "u",
                                        .symbol = "u",
                                        .role = Role::Gather,
                                        .element = &ElementTraits<float>::element(),
                                        .rank = 2,
                                        .usesNear = true,
                                        .reach = 2,
                                        .halo = halo,
                                        .haloShapes = 1},
                                       {.name = "r",
                                        .symbol = "r",
                                        .role = Role::Output,
                                        .element = &ElementTraits<float>::element(),
                                        .usesIndex = true,
                                        .usesExtent = true}}};
  Kernel kernel{.name = "near",
                .entry = "near",
                .declarations = {},
                .body = "void near(out float r) {}\n",
                .parameters = {},
                .sources = {}};
};

/// A part of the whole.
struct Held {
  Index origin;
  Shape shape;
};

constexpr std::int64_t rows = 40, columns = 64;

class Calls {
 public:
  /// The variant of a call that computes `box` into an output that holds `output`.
  assemble::Variant variantOf(const Near& near, const Held& gather, const Held& output, const Box& box) {
    const auto u = device_.createStream(ElementTraits<float>::element(), gather.shape, Storage::Single);
    const auto r = device_.createStream(ElementTraits<float>::element(), output.shape, Storage::Single);
    const std::array arguments{argumentOf(*u, gather), argumentOf(*r, output)};
    Box own = box;
    for (int d = 0; d < 2; ++d) {
      own.begin[d] -= output.origin[d];
      own.end[d] -= output.origin[d];
    }
    const DeviceScope scope(device_);
    const assemble::SpecValues specs{};
    const KernelOperands operands(device_, near.kernel, arguments, specs, nullptr, {}, own,
                                  {output.origin, {rows, columns}});
    return chooseVariant(near.kernel, operands.get(), operands.domain());
  }

  /// Whether `u` is local in a call whose output holds the same.
  bool isLocal(const Near& near, const Held& held, const Box& box) {
    return variantOf(near, held, held, box).access[0].local;
  }

 private:
  static Argument argumentOf(StreamState& stream, const Held& held) {
    Argument argument{.region = detail::wholeRegion(&stream)};
    argument.region.placement = {held.origin, {rows, columns}};
    return argument;
  }

  GlDevice device_{gl::openContext({"software", gl::Api::Gl}), {}};
};

}  // namespace

TEST_CASE("a gather that holds a halo around the box is local, in texels of four elements") {
  Calls calls;
  for (const Boundary boundary : {Boundary::Clamp, Boundary::Wrap, Boundary::Mirror, Boundary::Border}) {
    const Near near(boundary);
    const Held held{{9, 0}, {13, columns}};
    const assemble::Variant variant = calls.variantOf(near, held, held, {{10, 0}, {20, columns}});
    const StreamAccess& access = variant.access[0];
    CAPTURE(static_cast<int>(boundary));
    CHECK(variant.domainPlaced);
    CHECK(variant.domainPacked);
    CHECK(access.local);
    CHECK(access.packed);
    CHECK(access.nearby);
    CHECK_FALSE(access.placed);
    CHECK_FALSE(access.shifted);
    CHECK_FALSE(access.view);
  }
}

TEST_CASE("a gather that ends where the whole ends is local unless it wraps") {
  Calls calls;
  const Held first{{0, 0}, {12, columns}}, last{{29, 0}, {11, columns}};
  const Held across{{-1, 0}, {13, columns}};
  for (const Boundary boundary : {Boundary::Clamp, Boundary::Wrap, Boundary::Mirror, Boundary::Border}) {
    const Near near(boundary);
    const bool wraps = boundary == Boundary::Wrap;
    CAPTURE(static_cast<int>(boundary));
    CHECK(calls.isLocal(near, first, {{0, 0}, {10, columns}}) == !wraps);
    CHECK(calls.isLocal(near, last, {{30, 0}, {40, columns}}) == !wraps);
    CHECK(calls.isLocal(near, across, {{0, 0}, {10, columns}}) == wraps);
  }
}

TEST_CASE("a gather that begins elsewhere than the domain is shifted, by whole texels if it is packed") {
  Calls calls;
  const Near near(Boundary::Clamp);
  const Box all{{10, 8}, {20, 24}};
  const Held box{all.begin, {10, 16}};
  const assemble::Variant byTexels = calls.variantOf(near, {{9, 4}, {13, 24}}, box, all);
  CHECK(byTexels.domainPacked);
  CHECK(byTexels.access[0].local);
  CHECK(byTexels.access[0].shifted);
  CHECK(byTexels.access[0].nearby);
  CHECK_FALSE(calls.variantOf(near, {{9, 6}, {13, 20}}, box, all).access[0].local);
  const assemble::Variant byElements = calls.variantOf(near, {{9, 6}, {13, 21}}, box, all);
  CHECK(byElements.access[0].local);  // not packed: 21 is no multiple of four
  CHECK(byElements.access[0].shifted);
}

TEST_CASE("a gather that is read elsewhere, or whose promise may be broken, is not local") {
  Calls calls;
  const Held held{{9, 0}, {13, columns}};
  const Box box{{10, 0}, {20, columns}};
  const auto isLocal = [&](auto&& change) {
    Near near(Boundary::Clamp);
    change(near.parameters[0]);
    const assemble::Variant variant = calls.variantOf(near, held, held, box);
    CHECK(variant.access[0].placed == !variant.access[0].local);
    return variant.access[0].local;
  };
  CHECK(isLocal([](Parameter&) {}));
  CHECK_FALSE(isLocal([](Parameter& gather) { gather.usesAt = true; }));
  CHECK_FALSE(isLocal([](Parameter& gather) { gather.usesSample = true; }));
  CHECK_FALSE(isLocal([](Parameter& gather) { gather.reach = -1; }));
  CHECK(isLocal([](Parameter& gather) {  // as in a variant of a kernel
    gather.halo = {};
    gather.reach = 1;
  }));
  CHECK_FALSE(isLocal([](Parameter& gather) { gather.halo = {}; }));  // the halo has one row above
}

}  // namespace sk
