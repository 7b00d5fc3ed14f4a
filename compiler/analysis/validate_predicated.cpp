// SPDX-License-Identifier: MIT
#include "analysis/validate_predicated.hpp"

#include <fmt/format.h>

#include "analysis/uniformity.hpp"
#include "ir/reach.hpp"
#include "ir/validate.hpp"
#include "ir/walk.hpp"

namespace skc::analysis {

using namespace ir;

std::string validatePredicated(const Module& module) {
  std::string violation = validate(module, Stage::Predicated);
  for (const Kernel& kernel : module.kernels) {
    if (!violation.empty()) return violation;
    const Uniformity uniformity(module, kernel);
    for (const FunctionId id : functionsOf(module, kernel)) {
      const Function& function = module.functions[id];
      walkStmts(function.body, [&](const Stmt& stmt) {
        if (!violation.empty() || !uniformity.diverges(id, stmt)) return;
        violation = fmt::format("kernel {}: function @{} '{}': line {}: control flow diverges", kernel.name, id,
                                function.name, stmt.loc.line);
      });
    }
  }
  return violation;
}

}  // namespace skc::analysis
