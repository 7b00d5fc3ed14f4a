// SPDX-License-Identifier: MIT
//
// What the runtime knows of a compiled .sk file: constant, typed descriptors that `skc` writes into
// FILE.sk.cpp and that the assembler and the runtime read. This is the whole contract between the
// compiler and the runtime: nothing is parsed out of GLSL text, and neither side sees the other.
//
// The GLSL of a kernel comes in two parts, both in the subset that GLSL 3.30, ESSL 3.00 and later
// share: declarations (structs and constants) and a body (plain functions). The assembler puts its
// own uniforms and functions between the two, since those speak of the structs, and the body of
// them. The body reaches streams only through these functions; `p` stands for Parameter::symbol:
//
//   ivec4 sk_index()           index of the current element in the domain, x fastest
//   ivec4 sk_index_p()         index of the current element in element parameter p   (usesIndex)
//   ivec4 sk_extent_p()        shape of p's stream, x fastest, missing dimensions 1  (usesExtent)
//   T     sk_at_p(ivecN i)     element of gather p at i; N is its rank, `int` if 1   (usesAt)
//   T     sk_near_p(ivecN d)   element of gather p at the current index plus d       (usesNear)
//   T     sk_sample_p(vecN x)  gather p of floats, interpolated at x; `float` if 1   (usesSample)
//   ivec4 sk_extent()          shape of the domain, where no output has it           (usesExtent)
//                              (of a reduction, the domain is what its elements lie in)
//   void  sk_push_p(T v)       appends v to variable output p
//   void  sk_put_p(ivecN i, T v)   element of scatter output p at i becomes v, or what Parameter::scatter
//                              makes of it and v; nothing where i is outside
//
//   float sk_table_f(float x)  function f of the body, or its value in a table         (Kernel::tables)
//
// Doubles are of types sk_double, sk_double2, sk_double3 and sk_double4, whose components are members x, y, z
// and w. A body computes with them by functions of one sk_double, which the assembler defines for native doubles or
// for pairs of floats: assemble/glsl/doubles.hpp lists them.
//
// Every name that the assembler declares begins with `sk_`; names of the user never do.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "sk/options.hpp"
#include "sk/table.hpp"

namespace sk::native {
struct Code;
}  // namespace sk::native

namespace sk::program {

/// Component type of a field, in host memory: Bool is a byte of 0 or 1, Half and the normalized ones
/// lie as types.hpp has them. GLSL computes Char, Uchar, Short and Ushort as int, and those from Half on
/// that are no integers as float. The texture format follows from it.
enum class Scalar : std::uint8_t {
  Bool,
  Int,
  Uint,
  Float,
  Double,
  Half,
  Char,
  Uchar,
  Short,
  Ushort,
  Unorm8,
  Snorm8,
  Unorm16,
  Snorm16,
};

/// One plane of an element: a scalar, a vector, a row of a matrix or up to two components of a vector of
/// doubles, which one texel of one texture holds.
struct Field {
  std::string_view path;  ///< member path in GLSL ("t", "a.b"); empty where the element is no struct
  Scalar scalar;
  std::uint8_t width;  ///< components, 1 to 4
  std::uint32_t offset;  ///< bytes from the element's start in host memory
  std::int8_t part = -1;  ///< which row of `path` it is, or which two components; -1: all of it
};

/// An element type: its GLSL spelling and its planes, in declaration order.
struct Element {
  std::string_view name;  ///< spelling in the .sk file, for messages: "float2", "Hit"
  std::string_view glsl;  ///< spelling in GLSL: "vec2", "Hit"
  std::uint32_t size;  ///< sizeof on the host
  std::span<const Field> fields;  ///< 1 or more
};

enum class Role : std::uint8_t {
  Uniform,  ///< `T c`
  Input,  ///< `T x<>`
  Output,  ///< `out T r<>`
  Gather,  ///< `T a[]`, `T a[][]`
  Accumulator,  ///< `reduce T r<>`
  VariableOutput,  ///< `vout T r<>`
  Scatter,  ///< `out T r[]`, `out T r[][]`
  Iterator,  ///< `iter T i<>`
  Spec,  ///< `spec T c`: a bool, int, uint or float whose value makes a variant
};

/// How an element input whose shape is not the domain's is read.
enum class Fit : std::uint8_t {
  Same,  ///< it has the domain's extents, or 1 where it repeats
  Stretched,  ///< its extents divide the domain's: each element serves several of these in a row
  Strided,  ///< its extents are multiples of the domain's: the first of several elements is read
};

/// What a scatter output does with the element that it holds and the value that comes.
enum class ScatterOp : std::uint8_t { Store, Add, Min, Max };

/// What a gather gives for an index outside its stream.
enum class Boundary : std::uint8_t { Clamp, Wrap, Mirror, Border };

/// One step of a condition over Spec parameters, for a machine with a stack: Spec and Literal push a
/// value of 32 bits, Not replaces the top, the others replace the two on top. `scalar` is the type of
/// the operands. Numbers are int or uint in arithmetic, which wraps.
// clang-format off
enum class ConditionOp : std::uint8_t {
  Spec, Literal, Not, And, Or, BitAnd, BitOr, BitXor, Add, Sub, Mul,
  Less, LessEqual, Greater, GreaterEqual, Equal, NotEqual,
};
// clang-format on
/// Spec parameters of one kernel, and values on the stack at once, at most.
inline constexpr std::size_t maxSpecs = 8;
inline constexpr std::size_t deepestCondition = 32;
struct ConditionStep {
  ConditionOp op;
  Scalar scalar;
  std::uint32_t value = 0;  ///< Spec: number of the parameter among those; Literal: its bits
};

/// When a kernel needs a stream: a condition of no steps is always true.
struct Condition {
  std::span<const ConditionStep> steps = {};
  std::string_view text = {};  ///< as the .sk file would write it, for messages
};

/// Where a plane lies that shares a texture with others (Plan::bundles).
struct Layer {
  std::int8_t bundle = -1;  ///< -1: it has a texture of its own
  std::uint8_t layer = 0;
  std::uint8_t count = 1;  ///< planes in the bundle
};

struct Parameter {
  std::string_view name;  ///< as declared, for messages
  std::string_view symbol;  ///< suffix of the assembler's names for it (a GLSL-safe name that begins
      ///< with a letter: GLSL reserves names with two underscores)
  Role role;
  const Element* element;  ///< as the body has it
  const Element* held =
      nullptr;  ///< inputs, outputs and gathers: what the stream holds, where that is floats
  ///< in the place of the element's doubles
  std::uint8_t rank = 0;  ///< gathers and scatter outputs: 1 to 4; else 0
  Boundary boundary = Boundary::Clamp;  ///< gathers
  std::string_view border = {};  ///< gathers with Boundary::Border: a GLSL constant expression
  std::string_view identity = {};  ///< accumulators: a GLSL constant expression; empty if none
  ScatterOp scatter = ScatterOp::Store;  ///< scatter outputs
  std::int32_t pushes = -1;  ///< variable and scatter outputs: calls of sk_push_p() or sk_put_p() by one
      ///< element at most; -1 if unknown
  bool usesIndex = false;  ///< the body calls sk_index_p()
  bool usesExtent = false;  ///< the body calls sk_extent_p()
  bool usesAt = false;  ///< the body calls sk_at_p()
  bool usesNear = false;  ///< the body calls sk_near_p()
  bool usesSample = false;  ///< the body calls sk_sample_p()
  bool filter = false;  ///< gathers: sk_sample_p() may leave the interpolation to the device
  std::int32_t reach = -1;  ///< largest |offset| of its sk_near_p() calls; -1 if not constant
  Condition neededIf = {};  ///< inputs, outputs, gathers: where it is false, the stream may be left out
  std::uint8_t firstPlane = 0;  ///< outputs of a pass that writes only some planes: the first,
  std::uint8_t planeCount = 0;  ///< and how many; 0 is all of them
  std::span<const Layer> layers = {};  ///< one a plane; empty if none is in a bundle
};

/// What the stream of a parameter holds.
constexpr const Element& heldBy(const Parameter& parameter) {
  return parameter.held != nullptr ? *parameter.held : *parameter.element;
}

/// A function that devices get wrong, or each in its own way. Bodies call it by its name in small letters
/// with `sk_` in front, and the assembler defines it (assemble/glsl/intrinsics.hpp).
/// Those up to Pow are functions of doubles, too (assemble/glsl/double_intrinsics.hpp).
// clang-format off
enum class Intrinsic : std::uint8_t {
  Sin, Cos, Tan, Asin, Acos, Atan, Atan2, Sinh, Cosh, Tanh, Asinh, Acosh, Atanh,
  Exp, Exp2, Log, Log2, Log10, Pow,
  Min, Max, Clamp, Saturate, Fract, Mod, Fmod, Mix, Step, Smoothstep, Sign, Isnan, Isinf,
  Length, Distance, Normalize,
};
// clang-format on
struct IntrinsicUse {
  Intrinsic intrinsic;
  std::uint8_t widths;  ///< bit n - 1 is set where it is called with floats of n components
  bool ofDouble = false;  ///< it is called with one double
};

struct Plan;
struct Kernel;

/// A function of one float that a table of its values may stand for. Bodies call it `sk_table_NAME(x)`, which the
/// assembler defines as either (assemble/glsl/tables.hpp).
struct Table {
  std::string_view function;  ///< qualified, for messages
  TableRange range;
  Interpolation interpolation;
  const Kernel* values;  ///< computes it: the table is made of what its native code gives in double
};
struct TableUse {
  const Table* table;
  std::string_view name;  ///< of the function in the body
};

/// A kernel. Its GLSL entry function takes, in order, every Uniform, Iterator, Spec, Input (by value) and
/// Output (as `out`) parameter; gathers, variable outputs and scatter outputs are no parameters of it.
struct Kernel {
  std::string_view name;  ///< qualified, for messages: "heat::diffuse"
  std::string_view entry;  ///< name of the entry function in `body`
  std::string_view declarations;  ///< structs, and the constants that Parameter::border and identity
      ///< name, with #line directives; empty if none
  std::string_view body;  ///< other constants, and functions, with #line directives
  std::span<const Parameter> parameters;  ///< in the order of the declaration
  std::span<const std::string_view> sources;  ///< file of source string number i + 1 in #line
  bool usesIndex = false;  ///< the body calls sk_index()
  bool usesExtent = false;  ///< the body calls sk_extent()
  bool usesLoops = false;  ///< the body has a loop: main() then leaves the helper invocations that
      ///< GPUs run beside the domain, where what they read might never end it
  bool usesDoubles = false;  ///< declarations or body speak of sk_double
  bool usesExactSums = false;  ///< the body has floats that no driver may simplify: sk_precise, sk_keep()
  std::span<const IntrinsicUse> intrinsics = {};  ///< those that declarations or body call
  const Plan* plans = nullptr;  ///< for devices that cannot run it in one pass, most generous first
  std::uint8_t planCount = 0;
  CallOptions options = {};  ///< what its declaration chooses, where a call does not
  const Kernel* half = nullptr;  ///< the form that rounds every float to half; null where there is none
  const Kernel* wide = nullptr;  ///< the form that computes in doubles what this one does in floats; likewise
  std::string_view whyNotHalf = {}, whyNotWide = {};  ///< where it computes floats, yet has no such form
  std::span<const TableUse> tables = {};  ///< whose functions the body calls
  bool drawn =
      true;  ///< whether fragment programs may run it; false where skc was asked for other targets alone
  bool dispatched = true;  ///< whether compute programs may
  const native::Code* code =
      nullptr;  ///< what skc compiled for it (sk/native/code.hpp); null without native code
};

/// What a parameter of a pass is given: an argument of the whole kernel, or a temporary.
struct PassOperand {
  bool isTemporary;
  std::uint8_t index;  ///< into the whole kernel's parameters, or into Plan::temporaries
};

struct Pass {
  Kernel kernel;
  std::span<const PassOperand> operands;  ///< one a parameter
};

/// A plane of an argument of the whole kernel.
struct ArgumentPlane {
  std::uint8_t argument, plane;
};

/// Planes of one texel format that are copied to the layers of an array texture before the passes run;
/// their programs read them there, through one texture unit.
struct Bundle {
  Scalar scalar;
  std::uint8_t width;
  std::span<const ArgumentPlane> layers;
};

/// A kernel as several passes, for devices that write and read so many planes in one. Every pass runs
/// over the kernel's domain. No pass reads what a pass writes but temporaries.
struct Plan {
  std::uint8_t drawBuffers;
  std::uint8_t textureUnits;
  std::span<const Element* const> temporaries;
  std::span<const Bundle> bundles;
  std::span<const Pass> passes;
};

struct CompensatedReduction;
struct WideReduction;
struct ExactSum;

/// Elements, or partial results, that a run folds one after the other, at most: as many as exact sums have room for.
inline constexpr int longestRun = 32;

/// What a sum of floats adds for each element, where the runtime can add it itself: one input, or the product of two. Of an
/// exact sum it may be a kernel instead, which has all parameters of the fold but accumulators, and then Outputs of one float each:
/// one for each term, or, where the sum is one of products, two, its factors. A term that an element does not add is -0.
struct SumTerm {
  std::span<const std::uint8_t> factors = {};  ///< parameters of the fold: Inputs of one float
  const Kernel* kernel = nullptr;  ///< where there are no factors
};

/// A reduction. `fold` is a kernel whose entry takes every Input by value and every Accumulator as `inout`,
/// among its other parameters, and folds an element into the accumulators. `combine` is one of the same
/// kind: its Inputs, as many as `fold` has Accumulators and of their types, are the accumulators of a later
/// run of elements, which it folds into those of an earlier one. It uses no index, and may be `fold` itself.
struct Reduction {
  Kernel fold;
  Kernel combine;
  std::span<const std::uint8_t> combineOperands;  ///< one a parameter of `combine`: that of `fold` whose
      ///< argument it gets; nobody looks at those of Inputs and Accumulators
  std::string_view addition =
      {};  ///< functions that `fold.body` lacks in order to call the entry of `combine`, too;
  ///< empty where they are the same, or no program can hold both
  bool seeded;  ///< a run may start from its first elements, taken as the accumulators
      ///< (they have the same types); else it starts from the identities, which
      ///< then all exist
  const CompensatedReduction* compensated = nullptr;  ///< null where it sums no floats
  const Reduction* half = nullptr;  ///< its forms for other precisions, as those of Kernel
  const WideReduction* wide = nullptr;
  std::span<const ExactSum> exact = {};  ///< one for each scalar of the accumulators that is a sum of floats
  bool commutative = false;  ///< elements may be folded in any order: by operators that are known
  SumTerm term = {};  ///< its factors, where it does nothing but sum such a term to one float
};

/// A reduction whose accumulators are doubles. `finish` takes them as Inputs and has the results as Outputs, which
/// hold floats.
struct WideReduction {
  Reduction reduction;
  Kernel finish;
};

/// A sum of floats: an accumulator, or a member of one.
struct CompensatedSum {
  std::uint8_t accumulator;  ///< a parameter of the plain fold
  std::uint32_t offset;  ///< bytes from the accumulator's start in host memory
};

/// A reduction that also sums what its sums of floats lose by rounding: it has one more accumulator for each of `sums`,
/// after all parameters of the plain fold, in this order. `finish` has as Inputs the accumulators that have sums, each
/// once and in their order, then what each sum has lost, and as Outputs these accumulators with both added.
struct CompensatedReduction {
  Reduction reduction;
  Kernel finish;
  std::span<const CompensatedSum> sums;
  bool inDoubles =
      false;  ///< the plain form in doubles serves, too: they hold its terms, each an input or a product of two
};

/// A form of a reduction that adds without rounding what one scalar of an accumulator sums. The fold of `reduction` has all
/// parameters of the plain one but accumulators, then accumulators of its own. `finish` takes the accumulator as
/// it is and these, and gives it with the rounded sum in that scalar's place.
struct ExactSum {
  Reduction reduction;
  Kernel finish;
  std::uint8_t accumulator;  ///< a parameter of the plain fold
  std::uint32_t offset = 0;  ///< of the scalar: bytes from the accumulator's start in host memory
  bool ofProducts = false;  ///< its terms are products of two floats, which are added as they are
  SumTerm term = {};  ///< null where an element may add any number of terms
};

}  // namespace sk::program
