// SPDX-License-Identifier: MIT
//
// Promises: a gather at the domain's index plus constants becomes a neighbour, in whatever way the index is
// computed; at any other index, or the index of another element, it stays a gather.
#include "transforms/passes.hpp"

#include <functional>

#include <catch2/catch.hpp>

#include "ir/kernel_builder.hpp"
#include "ir/print.hpp"
#include "ir/validate.hpp"
#include "support/diagnostics.hpp"

namespace skc {
namespace {

using namespace ir;
using enum BinaryOp;

const Type int2 = Type::of(Scalar::Int, 2);
constexpr StreamRef domain{StreamRef::Space::Domain, 0};

ExprPtr here(std::string_view components = "xy") { return swizzle(indexOf(domain), components); }
ExprPtr pair(ExprPtr x, ExprPtr y) { return construct(int2, exprs(std::move(x), std::move(y))); }

/// The value of `r` after the transform, where `make` builds the index of a gather of rank 2 from locals `p`,
/// initialised with `pValue`, and `x`, an input.
std::string read(const std::function<ExprPtr(KernelBuilder&, VarId p, VarId x)>& make,
                 ExprPtr pValue = here(), bool changes = false) {
  Module module = testModule();
  KernelBuilder k(module, "f");
  const VarId a = k.gather("a", floatType, 2);
  const VarId x = k.input("x", intType);
  const VarId r = k.output("r", floatType);
  const VarId p = k.local("p", int2);
  Block body = block(declare(p, std::move(pValue)));
  if (changes) body.push_back(assign(swizzle(k.ref(p), "x"), Add, k.ref(x)));
  body.push_back(
      assign(k.ref(r), gatherRead(floatType, {StreamRef::Space::KernelParameter, a}, make(k, p, x))));
  k.finish(std::move(body));
  DiagnosticLog log;
  findNeighbors(module, log);
  REQUIRE(validate(module, Stage::Specialized) == "");
  const std::string text = print(module, module.functions[0]);
  const std::size_t start = text.find("r = ") + 4;
  return text.substr(start, text.find(';', start) - start);
}

TEST_CASE("an index of the domain plus constants is a neighbour") {
  CHECK(read([](KernelBuilder& k, VarId p, VarId) { return k.ref(p); }) == "neighbor($0, int2{0, 0})");
  CHECK(read([](KernelBuilder& k, VarId p, VarId) {
          return pair(binary(Sub, swizzle(k.ref(p), "x"), literal(1)),
                      binary(Add, literal(2), swizzle(k.ref(p), "y")));
        }) == "neighbor($0, int2{-1, 2})");
  CHECK(read([](KernelBuilder& k, VarId p, VarId) {
          return binary(Add, k.ref(p), pair(literal(3), literal(-4)));
        }) == "neighbor($0, int2{3, -4})");
  CHECK(read([](KernelBuilder& k, VarId p, VarId) { return k.ref(p); },
             binary(Sub, here(), construct(int2, exprs(literal(1))))) == "neighbor($0, int2{-1, -1})");
  CHECK(read([](KernelBuilder&, VarId, VarId) { return pair(here("x"), here("y")); }) ==
        "neighbor($0, int2{0, 0})");
}

TEST_CASE("other indices stay") {
  const auto stays = [](const std::string& text) { return text.starts_with("$0["); };
  CHECK(stays(read([](KernelBuilder& k, VarId p, VarId) { return swizzle(k.ref(p), "yx"); })));
  CHECK(
      stays(read([](KernelBuilder& k, VarId p, VarId) { return pair(swizzle(k.ref(p), "x"), literal(0)); })));
  CHECK(stays(read([](KernelBuilder& k, VarId p, VarId) { return binary(Mul, k.ref(p), literal(2)); })));
  CHECK(stays(read([](KernelBuilder& k, VarId p, VarId) { return unary(UnaryOp::Negate, k.ref(p)); })));
  CHECK(stays(read(
      [](KernelBuilder& k, VarId p, VarId) { return binary(Sub, pair(literal(1), literal(1)), k.ref(p)); })));
  CHECK(stays(read([](KernelBuilder& k, VarId p, VarId x) {
    return pair(binary(Add, swizzle(k.ref(p), "x"), k.ref(x)), swizzle(k.ref(p), "y"));
  })));
  CHECK(stays(read([](KernelBuilder& k, VarId p, VarId) { return k.ref(p); }, here(), true)));
}

TEST_CASE("an input's index may be another than the domain's") {
  CHECK(read([](KernelBuilder& k, VarId p, VarId) { return k.ref(p); },
             swizzle(indexOf({StreamRef::Space::KernelParameter, 1}), "xy"))
            .starts_with("$0["));
}

TEST_CASE("an offset that might overflow stays an index") {
  CHECK(read([](KernelBuilder& k, VarId p, VarId) {
          return pair(binary(Add, swizzle(k.ref(p), "x"), literal(1 << 30)), swizzle(k.ref(p), "y"));
        }).starts_with("$0["));
}

}  // namespace
}  // namespace skc
