// SPDX-License-Identifier: MIT
//
// The intermediate representation: small, typed, structured. What it means:
//
//   * A Module holds struct types, constants, functions and kernels. Everything is named by an
//     index into the table that owns it (StructId, FunctionId ...), never by pointer.
//   * An expression is a tree with one parent, has a type and no side effect: evaluating it twice,
//     or not at all, changes nothing but time. Effects live in statements only. `&&`, `||` and `?:`
//     evaluate their right operands only when needed, as in C++.
//   * No conversion is implicit: the operands of a binary operator have one type, except that one
//     of them may be a scalar of the other's component type (GLSL's scalar-vector operators; not
//     for comparisons). A shift count is an integer, or a vector of them.
//     Comparisons of vectors are componentwise and give a bool vector.
//   * Narrow scalars (half, char ... snorm16) and their vectors are storage types: no operator
//     takes them but Convert, Select, Construct, Swizzle and Index. A Convert to one quantises, as
//     scalar_operations.hpp says; a Convert to its arithmetic type (arithmeticScalar) changes no value.
//   * Matrices are lists of rows: an Index gives a row, Construct takes all of them. They support
//     + - * == !=, * and / with a scalar, and * with a vector on the right, which is a column.
//   * A place (an lvalue: left side, or argument of an InOut parameter) is a VarRef of a mutable
//     variable, or a Member, Index or Swizzle without repeated components of a place. A statement evaluates its
//     expressions first, those in the indices of its places too, then changes variables.
//   * One loop node keeps the shape that its author wrote. `continue` goes to `step`, then `cond`.
//   * A function's parameters are its first `parameterCount` variables. `In` is a copy;
//     `InOut` copies in and out. The places that one call writes do not overlap, and none of their indices
//     reads a variable that the call writes: the order of copying out makes no difference.
//     `Gather`, `Element` and `AppendOutput` parameters stand for streams. They may only be used by stream
//     expressions (GatherRead, NeighborRead, Sample, IndexOf, ExtentOf), by stream statements (Push, Scatter)
//     if they are AppendOutputs, and as arguments; a VarRef may also read an Element.
//   * Each kernel has an entry function, with one variable per kernel parameter, in order. After
//     `specialize-gathers`, only entries have Gather or AppendOutput parameters, every StreamRef
//     names a kernel parameter, and no two kernels share a function; functions that no kernel reaches
//     are ignored from then on.
//   * A reduce has inputs and accumulators. A kernel with accumulators is a reduce that has outputs, too, which do
//     not depend on its accumulators. Partial results are combined by a reduce whose inputs have the
//     types of its accumulators, and which does not ask where an element is.
//   * A kernel that some target cannot run in one pass has plans after `split-kernels`. The kernels
//     of their passes are in the module like all others.
//   * After `predicate`, which only native code runs, a function computes several elements at once, one per
//     lane. Control flow is uniform: conditions are uniform, or ask AnyLane. What a single element does
//     depends on masks, which are bool variables. An entry may have one more parameter than its kernel:
//     a bool In that is true in the lanes that have an element.
//
// `validate` (validate.hpp) is this text made executable.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "ir/intrinsics.hpp"
#include "ir/plan.hpp"
#include "ir/type.hpp"
#include "support/loc.hpp"

namespace skc::ir {

using VarId = std::uint32_t;
using FunctionId = std::uint32_t;
using ConstantId = std::uint32_t;
using TableId = std::uint32_t;

// clang-format off: one node a line

// ---- expressions ------------------------------------------------------------------------------

struct Expr;
using ExprPtr = std::unique_ptr<Expr>;

/// A scalar; vectors of literals are Constructs. `bits` holds bool 0/1, int32, uint32 or float32 bits, for a narrow scalar the
/// bits of its arithmetic type, for a double the lower half. `high`: a double's upper half. `text`: the magnitude of the double nearest
/// to a float's text, 0 where the float itself is meant; wideValue() reads it.
struct Literal {
  std::uint32_t bits;
  std::uint32_t high = 0;
  double text = 0;

  /// The literal of a type of 64 bits.
  static Literal wide(std::uint64_t bits) {
    return {static_cast<std::uint32_t>(bits), static_cast<std::uint32_t>(bits >> 32)};
  }
  std::uint64_t wide() const { return std::uint64_t{high} << 32 | bits; }
};
struct VarRef { VarId var; };
struct ConstantRef { ConstantId constant; };

enum class UnaryOp : std::uint8_t { Negate, BitNot, LogicalNot };
struct Unary { UnaryOp op; ExprPtr operand; };   ///< LogicalNot of a bool vector is componentwise

enum class BinaryOp : std::uint8_t {
#define SKC_OPERATOR(Name, spelling, precedence, isAssociative, vectors, wide, condition) Name,
#include "ir/operators.def"
#undef SKC_OPERATOR
};
struct Binary { BinaryOp op; ExprPtr lhs, rhs; };

/// cond ? yes : no. A scalar condition evaluates one side; a bool vector selects by component.
struct Select { ExprPtr cond, yes, no; };
/// Changes the component type: C++'s conversion, `bool(x)` is `x != 0`. Same width.
struct Convert { ExprPtr operand; };
/// A vector from scalars and vectors whose components add up to its width, or from one scalar
/// (splat); a matrix from all its rows; a struct from all its members; an array from all its elements.
struct Construct { std::vector<ExprPtr> args; };
struct Swizzle { ExprPtr base; std::vector<std::uint8_t> components; };   ///< base: vector; 1 to 4 components
struct Member { ExprPtr base; std::uint32_t field; };
/// base is an array, vector or matrix, index an int or uint. An index outside an array is clamped.
struct Index { ExprPtr base, index; };
struct Call { FunctionId callee; std::vector<ExprPtr> args; };   ///< no InOut parameters, not void, prints nothing
struct IntrinsicCall { Intrinsic intrinsic; std::vector<ExprPtr> args; };

/// A stream: a variable of this function (Gather, Element or AppendOutput role), or, after
/// specialize-gathers, a parameter of the kernel. Domain (IndexOf and ExtentOf only) is the kernel's domain
/// itself, used for an output, a gather's current index, or an Element without a stream behind it.
struct StreamRef {
  enum class Space : std::uint8_t { Variable, KernelParameter, Domain };
  Space space;
  std::uint32_t id;
  bool operator==(const StreamRef&) const = default;
};
struct GatherRead { StreamRef stream; ExprPtr index; };       ///< int (rank 1), int2 .. int4; x fastest
struct NeighborRead { StreamRef stream; ExprPtr offset; };    ///< likewise
/// Linear interpolation of a gather of floats at a float (rank 1), float2 .. float4; x fastest. The result
/// has the element's arithmetic type.
struct Sample { StreamRef stream; ExprPtr position; };
struct IndexOf { StreamRef stream; };                         ///< int4
struct ExtentOf { StreamRef stream; };                        ///< int4

struct Expr {
  using Node = std::variant<Literal, VarRef, ConstantRef, Unary, Binary, Select, Convert, Construct,
                            Swizzle, Member, Index, Call, IntrinsicCall, GatherRead, NeighborRead,
                            Sample, IndexOf, ExtentOf>;
  Type type;
  Loc loc;
  Node node;
};

// ---- statements -------------------------------------------------------------------------------

struct Stmt;
using Block = std::vector<Stmt>;

struct Declare { VarId var; ExprPtr init; };                        ///< init may be null
struct Assign { ExprPtr place; std::optional<BinaryOp> op; ExprPtr value; };  ///< place (op)= value
/// Calls a function for its effect; `result` (may be null) is the lvalue that receives its value. The
/// argument of a Gather parameter, and of an Element parameter that stands for a stream, is a VarRef of this
/// function's own Gather or Element variable.
struct CallStmt { FunctionId callee; std::vector<ExprPtr> args; ExprPtr result; };
struct If { ExprPtr cond; Block then, otherwise; };
enum class LoopKind : std::uint8_t { For, While, DoWhile };
/// init; loop { (cond unless DoWhile); body; step; (cond if DoWhile) }. `init` and `step` are empty
/// unless For; a null cond is true. `init` declares variables that live as long as the loop.
struct Loop { LoopKind kind; Block init; ExprPtr cond; Block step; Block body; };
struct Case { std::vector<std::int64_t> values; bool isDefault = false; Block body; Loc loc; };
/// Cases fall through and share one scope, as in C++.
struct Switch { ExprPtr value; std::vector<Case> cases; };
struct Break {};
struct Continue {};
struct Return { ExprPtr value; };                                   ///< null in a void function
struct Scope { Block body; };

/// Appends an element to a variable output. Pushes by one element keep the order of execution, and precede
/// the pushes by later elements. `mask` is a bool that is true in the lanes that push; null, as it always is
/// before `predicate`, means all lanes.
struct Push { StreamRef stream; ExprPtr value; ExprPtr mask = nullptr; };
enum class ScatterOp : std::uint8_t { Store, Add, Min, Max };
/// Sets element `index` (int, int2 .. int4; x fastest) of a scatter output to `value`, or combines it with
/// `value`; an index outside has no effect. Order and mask are as in Push. Each output has one op.
struct Scatter { StreamRef stream; ScatterOp op; ExprPtr index, value; ExprPtr mask = nullptr; };

/// Prints values, which are integers of 32 or 64 bits, floats or doubles, by a format of C's printf. Only native code prints. Mask as in Push.
struct Print { std::string format; std::vector<ExprPtr> values; ExprPtr mask = nullptr; };

struct Stmt {
  using Node = std::variant<Declare, Assign, CallStmt, If, Loop, Switch, Break, Continue, Return, Scope,
                            Push, Scatter, Print>;
  Loc loc;
  Node node;
};

// clang-format on

// ---- declarations -----------------------------------------------------------------------------

enum class VarRole : std::uint8_t { Local, In, InOut, Element, Gather, AppendOutput };
struct Variable {
  std::string name;
  Type type;  ///< Gather, AppendOutput: the element type
  VarRole role = VarRole::Local;
  std::uint8_t rank = 0;  ///< Gather, and AppendOutput that is a scatter output: 1 to 4
  bool isConst = false;
  Loc loc;
};

struct Function {
  std::string name;  ///< as in the source, without namespaces
  Type result;  ///< may be void
  std::vector<Variable> variables;  ///< parameters first
  std::uint32_t parameterCount = 0;
  Block body;
  Loc loc;
  std::optional<TableId> table = {};  ///< the table that may replace a Call of it
  bool isLibrary = false;  ///< of the native library, with error bounds for the code as written, or of GLSL
};

/// A table of the values of a function that takes one float In and gives a float. tabulate sets `kernel` if a
/// kernel calls the function; it has one Input and one Output, and computes the function.
struct Table {
  std::string name;  ///< the function's name, without namespaces
  std::vector<std::string> scope;  ///< enclosing namespaces, outermost first
  float low, high;
  std::uint32_t intervals;
  bool isCubic;  ///< cubic interpolation, else linear
  std::optional<KernelId> kernel = {};
};

struct Constant {
  std::string name;
  Type type;
  ExprPtr value;
  Loc loc;
};

enum class ParamRole : std::uint8_t {
  Uniform,
  Input,
  Output,
  Gather,
  Accumulator,
  VariableOutput,
  Scatter,
  Iterator,
  Spec,
};
enum class Boundary : std::uint8_t { Clamp, Wrap, Mirror, Border };

/// The most Spec parameters of a kernel.
inline constexpr std::size_t mostSpecs = 8;

/// A number of elements: a constant plus multiples of the values of the kernel's Spec parameters, in their order.
struct Distance {
  std::int64_t constant = 0;
  std::array<std::int16_t, mostSpecs> perSpec = {};
  bool operator==(const Distance&) const = default;
};
/// How far from the index of the element that it computes a kernel reads a gather, in one dimension.
struct Reach {
  enum class Kind : std::uint8_t {
    Near,  ///< at most `below` before the element and `above` after it; a negative distance means 0
    Computed,  ///< at an index that no analysis bounds
    Whole,  ///< anywhere: at indices that do not depend on the element
  };
  std::uint8_t dimension = 0;  ///< 0 is x
  Kind kind = Kind::Near;
  Distance below = {}, above = {};
  bool isPromised = false;  ///< by [[halo]], because nothing is known
  bool operator==(const Reach&) const = default;
};

/// The values that the author promises: from `low` to `high`, either of which may be infinite. NaN is none of them.
struct ValueRange {
  double low, high;
  bool operator==(const ValueRange&) const = default;
};

struct KernelParam {
  std::string name;
  ParamRole role;
  Type type;  ///< element type
  std::optional<Type> held = {};  ///< the element type of the stream, if different: floats for doubles
  std::uint8_t rank = 0;  ///< Gather, Scatter
  Boundary boundary = Boundary::Clamp;  ///< Gather
  ExprPtr border;  ///< Gather with Border: constant expression
  bool filter = false;  ///< Gather: sampled by the device's own filter where possible
  ExprPtr identity;  ///< Accumulator: constant expression, or null
  std::uint32_t firstPlane = 0;  ///< Output of a pass that writes only some planes: the first
  std::uint32_t planeCount = 0;  ///< and their number; 0 means all planes
  Loc loc;
  ScatterOp scatter = ScatterOp::Store;  ///< Scatter: the op of all its statements
  std::int32_t pushes = -1;  ///< VariableOutput, Scatter: how many statements one element executes
      ///< at most; -1 if unknown
  /// Set by guard-streams: an expression of the entry's Spec variables that is false if the kernel does not
  /// need the stream, or null.
  ExprPtr neededIf = nullptr;
  /// Gathers of declared kernels, set by find-reach: at least one Reach for each dimension, x first. If Spec parameters
  /// count, there may be several, of which the farthest holds.
  std::vector<Reach> reach = {};
  /// `reach` holds if the parameters of these bits have the domain's extents.
  std::uint64_t reachShapes = 0;
  /// Gathers: [[halo(...)]], the distance for each dimension, x first, that no read exceeds; empty if nothing is promised.
  std::vector<std::int32_t> promise = {};
  /// [[range(lo, hi)]]: the range of every number of an element, before its ends are rounded to the type.
  std::optional<ValueRange> range = {};
};

/// A struct of parameters that belong together. C++ passes it as one argument; the IR's kernels have a parameter for each
/// member that they read.
struct BundleMember {
  std::string name;
  ParamRole role;  ///< Gather, Uniform or Spec; of a bundle within a bundle Uniform
  Type type;  ///< void for a bundle
  std::uint8_t rank = 0;  ///< of a Gather
  std::optional<std::uint32_t> bundle = {};  ///< its index in Module::bundleTypes, if it is one
};
struct BundleType {
  std::string name;  ///< without namespaces
  std::string arguments;  ///< of an instance of a template: "_2"
  std::vector<std::string> scope;  ///< enclosing namespaces, outermost first
  std::vector<BundleMember> members;
  Loc loc;
};

/// A bundle among a kernel's parameters: those from `first` on, which may be none, are named "bundle.member".
struct BundleParam {
  std::string name;
  std::uint32_t type;  ///< index in Module::bundleTypes
  std::uint32_t first, count;
};

/// The type of the elements that the parameter's stream holds.
inline Type heldType(const KernelParam& param) { return param.held.value_or(param.type); }

/// Components of an accumulator, or of a scalar, vector or matrix member of one.
struct AccumulatorPart {
  VarId accumulator;
  std::vector<std::uint32_t> members;  ///< path from the accumulator to the member
  Type type;  ///< of the member
  unsigned components;  ///< bit i: component i

  bool isWhole() const { return components == (1U << type.width) - 1; }
  bool isOfMember(const AccumulatorPart& other) const {
    return accumulator == other.accumulator && members == other.members;
  }
  bool overlaps(const AccumulatorPart& other) const {
    return isOfMember(other) && (components & other.components) != 0;
  }
};

/// An operator that folds: that of a compound assignment, && or ||; or Min or Max.
using FoldOp = std::variant<BinaryOp, Intrinsic>;
struct FoldTarget : AccumulatorPart {
  FoldOp op;
  Loc loc;  ///< of the first statement that folds into the target
};
/// How a reduce folds whose body only folds into accumulators by known operators (transforms/fold_pattern.hpp).
struct FoldPattern {
  std::vector<FoldTarget> targets;  ///< in statement order; each component is in one target only
  /// The body is only `accumulator op= its element`, whole or by member, each component at most once.
  bool isPlain;
};

/// A variant of a reduce that compensates sums of floats, set by compensate-sums. The reduce `fold` has one
/// more accumulator for each of `sums`, after all others and in that order, which holds the sum's rounding
/// error. `finish` is a kernel that takes the accumulators that have sums, each once and in order, then the
/// error of each sum, and returns these accumulators with the errors added.
struct Compensated {
  KernelId fold, finish;
  std::vector<AccumulatorPart> sums;
  /// The inputs, if each element only adds one input or the product of two.
  std::vector<VarId> term = {};
  /// Each element only adds an input, an element of a gather, or the product of two such floats: doubles represent it.
  bool addsDoubles = false;
};

/// What each element adds to an exact sum, for native code with its own accumulator. Empty if an element may
/// add any number of terms: then only the fold of digits can add them.
struct ExactTerm {
  std::vector<VarId> factors = {};  ///< float inputs: every element adds the one, or the product of the two
  /// Otherwise a native-only kernel. It has all parameters of the reduce except accumulators, then one float
  /// output per term, or two for a sum of products: the factors. A term that an element does not add is -0.
  std::optional<KernelId> kernel = {};
  bool isEmpty() const { return factors.empty() && !kernel; }
};

/// A scalar sum of floats of a reduce, set by sum-exactly. After its parameters other than accumulators, the
/// reduce `fold` has accumulators that hold the sum as digits of an integer. `finish` is a kernel that takes
/// the original accumulator and these, and returns the accumulator with the rounded sum in it.
struct ExactSum {
  KernelId fold, finish;
  VarId accumulator;
  std::vector<std::uint32_t> members;  ///< path from the accumulator to the float or vector
  std::uint32_t component;  ///< component of the vector; 0 for a float
  bool ofProducts;  ///< the digits have room for products of two floats
  ExactTerm term;
};

/// How partial results of a reduce combine; set by derive-combine (by the frontend if the user wrote an
/// overload that folds accumulators).
struct Reduction {
  std::optional<KernelId> combine = {};  ///< a reduce of accumulators; may be the same kernel
  std::vector<std::uint32_t> operands = {};  ///< one per parameter of `combine`: see sk::program::Reduction
  bool seeded = false;  ///< see sk::program::Reduction
  std::optional<Compensated> compensated = {};
  std::vector<ExactSum> exact = {};
  /// Wide variant: a kernel that converts the accumulators from doubles to floats.
  std::optional<KernelId> finish = {};
  /// True if elements may be folded in any order, because a known operator folds every accumulator.
  bool commutative = false;
  std::optional<FoldPattern> pattern = {};  ///< set by derive-combine, for reduces of the program
};

/// Kernels that do a part of what a kernel with outputs and accumulators does, for targets that cannot do both in
/// one pass; set by split-folds.
struct FoldParts {
  KernelId map;  ///< computes the outputs
  std::vector<std::uint32_t> mapOperands;  ///< for each of its parameters, the whole kernel's
  /// A reduce that folds the same elements, but reads outputs that `map` has computed. Absent if it would
  /// need another value, or cost no less than folding from the inputs.
  std::optional<KernelId> after;
  std::vector<std::uint32_t> afterOperands;
  /// A native-only variant of the whole kernel whose float sums are doubles; its reduction has a `finish`. Set by
  /// sum-in-doubles.
  std::optional<KernelId> inDoubles = {};
};

/// A condition that `assert` states. Its text is that of the program.
struct Assertion {
  std::string text;
  Loc loc;
};

/// What checks the assertions of a kernel, and of the functions that it calls. The kernel `check` has an int output besides
/// what the conditions need: 0 for an element that keeps all of them, else the number of the first that failed, from 1 on, in
/// Module::assertions. slice-assertions removes everything else from it.
struct AssertionCheck {
  KernelId check;
  std::vector<std::uint32_t> operands;  ///< for each of its parameters except the last, the kernel's
};

/// Variants of a kernel for other precisions, with the same parameters: set by widen-floats and round-halves.
struct PrecisionVariants {
  std::optional<KernelId> wide;  ///< computes in double wherever the kernel says float
  std::optional<KernelId> half;  ///< rounds every float that it computes to half
  std::string whyNotWide, whyNotHalf;  ///< why a kernel that computes floats has no such variant
};

/// Says that the kernel is a pass of another kernel's plan.
struct PassOf {
  KernelId whole;
  std::uint32_t number, count;  ///< from 1
};

/// The attributes in front of a kernel, such as [[precision(extended)]]: numbers of the enumerators of
/// sk::Precision, sk::Accumulate, sk::Intrinsics, sk::Tables, sk::Contraction and sk::Order; 0 if unspecified.
struct Choices {
  std::uint8_t precision = 0, accumulate = 0, intrinsics = 0, tables = 0, contraction = 0, order = 0;
  std::uint8_t ahead = 0;  ///< bits of Ahead: the programs for browsers besides those for whole streams
};

/// What [[variants(...)]] asks for, in the order of its words in frontend/choices.cpp.
enum class Ahead : std::uint8_t { Views, Half, Extended, Fast };
inline bool isAhead(const Choices& choices, Ahead variant) {
  return (choices.ahead >> static_cast<unsigned>(variant) & 1u) != 0;
}

/// A loop that unroll-loops has considered.
struct LoopNote {
  Loc loc;
  std::optional<std::int64_t> tripCount;  ///< if known
  std::string whyNot = {};  ///< why it stays a loop; empty if it was unrolled
};

/// A variant of a kernel for one value of a Spec parameter, with the same parameters: set by unroll-spec-loops.
struct UnrolledVariant {
  VarId spec;
  std::uint32_t value;  ///< its bits
  KernelId kernel;
};

struct Kernel {
  std::string name;  ///< without namespaces
  std::vector<std::string> scope;  ///< enclosing namespaces, outermost first
  std::string signature;  ///< the declaration as written, on one line
  FunctionId entry;  ///< void; variables 0..n-1 are the parameters:
      ///< Uniform, Iterator and Spec In, Input Element,
      ///< Output and Accumulator InOut, Gather Gather,
      ///< VariableOutput and Scatter AppendOutput
  std::vector<KernelParam> params;
  std::vector<BundleParam> bundles = {};  ///< of kernels that C++ calls, in order
  std::optional<Reduction> reduction;  ///< set for `reduce` and `scan`, and a kernel with accumulators
  bool isScan = false;  ///< keeps the accumulators after each element
  bool isSynthesized = false;  ///< synthesized by a transform: C++ cannot call it
  bool isNativeOnly = false;  ///< no GLSL program runs it
  std::optional<FoldParts> parts;  ///< of a kernel with outputs and accumulators
  bool isPart = false;  ///< of the FoldParts or AssertionCheck of another kernel: C++ cannot call it
  bool isOfPipeline = false;  ///< a pass of a pipeline, which alone calls it
  std::optional<AssertionCheck> assertions = {};  ///< of a declared kernel
  std::vector<Plan> plans;  ///< for targets whose limits it exceeds, the most generous first
  std::optional<PassOf> pass;
  PrecisionVariants variants;
  Choices choices;
  std::vector<LoopNote> loops = {};  ///< loops whose counters index neighbours or array elements
  std::vector<UnrolledVariant> unrolled = {};
  Loc loc;
};

/// True if the kernel has outputs as well as accumulators.
inline bool foldsBesideOutputs(const Kernel& kernel) {
  return kernel.reduction && std::ranges::any_of(kernel.params, [](const KernelParam& param) {
           return param.role == ParamRole::Output;
         });
}

/// The word that declares a kernel.
inline std::string_view wordOf(const Kernel& kernel) {
  return kernel.isScan ? "scan" : kernel.reduction && !foldsBesideOutputs(kernel) ? "reduce" : "kernel";
}

/// The word that declares its accumulators.
inline std::string_view accumulatorWordOf(const Kernel& kernel) { return kernel.isScan ? "scan" : "reduce"; }

/// A stream that only exists while a pipeline runs. It has the shape of the pipeline's domain.
struct LocalStream {
  std::string name;
  Type type;  ///< element type
};

/// A kernel of a pipeline, and its arguments: those of the pipeline, or local streams.
struct PipelinePass {
  KernelId kernel;
  std::vector<PassOperand> operands;  ///< one per parameter of the kernel
  std::vector<std::string> calls;  ///< the names of the kernels that it calls, in order
  bool isOverDomain =
      true;  ///< runs over the pipeline's domain; false: over the one that its arguments define
};

/// A function over streams: kernels, called in order. Calls that follow each other element by element are one pass.
struct Pipeline {
  Kernel
      face;  ///< what C++ calls: name, parameters, bundles and choices. It has no function, and is not in the module's table
  std::vector<LocalStream> locals;  ///< those that one pass writes and a later one reads
  std::vector<PipelinePass> passes;  ///< at least one
  /// The pipeline is a kernel of the module: its only pass, which has its name and parameters.
  bool isKernel = false;
  /// Bytes that an element's values take in memory, counted once for each pass that reads or writes them: if each
  /// call were a pass, and as it is.
  std::uint64_t bytesOfCalls = 0, bytesOfPasses = 0;
};

/// An extent of a declared stream: a constant, or, if it has a name, an argument of the struct that the stub
/// declares for the streams of a namespace.
struct DeclaredExtent {
  std::string name;
  std::int64_t value = 0;
};

/// `stream T name<extents>`: only C++ uses it, no kernel does.
struct DeclaredStream {
  std::string name;
  std::vector<std::string> scope;  ///< enclosing namespaces, outermost first
  Type type;  ///< element type
  std::vector<DeclaredExtent> extents;  ///< slowest first
  Loc loc;
};

struct Module {
  std::string file;  ///< path of the main file as given
  std::vector<std::string> sources;  ///< Loc::file indexes this
  std::vector<Struct> structs;
  std::vector<Array> arrays;
  std::vector<Constant> constants;
  std::vector<Function> functions;
  std::vector<Table> tables;
  std::vector<Kernel> kernels;
  std::vector<DeclaredStream> streams;
  std::vector<Assertion> assertions = {};
  std::vector<BundleType> bundleTypes;  ///< an inner one before those that have it as a member
  std::vector<Pipeline> pipelines = {};
};

}  // namespace skc::ir
