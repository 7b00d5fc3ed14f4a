// SPDX-License-Identifier: MIT
//
// Finds how the values of elements that are computed together relate to each other, and where their control
// flow diverges. Along x, the elements are lanes: neighbours in one row of the domain. Along y, they are in
// consecutive rows. Every value starts as uniform; what makes it vary is propagated to a fixed point (R.
// Karrenberg and S. Hack, "Whole-function vectorization", 2011).
//
// Shapes hold for active lanes only: in a loop that lanes leave at different times, a counter is uniform as
// long as no lane that has left can read it.
//
// Private to Uniformity: one walk over a function, which adds facts about varying values and divergent
// control flow. Uniformity repeats the walk until it adds nothing.
//
// The walk keeps a stack of frames, the reasons why some lanes are inactive: they took another branch, or
// have left the loop, the iteration or the function. A lane in another branch can read what is assigned
// meanwhile to a variable declared outside the branch. A lane that has left a loop cannot, if the variable
// lives only in that loop.
#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "analysis/shapes.hpp"
#include "ir/ir.hpp"

namespace skc::analysis {

class Uniformity {
 public:
  /// The module must have passed specialize-gathers.
  Uniformity(const ir::Module& module, const ir::Kernel& kernel, Axis axis = Axis::X);

  // `function` must be reachable from the kernel. A value has one shape per scalar leaf: one for a scalar,
  // one per component of a vector, width * width row by row for a matrix, those of its fields in order for a
  // struct. All elements of an array share the shapes of one.
  std::span<const Shape> of(ir::FunctionId function, ir::VarId var) const;
  std::span<const Shape> resultOf(ir::FunctionId function) const;
  std::vector<Shape> leavesOf(ir::FunctionId function, const ir::Expr& expr) const;
  /// The shape of all leaves together: Uniform if all are uniform; Consecutive only for a scalar.
  Shape of(ir::FunctionId function, const ir::Expr& expr) const;

  /// True if control flow diverges here: an If, Loop or Switch that must run under a mask, or a jump that not
  /// every active lane takes.
  bool diverges(ir::FunctionId function, const ir::Stmt& stmt) const;
  /// True if some lanes skip the rest of an iteration of this loop.
  bool skips(ir::FunctionId function, const ir::Stmt& loop) const;
  /// True if inactive lanes may read the variable that the statement assigns: it needs a masked store.
  bool blends(ir::FunctionId function, const ir::Stmt& stmt, ir::VarId var) const;
  /// True if some lanes return from the function before others.
  bool returnsEarly(ir::FunctionId function) const { return at(function).returnsEarly; }
  /// True if a call may run with lanes inactive that are active at the start of the calling function.
  bool isCalledDivergently(ir::FunctionId function) const { return at(function).isCalledDivergently; }

 private:
  friend class DivergenceWalk;

  /// Facts about one function.
  struct Facts {
    std::vector<std::vector<Shape>> variables;
    std::vector<Shape> result;
    std::set<const ir::Stmt*> divergent, skipping;
    std::set<std::pair<const ir::Stmt*, ir::VarId>> blended;
    bool returnsEarly = false;
    bool isCalledDivergently = false;
  };
  const Facts& at(ir::FunctionId function) const { return facts_.at(function); }
  void propagate(const std::vector<ir::FunctionId>& functions);

  const ir::Module& module_;
  const ir::Kernel& kernel_;
  Axis axis_;
  KernelShapes shapes_;
  std::map<ir::FunctionId, Facts> facts_;
};

/// Finds the last use of each variable of a function and the end of each loop, in source order.
class LastUses {
 public:
  explicit LastUses(const ir::Function& function);

  /// True if the variable is used after the end of the loop.
  bool isUsedAfter(ir::VarId var, const ir::Stmt& loop) const { return lastUse_[var] > ends_.at(&loop); }

 private:
  void visit(const ir::Block& block);
  void use(const ir::Expr& expr);

  std::vector<std::size_t> lastUse_;
  std::map<const ir::Stmt*, std::size_t> ends_;
  std::size_t now_ = 0;  ///< number of statements visited
};

class DivergenceWalk {
 public:
  DivergenceWalk(Uniformity& uniformity, ir::FunctionId id);

  /// Returns true if the walk added a fact.
  bool run();

 private:
  /// Why some lanes are inactive.
  struct Frame {
    enum Kind : std::uint8_t { Branch, Loop, Iteration, Function } kind;
    std::size_t loop = 0;  ///< Loop and Iteration: the number of loops around it
  };
  /// A statement that a jump can leave.
  struct Enclosing {
    const ir::Stmt* stmt;
    std::size_t frames;  ///< number of frames around it
    bool isLoop;
  };
  struct Declared {
    std::size_t frames, loops;  ///< numbers of frames and loops around the declaration
    bool isReadByCaller;  ///< the caller reads it after the function returns
  };

  void block(const ir::Block& statements, Frame::Kind leaves = Frame::Branch);
  bool jumps(const ir::Stmt& stmt, Frame::Kind left) const;

  void visit(const ir::Stmt& stmt, const ir::Declare& n);
  void visit(const ir::Stmt& stmt, const ir::Assign& n);
  void visit(const ir::Stmt& stmt, const ir::CallStmt& n);
  void visit(const ir::Stmt& stmt, const ir::If& n);
  void visit(const ir::Stmt& stmt, const ir::Loop& n);
  void visit(const ir::Stmt& stmt, const ir::Switch& n);
  void visit(const ir::Stmt& stmt, const ir::Break& n);
  void visit(const ir::Stmt& stmt, const ir::Continue& n);
  void visit(const ir::Stmt& stmt, const ir::Return& n);
  void visit(const ir::Stmt& stmt, const ir::Scope& n);
  void visit(const ir::Stmt&, const ir::Push&) {}
  void visit(const ir::Stmt&, const ir::Scatter&) {}
  void visit(const ir::Stmt&, const ir::Print&) {}

  void calls(const ir::Expr& expr);
  void called(ir::FunctionId callee);
  void assign(const ir::Stmt& stmt, const ir::Expr& place, LeafShapes value);
  bool isVisibleToInactiveLanes(ir::VarId var) const;
  bool isVisibleOutside(const Frame& frame, const Declared& declared, ir::VarId var) const;
  bool isDivergentJump(std::size_t frames, Frame::Kind allowed) const;

  LeafShapes shapes(const ir::Expr& expr) const { return exprs_.of(id_, expr); }
  void add(LeafShapes& into, const LeafShapes& from);
  void set(bool& flag);
  void insert(std::set<const ir::Stmt*>& where, const ir::Stmt& stmt);

  Uniformity& uniformity_;
  ir::FunctionId id_;
  const ir::Function& function_;
  Uniformity::Facts& facts_;
  ExprShapes exprs_;
  LastUses lastUses_;
  std::vector<Declared> declared_;
  std::vector<Frame> frames_;
  std::vector<Enclosing> enclosing_;
  std::vector<const ir::Stmt*> loops_;
  bool isNew_ = false;
};

}  // namespace skc::analysis
