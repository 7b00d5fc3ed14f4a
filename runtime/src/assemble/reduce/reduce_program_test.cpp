// SPDX-License-Identifier: MIT
//
// Tests the text of reduction passes. reduce_plan_test tests the order in which they fold.
#include "assemble/reduce/reduce_program.hpp"

#include <array>

#include <catch2/catch.hpp>

#include "assemble/program/sample_kernels.hpp"
#include "assemble/reduce/row_program.hpp"

using namespace sk::assemble;

namespace {

const Profile& glsl = *findProfile("glsl330");

std::string mainOf(const sk::program::Reduction& reduction, const ReduceVariant& variant) {
  const std::string program = reduceProgram(glsl, reduction, variant);
  return program.substr(program.find("void main"));
}

}  // namespace

TEST_CASE("the first pass of a reduction to a value") {
  CHECK(reduceProgram(glsl, samples::sum, {.walk = Walk::Line}) == R"(#version 330 core
// sum for glsl330: elements of a line, one block

uniform sampler2D sk_tex_x;
uniform int sk_domain_shift;
uniform int sk_fan;
uniform int sk_block_length;
uniform int sk_start;
uniform int sk_shift;
layout(location = 0) out float sk_out_total;

// Texel of element number n in a texture of width 1 << s.
ivec2 sk_texel(int sk_n, int sk_s) {
  return ivec2(sk_n & ((1 << sk_s) - 1), sk_n >> sk_s);
}

#line 1 1
void sum(float x, inout float total) {
  total += x;
}
#line 22 0

void main() {
  int sk_first = (int(gl_FragCoord.y) << sk_domain_shift | int(gl_FragCoord.x)) * sk_fan;
  int sk_count = min(sk_fan, sk_block_length - sk_first);
  int sk_at = sk_start + sk_first;
  float sk_total = texelFetch(sk_tex_x, sk_texel(sk_at, sk_shift), 0).x;
  for (int sk_k = 1; sk_k < sk_count; ++sk_k) {
    sum(texelFetch(sk_tex_x, sk_texel(sk_at + sk_k, sk_shift), 0).x, sk_total);
  }
  sk_out_total = sk_total;
}
)");
}

TEST_CASE("a long run is folded part by part, and what is left of it at last") {
  sk::program::Reduction sum = samples::sum;
  sum.seeded = false;
  const ReduceVariant known{.walk = Walk::Rows, .run = 64, .column = true, .part = 8, .packed = true};
  CHECK(mainOf(sum, known) == R"(void main() {
  ivec2 sk_corner = (ivec2(gl_FragCoord.xy) - sk_target.xy) * ivec2(1, 64);
  ivec2 sk_p = sk_origin.xy + sk_corner;
  float sk_total = 0.0;
  vec4 sk_in_x;
  for (int sk_i = 0; sk_i < 8; ++sk_i) {
    float sk_part = 0.0;
    for (int sk_k = 0; sk_k < 8; ++sk_k) {
      sk_in_x = texelFetch(sk_tex_x, sk_p + ivec2(0, sk_k), 0);
      sum(sk_in_x.x, sk_part);
      sum(sk_in_x.y, sk_part);
      sum(sk_in_x.z, sk_part);
      sum(sk_in_x.w, sk_part);
    }
    sum(sk_part, sk_total);
    sk_p.y += 8;
  }
  sk_out_total = sk_total;
}
)");
  const ReduceVariant unknown{.walk = Walk::Rows, .column = true, .part = 8};
  CHECK(mainOf(sum, unknown) == R"(void main() {
  ivec2 sk_corner = (ivec2(gl_FragCoord.xy) - sk_target.xy) * sk_run_shape.xy;
  ivec2 sk_p = sk_origin.xy + sk_corner;
  int sk_left = sk_source.y - sk_corner.y;
  int sk_count = sk_left > sk_run_shape.y ? sk_run_shape.y : sk_left + int(sk_corner.x < sk_source.z);
  float sk_total = 0.0;
  for (; sk_count >= 8; sk_count -= 8) {
    float sk_part = 0.0;
    for (int sk_k = 0; sk_k < 8; ++sk_k) {
      sum(texelFetch(sk_tex_x, sk_p + ivec2(0, sk_k), 0).x, sk_part);
    }
    sum(sk_part, sk_total);
    sk_p.y += 8;
  }
  for (int sk_k = 0; sk_k < sk_count; ++sk_k) {
    sum(texelFetch(sk_tex_x, sk_p + ivec2(0, sk_k), 0).x, sk_total);
  }
  sk_out_total = sk_total;
}
)");
}

TEST_CASE("a plane is walked row by row") {
  CHECK(mainOf(samples::sum, {.walk = Walk::Plane}) == R"(void main() {
  int sk_first = (int(gl_FragCoord.y) << sk_domain_shift | int(gl_FragCoord.x)) * sk_fan;
  int sk_count = min(sk_fan, sk_block_length - sk_first);
  ivec2 sk_corner = sk_origin.xy;
  int sk_y = sk_first / sk_block_shape.x;
  ivec2 sk_p = sk_corner + ivec2(sk_first - sk_y * sk_block_shape.x, sk_y);
  int sk_end = sk_corner.x + sk_block_shape.x;
  float sk_total = texelFetch(sk_tex_x, sk_p, 0).x;
  for (int sk_k = 1; sk_k < sk_count; ++sk_k) {
    ++sk_p.x;
    if (sk_p.x == sk_end) sk_p = ivec2(sk_corner.x, sk_p.y + 1);
    sum(texelFetch(sk_tex_x, sk_p, 0).x, sk_total);
  }
  sk_out_total = sk_total;
}
)");
}

TEST_CASE("small blocks take no division, and a run without a seed starts from the identity") {
  CHECK(
      mainOf(samples::countTrue, {.walk = Walk::Plane, .runs = Runs::WholeBlocks, .domain = Domain::Plane}) ==
      R"(void main() {
  int sk_count = sk_block_length;
  ivec2 sk_corner = sk_origin.xy + sk_result().xy * sk_block_shape.xy;
  ivec2 sk_p = sk_corner;
  int sk_end = sk_corner.x + sk_block_shape.x;
  ivec3 sk_total = ivec3(0);
  for (int sk_k = 0; sk_k < sk_count; ++sk_k) {
    countTrue(notEqual(texelFetch(sk_tex_b, sk_p, 0).xyz, uvec3(0u)), sk_total);
    ++sk_p.x;
    if (sk_p.x == sk_end) sk_p = ivec2(sk_corner.x, sk_p.y + 1);
  }
  sk_out_count = ivec4(sk_total, 0);
}
)");
}

TEST_CASE("later passes combine partial results") {
  CHECK(mainOf(samples::countTrue, {.walk = Walk::Partials, .runs = Runs::Split}) == R"(void main() {
  int sk_number = int(gl_FragCoord.y) << sk_domain_shift | int(gl_FragCoord.x);
  int sk_run = sk_number / sk_blocks;
  int sk_block = sk_number - sk_run * sk_blocks;
  int sk_first = sk_run * sk_fan;
  int sk_count = min(sk_fan, sk_block_length - sk_first);
  int sk_at = sk_first * sk_blocks + sk_block;
  ivec3 sk_total = texelFetch(sk_tex_count_part, sk_texel(sk_at, sk_shift), 0).xyz;
  for (int sk_k = 1; sk_k < sk_count; ++sk_k) {
    addCounts(
        texelFetch(sk_tex_count_part, sk_texel(sk_at + sk_k * sk_blocks, sk_shift), 0).xyz,
        sk_total);
  }
  sk_out_count = ivec4(sk_total, 0);
}
)");
}

TEST_CASE("structs are folded plane by plane") {
  const std::string text = mainOf(samples::firstHit, {.walk = Walk::Partials, .runs = Runs::WholeBlocks});
  CHECK(text == R"(void main() {
  int sk_block = int(gl_FragCoord.y) << sk_domain_shift | int(gl_FragCoord.x);
  int sk_count = sk_block_length;
  Hit sk_total = sk_fetch_h(sk_texel(sk_block, sk_shift));
  for (int sk_k = 1; sk_k < sk_count; ++sk_k) {
    firstHit(sk_fetch_h(sk_texel(sk_block + sk_k * sk_blocks, sk_shift)), sk_total);
  }
  sk_out0_best = sk_total.t;
  sk_out1_best = vec4(sk_total.at.normal, 0.0);
  sk_out2_best = uint(sk_total.at.inside);
  sk_out3_best = sk_total.id;
}
)");
}

TEST_CASE("a box is walked axis by axis") {
  CHECK(mainOf(samples::sum, {.walk = Walk::Box, .runs = Runs::Split, .axes = 3}) == R"(void main() {
  int sk_number = int(gl_FragCoord.y) << sk_domain_shift | int(gl_FragCoord.x);
  int sk_run = sk_number / sk_blocks;
  int sk_block = sk_number - sk_run * sk_blocks;
  int sk_first = sk_run * sk_fan;
  int sk_count = min(sk_fan, sk_block_length - sk_first);
  int sk_at = sk_start + sk_ravel(sk_unravel(sk_block, sk_blocks_step) * sk_block_shape, sk_stride);
  ivec4 sk_p = sk_unravel(sk_first, sk_block_step);
  float sk_total = texelFetch(sk_tex_x, sk_texel(sk_at + sk_ravel(sk_p, sk_stride), sk_shift), 0).x;
  for (int sk_k = 1; sk_k < sk_count; ++sk_k) {
    ++sk_p.x;
    if (sk_p.x == sk_block_shape.x) { sk_p.x = 0; ++sk_p.y; }
    if (sk_p.y == sk_block_shape.y) { sk_p.y = 0; ++sk_p.z; }
    sum(texelFetch(sk_tex_x, sk_texel(sk_at + sk_ravel(sk_p, sk_stride), sk_shift), 0).x, sk_total);
  }
  sk_out_total = sk_total;
}
)");
}

TEST_CASE("elements that lie apart, or are asked for their place, are found by their index") {
  const ReduceVariant variant{
      .walk = Walk::Index,
      .runs = Runs::Split,
      .axes = 2,
      .access = {{}, {Addressing::Plane, true}, {Addressing::Linear}, {Addressing::Plane}, {}, {}}};
  const std::string text = reduceProgram(glsl, samples::weigh, variant);
  CHECK(text.find("ivec4 sk_index_x() {\n  return min(sk_item, sk_shape_x - 1);\n}") != std::string::npos);
  CHECK(text.find("ivec4 sk_extent() {\n  return sk_item_shape;\n}") != std::string::npos);
  CHECK(text.substr(text.find("void main")) == R"(void main() {
  int sk_number = int(gl_FragCoord.y) << sk_domain_shift | int(gl_FragCoord.x);
  int sk_run = sk_number / sk_blocks;
  int sk_block = sk_number - sk_run * sk_blocks;
  int sk_first = sk_run * sk_fan;
  int sk_count = min(sk_fan, sk_block_length - sk_first);
  ivec4 sk_corner = sk_unravel(sk_block, sk_blocks_step) * sk_block_shape;
  ivec4 sk_p = sk_unravel(sk_first, sk_block_step);
  sk_item = sk_corner + sk_p;
  float sk_total_total = 0.0;
  Hit sk_total_best = Hit(1e30, Place(vec3(0.0), false), -1);
  for (int sk_k = 0; sk_k < sk_count; ++sk_k) {
    weigh(
        sk_arg_p,
        texelFetch(sk_tex_x, sk_index_x().xy + sk_origin_x.xy, 0).x,
        texelFetch(sk_tex_y, sk_texel(sk_ravel(sk_index_y(), sk_stride_y), sk_shift_y), 0).xyz,
        sk_total_total,
        sk_total_best);
    ++sk_p.x;
    if (sk_p.x == sk_block_shape.x) { sk_p.x = 0; ++sk_p.y; }
    sk_item = sk_corner + sk_p;
  }
  sk_out_total = sk_total_total;
  sk_out0_best = sk_total_best.t;
  sk_out1_best = vec4(sk_total_best.at.normal, 0.0);
  sk_out2_best = uint(sk_total_best.at.inside);
  sk_out3_best = sk_total_best.id;
}
)");
}

TEST_CASE("a pass may write some planes of all") {
  const std::string text = mainOf(samples::weigh, {.walk = Walk::Partials, .firstPlane = 3, .planeCount = 2});
  CHECK(text.find("weigh(") != std::string::npos);
  CHECK(text.substr(text.find("  sk_out")) == R"(  sk_out2_best = uint(sk_total_best.at.inside);
  sk_out3_best = sk_total_best.id;
}
)");
}

TEST_CASE("where there is no element, the identities are written without the kernel") {
  const std::string text = reduceProgram(glsl, samples::weigh, {.walk = Walk::Nothing, .planeCount = 1});
  CHECK(text.find("weigh(") == std::string::npos);
  CHECK(text.substr(text.find("void main")) == R"(void main() {
  float sk_total_total = 0.0;
  Hit sk_total_best = Hit(1e30, Place(vec3(0.0), false), -1);
  sk_out_total = sk_total_total;
}
)");
}

TEST_CASE("a dispatch leaves a value in a buffer, a plane in 16 bytes") {
  const Profile& compute = *findProfile("glsl430");
  const std::string text =
      reduceProgram(compute, samples::weigh, {.walk = Walk::GroupedPartials, .toBuffer = true});
  CHECK(text.find("image") == std::string::npos);
  CHECK(text.find(R"(layout(std430, binding = 0) writeonly buffer sk_values {
  vec4 sk_value0;
  vec4 sk_value1;
  vec4 sk_value2;
  uvec4 sk_value3;
  ivec4 sk_value4;
};
)") != std::string::npos);
  CHECK(text.substr(text.find("  if (gl_LocalInvocationIndex != 0u)")) ==
        R"(  if (gl_LocalInvocationIndex != 0u) return;
  sk_value0 = vec4(sk_out_total);
  sk_value1 = vec4(sk_out0_best);
  sk_value2 = sk_out1_best;
  sk_value3 = uvec4(sk_out2_best);
  sk_value4 = ivec4(sk_out3_best);
}
)");
}

TEST_CASE("invocations beside the elements fold no part of a run") {
  sk::program::Reduction sum = samples::sum;
  sum.seeded = false;
  ReduceVariant variant{
      .walk = Walk::Rows, .run = 32, .column = true, .part = 8, .grouped = true, .packed = true};
  const auto mainOfGroup = [&] { return reduceProgram(*findProfile("glsl430"), sum, variant); };
  CHECK(mainOfGroup().find("  if (sk_isInside) for (int sk_i = 0; sk_i < 4; ++sk_i) {\n") !=
        std::string::npos);
  variant.run = 0;
  CHECK(mainOfGroup().find("  if (sk_isInside) for (; sk_count >= 8; sk_count -= 8) {\n") !=
        std::string::npos);
}

TEST_CASE("work groups fold rows if all accumulators of a group have room in shared memory") {
  using sk::program::Scalar;
  const auto mayGroup = [](const std::vector<sk::program::Field>& fields, bool isSeeded = false) {
    const sk::program::Element element{"T", "T", 0, fields};
    const std::array parameters{sk::program::Parameter{
        .name = "total", .symbol = "total", .role = sk::program::Role::Accumulator, .element = &element}};
    sk::program::Reduction reduction{};
    reduction.fold.parameters = reduction.combine.parameters = parameters;
    reduction.seeded = isSeeded;
    return mayGroupRows(reduction);
  };
  const sk::program::Field one{"a", Scalar::Float, 1, 0}, three{"a", Scalar::Float, 3, 0},
      four{"a", Scalar::Float, 4, 0}, two{"a", Scalar::Double, 2, 0};
  CHECK(mayGroup({four, four}));
  CHECK(mayGroup({three, four}));   // three take the room of four
  CHECK(mayGroup({two, two}));
  CHECK_FALSE(mayGroup({four, four, one}));
  CHECK_FALSE(mayGroup({three, three, one}));
  CHECK_FALSE(mayGroup({two, two, one}));
  CHECK_FALSE(mayGroup({one}, true));
}
