// SPDX-License-Identifier: MIT
#include "gl_device/sort/word_sort.hpp"

#include "assemble/reduce/scan_plan.hpp"
#include "gl_device/pass/pass.hpp"
#include "gl_device/pass/pass_trace.hpp"
#include "gl_device/sort/device_sort.hpp"

namespace sk {

using assemble::RadixKeys;
using assemble::RadixStep;
using assemble::RadixStorage;
using assemble::Rect;

namespace {

std::int32_t divideUp(std::int32_t a, std::int32_t b) { return (a - 1) / b + 1; }

}  // namespace

WordSort::WordSort(GlDevice& device, std::int32_t count, Of of, const WordOrder& order)
    : device_(device),
      order_(order),
      count_(count),
      tileSize_(assemble::radixTile(device.programs().computeProfile())),
      tiles_(divideUp(count, tileSize_)),
      counts_(device, tiles_ * assemble::radixDigits),
      sums_(device, tiles_ * assemble::radixDigits),
      totals_(device, divideUp(tiles_ * assemble::radixDigits, assemble::radixSumTile)),
      totalSums_(device, divideUp(tiles_ * assemble::radixDigits, assemble::radixSumTile)),
      all_(device, 1) {
  if (of != Of::Pairs) keys.emplace(device, count);
  if (of != Of::Keys) pairs.emplace(device, count, sortWordPairs());
  if (!takesBuffer()) moved_.emplace(device, count, pairs ? sortWordPairs() : sortWords());
  shift_ = (keys ? *keys : *pairs).shift();
}

bool WordSort::isPossible(const GlDevice& device, Of of, std::int64_t count) {
  if (of != Of::Keys && !device.programs().mayStore(sortWordPairs())) return false;
  constexpr std::int64_t mostCounts =
      std::int64_t{assemble::radixSumTile} * assemble::radixSumTile;  // their totals are one tile
  const std::int64_t tiles = (count - 1) / assemble::radixTile(device.programs().computeProfile()) + 1;
  if (tiles * assemble::radixDigits > mostCounts) return false;
  const auto isFlat = [&](std::int64_t words) {
    const auto texture = assemble::linearTexture(words, device.textureLimits());
    return texture && texture->layers == 0;
  };
  return isFlat(count) && isFlat(tiles * assemble::radixDigits);
}

std::int64_t WordSort::divide() {
  sortBy(0, true);
  storeWords();
  const TraceScope traced(device_.trace.get(), "transfer", "read number of elements");
  const std::int32_t ones = tiles_;  // the sum before the ones of the first tile
  const std::uint32_t inTile = read(sums_, ones);
  const std::uint32_t before = read(totalSums_, ones / assemble::radixSumTile);
  device_.throwPendingError();
  return std::int64_t{inTile} + before;
}

void WordSort::sortByAll(bool fromKeys, int bits) {
  if (inBuffer_) bindBuffer();  // others may have used its binding meanwhile
  const int digits = std::max(1, (bits + 7) / 8);  // of 8 bits
  for (int digit = 0; digit < digits; ++digit) sortBy(digit, digit == 0 ? fromKeys : !pairs);
  storeWords();
}

/// Takes memory for two arrays of words besides the textures, or for one if the device's buffers are too small; false if they are
/// too small even for that, or if a loop records the commands, which it could not repeat.
bool WordSort::takesBuffer() {
  const auto isTooLarge = [&] { return bytesInBuffer() > device_.capabilities.storageBytes; };
  alternates_ = isTooLarge();
  inBuffer_ = !device_.bound().isLogged() && !isTooLarge() && bindBuffer();
  return inBuffer_;
}

bool WordSort::bindBuffer() {
  return device_.passes().bind(PassBuffer::SortedWords, static_cast<std::size_t>(bytesInBuffer()));
}

/// Brings sorted words from the buffer to their texture.
void WordSort::storeWords() {
  if (!isStored_) return;
  run(pairs ? RadixStep::StorePairs : RadixStep::Store, "store words", {nullptr}, {pairs ? &*pairs : &*keys},
      {{"sk_keys_shift", shift_}, {"sk_length", count_}, {"sk_from", current_}},
      divideUp(count_, assemble::radixSumTile));
  isStored_ = false;
}

void WordSort::sortBy(int digit, bool readsKeys) {
  const Uniform shift{"sk_digit", 8 * digit}, flip{"sk_flip", static_cast<std::int32_t>(order_.flip)};
  const Uniform keyShift{"sk_keys_shift", shift_}, countShift{"sk_counts_shift", counts_.shift()};
  const Uniform totalShift{"sk_totals_shift", totals_.shift()}, length{"sk_length", count_};
  const std::int32_t counts = tiles_ * assemble::radixDigits;
  const std::int32_t groups = divideUp(counts, assemble::radixSumTile);
  WordTexture* const from = isStored_ ? nullptr : readsKeys ? &*keys : &*pairs;
  const bool toBuffer = inBuffer_ && !(alternates_ && isStored_);
  const bool toSecond = isStored_ && current_ == 0 && !alternates_;
  const Uniform fromNumber{"sk_from", current_}, toNumber{"sk_to", toSecond ? count_ : 0};
  WordTexture& words = pairs ? *pairs : *keys;
  run(readsKeys ? RadixStep::Count : RadixStep::CountPairs, "count digits", {from}, {&counts_},
      {shift, flip, keyShift, countShift, length, fromNumber}, tiles_);
  run(RadixStep::Sum, "sum counts", {&counts_}, {&sums_, &totals_},
      {{"sk_length", counts}, countShift, totalShift}, groups);
  run(RadixStep::Sum, "sum counts", {&totals_}, {&totalSums_, &all_},
      {{"sk_length", groups}, {"sk_counts_shift", totals_.shift()}, {"sk_totals_shift", all_.shift()}}, 1);
  const RadixStep move = !pairs ? RadixStep::Move : readsKeys ? RadixStep::MoveFirst : RadixStep::MovePairs;
  run(move, "move keys", {from, &sums_, &totalSums_},
      {toBuffer    ? nullptr
       : inBuffer_ ? &words
                   : &*moved_},
      {shift, flip, keyShift, countShift, totalShift, length, fromNumber, toNumber}, tiles_);
  current_ = toNumber.value;
  isStored_ = toBuffer;
  if (!inBuffer_) words.swap(*moved_);
}

/// Dispatches a group for each tile. Words in the buffer take the place of the first texture that is read or written, which is null.
void WordSort::run(RadixStep step, std::string_view name, std::initializer_list<WordTexture*> read,
                   std::initializer_list<WordTexture*> written, std::initializer_list<Uniform> uniforms,
                   std::int32_t tiles) {
  const RadixStorage storage{.reads = *read.begin() == nullptr, .writes = *written.begin() == nullptr};
  IntegerProgram& program = device_.programs().ofSorts().of(step, order_.keys, storage);
  constexpr std::int32_t mostInRow = std::int32_t{1} << assemble::groupRowShift;
  const Rect groups{0, 0, std::min(tiles, mostInRow), divideUp(tiles, mostInRow)};
  const bool isPlain = step == RadixStep::Sum || step == RadixStep::Store || step == RadixStep::StorePairs;
  const std::int32_t tile = isPlain ? assemble::radixSumTile : tileSize_;
  const std::int64_t bytes = std::int64_t{tiles} * tile * 4 * static_cast<std::int64_t>(read.size());
  const PassScope traced(device_, {name, "sort", "dispatch"}, bytes, std::span<const Rect>(&groups, 1),
                         static_cast<std::size_t>(tile) * 4);
  device_.bound().program(program.program().name());
  int unit = 0;
  for (WordTexture* words : read) {
    if (words == nullptr) {
      ++unit;
    } else {
      unit = bindPlanes(device_, words->planes(), unit);
    }
  }
  unit = 0;
  for (WordTexture* words : written) {
    if (words == nullptr) break;
    const gl::Texture& texture = words->plane().texture;
    device_.bound().image(unit++, texture.name(), texture.format().internalFormat);
  }
  for (const Uniform& uniform : uniforms) program.set(device_.bound(), uniform.name, uniform.value);
  program.set(device_.bound(), "sk_tiles", tiles);
  program.set(device_.bound(), "sk_rect", gl::Int4{groups.x, groups.y, groups.width, groups.height});
  device_.passes().dispatch(groups.width, groups.height, storage.writes ? Writes::Storage : Writes::Texels);
}

std::uint32_t WordSort::read(WordTexture& words, std::int32_t number) {
  std::uint32_t word = 0;
  RenderTarget& plane = words.plane();
  plane.framebufferIn(device_.bound())
      .read(device_.bound(), plane.texture.format().tight, number & ((1 << words.shift()) - 1),
            number >> words.shift(), 1, 1, &word);
  return word;
}

IntegerProgram& SortPrograms::of(RadixStep step, RadixKeys keys, RadixStorage storage) {
  const bool hasDigits = step != RadixStep::Sum && step != RadixStep::Store && step != RadixStep::StorePairs;
  if (!hasDigits) keys = RadixKeys::Words;  // it does not compare them
  const std::size_t ofStep =
      assemble::radixKeyTypes * static_cast<std::size_t>(step) + static_cast<std::size_t>(keys);
  std::unique_ptr<IntegerProgram>& known =
      programs_[4 * ofStep + (storage.reads ? 2 : 0) + (storage.writes ? 1 : 0)];
  if (known) return *known;
  known = owner_.build({{}, assemble::radixProgram(owner_.computeProfile(), step, keys, storage)},
                       "a program of sk::sort");
  const gl::Program& linked = known->program();
  int unit = 0;
  if (step == RadixStep::Sum) {
    linked.setSampler("sk_counts", unit);
  } else {
    for (const char* name : {"sk_keys", "sk_sums", "sk_totals"}) linked.setSampler(name, unit++);
  }
  return *known;
}

}  // namespace sk
