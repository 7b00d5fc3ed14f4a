// SPDX-License-Identifier: MIT
//
// What a kernel computes, as a graph of scalar operations: control flow has become Select, vectors and structs their scalars.
// Equal operations on equal operands are one node. A node stands for two numbers, the exact one and the one that the device computes; its
// rounding says how far the device's operation is from the exact operation on the same operands.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <unordered_map>
#include <vector>

#include "bounds/functions.hpp"
#include "bounds/interval.hpp"
#include "support/loc.hpp"

namespace skc::bounds {

using NodeId = std::uint32_t;
inline constexpr NodeId noNode = std::numeric_limits<NodeId>::max();

enum class Op : std::uint8_t {
  Input,  ///< a number that the kernel reads; `index` is its place in Graph::inputs()
  Constant,  ///< `value`
  Round,  ///< the operand, rounded to another format
  Negate,
  Absolute,
  Add,
  Subtract,
  Multiply,
  Divide,
  MultiplyAdd,
  Min,
  Max,
  Call,  ///< `function`
  Call2,  ///< `function2`
  Floor,
  Ceil,
  Truncate,
  RoundEven,
  Select,  ///< the first operand is a condition
  // Conditions
  Less,
  LessEqual,
  Equal,
  And,
  Or,
  Not,
};

constexpr bool isCondition(Op op) { return op >= Op::Less; }
constexpr bool isComparison(Op op) { return op == Op::Less || op == Op::LessEqual || op == Op::Equal; }
constexpr bool isStep(Op op) { return op >= Op::Floor && op <= Op::RoundEven; }

/// A set of floating-point numbers.
struct Format {
  double unit;  ///< half a unit in the last place of 1
  double smallest;  ///< the smallest normal number
  double largest;
  bool isRelative = false;  ///< errors are `unit` of the result, as of pairs of floats, not of its power of 2
  bool flushes = false;  ///< denormal numbers may become 0
  bool operator==(const Format&) const = default;
};
inline constexpr Format floatFormat = {0x1p-24, 0x1p-126, 0x1.fffffep127};
inline constexpr Format doubleFormat = {0x1p-53, 0x1p-1022, largestDouble};
inline constexpr Format halfFormat = {0x1p-11, 0x1p-14, 65504};

/// How a device's operation differs from the exact one.
struct Rounding {
  enum class Kind : std::uint8_t {
    Exact,
    Nearest,  ///< the nearest number of the format
    Units,  ///< within `amount` units in the last place of the number nearest to the exact value
    Absolute,  ///< within `amount`
  };
  Kind kind = Kind::Exact;
  Format format = doubleFormat;
  double amount = 0;
  bool isScaling = false;  ///< the operation multiplies by a power of 2: exact unless the result is denormal
  bool isGrowing = false;  ///< the power is not below 1: exact
  bool operator==(const Rounding&) const = default;
};

/// Integers are exact, but their operations may overflow.
enum class Integer : std::uint8_t { No, Signed, Unsigned };

struct Node {
  Op op;
  UnaryFunction function = {};
  BinaryFunction function2 = {};
  std::array<NodeId, 3> operands = {noNode, noNode, noNode};
  std::uint32_t index = 0;
  double value = 0;
  Rounding rounding = {};
  Integer integer = Integer::No;
  Loc loc = {};  ///< of the first operation in the program that this node stands for

  int operandCount() const {
    int count = 0;
    while (count < 3 && operands[static_cast<std::size_t>(count)] != noNode) ++count;
    return count;
  }
};

/// A number that the kernel reads.
struct Input {
  std::string name;
  Interval range;
  bool isInteger = false;
};

class Graph {
 public:
  const Node& operator[](NodeId id) const { return nodes_[id]; }
  std::size_t size() const { return nodes_.size(); }
  const std::vector<Input>& inputs() const { return inputs_; }

  NodeId input(Input input, Rounding rounding, Integer integer = Integer::No);
  NodeId constant(double value, Rounding rounding = {}, Integer integer = Integer::No);
  /// Adds an operation, or returns a node that has the same value. Folds operations on constants whose results are exact, and what an
  /// operand of 0, 1 or -1 leaves alone.
  NodeId add(Node node);

  bool isConstant(NodeId id) const { return nodes_[id].op == Op::Constant; }
  /// True for a constant that the device has exactly.
  bool isExact(NodeId id) const {
    return isConstant(id) && nodes_[id].rounding.kind == Rounding::Kind::Exact;
  }
  bool isConstant(NodeId id, double value) const { return isExact(id) && nodes_[id].value == value; }

  // Conditions
  NodeId truth(bool value) { return constant(value ? 1 : 0); }
  NodeId conjunction(NodeId a, NodeId b);
  NodeId disjunction(NodeId a, NodeId b);
  NodeId negation(NodeId a);
  NodeId select(NodeId condition, NodeId yes, NodeId no, Loc loc);
  /// A bool as a condition: a Select of bools becomes one.
  NodeId condition(NodeId value);

  /// The nodes that the roots need, each after its operands.
  std::vector<NodeId> neededBy(const std::vector<NodeId>& roots) const;

 private:
  NodeId extreme(NodeId condition, NodeId yes, NodeId no, Loc loc);
  void noteScaling(Node& node) const;
  NodeId simplified(const Node& node);
  NodeId unique(const Node& node);

  std::vector<Node> nodes_;
  std::vector<Input> inputs_;
  std::unordered_multimap<std::uint64_t, NodeId> known_;
};

}  // namespace skc::bounds
