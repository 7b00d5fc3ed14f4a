// SPDX-License-Identifier: MIT
#include "study.hpp"

#include <algorithm>
#include <optional>
#include <string_view>

#include <fmt/format.h>

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

Solution solveWith(sk::Device& device, const System& system, const StudyChoices& choices,
                   const Arithmetic& arithmetic, bool refines) {
  const std::unique_ptr<Matrix> matrix = system.makeMatrix(device, choices.layout, arithmetic, nullptr);
  const std::unique_ptr<Preconditioner> preconditioner =
      choices.preconditioner.make(device, *matrix, system.matrix(), arithmetic);
  const std::unique_ptr<Method> method =
      choices.method.make(device, *matrix, preconditioner.get(), arithmetic);
  SolveSettings settings = choices.settings;
  settings.refines = refines;
  solve(*method, system.matrix(), system.rightHandSide(), arithmetic, settings);  // builds programs
  return solve(*method, system.matrix(), system.rightHandSide(), arithmetic, settings);
}

}  // namespace

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
