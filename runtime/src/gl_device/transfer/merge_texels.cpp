// SPDX-License-Identifier: MIT
#include "gl_device/transfer/merge_texels.hpp"

#include <algorithm>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "assemble/elements/planes.hpp"
#include "gl/blending.hpp"
#include "gl_device/pass/pass.hpp"
#include "gl_device/program/made_kernels.hpp"
#include "gl_device/transfer/copy_kernel.hpp"

namespace sk {

using assemble::lanes;
using assemble::Rect;
using assemble::RegionLayout;
using program::Kernel;
using program::Parameter;
using program::Role;

namespace {

/// Which elements of the region are in a texel: those at components first, first + step, ...
struct Columns {
  explicit Columns(const RegionLayout& target)
      : step(target.stride[0]),
        perTexel(lanes / step),
        first(target.origin[0] & (step - 1)),
        texel(target.origin[0] / lanes),
        // exact: the first element that the first texel would have is whole steps away from the region's first one
        before((lanes * texel + first - target.origin[0]) / step),
        last((target.origin[0] + (target.extent[0] - 1) * step) / lanes) {}

  std::int32_t step, perTexel;
  std::int32_t first;
  std::int32_t texel;  ///< the region's first, of a row
  std::int32_t before;  ///< the number of the element at component `first` of that texel, not above 0
  std::int32_t last;  ///< the region's last texel of a row
};

/// Whether the elements of each texel lie in one texel of the source.
bool readsTexels(const RegionLayout& source, const Columns& columns) {
  return source.packed && !source.strided && assemble::isWholeTexels(source) &&
         columns.before % columns.perTexel == 0;
}

/// The components of a texel, from elements of the source or from the texel that holds them, `v`.
std::string valuesOf(const Columns& columns, bool fromTexel) {
  std::string text;
  for (std::int32_t j = 0; j < columns.perTexel; ++j) {
    const std::int32_t component = columns.first + j * columns.step;
    const std::string element = !fromTexel                  ? fmt::format("sk_at_x(ivec2(k + {}, y))", j)
                                : columns.perTexel == lanes ? fmt::format("v[{}]", j)
                                : columns.perTexel == 1
                                    ? "v[k & 3]"
                                    : fmt::format("(k & 2) == 0 ? v[{}] : v[{}]", j, j + 2);
    text += fmt::format("  r[{}] = {};\n", component, element);
  }
  return text;
}

std::shared_ptr<const MadeKernel> mergeKernel(GlDevice& device, const program::Element& element,
                                              const Columns& columns, std::int32_t rows, bool fromTexel) {
  // the texels' bits, not the values that they stand for
  const program::Element& one = *copyKernel(element.fields.front()).parameters[0].element;
  const program::Element& four = assemble::fourOf(one.fields.front().scalar);
  std::string body =
      fmt::format("// {}\nvoid sk_merge(out {} r) {{\n  ivec2 t = sk_index().xy;\n", one.name, four.glsl);
  if (rows > 1) {
    body += fmt::format("  int y = int(uint(t.y) / {}u);\n  if (y * {} != t.y) discard;\n", rows, rows);
  } else {
    body += "  int y = t.y;\n";
  }
  body +=
      fmt::format("  int k = t.x * {} + {};\n  r = {}(0);\n", columns.perTexel, columns.before, four.glsl);
  if (fromTexel) body += fmt::format("  {} v = sk_at_x(ivec2(k >> 2, y));\n", four.glsl);
  body += valuesOf(columns, fromTexel) + "}\n";
  auto made = std::make_shared<MadeKernel>();
  made->body = std::move(body);
  made->parameters = {{.name = "x",
                       .symbol = "x",
                       .role = Role::Gather,
                       .element = fromTexel ? &four : &one,
                       .rank = 2,
                       .usesAt = true},
                      {.name = "r", .symbol = "r", .role = Role::Output, .element = &four}};
  made->kernel.name = "merge";
  made->kernel.entry = "sk_merge";
  made->kernel.body = made->body;
  made->kernel.parameters = made->parameters;
  made->kernel.usesIndex = true;
  return device.programs().mergeKernels().keep(std::move(made));
}

/// The texels from the region's first to its last one, with those of the rows between.
RegionLayout texelsAround(const RegionLayout& target, const Columns& columns) {
  RegionLayout texels;
  texels.view = true;
  texels.origin = {columns.texel, target.origin[1], 0, 0};
  texels.extent = {columns.last - columns.texel + 1, (target.extent[1] - 1) * target.stride[1] + 1, 1, 1};
  return texels;
}

struct Merge {
  Merge(GlDevice& device, const program::Element& element, const RegionLayout& source,
        const RegionLayout& target)
      : columns(target),
        fromTexel(readsTexels(source, columns)),
        made(mergeKernel(device, element, columns, target.stride[1], fromTexel)),
        kernel(made->kernel),
        read(fromTexel ? assemble::texelsOf(source) : source),
        domain(texelsAround(target, columns)) {}

  Columns columns;
  bool fromTexel;
  std::shared_ptr<const MadeKernel> made;
  const Kernel& kernel;
  RegionLayout read, domain;
};

/// The components of texels in column `x` that belong to the region.
gl::ColorMask maskOf(const RegionLayout& target, const Columns& columns, std::int32_t x) {
  gl::ColorMask mask{};
  const std::int32_t end = target.origin[0] + (target.extent[0] - 1) * columns.step;
  for (std::int32_t c = columns.first; c < lanes; c += columns.step) {
    const std::int32_t element = x * lanes + c;
    mask[static_cast<std::size_t>(c)] = element >= target.origin[0] && element <= end;
  }
  return mask;
}

}  // namespace

bool mayMerge(GlDevice& device, const RegionLayout& source, const RegionLayout& target) {
  const std::int32_t step = target.stride[0];
  return !device.programs().areDispatched() && !device.bound().isLogged() && target.packed &&
         target.strided && !target.linear && !target.numbered && (step == 1 || step == 2 || step == 4) &&
         !source.layered && std::equal(source.extent.begin(), source.extent.end(), target.extent.begin());
}

void prepareMerge(GlDevice& device, const program::Element& element, const RegionLayout& source,
                  const RegionLayout& target) {
  const Merge merge(device, element, source, target);
  const Operand operands[] = {{nullptr, merge.read, {}}, {}};
  device.programs().selected().kernelProgram(merge.kernel, operands, merge.domain);
}

void mergeTexels(GlDevice& device, const program::Element& element, std::span<RenderTarget> from,
                 const RegionLayout& source, RenderTarget& to, const RegionLayout& target) {
  const Merge merge(device, element, source, target);
  const Operand operands[] = {{nullptr, merge.read, from}, {}};
  RenderTarget* const targets[] = {&to};
  const std::int32_t height = merge.domain.extent[1];
  for (std::int32_t x = merge.columns.texel, end = 0; x <= merge.columns.last; x = end) {
    const gl::ColorMask mask = maskOf(target, merge.columns, x);
    end = x + 1;
    if (x != merge.columns.texel && x != merge.columns.last) end = merge.columns.last;
    const bool isOnly = x == merge.columns.texel && maskOf(target, merge.columns, merge.columns.last) == mask;
    if (isOnly) end = merge.columns.last + 1;  // no texel lacks any of its elements
    const Rect rect{x, merge.domain.origin[1], end - x, height};
    const gl::ColorMaskScope masked(device.bound(), mask);
    runKernel(device, merge.kernel, operands, merge.domain, std::span(&rect, 1), targets);
  }
}

}  // namespace sk
