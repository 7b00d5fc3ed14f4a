// SPDX-License-Identifier: MIT
//
// solve: systems of equations from Matrix Market files, with the residual that has really been reached.
#include <cstdint>
#include <filesystem>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <sk/sk.hpp>

#include "checks.hpp"
#include "direct.hpp"
#include "layout.hpp"
#include "memory.hpp"
#include "method.hpp"
#include "precise.hpp"
#include "preconditioner.hpp"
#include "report.hpp"
#include "residual.hpp"
#include "solve.hpp"
#include "study.hpp"
#include "support/application.hpp"
#include "support/named.hpp"
#include "support/progress.hpp"
#include "support/ranks.hpp"
#include "support/stopwatch.hpp"
#include "support/text_file.hpp"
#include "system.hpp"
#include "text/real_option.hpp"

namespace {

struct Settings {
  std::string matrix;
  std::filesystem::path rightHandSide, solution, json, svg;
  std::string solver = "cg", preconditioner = "jacobi", layout = "auto";
  std::string precision = "single", storage = "default", entries, accumulate = "compensated";
  std::string ordering = "colours", reorder = "none";
  double drop = 1e-3;
  int fill = 20;
  int restart = 30;
  double omega = 1.0;
  std::vector<int> sweeps{1, 1};
  linear::SolveSettings solve;
  bool isDirect = false, isJudged = false;
  std::string study;
  CLI::Option* studyOption = nullptr;  ///< may have been given without a name
};

template <class T>
struct Choice {
  std::string_view name;
  T value;
};
constexpr Choice<sk::Precision> precisions[] = {{"half", sk::Precision::Half},
                                                {"single", sk::Precision::Single},
                                                {"extended", sk::Precision::Extended},
                                                {"double", sk::Precision::Double}};
constexpr Choice<sk::Storage> storages[] = {{"default", sk::Storage::Default},
                                            {"half", sk::Storage::Half},
                                            {"single", sk::Storage::Single},
                                            {"extended", sk::Storage::Extended},
                                            {"double", sk::Storage::Double}};
constexpr Choice<sk::Accumulate> accumulations[] = {{"tree", sk::Accumulate::Tree},
                                                    {"compensated", sk::Accumulate::Default},
                                                    {"extended", sk::Accumulate::Extended},
                                                    {"exact", sk::Accumulate::Exact}};

template <class T, std::size_t n>
T chosen(const Choice<T> (&table)[n], std::string_view name, std::string_view what) {
  return examples::rowNamed(table, name, what).value;
}

void addOptions(CLI::App& cli, Settings& s) {
  cli.add_option("matrix", s.matrix,
                 "a Matrix Market file, or poisson:WxH or poisson:WxHxD for Poisson's equation on a grid; "
                 "poisson:WxH:X,Y has these "
                 "diffusivities along its dimensions, and poisson:WxH:periodic,dirichlet-neumann these ends "
                 "(dirichlet, neumann or periodic); poisson:WxH:PATTERN=RATIO has coefficients that jump "
                 "(inclusions, blocks or noise), and poisson:WxH:coefficients=FILE those of a file");
  cli.add_option("--rhs", s.rightHandSide,
                 "the right-hand side, a Matrix Market file; without one, A times ones, or A times random "
                 "numbers on a singular grid");
  cli.add_option("--solver", s.solver, examples::listed("the method:", linear::methodKinds(), 11))
      ->capture_default_str();
  cli.add_option("--preconditioner", s.preconditioner,
                 examples::listed("what the residual is multiplied by:", linear::preconditionerKinds(), 11))
      ->capture_default_str();
  cli.add_option("--restart", s.restart, "steps after which gmres begins anew")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  cli.add_option("--omega", s.omega, "the relaxation factor of sor and ssor, between 0 and 2")
      ->capture_default_str();
  cli.add_option(
         "--sweeps", s.sweeps,
         "BEFORE,AFTER: multigrid's sweeps before and after the correction by the coarser grid; cg needs "
         "as many of both")
      ->delimiter(',')
      ->expected(2)
      ->check(CLI::Range(0, 100))
      ->capture_default_str();
  cli.add_option(
         "--ordering", s.ordering,
         "of the rows for sor, ssor, ic0, ilu0 and ilut:\n  colours     few groups of rows, each of which is "
         "a call\n  levels      the order of the matrix, which needs fewer iterations")
      ->check(CLI::IsMember({"colours", "levels"}))
      ->capture_default_str();
  cli.add_option(
         "--reorder", s.reorder,
         "of the unknowns of a file:\n  none        as they are\n  rcm         reverse Cuthill-McKee, which "
         "brings entries near the diagonal")
      ->check(CLI::IsMember({"none", "rcm"}))
      ->capture_default_str();
  cli.add_option("--drop", s.drop,
                 "of ilut: factors below this, and entries below this part of the norm of a row, are dropped")
      ->capture_default_str();
  cli.add_option("--fill", s.fill, "of ilut: the most entries that a row of each factor keeps")
      ->check(CLI::Range(0, 100000))
      ->capture_default_str();
  cli.add_option(
         "--layout", s.layout,
         examples::listed("how the device holds the matrix:\n  auto        the one whose product should "
                          "cost least: a model, not a trial\n"
                          "  stencil     not at all: coefficients of a grid",
                          linear::layoutKinds(), 11))
      ->capture_default_str();
  cli.add_option("--precision", s.precision, "what iterations compute in: half, single, extended or double")
      ->capture_default_str();
  cli.add_option(
         "--storage", s.storage,
         "what vectors are stored in: half, single, extended or double; by default what a configuration "
         "file says, else single")
      ->capture_default_str();
  cli.add_option("--entries", s.entries, "what the matrix is stored in; as --storage if it is not given");
  cli.add_option("--accumulate", s.accumulate,
                 "how scalar products add: tree, compensated, extended or exact")
      ->capture_default_str();
  cli.add_option("--tolerance", s.solve.tolerance, "of ||b - A x|| / ||b||, in double precision")
      ->check(sk::text::realFrom(0, 1), "0 to 1")
      ->capture_default_str();
  cli.add_option("--most", s.solve.most, "the most iterations")
      ->check(CLI::Range(std::int64_t{0}, std::int64_t{1} << 40))
      ->capture_default_str();
  cli.add_option("--every", s.solve.every, "iterations between two looks at the residual")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1} << 30))
      ->capture_default_str();
  cli.add_flag("!--no-refinement", s.solve.refines, "run the method once, in its own precision");
  cli.add_flag("--direct", s.isDirect, "solve by sparse factors on the host in place of iterations");
  cli.add_flag("--judge", s.isJudged, "print the distance from the direct solution, too");
  s.studyOption =
      cli.add_option("--study", s.study,
                     examples::listed("print tables: with a matrix, what each precision, storage and "
                                      "accumulation attains; without one, NAME:",
                                      linear::studyKinds(), 11))
          ->expected(0, 1);
  cli.add_option("--solution", s.solution, "write x to this Matrix Market file");
  cli.add_option("--json", s.json, "write what was reached to this file");
  cli.add_option("--chart", s.svg, "draw the residual over the iterations to this file, as SVG");
}

/// Several processes divide a grid.
void checkDivisible(const examples::Ranks& ranks, const linear::Operator& a,
                    const linear::PreconditionerKind& preconditioner) {
  if (!a.isGrid())
    ranks.refuseSeveral("a matrix of a file",
                        "its rows read any element of a vector; start it without mpirun");
  if (!preconditioner.isDivisible)
    ranks.refuseSeveral(
        fmt::format("the preconditioner '{}'", preconditioner.name),
        "it takes rows one after the other; take multigrid, chebyshev or jacobi, or start it without "
        "mpirun");
}

/// What to try where a solve has not converged; "" if there is nothing to say.
std::string adviceFor(const linear::MethodKind& method, const linear::PreconditionerKind& preconditioner,
                      const linear::Arithmetic& arithmetic, const linear::Solution& solution) {
  const bool isWide =
      arithmetic.precision == sk::Precision::Double && arithmetic.vectors == sk::Storage::Double;
  // Incomplete factors solve most of what division by a diagonal leaves, as on olm1000.
  constexpr std::array<std::string_view, 3> diagonals = {"none", "jacobi", "spai0"};
  const bool isWeak = std::ranges::find(diagonals, preconditioner.name) != diagonals.end();
  const std::string_view factors = method.needsSymmetry ? "--preconditioner ic0" : "--preconditioner ilu0";
  const std::string_view stronger = isWeak ? factors : "another preconditioner";
  switch (solution.outcome) {
    case linear::Outcome::NotPositiveDefinite:
      if (method.name == "minres")
        return fmt::format(
            "minres takes any symmetric matrix, but the preconditioner '{}' must be positive definite, which "
            "it "
            "is not if diagonal entries are below 0; take --preconditioner none",
            preconditioner.name);
      return fmt::format("'{}' needs a positive definite matrix; take --solver minres --preconditioner none",
                         method.name);
    case linear::Outcome::Breakdown: return "take --solver gmres, which has no such breakdown";
    case linear::Outcome::Stagnated:
    case linear::Outcome::NotFinite:
      return isWide ? fmt::format("take {}", stronger)
                    : fmt::format("take --precision double --storage double, or {}", stronger);
    case linear::Outcome::MostIterations:
      return isWide
                 ? fmt::format("take a larger --most, or {}", stronger)
                 : fmt::format("take a larger --most, --precision double --storage double, or {}", stronger);
    case linear::Outcome::Converged:
    case linear::Outcome::SingularAndCompatible:
    case linear::Outcome::SingularAndIncompatible: break;
  }
  return "";
}

void writeFiles(const Settings& s, const linear::System& system, const linear::Account& account,
                const linear::Solution& solution) {
  if (!s.solution.empty()) linear::writeMatrixMarketVector(s.solution, system.inOwnOrder(solution.x));
  if (!s.svg.empty())
    examples::writeFile(s.svg, linear::svgChart(solution.history, s.solve.tolerance, account.system));
  if (!s.json.empty()) examples::writeFile(s.json, linear::jsonOf(account, solution));
}

/// ||x - y|| / ||y||; 2-norms.
double distance(std::span<const double> x, std::span<const double> y) {
  std::vector<double> difference(x.begin(), x.end());
  for (std::size_t i = 0; i < difference.size(); ++i) difference[i] -= y[i];
  const double norm = linear::normsOf(y).two;
  return norm > 0.0 ? linear::normsOf(difference).two / norm : linear::normsOf(difference).two;
}

/// The direct solution, as iterations report theirs.
linear::Solution solvedDirectly(const linear::System& system, double tolerance, linear::Account& account) {
  const linear::Operator& a = system.matrix();
  const std::span<const double> b = system.rightHandSide();
  linear::DirectSolution direct = linear::solveDirectly(a, b);
  account.factors = direct.factors;
  account.factorEntries = direct.entries;
  linear::Solution solution;
  const linear::Norms normB = linear::normsOf(b);
  if (normB.two > 0.0) {
    const linear::Norms left = linear::preciseResidual(a, 1.0, direct.x, b).norms;
    const linear::Norms x = linear::normsOf(direct.x);
    solution.residualTrue = solution.residualRecurred = left.two / normB.two;
    solution.residualError = left.error / normB.two;
    solution.backwardError = left.infinity / (a.infinityNorm * x.infinity + normB.infinity);
  }
  solution.outcome =
      solution.residualTrue <= tolerance ? linear::Outcome::Converged : linear::Outcome::Stagnated;
  solution.x = std::move(direct.x);
  solution.seconds = direct.seconds;
  return solution;
}

void verify(examples::Application& app, const Settings& s, const linear::Solution& solution) {
  examples::Verification verification("||b - A x|| / ||b|| in double precision", s.solve.tolerance,
                                      "--tolerance");
  verification.note(0, solution.residualTrue);
  app.verified(verification);
}

void solveDirectly(examples::Application& app, const Settings& s, const linear::System& system,
                   linear::Account& account) {
  account.device = "host";
  const linear::Solution solution = solvedDirectly(system, s.solve.tolerance, account);
  app.report(fmt::format("{}, {} unknowns, solved directly", account.system, account.unknowns),
             account.device, solution.seconds * 1000.0);
  fmt::print("{} with {} entries for {}\nresidual {:.3g} (known to {:.1g}), backward error {:.3g}\n",
             account.factors, account.factorEntries, account.entries, solution.residualTrue,
             solution.residualError, solution.backwardError);
  writeFiles(s, system, account, solution);
  verify(app, s, solution);
}

/// The direct solution beside that of iterations.
void judge(const linear::System& system, const linear::Solution& solution, linear::Account& account) {
  const linear::DirectSolution direct = linear::solveDirectly(system.matrix(), system.rightHandSide());
  account.factors = direct.factors;
  account.factorEntries = direct.entries;
  account.distance = distance(solution.x, direct.x);
  fmt::print("distance {:.3g} from the direct solution ({} with {} entries, {:.3g} ms)\n", *account.distance,
             account.factors, account.factorEntries, direct.seconds * 1000.0);
}

/// Residuals are computed in doubles from the entries as they are stored, so that a configuration file must not round them.
sk::Storage storageOfEntries(const Settings& s) {
  const sk::Storage storage = chosen(storages, s.entries.empty() ? s.storage : s.entries, "storage");
  return storage == sk::Storage::Default ? sk::Storage::Single : storage;
}

void solveSystem(examples::Application& app, Settings& s) {
  const linear::Arithmetic arithmetic{.precision = chosen(precisions, s.precision, "precision"),
                                      .matrix = storageOfEntries(s),
                                      .vectors = chosen(storages, s.storage, "storage"),
                                      .accumulate = chosen(accumulations, s.accumulate, "accumulation")};
  const linear::MethodKind& methodKind = examples::rowNamed(linear::methodKinds(), s.solver, "solver");
  const linear::PreconditionerKind& preconditionerKind =
      examples::rowNamed(linear::preconditionerKinds(), s.preconditioner, "preconditioner");

  linear::System system(s.matrix, s.rightHandSide);
  system.reorder(s.reorder);
  const linear::Operator& a = system.matrix();
  linear::checkChoice(methodKind, preconditionerKind, s.sweeps[0], s.sweeps[1]);
  if (system.duplicates() > 0)
    fmt::print(stderr, "solve: warning: {} entries are given several times, and were added up\n",
               system.duplicates());

  const bool isStudy = s.studyOption->count() > 0;
  if (s.isDirect || s.isJudged)
    app.ranks().refuseSeveral("a direct solution",
                              "leave out --direct and --judge, or start it without mpirun");
  if (isStudy) app.ranks().refuseSeveral("--study", "start it without mpirun");
  linear::Account account;
  account.system = system.description();
  account.unknowns = a.size;
  account.entries = linear::entriesOf(a);
  account.bandwidths = system.bandwidths();
  if (s.isDirect && !isStudy) return solveDirectly(app, s, system, account);
  checkDivisible(app.ranks(), a, preconditionerKind);
  const examples::OwnedSpace owned(app.ranks(), app.device(), linear::shapeOf(a), examples::Ends::Joined);
  const examples::Space& space = owned.get();
  sk::Device& device = space.device();
  if (isStudy && a.size > 0) {
    const examples::Stopwatch watch;
    const std::string table =
        linear::studyPrecisions(device, system, {methodKind, preconditionerKind, s.layout, s.solve});
    app.report(fmt::format("study of {}", system.description()), device.name(), watch.milliseconds());
    fmt::print("\n{}", table);
    return;
  }
  account.device = device.name();
  linear::Solution solution;
  if (a.size > 0) {
    linear::checkMemory(
        device, a, system.description(),
        {methodKind, preconditionerKind, s.layout, arithmetic, s.restart, app.ranks().count()});
    const std::unique_ptr<linear::Matrix> matrix =
        linear::makeMatrix(space, a, s.layout, arithmetic, &account.costs);
    linear::checkSymmetry(device, *matrix, arithmetic, methodKind, preconditionerKind, a);
    const std::unique_ptr<linear::Preconditioner> preconditioner =
        preconditionerKind.make(device, *matrix, a, arithmetic,
                                {.omega = s.omega,
                                 .ordering = s.ordering,
                                 .drop = s.drop,
                                 .fill = s.fill,
                                 .before = s.sweeps[0],
                                 .after = s.sweeps[1]});
    const std::unique_ptr<linear::Method> method = methodKind.make(
        device, *matrix, preconditioner.get(), arithmetic, {.restart = s.restart, .omega = s.omega, .a = &a});
    if (preconditioner && preconditioner->hierarchy() != nullptr)
      account.hierarchy = *preconditioner->hierarchy();
    account.layout = matrix->layout();
    account.stored = matrix->stored();
    account.offsetBits = matrix->offsetBits();
    examples::Progress progress("solve", s.solve.most);
    if (space.isFirst()) s.solve.progress = [&](std::int64_t done, double) { progress.update(done); };
    solution = linear::solve(*method, a, system.rightHandSide(), arithmetic, s.solve);
    progress.clear();
    if (!s.json.empty() && preconditioner != nullptr) account.rates = preconditioner->rates();
  } else {
    solution.outcome = linear::Outcome::Converged;
  }

  app.report(
      fmt::format("{}, {} unknowns, {}", account.system, account.unknowns, linear::nameOf(solution.outcome)),
      examples::placeOf(app.ranks(), device.name()), solution.seconds * 1000.0);
  fmt::print("{}{}", linear::textOf(account, solution),
             linear::textChart(solution.history, s.solve.tolerance));
  if (const std::string advice = adviceFor(methodKind, preconditionerKind, arithmetic, solution);
      !advice.empty())
    fmt::print("{}\n", advice);
  if (s.isJudged) judge(system, solution, account);
  if (space.isFirst()) writeFiles(s, system, account, solution);
  verify(app, s, solution);
}

void study(examples::Application& app, std::string_view name) {
  const examples::Study& kind = examples::rowNamed(linear::studyKinds(), name, "study");
  sk::Device device(app.device());
  const examples::Stopwatch watch;
  const std::string table = kind.run(device, false).table;
  app.report(fmt::format("study of {}", kind.does), device.name(), watch.milliseconds());
  fmt::print("\n{}", table);
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  examples::Application app("solve",
                            "Solves systems of linear equations, and says what has really been reached.",
                            examples::joinRanks());
  addOptions(app.options(), settings);
  return app.run(argc, argv, [&] {
    if (settings.matrix.empty() && !settings.study.empty()) {
      app.ranks().refuseSeveral("--study", "start it without mpirun");
      return study(app, settings.study);
    }
    if (settings.matrix.empty())
      throw std::runtime_error("no matrix is named; try poisson:256x256, or a Matrix Market file");
    try {
      solveSystem(app, settings);
    } catch (const std::bad_alloc&) {
      throw std::runtime_error("the matrix does not fit in memory");
    }
  });
}
