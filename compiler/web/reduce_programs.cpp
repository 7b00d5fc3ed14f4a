// SPDX-License-Identifier: MIT
//
// Which programs a reduction needs follows from the plans for streams of several shapes: the planner is asked, as the
// runtime asks its own.
#include <algorithm>
#include <limits>

#include "assemble/reduce/reduce_plan.hpp"
#include "web/ahead_programs.hpp"

namespace skc::web {
namespace {

using sk::assemble::Addressing;
using sk::assemble::Division;
using sk::assemble::Domain;
using sk::assemble::ReduceLimits;
using sk::assemble::ReducePass;
using sk::assemble::ReduceVariant;
using sk::assemble::RegionLayout;
using sk::assemble::StreamAccess;
using sk::assemble::Walk;
using sk::program::Kernel;
using sk::program::Parameter;
using sk::program::Reduction;
using sk::program::Role;

constexpr sk::assemble::TextureLimits anyTexture{8192, 256};

/// Layouts of elements for which all plans of whole streams are among their plans: squares, rows, columns, odd extents,
/// and last rows that are not full.
std::vector<RegionLayout> elementLayouts(bool packed) {
  std::vector<RegionLayout> layouts;
  for (const auto& [width, height] :
       {std::pair{2048, 2048}, {64, 64}, {4, 1}, {8, 400}, {400, 3}, {1020, 1021}, {20, 7}}) {
    RegionLayout plane;
    plane.extent = {width, height, 1, 1};
    plane.packed = packed;
    layouts.push_back(plane);
  }
  for (const std::int32_t count : {1 << 20, 1000004, 1024, 300, 4}) {
    RegionLayout linear = sk::assemble::linearLayout(
        count, *sk::assemble::linearTexture(packed ? count / sk::assemble::lanes : count, anyTexture));
    linear.packed = packed;
    layouts.push_back(linear);
  }
  return layouts;
}

/// One plan for each rank that programs by index may have.
std::vector<RegionLayout> indexedLayouts() {
  std::vector<RegionLayout> layouts(4);
  for (std::size_t rank = 1; rank <= 4; ++rank) {
    for (std::size_t d = 0; d < rank; ++d) layouts[rank - 1].extent[d] = 16;
  }
  return layouts;
}

std::vector<ReducePass> passesOf(const RegionLayout& elements, const Reduction& reduction, bool byIndex) {
  std::vector<ReducePass> all;
  for (const std::int32_t knownRuns : {ReduceLimits{}.knownRuns, std::numeric_limits<std::int32_t>::max()}) {
    ReduceLimits limits{.texture = anyTexture};
    limits.knownRuns = knownRuns;
    const Division division{.blocks = {1, 1, 1, 1},
                            .byIndex = byIndex,
                            .byTexel = elements.packed && !byIndex,
                            .inAnyOrder = reduction.commutative};
    std::vector<ReducePass> passes =
        sk::assemble::planReduction(elements, sk::assemble::valueLayout(), limits, division);
    std::ranges::move(passes, std::back_inserter(all));
  }
  return all;
}

bool readsScalars(const Kernel& fold) {
  return std::ranges::all_of(fold.parameters, [](const Parameter& parameter) {
    return parameter.role != Role::Input || sk::assemble::mayPack(heldBy(parameter));
  });
}

/// The variants of a pass for all accesses of gathers, iterators and, by index, of inputs.
std::vector<ReduceVariant> variantsOf(const ReducePass& pass, const Kernel& kernel,
                                      const RegionLayout& elements) {
  std::vector<ReduceVariant> variants;
  const bool isPartial = sk::assemble::isOfPartials(pass.variant.walk);
  const std::uint8_t rank = sk::assemble::decodedRank(elements);
  for (const sk::assemble::SpecValues& specs : specChoices(kernel)) {
    for (const Domain domain : {Domain::Plane, Domain::Linear}) {
      for (const bool packed : {true, false}) {
        for (std::vector<StreamAccess>& access : accessChoices(kernel, {domain, rank, packed}, packed)) {
          ReduceVariant variant = pass.variant;
          variant.specs = specs;
          for (std::size_t i = 0; i < access.size(); ++i) {
            if (kernel.parameters[i].role != Role::Input) continue;
            access[i] = {};
            if (variant.walk == Walk::Index && !isPartial)
              access[i].addressing = domain == Domain::Plane ? Addressing::Plane : Addressing::Linear;
          }
          variant.access = std::move(access);
          variants.push_back(std::move(variant));
        }
      }
    }
  }
  return variants;
}

/// Adds a pass's program, or one for each part of the accumulators' planes that the profile's devices write at once.
void add(Programs& programs, const sk::assemble::Profile& profile, const Reduction& reduction,
         ReduceVariant variant, const Kernel& kernel) {
  std::size_t planes = 0;
  for (const Parameter& parameter : reduction.fold.parameters) {
    if (parameter.role == Role::Accumulator) planes += parameter.element->fields.size();
  }
  const auto most = static_cast<std::size_t>(profile.drawBuffers);
  for (std::size_t first = 0; first < planes; first += most) {
    if (planes > most) {
      variant.firstPlane = static_cast<std::uint8_t>(first);
      variant.planeCount = static_cast<std::uint8_t>(std::min(most, planes - first));
    }
    const std::string key = keyOf(kernel, variant);
    if (!programs.contains(key))
      programs.emplace(key, sk::assemble::reduceProgram(profile, reduction, variant));
  }
}

}  // namespace

Programs reducePrograms(const sk::assemble::Profile& profile, const Reduction& reduction) {
  const bool byIndex = sk::assemble::readsElementIndex(reduction.fold);
  std::vector<RegionLayout> layouts =
      indexedLayouts();  // inputs may lie in different ways, even without an index
  if (!byIndex) {
    std::ranges::move(elementLayouts(false), std::back_inserter(layouts));
    if (readsScalars(reduction.fold)) std::ranges::move(elementLayouts(true), std::back_inserter(layouts));
  }
  const auto inputs = std::ranges::count(reduction.fold.parameters, Role::Input, &Parameter::role);
  Programs programs;
  for (const RegionLayout& elements : layouts) {
    const bool isIndexed = &elements - layouts.data() < 4;
    if (isIndexed && !byIndex && inputs == 1) continue;  // the only input lies as itself
    for (const ReducePass& pass : passesOf(elements, reduction, isIndexed)) {
      const Kernel& kernel =
          sk::assemble::isOfPartials(pass.variant.walk) ? reduction.combine : reduction.fold;
      for (const ReduceVariant& variant : variantsOf(pass, kernel, elements))
        add(programs, profile, reduction, variant, kernel);
    }
  }
  add(programs, profile, reduction, sk::assemble::planIdentities(sk::assemble::valueLayout()).variant,
      reduction.fold);
  return programs;
}

}  // namespace skc::web
