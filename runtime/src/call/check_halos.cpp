// SPDX-License-Identifier: MIT
#include "call/check_halos.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <memory>
#include <optional>
#include <vector>

#include "assemble/append/append_passes.hpp"
#include "assemble/condition.hpp"
#include "call/box.hpp"
#include "call/check_argument.hpp"
#include "call/halo_limits.hpp"
#include "device/device_state.hpp"
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

}  // namespace sk
