// SPDX-License-Identifier: MIT
//
// Promises: the transforms run in the order of transformNames(), and stop at an error.
#include "transforms/transforms.hpp"

#include <cassert>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "ir/kernel_builder.hpp"
#include "ir/validate.hpp"
#include "support/diagnostics.hpp"

namespace skc {
namespace {

using namespace ir;

Module sumModule(BinaryOp op) {
  Module module = testModule();
  KernelBuilder k(module, "sum");
  const VarId x = k.input("x", floatType);
  const VarId total = k.accumulator("total", floatType);
  k.finish(block(assign(k.ref(total), op, k.ref(x))));
  return module;
}

TEST_CASE("every transform is told once, in order, with a valid module") {
  Module module = sumModule(BinaryOp::Add);
  DiagnosticLog log;
  std::vector<std::string> visited;
  runTransforms(module, log, {.after = [&](std::string_view name, const Module& now) {
                  visited.emplace_back(name);
                  CHECK(validate(now, Stage::Specialized).empty());
                }});
  CHECK(visited == std::vector<std::string>(transformNames().begin(), transformNames().end()));
  CHECK(visited.size() == 25);
}

TEST_CASE("nothing runs after an error") {
  Module module = sumModule(BinaryOp::Sub);
  DiagnosticLog log;
  std::vector<std::string> visited;
  runTransforms(module, log,
                {.after = [&](std::string_view name, const Module&) { visited.emplace_back(name); }});
  CHECK(log.hasErrors());
  CHECK(visited == std::vector<std::string>{"specialize-gathers", "expand-powers", "tabulate",
                                            "fold-constants", "slice-assertions", "unroll-spec-loops",
                                            "unroll-loops", "find-neighbors", "find-reach", "guard-streams",
                                            "bound-pushes", "inline-folds"});
}

TEST_CASE("builds with tests check assertions and validate the IR", "[transforms]") {
  bool isChecked = false;
  assert((isChecked = true));
  CHECK(isChecked);
  CHECK(validatesTransforms());
}

}  // namespace
}  // namespace skc
