// SPDX-License-Identifier: MIT
//
// Sorts streams by dispatches (assemble/sort/radix_program.hpp): keys become words, which are sorted with the places
// that they come from; then each plane of a stream is brought into this order.
//
// Kernels around a sort of words: from elements to words that compare as the elements do, and back to elements.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "assemble/sort/radix_program.hpp"
#include "device/device_state.hpp"
#include "gl_device/program/program_binaries.hpp"
#include "sk/program.hpp"
#include "sk/scalar_bytes.hpp"

namespace sk {

class GlDevice;
class GlPrograms;

/// The programs of sorts, which are compiled on first use and kept as long as the device.
class SortPrograms {
 public:
  explicit SortPrograms(GlPrograms& owner) : owner_(owner) {}
  /// Throws sk::Error if the driver rejects it.
  IntegerProgram& of(assemble::RadixStep step, assemble::RadixKeys keys, assemble::RadixStorage storage);

 private:
  GlPrograms& owner_;
  std::array<std::unique_ptr<IntegerProgram>, 4 * assemble::radixKeyTypes * assemble::radixSteps>
      programs_;  ///< for each RadixStorage
};

/// Whether streams can be sorted by dispatches: the keys are stored as they are declared, or as halves, and temporaries
/// for all of them fit into textures without layers.
bool maySortByDispatches(const GlDevice& device, const Reordering& reordering);

/// Carries it out. Returns the number of elements that come first, if it chooses them. Throws sk::Error if memory is
/// exhausted or the driver rejects a program; nothing has moved then. A DeviceScope must be open, and compute programs
/// selected.
std::int64_t sortByDispatches(GlDevice& device, const Reordering& reordering);

/// How words compare: as unsigned numbers after an exclusive or with `flip`, or as the floats whose bits they are (RadixKeys).
struct WordOrder {
  assemble::RadixKeys keys = assemble::RadixKeys::Words;
  std::uint32_t flip = 0;
};
/// The order of the bits of keys of 32 bits or fewer.
WordOrder orderOfBits(program::Scalar keys, bool isDescending);

/// The element of what is sorted: a word, or the pair of a word and the place where it came from.
const program::Element& sortWords();
const program::Element& sortWordPairs();

/// (key) -> word, or (key) -> lower word, upper word. Words compare as unsigned numbers. All NaNs have the largest word,
/// also in descending order, and both zeros the same.
const program::Kernel& wordKernel(program::Scalar keys, bool isDescending);
/// (word, words[]), or the same for lower words and then for upper words -> 1 if the element of one dimension is equal to
/// the one before, else 0. A NaN is equal to nothing.
const program::Kernel& repeatKernel(program::Scalar keys);
/// (flag) -> 0 if it is true, or not 0, else 1.
const program::Kernel& flagKernel(program::Scalar flags);
/// ((word, place), elements[]) -> the texel of a plane at this place; the elements have one dimension or, by rank 4, any.
const program::Kernel& moveKernel(const program::Field& field, int rank);
/// ((word, place), upper words[]) -> the upper word at this place, and the place.
const program::Kernel& upperWordKernel();
/// (key) -> its bits, for keys of 32 bits or fewer.
const program::Kernel& bitsKernel(program::Scalar keys);
/// (bits) or ((bits, place)) -> the key.
const program::Kernel& restoreKernel(program::Scalar keys, bool fromPairs);
/// () -> the largest word, or a pair of it, of the element sortWords() or sortWordPairs().
const program::Kernel& lastWordKernel(const program::Element& words);
/// ((word, place)) -> the place as an int.
const program::Kernel& placeKernel();

}  // namespace sk
