// SPDX-License-Identifier: MIT
//
// Which values go through the vertex program, and how the two programs name them.
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "assemble/relayed_values.hpp"
#include "assemble/sample_kernels.hpp"

using namespace sk::assemble;
using namespace sk::program;

namespace {

Profile relaying(std::string_view name) {
  Profile profile = *findProfile(name);
  profile.relaysValues = true;
  return profile;
}

const Variant aligned{.access = {{}, {}, {}, {}}};

std::vector<std::string> namesOf(const std::vector<RelayedValue>& values) {
  std::vector<std::string> names;
  for (const RelayedValue& value : values) names.push_back(value.name);
  return names;
}

constexpr Field anyField[] = {{"", Scalar::Float, 1, 0}};

/// The names of what is relayed of uniform parameters a, b ... of these types.
std::vector<std::string> relayedOf(const std::vector<std::string_view>& types) {
  static constexpr std::string_view symbols = "abcdefghijklmnopqrstuvwxyz";
  std::vector<Element> elements;
  for (const std::string_view type : types) elements.push_back({type, type, 4, anyField});
  std::vector<Parameter> parameters;
  for (std::size_t i = 0; i < types.size(); ++i) {
    const std::string_view symbol = symbols.substr(i, 1);
    parameters.push_back({.name = symbol, .symbol = symbol, .role = Role::Uniform, .element = &elements[i]});
  }
  Kernel kernel;
  kernel.parameters = parameters;
  const Variant variant{.access = std::vector<StreamAccess>(types.size())};
  return namesOf(relayedValues(relaying("glsl330"), kernel, variant));
}

}  // namespace

TEST_CASE("the vertex program hands values on, and the fragment program declares them alike") {
  CHECK(vertexProgram(relaying("glsl330"), samples::saxpy, aligned) == R"(#version 330 core
uniform float sk_arg_a;
flat out float sk_flat_arg_a;
void main() {
  sk_flat_arg_a = sk_arg_a;
  gl_Position = vec4(float(gl_VertexID & 1) * 2.0 - 1.0, float(gl_VertexID & 2) - 1.0, 0.0, 1.0);
}
)");
  const std::string program = kernelProgram(relaying("glsl330"), samples::saxpy, aligned);
  CHECK(program.find("flat in float sk_flat_arg_a;\n") != std::string::npos);
  CHECK(program.find("saxpy(\n      sk_flat_arg_a,\n") != std::string::npos);
  CHECK(program.find("sk_arg_a") == std::string::npos);
}

TEST_CASE("nothing is relayed unless the profile says so") {
  const Profile& plain = *findProfile("glsl330");
  CHECK(relayedValues(plain, samples::saxpy, aligned).empty());
  CHECK(vertexProgram(plain, samples::saxpy, aligned) == vertexProgram(plain));
}

TEST_CASE("origins of views are relayed, too") {
  const Variant views{.domainView = true,
                      .access = {{}, {}, {.addressing = Addressing::Plane, .view = true}, {}}};
  const Profile profile = relaying("essl300");
  CHECK(namesOf(relayedValues(profile, samples::saxpy, views)) ==
        std::vector<std::string>{"sk_arg_a", "sk_domain_origin", "sk_origin_y"});
  const std::string program = kernelProgram(profile, samples::saxpy, views);
  CHECK(program.find("flat in ivec4 sk_flat_origin_y;") != std::string::npos);
  CHECK(program.find("uniform ivec4 sk_origin_y;") == std::string::npos);
}

TEST_CASE("what cannot be handed on stays, and so does what finds no room") {
  CHECK(relayedOf({"bool", "Hit", "float[3]", "sk_double", "ivec3"}) == std::vector<std::string>{"sk_arg_e"});
  // 15 locations are guaranteed: a matrix takes one for each column
  CHECK(relayedOf({"mat4", "mat4", "mat4", "mat4", "mat2", "vec3", "float"}) ==
        std::vector<std::string>{"sk_arg_a", "sk_arg_b", "sk_arg_c", "sk_arg_e", "sk_arg_f"});
}
