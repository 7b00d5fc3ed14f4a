// SPDX-License-Identifier: MIT
#include "gl_device/append/histo_pyramid.hpp"

#include <array>
#include <bit>

#include <fmt/format.h>

#include "gl_device/pass/pass.hpp"
#include "gl_device/pass/pass_trace.hpp"
#include "sk/error.hpp"
#include "sk/types.hpp"

namespace sk {

namespace {

constexpr const char* whatForSums = "the sums of what a kernel pushes";

const program::Element& sums() { return ElementTraits<int4>::element(); }

}  // namespace

HistoPyramid::HistoPyramid(GlDevice& device, RenderTarget& counts, const Layout& layout)
    : device_(device),
      plan_(assemble::planPyramid(static_cast<std::int32_t>(assemble::elements(layout.whole.extent)),
                                  device.textureLimits())),
      odd_(device.memory()),
      even_(device.memory()) {
  odd_.add(sums(), plan_.odd, whatForSums);
  if (plan_.even.height > 0) {
    even_.add(sums(), plan_.even, whatForSums);
  }
  draw(plan_.levels.front(), counts, true, 0);
  for (std::size_t level = 2; level <= plan_.levels.size(); ++level) {
    draw(plan_.levels[level - 1], ofLevel(level - 1), false, plan_.levels[level - 2].row);
  }
}

/// Draws a level over the counts, or over the nodes of the level below, which begins in row `belowRow`.
void HistoPyramid::draw(const assemble::PyramidLevel& level, RenderTarget& below, bool ofCounts,
                        std::int32_t belowRow) {
  const gl::TextureSize& shape = below.texture.size();
  IntegerProgram& program =
      device_.programs().ofAppends().pyramid({ofCounts, below.texture.isLayered(), plan_.isLayered()});
  const auto number = static_cast<std::size_t>(&level - plan_.levels.data()) + 1;
  device_.bound().program(program.program().name());
  bindPlanes(device_, {&below, 1}, 0);
  program.set(device_.bound(), "sk_children", level.children);
  program.set(device_.bound(), "sk_tree_shift", plan_.shift);
  program.set(device_.bound(), "sk_row", level.row);
  if (ofCounts) {
    program.set(device_.bound(), "sk_below_width", shape.width);
    program.set(device_.bound(), "sk_below_shift",
                std::bit_width(static_cast<std::uint32_t>(shape.height)) - 1);
  } else {
    program.set(device_.bound(), "sk_below_row", belowRow);
  }
  RenderTarget& above = ofLevel(number);
  const auto bytesBelow = level.children * static_cast<std::int64_t>(below.texture.format().texelBytes());
  const PassScope traced(device_, {"sums of counts", "tree"}, bytesBelow,
                         std::span<const assemble::Rect>(level.draws), above.texture.format().texelBytes());
  drawRects(device_, targetOf(device_.bound(), above), level.draws, program.row());
}

std::int32_t HistoPyramid::total() {
  PlanesLease lease(device_.memory());
  lease.planes = totalTexture();
  return readTotal(device_, lease.planes.front());
}

std::vector<RenderTarget> HistoPyramid::totalTexture() {
  std::vector<RenderTarget> total = device_.memory().acquire(sums(), {1, 1}, whatForSums);
  gl::Framebuffer& from = ofLevel(plan_.levels.size()).framebufferIn(device_.bound());
  const GLuint to = total.front().framebufferIn(device_.bound()).name();
  std::int32_t row = plan_.levels.back().row;
  if (plan_.isLayered()) {
    from.selectLayer(device_.bound(), row >> plan_.shift);
    row &= (1 << plan_.shift) - 1;
  }
  device_.passes().blit(from.name(), {0, row}, to, {0, 0}, 1, 1);
  return total;
}

std::int32_t readTotal(GlDevice& device, RenderTarget& total) {
  const TraceScope traced(device.trace.get(), "transfer", "read number of pushes");
  std::array<std::int32_t, 4> sums{};
  total.framebufferIn(device.bound())
      .read(device.bound(), total.texture.format().tight, 0, 0, 1, 1, sums.data());
  device.throwPendingError();
  return sums[3];
}

}  // namespace sk
