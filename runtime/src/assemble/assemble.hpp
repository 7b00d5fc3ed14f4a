// SPDX-License-Identifier: MIT
//
// The assembler: puts element fetches, stores, address arithmetic, boundary modes and main() around
// a kernel's body, for one profile and one choice of layouts. A pure text library without GL, used
// by the runtime and by `skc --emit=glsl` alike, so that what a user reads is what runs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "assemble/condition.hpp"
#include "assemble/region_layout.hpp"
#include "assemble/relayed_values.hpp"
#include "sk/arithmetic.hpp"
#include "sk/program.hpp"

namespace sk::assemble {

/// What doubles are in a program (doubles.hpp).
enum class Doubles : std::uint8_t {
  Native,  ///< GLSL's own, by GL_ARB_gpu_shader_fp64
  Pairs,   ///< pairs of floats
};

/// What runs a program.
enum class Stage : std::uint8_t {
  Fragment,  ///< a draw: an invocation is a fragment, outputs are drawn to
  Compute,   ///< a dispatch: outputs are images
};

/// Limits and spellings of one version of a target. The rows are in profiles.cpp.
struct Profile {
  std::string_view name;        ///< "glsl330", "essl300", "glsl430"
  std::string_view version;     ///< the #version line
  Stage stage;
  bool es;                      ///< precision statements, ES formats and limits
  int drawBuffers;  ///< planes that a pass may write: guaranteed minimum of draw buffers, or of images
  int textureUnits;  ///< guaranteed minimum for a program of the stage
  int uniformComponents;  ///< likewise; ES counts vectors of four
  Doubles doubles;  ///< the best form that devices of the profile have
  bool accurate = true;  ///< functions of ours for the intrinsics that devices get wrong
  Barrier barrier =
      Barrier::Xor;  ///< Precise needs GL_ARB_gpu_shader5, which devices of the profile may have
  bool tables = true;  ///< functions that a table may stand for are looked up there
  bool sharesTexels =
      true;  ///< compute programs fetch a texel once for all neighbours in a work group, which pays on GPUs
  bool samples =
      false;  ///< texels are sampled at their centres, which llvmpipe does faster than it fetches them;
  ///< the samplers that are bound are the nearest ones, but for filtered gathers
  bool relaysUniforms =
      false;  ///< they come from the vertex program (relayed_values.hpp), which software renderers like
};
const Profile* findProfile(std::string_view name);
std::span<const Profile> profiles();

/// How the texels of the output lie, hence how sk_index() follows from a program's texel. What has to be
/// drawn is drawnTexels() of region layout.hpp.
enum class Domain : std::uint8_t {
  Plane,  ///< texel = origin + index.xy: a whole 2-D stream or a rectangle of one
  Linear,  ///< a whole linearised stream: element number = y << shift | x
  LinearBox,  ///< a box of a linearised stream: texels outside the box are left out
  Entry,  ///< of an append output's list, linearised: the element is the one that it comes from (append/append_passes.hpp)
};
Domain domainOf(const RegionLayout& output);

/// How an element of a stream is found in its texture.
enum class Addressing : std::uint8_t {
  Aligned,  ///< inputs: the texel under the fragment; iterators: each component runs along a dimension
  Plane,  ///< texel = index.xy (plus the view's origin)
  Linear,  ///< element number = dot(index, strides), texel = (number & mask, number >> shift);
  ///< iterators: all components run over that number
  Layered,  ///< the same in an array texture
};

struct StreamAccess {
  Addressing addressing = Addressing::Aligned;
  bool view = false;  ///< a region of its stream: an origin is added
  bool nearby = false;  ///< gathers: Parameter::reach is known and below every extent, and no extent
      ///< of the domain is above the gather's, so that one step wraps or mirrors
      ///< a neighbour's index
  bool filtered = false;  ///< gathers: sk_sample_p() is left to the sampler's linear filter (mayFilter())
  program::Fit fit = program::Fit::Same;  ///< inputs
  Storage storage = Storage::Single;  ///< inputs, outputs and gathers: what the stream holds floats as
  bool packed = false;  ///< four elements a texel
  auto operator<=>(const StreamAccess&) const = default;
};

/// Whether a sampler's linear filter can stand for sk_sample_p(), where the whole of a texture that lies as
/// it is (Addressing::Plane) is read; a gather of floats, if the device filters these.
bool mayFilter(const program::Parameter& gather);

/// Whether elements of this type can lie four to a texel (RegionLayout::packed): one scalar of four bytes at most.
bool mayPack(const program::Element& held);

/// Whether a kernel may write packed texels, the four elements of one after the other, as far as it is its own affair.
/// Not with loops, which would run four times in a row, nor is it worth it for long programs, which would take four
/// times as long to compile.
bool mayWritePacked(const program::Kernel& kernel);

/// Characters of the longest body that is worth it, and of the functions that it calls, each as often as it is called: a driver
/// in software takes some 10 s for four times as many.
constexpr std::size_t longestPackedBody = 4096, longestPackedCalls = 28672;

/// What a program of a kernel computes (append/append_passes.hpp).
enum class Work : std::uint8_t {
  Elements,  ///< its outputs; it has no append outputs
  Counts,  ///< its outputs, and how often each element pushes to each counted append output
  List,  ///< the list of one append output, and nothing else
};

struct Task {
  Work work = Work::Elements;
  std::uint8_t appendOutput = 0;  ///< List: the parameter
  bool treeLayered = false;  ///< List: the tree of a counted append output is
  auto operator<=>(const Task&) const = default;
};

/// One way to lay a kernel out. `access` has one entry per parameter, in order (Uniform, Spec and Output
/// entries are not looked at, nor those of streams that `specs` switches off; a scatter output's says where its
/// elements lie, for Work::List).
struct Variant {
  Task task = {};
  Domain domain = Domain::Plane;
  bool domainView = false;  ///< Plane: the domain's origin is not (0, 0)
  bool domainPacked = false;  ///< four elements a texel, which one invocation computes one after the other
  bool domainEven = false;  ///< drawsWholeQuads(): no fragment is outside
  bool domainLayered = false;  ///< what is drawn to is layered
  std::uint8_t domainRank = 2;  ///< Linear, LinearBox: dimensions that an index is decoded into;
      ///< decodedRank() of the output, or more
  std::vector<StreamAccess> access;
  SpecValues specs{};
  auto operator<=>(const Variant&) const = default;
};

/// Names of the uniforms that a program declares, where it needs them; P is the parameter's
/// symbol, and the values are those of a RegionLayout (region layout.hpp):
///   sk_arg_P                       value of uniform parameter P
///   sk_begin_P sk_step_P           first value and step of iterator P, of its type
///   sk_tex_P | sk_tex0_P sk_tex1_P ...   samplers, one a plane (a single plane has no number)
///   sk_origin_P  ivec4             first index of the region in its stream, x fastest
///   sk_shape_P   ivec4             shape of the region, missing dimensions 1
///   sk_stride_P  ivec4             Linear: elements to step for each dimension of its stream; of an
///                                  iterator, of the domain
///   sk_shift_P   int               Linear: log2 of the texture's width
///   sk_ratio_P   ivec4             of a fitted input: its stretch or stride in each dimension
/// and for the domain (hence for every output, which has none of its own) the same with
/// `sk_domain_origin sk_domain_shape sk_domain_stride sk_domain_shift`; and `sk_domain_row`, an int, where that is
/// layered: the first row of the layer that is drawn.
/// A compute program has `sk_rect`, an ivec4: the first texel that is written, and how many in each dimension. One whose
/// work groups each compute a texel is dispatched with as many groups.
/// Outputs are `layout(location = n) out`, or images of binding n, one a plane, numbered in order of parameters and
/// fields; those of Work::Counts have one more for each counted append output, and those of Work::List are the planes of the append output, for a
/// scatter output after one for its texel. A list of a counted append output reads a tree (append/histo_pyramid.hpp):
///   sk_odd sk_even sk_tree_shift   its textures (samplers) and log2 of their width
///   sk_levels, sk_rows[l]          the number of levels, and the first row of level l in its texture
/// Of a function with a table, those of tables.hpp.
/// Where the profile relays uniforms, the vertex program has most of them.
///
/// Extents are at most sk::mostExtent and numbers of elements sk::mostElements. Gathers are not empty: the runtime refuses such a call.
/// Compute programs are of Work::Elements alone.
std::string kernelProgram(const Profile& profile, const program::Kernel& kernel, const Variant& variant);

/// Name of the sampler of a plane of a parameter, for kernels and reductions alike. Planes in a bundle
/// have that of the bundle.
std::string samplerName(const program::Parameter& parameter, std::size_t plane);
/// Name of the sampler (sampler2DArray) of a plan's bundle.
std::string bundleName(std::size_t bundle);

/// The vertex program of a strip of four corners, those of the viewport, from gl_VertexID alone. It hands these uniforms on.
std::string vertexProgram(const Profile& profile, std::span<const RelayedValue> relayed = {});

/// What a driver links.
struct ProgramPair {
  std::string vertex;  ///< empty where `main` is a compute program
  std::string main;
};
/// That of kernelProgram(), and its vertex program.
ProgramPair kernelPrograms(const Profile& profile, const program::Kernel& kernel, const Variant& variant);

}  // namespace sk::assemble
