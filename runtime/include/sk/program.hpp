// SPDX-License-Identifier: MIT
//
// Descriptors: constant, typed data about a compiled .sk file. `skc` writes them to FILE.sk.cpp; the
// assembler and the runtime read them. They are the whole contract between compiler and runtime: nothing is
// parsed out of GLSL text, and neither side includes the other.
//
// A kernel's GLSL has two parts, both in the common subset of GLSL 3.30, ESSL 3.00 and later: declarations
// (structs and constants) and a body (plain functions). The assembler inserts its own uniforms and functions
// between them, because they use the structs and the body uses them. The body accesses streams only through
// these functions; `p` is Parameter::symbol:
//
//   ivec4 sk_index()           index of the current element in the domain, x fastest
//   ivec4 sk_index_p()         index of the current element in element parameter p   (usesIndex)
//   ivec4 sk_extent_p()        shape of p's stream, x fastest, missing dimensions 1  (usesExtent)
//   T     sk_at_p(ivecN i)     element of gather p at i; N is its rank, `int` if 1   (usesAt)
//   T     sk_near_p(ivecN d)   element of gather p at the current index plus d       (usesNear)
//   T     sk_sample_p(vecN x)  gather p of floats, interpolated at x; `float` if 1   (usesSample)
//   ivec4 sk_extent()          shape of the domain, where no output has it           (usesExtent)
//                              (in a reduction, the domain of the elements it folds)
//   void  sk_push_p(T v)       appends v to variable output p
//   void  sk_put_p(ivecN i, T v)   stores v to element i of scatter output p, or combines them as
//                              Parameter::scatter says; does nothing if i is out of bounds
//
//   float sk_table_f(float x)  function f of the body, or its table's value at x         (Kernel::tables)
//
// Doubles have the types sk_double, sk_double2, sk_double3 and sk_double4, with members x, y, z and w. A body
// computes with them through functions of one sk_double each, which the assembler defines for native doubles
// or for pairs of floats: see assemble/glsl/double_intrinsics.hpp. Integers of 64 bits likewise have the types sk_long to sk_long4 and
// sk_ulong to sk_ulong4, and functions of one of them (assemble/glsl/longs.hpp).
//
// Every name that the assembler declares begins with `sk_`; users' names never do.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string_view>

#include "sk/exact_digits.hpp"
#include "sk/options.hpp"
#include "sk/table.hpp"

namespace sk::native {
struct Code;
}  // namespace sk::native

namespace sk::program {

/// Component type of a field in host memory: Bool is a byte of 0 or 1; types.hpp defines Half and the
/// normalized types. GLSL computes Char, Uchar, Short and Ushort as int, and Half and the normalized types as
/// float. Each has its own texture format.
enum class Scalar : std::uint8_t {
  Bool,
  Int,
  Uint,
  Float,
  Double,
  Long,
  Ulong,
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

/// One plane of an element, stored in one texel of one texture: a scalar, a vector, a row of a matrix, or up
/// to two components of a vector of doubles.
struct Field {
  std::string_view path;  ///< member path in GLSL ("t", "a.b"); empty if the element is not a struct
  Scalar scalar;
  std::uint8_t width;  ///< components, 1 to 4
  std::uint32_t offset;  ///< bytes from the element's start in host memory
  std::int8_t part = -1;  ///< which row, or which pair of components, of `path`; -1: all of it
};

/// An element type: its spellings and its planes, in declaration order.
struct Element {
  std::string_view name;  ///< spelling in the .sk file, for messages: "float2", "Hit"
  std::string_view glsl;  ///< spelling in GLSL: "vec2", "Hit"
  std::uint32_t size;  ///< sizeof on the host
  std::span<const Field> fields;  ///< at least 1
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

/// How an element input is read if its shape differs from the domain's.
enum class Fit : std::uint8_t {
  Same,  ///< has the domain's extents, or extent 1, which is broadcast
  Stretched,  ///< its extents divide the domain's: each element serves several consecutive indices
  Strided,  ///< its extents are multiples of the domain's: the first element of each group is read
  StretchedOrStrided,  ///< each dimension on its own: Stretched if its extent divides the domain's, else Strided
};

/// How a scatter output combines a stored element with a new value.
enum class ScatterOp : std::uint8_t { Store, Add, Min, Max };

/// The value of a gather at an index out of bounds.
enum class Boundary : std::uint8_t { Clamp, Wrap, Mirror, Border };

/// One step of a condition over Spec parameters, for a stack machine: Spec and Literal push a value of 32
/// bits, Not replaces the top, and all others replace the top two. `scalar` is the operands' type. Arithmetic
/// is on int or uint and wraps.
// clang-format off
enum class ConditionOp : std::uint8_t {
  Spec, Literal, Not, And, Or, BitAnd, BitOr, BitXor, Add, Sub, Mul,
  Less, LessEqual, Greater, GreaterEqual, Equal, NotEqual,
};
// clang-format on
/// Limits: Spec parameters of a kernel, and values on the stack.
inline constexpr std::size_t maxSpecs = 8;
inline constexpr std::size_t deepestCondition = 32;
struct ConditionStep {
  ConditionOp op;
  Scalar scalar;
  std::uint32_t value = 0;  ///< Spec: index among the Spec parameters; Literal: its bits
};

/// When a kernel needs a stream. A condition without steps is always true.
struct Condition {
  std::span<const ConditionStep> steps = {};
  std::string_view text = {};  ///< its source text, for messages
};

/// The location of a plane that shares a texture with others (Plan::stacks).
struct Layer {
  std::int8_t stack = -1;  ///< -1: the plane has its own texture
  std::uint8_t layer = 0;
  std::uint8_t count = 1;  ///< planes in the stack
};

/// A number of elements: a constant plus multiples of the values of the kernel's Spec parameters, in their order.
struct Distance {
  std::int64_t constant = 0;
  std::array<std::int16_t, maxSpecs> perSpec = {};
};

/// How far from the index of the element that it computes a kernel reads a gather, in one dimension. An index that a
/// boundary mode brings inside counts as what it was before.
struct Reach {
  enum class Kind : std::uint8_t {
    Near,  ///< at most `below` before the element and `above` after it; a negative distance means 0
    Computed,  ///< at an index that skc cannot bound
    Whole,  ///< anywhere: at indices that do not depend on the element
  };
  std::uint8_t dimension = 0;  ///< 0 is x
  Kind kind = Kind::Near;
  Distance below = {}, above = {};
  /// Near is what [[halo]] promises. If the gather has another extent than the domain in this dimension, the distances count
  /// from the index of the gather's element in which the center of the kernel's element lies, when both are scaled to one
  /// length; in dimensions that the domain does not have, nothing is promised.
  bool isPromised = false;
};

/// The values that an author promises by [[range(lo, hi)]]: from `low` to `high`, either of which may be infinite. NaN is none of
/// them. The ends are those of the text; whoever compares them with a value rounds them to its type first.
struct ValueRange {
  static constexpr double infinity = std::numeric_limits<double>::infinity();
  double low, high;
  constexpr bool operator==(const ValueRange&) const = default;
};

struct Parameter {
  std::string_view name;  ///< as declared, for messages
  /// Suffix of the names that the assembler declares for it: a GLSL-safe name that begins with a letter,
  /// because GLSL reserves names with two underscores.
  std::string_view symbol;
  Role role;
  const Element* element;  ///< the type in the body
  /// Inputs, outputs and gathers: the stream's element type, if it has floats for the doubles of `element`.
  const Element* held = nullptr;
  std::uint8_t rank = 0;  ///< gathers and scatter outputs: 1 to 4; else 0
  Boundary boundary = Boundary::Clamp;  ///< gathers
  std::string_view border = {};  ///< gathers with Boundary::Border: a GLSL constant expression
  std::string_view identity = {};  ///< accumulators: a GLSL constant expression; empty if none
  ScatterOp scatter = ScatterOp::Store;  ///< scatter outputs
  /// Variable and scatter outputs: the most calls of sk_push_p() or sk_put_p() by one element; -1 if unknown.
  std::int32_t pushes = -1;
  bool usesIndex = false;  ///< the body calls sk_index_p()
  bool usesExtent = false;  ///< the body calls sk_extent_p()
  bool usesAt = false;  ///< the body calls sk_at_p()
  bool usesNear = false;  ///< the body calls sk_near_p()
  bool usesSample = false;  ///< the body calls sk_sample_p()
  bool filter = false;  ///< gathers: sk_sample_p() may use the device's interpolation
  std::int32_t reach = -1;  ///< largest |offset| of its sk_near_p() calls; -1 if not constant
  Condition neededIf = {};  ///< inputs, outputs, gathers: if false, the stream may be omitted
  std::uint8_t firstPlane = 0;  ///< outputs of a pass that writes only some planes: the first one,
  std::uint8_t planeCount = 0;  ///< and how many; 0 means all
  std::span<const Layer> layers = {};  ///< one per plane; empty if no plane is in a stack
  /// Gathers of declared kernels: at least one for each dimension, x first. If Spec parameters count, there may be several,
  /// of which the farthest holds. Empty if nothing is known, as in code that an older skc has generated.
  std::span<const Reach> halo = {};
  /// Bit p is set if what `halo` says without a promise holds only for calls that give parameter p the domain's extents.
  std::uint64_t haloShapes = 0;
  std::optional<ValueRange> range = {};  ///< declared kernels: of every number of an element
};

/// The element type of a parameter's stream.
constexpr const Element& heldBy(const Parameter& parameter) {
  return parameter.held != nullptr ? *parameter.held : *parameter.element;
}

/// A function that devices implement incorrectly or inconsistently. Bodies call it by its lower-case name
/// with the prefix `sk_`; the assembler defines it (assemble/glsl/intrinsics.hpp). Functions up to Pow exist
/// for doubles, too (assemble/glsl/double_intrinsics.hpp).
// clang-format off
enum class Intrinsic : std::uint8_t {
  Sin, Cos, Tan, Asin, Acos, Atan, Atan2, Sinh, Cosh, Tanh, Asinh, Acosh, Atanh,
  Exp, Exp2, Log, Log2, Log10, Hypot, Log1p, Expm1, Cbrt, Erf, Erfc, Pow,
  Min, Max, Clamp, Saturate, Fract, Mod, Fmod, Mix, Step, Smoothstep, Sign, Isnan, Isinf,
  Length, Distance, Normalize,
};
// clang-format on
struct IntrinsicUse {
  Intrinsic intrinsic;
  std::uint8_t widths;  ///< bit n - 1 is set if it is called with floats of n components
  bool ofDouble = false;  ///< it is called with one double
};

/// What the body of a kernel defines beside its entry, for programs that hold the bodies of several kernels. A body begins with
/// functions of skc's own, whose text is the same wherever a kernel needs them; functions and constants of the .sk file follow.
struct Definition {
  std::string_view name = {};  ///< of a function or constant of the .sk file; empty: skc's own
  std::uint32_t bytes = 0;  ///< skc's own: the length of the text
};

struct Plan;
struct Kernel;
struct AssertionCheck;

/// A function of one float that a table may replace. Bodies call it `sk_table_NAME(x)`, which the assembler
/// defines as the function or as a lookup (assemble/glsl/tables.hpp).
struct Table {
  std::string_view function;  ///< qualified, for messages
  TableRange range;
  Interpolation interpolation;
  const Kernel* values;  ///< computes the function; its native code fills the table, in double
};
struct TableUse {
  const Table* table;
  std::string_view name;  ///< the function's name in the body
};

/// A variant of a kernel for one value of a Spec parameter, without the loops that it bounds.
struct UnrolledKernel {
  std::uint8_t spec;  ///< the parameter's number among Spec parameters
  std::uint32_t value;  ///< its bits
  const Kernel* kernel;
};

/// A kernel. Its GLSL entry function has a parameter for every Uniform, Iterator, Spec, Input (by value) and
/// Output (as `out`), in order; gathers, variable outputs and scatter outputs are not parameters.
struct Kernel {
  std::string_view name;  ///< qualified, for messages: "heat::diffuse"
  std::string_view entry;  ///< name of the entry function in `body`
  /// Structs, and the constants that Parameter::border and identity use, with #line directives; may be empty.
  std::string_view declarations;
  std::string_view
      body;  ///< other constants, and functions, with #line directives and marks (sk/arithmetic_marks.hpp)
  std::uint32_t weight =
      0;  ///< operations to compile, in the body and in the library functions that it calls
  std::span<const Parameter> parameters;  ///< in order of declaration
  std::span<const std::string_view> sources;  ///< source file of string number i + 1 in #line
  bool usesIndex = false;  ///< the body calls sk_index()
  bool usesExtent = false;  ///< the body calls sk_extent()
  /// The body has a loop that may take many iterations: its number depends on data, or is large. main() then returns early in
  /// helper invocations outside the domain, where undefined inputs might keep the loop from ending, no texel is packed, and
  /// devices that end long loops check that they have not (assemble/glsl/loop_check.glsl).
  bool usesLoops = false;
  bool usesDoubles = false;  ///< declarations or body use sk_double
  bool usesLongs = false;  ///< declarations or body use sk_long or sk_ulong
  bool usesExactSums = false;  ///< the body has floats that no driver may simplify: sk_precise, sk_keep()
  std::span<const IntrinsicUse> intrinsics = {};  ///< the intrinsics that declarations or body call
  /// What the body defines, in the order of its text; empty in code that an older skc has generated.
  std::span<const Definition> definitions = {};
  const Plan* plans = nullptr;  ///< for devices that cannot run it in one pass, least restrictive first
  std::uint8_t planCount = 0;
  CallOptions options = {};  ///< the declaration's choices, which a call may override
  const Kernel* half = nullptr;  ///< the variant that rounds every float to half; null if there is none
  const Kernel* wide = nullptr;  ///< the variant that computes in doubles for floats; or null
  std::string_view whyNotHalf = {}, whyNotWide = {};  ///< why a kernel with floats lacks that variant
  std::span<const TableUse> tables = {};  ///< of the functions that the body calls
  std::span<const UnrolledKernel> unrolled = {};  ///< computes the same, in float
  bool drawn = true;  ///< fragment programs may run it; false if skc was asked for other targets only
  bool dispatched = true;  ///< compute programs may run it
  const native::Code* code = nullptr;  ///< its native code (sk/native/code.hpp); null if there is none
  const AssertionCheck* assertions = nullptr;  ///< null if it asserts nothing
};

/// A condition that `assert` states in a kernel, or in a function that it calls.
struct Assertion {
  std::string_view file;  ///< the name of the .sk file, without its folders
  std::uint32_t line;
  std::string_view text;  ///< the condition as in the program, on one line
};

/// Finds the elements for which assertions of a kernel or a fold fail. The last parameter of `check` is an Output of one int,
/// which becomes 0, or the number of the first assertion that fails, from 1 on.
struct AssertionCheck {
  Kernel check;
  std::span<const std::uint8_t>
      operands;  ///< for each of its other parameters, the one whose argument it gets
  std::span<const Assertion> assertions;  ///< by number; a file's kernels share them
};

/// The operand of a parameter of a pass: an argument of the whole kernel, or a temporary.
struct PassOperand {
  bool isTemporary;
  std::uint8_t index;  ///< into the whole kernel's parameters, or into Plan::temporaries
};

struct Pass {
  Kernel kernel;
  std::span<const PassOperand> operands;  ///< one per parameter
};

/// One plane of an argument of the whole kernel.
struct ArgumentPlane {
  std::uint8_t argument, plane;
};

/// Planes of one texel format that are copied to the layers of an array texture before the passes run; their
/// programs read all of them through one texture unit.
struct Stack {
  Scalar scalar;
  std::uint8_t width;
  std::span<const ArgumentPlane> layers;
};

/// A kernel split into several passes, for devices with limits of at least `drawBuffers` planes written and
/// `textureUnits` planes read per pass. Every pass runs over the kernel's domain. A pass reads no output of
/// another pass, only temporaries.
struct Plan {
  std::uint8_t drawBuffers;
  std::uint8_t textureUnits;
  std::span<const Element* const> temporaries;
  std::span<const Stack> stacks;
  std::span<const Pass> passes;
};

struct CompensatedReduction;
struct FoldParts;
struct WideReduction;
struct ExactSum;
struct Reduction;

/// A kernel of a pipeline, and its arguments: those of the pipeline, or local streams, which are the temporaries.
struct PipelinePass {
  const Kernel* kernel;  ///< the fold of a reduction or a scan
  const Reduction* reduction = nullptr;
  bool isScan = false;
  bool isOverDomain =
      true;  ///< runs over the pipeline's domain; false: over the one that its arguments define
  std::span<const PassOperand> operands = {};  ///< one per parameter
};

struct PipelineParameter {
  std::string_view name;  ///< as declared, for messages
  Role role;
};

/// Kernels that are called in order, with streams between them that nothing else sees. A local stream is an output of the
/// passes that write it, and has the shape of the pipeline's domain: that of its outputs or, if it has none, of its inputs.
struct Pipeline {
  std::string_view name;  ///< qualified, for messages
  std::span<const PipelineParameter> parameters;  ///< in order of declaration
  std::span<const std::string_view> locals;  ///< their names
  std::span<const PipelinePass> passes;
};

/// Most elements, or partial results, that a run folds one after the other: as many terms as the digits of an exact sum
/// have room for.
inline constexpr int longestRun = DigitLoad<std::int32_t>().room();
/// The same for a run that continues from accumulators that were combined.
inline constexpr int longestContinuedRun = DigitLoad<std::int32_t>::combined().room();
static_assert(longestRun == 32 && longestContinuedRun == 30);

/// The term that a sum of floats adds for each element, if the runtime can add it itself: one input, or the
/// product of two. For an exact sum, it may be a kernel with all parameters of the fold except accumulators and Outputs,
/// followed by Outputs of one float: one per term, or two per term, its factors, in a sum of products. A term
/// that an element does not add is -0.
struct SumTerm {
  std::span<const std::uint8_t> factors = {};  ///< parameters of the fold: Inputs of one float
  const Kernel* kernel = nullptr;  ///< used if there are no factors
};

/// A reduction. `fold` is a kernel whose entry takes every Input by value and every Accumulator as `inout`,
/// and folds an element into the accumulators. `combine` is a kernel of the same kind: its Inputs correspond
/// to the Accumulators of `fold` in number and type. They are the result of a later run of elements, which it
/// folds into the result of an earlier run. It uses no index, and may be `fold` itself.
///
/// A kernel with folded outputs is a reduction whose fold has Outputs, too. Whoever calls the fold may ignore
/// these, as they do not depend on the accumulators.
struct Reduction {
  Kernel fold;
  Kernel combine;
  /// For each parameter of `combine`: the parameter of `fold` whose argument it gets. Entries of Inputs and
  /// Accumulators are ignored; empty if there are no others.
  std::span<const std::uint8_t> combineOperands;
  /// Functions that `fold.body` needs in order to call the entry of `combine`, too; empty if the kernels are
  /// the same, or if no program can contain both.
  std::string_view addition = {};
  /// A run may start from its first elements, because inputs and accumulators have the same types; otherwise
  /// it starts from the identities, all of which exist.
  bool seeded;
  const CompensatedReduction* compensated = nullptr;  ///< null if it sums no floats
  const Reduction* half = nullptr;  ///< variants for other precisions, as in Kernel
  const WideReduction* wide = nullptr;
  std::span<const ExactSum> exact = {};  ///< one for each scalar of the accumulators that is a sum of floats
  bool commutative = false;  ///< elements may be folded in any order, because its operators are known
  SumTerm term = {};  ///< has factors if the reduction only sums such a term to one float
  const FoldParts* parts = nullptr;  ///< set if the fold has Outputs
};

/// The parts of a kernel with folded outputs, for devices that cannot store elements while they fold. Operands
/// are, for each parameter of a part, the parameter of the fold whose argument it gets.
struct FoldParts {
  /// For native code: the whole, whose sums of floats are doubles. It is as good as compensated sums. Null if there is
  /// none.
  const WideReduction* inDoubles = nullptr;
  Kernel map;  ///< computes the Outputs
  std::span<const std::uint8_t> mapOperands;
  /// Folds the same, but has some of the Outputs as Inputs: the results of `map`. Null if there is none.
  const Reduction* after = nullptr;
  std::span<const std::uint8_t> afterOperands = {};
};

/// A reduction whose accumulators are doubles. `finish` has the accumulators as Inputs and the results, in
/// floats, as Outputs.
struct WideReduction {
  Reduction reduction;
  Kernel finish;
};

/// A sum of floats: an accumulator, or a member of one.
struct CompensatedSum {
  std::uint8_t accumulator;  ///< a parameter of the plain fold
  std::uint32_t offset;  ///< bytes from the accumulator's start in host memory
};

/// A reduction that also sums the rounding errors of its sums of floats: for each of `sums`, in order, it has
/// one more accumulator after all parameters of the plain fold. The Inputs of `finish` are the accumulators
/// that have sums, each once and in order, then the rounding error of each sum; its Outputs are these
/// accumulators with the errors added.
struct CompensatedReduction {
  Reduction reduction;
  Kernel finish;
  std::span<const CompensatedSum> sums;
  /// The plain variant in doubles is as good: doubles represent its terms exactly, each an input, an element of a gather,
  /// or a product of two such floats.
  bool addsDoubles = false;
};

/// A variant of a reduction that adds one scalar of an accumulator without rounding. The fold of `reduction`
/// has all parameters of the plain fold except accumulators and Outputs, then its own accumulators. `finish` takes the
/// plain accumulator and these, and returns the plain accumulator with the rounded sum in that scalar.
struct ExactSum {
  Reduction reduction;
  Kernel finish;
  std::uint8_t accumulator;  ///< a parameter of the plain fold
  std::uint32_t offset = 0;  ///< of the scalar: bytes from the accumulator's start in host memory
  bool ofProducts = false;  ///< its terms are products of two floats, which are added without rounding
  SumTerm term = {};  ///< empty if an element may add any number of terms
};

}  // namespace sk::program
