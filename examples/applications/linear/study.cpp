// SPDX-License-Identifier: MIT
#include "study.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "compact.hpp"
#include "layout.hpp"
#include "multigrid.hpp"
#include "support/named.hpp"
#include "support/stopwatch.hpp"
#include "support/table.hpp"

namespace linear {

namespace {

struct Case {
  std::string_view precision, storage, accumulation;
  Arithmetic arithmetic;
};

Arithmetic arithmeticOf(sk::Precision precision, sk::Storage storage, sk::Accumulate accumulate) {
  return {.precision = precision, .matrix = storage, .vectors = storage, .accumulate = accumulate};
}

using enum sk::Precision;

const Case cases[] = {
    {"half", "half", "tree", arithmeticOf(Half, sk::Storage::Half, sk::Accumulate::Tree)},
    {"single", "half", "tree", arithmeticOf(Single, sk::Storage::Half, sk::Accumulate::Tree)},
    {"single", "half", "compensated", arithmeticOf(Single, sk::Storage::Half, sk::Accumulate::Default)},
    {"single", "single", "tree", arithmeticOf(Single, sk::Storage::Single, sk::Accumulate::Tree)},
    {"single", "single", "compensated", arithmeticOf(Single, sk::Storage::Single, sk::Accumulate::Default)},
    {"single", "single", "exact", arithmeticOf(Single, sk::Storage::Single, sk::Accumulate::Exact)},
    {"extended", "extended", "compensated",
     arithmeticOf(Extended, sk::Storage::Extended, sk::Accumulate::Default)},
    {"double", "double", "compensated", arithmeticOf(Double, sk::Storage::Double, sk::Accumulate::Default)},
};

struct Run {
  std::string_view method = "cg", preconditioner = "jacobi", layout = "auto", ordering = "colours";
  Arithmetic arithmetic = {};
  SolveSettings settings = {};
  double omega = 1.0;
  int before = 1, after = 1;
};

struct Reached {
  Solution solution;
  std::string layout;
  double productSeconds = 0.0;
  double bytes = 0.0;  ///< of the matrix, for each unknown and product
  std::vector<LevelRate> rates;
  HierarchyAccount hierarchy;  ///< of the preconditioner, if it has levels
};

/// The time of one product, the best of many: the processor's own on devices that run there.
double secondsOf(sk::Device& device, Matrix& matrix, const Arithmetic& arithmetic) {
  Vector x = device.stream<float>(matrix.domain(), arithmetic.vectors);
  Vector y = device.stream<float>(matrix.range(), arithmetic.vectors);
  x.fill(1.0f);
  // Where the processor computes, its own time, whatever else runs beside it.
  const bool isProcessor = device.profile() == "native" || device.isSoftware();
  double best = 0.0;
  for (int i = 0; i < 20; ++i) {  // the first builds programs; others may be disturbed
    device.finish();
    const examples::Stopwatch watch;
    const std::clock_t start = std::clock();
    matrix.multiply(x, y);
    device.finish();
    const double seconds = isProcessor ? static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC
                                       : watch.milliseconds() / 1000.0;
    if (i == 1 || (i > 1 && seconds < best)) best = seconds;
  }
  return best;
}

/// Solves twice, since the first time builds programs, and returns the second.
Reached reached(sk::Device& device, const System& system, const Run& run) {
  const Operator& a = system.matrix();
  const std::unique_ptr<Matrix> matrix = makeMatrix(Space(device, shapeOf(a)), a, run.layout, run.arithmetic);
  const auto preconditioner =
      examples::rowNamed(preconditionerKinds(), run.preconditioner, "preconditioner")
          .make(device, *matrix, a, run.arithmetic,
                {.omega = run.omega, .ordering = run.ordering, .before = run.before, .after = run.after});
  const auto method =
      examples::rowNamed(methodKinds(), run.method, "solver")
          .make(device, *matrix, preconditioner.get(), run.arithmetic, {.omega = run.omega, .a = &a});
  Reached r;
  for (int i = 0; i < 2; ++i)
    r.solution = solve(*method, a, system.rightHandSide(), run.arithmetic, run.settings);
  if (preconditioner != nullptr && run.method == "stationary") r.rates = preconditioner->rates();
  if (preconditioner && preconditioner->hierarchy() != nullptr) r.hierarchy = *preconditioner->hierarchy();
  r.layout = matrix->layout();
  r.productSeconds = secondsOf(device, *matrix, run.arithmetic);
  r.bytes = static_cast<double>(matrix->bytes()) / static_cast<double>(a.size);
  return r;
}

Solution solveWith(sk::Device& device, const System& system, const StudyChoices& choices,
                   const Arithmetic& arithmetic, bool refines) {
  Run run{.method = choices.method.name,
          .preconditioner = choices.preconditioner.name,
          .layout = choices.layout,
          .arithmetic = arithmetic,
          .settings = choices.settings};
  run.settings.refines = refines;
  return reached(device, system, run).solution;
}

std::string number(double v) { return fmt::format("{:.1e}", v); }
std::string milliseconds(double seconds) { return fmt::format("{:.3g}", seconds * 1000.0); }

examples::Findings precisions(sk::Device& device, bool) {
  const System system("poisson:63x63", {});
  return {studyPrecisions(device, system,
                          {examples::rowNamed(methodKinds(), "cg", "solver"),
                           examples::rowNamed(preconditionerKinds(), "jacobi", "preconditioner"),
                           "auto",
                           {}})};
}

examples::Findings solvers(sk::Device& device, bool) {
  const System system("poisson:63x63", {});
  examples::Table table(
      {"solver", "preconditioner", "outcome", "iterations", "residual", "ms", "us for an iteration"});
  const Run runs[] = {{.method = "cg", .preconditioner = "none"},
                      {.method = "pipelined", .preconditioner = "none"},
                      {.method = "minres", .preconditioner = "none"},
                      {.method = "chebyshev", .preconditioner = "none"},
                      {.method = "bicgstab", .preconditioner = "none"},
                      {.method = "gmres", .preconditioner = "none"},
                      {.method = "gmres", .preconditioner = "multigrid"},
                      {.method = "sor", .preconditioner = "none", .omega = 1.9},
                      {.method = "stationary", .preconditioner = "multigrid"}};
  for (const Run& run : runs) {
    const Solution s = reached(device, system, run).solution;
    table.add({std::string(run.method), std::string(run.preconditioner), std::string(nameOf(s.outcome)),
               std::to_string(s.iterations), number(s.residualTrue), milliseconds(s.seconds),
               fmt::format("{:.3g}",
                           s.seconds * 1e6 / static_cast<double>(std::max<std::int64_t>(1, s.iterations)))});
  }
  return {table.markdown()};
}

examples::Findings preconditionerTable(sk::Device& device, bool) {
  const System system("poisson:63x63", {});
  examples::Table table({"preconditioner", "ordering", "outcome", "iterations", "residual", "ms"});
  for (const PreconditionerKind& kind : preconditionerKinds()) {
    if (!kind.isSymmetric) continue;
    const bool isOrdered = kind.name == "ssor" || kind.name == "ic0";
    for (const std::string_view ordering : {"colours", "levels"}) {
      if (!isOrdered && ordering == "levels") continue;
      const Solution s =
          reached(device, system, {.preconditioner = kind.name, .ordering = ordering}).solution;
      table.add({std::string(kind.name), isOrdered ? std::string(ordering) : "",
                 std::string(nameOf(s.outcome)), std::to_string(s.iterations), number(s.residualTrue),
                 milliseconds(s.seconds)});
    }
  }
  return {table.markdown()};
}

examples::Findings layoutsOfGrids(sk::Device& device, bool) {
  const System system("poisson:128x128", {});
  examples::Table table({"layout", "entries in", "bytes for an unknown", "ms for a product",
                         "a byte's cost beside rows", "in the model", "iterations", "residual", "ms"});
  // What a product takes for a byte that the model counts: of the layout and, for each entry, of x.
  const double ofX =
      4.0 * static_cast<double>(entriesOf(system.matrix())) / static_cast<double>(system.matrix().size);
  const auto costOf = [&](const Reached& r) { return r.productSeconds / (r.bytes + ofX); };
  double costOfRows = 0.0;
  for (const std::string_view layout : {"rows", "slices", "diagonals", "buckets", "points", "stencil"})
    for (const sk::Storage entries : {sk::Storage::Single, sk::Storage::Half}) {
      if (layout == "stencil" && entries == sk::Storage::Half) continue;
      Arithmetic arithmetic;
      arithmetic.matrix = entries;
      const Reached r = reached(
          device, system, {.layout = layout, .arithmetic = arithmetic, .settings = {.tolerance = 1e-6}});
      if (costOfRows == 0.0) costOfRows = costOf(r);
      std::string measured, model;
      if (layout != "stencil") {
        const LayoutKind& kind = examples::rowNamed(layoutKinds(), layout, "layout");
        measured = fmt::format("{:.2f}", costOf(r) / costOfRows);
        model = kind.suits(sparseOf(system.matrix()))
                    ? fmt::format("{:g}", device.profile() == "native" ? kind.native : kind.others)
                    : "not chosen";
      }
      table.add({std::string(layout),
                 layout == "stencil"            ? ""
                 : entries == sk::Storage::Half ? "half"
                                                : "single",
                 fmt::format("{:.3g}", r.bytes), milliseconds(r.productSeconds), measured, model,
                 std::to_string(r.solution.iterations), number(r.solution.residualTrue),
                 milliseconds(r.solution.seconds)});
    }
  return {table.markdown()};
}

struct NamedCycle {
  std::string_view name, preconditioner;
  int before, after;
};

examples::Findings multigridRates(sk::Device& device, bool) {
  examples::Table table({"grid", "cycle", "iterations", "residual an iteration",
                         "rates from the finest grid to the coarsest", "ms"});
  constexpr NamedCycle cycles[] = {{"V(1,1)", "multigrid", 1, 1},
                                   {"V(2,1)", "multigrid", 2, 1},
                                   {"W(1,1)", "w-cycle", 1, 1},
                                   {"F(1,1)", "f-cycle", 1, 1},
                                   {"full", "full", 1, 1}};
  for (const std::string_view grid :
       {"127x127", "61x67", "64x64:periodic,neumann", "63x63:1,1000", "31x31x31"})
    for (const NamedCycle& cycle : cycles) {
      if (grid != "127x127" && cycle.name != "V(2,1)") continue;
      const System system(fmt::format("poisson:{}", grid), {});
      Run run{.method = "stationary", .preconditioner = cycle.preconditioner, .settings = {.every = 1}};
      run.before = cycle.before;
      run.after = cycle.after;
      const Reached r = reached(device, system, run);
      std::string rates;
      for (const LevelRate& level : r.rates)
        rates += fmt::format("{}{:.3f}", rates.empty() ? "" : ", ", level.rate);
      const double iterations = static_cast<double>(std::max<std::int64_t>(1, r.solution.iterations));
      table.add({std::string(grid), std::string(cycle.name), std::to_string(r.solution.iterations),
                 fmt::format("{:.3f}", std::pow(r.solution.residualTrue, 1.0 / iterations)), rates,
                 milliseconds(r.solution.seconds)});
    }
  return {table.markdown()};
}

examples::Findings jumps(sk::Device& device, bool) {
  examples::Table table({"coefficients", "grid", "ratio", "largest rate of V(2,1)", "V(2,1) alone",
                         "cg with V(1,1)", "the same in floats", "cg with jacobi"});
  constexpr std::string_view grids[][2] = {
      {"blocks", "127x127"},      {"blocks", "100x90"},
      {"inclusions", "127x127"},  {"inclusions", "101x75:periodic,dirichlet-neumann"},
      {"inclusions", "31x31x31"}, {"noise", "127x127"}};
  const Arithmetic doubles = arithmeticOf(Double, sk::Storage::Double, sk::Accumulate::Default);
  for (const auto& [pattern, grid] : grids)
    for (const std::string_view ratio : {"1", "1e2", "1e4", "1e6"}) {
      const System system(fmt::format("poisson:{}:{}={}", grid, pattern, ratio), {});
      const Run runs[] = {{.method = "stationary",
                           .preconditioner = "multigrid",
                           .arithmetic = doubles,
                           .settings = {.most = 100, .every = 1},
                           .before = 2},
                          {.preconditioner = "multigrid", .arithmetic = doubles, .settings = {.every = 1}},
                          {.preconditioner = "multigrid", .settings = {.every = 1}},
                          {.arithmetic = doubles, .settings = {.every = 1}}};
      std::vector<std::string> row{std::string(pattern), std::string(grid), std::string(ratio)};
      for (const Run& run : runs) {
        const Reached r = reached(device, system, run);
        double largest = 0.0;
        for (const LevelRate& level : r.rates) largest = std::max(largest, level.rate);
        if (!r.rates.empty()) row.push_back(fmt::format("{:.2f}", largest));
        const bool isSolved = r.solution.residualTrue <= run.settings.tolerance;
        row.push_back(fmt::format("{}{}", isSolved ? "" : "> ", r.solution.iterations));
      }
      table.add(row);
    }
  return {table.markdown()};
}

/// By conjugate gradients with multigrid.
Solution solvedKnown(sk::Device& device, const KnownSolution& known, bool isCompact) {
  const Arithmetic doubles = arithmeticOf(Double, sk::Storage::Double, sk::Accumulate::Default);
  VaryingStencil compact;
  SparseMatrix sparse;
  if (isCompact) {
    compact = compactPoisson(known.grid);
    sparse = assemble(compact);
  }
  Operator a = isCompact ? operatorOf(sparse) : operatorOf(known.grid);
  if (isCompact) a.varying = &compact;
  const std::unique_ptr<Matrix> matrix = isCompact ? makeMatrix(device, scaled(compact, a.scale), doubles)
                                                   : makeMatrix(scaled(known.grid, a.scale), doubles);
  const auto m = examples::rowNamed(preconditionerKinds(), "multigrid", "preconditioner")
                     .make(device, *matrix, a, doubles);
  const auto method =
      examples::rowNamed(methodKinds(), "cg", "solver").make(device, *matrix, m.get(), doubles);
  return solve(*method, a, isCompact ? known.fourthOrder() : known.secondOrder(), doubles,
               {.tolerance = 1e-12, .every = 1});
}

examples::Findings orders(sk::Device& device, bool) {
  examples::Table table({"grid", "5 or 7 entries: error", "order", "iterations", "9 or 19 entries: error",
                         "order", "iterations"});
  for (const int rank : {2, 3}) {
    double before[2] = {0.0, 0.0};
    for (const std::int64_t n : {7, 15, 31, 63, 127}) {
      if (rank == 3 && n > 63) continue;
      const KnownSolution known(rank, n);
      std::vector<std::string> row{rank == 2 ? fmt::format("{}x{}", n, n) : fmt::format("{}x{}x{}", n, n, n)};
      for (const bool isCompact : {false, true}) {
        const Solution s = solvedKnown(device, known, isCompact);
        const double error = known.errorOf(s.x);
        double& last = before[isCompact ? 1 : 0];
        row.push_back(fmt::format("{:.2e}", error));
        row.push_back(last > 0.0 ? fmt::format("{:.2f}", std::log2(last / error)) : "");
        row.push_back(std::to_string(s.iterations));
        last = error;
      }
      table.add(row);
    }
  }
  return {table.markdown()};
}

/// The largest errors after one and two cycles of full multigrid in floats, as parts of the largest error of the discretisation, and the time of a cycle.
std::vector<std::string> nested(sk::Device& device, const KnownSolution& known, double discretisation,
                                int before, int after) {
  const Operator a = operatorOf(known.grid);
  const Stencil matrix = scaled(known.grid, a.scale);
  const auto m = makeMultigrid(
      device, matrix, {}, {.cycle = Cycle::Full, .before = before, .after = after, .isSymmetric = false});
  const std::vector<double> b = known.secondOrder();
  std::vector<double> x(b.size(), 0.0), r = b;
  Vector in = device.stream<float>(matrix.grid), out = device.stream<float>(matrix.grid),
         rz = device.stream<float>({1});
  std::vector<std::string> errors;
  double fastest = 0.0;
  for (int cycle = 0; cycle < 6; ++cycle) {
    for (double& v : r) v *= a.scale;
    in.writeReals(r);
    device.finish();
    const examples::Stopwatch watch;
    m->apply(in, out, rz);
    device.finish();
    const double seconds = watch.milliseconds() / 1000.0;
    if (cycle == 1 || (cycle > 1 && seconds < fastest)) fastest = seconds;  // the first builds programs
    const std::vector<double> z = out.readReals();
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += z[i];
    r = multiply(known.grid, x);
    for (std::size_t i = 0; i < r.size(); ++i) r[i] = b[i] - r[i];
    if (cycle < 2) errors.push_back(fmt::format("{:.3f}", known.errorOf(x) / discretisation));
  }
  errors.push_back(milliseconds(fastest));
  return errors;
}

examples::Findings fullMultigrid(sk::Device& device, bool) {
  examples::Table table(
      {"grid", "error of the discretisation", "sweeps", "after one cycle", "after two", "ms a cycle"});
  for (const auto& [rank, n] :
       {std::pair{2, 63}, std::pair{2, 100}, std::pair{2, 255}, std::pair{2, 512}, std::pair{3, 31},
        std::pair{3, 40}, std::pair{3, 63}, std::pair{3, 127}, std::pair{3, 128}}) {
    const KnownSolution known(rank, n);
    const double discretisation = known.errorOf(solvedKnown(device, known, false).x);
    for (const auto& [before, after] : {std::pair{1, 1}, std::pair{2, 1}}) {
      std::vector<std::string> row{rank == 2 ? fmt::format("{}x{}", n, n) : fmt::format("{}x{}x{}", n, n, n),
                                   fmt::format("{:.2e}", discretisation),
                                   fmt::format("{}, {}", before, after)};
      for (std::string& cell : nested(device, known, discretisation, before, after))
        row.push_back(std::move(cell));
      table.add(row);
    }
  }
  return {table.markdown()};
}

examples::Findings aggregation(sk::Device& device, bool) {
  examples::Table table({"grid", "computed in", "levels", "operator complexity", "set-up ms",
                         "cg with jacobi", "cg with aggregation", "aggregation alone", "ms"});
  const Arithmetic singles, doubles = arithmeticOf(Double, sk::Storage::Double, sk::Accumulate::Default);
  for (const auto& [grid, isDouble] :
       {std::pair{"32x32", false}, std::pair{"64x64", false}, std::pair{"128x128", false},
        std::pair{"256x256", false}, std::pair{"16x16x16", false}, std::pair{"32x32x32", false},
        std::pair{"128x128:1,1000", false}, std::pair{"127x127:blocks=1e6", true},
        std::pair{"127x127:inclusions=1e6", true}, std::pair{"127x127:noise=1e4", true}}) {
    const System system(fmt::format("poisson:{}", grid), {});
    const auto with = [&](std::string_view method, std::string_view preconditioner) {
      return reached(device, system,
                     {.method = method,
                      .preconditioner = preconditioner,
                      .layout = "slices",
                      .arithmetic = isDouble ? doubles : singles,
                      .settings = {.every = 1}});
    };
    const Reached plain = with("cg", "jacobi"), r = with("cg", "aggregation"),
                  alone = with("stationary", "aggregation");
    table.add({grid, isDouble ? "double" : "single", std::to_string(r.hierarchy.levels.size()),
               fmt::format("{:.2f}", r.hierarchy.operatorComplexity()), milliseconds(r.hierarchy.seconds),
               std::to_string(plain.solution.iterations), std::to_string(r.solution.iterations),
               std::to_string(alone.solution.iterations), milliseconds(r.solution.seconds)});
  }
  return {table.markdown()};
}

constexpr examples::Study studies[] = {
    {"precision", "precisions, storages and accumulations, with and without refinement", precisions},
    {"solvers", "every solver, for Poisson's equation", solvers},
    {"preconditioners", "every symmetric preconditioner, with conjugate gradients", preconditionerTable},
    {"multigrid", "the rates of multigrid's cycles on every grid of their hierarchies", multigridRates},
    {"jumps", "multigrid and conjugate gradients where coefficients jump", jumps},
    {"full", "the error after one and two cycles of full multigrid", fullMultigrid},
    {"orders", "the errors of discretisations of the second and the fourth order", orders},
    {"aggregation", "levels and iterations of smoothed aggregation, for stored matrices of growing grids",
     aggregation},
    {"layouts", "every layout of a sparse matrix, with entries in floats and halves", layoutsOfGrids},
};

}  // namespace

std::span<const examples::Study> studyKinds() { return studies; }

std::string studyPrecisions(sk::Device& device, const System& system, const StudyChoices& choices) {
  examples::Table table({"computed in", "stored as", "sums", "refined", "outcome", "iterations", "residual",
                         "backward error", "ms"});
  std::string cheapest = "no choice reaches the tolerance";
  std::optional<double> least;
  for (const Case& c : cases)
    for (const bool refines : {false, true}) {
      try {
        const Solution s = solveWith(device, system, choices, c.arithmetic, refines);
        table.add({std::string(c.precision), std::string(c.storage), std::string(c.accumulation),
                   refines ? "yes" : "no", std::string(nameOf(s.outcome)), std::to_string(s.iterations),
                   fmt::format("{:.1e}", s.residualTrue), fmt::format("{:.1e}", s.backwardError),
                   fmt::format("{:.3g}", s.seconds * 1000.0)});
        if (s.outcome != Outcome::Converged || (least && *least <= s.seconds)) continue;
        least = s.seconds;
        cheapest =
            fmt::format("the cheapest within {:.0e}: computed in {}, stored as {}, sums {}{}, {:.3g} ms",
                        choices.settings.tolerance, c.precision, c.storage, c.accumulation,
                        refines ? ", refined" : "", s.seconds * 1000.0);
      } catch (const sk::Error& error) {
        if (error.kind() != sk::Error::Kind::Device) throw;
        break;  // the device has no such precision
      }
    }
  return fmt::format("{}\n{}\n", table.markdown(), cheapest);
}

}  // namespace linear
