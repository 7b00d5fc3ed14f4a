// SPDX-License-Identifier: MIT
#include "assemble/relayed_values.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

namespace sk::assemble {
namespace {

using program::Parameter;
using program::Role;

/// OpenGL 3.3 and OpenGL ES 3.0 guarantee 60 components, and a location has four.
constexpr int mostLocations = 15;

/// That a value of this type takes; 0 where it cannot be handed on.
int locationsOf(std::string_view type) {
  static constexpr std::array<std::string_view, 12> vectors = {
      "float", "vec2", "vec3", "vec4", "int", "ivec2", "ivec3", "ivec4", "uint", "uvec2", "uvec3", "uvec4"};
  static constexpr std::array<std::string_view, 3> matrices = {"mat2", "mat3", "mat4"};
  if (std::ranges::find(vectors, type) != vectors.end()) return 1;
  return std::ranges::find(matrices, type) != matrices.end() ? type.back() - '0' : 0;
}

class Relay {
 public:
  void add(std::string_view type, std::string_view kind, std::string_view symbol) {
    const int locations = locationsOf(type);
    if (locations == 0 || used_ + locations > mostLocations) return;
    used_ += locations;
    values_.push_back({type, fmt::format("sk_{}_{}", kind, symbol)});
  }
  std::vector<RelayedValue> take() { return std::move(values_); }

 private:
  int used_ = 0;
  std::vector<RelayedValue> values_;
};

}  // namespace

std::vector<RelayedValue> relayedValues(const Profile& profile, const program::Kernel& kernel,
                                        const Variant& variant) {
  if (!profile.relaysValues) return {};
  Relay relay;
  for (const Parameter& parameter : kernel.parameters) {
    if (parameter.role == Role::Uniform) relay.add(parameter.element->glsl, "arg", parameter.symbol);
    if (parameter.role == Role::Iterator) {
      relay.add(parameter.element->glsl, "begin", parameter.symbol);
      relay.add(parameter.element->glsl, "step", parameter.symbol);
    }
  }
  if (variant.domainView || variant.domain == Domain::LinearBox) relay.add("ivec4", "domain", "origin");
  for (std::size_t i = 0; i < kernel.parameters.size(); ++i) {
    const Parameter& parameter = kernel.parameters[i];
    const bool isRead = parameter.role == Role::Input || parameter.role == Role::Gather;
    if (isRead && variant.access[i].view) relay.add("ivec4", "origin", parameter.symbol);
  }
  return relay.take();
}

std::string relayedName(std::string_view uniform) {
  constexpr std::string_view prefix = "sk_";
  return fmt::format("sk_flat_{}", uniform.substr(prefix.size()));
}

}  // namespace sk::assemble
