// SPDX-License-Identifier: MIT
//
// Chooses variants and packs the same choices into keys.
#include "gl_device/program/variant.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "call/iterator.hpp"
#include "call/resolved_call.hpp"
#include "gl_device/gl_stream.hpp"
#include "gl_device/memory/layout.hpp"

namespace sk {

namespace {

using assemble::Addressing;
using assemble::isNeeded;
using assemble::RegionLayout;
using assemble::StreamAccess;
using assemble::Task;
using assemble::Work;
using program::Parameter;
using program::Role;

/// Whether a program depends on the region layout of a parameter, besides the domain's.
bool hasAccess(const program::Kernel& kernel, std::size_t i, const Task& task) {
  const Role role = kernel.parameters[i].role;
  if (role == Role::Input || role == Role::Gather) return true;
  const bool isListed = task.work == Work::List && task.appendOutput == i;
  return role == Role::Scatter && (isListed || task.work == Work::Groups || task.work == Work::Owners);
}

/// Whether a stream holds the value of a uniform.
bool isHeld(const Parameter& parameter, const Operand& operand) {
  return parameter.role == Role::Uniform && operand.value == nullptr;
}

assemble::Domain domainOf(const RegionLayout& domain, const Task& task) {
  return task.work == Work::List ? assemble::Domain::Entry : assemble::domainOf(domain);
}

/// StreamAccess::nearby: whether a neighbour's index wraps or mirrors at most once, at every index of the
/// domain.
bool isNearby(const Parameter& gather, const RegionLayout& regionLayout, const RegionLayout& domain) {
  if (!gather.usesNear || gather.reach < 0) {
    return false;
  }
  const assemble::Index4& seen = domain.placed ? domain.place.whole : domain.extent;
  // a local gather holds the current element if the whole has it
  const assemble::Index4& gathered = regionLayout.local ? regionLayout.place.whole : regionLayout.extent;
  for (std::size_t d = 0; d < gather.rank; ++d) {
    if (gather.reach >= regionLayout.extent[d] || seen[d] > gathered[d]) {
      return false;
    }
  }
  return true;
}

/// StreamAccess::filtered: whether the sampler's linear filter implements sk_sample_p(), also at the
/// texture's edges.
bool isFiltered(const Parameter& gather, const RegionLayout& regionLayout, bool filtersFloats) {
  const bool isFloat = gather.element->fields.front().scalar == program::Scalar::Float;
  return assemble::mayFilter(gather) && !regionLayout.placed && !regionLayout.linear &&
         !regionLayout.packed && !regionLayout.view && (!isFloat || filtersFloats);
}

StreamAccess chooseAccess(const Parameter& parameter, const Operand& operand, const RegionLayout& domain,
                          const Task& task, bool filtersFloats) {
  StreamAccess access{.storage = operand.storage};
  const RegionLayout& regionLayout = operand.regionLayout;
  const bool isAligned = task.work != Work::List && haveSameTexels(regionLayout, domain);
  if (parameter.role == Role::Input && isAligned) {
    return access;
  }
  access.addressing = addressingOf(regionLayout);
  access.packed = regionLayout.packed;
  access.fitted = operand.fitted;
  access.strided = regionLayout.strided;
  const bool isPlacedGather = parameter.role == Role::Gather && regionLayout.placed;
  access.placed = isPlacedGather && !regionLayout.local;
  access.local = isPlacedGather && regionLayout.local;
  access.shifted = access.local && regionLayout.place.low != assemble::Index4{};
  access.view = access.fitted || access.strided || access.placed || regionLayout.origin != assemble::Index4{};
  access.nearby = parameter.role == Role::Gather && isNearby(parameter, regionLayout, domain);
  access.filtered = parameter.role == Role::Gather && operand.storage < Storage::Extended &&
                    isFiltered(parameter, regionLayout, filtersFloats);
  return access;
}

bool isFlat(const RegionLayout& domain) {
  const assemble::Index4& seen = domain.placed ? domain.place.whole : domain.extent;
  return assemble::elements(seen) == seen[0];
}

/// If only x has an extent above 1, the index in x is the element number, which needs no addressing by
/// number.
StreamAccess chooseIteration(const Parameter& iterator, const Operand& operand, const RegionLayout& domain) {
  const bool isScalar = iterator.element->fields[0].width == 1;
  const bool counts = countsElements(iterator, operand.rank) && !(isScalar && isFlat(domain));
  return {.addressing = counts ? Addressing::Linear : Addressing::Aligned};
}

assemble::SpecValues specsOf(const program::Kernel& kernel, std::span<const Operand> operands) {
  assemble::SpecValues specs{};
  std::size_t count = 0;
  for (std::size_t i = 0; i < kernel.parameters.size(); ++i) {
    if (kernel.parameters[i].role == Role::Spec) {
      specs[count++] = specBits(kernel.parameters[i], operands[i].value);
    }
  }
  return specs;
}

bool isDomainView(const RegionLayout& domain) {
  return !domain.linear && domain.origin != assemble::Index4{};
}

/// Strided domains have ranks of their own in a key, and their rank in place of the kind of domain.
bool isStrided(const RegionLayout& domain, const Task& task) {
  return domain.strided && task.work != Work::List;
}
std::uint64_t rankBits(const RegionLayout& domain, const Task& task) {
  if (!isStrided(domain, task)) return assemble::decodedRank(domain);
  return domain.linear ? 5 : domain.numbered ? 6 : 7;
}
std::uint64_t domainBits(const RegionLayout& domain, const Task& task) {
  const std::uint64_t kind = isStrided(domain, task) ? assemble::decodedRank(domain) - 1u
                                                     : static_cast<std::uint64_t>(domainOf(domain, task));
  return kind | std::uint64_t{domain.layered} << 2 | std::uint64_t{isDomainView(domain)} << 3;
}

/// Two bits for `fit`, `view` and `nearby`: fitted inputs are always views, and inputs are never nearby.
std::uint64_t choiceBits(const StreamAccess& access) {
  if (access.fitted) return 2;
  return std::uint64_t{access.view} | std::uint64_t{access.nearby} << 1;
}

/// How a gather belongs to a whole.
std::uint64_t placeBits(const RegionLayout& gather) {
  const bool isShifted = gather.local && gather.place.low != assemble::Index4{};
  return std::uint64_t{gather.placed} | std::uint64_t{gather.local} << 1 | std::uint64_t{isShifted} << 2;
}

/// Variant::domainEven, which matters only for kernels with loops. The passes of a list draw the list's
/// texels, not the domain's.
bool isEven(const program::Kernel& kernel, const RegionLayout& domain, const Task& task) {
  return kernel.usesLoops && task.work != Work::List && assemble::drawsWholeQuads(domain);
}

/// Packs small numbers into a key's words.
class KeyBits {
 public:
  explicit KeyBits(ProgramKey& key) : key_(key) {}

  void add(std::uint64_t value, unsigned bits) {
    word(used_ / 64) |= value << used_ % 64;
    used_ += bits;
  }

 private:
  std::uint64_t& word(std::size_t number) {
    if (number < key_.words.size()) return key_.words[number];
    number -= key_.words.size();
    if (number == key_.more.size()) key_.more.push_back(0);
    return key_.more[number];
  }

  ProgramKey& key_;
  std::size_t used_ = 0;
};

}  // namespace

std::size_t ProgramKeyHash::operator()(const ProgramKey& key) const {
  std::uint64_t hash = reinterpret_cast<std::uintptr_t>(key.kernel);
  const auto add = [&](std::uint64_t word, std::size_t place) {
    if (word == 0) return;  // most words are 0
    hash = (hash ^ (word + place)) * 0x9E3779B97F4A7C15u;
    hash ^= hash >> 29;
  };
  for (std::size_t i = 0; i < key.words.size(); ++i) add(key.words[i], i);
  for (std::size_t i = 0; i < key.more.size(); ++i) add(key.more[i], key.words.size() + i);
  for (std::size_t i = 0; i < key.specs.size(); ++i) add(key.specs[i], i);
  return hash * 0x9E3779B97F4A7C15u >> 32;
}

Addressing addressingOf(const RegionLayout& regionLayout) {
  if (!regionLayout.linear) {
    return regionLayout.numbered ? Addressing::Rows : Addressing::Plane;
  }
  return regionLayout.layered ? Addressing::Layered : Addressing::Linear;
}

Operand regionOperand(const Argument& argument, const Shape& domain) {
  GlStream& stream = glStream(argument.region);
  Operand operand{.regionLayout = regionLayoutOf(argument.region, stream.layout), .planes = stream.planes};
  operand.storage = stream.storage;
  operand.fitted = argument.fit != program::Fit::Same;
  if (!operand.fitted) return operand;
  const assemble::Index4 whole = xFirst(domain);
  for (std::size_t d = 0; d < whole.size(); ++d) {
    const std::int32_t extent = operand.regionLayout.extent[d];
    operand.ratio[d] = extent <= whole[d] ? whole[d] / extent : -(extent / whole[d]);
  }
  return operand;
}

RegionLayout texelOf(RegionLayout element) {
  if (!element.linear) return element;
  std::int64_t number = 0;
  for (std::size_t d = 0; d < element.origin.size(); ++d) {
    number += std::int64_t{element.origin[d]} * element.stride[d];
  }
  const std::int32_t shift = element.shift + (element.packed ? 2 : 0);
  element.origin = {static_cast<std::int32_t>(number & ((std::int64_t{1} << shift) - 1)),
                    static_cast<std::int32_t>(number >> shift), 0, 0};
  return element;
}

Operand uniformOperand(const Argument& argument) {
  if (argument.value != nullptr) return {.value = argument.value};
  Operand operand = regionOperand(argument, argument.region.shape);
  operand.regionLayout = texelOf(operand.regionLayout);
  return operand;
}

Operand iteration(const Parameter& iterator, const void* ends, const Shape& domain) {
  RegionLayout regionLayout;
  regionLayout.extent = xFirst(domain);
  if (domain.size() <= mostElements) regionLayout.stride = assemble::stridesOf(regionLayout.extent);
  return {.value = ends,
          .regionLayout = regionLayout,
          .step = stepOf(iterator, ends, domain),
          .rank = domain.rank()};
}

assemble::Variant chooseVariant(const program::Kernel& kernel, std::span<const Operand> operands,
                                const RegionLayout& domain, const Task& task, bool filtersFloats) {
  assemble::Variant variant;
  variant.task = task;
  variant.domain = domainOf(domain, task);
  variant.domainView = isDomainView(domain);
  variant.domainPacked = domain.packed;
  variant.domainEven = isEven(kernel, domain, task);
  variant.domainLayered = domain.layered;
  variant.domainPlaced = domain.placed;
  variant.domainRank = assemble::decodedRank(domain);
  variant.specs = specsOf(kernel, operands);
  for (std::size_t i = 0; i < kernel.parameters.size(); ++i) {
    const Parameter& parameter = kernel.parameters[i];
    StreamAccess access;
    if (isHeld(parameter, operands[i])) {
      access = {.addressing = addressingOf(operands[i].regionLayout),
                .view = true,
                .storage = operands[i].storage,
                .packed = operands[i].regionLayout.packed};
    } else if (parameter.role == Role::Iterator) {
      access = chooseIteration(parameter, operands[i], domain);
    } else if (hasAccess(kernel, i, task) && isNeeded(parameter, variant.specs)) {
      access = chooseAccess(parameter, operands[i], domain, task, filtersFloats);
    } else if (parameter.role == Role::Output && isNeeded(parameter, variant.specs)) {
      access.storage = operands[i].storage;
    }
    variant.access.push_back(access);
  }
  return variant;
}

// Every entry has 4 bits, so that none straddles two words.
ProgramKey variantKey(const program::Kernel& kernel, std::span<const Operand> operands,
                      const RegionLayout& domain, const Task& task, bool filtersFloats) {
  ProgramKey key{&kernel, {}, {}, specsOf(kernel, operands)};
  KeyBits bits(key);
  bits.add(domainBits(domain, task), 4);
  bits.add(static_cast<std::uint64_t>(task.work) | std::uint64_t{domain.packed} << 3, 4);
  bits.add(std::uint64_t{task.pyramidLayered} | std::uint64_t{task.scattersInAnyOrder} << 1 |
               std::uint64_t{task.pushesInAnyOrder} << 2,
           4);
  bits.add(task.appendOutput & 15u, 4);
  bits.add(task.appendOutput >> 4, 4);
  bool hasStorages = false;
  for (std::size_t i = 0; i < operands.size(); ++i) {
    hasStorages = hasStorages || operands[i].storage != Storage::Single || operands[i].regionLayout.packed ||
                  operands[i].regionLayout.strided || isHeld(kernel.parameters[i], operands[i]);
  }
  bits.add(rankBits(domain, task) | std::uint64_t{hasStorages} << 3, 4);
  if (kernel.usesLoops) {
    bits.add(isEven(kernel, domain, task), 4);
  }
  bool hasIterator = false;
  for (std::size_t i = 0; i < kernel.parameters.size(); ++i) {
    const Parameter& parameter = kernel.parameters[i];
    if (parameter.role == Role::Iterator && !std::exchange(hasIterator, true)) {
      // the properties of the domain on which chooseIteration() depends, once for all iterators
      bits.add(std::uint64_t{operands[i].rank == 1} | std::uint64_t{isFlat(domain)} << 1, 4);
    }
    if (hasAccess(kernel, i, task) && isNeeded(parameter, key.specs)) {
      const StreamAccess access = chooseAccess(parameter, operands[i], domain, task, filtersFloats);
      // Aligned, which no gather is, stands for a filtered one: those are planes and not views. With strides, it stands
      // for Rows, which is no other access.
      const bool isOther = access.filtered || access.addressing == Addressing::Rows;
      const Addressing addressing = isOther ? Addressing::Aligned : access.addressing;
      bits.add(static_cast<std::uint64_t>(addressing) | choiceBits(access) << 2, 4);
    }
    if (hasStorages && parameter.role == Role::Uniform) {
      // no operand has Storage::Default, which stands for a value
      const bool isStream = isHeld(parameter, operands[i]);
      bits.add(isStream ? static_cast<std::uint64_t>(operands[i].storage) |
                              std::uint64_t{operands[i].regionLayout.packed} << 3
                        : 0,
               4);
      if (isStream) bits.add(std::uint64_t{operands[i].regionLayout.layered}, 4);
    } else if (hasStorages && parameter.role != Role::Spec) {
      static_assert(static_cast<int>(Storage::Double) <= 4);  // and none is Default, 0
      bits.add((static_cast<std::uint64_t>(operands[i].storage) & 3) |
                   std::uint64_t{operands[i].regionLayout.packed} << 2 |
                   std::uint64_t{operands[i].regionLayout.strided} << 3,
               4);
    }
  }
  const bool isPlaced = domain.placed || std::ranges::any_of(operands, [](const Operand& operand) {
                          return operand.regionLayout.placed;
                        });
  if (!isPlaced) return key;
  bits.add(1 | std::uint64_t{domain.placed} << 1, 4);
  for (std::size_t i = 0; i < operands.size(); ++i) {
    if (kernel.parameters[i].role == Role::Gather) bits.add(placeBits(operands[i].regionLayout), 4);
  }
  return key;
}

}  // namespace sk
