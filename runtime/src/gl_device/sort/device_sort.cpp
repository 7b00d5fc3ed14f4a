// SPDX-License-Identifier: MIT
//
// Descriptors as skc would generate them, created on first use.
#include "gl_device/sort/device_sort.hpp"

#include <algorithm>
#include <array>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
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
#include "gl_device/sort/word_sort.hpp"
#include "gl_device/transfer/copy_kernel.hpp"
#include "sk/error.hpp"
#include "sk/types.hpp"

namespace sk {

using assemble::Rect;
using assemble::RegionLayout;
using program::Element;
using program::Kernel;
using program::Parameter;
using program::Role;

namespace {

program::Scalar scalarOf(const Reordering& reordering) {
  return reordering.keys.stream->element->fields.front().scalar;
}

bool isKeys(const Reordering& reordering, const StreamRegion& region) {
  return region.stream == reordering.keys.stream;
}

/// Whether the words are the bits of keys, which sorted words give back. They do not for halves, whose NaNs have fewer bits.
bool sortsBits(const Reordering& reordering) {
  return !reordering.choosesFirst() && !program::is64Bit(scalarOf(reordering)) &&
         reordering.keys.stream->storage != Storage::Half;
}

/// Whether the words need the places that they come from.
WordSort::Of wordsOf(const Reordering& reordering) {
  const auto isWithout = [&](const StreamRegion& region) {
    return isKeys(reordering, region) && sortsBits(reordering);
  };
  const bool needsPlaces = reordering.places != nullptr || program::is64Bit(scalarOf(reordering)) ||
                           !std::ranges::all_of(reordering.moved, isWithout);
  return needsPlaces ? WordSort::Of::KeysAndPlaces : WordSort::Of::Keys;
}

/// The streams of a reordering. New elements are in new planes until all passes have run.
class StreamSort {
 public:
  StreamSort(GlDevice& device, const Reordering& reordering)
      : device_(device),
        reordering_(reordering),
        scalar_(scalarOf(reordering)),
        extent_(xFirst(reordering.keys.shape)),
        count_(static_cast<std::int32_t>(reordering.keys.shape.size())) {}

  std::int64_t run() {
    WordSort sort(device_, count_, wordsOf(reordering_),
                  sortsBits() ? orderOfBits(scalar_, isDescending()) : WordOrder{});
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
  bool isKeys(const StreamRegion& region) const { return sk::isKeys(reordering_, region); }
  bool sortsBits() const { return sk::sortsBits(reordering_); }

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
    if (!program::is64Bit(scalar_)) {
      makeWords(sortsBits() ? bitsKernel(scalar_) : wordKernel(scalar_, isDescending()), {&*sort.keys});
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
    if (!program::is64Bit(scalar_)) {
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
      if (isKeys(moved.region) && sortsBits()) {
        const Operand operands[] = {shapedOperandOf(sort.pairs ? *sort.pairs : *sort.keys), {}};
        runKernel(device_, restoreKernel(scalar_, sort.pairs.has_value()), operands, domain, rects, targets);
        continue;
      }
      const Operand operands[] = {shapedOperandOf(*sort.pairs), from, {}};
      runKernel(device_, moveKernel(fields[plane], rank), operands, domain, rects, targets);
    }
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
      (keys.storage == Storage::Half && !program::is64Bit(keys.element->fields.front().scalar));
  return isStoredSo && WordSort::isPossible(device, wordsOf(reordering), reordering.keys.shape.size());
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

const program::Element& sortWords() { return ElementTraits<std::uint32_t>::element(); }
const program::Element& sortWordPairs() { return ElementTraits<uint2>::element(); }

namespace {

/// A kernel and what it refers to. Its entry is the only function `sort_kernel`.
struct SortKernel {
  std::string body;
  std::vector<Parameter> parameters;
  Kernel kernel;
};

Parameter input(std::string_view name, const Element& element) {
  return {.name = name, .symbol = name, .role = Role::Input, .element = &element};
}
Parameter output(std::string_view name, const Element& element) {
  return {.name = name, .symbol = name, .role = Role::Output, .element = &element};
}
Parameter gather(std::string_view name, const Element& element, int rank) {
  return {.name = name,
          .symbol = name,
          .role = Role::Gather,
          .element = &element,
          .rank = static_cast<std::uint8_t>(rank),
          .usesExtent = rank > 1,
          .usesAt = true};
}

/// The kernel with this body and these parameters.
const Kernel& kept(std::string&& body, std::vector<Parameter>&& parameters, bool usesIndex = false) {
  static std::mutex mutex;
  static std::map<std::string, std::unique_ptr<SortKernel>> kernels;  // by their bodies, which have all types
  const std::lock_guard lock(mutex);
  std::unique_ptr<SortKernel>& known = kernels[body];
  if (known) return known->kernel;
  known = std::make_unique<SortKernel>(SortKernel{std::move(body), std::move(parameters), {}});
  known->kernel.name = "sort";
  known->kernel.entry = "sort_kernel";
  known->kernel.body = known->body;
  known->kernel.parameters = known->parameters;
  known->kernel.usesIndex = usesIndex;
  return known->kernel;
}

/// The element of gather `x` at the place of pair `k`.
std::string elementAt(int rank) {
  return rank == 1 ? "sk_at_x(int(k.y))" : "sk_at_x(sort_index(int(k.y), sk_extent_x()))";
}
std::string_view indexFunction(int rank) {
  if (rank == 1) return "";
  return "ivec4 sort_index(int n, ivec4 e) {\n"
         "  int y = n / e.x, z = y / e.y, w = z / e.z;\n"
         "  return ivec4(n - y * e.x, y - z * e.y, z - w * e.z, w);\n"
         "}\n";
}

/// The element of a key or a flag; uint if there is none of this type.
const Element& elementOf(program::Scalar scalar) {
  switch (scalar) {
    case program::Scalar::Int: return ElementTraits<std::int32_t>::element();
    case program::Scalar::Float: return ElementTraits<float>::element();
    case program::Scalar::Bool: return ElementTraits<bool>::element();
    case program::Scalar::Uint:
    case program::Scalar::Double:
    case program::Scalar::Long:
    case program::Scalar::Ulong:
    case program::Scalar::Half:
    case program::Scalar::Char:
    case program::Scalar::Uchar:
    case program::Scalar::Short:
    case program::Scalar::Ushort:
    case program::Scalar::Unorm8:
    case program::Scalar::Snorm8:
    case program::Scalar::Unorm16:
    case program::Scalar::Snorm16: break;
  }
  return sortWords();
}

}  // namespace

const Kernel& wordKernel(program::Scalar keys, bool isDescending) {
  const std::string_view inverted = isDescending ? "~" : "";
  if (program::is64Bit(keys) && keys != program::Scalar::Double) {
    return kept(fmt::format("void sort_kernel(uvec2 k, out uint lower, out uint upper) {{\n"
                            "  lower = {0}k.x;\n"
                            "  upper = {0}(k.y{1});\n"
                            "}}\n",
                            inverted, keys == program::Scalar::Long ? " ^ 0x80000000u" : ""),
                {input("k", sortWordPairs()), output("lower", sortWords()), output("upper", sortWords())});
  }
  if (program::is64Bit(keys)) {
    return kept(fmt::format("void sort_kernel(uvec2 k, out uint lower, out uint upper) {{\n"
                            "  uint m = k.y & 0x7fffffffu;\n"
                            "  if ((m | k.x) == 0u) k = uvec2(0u);\n"
                            "  bool isNan = m > 0x7ff00000u || (m == 0x7ff00000u && k.x != 0u);\n"
                            "  uvec2 r = (k.y >> 31) != 0u ? ~k : uvec2(k.x, k.y | 0x80000000u);\n"
                            "  lower = isNan ? 0xffffffffu : {0}r.x;\n"
                            "  upper = isNan ? 0xffffffffu : {0}r.y;\n"
                            "}}\n",
                            inverted),
                {input("k", sortWordPairs()), output("lower", sortWords()), output("upper", sortWords())});
  }
  const Element& element = elementOf(keys);
  if (keys == program::Scalar::Float) {
    return kept(fmt::format("void sort_kernel(float k, out uint r) {{\n"
                            "  uint b = floatBitsToUint(k), m = b & 0x7fffffffu;\n"
                            "  if (m == 0u) b = 0u;\n"
                            "  b = (b >> 31) != 0u ? ~b : b | 0x80000000u;\n"
                            "  r = m > 0x7f800000u ? 0xffffffffu : {}b;\n"
                            "}}\n",
                            inverted),
                {input("k", element), output("r", sortWords())});
  }
  return kept(fmt::format("void sort_kernel({} k, out uint r) {{ r = {}(uint(k){}); }}\n", element.glsl,
                          inverted, keys == program::Scalar::Int ? " ^ 0x80000000u" : ""),
              {input("k", element), output("r", sortWords())});
}

const Kernel& repeatKernel(program::Scalar keys) {
  const bool isFloating = keys == program::Scalar::Float || keys == program::Scalar::Double;
  const std::string_view isNumber = isFloating ? " && k != 0xffffffffu" : "";
  if (!program::is64Bit(keys)) {
    return kept(fmt::format("void sort_kernel(uint k, out uint r) {{\n"
                            "  int n = sk_index().x;\n"
                            "  r = n > 0 && sk_at_x(n - 1) == k{} ? 1u : 0u;\n"
                            "}}\n",
                            isNumber),
                {input("k", sortWords()), gather("x", sortWords(), 1), output("r", sortWords())}, true);
  }
  return kept(fmt::format("void sort_kernel(uint k, uint l, out uint r) {{\n"
                          "  int n = sk_index().x;\n"
                          "  r = n > 0 && sk_at_x(n - 1) == k && sk_at_y(n - 1) == l{} ? 1u : 0u;\n"
                          "}}\n",
                          isFloating ? " && (k & l) != 0xffffffffu" : ""),
              {input("k", sortWords()), gather("x", sortWords(), 1), input("l", sortWords()),
               gather("y", sortWords(), 1), output("r", sortWords())},
              true);
}

const Kernel& flagKernel(program::Scalar flags) {
  const Element& element = elementOf(flags);
  return kept(
      fmt::format("void sort_kernel({0} k, out uint r) {{ r = k == {0}(0) ? 1u : 0u; }}\n", element.glsl),
      {input("k", element), output("r", sortWords())});
}

const Kernel& moveKernel(const program::Field& field, int rank) {
  const Element& element = *copyKernel(field).parameters[0].element;
  return kept(fmt::format("// {}\n{}void sort_kernel(uvec2 k, out {} r) {{ r = {}; }}\n", element.name,
                          indexFunction(rank), element.glsl, elementAt(rank)),
              {input("k", sortWordPairs()), gather("x", element, rank), output("r", element)});
}

const Kernel& upperWordKernel() {
  return kept("void sort_kernel(uvec2 k, out uvec2 r) { r = uvec2(sk_at_x(int(k.y)), k.y); }\n",
              {input("k", sortWordPairs()), gather("x", sortWords(), 1), output("r", sortWordPairs())});
}

WordOrder orderOfBits(program::Scalar keys, bool isDescending) {
  const std::uint32_t inverted = isDescending ? 0xffffffffu : 0;
  if (keys == program::Scalar::Float) return {assemble::RadixKeys::Floats, inverted};
  const std::uint32_t sign = keys == program::Scalar::Int ? 0x80000000u : 0;
  return {assemble::RadixKeys::Words, inverted ^ sign};
}

const Kernel& bitsKernel(program::Scalar keys) {
  const Element& element = elementOf(keys);
  const std::string_view bits = keys == program::Scalar::Float ? "floatBitsToUint" : "uint";
  return kept(fmt::format("void sort_kernel({} k, out uint r) {{ r = {}(k); }}\n", element.glsl, bits),
              {input("k", element), output("r", sortWords())});
}

const Kernel& restoreKernel(program::Scalar keys, bool fromPairs) {
  const Element& element = elementOf(keys);
  const Element& from = fromPairs ? sortWordPairs() : sortWords();
  const std::string_view key = keys == program::Scalar::Float ? "uintBitsToFloat" : element.glsl;
  return kept(fmt::format("void sort_kernel({} k, out {} r) {{ r = {}(k{}); }}\n", from.glsl, element.glsl,
                          key, fromPairs ? ".x" : ""),
              {input("k", from), output("r", element)});
}

const Kernel& lastWordKernel(const Element& words) {
  return kept(fmt::format("void sort_kernel(out {0} r) {{ r = {0}(0xffffffffu); }}\n", words.glsl),
              {output("r", words)});
}

const Kernel& placeKernel() {
  return kept("void sort_kernel(uvec2 k, out int r) { r = int(k.y); }\n",
              {input("k", sortWordPairs()), output("r", elementOf(program::Scalar::Int))});
}

}  // namespace sk
