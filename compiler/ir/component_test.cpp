// SPDX-License-Identifier: MIT
//
// Promises: a component is extracted from constructors, swizzles and operators, and keeps its meaning.
#include "ir/component.hpp"

#include <catch2/catch.hpp>

#include "ir/kernel_builder.hpp"
#include "ir/print.hpp"

namespace skc::ir {
namespace {

const Type int2 = Type::of(Scalar::Int, 2), int3 = Type::of(Scalar::Int, 3);

/// Component `number` of the expression that `make` builds from variables `v`, an int2, and `s`, an int.
template <class Make>
std::string component(Make make, std::uint8_t number) {
  Module module = testModule();
  Function function;
  const VarId v = addVariable(function, "v", int2), s = addVariable(function, "s", intType);
  const ExprPtr vector = make(function, v, s);
  return print(module, function, *componentOf(*vector, number));
}

TEST_CASE("components come out of constructors and swizzles") {
  const auto whole = [](const Function& f, VarId v, VarId s) {
    return construct(int3, exprs(varRef(f, v), varRef(f, s)));
  };
  CHECK(component(whole, 0) == "v.x");
  CHECK(component(whole, 1) == "v.y");
  CHECK(component(whole, 2) == "s");
  const auto splat = [](const Function& f, VarId, VarId s) { return construct(int2, exprs(varRef(f, s))); };
  CHECK(component(splat, 1) == "s");
  const auto turned = [](const Function& f, VarId v, VarId) { return swizzle(varRef(f, v), "yx"); };
  CHECK(component(turned, 0) == "v.y");
}

TEST_CASE("operators by component, also of a vector and a scalar") {
  const auto product = [](const Function& f, VarId v, VarId s) {
    return binary(BinaryOp::Mul, varRef(f, s), unary(UnaryOp::Negate, varRef(f, v)));
  };
  CHECK(component(product, 1) == "s * -v.y");
  const auto converted = [](const Function& f, VarId v, VarId) {
    return convert(Scalar::Float, varRef(f, v));
  };
  CHECK(component(converted, 0) == "float(v.x)");
}

TEST_CASE("a matrix times a vector is not taken apart") {
  const auto product = [](const Function& f, VarId v, VarId) {
    return binary(BinaryOp::Mul, construct(Type::matrix(2), exprs(literal(1.0F))),
                  convert(Scalar::Float, varRef(f, v)));
  };
  CHECK(component(product, 1).ends_with(".y"));
}

}  // namespace
}  // namespace skc::ir
