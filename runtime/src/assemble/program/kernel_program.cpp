// SPDX-License-Identifier: MIT
//
// Assembles the program of a kernel for one variant. Fills the sections parameter by parameter; main() calls
// the kernel's entry function between fetches and stores.
#include <algorithm>
#include <cassert>
#include <deque>
#include <optional>

#include <fmt/format.h>

#include "assemble/append/append_groups.hpp"
#include "assemble/append/append_passes.hpp"
#include "assemble/assemble.hpp"
#include "assemble/elements/arguments.hpp"
#include "assemble/elements/domain.hpp"
#include "assemble/elements/gather.hpp"
#include "assemble/elements/planes.hpp"
#include "assemble/glsl/own_arithmetic.hpp"
#include "assemble/glsl/program_text.hpp"
#include "assemble/reduce/group_fold.hpp"
#include "sk/scalar_bytes.hpp"

namespace sk::assemble {
namespace {

using program::Kernel;
using program::Parameter;
using program::Reduction;
using program::Role;

std::string_view name(Domain domain) {
  switch (domain) {
    case Domain::Plane: return "plane";
    case Domain::Linear: return "linear";
    case Domain::LinearBox: return "linear box";
    case Domain::Strided:
    case Domain::StridedRows: return "strided";
    case Domain::StridedLinear: return "linear strided";
    case Domain::Entry: return "list";
  }
  return {};
}

std::string_view name(Addressing addressing) {
  switch (addressing) {
    case Addressing::Aligned: return "aligned";
    case Addressing::Plane: return "plane";
    case Addressing::Linear: return "linear";
    case Addressing::Layered: return "layered";
    case Addressing::Rows: return "rows";
  }
  return {};
}

std::string_view name(Storage storage) {
  switch (storage) {
    case Storage::Default:
    case Storage::Single: return "";
    case Storage::Half: return " of halves";
    case Storage::Extended:
    case Storage::Double: return " of doubles";
  }
  return {};
}

/// For example "diffuse for glsl330: plane domain; u plane view nearby".
std::string describe(const Profile& profile, const Kernel& kernel, const Variant& variant) {
  std::string text = fmt::format(
      "{} for {}: {}{}{}{}{} domain", kernel.name, profile.name, variant.domainPlaced ? "placed " : "",
      variant.domainLayered ? "layered " : "", variant.domainPacked ? "packed " : "", name(variant.domain),
      variant.domainView ? " view" : "");
  for (std::size_t i = 0; i < kernel.parameters.size(); ++i) {
    const Parameter& parameter = kernel.parameters[i];
    const bool isRead = parameter.role == Role::Input || parameter.role == Role::Gather;
    if (parameter.role == Role::Uniform) {
      if (variant.access[i].view) text += fmt::format("; {} in a stream", parameter.name);
      continue;
    }
    if (!isNeeded(parameter, variant.specs)) {
      text += fmt::format("; no {}", parameter.name);
      continue;
    }
    const StreamAccess& access = variant.access[i];
    if (!isRead) {
      if (access.storage != Storage::Single)
        text += fmt::format("; {}{}", parameter.name, name(access.storage));
      continue;
    }
    text += fmt::format("; {} {}{}{}{}{}{}{}{}{}{}", parameter.name,
                        access.placed  ? "placed "
                        : access.local ? "local "
                                       : "",
                        access.packed ? "packed " : "", name(access.addressing), access.view ? " view" : "",
                        access.shifted ? " shifted" : "", access.strided ? " strided" : "",
                        access.nearby ? " nearby" : "", access.filtered ? " filtered" : "",
                        access.fitted ? " fitted" : "", name(access.storage));
  }
  return text;
}

/// Work groups of append outputs do not fetch texels together: they run the kernel on one texel after the other.
Profile profileFor(const Task& task, Profile profile) {
  if (task.work == Work::Groups || task.work == Work::Owners) profile.sharesTexels = false;
  return profile;
}

class KernelText {
 public:
  KernelText(const Profile& profile, const Kernel& kernel, const Variant& variant, const Reduction* reduction)
      : profile_(profileFor(variant.task, profile)),
        held_(kernel, variant.access),
        kernel_(held_.kernel()),
        variant_(variant),
        program_(profile_),
        domain_(program_,
                {variant.domain, variant.domainView, variant.domainRank, variant.domainLayered,
                 variant.domainPacked, variant.domainPlaced},
                variant.domainPlaced ? "sk_within" : "sk_index"),
        groups_(program_, domain_, profile, kernel_, variant) {
    if (reduction != nullptr) fold_.emplace(program_, *reduction, variant.domainPacked);
  }

  std::string write() {
    assert(variant_.task.work == Work::Elements ||
           (isGroups() || fold_) == (profile_.stage == Stage::Compute));
    assert(fold_.has_value() == (variant_.task.work == Work::Folds));
    if (profile_.relaysUniforms && !isList()) relayUniforms();
    if (isList())
      findEntry(program_, domain_, kernel_.parameters[variant_.task.appendOutput],
                variant_.task.pyramidLayered);
    if (kernel_.usesLoops && !variant_.domainEven) domain_.leaveOutside();
    if (kernel_.usesIndex) domain_.seenIndex();
    if (kernel_.usesExtent) {
      program_.function("ivec4 sk_extent()", {fmt::format("return {};", domain_.seenShape())});
    }
    for (std::size_t i = 0; i < kernel_.parameters.size(); ++i) {
      const bool isFolded = kernel_.parameters[i].role == Role::Accumulator;
      if (isFolded || isNeeded(kernel_.parameters[i], variant_.specs)) {
        defineAccess(i, variant_.access[i]);
      } else {
        defineUnused(kernel_.parameters[i]);
      }
    }
    callEntry();
    for (const auto& [parameter, variable] : results_) store(program_, *parameter, variable);
    storeAppendOutputs();
    if (profile_.stage == Stage::Compute)
      program_.storeAt(place(program_, domain_.texel()), variant_.domainLayered);
    if (isGroups()) groups_.finish();
    if (fold_) fold_->finish();
    return program_.finish(profile_, describe(profile_, kernel_, variant_), kernel_);
  }

  const std::vector<RelayedValue>& relayed() const { return program_.relayed(); }

 private:
  struct Result {
    const Parameter* parameter;
    std::string variable;
  };
  /// An argument of the entry function. `isLanes`: a vector of the values for the elements of a packed texel.
  struct Value {
    std::string text;
    bool isLanes = false;
  };

  /// Calls the entry once, or for each element of a packed texel.
  void callEntry() {
    const auto callWith = [&](std::string_view component) {
      std::vector<std::string> arguments;
      for (const Value& value : arguments_) {
        arguments.push_back(value.isLanes ? fmt::format("{}.{}", value.text, component) : value.text);
      }
      program_.statement(call(kernel_.entry, arguments, "      ") + ";");
    };
    if (!variant_.domainPacked) return callWith("");
    for (int lane = 0; lane < lanes; ++lane) {
      if (domain_.usesLane()) program_.statement(fmt::format("sk_lane = {};", lane));
      callWith(std::string_view("xyzw").substr(static_cast<std::size_t>(lane), 1));
      if (isGroups() && !groups_.afterElement().empty()) program_.statement(groups_.afterElement());
    }
  }

  /// Relays the uniforms that change most often first, because room is limited.
  void relayUniforms() {
    program_.relayUniforms();
    for (std::size_t i = 0; i < kernel_.parameters.size(); ++i) {
      const Parameter& parameter = kernel_.parameters[i];
      if (!isNeeded(parameter, variant_.specs)) continue;
      if (parameter.role == Role::Uniform && !variant_.access[i].view) {
        parameterUniform(program_, parameter.element->glsl, "arg", parameter);
      } else if (parameter.role == Role::Iterator) {
        parameterUniform(program_, parameter.element->glsl, "begin", parameter);
        parameterUniform(program_, parameter.element->glsl, "step", parameter);
      }
    }
    for (std::size_t i = 0; i < kernel_.parameters.size(); ++i) {
      if (variant_.access[i].view) parameterUniform(program_, "ivec4", "origin", kernel_.parameters[i]);
    }
  }

  bool isList() const { return variant_.task.work == Work::List; }
  bool isGroups() const { return variant_.task.work == Work::Groups || variant_.task.work == Work::Owners; }

  void defineAccess(std::size_t i, const StreamAccess& access) {
    const Parameter& parameter = kernel_.parameters[i];
    switch (parameter.role) {
      case Role::Uniform: arguments_.push_back({uniformValue(program_, parameter, access)}); break;
      case Role::Input: defineInput(parameter, access); break;
      case Role::Output: defineOutput(parameter); break;
      case Role::Gather:
        defineGather(
            program_,
            [&](int components) {
              return access.local ? domain_.position(components) : domain_.seenPosition(components);
            },
            parameter, access, sharesTexels(parameter, access) ? &domain_ : nullptr);
        defineExtent(program_, parameter, access.local ? "whole" : "shape");
        break;
      case Role::Iterator:
        arguments_.push_back({iteratorValue(program_, parameter, access, domain_.seenIndex())});
        break;
      case Role::Spec:
        arguments_.push_back({specConstant(program_, parameter, variant_.specs[specs_++])});
        break;
      case Role::Accumulator: arguments_.push_back({fold_->define(parameter)}); break;
      case Role::VariableOutput:
      case Role::Scatter:
        defineAppendOutput(i, access);
        defineExtent(program_, parameter);
        break;
    }
  }

  void defineUnused(const Parameter& parameter) {
    defineAbsent(program_, parameter);
    if (parameter.role != Role::Gather) arguments_.push_back({absentElement(parameter)});
    if (parameter.role == Role::Output) defineDomainGetters(parameter);
  }

  void defineInput(const Parameter& parameter, const StreamAccess& access) {
    const bool isAligned = access.addressing == Addressing::Aligned;
    declareSamplers(program_, parameter,
                    isAligned ? variant_.domainLayered : access.addressing == Addressing::Layered);
    const bool isPlaced = variant_.domainPlaced;
    const std::string_view index = isPlaced ? "within" : "index";
    if (!isAligned || (parameter.usesIndex && !isPlaced))
      defineInputIndex(program_, parameter, access, domain_.index(), index);
    if (isAligned && variant_.domainPacked) {
      fetchLanes(parameter);
    } else {
      const Texel texel = isAligned ? domain_.texel() : inputTexel(program_, parameter, access, index);
      arguments_.push_back({fetch(program_, parameter, texel)});
    }
    if (isPlaced) {
      definePlacedGetters(program_, parameter, domain_.seenIndex());
    } else {
      defineExtent(program_, parameter);
    }
  }

  /// Fetches the four elements of a texel at once.
  void fetchLanes(const Parameter& parameter) {
    const Parameter four = fourOf(parameter);
    const std::string name = fmt::format("sk_in_{}", parameter.symbol);
    program_.statement(
        fmt::format("{} {} = {};", four.element->glsl, name, fetch(program_, four, domain_.texel())));
    arguments_.push_back({name, true});
  }

  /// Whether a gather has the domain's texel layout, so that neighbours are found by texels. Local gathers have whole texels
  /// between the domain's first element and their own.
  bool sharesTexels(const Parameter& gather, const StreamAccess& access) const {
    constexpr int farthest = 4;  // a gather of rank 2 then reaches 27 texels
    const bool isElsewhere = !access.local && (variant_.domainView || variant_.domainPlaced);
    if (gather.reach > farthest || !variant_.domainPacked || !access.packed || !access.nearby ||
        access.view || isElsewhere) {
      return false;
    }
    const bool isRow = variant_.domain == Domain::Linear && variant_.domainRank == 1 && gather.rank == 1;
    return variant_.domain == Domain::Plane ? access.addressing == Addressing::Plane
                                            : isRow && access.addressing != Addressing::Plane;
  }

  void defineAppendOutput(std::size_t i, const StreamAccess& access) {
    const Parameter& appendOutput = kernel_.parameters[i];
    if (isGroups()) return groups_.define(appendOutput, access);
    if (!isList()) return defineCounting(program_, appendOutput);
    i == variant_.task.appendOutput ? defineListed(program_, appendOutput, access)
                                    : defineIgnored(program_, appendOutput);
  }

  void storeAppendOutputs() {
    if (isGroups()) return;  // the body has stored them
    if (isList()) return storeListed(program_, kernel_.parameters[variant_.task.appendOutput]);
    for (const Parameter& parameter : kernel_.parameters) {
      if (isAppendOutput(parameter)) storeCount(program_, parameter);
    }
  }

  void defineOutput(const Parameter& parameter) {
    if (isList() || variant_.task.work == Work::Owners) {  // another pass writes it
      arguments_.push_back({fmt::format("sk_unused_{}", parameter.symbol)});
      program_.statement(fmt::format("{} {};", parameter.element->glsl, arguments_.back().text));
    } else {
      const Parameter& written = variant_.domainPacked ? written_.emplace_back(fourOf(parameter)) : parameter;
      declareOutputs(program_, written);
      results_.push_back({&written, resultVariable(program_, written)});
      arguments_.push_back({results_.back().variable, variant_.domainPacked});
    }
    defineDomainGetters(parameter);
  }

  void defineDomainGetters(const Parameter& parameter) {
    if (parameter.usesIndex) defineGetter(program_, "index", parameter, domain_.seenIndex());
    if (parameter.usesExtent) defineGetter(program_, "extent", parameter, domain_.seenShape());
  }

  const Profile profile_;
  const HeldKernel held_;
  const Kernel& kernel_;
  const Variant& variant_;
  ProgramText program_;
  DomainText domain_;
  GroupText groups_;
  std::optional<GroupFold> fold_;
  std::vector<Value> arguments_;
  std::deque<Parameter> written_;  ///< of packed texels
  std::vector<Result> results_;
  std::size_t specs_ = 0;  ///< number of spec constants declared
};

}  // namespace

Domain domainOf(const RegionLayout& output) {
  if (output.strided) {
    return output.linear ? Domain::StridedLinear : output.numbered ? Domain::StridedRows : Domain::Strided;
  }
  if (!output.linear) return Domain::Plane;
  return output.view ? Domain::LinearBox : Domain::Linear;
}

bool mayPack(const program::Element& held) {
  const program::Field& field = held.fields.front();
  return held.fields.size() == 1 && field.path.empty() && field.width == 1 && !program::is64Bit(field.scalar);
}

namespace {

bool mayRunInSequence(const Kernel& kernel) {
  return !kernel.usesLoops && kernel.weight <= greatestPackedWeight;
}

}  // namespace

bool mayGroupPacked(const Kernel& kernel) {
  return mayRunInSequence(kernel) && std::ranges::none_of(kernel.parameters, [](const Parameter& parameter) {
           return parameter.role == Role::Output;
         });
}

bool mayWritePacked(const Kernel& kernel) {
  return mayRunInSequence(kernel) && std::ranges::all_of(kernel.parameters, [](const Parameter& parameter) {
           return !isAppendOutput(parameter) &&
                  (parameter.role != Role::Output || mayPack(heldBy(parameter)));
         });
}

ProgramPair kernelPrograms(const Profile& profile, const Kernel& kernel, const Variant& variant,
                           const Reduction* reduction) {
  assert(variant.access.size() == kernel.parameters.size());
  KernelText text(profile, kernel, variant, reduction);
  ProgramPair programs{.vertex = {}, .main = text.write()};
  if (profile.stage == Stage::Fragment) programs.vertex = vertexProgram(profile, text.relayed());
  return programs;
}

std::string kernelProgram(const Profile& profile, const Kernel& kernel, const Variant& variant,
                          const Reduction* reduction) {
  return kernelPrograms(profile, kernel, variant, reduction).main;
}

}  // namespace sk::assemble
