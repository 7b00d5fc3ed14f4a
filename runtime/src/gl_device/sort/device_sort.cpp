// SPDX-License-Identifier: MIT
#include "gl_device/sort/device_sort.hpp"

#include <algorithm>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "assemble/elements/planes.hpp"
#include "assemble/reduce/scan_tiles.hpp"
#include "gl/commands.hpp"
#include "gl_device/gl_device.hpp"
#include "gl_device/gl_stream.hpp"
#include "gl_device/pass/output_targets.hpp"
#include "gl_device/pass/pass.hpp"
#include "gl_device/pass/pass_trace.hpp"
#include "gl_device/sort/sort_kernels.hpp"
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

constexpr const char* whatForSort = "a sort";

std::int32_t divideUp(std::int32_t a, std::int32_t b) { return (a - 1) / b + 1; }

/// A linearised texture of words, or of pairs of them.
class WordTexture {
 public:
  WordTexture(GlDevice& device, std::int32_t count, const program::Element& element = sortWords())
      : texture_(*assemble::linearTexture(count, device.textureLimits())),
        shift_(assemble::linearLayout(count, texture_).shift),
        lease_(device) {
    lease_.planes = device.acquirePlanes(element, texture_, whatForSort);
  }

  std::int32_t shift() const { return shift_; }
  std::span<RenderTarget> planes() { return lease_.planes; }
  RenderTarget& plane() { return lease_.planes.front(); }
  /// The layout of elements of this shape, x first, that take one word each.
  RegionLayout layoutOf(const assemble::Index4& extent) const {
    return {.linear = true, .extent = extent, .stride = assemble::stridesOf(extent), .shift = shift_};
  }
  void swap(WordTexture& other) noexcept { std::swap(lease_.planes, other.lease_.planes); }

 private:
  assemble::TextureShape texture_;
  std::int32_t shift_;
  PlanesLease lease_;
};

struct Uniform {
  std::string_view name;
  std::int32_t value;
};

/// Dispatches a group for each tile. Words in the buffer take the place of the first that is read or written, which is null.
void dispatchTiles(GlDevice& device, RadixStep step, std::string_view name,
                   std::span<WordTexture* const> read, std::span<WordTexture* const> written,
                   std::span<const Uniform> uniforms, std::int32_t tiles) {
  const RadixStorage storage{.reads = read.front() == nullptr, .writes = written.front() == nullptr};
  IntegerProgram& program = device.sortPrograms.of(step, storage);
  constexpr std::int32_t mostInRow = std::int32_t{1} << assemble::groupRowShift;
  const Rect groups{0, 0, std::min(tiles, mostInRow), divideUp(tiles, mostInRow)};
  const std::int64_t bytes =
      std::int64_t{tiles} * assemble::radixTile * 4 * static_cast<std::int64_t>(read.size());
  const PassScope traced(device, {name, "sort", "dispatch"}, bytes, std::span<const Rect>(&groups, 1),
                         std::size_t{assemble::radixTile} * 4);
  device.bound.program(program.program().name());
  int unit = 0;
  for (WordTexture* words : read) {
    if (words == nullptr) {
      ++unit;
    } else {
      unit = bindPlanes(device, words->planes(), unit);
    }
  }
  unit = 0;
  for (WordTexture* words : written) {
    if (words == nullptr) break;
    const gl::Texture& texture = words->plane().texture;
    device.bound.image(unit++, texture.name(), texture.format().internalFormat);
  }
  for (const Uniform& uniform : uniforms) program.set(device.bound, uniform.name, uniform.value);
  program.set(device.bound, "sk_tiles", tiles);
  program.set(device.bound, "sk_rect", gl::Int4{groups.x, groups.y, groups.width, groups.height});
  if (std::exchange(device.hasDrawn, false)) gl::finishDraws(device.bound);
  gl::dispatch(device.bound, groups.width, groups.height);
  if (storage.writes) gl::finishStorage(device.bound);
}

/// Sorts words, or pairs of words and the places that they come from, digit by digit.
class WordSort {
 public:
  WordSort(GlDevice& device, std::int32_t count, bool keepsPlaces)
      : device_(device),
        count_(count),
        tiles_(divideUp(count, assemble::radixTile)),
        counts_(device, tiles_ * assemble::radixDigits),
        sums_(device, tiles_ * assemble::radixDigits),
        totals_(device, divideUp(tiles_ * assemble::radixDigits, assemble::radixTile)),
        totalSums_(device, divideUp(tiles_ * assemble::radixDigits, assemble::radixTile)),
        all_(device, 1),
        keys(device, count) {
    if (keepsPlaces) pairs.emplace(device, count, sortWordPairs());
    if (!takesBuffer()) moved_.emplace(device, count, keepsPlaces ? sortWordPairs() : sortWords());
  }

  /// Sorts `keys` to `pairs`, or to `keys` if there are no pairs.
  void sort() { sortByAll(true); }
  /// Sorts `pairs`.
  void sortAgain() { sortByAll(false); }

  /// Divides `keys`, each 0 or 1, to `pairs`. Returns the number of zeros; waits for the device.
  std::int64_t divide() {
    sortBy(0, true);
    storePairs();
    const TraceScope traced(device_.trace.get(), "transfer", "read number of elements");
    const std::int32_t ones = tiles_;  // the sum before the ones of the first tile
    const std::uint32_t inTile = read(sums_, ones);
    const std::uint32_t before = read(totalSums_, ones / assemble::radixTile);
    device_.throwPendingError();
    return std::int64_t{inTile} + before;
  }

 private:
  void sortByAll(bool fromKeys) {
    constexpr int digits = 4;  // of 8 bits in a word
    for (int digit = 0; digit < digits; ++digit) sortBy(digit, digit == 0 ? fromKeys : !pairs);
    storePairs();
  }

  /// Takes memory for two arrays of pairs besides the textures; false if the device's buffers are too small, or if a loop
  /// records the commands, which it could not repeat. Single words are moved as fast from texture to texture.
  bool takesBuffer() {
    const std::int64_t bytes = std::int64_t{count_} * 16;
    inBuffer_ = pairs && !device_.bound.isLogged() && bytes <= device_.capabilities.storageBytes &&
                device_.sortedWords.bind(device_.bound, static_cast<std::size_t>(bytes));
    return inBuffer_;
  }

  /// Brings sorted pairs from the buffer to `pairs`.
  void storePairs() {
    if (!inBuffer_) return;
    WordTexture& to = *pairs;
    run(RadixStep::StorePairs, "store keys", {nullptr}, {&to},
        {{"sk_keys_shift", to.shift()}, {"sk_length", count_}, {"sk_from", current_}}, tiles_);
    isStored_ = false;
  }

  void sortBy(int digit, bool readsKeys) {
    const Uniform shift{"sk_digit", 8 * digit};
    const Uniform keyShift{"sk_keys_shift", keys.shift()}, countShift{"sk_counts_shift", counts_.shift()};
    const Uniform totalShift{"sk_totals_shift", totals_.shift()}, length{"sk_length", count_};
    const std::int32_t counts = tiles_ * assemble::radixDigits;
    const std::int32_t groups = divideUp(counts, assemble::radixTile);
    WordTexture* const from = isStored_ ? nullptr : readsKeys ? &keys : &*pairs;
    const std::int32_t to = isStored_ && current_ == 0 ? count_ : 0;
    run(isStored_ ? RadixStep::CountPairs : RadixStep::Count, "count digits", {from}, {&counts_},
        {shift, keyShift, countShift, length, {"sk_from", current_}}, tiles_);
    run(RadixStep::Sum, "sum counts", {&counts_}, {&sums_, &totals_},
        {{"sk_length", counts}, countShift, totalShift}, groups);
    run(RadixStep::Sum, "sum counts", {&totals_}, {&totalSums_, &all_},
        {{"sk_length", groups}, {"sk_counts_shift", totals_.shift()}, {"sk_totals_shift", all_.shift()}}, 1);
    const RadixStep move = !pairs ? RadixStep::Move : readsKeys ? RadixStep::MoveFirst : RadixStep::MovePairs;
    run(move, "move keys", {from, &sums_, &totalSums_}, {inBuffer_ ? nullptr : &*moved_},
        {shift, keyShift, countShift, totalShift, length, {"sk_from", current_}, {"sk_to", to}}, tiles_);
    current_ = to;
    isStored_ = inBuffer_;
    if (!inBuffer_) (pairs ? *pairs : keys).swap(*moved_);
  }

  void run(RadixStep step, std::string_view name, std::initializer_list<WordTexture*> read,
           std::initializer_list<WordTexture*> written, std::initializer_list<Uniform> uniforms,
           std::int32_t tiles) {
    dispatchTiles(device_, step, name, {read.begin(), read.size()}, {written.begin(), written.size()},
                  {uniforms.begin(), uniforms.size()}, tiles);
  }

  std::uint32_t read(WordTexture& words, std::int32_t number) {
    std::uint32_t word = 0;
    RenderTarget& plane = words.plane();
    plane.framebufferIn(device_.bound)
        .read(device_.bound, plane.texture.format().tight, number & ((1 << words.shift()) - 1),
              number >> words.shift(), 1, 1, &word);
    return word;
  }

  GlDevice& device_;
  const std::int32_t count_, tiles_;
  WordTexture counts_, sums_, totals_, totalSums_, all_;

 public:
  WordTexture keys;
  std::optional<WordTexture> pairs;  ///< of keys and places; if it keeps places

 private:
  std::optional<WordTexture> moved_;  ///< without a buffer
  bool inBuffer_ = false;  ///< pairs lie in the buffer between two digits
  bool isStored_ = false;  ///< the current pairs lie there, from number current_ on
  std::int32_t current_ = 0;
};

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
    WordSort sort(device_, count_, needsPlaces());
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
      case Reordering::By::Flags: makeWords(flagKernel(scalar_), {&sort.keys}); break;
    }
    return sort.divide();
  }

  void sortKeys(WordSort& sort) {
    if (!hasTwoWords(scalar_)) {
      makeWords(wordKernel(scalar_, isDescending()), {&sort.keys});
      return sort.sort();
    }
    WordTexture upper(device_, count_);
    makeWords(wordKernel(scalar_, isDescending()), {&sort.keys, &upper});
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
      return runOver(repeatKernel(scalar_), operands, sort.keys);
    }
    WordTexture upper(device_, count_);
    makeWords(wordKernel(scalar_, false), {&lower, &upper});
    const Operand operands[] = {operandOf(lower), operandOf(lower), operandOf(upper), operandOf(upper), {}};
    runOver(repeatKernel(scalar_), operands, sort.keys);
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
    std::vector<Operand> operands{shapedOperandOf(sort.pairs ? *sort.pairs : sort.keys)};
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

IntegerProgram& SortPrograms::of(RadixStep step, RadixStorage storage) {
  const std::size_t number =
      4 * static_cast<std::size_t>(step) + (storage.reads ? 2 : 0) + (storage.writes ? 1 : 0);
  std::unique_ptr<IntegerProgram>& known = programs_[number];
  if (known) return *known;
  std::string log;
  gl::Program program =
      ProgramBuild(device_, {{}, assemble::radixProgram(device_.computeProfile, step, storage)})
          .finish(device_, log);
  if (!program) {
    device_.throwIfLost();
    throw Error(fmt::format("the driver of '{}' refuses a program of sk::sort:\n{}",
                            device_.capabilities.renderer, log),
                Error::Kind::Compile);
  }
  known = std::make_unique<IntegerProgram>(std::move(program));
  const gl::Program& linked = known->program();
  device_.bound.program(linked.name());
  int unit = 0;
  if (step == RadixStep::Sum) {
    linked.setSampler("sk_counts", unit);
  } else {
    for (const char* name : {"sk_keys", "sk_sums", "sk_totals"}) linked.setSampler(name, unit++);
  }
  return *known;
}

bool maySortByDispatches(const GlDevice& device, const Reordering& reordering) {
  const StreamState& keys = *reordering.keys.stream;
  const bool isStoredSo =
      keys.storage == Storage::Single ||
      (keys.storage == Storage::Half && !hasTwoWords(keys.element->fields.front().scalar));
  const std::int64_t count = reordering.keys.shape.size();
  constexpr std::int64_t most = std::int64_t{assemble::radixTile} * assemble::radixTile *
                                (assemble::radixTile / assemble::radixDigits);  // the totals are one tile
  if (!isStoredSo || count > most) return false;
  const auto isFlat = [&](std::int64_t words) {
    const auto texture = assemble::linearTexture(words, device.textureLimits());
    return texture && texture->layers == 0;
  };
  const std::int64_t tiles = (count - 1) / assemble::radixTile + 1;
  return isFlat(count) && isFlat(tiles * assemble::radixDigits);
}

std::int64_t sortByDispatches(GlDevice& device, const Reordering& reordering) {
  return StreamSort(device, reordering).run();
}

std::optional<std::int64_t> GlDevice::reorder(const Reordering& reordering) {
  if (!sortsByDispatches_ || !maySortByDispatches(*this, reordering)) return std::nullopt;
  const DeviceScope scope(*this);
  const gl::LabelGroup group(labels, "sort");
  selectPrograms({}, assemble::Stage::Compute);
  return sortByDispatches(*this, reordering);
}

}  // namespace sk
