// SPDX-License-Identifier: MIT
//
// Promises: a kernel that checks assertions has what their conditions need, and no other streams and statements; a condition
// that depends on an accumulator, also by the branch in which it stands, is an error at the place that reads it.
#include "split/passes.hpp"

#include <catch2/catch.hpp>

#include "ir/kernel_builder.hpp"
#include "ir/print.hpp"
#include "ir/validate.hpp"

namespace skc::split {
namespace {

using namespace ir;
using enum BinaryOp;

/// `if (failed == 0 && !(value >= 0)) failed = number;`
Stmt assertion(KernelBuilder& k, VarId failed, ExprPtr value, std::int32_t number) {
  ExprPtr fails = unary(UnaryOp::LogicalNot, binary(GreaterEqual, std::move(value), literal(0.0f)));
  ExprPtr isFirst = binary(Equal, k.ref(failed), literal(0));
  return ifStmt(binary(LogicalAnd, std::move(isFirst), std::move(fails)),
                block(assign(k.ref(failed), literal(number))), {});
}

/// A kernel and its check, which have one body. `total` is an accumulator of the kernel, and an output of the check.
Module asserting(bool dependsOnTotal) {
  Module module = testModule();
  for (const bool isCheck : {false, true}) {
    KernelBuilder k(module, "f");
    const VarId x = k.input("x", floatType), y = k.input("y", floatType);
    const VarId total = isCheck ? k.output("total", floatType) : k.accumulator("total", floatType);
    Block body;
    if (isCheck) {
      const VarId failed = k.output("failed", intType), root = k.local("root", floatType);
      body = block(assign(k.ref(failed), literal(0)), declare(root, k.ref(x)));
      body.push_back(assertion(k, failed, k.ref(dependsOnTotal ? total : root), 1));
    }
    body.push_back(assign(k.ref(total), Add, k.ref(y)));
    k.finish(std::move(body));
    module.kernels.back().isPart = isCheck;
  }
  module.assertions.push_back({"root >= 0", {}});
  module.kernels[0].assertions = AssertionCheck{1, {}};
  return module;
}

TEST_CASE("the check of a kernel is a slice of it") {
  Module module = asserting(false);
  DiagnosticLog log;
  sliceAssertions(module, log);
  CHECK(log.entries().empty());
  REQUIRE(module.kernels.size() == 2);
  const AssertionCheck& check = *module.kernels[0].assertions;
  CHECK(check.operands == std::vector<std::uint32_t>{0});
  const Kernel& kernel = module.kernels[check.check];
  CHECK(kernel.isPart);
  CHECK(print(module, module.functions[kernel.entry]) ==
        "  x: element float\n"
        "  failed: inout int\n"
        "  root: local float\n"
        "{\n"
        "  failed = 0;\n"
        "  float root = x;\n"
        "  if (failed == 0 && !(root >= 0.0)) {\n"
        "    failed = 1;\n"
        "  }\n"
        "}\n");
}

TEST_CASE("an assertion about an accumulator is an error") {
  Module module = asserting(true);
  DiagnosticLog log;
  sliceAssertions(module, log);
  REQUIRE(log.entries().size() == 1);
  CHECK(log.entries()[0].diag == Diag::AssertFolded);
  CHECK(log.entries()[0].text.starts_with("an assertion of 'f' depends on 'total'"));
}

}  // namespace
}  // namespace skc::split
