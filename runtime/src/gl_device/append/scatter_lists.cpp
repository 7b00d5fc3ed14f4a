// SPDX-License-Identifier: MIT
#include "gl_device/append/scatter_lists.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <utility>

#include "assemble/append/append_groups.hpp"
#include "assemble/append/scatter_programs.hpp"
#include "assemble/reduce/scan_plan.hpp"
#include "gl_device/pass/pass.hpp"
#include "gl_device/pass/pass_trace.hpp"
#include "gl_device/sort/device_sort.hpp"
#include "gl_device/transfer/copy_regions.hpp"
#include "sk/types.hpp"

namespace sk {

namespace {

using assemble::PointStep;
using program::ScatterOp;

constexpr const char* whatFor = "a scatter output of integers";

/// The float element of this width.
const program::Element& floatsOf(int width) {
  switch (width) {
    case 1: return ElementTraits<float>::element();
    case 2: return ElementTraits<float2>::element();
    case 3: return ElementTraits<float3>::element();
    default: return ElementTraits<float4>::element();
  }
}

bool isOfFloats(const program::Parameter& appendOutput) {
  return appendOutput.element->fields.front().scalar == program::Scalar::Float;
}

}  // namespace

Scatterer::Scatterer(GlDevice& device, const program::Parameter& appendOutput, std::span<RenderTarget> list,
                     const assemble::RegionLayout& listLayout, const assemble::RegionLayout& regionLayout,
                     std::span<RenderTarget> planes)
    : device_(device),
      appendOutput_(appendOutput),
      list_(list),
      listLayout_(listLayout),
      length_(listLayout.extent[0]),
      regionLayout_(regionLayout),
      planes_(planes),
      rects_(assemble::drawnTexels(regionLayout)),
      limbs_(device.memory()),
      upper_(device.memory()),
      lower_(device.memory()) {
  const std::span<const PointStep> steps = assemble::pointSteps(appendOutput);
  for (const PointStep step : steps) {
    device.programs().ofAppends().points(appendOutput, step, {listLayout.layered, regionLayout.layered});
  }
  if (steps.front() == PointStep::SplitLimbs) {
    for (int c = 0; c < width(); ++c) takeFloats(limbs_, 4);
    target(limbs_.planes);
  } else if (steps.front() == PointStep::SplitUpper) {
    takeFloats(upper_, width());
    takeFloats(lower_, width());
  }
  target(planes);
}

void Scatterer::run() {
  switch (appendOutput_.scatter) {
    case ScatterOp::Store: return store(gl::Blend::None);
    case ScatterOp::Add: return isOfFloats(appendOutput_) ? store(gl::Blend::Add) : addIntegers();
    case ScatterOp::Min: return isOfFloats(appendOutput_) ? store(gl::Blend::Min) : extremeIntegers();
    case ScatterOp::Max: return isOfFloats(appendOutput_) ? store(gl::Blend::Max) : extremeIntegers();
  }
}

void Scatterer::store(gl::Blend blend) { points(PointStep::Store, blend, planes_, 0, length_); }

/// Draws at most mostLimbPoints points at a time, so that the sums of their limbs are exact.
void Scatterer::addIntegers() {
  for (std::int32_t first = 0; first < length_; first += assemble::mostLimbPoints) {
    region(PointStep::SplitLimbs, limbs_.planes);
    points(PointStep::AddLimbs, gl::Blend::Add, limbs_.planes, first,
           std::min(assemble::mostLimbPoints, length_ - first));
    bindAfterElements(limbs_.planes);
    region(PointStep::JoinLimbs, planes_);
  }
}

void Scatterer::extremeIntegers() {
  region(PointStep::SplitUpper, upper_.planes);
  points(PointStep::Upper, gl::Blend::Max, upper_.planes, 0, length_);
  bindAfterElements(upper_.planes);
  region(PointStep::SplitLower, lower_.planes);
  points(PointStep::Lower, gl::Blend::Max, lower_.planes, 0, length_);
  bindPlanes(device_, lower_.planes, bindAfterElements(upper_.planes));
  region(PointStep::JoinHalves, planes_);
}

/// Adds a plane of floats, as large as the output's planes.
void Scatterer::takeFloats(PlanesLease& lease, int width) {
  lease.add(floatsOf(width), planes_.front().shape(), whatFor);
}

/// Binds planes from unit 2 on, behind the two of a list, or of the elements. Returns the next unit.
int Scatterer::bindAfterElements(std::span<RenderTarget> planes) { return bindPlanes(device_, planes, 2); }

IntegerProgram& Scatterer::programOf(PointStep step) {
  IntegerProgram& program = device_.programs().ofAppends().points(
      appendOutput_, step, {listLayout_.layered, regionLayout_.layered});
  device_.bound().program(program.program().name());
  program.set(device_.bound(), "sk_domain_shift", regionLayout_.shift);
  return program;
}

DrawTarget Scatterer::target(std::span<RenderTarget> planes) {
  std::array<RenderTarget*, gl::maxDrawBuffers> renderTargets{};
  for (std::size_t i = 0; i < planes.size(); ++i) {
    renderTargets[i] = &planes[i];
  }
  return targetOf(device_, std::span(renderTargets).first(planes.size()));
}

/// Draws every point to every layer: it is clipped in all layers but its own.
void Scatterer::points(PointStep step, gl::Blend blend, std::span<RenderTarget> targets, std::int32_t first,
                       std::int32_t count) {
  IntegerProgram& program = programOf(step);
  const DrawTarget drawn = target(targets);
  bindPlanes(device_, list_, 0);
  const gl::Texture& texture = targets.front().texture;
  const gl::TextureSize& shape = texture.size();
  program.set(device_.bound(), "sk_list_shift", listLayout_.shift);
  program.set(device_.bound(), "sk_first", first);
  program.set(device_.bound(), "sk_size", gl::Int4{shape.width, shape.height, 0, 0});
  device_.passes().beginDraw();
  const gl::Blending blending(device_.capabilities, blend, device_.context().isGuest());
  const assemble::Rect whole{0, 0, shape.width, texture.rows()};
  const assemble::Rect written{0, 0, count, 1};
  const PassScope traced(device_, {appendOutput_.name, "scatter"}, std::span<const RenderTarget>(list_),
                         std::span(&written, 1), texelBytesOf(targets));
  forEachLayer(whole, drawn.layerRows, [&](const assemble::Rect& part, std::int32_t layer, std::int32_t) {
    selectLayer(device_.bound(), drawn, layer, program.row());
    device_.bound().viewport(0, 0, part.width, part.height);
    gl::drawPoints(device_.bound(), count);
  });
}

/// Draws a step over the region. Steps that draw to the elements' own planes do not read them.
void Scatterer::region(PointStep step, std::span<RenderTarget> targets) {
  IntegerProgram& program = programOf(step);
  const DrawTarget drawn = target(targets);
  bindPlanes(device_, planes_, 1);
  const PassScope traced(device_, {appendOutput_.name, "scatter"}, std::span<const RenderTarget>(planes_),
                         std::span<const assemble::Rect>(rects_), texelBytesOf(targets));
  drawRects(device_, drawn, rects_, program.row());
}

ListedScatter::ListedScatter(GlDevice& device, const program::Parameter& scatter, std::int32_t length,
                             RenderTarget* count)
    : device_(device),
      scatter_(scatter),
      length_(length),
      count_(count),
      sort_(device, length, assemble::isPair(scatter) ? WordSort::Of::Pairs : WordSort::Of::KeysAndPlaces),
      values_(device.memory()) {
  const bool isPair = assemble::isPair(scatter);
  if (!isPair) {
    const Layout layout = listLayout(length, device.textureLimits());
    shift_ = layout.whole.shift;
    values_.add(*scatter.element, layout.texture, "what a kernel scatters");
  }
  device.programs().ofAppends().records(scatter, count != nullptr);
  if (count != nullptr) fill(isPair ? *sort_.pairs : *sort_.keys);
}

/// What the kernel leaves free sorts behind all records.
void ListedScatter::fill(WordTexture& words) {
  const program::Kernel& kernel = lastWordKernel(assemble::isPair(scatter_) ? sortWordPairs() : sortWords());
  const Operand operands[] = {{}};
  RenderTarget* const targets[] = {&words.plane()};
  const assemble::RegionLayout domain = words.layoutOf({length_, 1, 1, 1});
  runKernel(device_, kernel, operands, domain, assemble::drawnTexels(domain), targets);
}

std::vector<RenderTarget*> ListedScatter::planes() {
  if (assemble::isPair(scatter_)) return {&sort_.pairs->plane()};
  return {&sort_.keys->plane(), &values_.planes.front()};
}

void ListedScatter::combine(GlStream& stream) {
  const assemble::TextureShape& texture = stream.layout.texture;
  const auto targets = static_cast<std::uint64_t>(texture.width) * static_cast<std::uint64_t>(texture.height);
  sort_.sort(std::bit_width(targets - 1));
  IntegerProgram& program = device_.programs().ofAppends().records(scatter_, count_ != nullptr);
  const std::int32_t tiles = (length_ - 1) / assemble::recordTile + 1;
  constexpr std::int32_t mostInRow = std::int32_t{1} << assemble::groupRowShift;
  const assemble::Rect groups{0, 0, std::min(tiles, mostInRow), (tiles - 1) / mostInRow + 1};
  const PassScope traced(device_, {scatter_.name, "combine records", "dispatch"}, std::int64_t{length_} * 8,
                         std::span<const assemble::Rect>(&groups, 1), std::size_t{assemble::recordTile} * 4);
  device_.bound().program(program.program().name());
  bindPlanes(device_, sort_.pairs->planes(), 0);
  if (count_ != nullptr) bindPlanes(device_, {count_, 1}, 1);
  if (!assemble::isPair(scatter_)) bindPlanes(device_, values_.planes, 2);
  if (device_.bound().isEs()) bindPlanes(device_, stream.planes, 3);
  const gl::Texture& target = stream.planes.front().texture;
  device_.bound().readWriteImage(0, target.name(), target.format().internalFormat);
  program.set(device_.bound(), "sk_length", length_);
  program.set(device_.bound(), "sk_tiles", tiles);
  program.set(device_.bound(), "sk_keys_shift", sort_.pairs->shift());
  program.set(device_.bound(), "sk_list_shift", shift_);
  program.set(device_.bound(), "sk_width", texture.width);
  program.set(device_.bound(), "sk_rect", gl::Int4{groups.x, groups.y, groups.width, groups.height});
  device_.passes().dispatch(groups.width, groups.height);
}

}  // namespace sk
