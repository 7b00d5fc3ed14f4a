// SPDX-License-Identifier: MIT
//
// The program of a kernel for one variant. Sections are filled parameter by parameter; main() is one
// call of the kernel's entry function between fetches and stores.
#include <cassert>

#include <fmt/format.h>

#include "assemble/assemble.hpp"
#include "assemble/domain.hpp"
#include "assemble/gather.hpp"
#include "assemble/planes.hpp"
#include "assemble/program_text.hpp"

namespace sk::assemble {
namespace {

using program::Kernel;
using program::Parameter;
using program::Role;

std::string_view name(Domain domain) {
  switch (domain) {
    case Domain::Plane: return "plane";
    case Domain::Linear: return "linear";
    case Domain::LinearBox: return "linear box";
  }
  return {};
}

std::string_view name(Addressing addressing) {
  switch (addressing) {
    case Addressing::Aligned: return "aligned";
    case Addressing::Plane: return "plane";
    case Addressing::Linear: return "linear";
  }
  return {};
}

/// "diffuse for glsl330: plane domain; u plane view nearby".
std::string describe(const Profile& profile, const Kernel& kernel, const Variant& variant) {
  std::string text = fmt::format("{} for {}: {}{} domain", kernel.name, profile.name, name(variant.domain),
                                 variant.domainView ? " view" : "");
  for (std::size_t i = 0; i < kernel.parameters.size(); ++i) {
    const Parameter& parameter = kernel.parameters[i];
    if (parameter.role != Role::Input && parameter.role != Role::Gather) continue;
    const StreamAccess& access = variant.access[i];
    text += fmt::format("; {} {}{}{}", parameter.name, name(access.addressing), access.view ? " view" : "",
                        access.nearby ? " nearby" : "");
  }
  return text;
}

class KernelText {
 public:
  KernelText(const Kernel& kernel, const Variant& variant)
      : kernel_(kernel),
        variant_(variant),
        domain_(program_, variant.domain, variant.domainView, variant.domainRank) {}

  std::string write(const Profile& profile) {
    if (kernel_.usesLoops) domain_.leaveOutside();
    if (kernel_.usesIndex) domain_.index();
    for (std::size_t i = 0; i < kernel_.parameters.size(); ++i) {
      defineAccess(kernel_.parameters[i], variant_.access[i]);
    }
    program_.statement(call(kernel_.entry, arguments_, "      ") + ";");
    for (const auto& [parameter, variable] : results_) store(program_, *parameter, variable);
    return program_.finish(profile, describe(profile, kernel_, variant_), kernel_);
  }

 private:
  struct Result {
    const Parameter* parameter;
    std::string variable;
  };

  void defineAccess(const Parameter& parameter, const StreamAccess& access) {
    switch (parameter.role) {
      case Role::Uniform: arguments_.push_back(uniform(parameter.element->glsl, "arg", parameter)); break;
      case Role::Input: defineInput(parameter, access); break;
      case Role::Output: defineOutput(parameter); break;
      case Role::Gather:
        defineGather(program_, domain_, parameter, access);
        defineExtent(parameter);
        break;
      case Role::Accumulator: assert(!"a reduction has programs of its own"); break;
      case Role::VariableOutput:
      case Role::Scatter: assert(!"sinks have programs of their own"); break;
    }
  }

  void defineInput(const Parameter& parameter, const StreamAccess& access) {
    declareSamplers(program_, parameter);
    if (parameter.usesIndex || access.addressing != Addressing::Aligned) defineIndex(parameter, access);
    arguments_.push_back(fetch(program_, parameter, texel(parameter, access)));
    defineExtent(parameter);
  }

  void defineOutput(const Parameter& parameter) {
    declareOutputs(program_, parameter);
    results_.push_back({&parameter, resultVariable(program_, parameter)});
    arguments_.push_back(results_.back().variable);
    if (parameter.usesIndex) defineGetter("index", parameter, domain_.index());
    if (parameter.usesExtent) {
      defineGetter("extent", parameter, program_.uniform("ivec4", "sk_domain_shape"));
    }
  }

  /// An input of extent 1 in a dimension repeats its only element there.
  void defineIndex(const Parameter& parameter, const StreamAccess& access) {
    const std::string index = domain_.index();
    const bool mayRepeat = access.addressing != Addressing::Aligned;
    defineGetter(
        "index", parameter,
        mayRepeat ? fmt::format("min({}, {} - 1)", index, uniform("ivec4", "shape", parameter)) : index);
  }

  void defineExtent(const Parameter& parameter) {
    if (parameter.usesExtent) defineGetter("extent", parameter, uniform("ivec4", "shape", parameter));
  }

  std::string texel(const Parameter& parameter, const StreamAccess& access) {
    if (access.addressing == Addressing::Aligned) return "ivec2(gl_FragCoord.xy)";
    const std::string index = fmt::format("sk_index_{}()", parameter.symbol);
    const std::string origin = access.view ? " + " + uniform("ivec4", "origin", parameter) : "";
    if (access.addressing == Addressing::Plane) {
      return access.view ? fmt::format("{}.xy{}.xy", index, origin) : index + ".xy";
    }
    program_.require(Function::Ravel);
    program_.require(Function::Texel);
    const std::string stride = uniform("ivec4", "stride", parameter);
    const std::string shift = uniform("int", "shift", parameter);
    return fmt::format("sk_texel(sk_ravel({}{}, {}), {})", index, origin, stride, shift);
  }

  std::string uniform(std::string_view type, std::string_view kind, const Parameter& parameter) {
    return program_.uniform(type, fmt::format("sk_{}_{}", kind, parameter.symbol));
  }

  /// What the body calls as `sk_index_p` or `sk_extent_p`.
  void defineGetter(std::string_view kind, const Parameter& parameter, std::string_view value) {
    program_.function(fmt::format("ivec4 sk_{}_{}()", kind, parameter.symbol),
                      {fmt::format("return {};", value)});
  }

  const Kernel& kernel_;
  const Variant& variant_;
  ProgramText program_;
  DomainText domain_;
  std::vector<std::string> arguments_;
  std::vector<Result> results_;
};

}  // namespace

Domain domainOf(const Placement& output) {
  if (!output.linear) return Domain::Plane;
  return output.view ? Domain::LinearBox : Domain::Linear;
}

std::string fragmentProgram(const Profile& profile, const Kernel& kernel, const Variant& variant) {
  assert(variant.access.size() == kernel.parameters.size());
  return KernelText(kernel, variant).write(profile);
}

}  // namespace sk::assemble
