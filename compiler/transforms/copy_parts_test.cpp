// SPDX-License-Identifier: MIT
//
// Promises: a function that writes a part of a part gets a variable if its call has an expression; everything else stays.
#include "transforms/passes.hpp"

#include <catch2/catch.hpp>

#include "ir/kernel_builder.hpp"
#include "ir/print.hpp"
#include "ir/validate.hpp"
#include "support/diagnostics.hpp"

namespace skc {
namespace {

using namespace ir;
using enum BinaryOp;

struct PartsKernel {
  Module module = testModule();
  FunctionId write;
  Type pair;
  KernelBuilder k{module, "f"};
  VarId x = k.input("x", intType);
  VarId r = k.output("r", floatType);
  VarId p;

  PartsKernel() {
    const Type items = arrayOf(module, intType, 2);
    Struct record;
    record.name = "Pair";
    record.fields = {{"items", items}, {"count", intType}};
    module.structs.push_back(std::move(record));
    pair = Type::structType(static_cast<std::uint32_t>(module.structs.size() - 1));
    Function function;
    function.name = "write";
    const VarId to = addVariable(function, "to", intType, VarRole::InOut);
    const VarId by = addVariable(function, "by", intType, VarRole::In);
    function.parameterCount = 2;
    Block body = block(assign(varRef(function, to), varRef(function, by)));
    write = addFunction(module, std::move(function), std::move(body));
    p = k.local("p", pair);
  }

  ExprPtr item(ExprPtr at) { return index(module, member(module, k.ref(p), 0), std::move(at)); }
  ExprPtr sum() { return binary(Add, k.ref(x), literal(1)); }
  Stmt call(ExprPtr place, ExprPtr value) {
    return callStmt(write, exprs(std::move(place), std::move(value)));
  }

  /// The statement after the transform, behind assignments of the variables.
  std::string copied(Stmt stmt) {
    const KernelId id = k.finish(block(declare(p), assign(k.ref(r), literal(0.0F)), std::move(stmt)));
    DiagnosticLog log;
    copyParts(module, log);
    CHECK(validate(module, Stage::Specialized) == "");
    const std::string text = print(module, module.functions[module.kernels[id].entry]);
    const std::size_t begin = text.find("r = 0.0;\n") + 9;
    return text.substr(begin, text.rfind('}') - begin);
  }
};

TEST_CASE("a part of a part is passed through a variable if the call has an expression") {
  PartsKernel a, b, c;
  CHECK(a.copied(a.call(a.item(literal(1)), a.sum())) == R"(  {
    int part = p.items[1];
    write(part, x + 1);
    p.items[1] = part;
  }
)");
  CHECK(b.copied(b.call(b.item(b.k.ref(b.x)), literal(3))) == R"(  {
    int part = p.items[x];
    write(part, 3);
    p.items[x] = part;
  }
)");
  CHECK(c.copied(c.call(member(c.module, c.k.ref(c.p), 1), c.sum())) == "  write(p.count, x + 1);\n");
}

TEST_CASE("a call without expressions stays") {
  PartsKernel a;
  CHECK(a.copied(a.call(a.item(literal(1)), a.k.ref(a.x))) == "  write(p.items[1], x);\n");
}

}  // namespace
}  // namespace skc
