// SPDX-License-Identifier: MIT
//
// The public face, sk/linear.hpp: checks what it is given, and puts the library's parts together.
#include <sk/linear.hpp>

#include <cmath>
#include <new>
#include <utility>

#include <fmt/format.h>

#include "checks.hpp"
#include "memory.hpp"
#include "operator_matrix.hpp"
#include "ordering.hpp"
#include "reordering.hpp"
#include "residual.hpp"
#include "solve.hpp"
#include "text/named.hpp"

namespace sk::linear {

namespace {

/// Numbers alone; names are looked up in the library's tables.
void checkOptions(const Options& o) {
  const auto require = [](bool holds, std::string_view option, const auto& value, std::string_view range) {
    if (!holds) throw sk::Error(fmt::format("the option '{}' is {}; it is {}", option, value, range));
  };
  require(o.tolerance >= 0.0 && o.tolerance <= 1.0, "tolerance", o.tolerance, "from 0 to 1");
  require(o.most >= 0, "most", o.most, "0 or more iterations");
  require(o.restart >= 1 && o.restart <= 1000, "restart", o.restart, "from 1 to 1000 steps");
  require(o.omega > 0.0 && o.omega < 2.0, "omega", o.omega, "between 0 and 2");
  require(o.drop >= 0.0 && o.drop < 1.0, "drop", o.drop, "from 0 to below 1");
  require(o.fill >= 0 && o.fill <= 100000, "fill", o.fill, "from 0 to 100000 entries");
  require(o.reorder == "none" || o.reorder == "rcm", "reorder", o.reorder, "none or rcm");
  require(o.sweepsBefore >= 0 && o.sweepsBefore <= 100, "sweepsBefore", o.sweepsBefore, "from 0 to 100");
  require(o.sweepsAfter >= 0 && o.sweepsAfter <= 100, "sweepsAfter", o.sweepsAfter, "from 0 to 100");
  require(o.ordering == "colours" || o.ordering == "levels", "ordering", o.ordering, "colours or levels");
}

template <class Fn>
decltype(auto) withinMemory(std::string_view what, Fn&& fn) {
  try {
    return fn();
  } catch (const std::bad_alloc&) {
    throw sk::Error(fmt::format("the host has not enough memory for {}", what), sk::Error::Kind::Memory);
  }
}

void requireOwnOrder(const Options& o) {
  if (o.reorder != "none")
    throw sk::Error(
        "a grid keeps the order of its elements; leave out 'reorder', or give its entries by assemble()");
}

template <class Rows>
std::vector<Named> namesOf(const Rows& table) {
  std::vector<Named> names;
  for (const auto& row : table) names.push_back({row.name, row.does});
  return names;
}

}  // namespace

/// The members refer to those above them.
struct Solver::Parts {
  Parts(sk::Device& on, const Options& chosen)
      : device(on),
        options(chosen),
        method(text::rowNamed(methodKinds(), options.solver, "solver")),
        preconditioner(text::rowNamed(preconditionerKinds(), options.preconditioner, "preconditioner")),
        arithmetic{.precision = options.precision,
                   .matrix = options.entries.value_or(options.storage),
                   .vectors = options.storage,
                   .accumulate = options.accumulate} {
    checkOptions(options);
    checkChoice(method, preconditioner, options.sweepsBefore, options.sweepsAfter);
    if (options.layout != "auto" && options.layout != "stencil")
      text::rowNamed(layoutKinds(), options.layout, "layout");
  }

  /// Once `a` describes the matrix.
  void makeAll() {
    checkMemory(device, a, fmt::format("a matrix of {} unknowns", a.size),
                {method, preconditioner, options.layout, arithmetic, options.restart});
    if (a.size == 0) return;
    matrix = makeMatrix(Space(device, shapeOf(a)), a, options.layout, arithmetic);
    makeIterations();
    residual = makeResidual(device, *matrix, a, arithmetic);
  }

  void makeIterations() {
    iterations.reset();  // refers to the others
    applied.reset();
    checkSymmetry(device, *matrix, arithmetic, method, preconditioner, a);
    applied = preconditioner.make(device, *matrix, a, arithmetic,
                                  {.omega = options.omega,
                                   .ordering = options.ordering,
                                   .drop = options.drop,
                                   .fill = options.fill,
                                   .before = options.sweepsBefore,
                                   .after = options.sweepsAfter});
    iterations = method.make(device, *matrix, applied.get(), arithmetic,
                             {.restart = options.restart, .omega = options.omega, .a = &a});
  }

  Solution solve(std::span<const double> b) {
    if (isBroken)
      throw sk::Error("the solver has no matrix, because its last update failed; update it, or make another");
    const SolveSettings settings{.tolerance = options.tolerance,
                                 .most = options.most,
                                 .refines = options.refines,
                                 .progress = options.progress};
    if (a.size > 0 && static_cast<std::int64_t>(b.size()) == a.size && !order.empty()) {
      checkFinite(b);
      Solution s = linear::solve(*iterations, *residual, a, inOrder(b, order), arithmetic, settings);
      s.x = inFormerOrder(s.x, order);
      return s;
    }
    if (a.size > 0) return linear::solve(*iterations, *residual, a, b, arithmetic, settings);
    if (!b.empty())
      throw sk::Error(fmt::format("the right-hand side has {} elements, and the matrix 0 rows", b.size()),
                      sk::Error::Kind::Shape);
    Solution none;
    none.outcome = Outcome::Converged;
    return none;
  }

  void update(const SparseMatrix& values) {
    if (isOfGrid)
      throw sk::Error(
          "an update takes other values of a sparse matrix, and this one is of a grid; make another solver");
    checkStructure(values);
    const SparseMatrix& former = order.empty() ? sparse : pattern;
    if (values.rows != former.rows || values.columns != former.columns || values.starts != former.starts ||
        values.column != former.column)
      throw sk::Error(
          "an update has its entries where the solver's matrix has them; make another solver for other "
          "places",
          sk::Error::Kind::Shape);
    if (a.size == 0) return;
    isBroken = true;
    if (order.empty())
      sparse.value = values.value;
    else
      sparse = permuted(values, order);
    a = operatorOf(sparse);
    a.order = order;
    matrix->update(scaled(sparse, a.scale));
    const bool followsMatrix = method.isUpdatable && (applied == nullptr || applied->isUpdatable());
    if (followsMatrix && iterations != nullptr) {
      checkSymmetry(device, *matrix, arithmetic, method, preconditioner, a);
      if (applied != nullptr) applied->update(a);
    } else {
      makeIterations();
    }
    residual->update();
    isBroken = false;
  }

  sk::Device& device;
  Options options;
  const MethodKind& method;
  const PreconditionerKind& preconditioner;
  Arithmetic arithmetic;
  SparseMatrix sparse;  ///< of grids, only if the coefficients vary
  std::vector<std::int32_t> order;  ///< of the unknowns; empty: their own
  SparseMatrix pattern;  ///< before it was reordered, without values
  VaryingStencil varying;
  Operator a;
  std::unique_ptr<Matrix> matrix;
  std::unique_ptr<Preconditioner> applied;
  std::unique_ptr<Method> iterations;
  std::unique_ptr<Residual> residual;
  bool isOfGrid = false;
  bool isBroken = false;  ///< while an update changes the parts, one after the other
};

Solver::Solver(sk::Device& device, SparseMatrix a, const Options& options)
    : parts_(std::make_unique<Parts>(device, options)) {
  withinMemory("a solver of sparse equations", [&] {
    checkStructure(a);
    if (a.rows == a.columns) parts_->order = reorderingNamed(options.reorder, a);
    parts_->sparse = parts_->order.empty() ? std::move(a) : permuted(a, parts_->order);
    if (!parts_->order.empty()) {
      parts_->pattern = std::move(a);
      parts_->pattern.value.clear();
    }
    parts_->a = operatorOf(parts_->sparse);
    parts_->a.order = parts_->order;
    parts_->makeAll();
  });
}

Solver::Solver(sk::Device& device, const Stencil& a, const Options& options)
    : parts_(std::make_unique<Parts>(device, options)) {
  withinMemory("a solver on a grid", [&] {
    checkGrid(a);
    requireOwnOrder(options);
    parts_->isOfGrid = true;
    parts_->a = operatorOf(a);
    parts_->makeAll();
  });
}

Solver::Solver(sk::Device& device, VaryingStencil a, const Options& options)
    : parts_(std::make_unique<Parts>(device, options)) {
  withinMemory("a solver on a grid", [&] {
    checkGrid(a);
    requireOwnOrder(options);
    parts_->isOfGrid = true;
    parts_->varying = std::move(a);
    parts_->sparse = assemble(parts_->varying);
    parts_->a = operatorOf(parts_->sparse);
    parts_->a.varying = &parts_->varying;
    parts_->makeAll();
  });
}

Solver::Solver(Solver&&) noexcept = default;
Solver& Solver::operator=(Solver&&) noexcept = default;
Solver::~Solver() = default;

Solution Solver::solve(std::span<const double> b) {
  return withinMemory("the solution", [&] { return parts_->solve(b); });
}

void Solver::update(const SparseMatrix& a) {
  withinMemory("other values of the matrix", [&] { parts_->update(a); });
}

std::int64_t Solver::unknowns() const { return parts_->a.size; }
std::string Solver::layout() const { return parts_->matrix != nullptr ? parts_->matrix->layout() : "none"; }
std::int64_t Solver::storedEntries() const {
  return parts_->matrix != nullptr ? parts_->matrix->stored() : 0;
}

Solution solve(sk::Device& device, const SparseMatrix& a, std::span<const double> b, const Options& options) {
  return Solver(device, a, options).solve(b);
}
Solution solve(sk::Device& device, const Stencil& a, std::span<const double> b, const Options& options) {
  return Solver(device, a, options).solve(b);
}

std::vector<Named> solvers() { return namesOf(methodKinds()); }
std::vector<Named> preconditioners() { return namesOf(preconditionerKinds()); }
std::vector<Named> layouts() {
  std::vector<Named> names = namesOf(layoutKinds());
  names.insert(names.begin(), {{"auto", "the one whose product should cost least: a model, not a trial"},
                               {"stencil", "not at all: coefficients of a grid"}});
  return names;
}

}  // namespace sk::linear
