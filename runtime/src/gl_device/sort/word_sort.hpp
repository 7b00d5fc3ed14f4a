// SPDX-License-Identifier: MIT
//
// Sorts words by dispatches, stably, digit by digit (assemble/sort/radix_program.hpp). What the words stand for is the
// caller's.
#pragma once

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "assemble/sort/radix_program.hpp"
#include "gl_device/gl_device.hpp"
#include "gl_device/memory/layout.hpp"
#include "gl_device/sort/device_sort.hpp"

namespace sk {

/// A linearised texture of words, or of pairs of them.
class WordTexture {
 public:
  WordTexture(GlDevice& device, std::int32_t count, const program::Element& element = sortWords())
      : texture_(*assemble::linearTexture(count, device.textureLimits())),
        shift_(assemble::linearLayout(count, texture_).shift),
        lease_(device.memory()) {
    lease_.add(element, texture_, "a sort");
  }

  std::int32_t shift() const { return shift_; }
  std::span<RenderTarget> planes() { return lease_.planes; }
  RenderTarget& plane() { return lease_.planes.front(); }
  /// The layout of elements of this shape, x first, that take one word each.
  assemble::RegionLayout layoutOf(const assemble::Index4& extent) const {
    return {.linear = true, .extent = extent, .stride = assemble::stridesOf(extent), .shift = shift_};
  }
  void swap(WordTexture& other) noexcept { std::swap(lease_.planes, other.lease_.planes); }

 private:
  assemble::TextureShape texture_;
  std::int32_t shift_;
  PlanesLease lease_;
};

/// Sorts words, or pairs of a word and the place that it comes from, or whatever belongs to it. A DeviceScope must be open, and compute
/// programs selected. Throws sk::Error if memory is exhausted or the driver rejects a program.
class WordSort {
 public:
  enum class Of : std::uint8_t {
    Keys,  ///< `keys`
    KeysAndPlaces,  ///< `keys`, to `pairs`
    Pairs,  ///< `pairs`
  };
  WordSort(GlDevice& device, std::int32_t count, Of of, const WordOrder& order = {});

  /// Whether a device sorts this number of words: temporaries for all of them fit into textures without layers, and compute programs
  /// write those of pairs.
  static bool isPossible(const GlDevice& device, Of of, std::int64_t count);

  /// Sorts by the lowest `bits` bits of words: `keys` to `pairs`, or to `keys` if there are no pairs, or `pairs`.
  void sort(int bits = 32) { sortByAll(keys.has_value(), bits); }
  /// Sorts `pairs`.
  void sortAgain() { sortByAll(false, 32); }
  /// Divides `keys`, each 0 or 1, to `pairs`. Returns the number of zeros; waits for the device.
  std::int64_t divide();

 private:
  struct Uniform {
    std::string_view name;
    std::int32_t value;
  };

  void sortByAll(bool fromKeys, int bits);
  std::int64_t bytesInBuffer() const {
    const std::int64_t ofArray = std::int64_t{count_} * (pairs ? 8 : 4);
    return alternates_ ? ofArray : 2 * ofArray;
  }
  bool takesBuffer();
  bool bindBuffer();
  void storeWords();
  void sortBy(int digit, bool readsKeys);
  void run(assemble::RadixStep step, std::string_view name, std::initializer_list<WordTexture*> read,
           std::initializer_list<WordTexture*> written, std::initializer_list<Uniform> uniforms,
           std::int32_t tiles);
  std::uint32_t read(WordTexture& words, std::int32_t number);

  GlDevice& device_;
  const WordOrder order_;
  const std::int32_t count_, tileSize_, tiles_;
  std::int32_t shift_ = 0;  ///< of the layout of words
  WordTexture counts_, sums_, totals_, totalSums_, all_;

 public:
  std::optional<WordTexture> keys;
  std::optional<WordTexture> pairs;

 private:
  std::optional<WordTexture> moved_;  ///< without a buffer
  bool inBuffer_ = false;  ///< words lie in the buffer between two digits,
  bool alternates_ = false;  ///< or after every other one, and in their texture after the others
  bool isStored_ = false;  ///< the current words lie there, from number current_ on
  std::int32_t current_ = 0;
};

}  // namespace sk
