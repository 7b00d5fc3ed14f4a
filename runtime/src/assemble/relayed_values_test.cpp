// SPDX-License-Identifier: MIT
//
// Tests which uniforms the vertex program relays, and their names in both programs.
#include <string>
#include <string_view>
#include <vector>

#include <catch2/catch.hpp>

#include "assemble/assemble.hpp"
#include "assemble/program/sample_kernels.hpp"

using namespace sk::assemble;
using namespace sk::program;

namespace {

Profile relaying(std::string_view name) {
  Profile profile = *findProfile(name);
  profile.relaysUniforms = true;
  return profile;
}

const Variant aligned{.access = {{}, {}, {}, {}}};

bool has(const std::string& program, std::string_view text) {
  return program.find(text) != std::string::npos;
}

/// Whether a uniform of each of these types is relayed.
std::vector<bool> taken(const std::vector<std::string_view>& types) {
  RelayedValues values;
  std::vector<bool> all;
  for (const std::string_view type : types) {
    all.push_back(values.take(type, "sk_arg_" + std::to_string(all.size())));
  }
  return all;
}

}  // namespace

TEST_CASE("the vertex program hands uniforms on, and the fragment program declares them alike") {
  const auto [vertex, main] = kernelPrograms(relaying("glsl330"), samples::saxpy, aligned);
  CHECK(vertex == R"(#version 330 core
uniform float sk_arg_a;
flat out float sk_flat_arg_a;
void main() {
  sk_flat_arg_a = sk_arg_a;
  gl_Position = vec4(float(gl_VertexID & 1) * 2.0 - 1.0, float(gl_VertexID & 2) - 1.0, 0.0, 1.0);
}
)");
  CHECK(has(main, "flat in float sk_flat_arg_a;\n"));
  CHECK(has(main, "saxpy(\n      sk_flat_arg_a,\n"));
  CHECK_FALSE(has(main, "sk_arg_a"));
}

TEST_CASE("nothing is relayed unless the profile says so, nor to compute programs") {
  const Profile& plain = *findProfile("glsl330");
  CHECK(kernelPrograms(plain, samples::saxpy, aligned).vertex == vertexProgram(plain));
  CHECK(kernelPrograms(*findProfile("glsl430"), samples::saxpy, aligned).vertex.empty());
}

TEST_CASE("shapes and the origins of views are relayed, too") {
  const Variant view{.access = {{}, {.addressing = Addressing::Plane, .view = true}, {}}};
  const auto [vertex, main] = kernelPrograms(relaying("essl300"), samples::diffuse, view);
  for (const std::string uniform : {"float sk_arg_k", "ivec4 sk_shape_u", "ivec4 sk_origin_u"}) {
    CHECK(has(vertex, "uniform " + uniform + ";\n"));
    CHECK_FALSE(has(main, "uniform " + uniform));
  }
}

TEST_CASE("what cannot be handed on stays, and so does what finds no room") {
  CHECK(taken({"bool", "Hit", "float[3]", "sk_double", "sampler2D", "ivec3"}) ==
        std::vector<bool>{false, false, false, false, false, true});
  // 15 locations are guaranteed; a matrix takes one per column
  CHECK(taken({"mat4", "mat4", "mat4", "mat4", "mat2", "vec3", "float"}) ==
        std::vector<bool>{true, true, true, false, true, true, false});
}

TEST_CASE("a uniform takes its room once") {
  RelayedValues values;
  for (int i = 0; i < 20; ++i) CHECK(values.take("mat3", "sk_arg_m"));
  CHECK(values.all().size() == 1);
}
