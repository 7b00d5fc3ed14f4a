// SPDX-License-Identifier: MIT
//
// Implements the sample descriptors.
#include "assemble/program/sample_kernels.hpp"

#include <array>

#include <fmt/format.h>

namespace sk::assemble::samples {

using namespace program;

namespace {

constexpr Field floatFields[] = {{"", Scalar::Float, 1, 0}};
constexpr Field float3Fields[] = {{"", Scalar::Float, 3, 0}};
constexpr Field intFields[] = {{"", Scalar::Int, 1, 0}};
constexpr Field int3Fields[] = {{"", Scalar::Int, 3, 0}};
constexpr Field uint2Fields[] = {{"", Scalar::Uint, 2, 0}};
constexpr Field boolFields[] = {{"", Scalar::Bool, 1, 0}};
constexpr Field bool3Fields[] = {{"", Scalar::Bool, 3, 0}};
constexpr Field hitFields[] = {{"t", Scalar::Float, 1, 0},
                               {"at.normal", Scalar::Float, 3, 4},
                               {"at.inside", Scalar::Bool, 1, 16},
                               {"id", Scalar::Int, 1, 20}};

constexpr std::string_view hitDeclarations = R"(#line 1 1
struct Place {
  vec3 normal;
  bool inside;
};
#line 5 1
struct Hit {
  float t;
  Place at;
  int id;
};
)";

}  // namespace

constexpr Element floatElement{"float", "float", 4, floatFields};
constexpr Element float3Element{"float3", "vec3", 12, float3Fields};
constexpr Element intElement{"int", "int", 4, intFields};
constexpr Element int3Element{"int3", "ivec3", 12, int3Fields};
constexpr Element uint2Element{"uint2", "uvec2", 8, uint2Fields};
constexpr Element boolElement{"bool", "bool", 1, boolFields};
constexpr Element bool3Element{"bool3", "bvec3", 3, bool3Fields};
constexpr Element hitElement{"Hit", "Hit", 24, hitFields};

namespace {

constexpr std::string_view sources[] = {"sample.sk"};

constexpr Parameter saxpyParameters[] = {
    {.name = "a", .symbol = "a", .role = Role::Uniform, .element = &floatElement},
    {.name = "x", .symbol = "x", .role = Role::Input, .element = &floatElement},
    {.name = "y", .symbol = "y", .role = Role::Input, .element = &floatElement},
    {.name = "r", .symbol = "r", .role = Role::Output, .element = &floatElement},
};

constexpr Parameter keepPositiveParameters[] = {
    {.name = "x", .symbol = "x", .role = Role::Input, .element = &floatElement},
    {.name = "r", .symbol = "r", .role = Role::VariableOutput, .element = &floatElement, .pushes = 1},
};

constexpr Parameter diffuseParameters[] = {
    {.name = "k", .symbol = "k", .role = Role::Uniform, .element = &floatElement},
    {.name = "u",
     .symbol = "u",
     .role = Role::Gather,
     .element = &floatElement,
     .rank = 2,
     .usesNear = true,
     .reach = 1},
    {.name = "v", .symbol = "v", .role = Role::Output, .element = &floatElement},
};

constexpr Parameter sumParameters[] = {
    {.name = "x", .symbol = "x", .role = Role::Input, .element = &floatElement},
    {.name = "total",
     .symbol = "total",
     .role = Role::Accumulator,
     .element = &floatElement,
     .identity = "0.0"},
};

constexpr Parameter firstHitParameters[] = {
    {.name = "h", .symbol = "h", .role = Role::Input, .element = &hitElement},
    {.name = "best", .symbol = "best", .role = Role::Accumulator, .element = &hitElement},
};

constexpr Parameter addCountsParameters[] = {
    {.name = "count_part", .symbol = "count_part", .role = Role::Input, .element = &int3Element},
    {.name = "count", .symbol = "count", .role = Role::Accumulator, .element = &int3Element},
};

constexpr Parameter weighTotal{.name = "total",
                               .symbol = "total",
                               .role = Role::Accumulator,
                               .element = &floatElement,
                               .identity = "0.0"};
constexpr Parameter weighBest{.name = "best",
                              .symbol = "best",
                              .role = Role::Accumulator,
                              .element = &hitElement,
                              .identity = "Hit(1e30, Place(vec3(0.0), false), -1)"};

constexpr Parameter weighParameters[] = {
    {.name = "p", .symbol = "p", .role = Role::Uniform, .element = &floatElement},
    {.name = "x", .symbol = "x", .role = Role::Input, .element = &floatElement, .usesIndex = true},
    {.name = "y", .symbol = "y", .role = Role::Input, .element = &float3Element, .usesExtent = true},
    {.name = "w",
     .symbol = "w",
     .role = Role::Gather,
     .element = &floatElement,
     .rank = 1,
     .usesAt = true,
     .usesNear = true,
     .reach = 1},
    weighTotal,
    weighBest,
};

constexpr Parameter weighTwoParameters[] = {
    {.name = "total_part", .symbol = "total_part", .role = Role::Input, .element = &floatElement},
    {.name = "best_part", .symbol = "best_part", .role = Role::Input, .element = &hitElement},
    {.name = "p", .symbol = "p", .role = Role::Uniform, .element = &floatElement},
    weighTotal,
    weighBest,
};

constexpr Parameter countTrueParameters[] = {
    {.name = "b", .symbol = "b", .role = Role::Input, .element = &bool3Element},
    {.name = "count",
     .symbol = "count",
     .role = Role::Accumulator,
     .element = &int3Element,
     .identity = "ivec3(0)"},
};

}  // namespace

constexpr Kernel saxpy{.name = "saxpy",
                       .entry = "saxpy",
                       .declarations = {},
                       .body = R"(#line 3 1
void saxpy(float a, float x, float y, out float r) {
  r = a * x + y;
}
)",
                       .parameters = saxpyParameters,
                       .sources = sources};

constexpr Kernel keepPositive{.name = "keepPositive",
                              .entry = "keepPositive",
                              .declarations = {},
                              .body = R"(#line 3 1
void keepPositive(float x) {
  if (x > 0.0) sk_push_r(x);
}
)",
                              .parameters = keepPositiveParameters,
                              .sources = sources};

constexpr Kernel diffuse{.name = "heat::diffuse",
                         .entry = "heat_diffuse",
                         .declarations = {},
                         .body = R"(#line 7 1
void heat_diffuse(float k, out float v) {
  v = (1.0 - 4.0 * k) * sk_near_u(ivec2(0, 0)) + k * (sk_near_u(ivec2(1, 0)) + sk_near_u(ivec2(-1, 0)) +
      sk_near_u(ivec2(0, 1)) + sk_near_u(ivec2(0, -1)));
}
)",
                         .parameters = diffuseParameters,
                         .sources = sources};

namespace {

constexpr Kernel sumKernel{.name = "sum",
                           .entry = "sum",
                           .declarations = {},
                           .body = R"(#line 1 1
void sum(float x, inout float total) {
  total += x;
}
)",
                           .parameters = sumParameters,
                           .sources = sources};

constexpr Kernel firstHitKernel{.name = "firstHit",
                                .entry = "firstHit",
                                .declarations = hitDeclarations,
                                .body = R"(#line 11 1
void firstHit(Hit h, inout Hit best) {
  if (h.t < best.t) best = h;
}
)",
                                .parameters = firstHitParameters,
                                .sources = sources};

constexpr Kernel countTrueKernel{.name = "countTrue",
                                 .entry = "countTrue",
                                 .declarations = {},
                                 .body = R"(#line 1 1
void countTrue(bvec3 b, inout ivec3 count) {
  count += ivec3(b);
}
)",
                                 .parameters = countTrueParameters,
                                 .sources = sources};

constexpr Kernel addCountsKernel{.name = "addCounts",
                                 .entry = "addCounts",
                                 .declarations = {},
                                 .body = R"(#line 4 1
void addCounts(ivec3 count_part, inout ivec3 count) {
  count += count_part;
}
)",
                                 .parameters = addCountsParameters,
                                 .sources = sources};

constexpr Kernel weighKernel{.name = "weigh",
                             .entry = "weigh",
                             .declarations = hitDeclarations,
                             .body = R"(#line 1 1
void weigh(float p, float x, vec3 y, inout float total, inout Hit best) {
  total += p * x * sk_at_w(sk_index_x().x) * sk_near_w(1);
  if (y.x < best.t) best = Hit(y.x, Place(y, true), sk_extent().x - sk_extent_y().x);
}
)",
                             .parameters = weighParameters,
                             .sources = sources,
                             .usesExtent = true};

constexpr Kernel weighTwoKernel{.name = "weigh",
                                .entry = "weigh",
                                .declarations = hitDeclarations,
                                .body = R"(#line 7 1
void weigh(float total_part, Hit best_part, float p, inout float total, inout Hit best) {
  total += total_part;
  if (best_part.t < p * best.t) best = best_part;
}
)",
                                .parameters = weighTwoParameters,
                                .sources = sources};

constexpr std::uint8_t weighOperands[] = {0, 0, 0, 0, 0};

}  // namespace

constexpr Reduction sum{.fold = sumKernel, .combine = sumKernel, .combineOperands = {}, .seeded = true};
constexpr Reduction firstHit{
    .fold = firstHitKernel, .combine = firstHitKernel, .combineOperands = {}, .seeded = true};
constexpr Reduction countTrue{
    .fold = countTrueKernel, .combine = addCountsKernel, .combineOperands = {}, .seeded = false};
constexpr Reduction weigh{
    .fold = weighKernel, .combine = weighTwoKernel, .combineOperands = weighOperands, .seeded = false};

EveryAccess::EveryAccess(const Element& element, std::string_view border, int rank, Boundary boundary,
                         int reach)
    : parameters_{
          {.name = "c", .symbol = "c", .role = Role::Uniform, .element = &element},
          {.name = "x",
           .symbol = "x",
           .role = Role::Input,
           .element = &element,
           .usesIndex = true,
           .usesExtent = true},
          {.name = "a",
           .symbol = "a",
           .role = Role::Gather,
           .element = &element,
           .rank = static_cast<std::uint8_t>(rank),
           .boundary = boundary,
           .border = boundary == Boundary::Border ? border : std::string_view(),
           .usesExtent = true,
           .usesAt = true,
           .usesNear = true,
           .reach = reach},
          {.name = "r",
           .symbol = "r",
           .role = Role::Output,
           .element = &element,
           .usesIndex = true,
           .usesExtent = true},
          {.name = "s", .symbol = "s", .role = Role::Output, .element = &intElement},
      } {
  const std::string vector = rank == 1 ? "int" : fmt::format("ivec{}", rank);
  body_ = fmt::format(R"(#line 20 1
void every({0} c, {0} x, out {0} r, out int s) {{
  ivec4 i = sk_index_x() + sk_extent_x() + sk_extent_a() + sk_index_r() + sk_extent_r() + sk_index();
  s = i.x + i.y + i.z + i.w;
  r = s > 100 ? c : s > 50 ? x : s > 30 ? sk_at_a({1}(s)) : sk_near_a({1}(1));
}}
)",
                      element.glsl, vector);
  kernel_ = {.name = "every",
             .entry = "every",
             .declarations = &element == &hitElement ? hitDeclarations : std::string_view(),
             .body = body_,
             .parameters = parameters_,
             .sources = sources,
             .usesIndex = true};
}

}  // namespace sk::assemble::samples
