// SPDX-License-Identifier: MIT
#include "gl_device/append/listed_scatter.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <utility>

#include "assemble/append/append_groups.hpp"
#include "assemble/append/scatter_programs.hpp"
#include "assemble/reduce/scan_plan.hpp"
#include "gl_device/pass/pass.hpp"
#include "gl_device/pass/pass_trace.hpp"
#include "gl_device/sort/sort_kernels.hpp"

namespace sk {

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
