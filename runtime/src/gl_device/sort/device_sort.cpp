// SPDX-License-Identifier: MIT
#include "gl_device/sort/device_sort.hpp"

#include <algorithm>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "assemble/elements/planes.hpp"
#include "assemble/reduce/scan_plan.hpp"
#include "gl/commands.hpp"
#include "gl_device/gl_device.hpp"
#include "gl_device/gl_stream.hpp"
#include "gl_device/pass/output_targets.hpp"
#include "gl_device/pass/pass.hpp"
#include "gl_device/pass/pass_trace.hpp"
#include "gl_device/sort/sort_kernels.hpp"
#include "gl_device/sort/word_sort.hpp"
#include "sk/error.hpp"
#include "sk/types.hpp"

namespace sk {

using assemble::RadixStep;
using assemble::RadixStorage;
using assemble::Rect;
using assemble::RegionLayout;
using program::Parameter;
using program::Role;

namespace {

/// The streams of a reordering. New elements are in new planes until all passes have run.
class StreamSort {
 public:
  StreamSort(GlDevice& device, const Reordering& reordering)
      : device_(device),
        reordering_(reordering),
        scalar_(reordering.keys.stream->element->fields.front().scalar),
        extent_(xFirst(reordering.keys.shape)),
        count_(static_cast<std::int32_t>(reordering.keys.shape.size())) {}

  std::int64_t run() {
    WordSort sort(device_, count_, needsPlaces() ? WordSort::Of::KeysAndPlaces : WordSort::Of::Keys);
    const std::int64_t first = sortWords(sort);
    std::deque<Moved> moved;
    for (const StreamRegion& region : reordering_.moved) moveTo(moved.emplace_back(device_, region), sort);
    if (reordering_.places != nullptr) storePlaces(sort);
    for (Moved& stream : moved) stream.targets.copy();
    for (Moved& stream : moved) stream.targets.exchange();
    return first;
  }

 private:
  bool isDescending() const { return reordering_.by == Reordering::By::DescendingKeys; }
  bool isKeys(const StreamRegion& region) const { return region.stream == reordering_.keys.stream; }
  bool isHalf() const { return reordering_.keys.stream->storage == Storage::Half; }
  /// Whether sorted words give the keys back.
  bool restoresKeys() const { return !reordering_.choosesFirst() && !hasTwoWords(scalar_) && !isHalf(); }
  bool needsPlaces() const {
    const auto isWithout = [&](const StreamRegion& region) {
      return isKeys(region) && restoresKeys() && scalar_ != program::Scalar::Float;
    };
    return reordering_.places != nullptr || hasTwoWords(scalar_) ||
           !std::ranges::all_of(reordering_.moved, isWithout);
  }

  // ---- words ------------------------------------------------------------------------------------

  /// Returns the number of elements that come first.
  std::int64_t sortWords(WordSort& sort) {
    switch (reordering_.by) {
      case Reordering::By::Keys:
      case Reordering::By::DescendingKeys: sortKeys(sort); return count_;
      case Reordering::By::Changes: findRepeats(sort); break;
      case Reordering::By::Flags: makeWords(flagKernel(scalar_), {&*sort.keys}); break;
    }
    return sort.divide();
  }

  void sortKeys(WordSort& sort) {
    if (!hasTwoWords(scalar_)) {
      makeWords(wordKernel(scalar_, isDescending()), {&*sort.keys});
      return sort.sort();
    }
    WordTexture upper(device_, count_);
    makeWords(wordKernel(scalar_, isDescending()), {&*sort.keys, &upper});
    sort.sort();
    WordTexture byUpper(device_, count_, sortWordPairs());
    const Operand operands[] = {operandOf(*sort.pairs), operandOf(upper), {}};
    runOver(upperWordKernel(), operands, byUpper);
    sort.pairs->swap(byUpper);
    sort.sortAgain();
  }

  void findRepeats(WordSort& sort) {
    WordTexture lower(device_, count_);
    if (!hasTwoWords(scalar_)) {
      makeWords(wordKernel(scalar_, false), {&lower});
      const Operand operands[] = {operandOf(lower), operandOf(lower), {}};
      return runOver(repeatKernel(scalar_), operands, *sort.keys);
    }
    WordTexture upper(device_, count_);
    makeWords(wordKernel(scalar_, false), {&lower, &upper});
    const Operand operands[] = {operandOf(lower), operandOf(lower), operandOf(upper), operandOf(upper), {}};
    runOver(repeatKernel(scalar_), operands, *sort.keys);
  }

  /// Makes words of the keys.
  void makeWords(const program::Kernel& kernel, std::initializer_list<WordTexture*> to) {
    std::vector<Operand> operands{regionOperand({.region = reordering_.keys}, reordering_.keys.shape)};
    std::vector<RenderTarget*> targets;
    for (WordTexture* words : to) {
      operands.emplace_back();
      targets.push_back(&words->plane());
    }
    const RegionLayout domain = (*to.begin())->layoutOf(extent_);
    runKernel(device_, kernel, operands, domain, assemble::drawnTexels(domain), targets);
  }

  /// The words as a stream of one dimension.
  Operand operandOf(WordTexture& words) const {
    return {.regionLayout = words.layoutOf({count_, 1, 1, 1}), .planes = words.planes()};
  }
  /// The words as a stream with the shape of the keys.
  Operand shapedOperandOf(WordTexture& words) const {
    return {.regionLayout = words.layoutOf(extent_), .planes = words.planes()};
  }

  void runOver(const program::Kernel& kernel, std::span<const Operand> operands, WordTexture& to) {
    const RegionLayout domain = to.layoutOf({count_, 1, 1, 1});
    RenderTarget* const targets[] = {&to.plane()};
    runKernel(device_, kernel, operands, domain, assemble::drawnTexels(domain), targets);
  }

  // ---- streams ----------------------------------------------------------------------------------

  /// A stream that is read at other places than it is written. OutputTargets takes what this kernel says of it.
  struct Moved {
    Moved(GlDevice& device, const StreamRegion& of)
        : region(unpackedUnlessWhole(of)),
          parameters{{{.name = "from", .symbol = "from", .role = Role::Gather, .element = of.stream->element},
                      {.name = "to", .symbol = "to", .role = Role::Output, .element = of.stream->element}}},
          arguments{{{.region = region}, {.region = region}}},
          operands{{regionOperand(arguments[0], region.shape), regionOperand(arguments[1], region.shape)}},
          targets(device, kernelOf(), arguments, specs, operands, operands[1].regionLayout,
                  glStream(region).layout) {}

    static StreamRegion unpackedUnlessWhole(const StreamRegion& region) {
      GlStream& stream = glStream(region);
      const RegionLayout layout = regionLayoutOf(region, stream.layout);
      if (layout.packed && !assemble::isWholeTexels(layout)) stream.unpack();
      return region;
    }
    const program::Kernel& kernelOf() {
      kernel.name = "sort";
      kernel.parameters = parameters;
      return kernel;
    }

    const StreamRegion region;
    const std::array<Parameter, 2> parameters;
    program::Kernel kernel;
    const std::array<Argument, 2> arguments;
    const assemble::SpecValues specs{};
    const std::array<Operand, 2> operands;
    OutputTargets targets;
  };

  /// Brings the elements of a stream into order, in new planes.
  void moveTo(Moved& moved, WordSort& sort) {
    const RegionLayout& domain = moved.operands[1].regionLayout;
    const std::vector<Rect> rects = assemble::drawnTexels(domain);
    const std::span<RenderTarget> to = moved.targets.planesOfOutputs()[1];
    const int rank = assemble::elements(domain.extent) == domain.extent[0] ? 1 : 4;
    Operand from = moved.operands[0];
    from.storage = Storage::Single;  // the planes are moved as they are
    const std::span<RenderTarget> planes = from.planes;
    const auto fields = glStream(moved.region).held().fields;
    for (std::size_t plane = 0; plane < planes.size(); ++plane) {
      RenderTarget* const targets[] = {&to[plane]};
      from.planes = planes.subspan(plane, 1);
      if (isKeys(moved.region) && restoresKeys()) {
        restoreKeys(from, domain, rects, targets, sort, rank);
        continue;
      }
      const Operand operands[] = {shapedOperandOf(*sort.pairs), from, {}};
      runKernel(device_, moveKernel(fields[plane], rank), operands, domain, rects, targets);
    }
  }

  void restoreKeys(const Operand& keys, const RegionLayout& domain, std::span<const Rect> rects,
                   std::span<RenderTarget* const> targets, WordSort& sort, int rank) {
    const program::Kernel& kernel = restoreKernel(scalar_, isDescending(), sort.pairs.has_value(), rank);
    std::vector<Operand> operands{shapedOperandOf(sort.pairs ? *sort.pairs : *sort.keys)};
    if (scalar_ == program::Scalar::Float) operands.push_back(keys);
    operands.emplace_back();
    runKernel(device_, kernel, operands, domain, rects, targets);
  }

  /// Stores the places to a stream of the keys' shape, which holds nothing yet.
  void storePlaces(WordSort& sort) {
    GlStream& stream = glStream(*reordering_.places);
    const RegionLayout& domain = stream.layout.whole;
    const Operand operands[] = {shapedOperandOf(*sort.pairs), {}};
    RenderTarget* const targets[] = {&stream.planes.front()};
    runKernel(device_, placeKernel(), operands, domain, stream.layout.draws, targets);
    stream.setWritten();
  }

  GlDevice& device_;
  const Reordering& reordering_;
  const program::Scalar scalar_;  ///< of keys or flags
  const assemble::Index4 extent_;
  const std::int32_t count_;
};

}  // namespace

bool maySortByDispatches(const GlDevice& device, const Reordering& reordering) {
  const StreamState& keys = *reordering.keys.stream;
  const bool isStoredSo =
      keys.storage == Storage::Single ||
      (keys.storage == Storage::Half && !hasTwoWords(keys.element->fields.front().scalar));
  return isStoredSo && WordSort::isPossible(device, reordering.keys.shape.size());
}

std::int64_t sortByDispatches(GlDevice& device, const Reordering& reordering) {
  return StreamSort(device, reordering).run();
}

std::optional<std::int64_t> GlDevice::reorder(const Reordering& reordering) {
  if (target == Target::Fragment || !capabilities.hasCompute || !traits.sortsByDispatches ||
      !maySortByDispatches(*this, reordering))
    return std::nullopt;
  const DeviceScope scope(*this);
  const gl::LabelGroup group(context().labels(), "sort");
  programs_.select({}, assemble::Stage::Compute);
  return sortByDispatches(*this, reordering);
}

}  // namespace sk
