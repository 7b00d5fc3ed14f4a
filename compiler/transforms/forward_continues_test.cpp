// SPDX-License-Identifier: MIT
//
// Promises: no `continue` remains in a switch nested in another switch of its loop; all others stay.
#include "transforms/passes.hpp"

#include <catch2/catch.hpp>

#include "ir/kernel_builder.hpp"
#include "ir/print.hpp"
#include "ir/validate.hpp"
#include "support/diagnostics.hpp"

namespace skc {
namespace {

using namespace ir;

struct SwitchKernel {
  Module module = testModule();
  KernelBuilder k{module, "f"};
  VarId x = k.input("x", intType);
  VarId r = k.output("r", intType);

  /// switch (x) { case 1: body }
  Stmt choice(Block body) {
    std::vector<Case> cases;
    cases.push_back({{1}, false, std::move(body), {}});
    return switchStmt(k.ref(x), std::move(cases));
  }

  /// The body after the transform.
  std::string forwarded(Block body) {
    const KernelId id = k.finish(std::move(body));
    DiagnosticLog log;
    forwardContinues(module, log);
    CHECK(validate(module, Stage::Specialized) == "");
    const std::string text = print(module, module.functions[module.kernels[id].entry]);
    return text.substr(text.find('{'));
  }
};

TEST_CASE("a continue leaves one switch after the other") {
  SwitchKernel s;
  CHECK(s.forwarded(block(assign(s.k.ref(s.r), literal(0)),
                          whileLoop(literal(true),
                                    block(s.choice(block(s.choice(block(continueStmt())), breakStmt())))))) ==
        R"({
  r = 0;
  while (true) {
    switch (x) {
      case 1:
        {
          bool continues = false;
          switch (x) {
            case 1:
              {
                continues = true;
                break;
              }
          }
          if (continues) {
            continue;
          }
        }
        break;
    }
  }
}
)");
}

TEST_CASE("a continue of one switch stays, and one of a loop inside of switches") {
  SwitchKernel a, b;
  CHECK(a.forwarded(block(assign(a.k.ref(a.r), literal(0)),
                          whileLoop(literal(true), block(a.choice(block(continueStmt()))))))
            .find("continues") == std::string::npos);
  CHECK(b.forwarded(block(assign(b.k.ref(b.r), literal(0)),
                          b.choice(block(b.choice(block(whileLoop(literal(true), block(continueStmt()))))))))
            .find("continues") == std::string::npos);
}

}  // namespace
}  // namespace skc
