// SPDX-License-Identifier: MIT
//
// Tests the exact text of typical programs, which should be what an expert would write by hand.
#include <cstdint>
#include <string>
#include <string_view>

#include <catch2/catch.hpp>

#include "assemble/assemble.hpp"
#include "assemble/program/sample_kernels.hpp"

using namespace sk::assemble;
using namespace sk::program;

namespace {

const Profile& glsl = *findProfile("glsl330");
const Profile& es = *findProfile("essl300");

/// The text from `begin` to `end`, inclusive.
std::string part(const std::string& program, std::string_view begin, std::string_view end) {
  const std::size_t first = program.find(begin);
  REQUIRE(first != std::string::npos);
  const std::size_t last = program.find(end, first);
  REQUIRE(last != std::string::npos);
  return program.substr(first, last + end.size() - first);
}

/// The definition of the function that begins with `begin`.
std::string definition(const std::string& program, std::string_view begin) {
  return part(program, begin, "\n}\n");
}

/// sk_at_a and sk_near_a of a gather.
struct Accessors {
  Accessors(Boundary boundary, int rank, int reach, const Variant& variant) {
    const samples::EveryAccess sample(samples::floatElement, "-1.0", rank, boundary, reach);
    const std::string program = kernelProgram(glsl, sample.kernel(), variant);
    at = definition(program, "float sk_at_a");
    near = definition(program, "float sk_near_a");
  }
  std::string at, near;
};

Variant planeVariant(StreamAccess gather) { return {.access = {{}, {}, gather, {}, {}}}; }

}  // namespace

TEST_CASE("an element-wise kernel over planes has no address arithmetic") {
  CHECK(kernelProgram(glsl, samples::saxpy, {.access = {{}, {}, {}, {}}}) == R"(#version 330 core
// saxpy for glsl330: plane domain; x aligned; y aligned

uniform float sk_arg_a;
uniform sampler2D sk_tex_x;
uniform sampler2D sk_tex_y;
layout(location = 0) out float sk_out_r;

#line 3 1
void saxpy(float a, float x, float y, out float r) {
  r = a * x + y;
}
#line 14 0

void main() {
  saxpy(
      sk_arg_a,
      texelFetch(sk_tex_x, ivec2(gl_FragCoord.xy), 0).x,
      texelFetch(sk_tex_y, ivec2(gl_FragCoord.xy), 0).x,
      sk_out_r);
}
)");
}

TEST_CASE("texels are sampled where that is faster, but for layers and filtered gathers") {
  Profile sampling = glsl;
  sampling.samples = true;
  const std::string plane = kernelProgram(sampling, samples::saxpy, {.access = {{}, {}, {}, {}}});
  CHECK(plane.find("sk_sampled(sk_tex_x, ivec2(gl_FragCoord.xy)).x") != std::string::npos);
  CHECK(plane.find("texelFetch") == std::string::npos);
  const std::string layers =
      kernelProgram(sampling, samples::saxpy,
                    {.domain = Domain::Linear, .domainLayered = true, .access = {{}, {}, {}, {}}});
  CHECK(layers.find("texelFetch(sk_tex_x, sk_layered(") != std::string::npos);
  CHECK(layers.find("sk_sampled") == std::string::npos);
  const samples::EveryAccess gathers(samples::floatElement, "-1.0", 2, Boundary::Clamp, 1);
  const auto at = [&](const StreamAccess& access) {
    const Variant variant = planeVariant(access);
    return definition(kernelProgram(sampling, gathers.kernel(), variant), "float sk_at_a");
  };
  CHECK(at({Addressing::Plane}).find("sk_sampled(") != std::string::npos);
  CHECK(at({.addressing = Addressing::Plane, .filtered = true}).find("texelFetch(") != std::string::npos);
}

TEST_CASE("high products are not left to a device that cannot take them") {
  sk::program::Kernel kernel = samples::saxpy;
  kernel.body =
      "void saxpy(float a, float x, float y, out float r) {\n  r = float(sk_mulhi(1u, uint(x)));\n}\n";
  Profile software = glsl;
  const auto isMarked = [&](const sk::program::Kernel& one) {
    return kernelProgram(software, one, {.access = {{}, {}, {}, {}}})
               .find("#define SK_WITHOUT_HIGH_PRODUCTS\n") != std::string::npos;
  };
  CHECK_FALSE(isMarked(kernel));
  software.highProducts = false;
  CHECK(isMarked(kernel));
  CHECK_FALSE(isMarked(samples::saxpy));
}

TEST_CASE("samplers filter clamped and repeated gathers of floats with one or two dimensions") {
  const auto may = [](const Element& element, int rank, Boundary boundary, bool isAllowed = true) {
    return mayFilter({.name = "a",
                      .symbol = "a",
                      .role = Role::Gather,
                      .element = &element,
                      .rank = static_cast<std::uint8_t>(rank),
                      .boundary = boundary,
                      .usesSample = true,
                      .filter = isAllowed});
  };
  for (const int rank : {1, 2}) {
    CHECK(may(samples::floatElement, rank, Boundary::Clamp));
    CHECK(may(samples::float3Element, rank, Boundary::Wrap));
    CHECK_FALSE(may(samples::floatElement, rank, Boundary::Border));
    CHECK_FALSE(may(samples::intElement, rank, Boundary::Clamp));
    CHECK_FALSE(may(samples::floatElement, rank, Boundary::Clamp, false));
  }
  CHECK_FALSE(may(samples::floatElement, 3, Boundary::Clamp));
}

TEST_CASE("a linearised element-wise kernel has none either") {
  const std::string plane = kernelProgram(glsl, samples::saxpy, {.access = {{}, {}, {}, {}}});
  const std::string linear =
      kernelProgram(glsl, samples::saxpy, {.domain = Domain::Linear, .access = {{}, {}, {}, {}}});
  CHECK(part(plane, "\nuniform", "main() {") == part(linear, "\nuniform", "main() {"));
}

TEST_CASE("a stencil clamps its neighbours") {
  CHECK(kernelProgram(es, samples::diffuse, {.access = {{}, {Addressing::Plane}, {}}}) == R"(#version 300 es
// heat::diffuse for essl300: plane domain; u plane
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp isampler2D;
precision highp usampler2D;

uniform float sk_arg_k;
uniform sampler2D sk_tex_u;
uniform ivec4 sk_shape_u;
layout(location = 0) out float sk_out_v;

float sk_near_u(ivec2 sk_d) {
  ivec2 sk_p = clamp(ivec2(gl_FragCoord.xy) + sk_d, ivec2(0), sk_shape_u.xy - 1);
  return texelFetch(sk_tex_u, sk_p, 0).x;
}

#line 7 1
void heat_diffuse(float k, out float v) {
  v = (1.0 - 4.0 * k) * sk_near_u(ivec2(0, 0)) + k * (sk_near_u(ivec2(1, 0)) + sk_near_u(ivec2(-1, 0)) +
      sk_near_u(ivec2(0, 1)) + sk_near_u(ivec2(0, -1)));
}
#line 25 0

void main() {
  heat_diffuse(sk_arg_k, sk_out_v);
}
)");
}

TEST_CASE("a box of a linearised stream discards before it fetches") {
  const Variant variant{
      .domain = Domain::LinearBox, .domainRank = 2, .access = {{}, {Addressing::Linear, true}, {}}};
  const std::string program = kernelProgram(glsl, samples::diffuse, variant);
  CHECK(definition(program, "float sk_near_u") == R"(float sk_near_u(ivec2 sk_d) {
  ivec2 sk_p = clamp(sk_index().xy + sk_d, ivec2(0), sk_shape_u.xy - 1);
  sk_p += sk_origin_u.xy;
  return texelFetch(sk_tex_u, sk_texel(sk_p.x + sk_p.y * sk_stride_u.y, sk_shift_u), 0).x;
}
)");
  CHECK(definition(program, "void main") == R"(void main() {
  int sk_element = int(gl_FragCoord.y) << sk_domain_shift | int(gl_FragCoord.x);
  sk_here = sk_unravel(sk_element, sk_domain_stride) - sk_domain_origin;
  if (any(greaterThanEqual(uvec4(sk_here), uvec4(sk_domain_shape)))) discard;
  heat_diffuse(sk_arg_k, sk_out_v);
}
)");
}

TEST_CASE("structs are rebuilt from their planes and stored to them") {
  const samples::EveryAccess sample(samples::hitElement, "", 1, Boundary::Clamp, 1);
  const std::string program = kernelProgram(glsl, sample.kernel(), planeVariant({Addressing::Plane}));
  CHECK(definition(program, "Hit sk_fetch_a") == R"(Hit sk_fetch_a(ivec2 sk_t) {
  Hit sk_e;
  sk_e.t = texelFetch(sk_tex0_a, sk_t, 0).x;
  sk_e.at.normal = texelFetch(sk_tex1_a, sk_t, 0).xyz;
  sk_e.at.inside = texelFetch(sk_tex2_a, sk_t, 0).x != 0u;
  sk_e.id = texelFetch(sk_tex3_a, sk_t, 0).x;
  return sk_e;
}
)");
  CHECK(part(program, "layout(location = 0)", "sk_out_s;\n") == R"(layout(location = 0) out float sk_out0_r;
layout(location = 1) out vec4 sk_out1_r;
layout(location = 2) out uint sk_out2_r;
layout(location = 3) out int sk_out3_r;
layout(location = 4) out int sk_out_s;
)");
  CHECK(definition(program, "void main") == R"(void main() {
  Hit sk_value_r;
  every(sk_arg_c, sk_fetch_x(ivec2(gl_FragCoord.xy)), sk_value_r, sk_out_s);
  sk_out0_r = sk_value_r.t;
  sk_out1_r = vec4(sk_value_r.at.normal, 0.0);
  sk_out2_r = uint(sk_value_r.at.inside);
  sk_out3_r = sk_value_r.id;
}
)");
}

TEST_CASE("declarations come before what speaks of them, and lines are numbered from the program's begin") {
  const samples::EveryAccess sample(samples::hitElement, "", 1, Boundary::Clamp, 1);
  const std::string program = kernelProgram(glsl, sample.kernel(), planeVariant({Addressing::Plane}));
  CHECK(program.find("struct Hit") < program.find("uniform Hit sk_arg_c;"));
  std::size_t restored = 0;
  int number = 0;
  std::string_view rest = program;
  while (!rest.empty()) {
    ++number;
    const std::string line(rest.substr(0, rest.find('\n')));
    rest.remove_prefix(line.size() + 1);
    if (!line.starts_with("#line ") || !line.ends_with(" 0")) continue;
    ++restored;
    CHECK(line == "#line " + std::to_string(number + 1) + " 0");
  }
  CHECK(restored == 2);
}

TEST_CASE("bools and vectors of 3 are converted at the borders") {
  const samples::EveryAccess flags(samples::bool3Element, "", 1, Boundary::Clamp, 1);
  const std::string program = kernelProgram(glsl, flags.kernel(), planeVariant({Addressing::Plane}));
  CHECK(program.find("uniform usampler2D sk_tex_x;") != std::string::npos);
  CHECK(definition(program, "void main") == R"(void main() {
  bvec3 sk_value_r;
  every(
      sk_arg_c,
      notEqual(texelFetch(sk_tex_x, ivec2(gl_FragCoord.xy), 0).xyz, uvec3(0u)),
      sk_value_r,
      sk_out_s);
  sk_out_r = uvec4(uvec3(sk_value_r), 0u);
}
)");
}

TEST_CASE("an input that does not lie under the fragment repeats where its extent is 1") {
  const std::string plane = kernelProgram(
      glsl, samples::saxpy, {.access = {{}, {Addressing::Plane, true}, {Addressing::Linear}, {}}});
  CHECK(definition(plane, "ivec4 sk_index_x") == R"(ivec4 sk_index_x() {
  return min(sk_index(), sk_shape_x - 1);
}
)");
  CHECK(definition(plane, "void main") == R"(void main() {
  saxpy(
      sk_arg_a,
      texelFetch(sk_tex_x, sk_index_x().xy + sk_origin_x.xy, 0).x,
      texelFetch(sk_tex_y, sk_texel(sk_ravel(sk_index_y(), sk_stride_y), sk_shift_y), 0).x,
      sk_out_r);
}
)");
}

TEST_CASE("clamped gathers") {
  const Accessors constant(Boundary::Clamp, 1, 2, planeVariant({Addressing::Plane}));
  CHECK(constant.at == R"(float sk_at_a(int sk_i) {
  int sk_p = clamp(sk_i, 0, sk_shape_a.x - 1);
  return texelFetch(sk_tex_a, ivec2(sk_p, 0), 0).x;
}
)");
  CHECK(constant.near == R"(float sk_near_a(int sk_d) {
  int sk_p = clamp(int(gl_FragCoord.x) + sk_d, 0, sk_shape_a.x - 1);
  return texelFetch(sk_tex_a, ivec2(sk_p, 0), 0).x;
}
)");
  const Accessors any(Boundary::Clamp, 2, -1, planeVariant({Addressing::Plane, true}));
  CHECK(any.near == R"(float sk_near_a(ivec2 sk_d) {
  ivec2 sk_i = ivec2(gl_FragCoord.xy);
  ivec2 sk_p = sk_i + clamp(sk_d, -sk_i, sk_shape_a.xy - 1 - sk_i);
  return texelFetch(sk_tex_a, sk_p + sk_origin_a.xy, 0).x;
}
)");
}

TEST_CASE("wrapped gathers") {
  const Accessors nearby(Boundary::Wrap, 2, 1, planeVariant({Addressing::Plane, false, true}));
  CHECK(nearby.at == R"(float sk_at_a(ivec2 sk_i) {
  ivec2 sk_p = ivec2(sk_wrap(0, sk_i.x, sk_shape_a.x), sk_wrap(0, sk_i.y, sk_shape_a.y));
  return texelFetch(sk_tex_a, sk_p, 0).x;
}
)");
  CHECK(nearby.near == R"(float sk_near_a(ivec2 sk_d) {
  ivec2 sk_p = ivec2(gl_FragCoord.xy) + sk_d;
  sk_p = ivec2(sk_wrap(sk_p.x, sk_shape_a.x), sk_wrap(sk_p.y, sk_shape_a.y));
  return texelFetch(sk_tex_a, sk_p, 0).x;
}
)");
  const Accessors any(Boundary::Wrap, 1, -1, planeVariant({Addressing::Linear, true}));
  CHECK(any.near == R"(float sk_near_a(int sk_d) {
  int sk_i = int(gl_FragCoord.x);
  int sk_p = sk_wrap(sk_i, sk_d, sk_shape_a.x);
  sk_p += sk_origin_a.x;
  return texelFetch(sk_tex_a, sk_texel(sk_p, sk_shift_a), 0).x;
}
)");
}

TEST_CASE("mirrored gathers of every rank") {
  const Accessors four(
      Boundary::Mirror, 4, 1,
      {.domain = Domain::Linear, .domainRank = 4, .access = {{}, {}, {Addressing::Linear}, {}, {}}});
  CHECK(four.near == R"(float sk_near_a(ivec4 sk_d) {
  ivec4 sk_i = sk_index();
  ivec4 sk_p = ivec4(
      sk_mirror(sk_i.x, sk_d.x, sk_shape_a.x),
      sk_mirror(sk_i.y, sk_d.y, sk_shape_a.y),
      sk_mirror(sk_i.z, sk_d.z, sk_shape_a.z),
      sk_mirror(sk_i.w, sk_d.w, sk_shape_a.w));
  return texelFetch(sk_tex_a, sk_texel(sk_p.x + sk_p.y * sk_stride_a.y + sk_p.z * sk_stride_a.z + sk_p.w * sk_stride_a.w, sk_shift_a), 0).x;
}
)");
}

TEST_CASE("gathers with a border") {
  const Accessors two(Boundary::Border, 2, -1, planeVariant({Addressing::Plane, true}));
  CHECK(two.at == R"(float sk_at_a(ivec2 sk_i) {
  ivec2 sk_p = sk_i;
  if (any(greaterThanEqual(uvec2(sk_p), uvec2(sk_shape_a.xy)))) return -1.0;
  return texelFetch(sk_tex_a, sk_p + sk_origin_a.xy, 0).x;
}
)");
  CHECK(two.near == R"(float sk_near_a(ivec2 sk_d) {
  ivec2 sk_p = ivec2(gl_FragCoord.xy) + sk_d;
  if (any(greaterThanEqual(uvec2(sk_p), uvec2(sk_shape_a.xy)))) return -1.0;
  return texelFetch(sk_tex_a, sk_p + sk_origin_a.xy, 0).x;
}
)");
}

TEST_CASE("a dispatched stencil fetches each texel once for its work group") {
  const samples::EveryAccess sample(samples::floatElement, "", 2, Boundary::Clamp, 1);
  const StreamAccess packed{.addressing = Addressing::Plane, .nearby = true, .packed = true};
  const Variant variant{
      .domainPacked = true,
      .access = {{.packed = true}, {.packed = true}, packed, {.packed = true}, {.packed = true}}};
  const std::string program = kernelProgram(*findProfile("glsl430"), sample.kernel(), variant);
  CHECK(program.find("shared vec4 sk_tile_a[18][10];") != std::string::npos);
  const std::string main = part(program, "void main() {", "return;");
  CHECK(main.find("barrier();") != std::string::npos);  // all invocations reach it, including those outside
  CHECK(main.find("if (any(greaterThanEqual(") > main.find("barrier();"));
  CHECK(kernelProgram(glsl, sample.kernel(), variant).find("sk_tile_a") == std::string::npos);
}

TEST_CASE("a local gather reads its neighbours as in a stream that is not placed") {
  const auto programOf = [](const Profile& profile, bool isPacked, Variant variant, StreamAccess gather) {
    const samples::EveryAccess sample(samples::floatElement, "-1.0", 2, Boundary::Border, 1);
    gather.addressing = Addressing::Plane;
    gather.nearby = true;
    variant.domainPacked = gather.packed = isPacked;
    variant.access = {{}, {}, gather, {}, {}};
    return kernelProgram(profile, sample.kernel(), variant);
  };
  const Variant placed{.domainPlaced = true, .access = {}},
      view{.domainView = true, .domainPlaced = true, .access = {}};
  const StreamAccess local{.local = true}, shifted{.local = true, .shifted = true};
  for (const bool isPacked : {false, true}) {
    const std::string plain = programOf(glsl, isPacked, {}, {}),
                      here = programOf(glsl, isPacked, placed, local);
    CHECK(definition(here, "float sk_near_a") == definition(plain, "float sk_near_a"));
    CHECK(definition(here, "ivec4 sk_extent_a()") == "ivec4 sk_extent_a() {\n  return sk_whole_a;\n}\n");
    CHECK(definition(here, "ivec4 sk_extent_r()") == "ivec4 sk_extent_r() {\n  return sk_domain_whole;\n}\n");
  }
  CHECK(definition(programOf(glsl, true, placed, local), "vec4 sk_texel_at_a") ==
        definition(programOf(glsl, true, {}, {}), "vec4 sk_texel_at_a"));
  CHECK(definition(programOf(glsl, false, placed, shifted), "float sk_near_a")
            .find("ivec2 sk_p = (ivec2(gl_FragCoord.xy) + sk_low_a.xy) + sk_d;") != std::string::npos);
  CHECK(definition(programOf(glsl, true, view, shifted), "vec4 sk_texel_at_a")
            .find("ivec2 sk_p = ((ivec2(gl_FragCoord.xy) - (sk_domain_origin.xy >> ivec2(2, 0))) + "
                  "(sk_low_a.xy >> ivec2(2, 0))) + sk_d;") != std::string::npos);
  const Profile& compute = *findProfile("glsl430");
  CHECK(programOf(compute, true, view, shifted).find("shared vec4 sk_tile_a[18][10];") != std::string::npos);
  CHECK(programOf(compute, true, placed, {.placed = true}).find("sk_tile_a") == std::string::npos);
  CHECK(programOf(compute, true, placed, {}).find("sk_tile_a") == std::string::npos);
}

TEST_CASE("the vertex program needs no data") {
  CHECK(vertexProgram(glsl) == R"(#version 330 core
void main() {
  gl_Position = vec4(float(gl_VertexID & 1) * 2.0 - 1.0, float(gl_VertexID & 2) - 1.0, 0.0, 1.0);
}
)");
}

TEST_CASE("a kernel with loops leaves fragments beside its domain before it does anything else") {
  Kernel looping = samples::saxpy;
  looping.usesLoops = true;
  const auto first = [&](const Variant& variant) {
    return part(kernelProgram(glsl, looping, variant), "void main() {\n", ";\n");
  };
  CHECK(first({.access = {{}, {}, {}, {}}}) ==
        "void main() {\n  if (any(greaterThanEqual(uvec2(ivec2(gl_FragCoord.xy)), "
        "uvec2(sk_domain_shape.xy)))) return;\n");
  CHECK(first({.domainView = true, .access = {{}, {}, {}, {}}}) ==
        "void main() {\n  if (any(greaterThanEqual(uvec2(ivec2(gl_FragCoord.xy) - sk_domain_origin.xy), "
        "uvec2(sk_domain_shape.xy)))) return;\n");
  CHECK(first({.domain = Domain::Linear, .access = {{}, {}, {}, {}}}) ==
        "void main() {\n  if ((int(gl_FragCoord.y) << sk_domain_shift | int(gl_FragCoord.x)) >= "
        "sk_domain_stride.w * sk_domain_shape.w) return;\n");
  CHECK(kernelProgram(glsl, looping, {.domain = Domain::LinearBox, .access = {{}, {}, {}, {}}})
            .find("return;") == std::string::npos);
}

TEST_CASE("a kernel's own operations are guarded as the profile and the call say") {
  Kernel kernel = samples::saxpy;
  const std::string marked =
      "void saxpy($pfloat a, float x, float y, $pout float r) {\n"
      "  $pfloat p = $(a * $[x + y$]$);\n"
      "  if ($v1$(p - x$)$; < $v1$[x + y$]$;) r = g($v1$fdot($v2$(x * y$)$;, p)$;);\n"
      "  $=r$,+$,$(p * x$)$.;\n"
      "  r = $($<float(1)$> * -$0$);\n"
      "  if ($!(x < y)) r = any($~(lessThan(v, v))) ? $($<x$> + y$) : y;\n"
      "  r = $mv$*m$#.x + $qroundEven(x)$Q8$;\n"
      "}\n";
  kernel.body = marked;
  const auto bodyOf = [&](sk::Barrier barrier, bool asWritten) {
    Profile profile = glsl;
    profile.barrier = barrier;
    profile.asWritten = asWritten;
    const std::string text = kernelProgram(profile, kernel, {.access = {{}, {}, {}, {}}});
    const std::size_t from = text.find("void saxpy("), to = text.find("}\n", from) + 2;
    return text.substr(from, to - from);
  };
  const std::string plain =
      "void saxpy(float a, float x, float y, out float r) {\n"
      "  float p = a * (x + y);\n"
      "  if (p - x < (x + y)) r = g(dot(x * y, p));\n"
      "  r += p * x;\n"
      "  r = float(1) * -0.0;\n"
      "  if (!(x < y)) r = any(not(lessThan(v, v))) ? x + y : y;\n"
      "  r = v * m.x + roundEven(x) / 255.0;\n"
      "}\n";
  CHECK(bodyOf(sk::Barrier::None, true) == plain);
  CHECK(bodyOf(sk::Barrier::Precise, false) == plain);
  CHECK(bodyOf(sk::Barrier::Xor, false) == plain);
  CHECK(
      bodyOf(sk::Barrier::Precise, true) ==
      "void saxpy(precise float a, float x, float y, precise out float r) {\n"
      "  precise float p = a * (x + y);\n"
      "  if ((sk_exact1 = p - x) < (sk_exact1 = x + y)) r = g((sk_exact1 = sk_exact_dot((sk_exact2 = x * y), "
      "p)));\n"
      "  r += p * x;\n"
      "  r = sk_known(float(1)) * -sk_known(0.0);\n"
      "  if (!(x < y)) r = any(not(lessThan(v, v))) ? sk_known(x) + y : y;\n"
      "  r = sk_exact_product(v, m).x + sk_exact_fraction(roundEven(x), 0.00390625, 0.003921569);\n"
      "}\n");
  CHECK(bodyOf(sk::Barrier::Xor, true) ==
        "void saxpy(float a, float x, float y, out float r) {\n"
        "  float p = sk_keep(a * sk_keep(x + y));\n"
        "  if (sk_keep(p - x) < sk_keep(x + y)) r = g(sk_exact_dot(sk_keep(x * y), p));\n"
        "  r = sk_keep(r + sk_keep(p * x));\n"
        "  r = sk_keep(sk_known(float(1)) * -sk_known(0.0));\n"
        "  if (sk_not(x < y)) r = any(sk_not(lessThan(v, v))) ? sk_keep(sk_known(x) + y) : y;\n"
        "  r = sk_exact_product(v, m).x + sk_exact_fraction(roundEven(x), 0.00390625, 0.003921569);\n"
        "}\n");
}

TEST_CASE("a heavy kernel writes no packed texels") {
  const auto packs = [](std::uint32_t weight, bool usesLoops = false) {
    Kernel kernel = samples::saxpy;
    kernel.weight = weight;
    kernel.usesLoops = usesLoops;
    return mayWritePacked(kernel);
  };
  CHECK(packs(greatestPackedWeight));
  CHECK(!packs(greatestPackedWeight + 1));
  CHECK(!packs(1, /*usesLoops=*/true));
}
