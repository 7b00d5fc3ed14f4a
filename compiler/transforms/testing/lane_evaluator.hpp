// SPDX-License-Identifier: MIT
//
// For tests: runs functions for several elements at once, one per lane. Control flow follows lane 0 and must be uniform,
// so functions as the frontend produces them run with a single lane. It knows all scalars but halves and normalized
// types, and the intrinsics that never round.
#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "analysis/uniformity.hpp"
#include "ir/ir.hpp"

namespace skc {

class LaneEvaluator {
 public:
  using Value = std::vector<double>;  ///< all scalars in order; a double represents every int, uint and float
  using Lanes = std::vector<Value>;

  /// `inFull`: `&&`, `||` and `?:` evaluate all their operands. Values are checked against `shapes`.
  LaneEvaluator(const ir::Module& module, std::size_t lanes, bool inFull,
                const analysis::Uniformity* shapes = nullptr)
      : module_(module), count_(lanes), inFull_(inFull), shapes_(shapes), pushed(lanes) {}

  /// Runs a function; returns the final values of its parameters.
  std::vector<Lanes> run(ir::FunctionId id, std::vector<Lanes> arguments) {
    Lanes result;
    return call(id, std::move(arguments), result);
  }

 private:
  enum class Flow : std::uint8_t { Next, Break, Continue, Return };
  using Offsets = std::vector<std::size_t>;
  struct Frame {
    ir::FunctionId id;
    const ir::Function& function;
    std::vector<Lanes> variables;
    Lanes result;
  };

  std::vector<Lanes> call(ir::FunctionId id, std::vector<Lanes> arguments, Lanes& result);
  Flow block(Frame& frame, const ir::Block& statements);
  Flow statement(Frame& frame, const ir::Stmt& stmt);
  Flow loop(Frame& frame, const ir::Loop& loop);
  Flow choice(Frame& frame, const ir::Switch& choice);
  void assign(Frame& frame, const ir::Expr& place, const Lanes& value);
  /// Where the scalars of an lvalue are in its root variable, for each lane.
  std::vector<Offsets> offsets(Frame& frame, const ir::Expr& place);
  Lanes unassigned(ir::FunctionId id, ir::VarId var) const;
  void check(const Frame& frame, ir::VarId var) const;
  void tick() {
    if (++steps_ > 5000000) throw std::runtime_error("it does not end");
  }

  Lanes of(Frame& frame, const ir::Expr& expr);
  Lanes logical(Frame& frame, const ir::Binary& n, std::size_t size);
  Lanes intrinsic(Frame& frame, const ir::IntrinsicCall& n, ir::Type type);
  bool uniform(Frame& frame, const ir::Expr& expr);
  std::size_t size(ir::Type type) const;
  void addLeaves(ir::Type type, std::size_t first, Offsets& leaves) const;
  template <class Fn>
  Lanes each(Fn&& fn) const {
    Lanes lanes;
    lanes.reserve(count_);
    for (std::size_t i = 0; i < count_; ++i) lanes.push_back(fn(i));
    return lanes;
  }

  const ir::Module& module_;
  std::size_t count_;
  bool inFull_;
  const analysis::Uniformity* shapes_;
  int steps_ = 0;

 public:
  std::vector<Value> pushed;  ///< one list per lane
  std::int32_t firstIndex = 0;  ///< index of lane 0
};

}  // namespace skc
