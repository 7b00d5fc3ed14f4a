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
//     for comparisons). Shifts take a count of the same component type's integer family.
//     Comparisons of vectors are componentwise and give a bool vector.
//   * Narrow scalars (half, char ... snorm16) and their vectors are for keeping values: no operator
//     takes them but Convert, Select, Construct, Swizzle and Index. A Convert to one quantises, as
//     quantize.hpp says; one to its carrier (carrierOf) changes no value.
//   * Matrices have rows: an Index gives a row, Construct takes all of them. They know + - * == !=,
//     * and / with a scalar, and * with a vector on the right, which is a column.
//   * A place (left side, or argument of an InOut parameter) is a VarRef of a mutable variable,
//     or a Member, Index or Swizzle without repeated components of a place.
//   * One loop node keeps the shape that its author wrote. `continue` goes to `step`, then `cond`.
//   * A function's parameters are its first `parameterCount` variables. `In` is a copy;
//     `InOut` copies in and out, and no variable is bound to two InOut parameters of one call.
//     `Gather`, `Element` and `AppendOutput` parameters stand for streams: they may only be used by the stream
//     expressions (GatherRead, NeighborRead, Sample, IndexOf, ExtentOf) and, an AppendOutput, by the stream
//     statements (Push, Scatter), or handed to another function; an Element may be read by VarRef too.
//   * Each kernel has an entry function, with one variable per kernel parameter, in order. After
//     `specialize-gathers`, no function but an entry has Gather or AppendOutput parameters, and every StreamRef
//     names a kernel parameter; the functions that a kernel reaches are then its own, and
//     what is in those that no kernel reaches any more does not count.
//   * A reduce has inputs and accumulators. Partial results are combined by a reduce whose inputs have the
//     types of its accumulators, and which does not ask where an element is.
//   * A kernel that some target cannot run in one pass has plans after `split-kernels`. The kernels
//     of their passes stand in the module like all others.
//   * After `predicate`, which only native code wants, a function computes several elements at once, each in a
//     lane. Control flow is the same for all lanes: conditions are uniform, or ask AnyLane. What an element does
//     alone depends on masks, which are bool variables. An entry may take one more parameter than its kernel
//     has: a bool In, true in the lanes that have an element.
//
// `validate` (validate.hpp) is this text made executable.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "ir/intrinsics.hpp"
#include "ir/type.hpp"
#include "support/loc.hpp"

namespace skc::ir {

using VarId = std::uint32_t;
using FunctionId = std::uint32_t;
using ConstantId = std::uint32_t;
using KernelId = std::uint32_t;
using TableId = std::uint32_t;

// clang-format off: one node a line

// ---- expressions ------------------------------------------------------------------------------

struct Expr;
using ExprPtr = std::unique_ptr<Expr>;

/// A scalar; vectors of literals are Constructs. `bits` holds bool 0/1, int32, uint32 or float32
/// bits; of a narrow scalar, those of its carrier; of a double the lower half, and `high` the upper.
struct Literal { std::uint32_t bits; std::uint32_t high = 0; };
struct VarRef { VarId var; };
struct ConstantRef { ConstantId constant; };

enum class UnaryOp : std::uint8_t { Negate, BitNot, LogicalNot };
struct Unary { UnaryOp op; ExprPtr operand; };   ///< LogicalNot of a bool vector is componentwise

enum class BinaryOp : std::uint8_t {
  Add, Sub, Mul, Div, Rem, BitAnd, BitOr, BitXor, ShiftLeft, ShiftRight,
  Less, LessEqual, Greater, GreaterEqual, Equal, NotEqual, LogicalAnd, LogicalOr,
};
struct Binary { BinaryOp op; ExprPtr lhs, rhs; };

/// cond ? yes : no. A scalar condition evaluates one side; a bool vector selects by component.
struct Select { ExprPtr cond, yes, no; };
/// Changes the component type: C++'s conversion, `bool(x)` is `x != 0`. Same width.
struct Convert { ExprPtr operand; };
/// A vector from scalars and vectors whose components add up to its width, or from one scalar
/// (splat); a matrix from all its rows; a struct from all its members; an array from all its elements.
struct Construct { std::vector<ExprPtr> args; };
struct Swizzle { ExprPtr base; std::vector<std::uint8_t> components; };   ///< of a vector; 1 to 4
struct Member { ExprPtr base; std::uint32_t field; };
/// Of an array, a vector or a matrix, at an int or uint. Outside an array, it is the nearest element.
struct Index { ExprPtr base, index; };
struct Call { FunctionId callee; std::vector<ExprPtr> args; };   ///< no InOut parameters, not void
struct IntrinsicCall { Intrinsic intrinsic; std::vector<ExprPtr> args; };

/// A stream: a variable of this function (Gather, Element or AppendOutput role), or, after specialize-gathers,
/// a parameter of the kernel. Domain (IndexOf and ExtentOf only) is the kernel's domain itself: what
/// an output, a gather's current index, or an Element without a stream behind it stands for.
struct StreamRef {
  enum class Space : std::uint8_t { Variable, KernelParameter, Domain };
  Space space;
  std::uint32_t id;
  bool operator==(const StreamRef&) const = default;
};
struct GatherRead { StreamRef stream; ExprPtr index; };       ///< int (rank 1), int2 .. int4; x fastest
struct NeighborRead { StreamRef stream; ExprPtr offset; };    ///< likewise
/// Linear interpolation of a gather of floats at a float (rank 1), float2 .. float4; x fastest. Its type is
/// the carrier of the element's.
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
/// Calls a function for its effect; `result` (may be null) is the place that takes its value.
/// The argument of a Gather parameter, and of an Element parameter that stands for a stream, is a
/// VarRef of this function's own Gather or Element variable.
struct CallStmt { FunctionId callee; std::vector<ExprPtr> args; ExprPtr result; };
struct If { ExprPtr cond; Block then, otherwise; };
enum class LoopKind : std::uint8_t { For, While, DoWhile };
/// init; loop { (cond unless DoWhile); body; step; (cond if DoWhile) }. `init` and `step` are empty
/// unless For; a null cond is true. `init` declares variables that live as long as the loop.
struct Loop { LoopKind kind; Block init; ExprPtr cond; Block step; Block body; };
struct Case { std::vector<std::int64_t> values; bool isDefault = false; Block body; Loc loc; };
/// Falls through as in C++; its cases are one scope, as in C++.
struct Switch { ExprPtr value; std::vector<Case> cases; };
struct Break {};
struct Continue {};
struct Return { ExprPtr value; };                                   ///< null in a void function
struct Scope { Block body; };

/// Appends an element to a variable output. Pushes of one element stay in the order of execution, and
/// those of an element come before those of every later one. `mask` is a bool that is true in the lanes which
/// push; null is all of them, and what it is before `predicate`.
struct Push { StreamRef stream; ExprPtr value; ExprPtr mask = nullptr; };
enum class ScatterOp : std::uint8_t { Store, Add, Min, Max };
/// Element `index` (int, int2 .. int4; x fastest) of a scatter output becomes `value`, or its old value
/// combined with it; an index outside does nothing. In the order of Push, and with its mask. One op an output.
struct Scatter { StreamRef stream; ScatterOp op; ExprPtr index, value; ExprPtr mask = nullptr; };

struct Stmt {
  using Node = std::variant<Declare, Assign, CallStmt, If, Loop, Switch, Break, Continue, Return, Scope,
                            Push, Scatter>;
  Loc loc;
  Node node;
};

// clang-format on

// ---- declarations -----------------------------------------------------------------------------

enum class VarRole : std::uint8_t { Local, In, InOut, Element, Gather, AppendOutput };
struct Variable {
  std::string name;
  Type type;  ///< Gather, AppendOutput: the element's type
  VarRole role = VarRole::Local;
  std::uint8_t rank = 0;  ///< Gather, AppendOutput of a scatter output: 1 to 4
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
  std::optional<TableId> table = {};  ///< that may stand for a Call of it
  bool isLibrary = false;  ///< of the native library: its errors are bounded as it is written
};

/// A table of the values of a function, which takes one float In and gives a float. `kernel`, set by tabulate where
/// some kernel calls the function, has one Input and one Output, and computes it.
struct Table {
  std::string name;  ///< the function's, without namespaces
  std::vector<std::string> scope;  ///< enclosing namespaces, outermost first
  float low, high;
  std::uint32_t intervals;
  bool isCubic;  ///< else linear
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
struct KernelParam {
  std::string name;
  ParamRole role;
  Type type;  ///< of one element
  std::optional<Type> held = {};  ///< what the stream holds where that is another type: floats for doubles
  std::uint8_t rank = 0;  ///< Gather, Scatter
  Boundary boundary = Boundary::Clamp;  ///< Gather
  ExprPtr border;  ///< Gather with Border: constant expression
  bool filter = false;  ///< Gather: sampled by the device's own filter where it can
  ExprPtr identity;  ///< Accumulator: constant expression, or null
  std::uint32_t firstPlane = 0;  ///< Output of a pass that writes only some planes of the element:
  std::uint32_t planeCount = 0;  ///< the first, and how many; 0 is all of them
  Loc loc;
  ScatterOp scatter = ScatterOp::Store;  ///< Scatter: what all its statements do
  std::int32_t pushes = -1;  ///< VariableOutput, Scatter: statements that one element executes
      ///< at most; -1 if unknown
  /// Streams, set by guard-streams: an expression of the entry's Spec variables that is false where the
  /// kernel does without; or null.
  ExprPtr neededIf = nullptr;
};

/// The type of the elements that the parameter's stream holds.
inline Type heldType(const KernelParam& param) { return param.held.value_or(param.type); }

/// A sum of floats that a reduce folds: an accumulator, or a member of one.
struct CompensatedSum {
  VarId accumulator;
  std::vector<std::uint32_t> members;  ///< way from the accumulator
};

/// A second form of a reduce that sums floats, set by compensate-sums: the reduce `fold` has one more accumulator for
/// each of `sums`, after all others and in that order, for what its sum has lost. `finish` is a kernel that takes the
/// accumulators which have sums as they are, each once and in their order, then what each of the sums has lost, and gives
/// these accumulators with both added.
struct Compensated {
  KernelId fold, finish;
  std::vector<CompensatedSum> sums;
  /// Where an element adds one input, or the product of two, and does no more: these.
  std::vector<VarId> term = {};
};

/// What each element adds to an exact sum, for code that has an accumulator of its own. Empty where an element may add any
/// number of terms: then only the fold of digits adds them.
struct ExactTerm {
  std::vector<VarId> factors = {};  ///< inputs of one float: every element adds it, or the product of two
  /// Otherwise a kernel that runs natively alone. It has all parameters of the reduce but accumulators, then an output of
  /// one float for each term; of a sum of products, two: its factors. A term that an element does not add is -0.
  std::optional<KernelId> kernel = {};
  bool isEmpty() const { return factors.empty() && !kernel; }
};

/// A scalar sum of floats of a reduce, set by sum-exactly: the reduce `fold` has, after all parameters but accumulators, those
/// that hold the sum as digits of an integer. `finish` is a kernel that takes the accumulator as it is and these, and
/// gives the accumulator with the rounded sum in its place.
struct ExactSum {
  KernelId fold, finish;
  VarId accumulator;
  std::vector<std::uint32_t> members;  ///< way from the accumulator to the float or vector
  std::uint32_t component;  ///< of that; 0 of a float
  bool ofProducts;  ///< the digits have room for products of two floats
  ExactTerm term;
};

/// How partial results of a reduce combine; set by derive-combine (frontend: where the user wrote
/// an overload that folds accumulators).
struct Reduction {
  std::optional<KernelId> combine = {};  ///< a reduce of accumulators; may be the very kernel
  std::vector<std::uint32_t> operands = {};  ///< one a parameter of it: see sk::program::Reduction
  bool seeded = false;  ///< likewise
  std::optional<Compensated> compensated = {};
  std::vector<ExactSum> exact = {};
  /// Of a wide form: a kernel that takes the accumulators, which are doubles, and gives them as floats.
  std::optional<KernelId> finish = {};
  /// Elements may be folded in any order: every accumulator is folded by an operator that is known.
  bool commutative = false;
};

/// A kernel's forms for other precisions, whose parameters are the same: set by widen-floats and round-halves.
struct Forms {
  std::optional<KernelId> wide;  ///< computing in doubles wherever the kernel says float
  std::optional<KernelId> half;  ///< rounding every float that it computes to half
  std::string whyNotWide, whyNotHalf;  ///< where it computes floats, yet has no such form
};

// ---- plans ------------------------------------------------------------------------------------

/// What a target can read and write in one pass.
struct Limits {
  std::uint32_t drawBuffers = 0;  ///< planes written
  std::uint32_t textureUnits = 0;  ///< planes read
  bool operator==(const Limits&) const = default;
};

/// A value that one pass of a plan writes and later ones read: a local variable of the whole kernel.
struct Temporary {
  std::string name;
  Type type;
  double computeCost;  ///< of computing it once, see split/cost.hpp
  std::uint32_t readers;  ///< passes that read it
};

/// What a parameter of a pass is given: an argument of the whole kernel, or a temporary.
struct PassOperand {
  bool isTemporary;
  std::uint32_t index;
};
struct Pass {
  KernelId kernel;  ///< Kernel::pass is set there
  std::vector<PassOperand> operands;  ///< one a parameter
  double cost;
};

/// A plane of an argument of the whole kernel.
struct ArgumentPlane {
  std::uint32_t argument, plane;
  bool operator==(const ArgumentPlane&) const = default;
};
/// Planes of one texel format that are copied to the layers of one texture, and read from there.
struct Bundle {
  Type type;
  std::vector<ArgumentPlane> layers;
};

/// How a kernel runs that needs more than a target has: in these passes, one after the other.
struct Plan {
  Limits limits;  ///< what its passes need
  std::vector<Temporary> temporaries;
  std::vector<Bundle> bundles;
  std::vector<Pass> passes;
  double cost = 0;
  double costWithoutTemporaries = 0;  ///< were every value computed wherever it is needed
};

/// The kernel is a pass of another's plan.
struct PassOf {
  KernelId whole;
  std::uint32_t number, count;  ///< from 1
};

/// What the author chooses by [[precision(extended)]] and the like, in front of a kernel: numbers of the enumerators of
/// sk::Precision, sk::Accumulate, sk::Intrinsics, sk::Tables and sk::Contraction; 0 where nothing is said.
struct Choices {
  std::uint8_t precision = 0, accumulate = 0, intrinsics = 0, tables = 0, contraction = 0;
};

/// A loop that unroll-loops has looked at.
struct LoopNote {
  Loc loc;
  std::optional<std::int64_t> rounds;  ///< where their number is known
  std::string whyNot = {};  ///< it stays a loop; empty where it was unrolled
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
  std::optional<Reduction> reduction;  ///< set for `reduce`
  bool isMade = false;  ///< made by a transform, for another one: C++ cannot call it
  bool isNativeOnly = false;  ///< no GLSL program runs it
  std::vector<Plan> plans;  ///< for targets that it is too large for, the most generous first
  std::optional<PassOf> pass;
  Forms forms;
  Choices choices;
  std::vector<LoopNote> loops = {};  ///< those with neighbours or array elements at their counters
  Loc loc;
};

/// An extent of a declared stream: a constant, or, where it has a name, an argument of the struct that
/// the stub declares for the streams of a namespace.
struct DeclaredExtent {
  std::string name;
  std::int64_t value = 0;
};

/// `stream T name<extents>`: no kernel knows it.
struct DeclaredStream {
  std::string name;
  std::vector<std::string> scope;  ///< enclosing namespaces, outermost first
  Type type;  ///< of one element
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
};

}  // namespace skc::ir
