// SPDX-License-Identifier: MIT
//
// Drawing the levels of a tree, and reading its root.
#include "sink_list.hpp"

#include <array>

#include <fmt/format.h>

#include "gl/commands.hpp"
#include "pass.hpp"
#include "sk/error.hpp"
#include "sk/types.hpp"

namespace sk {

namespace {

constexpr const char* whatFor = "the sums of what a kernel pushes";

const program::Element& sums() { return ElementTraits<int4>::element(); }

}  // namespace

CountTree::CountTree(DeviceState& device, Surface& counts, const Layout& layout)
    : device_(device),
      plan_(assemble::planTree(static_cast<std::int32_t>(assemble::elements(layout.whole.extent)),
                               device.limits.textureSize)),
      odd_(device),
      even_(device) {
  const std::int32_t width = 1 << plan_.shift;
  odd_.planes = device.takePlanes(sums(), width, plan_.oddRows, whatFor);
  if (plan_.evenRows > 0) {
    even_.planes = device.takePlanes(sums(), width, plan_.evenRows, whatFor);
  }
  draw(plan_.levels.front(), counts, layout.width, 0);
  for (std::size_t level = 2; level <= plan_.levels.size(); ++level) {
    draw(plan_.levels[level - 1], ofLevel(level - 1), 0, plan_.levels[level - 2].row);
  }
}

/// A level of counts, where their texture's width is given, or else of nodes that start in row `belowRow`.
void CountTree::draw(const assemble::TreeLevel& level, Surface& below, std::int32_t belowWidth,
                     std::int32_t belowRow) {
  const bool ofCounts = belowWidth > 0;
  StepProgram& program = device_.sinkPrograms.tree(ofCounts);
  const auto number = static_cast<std::size_t>(&level - plan_.levels.data()) + 1;
  device_.bound.program(program.program().name());
  device_.bound.framebuffer(ofLevel(number).framebufferName(device_.bound));
  device_.bound.texture(0, below.texture.name());
  program.set("sk_children", level.children);
  program.set("sk_tree_shift", plan_.shift);
  program.set("sk_row", level.row);
  if (ofCounts) {
    program.set("sk_below_width", belowWidth);
  } else {
    program.set("sk_below_row", belowRow);
  }
  drawRects(device_, level.draws);
}

std::int32_t CountTree::total() {
  PlanesLease lease(device_);
  lease.planes = totalTexture();
  return readTotal(device_, lease.planes.front());
}

std::vector<Surface> CountTree::totalTexture() {
  std::vector<Surface> total = device_.takePlanes(sums(), 1, 1, whatFor);
  const GLuint from = ofLevel(plan_.levels.size()).framebufferName(device_.bound);
  const GLuint to = total.front().framebufferName(device_.bound);
  gl::blit(device_.bound, from, {0, plan_.levels.back().row}, to, {0, 0}, 1, 1);
  return total;
}

std::int32_t readTotal(DeviceState& device, Surface& total) {
  std::array<std::int32_t, 4> sums{};
  total.framebufferName(device.bound);
  total.framebuffer.read(device.bound, total.texture.format().tight, 0, 0, 1, 1, sums.data());
  device.throwPendingError();
  return sums[3];
}

Layout listLayout(std::int64_t length, std::int32_t textureSize) {
  Layout layout;
  layout.whole.linear = true;
  layout.whole.shift = assemble::linearShift(length, textureSize);
  const std::int64_t width = std::int64_t{1} << layout.whole.shift;
  const std::int64_t height = (length + width - 1) >> layout.whole.shift;
  if (height > textureSize) {
    throw Error(
        fmt::format("{} elements are pushed or scattered, but one texture of this device holds {} "
                    "({} x {} texels); divide the domain",
                    length, width * textureSize, width, textureSize));
  }
  layout.whole.extent = {static_cast<std::int32_t>(length), 1, 1, 1};
  layout.whole.stride = assemble::stridesOf(layout.whole.extent);
  layout.width = static_cast<std::int32_t>(width);
  layout.height = static_cast<std::int32_t>(height);
  layout.draws = assemble::drawnTexels(layout.whole);
  return layout;
}

}  // namespace sk
