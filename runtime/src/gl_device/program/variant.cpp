// SPDX-License-Identifier: MIT
//
// Chooses variants.
#include "gl_device/program/variant.hpp"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <type_traits>

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

/// Variant::domainEven, which matters only for kernels with loops. The passes of a list draw the list's
/// texels, not the domain's.
bool isEven(const program::Kernel& kernel, const RegionLayout& domain, const Task& task) {
  return kernel.usesLoops && task.work != Work::List && assemble::drawsWholeQuads(domain);
}

}  // namespace

std::size_t ProgramKeyHash::operator()(const ProgramKey& key) const {
  const assemble::Variant& variant = key.variant;
  static_assert(std::has_unique_object_representations_v<StreamAccess> &&
                std::has_unique_object_representations_v<Task>);
  std::uint64_t hash = reinterpret_cast<std::uintptr_t>(key.kernel);
  const auto add = [&](const auto* values, std::size_t count) {
    const auto* const bytes = reinterpret_cast<const char*>(values);
    const std::size_t size = count * sizeof *values;
    std::uint64_t word = 0;
    for (std::size_t i = 0; i < size; i += sizeof word) {
      std::memcpy(&word, bytes + i, std::min(sizeof word, size - i));
      hash = (hash ^ (word + i)) * 0x9E3779B97F4A7C15u;
      hash ^= hash >> 29;
    }
  };
  add(&variant.task, 1);
  const std::uint8_t domain[] = {static_cast<std::uint8_t>(variant.domain),
                                 variant.domainView,
                                 variant.domainPacked,
                                 variant.domainEven,
                                 variant.domainLayered,
                                 variant.domainRank,
                                 variant.domainPlaced};
  add(domain, std::size(domain));
  add(variant.access.data(), variant.access.size());
  add(variant.specs.data(), variant.specs.size());
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
  chooseVariant(kernel, operands, domain, task, filtersFloats, variant);
  return variant;
}

void chooseVariant(const program::Kernel& kernel, std::span<const Operand> operands,
                   const RegionLayout& domain, const Task& task, bool filtersFloats,
                   assemble::Variant& variant) {
  variant.task = task;
  variant.domain = domainOf(domain, task);
  variant.domainView = isDomainView(domain);
  variant.domainPacked = domain.packed;
  variant.domainEven = isEven(kernel, domain, task);
  variant.domainLayered = domain.layered;
  variant.domainPlaced = domain.placed;
  variant.domainRank = assemble::decodedRank(domain);
  variant.specs = specsOf(kernel, operands);
  variant.access.clear();
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
}

}  // namespace sk
