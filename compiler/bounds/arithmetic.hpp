// SPDX-License-Identifier: MIT
//
// Adds a kernel's operations to a graph, with the rounding errors that they have on the target.
#pragma once

#include "bounds/graph.hpp"
#include "bounds/options.hpp"
#include "ir/ir.hpp"

namespace skc::bounds {

class Arithmetic {
 public:
  Arithmetic(Graph& graph, const Options& options) : graph_(graph), options_(options) {}

  Graph& graph() { return graph_; }
  /// The place that new nodes get.
  void at(Loc loc) { loc_ = loc; }
  Loc loc() const { return loc_; }

  // Operations on scalars of one type, a float, double, int or uint.
  NodeId negate(ir::Scalar type, NodeId x);
  NodeId absolute(ir::Scalar type, NodeId x);
  NodeId add(ir::Scalar type, NodeId x, NodeId y) { return basic(Op::Add, type, x, y); }
  NodeId subtract(ir::Scalar type, NodeId x, NodeId y) { return basic(Op::Subtract, type, x, y); }
  NodeId multiply(ir::Scalar type, NodeId x, NodeId y) { return basic(Op::Multiply, type, x, y); }
  NodeId divide(ir::Scalar type, NodeId x, NodeId y);
  NodeId multiplyAdd(ir::Scalar type, NodeId x, NodeId y, NodeId z);
  NodeId minimum(ir::Scalar type, NodeId x, NodeId y);
  NodeId maximum(ir::Scalar type, NodeId x, NodeId y);
  NodeId call(ir::Scalar type, UnaryFunction function, NodeId x);
  NodeId call(ir::Scalar type, BinaryFunction function, NodeId x, NodeId y);
  NodeId step(Op op, ir::Scalar type, NodeId x);
  /// x - y * trunc(x / y) or x - y * floor(x / y), of a device that computes the quotient exactly.
  NodeId remainder(ir::Scalar type, NodeId x, NodeId y, Op rounded);
  /// x - floor(x), which stays below 1.
  NodeId fraction(ir::Scalar type, NodeId x);
  NodeId number(double value) { return graph_.constant(value); }
  NodeId number(ir::Scalar type, double value);

  /// A number that the kernel reads, of its arithmetic type.
  NodeId read(ir::Scalar type, std::string name, Interval range);
  NodeId literal(ir::Scalar type, const ir::Literal& literal);
  NodeId convert(ir::Scalar from, ir::Scalar to, NodeId x);
  /// What a stream of this type holds of an output.
  NodeId stored(ir::Scalar type, NodeId x);

  NodeId less(NodeId x, NodeId y) { return compare(Op::Less, x, y); }
  NodeId lessEqual(NodeId x, NodeId y) { return compare(Op::LessEqual, x, y); }
  NodeId equal(NodeId x, NodeId y) { return compare(Op::Equal, x, y); }
  NodeId select(NodeId condition, NodeId yes, NodeId no) {
    return graph_.select(graph_.condition(condition), yes, no, loc_);
  }

  /// The rounding of + - * and, if the target rounds it correctly, of other operations.
  Rounding nearest(ir::Scalar type) const;

 private:
  Format formatOf(ir::Scalar type) const;
  bool isNative() const { return options_.target == Target::Native; }
  bool isPair(ir::Scalar type) const;
  Rounding units(ir::Scalar type, double amount) const;
  Rounding roundingOf(ir::Scalar type, std::string_view function) const;
  NodeId basic(Op op, ir::Scalar type, NodeId x, NodeId y);
  NodeId compare(Op op, NodeId x, NodeId y);
  NodeId rounded(const Format& format, NodeId x);
  NodeId toHalf(ir::Scalar type, NodeId x);
  NodeId add(Node node);

  Graph& graph_;
  const Options& options_;
  Loc loc_ = {};
};

}  // namespace skc::bounds
