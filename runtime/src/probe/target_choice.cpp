// SPDX-License-Identifier: MIT
//
// The kernels of the trials, written as skc would generate them, and the measurement.
#include "probe/target_choice.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "assemble/append/append_groups.hpp"
#include "assemble/append/append_passes.hpp"
#include "call/box.hpp"
#include "call/resolved_call.hpp"
#include "device/stream_state.hpp"
#include "gl_device/gl_device.hpp"
#include "sk/error.hpp"
#include "sk/types.hpp"
#include "support/cache_folder.hpp"

namespace sk {

namespace {

using program::Kernel;
using program::Parameter;
using program::Role;

constexpr const program::Element& floats = ElementTraits<float>::element();

constexpr std::array<Parameter, 3> elementParameters{
    {{.name = "x", .symbol = "x", .role = Role::Input, .element = &floats},
     {.name = "y", .symbol = "y", .role = Role::Input, .element = &floats},
     {.name = "r", .symbol = "r", .role = Role::Output, .element = &floats}}};
constexpr std::array<Parameter, 2> neighbourParameters{
    {{.name = "x",
      .symbol = "x",
      .role = Role::Gather,
      .element = &floats,
      .rank = 2,
      .usesNear = true,
      .reach = 1},
     {.name = "r", .symbol = "r", .role = Role::Output, .element = &floats}}};
constexpr std::array<Parameter, 2> gatherParameters{
    {{.name = "x", .symbol = "x", .role = Role::Gather, .element = &floats, .rank = 2, .usesAt = true},
     {.name = "r", .symbol = "r", .role = Role::Output, .element = &floats}}};
constexpr std::array<Parameter, 2> loopParameters{
    {{.name = "x", .symbol = "x", .role = Role::Input, .element = &floats},
     {.name = "r", .symbol = "r", .role = Role::Output, .element = &floats}}};
constexpr std::array<Parameter, 2> scatterParameters{
    {{.name = "x", .symbol = "x", .role = Role::Input, .element = &floats, .usesIndex = true},
     {.name = "r", .symbol = "r", .role = Role::Scatter, .element = &floats, .rank = 2, .pushes = 1}}};
constexpr std::array<Parameter, 2> orderedParameters{
    {{.name = "x", .symbol = "x", .role = Role::Input, .element = &floats, .usesIndex = true},
     {.name = "r",
      .symbol = "r",
      .role = Role::Scatter,
      .element = &floats,
      .rank = 2,
      .scatter = program::ScatterOp::Add,
      .pushes = 1}}};
constexpr std::array<Parameter, 2> pushParameters{
    {{.name = "x", .symbol = "x", .role = Role::Input, .element = &floats},
     {.name = "r", .symbol = "r", .role = Role::VariableOutput, .element = &floats, .pushes = 1}}};
constexpr std::array<Parameter, 2> sumParameters{
    {{.name = "x", .symbol = "x", .role = Role::Input, .element = &floats},
     {.name = "r", .symbol = "r", .role = Role::Accumulator, .element = &floats, .identity = "0.0"}}};

constexpr Kernel kernelOf(std::string_view name, std::string_view body,
                          std::span<const Parameter> parameters) {
  return {.name = name,
          .entry = "sk_trial",
          .declarations = {},
          .body = body,
          .parameters = parameters,
          .sources = {}};
}

const Kernel elements =
    kernelOf("a trial of elements", "void sk_trial(float x, float y, out float r) { r = 2.5 * x + y; }\n",
             elementParameters);
const Kernel neighbours = kernelOf("a trial of neighbours",
                                   "void sk_trial(out float r) {\n"
                                   "  r = sk_near_x(ivec2(1, 0)) + sk_near_x(ivec2(-1, 0)) +\n"
                                   "      sk_near_x(ivec2(0, 1)) + sk_near_x(ivec2(0, -1)) -\n"
                                   "      3.0 * sk_near_x(ivec2(0, 0));\n"
                                   "}\n",
                                   neighbourParameters);
const Kernel gathers = [] {
  Kernel kernel = kernelOf("a trial of gathers",
                           "void sk_trial(out float r) {\n"
                           "  ivec2 p = sk_index().yx;\n"
                           "  r = sk_at_x(p) + sk_at_x(p ^ 5);\n"
                           "}\n",
                           gatherParameters);
  kernel.usesIndex = true;
  return kernel;
}();
const Kernel loops = [] {
  Kernel kernel = kernelOf("a trial of loops",
                           "void sk_trial(float x, out float r) {\n"
                           "  float a = 0.0, b = 0.0;\n"
                           "  int n = 0;\n"
                           "  for (; n < 64 && a * a + b * b < 4.0; ++n) {\n"
                           "    float c = a * a - b * b + x - 0.75;\n"
                           "    b = 2.0 * a * b + 0.1;\n"
                           "    a = c;\n"
                           "  }\n"
                           "  r = float(n);\n"
                           "}\n",
                           loopParameters);
  kernel.usesLoops = true;
  return kernel;
}();
const Kernel scatters =
    kernelOf("a trial of scatters", "void sk_trial(float x) { sk_put_r(sk_index_x().yx ^ 5, x); }\n",
             scatterParameters);
const Kernel orderedScatters =
    kernelOf("a trial of scatters in order",
             "void sk_trial(float x) { sk_put_r((sk_index_x().yx ^ 5) & ~1, x); }\n", orderedParameters);
const Kernel pushes = kernelOf("a trial of pushes",
                               "void sk_trial(float x) {\n"
                               "  if ((floatBitsToInt(x) & 1) == 0) sk_push_r(x);\n"
                               "}\n",
                               pushParameters);
const program::Reduction sumOfFloats = [] {
  program::Reduction reduction{};
  reduction.fold =
      kernelOf("a trial of reduces", "void sk_trial(float x, inout float r) { r += x; }\n", sumParameters);
  reduction.combine = reduction.fold;
  reduction.seeded = true;
  reduction.commutative = true;
  return reduction;
}();

class Trial {
 public:
  Trial(GlDevice& device, KernelClass kernels)
      : device_(device),
        kernels_(kernels),
        shape_(shapeFor(device, kernels)),
        x_(device.createStream(floats, shape_, Storage::Single)),
        y_(device.createStream(floats, shape_, Storage::Single)),
        r_(device.createStream(floats, shape_, Storage::Single)),
        list_(device.createStream(floats, {0}, Storage::Single)) {
    std::vector<float> values(static_cast<std::size_t>(shape_.size()), 0.5F);
    for (std::size_t i = 0; i < values.size(); i += 2) values[i] = std::nextafter(0.5F, 1.0F);
    detail::write(detail::wholeRegion(x_.get()), values.data(), values.size());
    detail::write(detail::wholeRegion(y_.get()), values.data(), values.size());
  }

  /// Compares the shortest of several alternating runs. Warm-up runs come first: they compile and raise clock
  /// rates.
  double computeOverFragment() {
    constexpr int warm = 3, rounds = 5;
    std::array<double, 2> best;
    best.fill(std::numeric_limits<double>::infinity());
    for (int round = -warm; round < rounds; ++round) {
      const double drawn = seconds(Target::Fragment);
      const double dispatched = seconds(Target::Compute);
      if (round >= 0) best = {std::min(best[0], drawn), std::min(best[1], dispatched)};
    }
    return best[1] / best[0];
  }

 private:
  /// Scatters take a software renderer long.
  static Shape shapeFor(const GlDevice& device, KernelClass kernels) {
    if (!device.capabilities.isSoftware) return {2048, 2048};
    switch (kernels) {
      case KernelClass::Pushes:
      case KernelClass::Scatters:
      case KernelClass::OrderedScatters: return {256, 256};
      case KernelClass::Elements:
      case KernelClass::Neighbours:
      case KernelClass::Gathers:
      case KernelClass::Loops:
      case KernelClass::Reduces: break;
    }
    return {1024, 1024};
  }

  double seconds(Target target) {
    device_.finish();
    const auto start = std::chrono::steady_clock::now();
    run({.target = target});
    device_.finish();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

  void run(const CallOptions& options) {
    const Argument x{.region = detail::wholeRegion(x_.get())};
    const Argument y{.region = detail::wholeRegion(y_.get())};
    const Argument r{.region = detail::wholeRegion(r_.get())};
    const std::array two{x, r};
    switch (kernels_) {
      case KernelClass::Elements: return device_.runUnchecked(elements, std::array{x, y, r}, options);
      case KernelClass::Neighbours: return device_.runUnchecked(neighbours, two, options);
      case KernelClass::Gathers: return device_.runUnchecked(gathers, two, options);
      case KernelClass::Loops: return device_.runUnchecked(loops, two, options);
      case KernelClass::Pushes:
        return device_.runUnchecked(
            pushes, std::array{x, Argument{.region = detail::wholeRegion(list_.get())}}, options);
      case KernelClass::Scatters: return device_.runUnchecked(scatters, two, options);
      case KernelClass::OrderedScatters: return device_.runUnchecked(orderedScatters, two, options);
      case KernelClass::Reduces: {
        float total = 0;
        const std::array<void*, 1> results{&total};
        return device_.reduce(
            {device_, sumOfFloats, std::array{x, Argument{}}, shape_, oneBlock(shape_), results, options});
      }
    }
  }

  GlDevice& device_;
  const KernelClass kernels_;
  const Shape shape_;
  const std::unique_ptr<StreamState> x_, y_, r_, list_;
};

}  // namespace

std::string_view nameOf(KernelClass kernels) {
  switch (kernels) {
    case KernelClass::Elements: return "elements";
    case KernelClass::Neighbours: return "neighbours";
    case KernelClass::Gathers: return "gathers";
    case KernelClass::Loops: return "loops";
    case KernelClass::Reduces: return "reduces";
    case KernelClass::Pushes: return "pushes";
    case KernelClass::Scatters: return "scatters";
    case KernelClass::OrderedScatters: return "ordered-scatters";
  }
  return {};
}

KernelClass classOf(const Kernel& kernel, Order order) {
  const auto any = [&](auto&& asks) { return std::ranges::any_of(kernel.parameters, asks); };
  if (any(assemble::isAppendOutput)) {
    if (any([&](const Parameter& parameter) { return assemble::isListed(parameter, order); }))
      return KernelClass::OrderedScatters;
    const bool pushes =
        any([](const Parameter& parameter) { return parameter.role == Role::VariableOutput; });
    return pushes && order != Order::Any ? KernelClass::Pushes : KernelClass::Scatters;
  }
  if (kernel.usesLoops) return KernelClass::Loops;
  if (any([](const Parameter& parameter) { return parameter.usesAt || parameter.usesSample; }))
    return KernelClass::Gathers;
  return any([](const Parameter& parameter) { return parameter.usesNear; }) ? KernelClass::Neighbours
                                                                            : KernelClass::Elements;
}

std::string trialKey(std::string_view driver, const DeviceLimits& limits, bool isSoftware) {
  return fmt::format("{}, textures of {} x {}{}{}", driver, limits.textureSize, limits.textureLayers,
                     isSoftware ? ", " : "", isSoftware ? processorKey() : "");
}

std::optional<double> computeOverFragment(GlDevice& device, KernelClass kernels) {
  const std::string name = fmt::format("compute-over-fragment-{}", nameOf(kernels));
  const std::string key = trialKey(driverKey(device.name(), device.driver(), device.profileName()),
                                   device.limits, device.isSoftware());
  try {
    return device.cache.measuredOnce(name, key, [&] { return Trial(device, kernels).computeOverFragment(); });
  } catch (const Error&) {
    return std::nullopt;
  }
}

}  // namespace sk
