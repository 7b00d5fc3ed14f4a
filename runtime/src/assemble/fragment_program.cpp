// SPDX-License-Identifier: MIT
//
// The program of a kernel for one variant. Sections are filled parameter by parameter; main() is one
// call of the kernel's entry function between fetches and stores.
#include <array>
#include <cassert>

#include <fmt/format.h>

#include "assemble/assemble.hpp"
#include "assemble/domain.hpp"
#include "assemble/gather.hpp"
#include "assemble/planes.hpp"
#include "assemble/program_text.hpp"
#include "assemble/sinks.hpp"

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
    case Domain::Entry: return "list";
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
    const bool isRead = parameter.role == Role::Input || parameter.role == Role::Gather;
    if (!isNeeded(parameter, variant.specs)) {
      text += fmt::format("; no {}", parameter.name);
      continue;
    }
    if (!isRead) continue;
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
    if (isList()) findEntry(program_, kernel_.parameters[variant_.task.sink]);
    if (kernel_.usesLoops) domain_.leaveOutside();
    if (kernel_.usesIndex) domain_.index();
    if (kernel_.usesExtent) {
      program_.function("ivec4 sk_extent()",
                        {fmt::format("return {};", program_.uniform("ivec4", "sk_domain_shape"))});
    }
    for (std::size_t i = 0; i < kernel_.parameters.size(); ++i) {
      if (isNeeded(kernel_.parameters[i], variant_.specs)) {
        defineAccess(i, variant_.access[i]);
      } else {
        defineAbsent(kernel_.parameters[i]);
      }
    }
    program_.statement(call(kernel_.entry, arguments_, "      ") + ";");
    for (const auto& [parameter, variable] : results_) store(program_, *parameter, variable);
    storeSinks();
    return program_.finish(profile, describe(profile, kernel_, variant_), kernel_);
  }

 private:
  struct Result {
    const Parameter* parameter;
    std::string variable;
  };

  bool isList() const { return variant_.task.work == Work::List; }

  void defineAccess(std::size_t i, const StreamAccess& access) {
    const Parameter& parameter = kernel_.parameters[i];
    switch (parameter.role) {
      case Role::Uniform: arguments_.push_back(uniform(parameter.element->glsl, "arg", parameter)); break;
      case Role::Input: defineInput(parameter, access); break;
      case Role::Output: defineOutput(parameter); break;
      case Role::Gather:
        defineGather(program_, domain_, parameter, access);
        defineExtent(parameter);
        break;
      case Role::Iterator: arguments_.push_back(iteratorValue(parameter, access)); break;
      case Role::Spec: arguments_.push_back(specConstant(parameter)); break;
      case Role::Accumulator: assert(!"a reduction has programs of its own"); break;
      case Role::VariableOutput:
      case Role::Scatter:
        defineSink(i, access);
        defineExtent(parameter);
        break;
    }
  }

  /// A stream that the body names only where the values of spec parameters never let it come.
  void defineAbsent(const Parameter& parameter) {
    const std::string_view type = parameter.element->glsl;
    const std::string none = fmt::format("sk_none_{}", parameter.symbol);
    if (parameter.role == Role::Gather) {
      const std::string vector = parameter.rank == 1 ? "int" : fmt::format("ivec{}", parameter.rank);
      const std::vector<std::string> nothing = {fmt::format("{} {};", type, none),
                                                fmt::format("return {};", none)};
      if (parameter.usesAt) {
        program_.function(fmt::format("{} sk_at_{}({} sk_i)", type, parameter.symbol, vector), nothing);
      }
      if (parameter.usesNear) {
        program_.function(fmt::format("{} sk_near_{}({} sk_d)", type, parameter.symbol, vector), nothing);
      }
    } else {
      program_.statement(fmt::format("{} {};", type, none));
      arguments_.push_back(none);
    }
    if (parameter.role != Role::Output) {
      if (parameter.usesIndex) defineGetter("index", parameter, "ivec4(0)");
      if (parameter.usesExtent) defineGetter("extent", parameter, "ivec4(0)");
    } else {
      defineDomainGetters(parameter);
    }
  }

  /// A multiplication and an addition; integers wrap.
  std::string iteratorValue(const Parameter& parameter, const StreamAccess& access) {
    static constexpr std::array<std::string_view, 4> swizzles = {".x", ".xy", ".xyz", ""};
    const std::string_view type = parameter.element->glsl;
    std::string position = domain_.index();
    if (access.addressing == Addressing::Linear) {
      program_.require(Function::Ravel);
      position = fmt::format("sk_ravel({}, {})", position, uniform("ivec4", "stride", parameter));
    } else {
      position += swizzles[parameter.element->fields.front().width - 1u];
    }
    return fmt::format("{} + {}({}) * {}", uniform(type, "begin", parameter), type, position,
                       uniform(type, "step", parameter));
  }

  std::string specConstant(const Parameter& parameter) {
    const std::string name = fmt::format("sk_spec_{}", parameter.symbol);
    const program::Scalar scalar = parameter.element->fields.front().scalar;
    program_.variable(fmt::format("const {}", parameter.element->glsl),
                      fmt::format("{} = {}", name, glslLiteral(scalar, variant_.specs[specs_++])));
    return name;
  }

  void defineInput(const Parameter& parameter, const StreamAccess& access) {
    declareSamplers(program_, parameter);
    if (parameter.usesIndex || access.addressing != Addressing::Aligned) defineIndex(parameter, access);
    arguments_.push_back(fetch(program_, parameter, texel(parameter, access)));
    defineExtent(parameter);
  }

  void defineSink(std::size_t i, const StreamAccess& access) {
    const Parameter& sink = kernel_.parameters[i];
    if (!isList()) return defineCounting(program_, sink);
    i == variant_.task.sink ? defineListed(program_, sink, access) : defineIgnored(program_, sink);
  }

  void storeSinks() {
    if (isList()) return storeListed(program_, kernel_.parameters[variant_.task.sink]);
    for (const Parameter& parameter : kernel_.parameters) {
      if (isSink(parameter)) storeCount(program_, parameter);
    }
  }

  void defineOutput(const Parameter& parameter) {
    if (isList()) {   // written by another pass
      arguments_.push_back(fmt::format("sk_unused_{}", parameter.symbol));
      program_.statement(fmt::format("{} {};", parameter.element->glsl, arguments_.back()));
    } else {
      declareOutputs(program_, parameter);
      results_.push_back({&parameter, resultVariable(program_, parameter)});
      arguments_.push_back(results_.back().variable);
    }
    defineDomainGetters(parameter);
  }

  void defineDomainGetters(const Parameter& parameter) {
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
  std::size_t specs_ = 0;   ///< whose constants are declared
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
