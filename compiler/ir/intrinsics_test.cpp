// SPDX-License-Identifier: MIT
//
// Promises: signatures mean what the opening comment of intrinsics.def says.
#include "ir/intrinsics.hpp"

#include <initializer_list>
#include <set>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

namespace skc::ir {
namespace {

constexpr Type f(int width = 1) { return Type::of(Scalar::Float, width); }
constexpr Type i(int width = 1) { return Type::of(Scalar::Int, width); }
constexpr Type u(int width = 1) { return Type::of(Scalar::Uint, width); }
constexpr Type d(int width = 1) { return Type::of(Scalar::Double, width); }
constexpr Type b(int width = 1) { return Type::of(Scalar::Bool, width); }

std::optional<Type> result(Intrinsic intrinsic, std::initializer_list<Type> arguments) {
  return resultType(intrinsic, std::vector<Type>(arguments));
}

TEST_CASE("generic letters have one width throughout") {
  CHECK(result(Intrinsic::Sin, {f(3)}) == f(3));
  CHECK(result(Intrinsic::Pow, {f(2), f(2)}) == f(2));
  CHECK_FALSE(result(Intrinsic::Pow, {f(2), f(3)}));
  CHECK_FALSE(result(Intrinsic::Sin, {i()}));
  CHECK_FALSE(result(Intrinsic::Sin, {}));
}

TEST_CASE("component types are the same throughout where the letter says so") {
  CHECK(result(Intrinsic::Min, {i(2), i(2)}) == i(2));
  CHECK(result(Intrinsic::Min, {u(4), u()}) == u(4));
  CHECK(result(Intrinsic::Clamp, {f(3), f(), f()}) == f(3));
  CHECK_FALSE(result(Intrinsic::Min, {i(), f()}));
  CHECK_FALSE(result(Intrinsic::Min, {b(), b()}));
  CHECK_FALSE(result(Intrinsic::Abs, {u()}));
  CHECK(result(Intrinsic::Mulhi, {u(3), u(3)}) == u(3));
  CHECK(result(Intrinsic::Popcount, {u(2)}) == i(2));
  CHECK_FALSE(result(Intrinsic::Mulhi, {i(), u()}));
  CHECK_FALSE(result(Intrinsic::Clz, {f()}));
}

TEST_CASE("results of another component type") {
  CHECK(result(Intrinsic::Isnan, {f(2)}) == b(2));
  CHECK(result(Intrinsic::Ldexp, {f(2), i(2)}) == f(2));
  CHECK(result(Intrinsic::FloatBitsToUint, {f(4)}) == u(4));
  CHECK(result(Intrinsic::Dot, {f(4), f(4)}) == f());
  CHECK(result(Intrinsic::Cross, {f(3), f(3)}) == f(3));
  CHECK_FALSE(result(Intrinsic::Cross, {f(2), f(2)}));
}

TEST_CASE("doubles have what their letters and the generic ones say") {
  CHECK(result(Intrinsic::Sqrt, {d(3)}) == d(3));
  CHECK(result(Intrinsic::Min, {d(2), d()}) == d(2));
  CHECK(result(Intrinsic::Sign, {d(4)}) == d(4));
  CHECK(result(Intrinsic::Dot, {d(4), d(4)}) == d());
  CHECK(result(Intrinsic::Cross, {d(3), d(3)}) == d(3));
  CHECK(result(Intrinsic::LessThan, {d(2), d(2)}) == b(2));
  CHECK(result(Intrinsic::Sin, {d(2)}) == d(2));
  CHECK_FALSE(result(Intrinsic::FloatBitsToUint, {d()}));
  CHECK_FALSE(result(Intrinsic::Min, {d(), f()}));
}

TEST_CASE("comparisons are of vectors only") {
  CHECK(result(Intrinsic::LessThan, {i(3), i(3)}) == b(3));
  CHECK(result(Intrinsic::EqualTo, {b(2), b(2)}) == b(2));
  CHECK_FALSE(result(Intrinsic::LessThan, {b(2), b(2)}));
  CHECK_FALSE(result(Intrinsic::LessThan, {f(), f()}));
  CHECK(result(Intrinsic::Any, {b()}) == b());
}

TEST_CASE("every row has a signature, and the function that it calls, and stands at its place") {
  for (const IntrinsicRow& entry : intrinsicRows()) {
    INFO(entry.name);
    CHECK(&row(entry.id) == &entry);
    CHECK_FALSE(overloads(entry.id).empty());
    const bool callsOwn = entry.glsl.substr(0, 3) == "sk_";
    CHECK(callsOwn == !entry.polyfill.empty());
  }
}

TEST_CASE("rows that share a spelling never fit the same arguments") {
  std::set<std::string> seen;
  for (const IntrinsicRow& entry : intrinsicRows()) {
    if (entry.spelling.empty()) continue;
    for (const IntrinsicOverload& one : overloads(entry.id)) {
      std::string key(entry.spelling);
      for (Type type : one.arguments) {
        key += "," + std::to_string(static_cast<int>(type.scalar)) + "x" + std::to_string(type.width);
      }
      INFO(key);
      CHECK(seen.insert(key).second);
    }
  }
}

}  // namespace
}  // namespace skc::ir
