// SPDX-License-Identifier: MIT
//
// The assembler: adds element fetches, stores, address arithmetic, boundary modes and main() to a kernel's
// body, for one profile and one choice of layouts. It only produces text and must not depend on GL. The
// runtime and `skc --emit=glsl` both use it, so that users read exactly what runs.
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

/// The representation of doubles in a program (glsl/double_intrinsics.hpp).
enum class Doubles : std::uint8_t {
  Native,  ///< GLSL's double, from GL_ARB_gpu_shader_fp64
  Pairs,   ///< pairs of floats
};

/// How a program is executed.
enum class Stage : std::uint8_t {
  Fragment,  ///< by a draw: an invocation is a fragment, and outputs are render targets
  Compute,  ///< by a dispatch: outputs are images
};

/// Limits and spellings of one version of a target. The rows are in profiles.cpp.
struct Profile {
  std::string_view name;        ///< "glsl330", "essl300", "glsl430", "essl310", "webgl2"
  std::string_view version;     ///< the #version line
  Stage stage;
  bool es;                      ///< precision statements, ES formats and limits
  int drawBuffers;  ///< planes that a pass may write: the guaranteed draw buffers, or images
  int textureUnits;  ///< guaranteed for a program of the stage
  int uniformComponents;  ///< likewise; ES counts vectors of four
  Doubles doubles;  ///< the best representation that devices of the profile have
  /// Programs run in browsers, where `?:` does not choose between structs or arrays: bodies have passed expand-selects
  /// (compiler/transforms/expand_selects.cpp). No sk::Device has such a profile.
  bool webgl = false;
  bool accurate = true;  ///< use our own functions for intrinsics that devices get wrong
  /// What keeps floats from being simplified. Precise needs GL_ARB_gpu_shader5, which most devices with OpenGL have, or in ES
  /// GL_EXT_gpu_shader5 or GL_OES_gpu_shader5, and version 3.10.
  Barrier barrier = Barrier::Xor;
  /// Contraction::Exact: a kernel's own operations are computed as they are written (glsl/own_arithmetic.hpp).
  bool asWritten = true;
  bool tables = true;  ///< look functions with tables up
  /// Compute programs fetch a texel once for all neighbours in a work group, which is faster on GPUs.
  bool sharesTexels = true;
  /// Sample texels at their centres, which llvmpipe does faster than fetching. All bound samplers are then
  /// nearest ones, except those of filtered gathers.
  bool samples = false;
  /// Uniforms come from the vertex program (relayed_values.hpp), which is faster in software renderers.
  bool relaysUniforms = false;
  /// Programs with loops that may take many iterations report if the driver has ended them early (glsl/loop_check.glsl).
  bool checksLoops = false;
  /// Where GLSL has umulExtended, it may be called: with a literal 0xffffffff, LLVM 15 brings llvmpipe down.
  bool highProducts = true;
  /// Compute programs may use subgroups of 32 invocations (glsl/subgroups.hpp), and 48 KiB of shared memory in a work group.
  bool subgroups = false;
  /// ES: compute programs write images of every format (GL_NV_image_formats), not only of those of ES 3.1 (mayStore()).
  bool storesAllFormats = false;
};
const Profile* findProfile(std::string_view name);
std::span<const Profile> profiles();

/// The format of the image that a compute program of ES declares for a field's plane, as a layout qualifier: "rgba32f".
std::string imageFormat(const program::Field& field);
/// Whether compute programs of the profile may write images of a format. ES 3.1 has formats of four components, and of one
/// component of 32 bits.
bool mayStore(const Profile& profile, std::string_view format);
/// The same for all planes of elements that do not share texels.
bool mayStore(const Profile& profile, const program::Element& element);

/// The layout of the output's texels, which determines how sk_index() follows from a texel. drawnTexels() of
/// region_layout.hpp says what to draw.
enum class Domain : std::uint8_t {
  Plane,  ///< texel = origin + index.xy: a whole 2-D stream or a rectangle of one
  Linear,  ///< a whole linearised stream: element number = y << shift | x
  LinearBox,  ///< a box of a linearised stream: texels outside of the box are skipped
  /// The linearised list of an append output: the element is the one that pushed the entry
  /// (append/append_passes.hpp).
  Entry,
  /// Strided regions, for copies to them: of a plane, of a plane by number, of a linearised stream. Texels between
  /// their elements are skipped; compute programs run for the elements of a Strided one alone, numbered from {0, 0}.
  Strided,
  StridedRows,
  StridedLinear,
};
Domain domainOf(const RegionLayout& output);

/// How the texel of an element is addressed.
enum class Addressing : std::uint8_t {
  Aligned,  ///< inputs: the fragment's texel; iterators: each component runs along a dimension
  Plane,  ///< texel = index.xy (plus the view's origin)
  /// texel = (number & mask, number >> shift) with element number = dot(index, strides); iterators: all
  /// components advance with the element number.
  Linear,
  Layered,  ///< like Linear, in an array texture
  Rows,  ///< strided: texel = (number % width, number / width) in a plane
};

struct StreamAccess {
  Addressing addressing = Addressing::Aligned;
  /// A region of its stream, so that an origin is added. Uniforms: a stream holds the value, at texel `origin` (in a
  /// packed stream, x counts elements).
  bool view = false;
  /// Gathers: Parameter::reach is known and less than every extent, and the domain's extents do not exceed
  /// the gather's, so that a neighbour's index wraps or mirrors at most once.
  bool nearby = false;
  bool filtered = false;  ///< gathers: sk_sample_p() uses the sampler's linear filter (mayFilter())
  bool fitted = false;  ///< inputs with another program::Fit than Same
  Storage storage = Storage::Single;  ///< inputs, outputs and gathers: how the stream stores floats
  bool packed = false;  ///< four elements per texel
  bool strided = false;  ///< RegionLayout::strided: a view
  bool placed = false;  ///< gathers, and inputs in another layout than the domain's: a part of a whole
  /// Gathers in a placed domain: a part of a whole, whose neighbours are found as in a stream that is not placed.
  bool local = false;
  bool shifted = false;  ///< local gathers: the domain's first element is not the first one of the part
  auto operator<=>(const StreamAccess&) const = default;
};

/// Whether a sampler's linear filter can implement sk_sample_p(): for a gather of floats that reads a whole
/// texture with Addressing::Plane, if the device filters floats.
bool mayFilter(const program::Parameter& gather);

/// Whether four elements of this type fit in a texel (RegionLayout::packed): one scalar of at most four
/// bytes.
bool mayPack(const program::Element& held);

/// Whether a kernel may compute the four elements of a packed texel in sequence; other conditions are the
/// caller's. Not if it has loops, which would run four times in sequence, nor if it is heavy, because it would
/// take four times as long to compile.
bool mayWritePacked(const program::Kernel& kernel);

/// Likewise for a kernel with append outputs and Work::Groups, over a domain whose texels hold four elements.
bool mayGroupPacked(const program::Kernel& kernel);

/// The greatest program::Kernel::weight for which this is worthwhile: software drivers take some 10 s for four times as much.
/// Every kernel among our examples is on the same side of it as it was of an earlier limit, 4096 characters of GLSL, except for
/// a few variants in halves or doubles.
constexpr std::uint32_t greatestPackedWeight = 660;

/// What a kernel's program computes (append/append_passes.hpp, append/append_groups.hpp).
enum class Work : std::uint8_t {
  Elements,  ///< its outputs; there are no append outputs
  Counts,  ///< its outputs, and how often each element pushes to each counted append output
  List,  ///< the list of one append output only
  Owners,  ///< a compute program: which element stores to an element of a scatter output last
  Groups,  ///< a compute program: its outputs, and all append outputs
  Folds,  ///< a compute program: its outputs, and its accumulators (reduce/group_fold.hpp)
  Tiles,  ///< a compute program: several calls of several kernels, by tiles (program/tile_program.hpp)
};

struct Task {
  Work work = Work::Elements;
  std::uint8_t appendOutput = 0;  ///< List: the parameter
  bool pyramidLayered = false;  ///< List: the pyramid of a counted append output has layers
  bool scattersInAnyOrder = false;  ///< Owners, Groups: Order::Any
  bool pushesInAnyOrder = false;  ///< Groups: Order::Any, and all variable outputs have room
  bool inOneRound = false;  ///< Groups: an invocation computes one texel, in place of GroupPlan::rounds
  auto operator<=>(const Task&) const = default;
};

/// One choice of layouts for a kernel. `access` has one entry per parameter, in order. Entries of Spec
/// and Output parameters, and of streams that `specs` switches off, are ignored. The entry of a scatter
/// output gives the layout of its elements, for Work::List, Owners and Groups.
struct Variant {
  Task task = {};
  Domain domain = Domain::Plane;
  bool domainView = false;  ///< Plane: the domain's origin is not (0, 0)
  bool domainPacked = false;  ///< four elements per texel; one invocation computes them in sequence
  bool domainEven = false;  ///< drawsWholeQuads(): no fragment is outside
  bool domainLayered = false;  ///< the render target has layers
  /// Linear, LinearBox: the number of dimensions into which an index is decoded: decodedRank() of the output,
  /// or more.
  std::uint8_t domainRank = 2;
  bool domainPlaced = false;  ///< the domain is a part of a whole
  std::vector<StreamAccess> access;
  SpecValues specs{};
  auto operator<=>(const Variant&) const = default;
};

/// The uniforms that a program declares if it needs them. P is the parameter's symbol; the values are those
/// of a RegionLayout (region_layout.hpp):
///   sk_arg_P                       value of uniform parameter P
///   sk_begin_P sk_step_P           first value and step of iterator P, of its type
///   sk_tex_P | sk_tex0_P sk_tex1_P ...   samplers, one per plane (a single plane has no number)
///   sk_origin_P  ivec4             first index of the region in its stream, x fastest
///   sk_shape_P   ivec4             shape of the region, missing dimensions 1
///   sk_stride_P  ivec4             Linear and strided: elements to step for each dimension; of an iterator,
///                                  of the domain
///   sk_shift_P   int               Linear: log2 of the texture's width; Rows: the width in elements
///   sk_ratio_P   ivec4             of a fitted input: its stretch or stride in each dimension
///   sk_low_P sk_high_P  ivec4      placed gathers: the indices that are held; sk_low_P of shifted gathers: the
///                                  index in the part of the domain's first element
///   sk_whole_P   ivec4             inputs in a placed domain, and local gathers: the extents of the whole
/// A placed domain has `sk_domain_low`, the index in the whole of its first element, and `sk_domain_whole`.
/// The domain, and hence every output, has the same uniforms under the names `sk_domain_origin
/// sk_domain_shape sk_domain_stride sk_domain_shift`. If it has layers, there is also `sk_domain_row`, an
/// int: the first row of the drawn layer.
/// A compute program has `sk_rect`, an ivec4: the first texel to write, then the number of texels in each
/// dimension. If each of its work groups computes one texel, it is dispatched with that number of groups.
/// Outputs are `layout(location = n) out`, or images with binding n, one per plane, numbered in order of
/// parameters and fields. Work::Counts adds one for each counted append output. Work::List writes only the
/// planes of the append output, which follow the target texel in a scatter output. Work::Groups has the planes of all
/// outputs and lists, and then, for each variable output, an image of one texel with the number of its pushes. The list of a
/// counted append output reads a pyramid (append/histo_pyramid.hpp):
///   sk_odd sk_even sk_tree_shift   its textures (samplers) and log2 of their width
///   sk_levels, sk_rows[l]          the number of levels, and the first row of level l in its texture
/// Functions with tables have the uniforms of tables.hpp.
/// If the profile relays uniforms, most of them are uniforms of the vertex program.
///
/// Requires extents up to sk::mostExtent, element numbers up to sk::mostElements and nonempty gathers; the
/// runtime rejects other calls. Fragment programs support Work::Elements, Counts and List, compute programs Work::Elements,
/// Owners, Groups and Folds. `reduction`, whose fold the kernel is, must be given for Work::Folds alone; the domain has no
/// layers then, and mayFoldInGroups() is true. The images of accumulators follow those of outputs.
std::string kernelProgram(const Profile& profile, const program::Kernel& kernel, const Variant& variant,
                          const program::Reduction* reduction = nullptr);

/// The sampler's name for a plane of a parameter, in kernels and reductions. Planes in a stack share its
/// name.
std::string samplerName(const program::Parameter& parameter, std::size_t plane);
/// The name of the sampler (sampler2DArray) of a plan's stack.
std::string stackName(std::size_t stack);

/// The vertex program of a strip of four corners, those of the viewport, computed from gl_VertexID. It relays
/// `relayed`.
std::string vertexProgram(const Profile& profile, std::span<const RelayedValue> relayed = {});

/// The programs that a driver links.
struct ProgramPair {
  std::string vertex;  ///< empty if `main` is a compute program
  std::string main;
};
/// The result of kernelProgram(), with its vertex program.
ProgramPair kernelPrograms(const Profile& profile, const program::Kernel& kernel, const Variant& variant,
                           const program::Reduction* reduction = nullptr);

}  // namespace sk::assemble
