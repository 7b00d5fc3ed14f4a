// SPDX-License-Identifier: MIT
#include "web/ahead_programs.hpp"

#include <algorithm>
#include <iterator>
#include <string_view>

#include <fmt/format.h>

#include "web/offered.hpp"
#include "web/spec_choices.hpp"

namespace skc::web {
namespace {

using sk::assemble::Addressing;
using sk::assemble::Domain;
using sk::assemble::SpecValues;
using sk::assemble::StreamAccess;
using sk::assemble::Variant;
using sk::assemble::Work;
using sk::program::Kernel;
using sk::program::Parameter;
using sk::program::Role;

std::string_view nameOf(Addressing addressing) {
  switch (addressing) {
    case Addressing::Aligned: return "aligned";
    case Addressing::Plane: return "plane";
    case Addressing::Linear: return "linear";
    case Addressing::Layered: return "layered";
    case Addressing::Rows: break;
  }
  return "rows";
}

std::string_view nameOf(Domain domain) {
  switch (domain) {
    case Domain::Plane: return "plane";
    case Domain::Linear: return "linear";
    case Domain::LinearBox: return "box";
    case Domain::Entry: return "entry";
    case Domain::Strided: return "strided";
    case Domain::StridedRows: return "strided rows";
    case Domain::StridedLinear: break;
  }
  return "strided linear";
}

/// "; u:plane packed nearby" for each parameter whose access a program depends on, "; no u" for a stream that it does
/// not need.
std::string accessKey(const Kernel& kernel, std::span<const StreamAccess> access, const SpecValues& specs) {
  std::string key;
  for (std::size_t i = 0; i < access.size(); ++i) {
    const Parameter& parameter = kernel.parameters[i];
    const Role role = parameter.role;
    if (!sk::assemble::isNeeded(parameter, specs)) {
      key += fmt::format("; no {}", parameter.name);
    } else if (role == Role::Input || role == Role::Gather || role == Role::Iterator) {
      const StreamAccess& a = access[i];
      key += fmt::format("; {}:{}{}{}{}{}", parameter.name, nameOf(a.addressing), a.packed ? " packed" : "",
                         a.view ? " view" : "", a.nearby ? " nearby" : "", a.filtered ? " filtered" : "");
    }
  }
  return key;
}

}  // namespace

std::vector<Lie> liesOf(const Kernel& kernel) {
  const auto readsNear = [&](std::initializer_list<int> ranks) {
    return std::ranges::any_of(kernel.parameters, [&](const Parameter& parameter) {
      return parameter.usesNear && std::ranges::find(ranks, parameter.rank) != ranks.end();
    });
  };
  const bool isAny = !readsNear({1, 2, 3, 4});
  const bool isPlane = isAny || readsNear({2}), isLine = isAny || readsNear({1}),
             isSpace = isAny || readsNear({3, 4});
  std::vector<Lie> lies;
  for (const bool packed : {true, false}) {
    if (isPlane) lies.push_back({Domain::Plane, 2, packed});
    if (isLine) lies.push_back({Domain::Linear, 1, packed});
    if (isSpace) lies.push_back({Domain::Linear, 4, packed});
  }
  return lies;
}

namespace {

/// "; i:linear" for iterators, "; no u" for streams that are not needed: views are all accessed in one way.
std::string viewsKey(const Kernel& kernel, const Variant& variant) {
  std::string key = variant.domain == Domain::Plane ? "views plane" : "views box";
  for (std::size_t i = 0; i < variant.access.size(); ++i) {
    const Parameter& parameter = kernel.parameters[i];
    if (!sk::assemble::isNeeded(parameter, variant.specs)) {
      key += fmt::format("; no {}", parameter.name);
    } else if (parameter.role == Role::Iterator) {
      key += fmt::format("; {}:{}", parameter.name, nameOf(variant.access[i].addressing));
    }
  }
  return key;
}

/// Accesses of the streams of a call with views. Scalar iterators count elements; others do so in domains of one dimension
/// alone.
std::vector<std::vector<StreamAccess>> viewChoices(const Kernel& kernel, Domain domain) {
  std::vector<std::vector<StreamAccess>> choices(1);
  bool hasVectorIterator = false;
  for (const Parameter& parameter : kernel.parameters) {
    StreamAccess access;
    if (parameter.role == Role::Input || parameter.role == Role::Gather) {
      const bool isPlane = parameter.role == Role::Input ? domain == Domain::Plane : parameter.rank == 2;
      access = {.addressing = isPlane ? Addressing::Plane : Addressing::Linear,
                .view = true,
                .fitted = parameter.role == Role::Input,
                .strided = true};
    } else if (parameter.role == Role::Iterator) {
      const bool isScalar = parameter.element->fields.front().width == 1;
      if (isScalar) access.addressing = Addressing::Linear;
      hasVectorIterator = hasVectorIterator || !isScalar;
    }
    choices.front().push_back(access);
  }
  if (domain == Domain::Plane || !hasVectorIterator) return choices;
  choices.push_back(choices.front());
  for (std::size_t i = 0; i < kernel.parameters.size(); ++i) {
    if (kernel.parameters[i].role == Role::Iterator) choices.back()[i].addressing = Addressing::Linear;
  }
  return choices;
}

/// Programs that read and write any region of a stream, and whose inputs repeat or skip elements: one for planes, one for
/// linearised streams, which decodes all four dimensions.
void addViewPrograms(Programs& programs, const sk::assemble::Profile& profile, const Kernel& kernel,
                     const SpecValues& specs) {
  for (const Lie& lie : liesOf(kernel)) {
    if (lie.packed) continue;
    Variant variant;
    variant.specs = specs;
    variant.domain = lie.domain == Domain::Plane ? Domain::Plane : Domain::LinearBox;
    variant.domainView = true;
    variant.domainRank = variant.domain == Domain::Plane ? 2 : 4;
    for (std::vector<StreamAccess>& access : viewChoices(kernel, variant.domain)) {
      variant.access = std::move(access);
      const std::string key = keyOf(kernel, variant);
      if (!programs.contains(key))
        programs.emplace(key, sk::assemble::kernelProgram(profile, kernel, variant));
    }
  }
}

}  // namespace

std::string keyOf(const Kernel& kernel, const Variant& variant) {
  if (variant.domainView) return viewsKey(kernel, variant);
  std::string key(nameOf(variant.domain));
  if (variant.domain == Domain::Linear || variant.domain == Domain::Entry)
    key += std::to_string(variant.domainRank);
  if (variant.domainPacked) key += " packed";
  return key + accessKey(kernel, variant.access, variant.specs);
}

std::string keyOf(const Kernel& kernel, const sk::assemble::ReduceVariant& v) {
  using sk::assemble::Runs;
  using sk::assemble::Walk;
  constexpr std::string_view walks[] = {
      "line", "plane", "box", "index", "rows", "partials", "partialRows", "groupedPartials", "nothing"};
  std::string key(walks[static_cast<std::size_t>(v.walk)]);
  if (v.runs != Runs::OneBlock) key += v.runs == Runs::WholeBlocks ? " whole" : " split";
  if (v.domain != Domain::Linear) key += fmt::format(" to {}", nameOf(v.domain));
  if (v.axes != 1) key += fmt::format(" axes{}", v.axes);
  if (v.run != 0) key += fmt::format(" run{}", v.run);
  if (v.column) key += " column";
  if (v.packed) key += " packed";
  if (v.sourceLayered) key += " layers";
  if (v.domainLayered) key += " to layers";
  if (v.reshaped) key += " reshaped";
  constexpr std::string_view scans[] = {"", " folds", " inclusive", " exclusive"};
  key += scans[static_cast<std::size_t>(v.scan)];
  if (v.carried) key += " carried";
  if (v.planeCount != 0) key += fmt::format(" planes{}", v.firstPlane);
  if (v.walk == Walk::Nothing) return key;
  std::vector<StreamAccess> access = v.access;
  for (std::size_t i = 0; i < access.size(); ++i) {
    const bool isAligned = kernel.parameters[i].role == Role::Input && v.walk != Walk::Index;
    if (isAligned) access[i] = {};
  }
  return key + accessKey(kernel, access, v.specs);
}

std::vector<std::vector<StreamAccess>> accessChoices(const Kernel& kernel, const Lie& lie,
                                                     bool domainPacked) {
  std::vector<std::vector<StreamAccess>> choices(1);
  const auto add = [&](const StreamAccess& access) {
    for (std::vector<StreamAccess>& choice : choices) choice.push_back(access);
  };
  bool hasIterator = false;
  for (const Parameter& parameter : kernel.parameters) {
    const bool isPacked = lie.packed && sk::assemble::mayPack(heldBy(parameter));
    StreamAccess access;
    if (parameter.role == Role::Input) {
      if (isPacked != domainPacked) {
        access.addressing = lie.domain == Domain::Plane ? Addressing::Plane : Addressing::Linear;
        access.packed = isPacked;
      }
      add(access);
    } else if (parameter.role == Role::Gather) {
      access.nearby = parameter.usesNear && parameter.reach >= 0;
      access.addressing = parameter.rank == 2 ? Addressing::Plane : Addressing::Linear;
      access.packed = isPacked && !sk::assemble::mayFilter(parameter);
      std::vector<std::vector<StreamAccess>> filtered;
      if (parameter.rank == 2 && sk::assemble::mayFilter(parameter)) filtered = choices;
      add(access);
      access.filtered = true;
      for (std::vector<StreamAccess>& choice : filtered) {
        choice.push_back(access);
        choices.push_back(std::move(choice));
      }
    } else {
      hasIterator = hasIterator || parameter.role == Role::Iterator;
      add(access);
    }
  }
  if (!hasIterator) return choices;
  // Iterators count elements, or they advance along the dimensions. In a domain whose only extent above 1 is x, numbers do
  // both.
  std::vector<std::vector<StreamAccess>> counting = choices;
  for (std::vector<StreamAccess>& choice : counting) {
    for (std::size_t i = 0; i < choice.size(); ++i) {
      const Parameter& parameter = kernel.parameters[i];
      if (parameter.role != Role::Iterator) continue;
      const bool isScalar = parameter.element->fields.front().width == 1;
      const bool isLine = lie.domain == Domain::Linear && lie.rank == 1;
      if (isScalar != isLine) choice[i].addressing = Addressing::Linear;
    }
  }
  std::ranges::move(counting, std::back_inserter(choices));
  return choices;
}

Programs viewPrograms(const sk::assemble::Profile& profile, const Kernel& kernel) {
  Programs programs;
  for (const SpecValues& specs : specChoices(kernel)) addViewPrograms(programs, profile, kernel, specs);
  return programs;
}

Programs kernelPrograms(const sk::assemble::Profile& profile, const Kernel& kernel, const Wanted& wanted) {
  Programs programs = wanted.views ? viewPrograms(profile, kernel) : Programs{};
  for (const SpecValues& specs : specChoices(kernel)) {
    for (const Lie& lie : liesOf(kernel)) {
      if (lie.packed && !wanted.packed) continue;
      Variant variant;
      if (hasAppendOutputs(kernel)) variant.task.work = Work::Counts;
      variant.specs = specs;
      variant.domain = lie.domain;
      variant.domainRank = lie.rank;
      variant.domainPacked = lie.packed && sk::assemble::mayWritePacked(kernel);
      for (std::vector<StreamAccess>& access : accessChoices(kernel, lie, variant.domainPacked)) {
        variant.access = std::move(access);
        const std::string key = keyOf(kernel, variant);
        if (!programs.contains(key))
          programs.emplace(key, sk::assemble::kernelProgram(profile, kernel, variant));
      }
    }
  }
  return programs;
}

Programs listPrograms(const sk::assemble::Profile& profile, const Kernel& kernel, std::size_t appendOutput) {
  Programs programs;
  for (const SpecValues& specs : specChoices(kernel)) {
    for (const Lie& lie : liesOf(kernel)) {
      if (lie.packed) continue;
      Variant variant;
      variant.task = {.work = Work::List, .appendOutput = static_cast<std::uint8_t>(appendOutput)};
      variant.specs = specs;
      variant.domain = Domain::Entry;
      variant.domainRank = lie.domain == Domain::Linear && lie.rank == 1 ? 1 : 4;
      for (std::vector<StreamAccess>& access : accessChoices(kernel, lie, false)) {
        variant.access = std::move(access);
        for (std::size_t i = 0; i < kernel.parameters.size(); ++i) {
          const Parameter& parameter = kernel.parameters[i];
          const bool isPlane =
              parameter.role == Role::Input ? lie.domain == Domain::Plane : parameter.rank == 2;
          if (parameter.role == Role::Input || parameter.role == Role::Scatter)
            variant.access[i] = {.addressing = isPlane ? Addressing::Plane : Addressing::Linear};
        }
        const std::string key = keyOf(kernel, variant);
        if (!programs.contains(key))
          programs.emplace(key, sk::assemble::kernelProgram(profile, kernel, variant));
      }
    }
  }
  return programs;
}

}  // namespace skc::web
