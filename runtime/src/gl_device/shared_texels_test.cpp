// SPDX-License-Identifier: MIT
//
// Promises: a stencil whose work groups share texels has the same results as one whose invocations fetch all
// texels themselves, wherever the domain ends in a work group. Runs on a software renderer, which by default
// does not share texels.
#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "device/stream_state.hpp"
#include "gl/open_context.hpp"
#include "gl_device/gl_device.hpp"
#include "sk/types.hpp"

namespace sk {
namespace {

using program::Boundary;
using program::Kernel;
using program::Parameter;
using program::Role;

constexpr const program::Element& floats = ElementTraits<float>::element();

/// A weighted sum of neighbours within `reach`, at most five per row: drivers compile 81 of them too slowly.
std::string bodyOf(int reach) {
  std::string body = "void weigh(out float r) {\n  r = 0.0;\n";
  int weight = 1;
  const int step = reach > 2 ? reach / 2 : 1;
  for (int y = -reach; y <= reach; y += step) {
    for (int x = -reach; x <= reach; x += step) {
      body += "  r += " + std::to_string(weight++) + ".0 * sk_near_a(ivec2(" + std::to_string(x) + ", " +
              std::to_string(y) + "));\n";
    }
  }
  return body + "}\n";
}

/// Must outlive the devices that run it, which identify it by its address.
struct Weigh {
  Weigh(Boundary boundary, int reach)
      : body(bodyOf(reach)),
        parameters{{{.name = "a",
                     .symbol = "a",
                     .role = Role::Gather,
                     .element = &floats,
                     .rank = 2,
                     .boundary = boundary,
                     .border = "-7.0",
                     .usesNear = true,
                     .reach = reach},
                    {.name = "r", .symbol = "r", .role = Role::Output, .element = &floats}}},
        kernel{.name = "weigh",
               .entry = "weigh",
               .declarations = {},
               .body = body,
               .parameters = parameters,
               .sources = {}} {}
  Weigh(const Weigh&) = delete;
  Weigh& operator=(const Weigh&) = delete;

  std::string body;
  std::array<Parameter, 2> parameters;
  Kernel kernel;
};

std::vector<float> weighed(GlDevice& device, const Kernel& kernel, const Shape& shape) {
  std::vector<float> values(static_cast<std::size_t>(shape.size()));
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i * 37 % 101);
  const auto a = device.createStream(floats, shape, Storage::Single);
  const auto r = device.createStream(floats, shape, Storage::Single);
  detail::write(detail::wholeRegion(a.get()), values.data(), values.size());
  const std::array arguments{Argument{.region = detail::wholeRegion(a.get())},
                             Argument{.region = detail::wholeRegion(r.get())}};
  device.runUnchecked(kernel, arguments, {.target = Target::Compute});
  detail::read(detail::wholeRegion(r.get()), values.data(), values.size());
  return values;
}

}  // namespace

TEST_CASE("stencils that share texels in work groups") {
  const auto open = [](bool shares) {
    const DeviceChoices choices{.target = Target::Compute, .sharesTexels = shares};
    return std::make_unique<GlDevice>(gl::openContext({"software", gl::Api::Gl}), choices);
  };
  const auto sharing = open(true), fetching = open(false);
  std::deque<Weigh> kernels;
  for (const Boundary boundary : {Boundary::Clamp, Boundary::Wrap, Boundary::Mirror, Boundary::Border}) {
    for (const int reach : {1, 2, 4}) {
      const Kernel& kernel = kernels.emplace_back(boundary, reach).kernel;
      for (const Shape& shape : {Shape{5, 8}, Shape{16, 32}, Shape{17, 36}, Shape{33, 100}}) {
        CAPTURE(static_cast<int>(boundary), reach, shape[0], shape[1]);
        CHECK(weighed(*sharing, kernel, shape) == weighed(*fetching, kernel, shape));
      }
    }
  }
}

}  // namespace sk
