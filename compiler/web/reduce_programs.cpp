// SPDX-License-Identifier: MIT
//
// Which programs a reduction needs follows from the plans for streams of several shapes: the planner is asked, as the
// runtime asks its own.
#include <algorithm>
#include <array>
#include <limits>

#include "assemble/reduce/reduce_plan.hpp"
#include "assemble/reduce/scan_plan.hpp"
#include "web/ahead_programs.hpp"
#include "web/spec_choices.hpp"

namespace skc::web {
namespace {

using sk::assemble::Addressing;
using sk::assemble::Division;
using sk::assemble::Domain;
using sk::assemble::Index4;
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

RegionLayout linear(const Index4& extent) {
  const std::int64_t count = sk::assemble::elements(extent);
  RegionLayout layout = sk::assemble::linearLayout(count, *sk::assemble::linearTexture(count, anyTexture));
  layout.extent = extent;
  layout.stride = sk::assemble::stridesOf(extent);
  return layout;
}

/// A plane, and linearised streams whose index has one component or four. Those of two and three use the latter's programs.
std::vector<RegionLayout> indexedLayouts() {
  return {{.extent = {2048, 16, 1, 1}}, linear({32768, 1, 1, 1}), linear({64, 16, 16, 16})};
}

/// Lets a pass's program write any number of runs of any number of blocks to a texture of any width, which saves programs.
void generalize(ReducePass& pass) {
  pass.variant.runs = sk::assemble::Runs::Split;
  pass.variant.domain = Domain::Plane;
}

/// The passes to a value for both kinds of programs of long runs.
std::vector<ReducePass> passesInOrder(const RegionLayout& elements, const Reduction& reduction) {
  std::vector<ReducePass> all;
  for (const std::int32_t knownRuns : {ReduceLimits{}.knownRuns, std::numeric_limits<std::int32_t>::max()}) {
    ReduceLimits limits{.texture = anyTexture};
    limits.knownRuns = knownRuns;
    const Division division{
        .blocks = {1, 1, 1, 1}, .byTexel = elements.packed, .inAnyOrder = reduction.commutative};
    std::ranges::move(sk::assemble::planReduction(elements, sk::assemble::valueLayout(), limits, division),
                      std::back_inserter(all));
  }
  return all;
}

/// The passes to a value or to a stream.
std::vector<ReducePass> passesByIndex(const RegionLayout& elements) {
  const Division division{.blocks = {1, 1, 1, 1}, .byIndex = true};
  std::vector<ReducePass> all =
      sk::assemble::planReduction(elements, sk::assemble::valueLayout(), {.texture = anyTexture}, division);
  std::ranges::for_each(all, generalize);
  return all;
}

bool hasIdentities(const Reduction& reduction) {
  return std::ranges::none_of(reduction.fold.parameters, [](const Parameter& parameter) {
    return parameter.role == Role::Accumulator && parameter.identity.empty();
  });
}

std::vector<ReducePass> passesOfScan(const RegionLayout& elements, const Reduction& reduction, bool byIndex) {
  std::vector<ReducePass> all;
  const ReduceLimits limits{.texture = anyTexture, .fanIn = sk::assemble::scanRun};
  const sk::assemble::Lines lines{static_cast<std::int32_t>(sk::assemble::elements(elements.extent)), 1};
  for (const bool isExclusive : {false, true}) {
    if (isExclusive && !hasIdentities(reduction)) continue;
    sk::assemble::ScanPlan plan =
        sk::assemble::planScan(elements, elements, limits, lines, {.byIndex = byIndex}, isExclusive);
    for (std::vector<ReducePass>* passes : {&plan.folds, &plan.scans}) {
      for (ReducePass& pass : *passes) {
        if (pass.variant.walk != Walk::Index) pass.variant.axes = 1;
        pass.variant.carried = pass.variant.scan != sk::assemble::ScanPass::Folds;
        generalize(pass);
        all.push_back(std::move(pass));
      }
    }
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
      if (pass.variant.walk == Walk::Index && (domain == Domain::Linear) != elements.linear) continue;
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

Programs reducePrograms(const sk::assemble::Profile& profile, const Reduction& reduction,
                        const ReductionCalls& calls) {
  Programs programs;
  const auto addAll = [&](const RegionLayout& elements, const std::vector<ReducePass>& passes) {
    for (const ReducePass& pass : passes) {
      const Kernel& kernel =
          sk::assemble::isOfPartials(pass.variant.walk) ? reduction.combine : reduction.fold;
      for (const ReduceVariant& variant : variantsOf(pass, kernel, elements))
        add(programs, profile, reduction, variant, kernel);
    }
  };
  if (calls.scans && !calls.byIndex) {
    for (const RegionLayout& elements : {RegionLayout{.extent = {2048, 16, 1, 1}}, linear({32768, 1, 1, 1})})
      addAll(elements, passesOfScan(elements, reduction, false));
    return programs;
  }
  for (const RegionLayout& elements : indexedLayouts())
    addAll(elements, calls.scans ? passesOfScan(elements, reduction, true) : passesByIndex(elements));
  if (calls.scans) return programs;
  for (const bool packed : {false, true}) {
    if (calls.byIndex || (packed && !readsScalars(reduction.fold))) continue;
    for (const RegionLayout& elements : elementLayouts(packed))
      addAll(elements, passesInOrder(elements, reduction));
  }
  if (calls.mayBeEmpty && hasIdentities(reduction))
    add(programs, profile, reduction, sk::assemble::planIdentities(sk::assemble::valueLayout()).variant,
        reduction.fold);
  return programs;
}

}  // namespace skc::web
