// SPDX-License-Identifier: MIT
#include "web/sum_variants.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "assemble/program/texture_units.hpp"
#include "assemble/reduce/reduce_plan.hpp"
#include "web/ahead_programs.hpp"
#include "web/offered.hpp"
#include "web/spec_choices.hpp"

namespace skc::web {
namespace {

using sk::program::Kernel;
using sk::program::Parameter;
using sk::program::Reduction;
using sk::program::Role;

std::uint8_t accumulatorsOf(const Kernel& fold) {
  return static_cast<std::uint8_t>(std::ranges::count(fold.parameters, Role::Accumulator, &Parameter::role));
}

/// The number among the accumulators of a parameter of the fold.
std::uint8_t numberOf(const Kernel& fold, std::size_t parameter) {
  return static_cast<std::uint8_t>(
      std::ranges::count(fold.parameters.first(parameter), Role::Accumulator, &Parameter::role));
}

/// Inputs are accumulators that have sums, each once, then the rounding errors.
SumVariant compensated(const Reduction& plain) {
  const sk::program::CompensatedReduction& second = *plain.compensated;
  SumVariant variant{&second.reduction, &second.finish, {}, {}};
  for (const sk::program::CompensatedSum& sum : second.sums) {
    const std::uint8_t result = numberOf(plain.fold, sum.accumulator);
    if (!variant.results.empty() && variant.results.back() == result) continue;
    variant.results.push_back(result);
    variant.inputs.push_back({true, result});
  }
  const std::uint8_t own = accumulatorsOf(plain.fold);
  for (std::size_t i = 0; i < second.sums.size(); ++i)
    variant.inputs.push_back({true, static_cast<std::uint8_t>(own + i)});
  return variant;
}

SumVariant extended(const Reduction& plain) {
  SumVariant variant{&plain.wide->reduction, &plain.wide->finish, {}, {}};
  for (std::uint8_t i = 0; i < accumulatorsOf(plain.fold); ++i) {
    variant.inputs.push_back({true, i});
    variant.results.push_back(i);
  }
  return variant;
}

/// Inputs are the plain accumulator and the digits of the sum.
SumVariant exact(const Reduction& plain, const sk::program::ExactSum& sum) {
  const std::uint8_t result = numberOf(plain.fold, sum.accumulator);
  SumVariant variant{&sum.reduction, &sum.finish, {{false, result}}, {result}};
  for (std::uint8_t i = 0; i < accumulatorsOf(sum.reduction.fold); ++i) variant.inputs.push_back({true, i});
  return variant;
}

std::string whyNot(const SumVariant& variant, bool scans) {
  const sk::assemble::Profile profile = webProfile();
  if (std::string why = whyTooManyPlanes(*variant.reduction, scans); !why.empty()) return why;
  if (sk::assemble::fitsOnePass(*variant.finish, {profile.drawBuffers, profile.textureUnits}, {})) return {};
  return fmt::format(
      "its accumulators have more than the {} planes that a pass of a browser writes; divide it",
      profile.drawBuffers);
}

std::size_t planesRead(const Kernel& kernel, const sk::assemble::SpecValues& specs) {
  std::size_t planes = 0;
  for (const Parameter& parameter : kernel.parameters) {
    const bool isRead = parameter.role == Role::Input || parameter.role == Role::Gather;
    if (isRead && sk::assemble::isNeeded(parameter, specs)) planes += heldBy(parameter).fields.size();
  }
  return planes;
}

SumVariants checked(SumVariants sums, bool scans) {
  for (const SumVariant& variant : sums.variants) {
    if (sums.whyNot = whyNot(variant, scans); !sums.whyNot.empty()) break;
  }
  if (!sums.whyNot.empty()) sums.variants.clear();
  return sums;
}

}  // namespace

std::vector<SumVariants> sumVariants(const Reduction& reduction, bool scans) {
  std::vector<SumVariants> all;
  if (reduction.compensated != nullptr)
    all.push_back(checked({.name = "compensated", .variants = {compensated(reduction)}}, scans));
  if (reduction.wide != nullptr) {
    all.push_back(checked({.name = "extended", .variants = {extended(reduction)}, .isRare = true}, scans));
  } else if (!reduction.fold.whyNotWide.empty()) {
    all.push_back({.name = "extended",
                   .variants = {},
                   .whyNot = fmt::format("it has no form in doubles: {}", reduction.fold.whyNotWide)});
  }
  if (!reduction.exact.empty()) {
    SumVariants sums{.name = "exact", .variants = {}, .isRare = true};
    for (const sk::program::ExactSum& sum : reduction.exact) sums.variants.push_back(exact(reduction, sum));
    all.push_back(checked(std::move(sums), scans));
  }
  return all;
}

bool sumsEverything(const Reduction& reduction) {
  std::size_t scalars = 0;
  for (const Parameter& parameter : reduction.fold.parameters) {
    if (parameter.role != Role::Accumulator) continue;
    for (const sk::program::Field& field : parameter.element->fields) scalars += field.width;
  }
  return scalars == reduction.exact.size();
}

bool findsByIndex(const Reduction& reduction) {
  return sk::assemble::readsElementIndex(reduction.fold) ||
         std::ranges::find(reduction.fold.parameters, Role::Input, &Parameter::role) ==
             reduction.fold.parameters.end();
}

std::string whyTooManyPlanes(const Reduction& reduction, bool scans) {
  std::size_t carried = 0;
  for (const Parameter& parameter : reduction.fold.parameters) {
    if (scans && parameter.role == Role::Accumulator) carried += parameter.element->fields.size();
  }
  const auto most = static_cast<std::size_t>(webProfile().textureUnits);
  for (const Kernel* kernel : {&reduction.fold, &reduction.combine}) {
    for (const sk::assemble::SpecValues& specs : specChoices(*kernel)) {
      if (const std::size_t planes = planesRead(*kernel, specs) + carried; planes > most) {
        return fmt::format(
            "a pass reads {} planes, one for each scalar, vector or member of a struct, but browsers "
            "guarantee {}; put scalars together in vectors, or divide it",
            planes, most);
      }
    }
  }
  return {};
}

}  // namespace skc::web
