// SPDX-License-Identifier: MIT
#include "gl_device/gl_stream.hpp"

#include <algorithm>
#include <memory>
#include <new>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "assemble/elements/planes.hpp"
#include "assemble/region_layout.hpp"
#include "device/write_scope.hpp"
#include "gl/blending.hpp"
#include "gl_device/append/histo_pyramid.hpp"
#include "gl_device/gl_device.hpp"
#include "gl_device/pass/pass.hpp"
#include "gl_device/program/made_kernels.hpp"
#include "gl_device/transfer/buffered_transfer.hpp"
#include "gl_device/transfer/copy_kernel.hpp"
#include "gl_device/transfer/transfer.hpp"
#include "sk/error.hpp"
#include "sk/program.hpp"
#include "support/convert_elements.hpp"

namespace sk {

namespace {

// Draws elements to a strided region of a packed stream. If the stride along x is 1, 2 or 4, the region has the same components of
// each texel, and a colour mask keeps the others as they are. So a texel is drawn once, and the stream stays packed.

using assemble::lanes;
using assemble::Rect;
using assemble::RegionLayout;
using program::Kernel;
using program::Parameter;
using program::Role;

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

/// Whether the region of a packed stream consists of the same components of each texel, and rows at regular distances, and passes are
/// drawn. A loop that is recorded repeats no such pass.
bool mayMerge(GlDevice& device, const RegionLayout& source, const RegionLayout& target) {
  const std::int32_t step = target.stride[0];
  return !device.programs().areDispatched() && !device.bound().isLogged() && target.packed &&
         target.strided && !target.linear && !target.numbered && (step == 1 || step == 2 || step == 4) &&
         !source.layered && std::equal(source.extent.begin(), source.extent.end(), target.extent.begin());
}

/// Compiles the program, so that mergeTexels() cannot fail for it.
void prepareMerge(GlDevice& device, const program::Element& element, const RegionLayout& source,
                  const RegionLayout& target) {
  const Merge merge(device, element, source, target);
  const Operand operands[] = {{nullptr, merge.read, {}}, {}};
  device.programs().selected().kernelProgram(merge.kernel, operands, merge.domain);
}

/// Copies the elements of `source`, which lies in `from`, to `target` in `to`. Both hold scalars of type `element`.
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

}  // namespace

GlStream::GlStream(GlDevice& on, const program::Element& type, const Shape& extents, Storage as)
    : StreamState(on, type, extents, as) {
  if (storage != Storage::Single) {
    held_ = std::make_unique<assemble::HeldElement>(type, storage);
  }
  layout = layoutOf(extents, on.textureLimits(), canPack());
  planes = acquirePlanesFor(layout);
}

GlStream::~GlStream() {
  if (device == nullptr) {
    return;
  }
  if (total_) {
    owner().memory().pool().release(std::move(total_));
  }
  owner().memory().release(planes);
}

std::vector<RenderTarget> GlStream::acquirePlanesFor(const Layout& planned) {
  if (planned.texture.width == 0) {
    return {};
  }
  const program::Element& texel =
      planned.whole.packed ? assemble::fourOf(held().fields.front().scalar) : held();
  return owner().memory().acquire(texel, planned.texture,
                                  fmt::format("a stream of {} of shape {}", element->name, toString(shape)));
}

void GlStream::unpack() {
  if (!layout.whole.packed) {
    return;
  }
  Layout wanted = layoutOf(shape, owner().textureLimits());
  PlanesLease lease(owner().memory());
  lease.planes = acquirePlanesFor(wanted);
  copyRegion(owner(), held(), planes, layout.whole, lease.planes, wanted.whole);
  std::swap(planes, lease.planes);
  layout = std::move(wanted);
  period_ = owner().context().period();
  labelPlanes();
}

GlDevice& GlStream::owner() const { return static_cast<GlDevice&>(*device); }

void GlStream::replaceElements(std::vector<RenderTarget>& elements, Layout&& list,
                               RenderTarget* total) noexcept {
  std::swap(planes, elements);
  layout = std::move(list);
  if (total_) {
    owner().memory().pool().release(std::move(total_));
    total_ = {};
  }
  if (total != nullptr) {
    total_ = std::move(*total);
  } else {
    shape = Shape(layout.whole.extent[0]);
  }
  setWritten();
}

void GlStream::setWritten() noexcept {
  StreamState::setWritten();
  period_ = owner().context().period();
}

void GlStream::settle() {
  if (!total_) {
    return;
  }
  const DeviceScope scope(owner());
  const std::int32_t count = isLost() ? 0 : readTotal(owner(), total_);
  layout = withSize(layout, count);
  shape = Shape(count);
  owner().memory().pool().release(std::move(total_));
  total_ = {};
}

Layout GlStream::withSize(Layout list, std::int32_t count) {
  list.whole.extent = {count, 1, 1, 1};
  list.whole.stride = assemble::stridesOf(list.whole.extent);
  list.draws = assemble::drawnTexels(list.whole);
  return list;
}

// Packed texels are transferred as they are if the region consists of whole ones; else the stream is
// unpacked.
GlStream::TransferRegion GlStream::transferRegion(const StreamRegion& region) {
  const RegionLayout place = regionLayoutOf(region, layout);
  if (!place.packed) {
    return {&held(), region.shape, place};
  }
  if (!assemble::isWholeTexels(place)) {
    unpack();
    return {&held(), region.shape, regionLayoutOf(region, layout)};
  }
  const int last = region.shape.rank() - 1;
  return {&assemble::fourOf(held().fields.front().scalar),
          region.shape.with(last, region.shape[last] / assemble::lanes), assemble::texelsOf(place)};
}

/// Whether writing to a region is faster through a pixel buffer. On a GPU it is for parts of a stream: from
/// host memory, a driver may transfer the whole texture to change a part of it. Whole streams, and all streams
/// of a software renderer, are written faster without a buffer.
bool GlStream::writesThroughBuffer(const StreamRegion& region) const {
  const std::int64_t bytes = region.shape.size() * static_cast<std::int64_t>(held().size);
  return region.shape != shape && bytes <= owner().traits.bufferedWriteBytes;
}

void GlStream::uploadHeld(const StreamRegion& region, const std::byte* elements, bool isBuffered) {
  const TransferRegion what = transferRegion(region);
  WriteScope writes;
  writes.add(this);
  if (isBuffered) {
    writeBuffered(owner(), *what.element, planes, what.place, elements, writes);
  } else {
    upload(owner(), *what.element, planes, what.place, elements, writes);
  }
  writes.commit();
}

void GlStream::downloadHeld(const StreamRegion& region, std::byte* elements) {
  const TransferRegion what = transferRegion(region);
  download(owner(), *what.element, planes, what.place, elements);
}

void GlStream::setName(std::string_view given) {
  StreamState::setName(given);
  if (owner().context().labels().isOn()) {
    const DeviceScope scope(owner());
    labelPlanes();
  }
}

void GlStream::labelPlanes() const noexcept {
  if (name.empty() || !owner().context().labels().isOn()) {
    return;
  }
  try {
    const std::span<const program::Field> fields = held().fields;
    for (std::size_t i = 0; i < planes.size(); ++i) {
      owner().context().labels().texture(
          planes[i].texture.name(),
          fields[i].path.empty() ? name : fmt::format("{}.{}", name, fields[i].path));
    }
  } catch (const std::bad_alloc&) {
    return;  // the planes keep their previous labels
  }
}

void GlStream::write(const StreamRegion& region, const std::byte* elements) {
  const DeviceScope scope(owner());
  writeDeclared(region, elements, writesThroughBuffer(region));
}

void GlStream::writeAsync(const StreamRegion& region, const std::byte* elements) {
  const DeviceScope scope(owner());
  writeDeclared(region, elements, /*isBuffered=*/true);
}

void GlStream::writeDeclared(const StreamRegion& region, const std::byte* elements, bool isBuffered) {
  writeConverted(held(), *element, static_cast<std::size_t>(region.shape.size()), elements,
                 [&](const std::byte* converted) { uploadHeld(region, converted, isBuffered); });
}

void GlStream::read(const StreamRegion& region, std::byte* elements) {
  const DeviceScope scope(owner());
  readConverted(held(), *element, static_cast<std::size_t>(region.shape.size()), elements,
                [&](std::byte* converted) { downloadHeld(region, converted); });
}

std::unique_ptr<TransferState> GlStream::readAsync(const StreamRegion& region) {
  const DeviceScope scope(owner());
  return std::make_unique<PendingRead>(owner(), *this, region);
}

void GlStream::readReals(const StreamRegion& region, double* values) {
  const DeviceScope scope(owner());
  const auto count = static_cast<std::size_t>(region.shape.size());
  std::vector<std::byte> converted(count * held().size);
  downloadHeld(region, converted.data());
  readComponents(held(), converted.data(), count, values);
}

void GlStream::writeReals(const StreamRegion& region, const double* values) {
  const DeviceScope scope(owner());
  const auto count = static_cast<std::size_t>(region.shape.size());
  std::vector<std::byte> converted(count * held().size);
  writeComponents(held(), converted.data(), count, values);
  uploadHeld(region, converted.data(), writesThroughBuffer(region));
}

// Runs a copy kernel whose input, one texel with the value, is broadcast to the region.
void GlStream::fill(const StreamRegion& region, const std::byte* value) {
  const DeviceScope scope(owner());
  const TransferRegion what = transferRegion(region);
  std::vector<std::byte> texel(std::max(what.element->size, held().size));
  writeConverted(held(), *element, 1, value,
                 [&](const std::byte* converted) { std::copy_n(converted, held().size, texel.begin()); });
  for (std::size_t at = held().size; at < what.element->size; at += held().size) {
    std::copy_n(texel.begin(), held().size, texel.begin() + static_cast<std::ptrdiff_t>(at));
  }
  PlanesLease one(owner().memory());
  const RegionLayout single{.extent = {1, 1, 1, 1}};
  {
    const UnreservedScope unreserved(owner().memory().pool());  // a loop keeps the texel
    const gl::UnloggedScope unlogged(owner().bound());
    one.add(*what.element, {1, 1}, "the value of fill()");
    WriteScope ofNoStream;
    upload(owner(), *what.element, one.planes, single, texel.data(), ofNoStream);
  }
  const std::vector<assemble::Rect> rects = assemble::drawnTexels(what.place);
  prepareCopy(owner(), *what.element, single, what.place, /*byKernel=*/true);
  StreamState* const written[] = {this};
  WriteScope writes(written);
  for (std::size_t plane = 0; plane < planes.size(); ++plane) {
    const Operand operands[] = {{nullptr, single, std::span(one.planes).subspan(plane, 1)}, {}};
    RenderTarget* const targets[] = {&planes[plane]};
    runKernel(owner(), copyKernel(what.element->fields[plane]), operands, what.place, rects, targets);
  }
  owner().memory().pool().keep(one.planes);
  writes.commit();
}

bool GlStream::copyFrom(const StreamRegion& from, const StreamRegion& to) {
  GlStream& source = glStream(from);
  if (source.storage != storage) return false;
  const DeviceScope scope(owner());
  const auto isWholeTexels = [](const StreamRegion& region) {
    const RegionLayout place = regionLayoutOf(region, glStream(region).layout);
    return place.packed && assemble::isWholeTexels(place);
  };
  // copies from and to strided regions read single elements, packed or not
  const bool isFromStrides = regionLayoutOf(from, source.layout).strided;
  const bool isToStrides = regionLayoutOf(to, layout).strided;
  const bool isMerged = mayMerge(owner(), regionLayoutOf(from, source.layout), regionLayoutOf(to, layout));
  if (isMerged) {
    // elements between those of the region stay in their texels
  } else if (!isWholeTexels(to) || (!isFromStrides && !isWholeTexels(from))) {
    if (!isFromStrides && !isToStrides) source.unpack();
    unpack();
  }
  const RegionLayout place = regionLayoutOf(to, layout);
  const RegionLayout sourcePlace = regionLayoutOf(from, source.layout);
  isMerged ? prepareMerge(owner(), held(), sourcePlace, place)
           : prepareCopy(owner(), held(), sourcePlace, place);
  PlanesLease before(owner().memory());
  if (&source == this) {  // the regions may overlap: reads from a copy of the stream
    before.planes = acquirePlanesFor(layout);
    copyRegion(owner(), held(), planes, layout.whole, before.planes, layout.whole);
  }
  StreamState* const written[] = {this};
  WriteScope writes(written);
  const std::span<RenderTarget> read = &source == this ? before.planes : source.planes;
  isMerged ? mergeTexels(owner(), held(), read, sourcePlace, planes.front(), place)
           : copyRegion(owner(), held(), read, sourcePlace, planes, place);
  writes.commit();
  return true;
}

void GlStream::exchangeElements(StreamState& other) noexcept {
  auto& with = static_cast<GlStream&>(other);
  std::swap(planes, with.planes);
  std::swap(layout, with.layout);
  std::swap(period_, with.period_);
  exchangeMarks(other);
  labelPlanes();
  with.labelPlanes();
}

/// The application does not ask the device for errors before it draws from what it gets.
void GlStream::throwLoopReport() {
  if (owner().passes().loopReports().isOpen()) owner().throwPendingError();
}

StreamTexture GlStream::texture(int plane) {
  static_cast<void>(owner().context().living());
  if (planes.empty()) {
    return {};
  }
  if (layout.whole.packed || owner().passes().loopReports().isOpen()) {
    const DeviceScope scope(owner());
    throwLoopReport();
    if (layout.whole.packed) unpack();
  }
  const gl::Texture& texture = planes[static_cast<std::size_t>(plane)].texture;
  const gl::TextureSize& extents = texture.size();
  return {texture.name(), texture.format().internalFormat, extents.width, extents.height, layout.whole.linear,
          extents.layers};
}

void GlStream::fillBuffer(std::uint32_t buffer, std::int64_t byteOffset, int plane) {
  const DeviceScope scope(owner());
  throwLoopReport();
  const TransferRegion what = transferRegion({this, {}, shape});
  readToBuffer(owner(), planes[static_cast<std::size_t>(plane)], what.place, buffer,
               static_cast<std::size_t>(byteOffset));
}

}  // namespace sk
