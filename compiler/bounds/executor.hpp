// SPDX-License-Identifier: MIT
//
// The state of graphOf() (execute.hpp): statements in execute.cpp, expressions in expressions.cpp, intrinsics in intrinsics.cpp.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bounds/execute.hpp"

namespace skc::bounds {

/// All scalars of a value in order: those of vectors by component, of matrices by row.
using Numbers = std::vector<NodeId>;

class Executor {
 public:
  Executor(const ir::Module& module, const ir::Kernel& kernel, const Options& options);
  KernelGraph run();

 private:
  /// The variables of a function at some point, and the condition under which control gets there.
  struct Path {
    NodeId condition;
    std::vector<Numbers> variables;
    Numbers result;  ///< of a return
  };
  /// Where control may be after a statement.
  struct Exits {
    std::optional<Path> next, broken, continued, returned;
  };
  struct Frame {
    ir::FunctionId id;
    const ir::Function* function;
    std::vector<std::optional<std::uint32_t>>
        streams;  ///< the kernel's parameter that an Element stands for, by variable
  };
  /// A variable, and the positions of an lvalue's numbers in it.
  struct Slots {
    ir::VarId var;
    std::vector<std::size_t> numbers;
    /// With an index that is not constant: the numbers of each element, and the index.
    std::vector<std::vector<std::size_t>> choices = {};
    NodeId index = noNode;
  };

  // statements: execute.cpp
  void tick(Loc loc);
  std::size_t size(ir::Type type) const;
  std::vector<Numbers> parameters();
  Numbers readParameter(const std::string& name, const ir::KernelParam& param, ir::Type type);
  void readNumbers(const std::string& name, const ir::KernelParam& param, ir::Type type, Numbers& numbers);
  NodeId readNumber(const std::string& name, const ir::KernelParam& param, ir::Scalar type);
  void nameNumbers(const std::string& name, ir::Type type,
                   std::vector<std::pair<std::string, ir::Scalar>>& names) const;
  void addOutputs(KernelGraph& result, const std::vector<Numbers>& before, const std::vector<Numbers>& after);
  Path call(ir::FunctionId id, std::vector<Numbers> arguments,
            std::vector<std::optional<std::uint32_t>> streams, Loc loc);
  void merge(std::optional<Path>& into, std::optional<Path> other, NodeId selector);
  void mergeExits(Exits& into, Exits other, NodeId selector);
  Exits block(Frame& frame, const ir::Block& statements, Path path);
  Exits statement(Frame& frame, const ir::Stmt& stmt, Path path);
  Exits branch(Frame& frame, const ir::If& branch, Path path);
  Exits loop(Frame& frame, const ir::Loop& loop, Path path, Loc loc);
  [[noreturn]] void refuseLoop(NodeId condition, Loc loc);
  Exits choice(Frame& frame, const ir::Switch& choice, Path path);
  void append(const Path& path, const ir::StreamRef& stream, const Numbers& value, std::string_view how,
              Loc loc);
  void callStatement(Frame& frame, const ir::CallStmt& call, Path& path, Loc loc);
  Slots slots(Frame& frame, const Path& path, const ir::Expr& place);
  void store(Path& path, const Slots& slots, const Numbers& value);

  // expressions: expressions.cpp
  Numbers of(Frame& frame, const Path& path, const ir::Expr& expr);
  Numbers node(Frame& frame, const Path& path, const ir::Expr& expr);
  void noteOrigin(const KernelGraph::Origin& origin);
  NodeId conditionOf(Frame& frame, const Path& path, const ir::Expr& expr);
  Numbers part(Frame& frame, const Path& path, const ir::Expr& expr, const Numbers& all);
  Numbers binaryOf(Frame& frame, const Path& path, const ir::Binary& binary);
  Numbers binary(ir::BinaryOp op, ir::Type left, ir::Type right, const Numbers& a, const Numbers& b);
  NodeId binary(ir::BinaryOp op, ir::Scalar type, NodeId a, NodeId b);
  std::optional<NodeId> comparison(ir::BinaryOp op, NodeId a, NodeId b);
  NodeId integerOperation(ir::BinaryOp op, ir::Scalar type, NodeId a, NodeId b);
  Numbers product(ir::Type left, const Numbers& a, const Numbers& b);
  Numbers unaryOf(Frame& frame, const Path& path, const ir::Unary& unary);
  Numbers selectOf(Frame& frame, const Path& path, const ir::Select& select);
  Numbers constructOf(Frame& frame, const Path& path, const ir::Construct& construct, std::size_t count);
  Numbers streamRead(Frame& frame, const ir::StreamRef& stream, const Numbers& at, bool isOffset,
                     ir::Type type);
  Numbers streamNumbers(Frame& frame, const ir::StreamRef& stream, bool isIndex);
  std::optional<std::uint32_t> paramOf(Frame& frame, const ir::StreamRef& stream) const;

  // intrinsics: intrinsics.cpp
  Numbers intrinsic(Frame& frame, const Path& path, const ir::IntrinsicCall& call, ir::Type type);
  std::optional<Numbers> combined(ir::Intrinsic intrinsic, ir::Scalar type, const std::vector<Numbers>& args);
  NodeId component(ir::Intrinsic intrinsic, ir::Scalar type, NodeId x, NodeId y, NodeId z);
  NodeId dot(ir::Scalar type, const Numbers& a, const Numbers& b);
  NodeId determinant(ir::Scalar type, const Numbers& m, std::size_t n);
  Numbers inverse(ir::Scalar type, const Numbers& m, std::size_t n);

  const ir::Module& module_;
  const ir::Kernel& kernel_;
  const Options& options_;
  Graph graph_;
  Arithmetic arithmetic_;
  std::vector<bool> lacksRange_;
  std::vector<KernelGraph::Origin> origins_;
  std::map<std::pair<std::uint32_t, Numbers>, Numbers> reads_;  ///< of gathers, by parameter and index
  std::map<std::string, NodeId> named_;
  std::vector<OutputNumber> appended_;  ///< what has been pushed and scattered
  std::vector<NodeId> callers_;  ///< the conditions under which the current function has been called
  int steps_ = 0;
  int depth_ = 0;
};

}  // namespace skc::bounds
