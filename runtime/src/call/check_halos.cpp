// SPDX-License-Identifier: MIT
//
// In calls with placed streams, an index beyond what a gather holds reads the nearest element that it holds, so that one
// layer of elements around the permitted ones catches every read that is too far.

#include "call/check_halos.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "assemble/append/append_passes.hpp"
#include "assemble/condition.hpp"
#include "call/box.hpp"
#include "call/check_call.hpp"
#include "call/halo_limits.hpp"
#include "call/placed.hpp"
#include "device/device_state.hpp"
#include "device/region.hpp"
#include "device/stream_state.hpp"
#include "sk/scalar_bytes.hpp"

namespace sk {

using program::Kernel;
using program::Parameter;
using program::Role;

namespace {

/// The most lines that are tested along a dimension.
constexpr std::int64_t mostLines = 64;

/// The tests of one call.
class HaloCheck {
 public:
  HaloCheck(DeviceState& device, const ResolvedCall& call,
            const std::function<void(const ResolvedCall&)>& run)
      : device_(device), call_(call), run_(run), arguments_(call.arguments.begin(), call.arguments.end()) {
    for (std::size_t i = 0; i < arguments_.size(); ++i) {
      if (call.kernel.parameters[i].role != Role::Output || arguments_[i].region.stream == nullptr) continue;
      outputs_.push_back(i);
      arguments_[i].region = like(call.arguments[i].region);
    }
  }

  void check(std::size_t gather) {
    const StreamRegion& region = call_.arguments[gather].region;
    const std::vector<std::byte> elements = read(region);
    // Elements that are stored in doubles have been rounded: both runs read what is written here.
    const StreamRegion same = like(region), changed = like(region);
    same.stream->write(same, elements.data());
    for (int d = 0; d < region.shape.rank(); ++d) {
      const std::optional<HaloLimits> limits =
          haloLimits(call_.kernel, call_.arguments, gather, d, call_.specs, call_.domain);
      const std::int64_t extent = gatherDimension(region.shape, d, call_.domain).domainExtent;
      if (!limits) continue;
      const std::int64_t lines = std::min(extent, mostLines);
      for (std::int64_t k = 0; k < lines; ++k) {
        const std::int64_t at = lines == 1 ? 0 : k * (extent - 1) / (lines - 1);
        checkLine(gather, d, at, *limits, elements, same, changed);
      }
    }
  }

 private:
  StreamRegion like(const StreamRegion& region) {
    const StreamState& stream = *region.stream;
    streams_.push_back(device_.createStream(*stream.element, region.shape, stream.storage));
    return {streams_.back().get(), Index::origin(region.shape.rank()), region.shape};
  }

  static std::vector<std::byte> read(const StreamRegion& region) {
    std::vector<std::byte> bytes(static_cast<std::size_t>(region.shape.size()) *
                                 region.stream->element->size);
    region.stream->read(region, bytes.data());
    return bytes;
  }

  /// Tests the elements with index `at` in the domain's dimension that belongs to the gather's dimension d.
  void checkLine(std::size_t gather, int d, std::int64_t at, const HaloLimits& limits,
                 const std::vector<std::byte>& elements, const StreamRegion& same,
                 const StreamRegion& changed) {
    const Parameter& parameter = call_.kernel.parameters[gather];
    std::vector<std::byte> other = elements;
    const GatherDimension dimension = gatherDimension(changed.shape, d, call_.domain);
    if (!changeBeyond(parameter, changed.shape, d, readBy(IndexRange{at, at + 1}, limits, dimension), other))
      return;
    changed.stream->write(changed, other.data());
    Box line{Index::origin(call_.domain.rank()), Index::origin(call_.domain.rank())};
    for (int k = 0; k < call_.domain.rank(); ++k) line.end[k] = call_.domain[k];
    if (const int k = dimension.domainDimension; k >= 0) {
      line.begin[k] = at;
      line.end[k] = at + 1;
    }
    if (resultsOf(gather, same, line) == resultsOf(gather, changed, line)) return;
    fail(call_.kernel,
         "'{}' is read more than {} before or {} after the element along {}, by elements with index {} "
         "there; correct "
         "its [[halo]]",
         parameter.name, limits.below, limits.above, "xyzw"[changed.shape.rank() - 1 - d], at);
  }

  /// Changes the elements of the gather that the line may not read: it reads the indices `read` in dimension d. Returns false if
  /// there are none.
  static bool changeBeyond(const Parameter& gather, const Shape& shape, int d, const IndexRange& read,
                           std::vector<std::byte>& elements) {
    std::int64_t inner = 1;
    for (int k = d + 1; k < shape.rank(); ++k) inner *= shape[k];
    const std::int64_t n = shape[d];
    const bool wraps = gather.boundary == program::Boundary::Wrap;
    const IndexRange inside = wraps ? read : broughtInside(gather.boundary, read, n);
    bool hasChanged = false;
    for (std::int64_t i = 0; i < shape.size(); ++i) {
      const std::int64_t x = i / inner % n;
      const bool isNear = wraps ? ((x - inside.begin) % n + n) % n < inside.end - inside.begin
                                : x >= inside.begin && x < inside.end;
      if (isNear) continue;
      changeBits(*gather.element, elements.data() + static_cast<std::size_t>(i) * gather.element->size);
      hasChanged = true;
    }
    return hasChanged;
  }

  /// The bytes of all outputs in the box.
  std::vector<std::byte> resultsOf(std::size_t gather, const StreamRegion& region, const Box& box) {
    arguments_[gather].region = region;
    ResolvedCall line = call_;
    line.arguments = arguments_;
    line.options.box = isAll(box, call_.domain) ? Box{} : box;
    run_(line);
    std::vector<std::byte> results;
    for (const std::size_t output : outputs_) {
      const std::vector<std::byte> one = read(partIn(arguments_[output].region, box));
      results.insert(results.end(), one.begin(), one.end());
    }
    arguments_[gather].region = call_.arguments[gather].region;
    return results;
  }

  DeviceState& device_;
  const ResolvedCall& call_;
  const std::function<void(const ResolvedCall&)>& run_;
  std::vector<Argument> arguments_;  ///< with streams of our own for the outputs
  std::vector<std::size_t> outputs_;
  std::vector<std::unique_ptr<StreamState>> streams_;
};

bool isTested(const ResolvedCall& call, std::size_t gather) {
  const Parameter& parameter = call.kernel.parameters[gather];
  return parameter.role == Role::Gather && !parameter.halo.empty() &&
         assemble::isNeeded(parameter, call.specs) && call.arguments[gather].region.shape.size() > 0;
}

}  // namespace

void changeBits(const program::Element& element, std::byte* bytes) {
  for (const program::Field& field : element.fields) {
    if (field.scalar == program::Scalar::Bool) {
      for (int c = 0; c < field.width; ++c) bytes[field.offset + static_cast<std::size_t>(c)] ^= std::byte{1};
      continue;
    }
    const std::size_t size = program::hostBytes(field.scalar) * static_cast<std::size_t>(field.width);
    for (std::size_t b = 0; b < size; ++b) bytes[field.offset + b] = ~bytes[field.offset + b];
  }
}

void checkHalos(DeviceState& device, const ResolvedCall& call,
                const std::function<void(const ResolvedCall&)>& run) {
  if (std::ranges::any_of(call.kernel.parameters, assemble::isAppendOutput) || call.domain.size() == 0)
    return;
  std::optional<HaloCheck> check;
  for (std::size_t i = 0; i < call.arguments.size(); ++i) {
    if (!isTested(call, i)) continue;
    if (!check) check.emplace(device, call, run);
    check->check(i);
  }
}

using program::Boundary;

namespace {

/// The most lines that are tested along a dimension.
constexpr std::int64_t mostPlacedLines = 64;

/// Calls visit(number, index) for the elements of a box, row-major.
template <class Visit>
void forEachIn(const Box& box, const Visit& visit) {
  const int rank = box.begin.rank();
  Index index = box.begin;
  for (std::int64_t number = 0;; ++number) {
    visit(number, index);
    int d = rank - 1;
    while (d >= 0 && ++index[d] == box.end[d]) {
      index[d] = box.begin[d];
      --d;
    }
    if (d < 0) return;
  }
}

std::size_t numberIn(const Box& box, const Index& index) {
  std::int64_t number = 0;
  for (int d = 0; d < index.rank(); ++d)
    number = number * (box.end[d] - box.begin[d]) + index[d] - box.begin[d];
  return static_cast<std::size_t>(number);
}

class PlacedCheck {
 public:
  PlacedCheck(DeviceState& device, const ResolvedCall& call,
              const std::function<void(const ResolvedCall&)>& run)
      : device_(device), call_(call), run_(run), arguments_(call.arguments.begin(), call.arguments.end()) {
    for (std::size_t i = 0; i < arguments_.size(); ++i) {
      if (call.kernel.parameters[i].role != Role::Output || arguments_[i].region.stream == nullptr) continue;
      outputs_.push_back(i);
      const StreamRegion& given = call.arguments[i].region;
      streams_.push_back(make(given, given.shape, given.placement));
      arguments_[i].region = streams_.back().region;
    }
  }

  void check(std::size_t gather) {
    const Box& box = call_.options.box;
    const Shape seen = seenShape(call_.arguments[gather].region);
    for (int d = 0; d < seen.rank(); ++d) {
      const std::optional<HaloLimits> limits = limitsOf(gather, d);
      const int k = gatherDimension(seen, d, call_.domain).domainDimension;
      if (!limits) continue;
      if (k < 0) {
        checkLine(gather, d, *limits, box);
        continue;
      }
      const std::int64_t count = box.end[k] - box.begin[k], lines = std::min(count, mostPlacedLines);
      for (std::int64_t number = 0; number < lines; ++number) {
        Box line = box;
        line.begin[k] += lines == 1 ? 0 : number * (count - 1) / (lines - 1);
        line.end[k] = line.begin[k] + 1;
        checkLine(gather, d, *limits, line);
      }
    }
  }

 private:
  std::optional<HaloLimits> limitsOf(std::size_t gather, int d) const {
    return haloLimits(call_.kernel, call_.arguments, gather, d, call_.specs, call_.domain);
  }

  struct Made {
    std::unique_ptr<StreamState> stream;
    StreamRegion region;
  };
  Made make(const StreamRegion& like, const Shape& shape, const Placement& placement) {
    const StreamState& stream = *like.stream;
    Made made{device_.createStream(*stream.element, shape, stream.storage), {}};
    made.region = {made.stream.get(), Index::origin(shape.rank()), shape};
    made.region.placement = placement;
    return made;
  }

  /// Changes what lies before the elements that the line may read, and then what lies behind them: no result may change.
  void checkLine(std::size_t gather, int d, const HaloLimits& limits, const Box& line) {
    const StreamRegion& given = call_.arguments[gather].region;
    const program::Element& element = *call_.kernel.parameters[gather].element;
    Box allowed = heldBox(given), around = allowed;
    limit(gather, d, readBy(line, limits, gatherDimension(seenShape(given), d, call_.domain)), allowed,
          around);
    if (around == allowed) return;
    const std::vector<std::byte> elements = elementsAround(given, allowed, around, element.size);
    Shape shape = given.shape;
    for (int k = 0; k < shape.rank(); ++k) shape = shape.with(k, around.end[k] - around.begin[k]);
    const Made made = make(given, shape, {around.begin, seenShape(given)});
    made.stream->write(made.region, elements.data());
    const std::vector<std::vector<std::byte>> expected = results(gather, made.region, line);
    for (const bool isAfter : {false, true}) {
      const std::int64_t at = isAfter ? allowed.end[d] : around.begin[d];
      if (at == (isAfter ? around.end[d] : allowed.begin[d])) continue;
      std::vector<std::byte> other = elements;
      forEachIn(around, [&](std::int64_t number, const Index& index) {
        if (index[d] == at)
          changeBits(element, other.data() + static_cast<std::size_t>(number) * element.size);
      });
      made.stream->write(made.region, other.data());
      compare(gather, d, isAfter, line, expected, results(gather, made.region, line));
    }
  }

  /// Sets the indices that may be read in dimension d, and those with an element where farther ones exist.
  void limit(std::size_t gather, int d, const IndexRange& read, Box& allowed, Box& around) const {
    const Boundary boundary = call_.kernel.parameters[gather].boundary;
    const StreamRegion& region = call_.arguments[gather].region;
    const std::int64_t n = seenShape(region)[d];
    const auto [below, above] = read;
    if (boundary == Boundary::Wrap) {
      if (above - below >= n) return;
      const std::int64_t low = heldBox(region).begin[d];
      allowed.begin[d] = low + ((below - low) % n + n) % n;
      allowed.end[d] = allowed.begin[d] + above - below;
      around.begin[d] = allowed.begin[d] - 1;
      around.end[d] = allowed.end[d] + 1;
      return;
    }
    if (boundary == Boundary::Mirror && (below < 0 || above > n)) return;  // reads come back from there
    allowed.begin[d] = std::clamp<std::int64_t>(below, 0, n - 1);
    allowed.end[d] = std::clamp<std::int64_t>(above, 1, n);
    around.begin[d] = std::max<std::int64_t>(allowed.begin[d] - 1, 0);
    around.end[d] = std::min(allowed.end[d] + 1, n);
  }

  static std::vector<std::byte> elementsAround(const StreamRegion& given, const Box& allowed,
                                               const Box& around, std::size_t size) {
    std::vector<std::byte> held(static_cast<std::size_t>(given.shape.size()) * size);
    given.stream->read(given, held.data());
    const Box box = heldBox(given);
    std::int64_t count = 1;
    for (int d = 0; d < around.begin.rank(); ++d) count *= around.end[d] - around.begin[d];
    std::vector<std::byte> elements(static_cast<std::size_t>(count) * size);
    forEachIn(allowed, [&](std::int64_t, const Index& index) {
      std::copy_n(held.data() + numberIn(box, index) * size, size,
                  elements.data() + numberIn(around, index) * size);
    });
    return elements;
  }

  /// The bytes of each output in the box.
  std::vector<std::vector<std::byte>> results(std::size_t gather, const StreamRegion& region,
                                              const Box& box) {
    arguments_[gather].region = region;
    ResolvedCall call = call_;
    call.arguments = arguments_;
    call.options.box = box;
    run_(call);
    arguments_[gather].region = call_.arguments[gather].region;
    std::vector<std::vector<std::byte>> all;
    for (const std::size_t output : outputs_) {
      const Parameter& parameter = call_.kernel.parameters[output];
      const StreamRegion part = partOfWhole(call_.kernel, parameter, arguments_[output].region, box);
      std::vector<std::byte>& bytes =
          all.emplace_back(static_cast<std::size_t>(part.shape.size()) * parameter.element->size);
      part.stream->read(part, bytes.data());
    }
    return all;
  }

  void compare(std::size_t gather, int d, bool isAfter, const Box& line,
               const std::vector<std::vector<std::byte>>& expected,
               const std::vector<std::vector<std::byte>>& got) const {
    for (std::size_t k = 0; k < outputs_.size(); ++k) {
      const auto first = std::ranges::mismatch(expected[k], got[k]).in1;
      if (first == expected[k].end()) continue;
      const auto number = static_cast<std::int64_t>(static_cast<std::size_t>(first - expected[k].begin()) /
                                                    call_.kernel.parameters[outputs_[k]].element->size);
      const Parameter& parameter = call_.kernel.parameters[gather];
      const int rank = call_.arguments[gather].region.shape.rank();
      const HaloLimits limits = *limitsOf(gather, d);
      Index at = line.begin;
      forEachIn(line, [&](std::int64_t n, const Index& index) {
        if (n == number) at = index;
      });
      fail(call_.kernel,
           "'{}' is read more than {} {} the element along {}, by the element with index {}; correct its "
           "[[halo]]",
           parameter.name, isAfter ? limits.above : limits.below, isAfter ? "after" : "before",
           "xyzw"[rank - 1 - d], toString(at));
    }
  }

  DeviceState& device_;
  const ResolvedCall& call_;
  const std::function<void(const ResolvedCall&)>& run_;
  std::vector<Argument> arguments_;  ///< with streams of our own for the outputs
  std::vector<std::size_t> outputs_;
  std::vector<Made> streams_;
};

}  // namespace

void checkPlacedHalos(DeviceState& device, const ResolvedCall& call,
                      const std::function<void(const ResolvedCall&)>& run) {
  std::optional<PlacedCheck> check;
  for (std::size_t i = 0; i < call.arguments.size(); ++i) {
    const Parameter& parameter = call.kernel.parameters[i];
    if (parameter.role != Role::Gather || !assemble::isNeeded(parameter, call.specs) ||
        !isPlaced(call.arguments[i].region) || parameter.halo.empty())
      continue;
    if (!check) check.emplace(device, call, run);
    check->check(i);
  }
}

}  // namespace sk
