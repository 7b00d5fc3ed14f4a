// SPDX-License-Identifier: MIT
//
// Promises: each case of derive-combine, with its identity and its start.
#include "transforms/passes.hpp"

#include <functional>
#include <limits>

#include <catch2/catch.hpp>

#include "ir/kernel_builder.hpp"
#include "ir/print.hpp"
#include "ir/validate.hpp"
#include "support/diagnostics.hpp"

namespace skc {
namespace {

using namespace ir;
using enum BinaryOp;

constexpr VarId x = 0, total = 1;

struct Outcome {
  std::string combine = {};    ///< "entry", the body of a synthesized function, or empty
  std::string identity = {};   ///< empty if none
  bool seeded = false;
  std::string error = {};
};

using Body = std::function<Block(Module&, KernelBuilder&)>;

Outcome derive(Type element, Type accumulator, ExprPtr identity, const Body& body,
               const std::function<void(Module&)>& prepare = {}) {
  Module module = testModule();
  module.structs.push_back({"Stats", {}, {{"sum", floatType}, {"low", floatType}, {"count", intType}}, {}});
  KernelBuilder k(module, "fold", 3);
  k.input("x", element);
  k.accumulator("total", accumulator, std::move(identity));
  k.local("y", floatType);
  Block statements = body(module, k);
  k.finish(std::move(statements));
  if (prepare) prepare(module);
  REQUIRE(validate(module, Stage::Specialized) == "");
  DiagnosticLog log;
  deriveCombine(module, log);
  if (log.hasErrors()) return {.error = log.entries()[0].text};
  REQUIRE(validate(module, Stage::Specialized) == "");
  const Kernel& kernel = module.kernels[0];
  Outcome outcome{.seeded = kernel.reduction->seeded};
  REQUIRE(kernel.reduction->combine);
  const KernelId combine = *kernel.reduction->combine;
  const std::string text = print(module, module.functions[module.kernels[combine].entry]);
  outcome.combine = combine == 0 ? "entry" : text.substr(text.find('{'));
  if (kernel.params[1].identity) outcome.identity = print(module, Function{}, *kernel.params[1].identity);
  return outcome;
}

Outcome derive(const Body& body) { return derive(floatType, floatType, nullptr, body); }
Block fold(KernelBuilder& k, BinaryOp op, ExprPtr value) {
  return block(assign(k.ref(total), op, std::move(value)));
}

/// The module after derive-combine, with a reduce that `make` declares.
Module derived(const std::function<void(Module&)>& make) {
  Module module = testModule();
  make(module);
  REQUIRE(validate(module, Stage::Specialized) == "");
  DiagnosticLog log;
  deriveCombine(module, log);
  REQUIRE_FALSE(log.hasErrors());
  REQUIRE(validate(module, Stage::Specialized) == "");
  return module;
}

TEST_CASE("x itself: the entry combines, and without an identity the fold starts with its first element") {
  const Outcome sum = derive([](Module&, KernelBuilder& k) { return fold(k, Add, k.ref(x)); });
  CHECK(sum.combine == "entry");
  CHECK(sum.seeded);
  CHECK(sum.identity == "0.0");
  const Outcome given = derive(floatType, floatType, literal(0.0F),
                               [](Module&, KernelBuilder& k) { return fold(k, Add, k.ref(x)); });
  CHECK(given.combine == "entry");
  CHECK_FALSE(given.seeded);
}

TEST_CASE("a reduce keeps its pattern, and none if it folds in another way") {
  const auto patternOf = [](ExprPtr (*value)(KernelBuilder&)) {
    const Module module = derived([&](Module& m) {
      KernelBuilder k(m, "f");
      k.input("x", floatType);
      k.accumulator("total", floatType);
      k.finish(block(assign(k.ref(total), value(k))));
    });
    return module.kernels[0].reduction->pattern;
  };
  const auto product = patternOf([](KernelBuilder& k) { return binary(Mul, k.ref(x), k.ref(total)); });
  REQUIRE(product);
  CHECK(product->isPlain);
  REQUIRE(product->targets.size() == 1);
  CHECK(product->targets[0].op == FoldOp(Mul));
  CHECK(product->targets[0].isWhole());
  CHECK_FALSE(patternOf([](KernelBuilder& k) {
    return select(binary(BinaryOp::Less, k.ref(x), k.ref(total)), k.ref(x), k.ref(total));
  }));
}

TEST_CASE("the other ways to write it") {
  const Body bodies[] = {[](Module&, KernelBuilder& k) {
                           return block(assign(k.ref(total), binary(Mul, k.ref(total), k.ref(x))));
                         },
                         [](Module&, KernelBuilder& k) {
                           return block(assign(k.ref(total), binary(Mul, k.ref(x), k.ref(total))));
                         },
                         [](Module&, KernelBuilder& k) { return fold(k, Mul, k.ref(x)); }};
  for (const Body& body : bodies) {
    const Outcome outcome = derive(body);
    CHECK(outcome.combine == "entry");
    CHECK(outcome.identity == "1.0");
  }
}

TEST_CASE("chains of sums and differences; more than x itself is not combined by the entry") {
  const auto chain = [](BinaryOp second, bool isNested) {
    return [=](Module&, KernelBuilder& k) {
      ExprPtr sum = binary(Add, k.ref(total), literal(1.0F));
      ExprPtr value =
          isNested ? binary(second, k.ref(x), std::move(sum)) : binary(second, std::move(sum), k.ref(x));
      return block(assign(k.ref(total), std::move(value)));
    };
  };
  for (const Body& body : {Body(chain(Add, false)), Body(chain(Sub, false)), Body(chain(Add, true))}) {
    CHECK(derive(body).combine == "{\n  total += total_part;\n}\n");
  }
  CHECK(derive(chain(Sub, true)).combine.empty());   // x - (total + 1) is not associative
}

TEST_CASE("min and max") {
  const auto body = [](Intrinsic intrinsicId) {
    return [intrinsicId](Module&, KernelBuilder& k) {
      return block(assign(k.ref(total), intrinsic(intrinsicId, exprs(k.ref(total), k.ref(x)))));
    };
  };
  CHECK(derive(body(Intrinsic::Min)).identity == "inf");
  CHECK(derive(body(Intrinsic::Max)).identity == "-inf");
  CHECK(derive(body(Intrinsic::Fmax)).combine == "entry");
  CHECK(derive(intType, intType, nullptr, body(Intrinsic::Min)).identity == "2147483647");
  CHECK(derive(intType, intType, nullptr, body(Intrinsic::Max)).identity == "-2147483648");
  const Type uint = Type::of(Scalar::Uint);
  CHECK(derive(uint, uint, nullptr, body(Intrinsic::Min)).identity == "4294967295u");
  CHECK(derive(uint, uint, nullptr, body(Intrinsic::Max)).identity == "0u");
}

TEST_CASE("bits and truth") {
  const auto bits = [](BinaryOp op) {
    return derive(intType, intType, nullptr,
                  [op](Module&, KernelBuilder& k) { return fold(k, op, k.ref(x)); });
  };
  CHECK(bits(BitAnd).identity == "-1");
  CHECK(bits(BitOr).identity == "0");
  CHECK(bits(BitXor).identity == "0");
  const auto truth = [](BinaryOp op) {
    const Type boolType = Type::of(Scalar::Bool);
    return derive(floatType, boolType, nullptr, [op](Module&, KernelBuilder& k) {
      ExprPtr test = binary(Less, k.ref(x), literal(0.0F));
      return block(assign(k.ref(total), binary(op, k.ref(total), std::move(test))));
    });
  };
  CHECK(truth(LogicalAnd).identity == "true");
  CHECK(truth(LogicalOr).identity == "false");
  CHECK(truth(LogicalAnd).combine == "{\n  total = total && total_part;\n}\n");
}

TEST_CASE("something made from x: a function combines, and runs start with the identity") {
  const Outcome outcome =
      derive([](Module&, KernelBuilder& k) { return fold(k, Add, binary(Mul, k.ref(x), k.ref(x))); });
  CHECK(outcome.combine == "{\n  total += total_part;\n}\n");
  CHECK(outcome.identity == "0.0");
  CHECK_FALSE(outcome.seeded);
}

TEST_CASE("through locals, branches and loops") {
  const Outcome outcome = derive([](Module&, KernelBuilder& k) {
    const VarId y = 2;
    return block(declare(y, binary(Mul, k.ref(x), k.ref(x))),
                 ifStmt(binary(Less, k.ref(y), literal(1.0F)), block(assign(k.ref(total), Add, k.ref(y)))));
  });
  CHECK(outcome.combine == "{\n  total += total_part;\n}\n");
}

TEST_CASE("another type of accumulator, member by member") {
  const Type stats = Type::structType(0);
  const Body body = [](Module& m, KernelBuilder& k) {
    const auto field = [&](std::uint32_t i) { return member(m, k.ref(total), i); };
    return block(assign(field(0), Add, k.ref(x)),
                 assign(field(1), intrinsic(Intrinsic::Min, exprs(field(1), k.ref(x)))),
                 assign(field(2), Add, literal(1)));
  };
  const Outcome outcome = derive(floatType, stats, nullptr, body);
  CHECK(outcome.combine ==
        "{\n  total.sum += total_part.sum;\n  total.low = min(total.low, total_part.low);\n"
        "  total.count += total_part.count;\n}\n");
  CHECK(outcome.identity == "Stats{0.0, inf, 0}");
  CHECK_FALSE(outcome.seeded);
}

TEST_CASE("the same type, member by member: still x itself") {
  const Type stats = Type::structType(0);
  const Body body = [](Module& m, KernelBuilder& k) {
    const auto field = [&](VarId var, std::uint32_t i) { return member(m, k.ref(var), i); };
    return block(assign(field(total, 1), intrinsic(Intrinsic::Min, exprs(field(total, 1), field(x, 1)))),
                 assign(field(total, 0), Add, field(x, 0)));
  };
  const Outcome outcome = derive(stats, stats, nullptr, body);
  CHECK(outcome.combine == "entry");
  CHECK(outcome.seeded);
  CHECK(outcome.identity.empty());   // the initial value of `count` is unknown
  const Outcome crossed = derive(stats, stats, nullptr, [](Module& m, KernelBuilder& k) {
    return block(assign(member(m, k.ref(total), 0), Add, member(m, k.ref(x), 1)));
  });
  CHECK(crossed.error.find("needs a value to start from") != std::string::npos);
}

TEST_CASE("vectors, whole and by component") {
  const Type float2 = Type::of(Scalar::Float, 2);
  const Outcome whole =
      derive(floatType, float2, nullptr, [](Module&, KernelBuilder& k) { return fold(k, Add, k.ref(x)); });
  CHECK(whole.combine == "{\n  total += total_part;\n}\n");
  CHECK(whole.identity == "float2{0.0}");
  const Outcome parts = derive(floatType, float2, nullptr, [](Module&, KernelBuilder& k) {
    return block(assign(swizzle(k.ref(total), "x"), Add, k.ref(x)),
                 assign(swizzle(k.ref(total), "y"), Mul, k.ref(x)));
  });
  CHECK(parts.combine == "{\n  total.x += total_part.x;\n  total.y *= total_part.y;\n}\n");
  CHECK(parts.identity == "float2{0.0, 1.0}");
  const auto swapped = [](Module&, KernelBuilder& k) {
    return block(assign(k.ref(total), Add, swizzle(k.ref(x), "yx")));
  };
  CHECK(derive(float2, float2, nullptr, swapped).combine == "{\n  total += total_part;\n}\n");
  const auto turned = [](Module&, KernelBuilder& k) {
    return block(assign(k.ref(total), binary(Add, swizzle(k.ref(total), "yx"), k.ref(x))));
  };
  CHECK(derive(float2, float2, nullptr, turned).identity.empty());  // it does not assign what it adds to
}

TEST_CASE("a general body on one type combines by itself; without an identity it starts with an element") {
  const Body last = [](Module&, KernelBuilder& k) {
    return block(ifStmt(binary(Less, k.ref(x), k.ref(total)), block(assign(k.ref(total), k.ref(x)))));
  };
  const Outcome outcome = derive(last);
  CHECK(outcome.combine == "entry");
  CHECK(outcome.seeded);
  CHECK(outcome.identity.empty());
  CHECK_FALSE(derive(floatType, floatType, literal(9.0F), last).seeded);
}

TEST_CASE(
    "x itself, twice, is no known operator, unless a loop repeats it; neither are overlapping components") {
  const auto add = [](KernelBuilder& k, std::uint32_t line) {
    Stmt stmt = assign(k.ref(total), Add, k.ref(x));
    stmt.loc = atLine(line);
    return stmt;
  };
  const Outcome twice = derive([&](Module&, KernelBuilder& k) { return block(add(k, 4), add(k, 5)); });
  CHECK(twice.error.find(
            "'fold' is not associative, so partial results do not combine: 1, 0.5 and 0.75 give 3.5 where "
            "the first two are folded first, and 5 where the last two are") == 0);
  const Outcome unrolled = derive([&](Module&, KernelBuilder& k) { return block(add(k, 4), add(k, 4)); });
  CHECK(unrolled.combine == "{\n  total += total_part;\n}\n");
  CHECK_FALSE(unrolled.seeded);

  const Type float2 = Type::of(Scalar::Float, 2);
  const auto by = [](KernelBuilder& k, const char* components, BinaryOp op, std::uint32_t line) {
    const auto part = [&](VarId var) {
      return components[1] == 0 ? swizzle(k.ref(var), components) : k.ref(var);
    };
    Stmt stmt = assign(part(total), op, part(x));
    stmt.loc = atLine(line);
    return stmt;
  };
  const auto overlapping = derive(float2, float2, nullptr, [&](Module&, KernelBuilder& k) {
    return block(by(k, "x", Add, 4), by(k, "y", Mul, 5), by(k, "xy", Add, 6));
  });
  CHECK(overlapping.error.find("'fold' is not associative") == 0);
  const auto reversed = derive(float2, float2, nullptr, [&](Module&, KernelBuilder& k) {
    return block(by(k, "xy", Add, 4), by(k, "x", Add, 5));
  });
  CHECK(reversed.error.find("'fold' is not associative") == 0);
  const auto disjoint = derive(float2, float2, nullptr, [&](Module&, KernelBuilder& k) {
    return block(by(k, "x", Add, 4), by(k, "y", Mul, 5));
  });
  CHECK(disjoint.combine == "entry");
}

TEST_CASE("a component that nothing folds keeps the first element's, so the order matters") {
  const Type float2 = Type::of(Scalar::Float, 2);
  for (const bool isWhole : {false, true}) {
    const Module module = derived([&](Module& m) {
      KernelBuilder k(m, "part");
      const VarId element = k.input("v", float2);
      const VarId sum = k.accumulator("sum", float2);
      const auto part = [&](VarId var) { return isWhole ? k.ref(var) : swizzle(k.ref(var), "x"); };
      k.finish(block(assign(part(sum), Add, part(element))));
    });
    CHECK(module.kernels[0].reduction->seeded);
    CHECK(module.kernels[0].reduction->commutative == isWhole);
  }
}

TEST_CASE("subtraction and division are errors that say what to do") {
  const auto error = [](BinaryOp op) {
    return derive([op](Module&, KernelBuilder& k) { return fold(k, op, k.ref(x)); }).error;
  };
  CHECK(error(Sub) ==
        "'-' is not associative, so it cannot fold into 'total'; write 'total += ...' and subtract once, "
        "from the result");
  CHECK(error(Div) ==
        "'/' is not associative, so it cannot fold into 'total'; write 'total *= ...' and divide once, by "
        "the result");
  const Outcome written = derive([](Module&, KernelBuilder& k) {
    return block(assign(k.ref(total), binary(Sub, k.ref(total), k.ref(x))));
  });
  CHECK(written.error.find("'-' is not associative") == 0);
}

TEST_CASE("a general body on two types needs an overload or an identity") {
  const Body general = [](Module&, KernelBuilder& k) {
    return block(ifStmt(binary(Less, convert(Scalar::Float, k.ref(x)), k.ref(total)),
                        block(assign(k.ref(total), convert(Scalar::Float, k.ref(x))))));
  };
  CHECK(
      derive(intType, floatType, literal(0.0F), general).error ==
      "how partial results of 'fold' combine does not follow from its body; fold each number by an operator, "
      "min or max, or add an overload that folds accumulators: 'reduce void fold(float total_part<>, reduce "
      "float total<>)'");
}

/// reduce void fold(float a<>, reduce float b<>) { b += a; }, as the author's overload.
void addOverload(Module& module) {
  KernelBuilder k(module, "fold", 9);
  const VarId a = k.input("a", floatType);
  const VarId b = k.accumulator("b", floatType);
  k.finish(block(assign(k.ref(b), Add, k.ref(a))));
  module.kernels[0].reduction = Reduction{1, {0, 0}, false};
}

/// reduce void fold(float a<>, reduce float b<>) { b = `combined` of a and b; }
void addCombination(Module& module, const std::function<ExprPtr(ExprPtr a, ExprPtr b)>& combined) {
  KernelBuilder k(module, "fold", 9);
  const VarId a = k.input("a", floatType);
  const VarId b = k.accumulator("b", floatType);
  k.finish(block(assign(k.ref(b), combined(k.ref(a), k.ref(b)))));
  module.kernels[0].reduction = Reduction{1, {0, 0}, false};
}

TEST_CASE("an overload has to combine as the fold does") {
  const Body sum = [](Module&, KernelBuilder& k) { return fold(k, Add, convert(Scalar::Float, k.ref(x))); };
  const auto withOverload = [&](const std::function<ExprPtr(ExprPtr, ExprPtr)>& combined, float identity) {
    return derive(intType, floatType, literal(identity), sum, [&](Module& m) { addCombination(m, combined); })
        .error;
  };
  CHECK(withOverload([](ExprPtr a, ExprPtr b) { return binary(Add, std::move(a), std::move(b)); }, 0) == "");
  CHECK(withOverload(
            [](ExprPtr a, ExprPtr b) { return intrinsic(Intrinsic::Max, exprs(std::move(a), std::move(b))); },
            0)
            .find("partial results of 'fold' do not combine to what it folds: 1, 6 and 7 give 14 one after "
                  "the other, and "
                  "13 where the result of the first is combined with that of the other two") == 0);
  const auto withoutOne = [](ExprPtr a, ExprPtr b) {
    return binary(Sub, binary(Add, std::move(a), std::move(b)), literal(1.0F));
  };
  CHECK(withOverload(withoutOne, 1) == "");   // each run starts from 1
  CHECK(withOverload(withoutOne, 0).find("partial results of 'fold' do not combine") == 0);
}

TEST_CASE("an overload may rely on what partial results are") {
  const Body least = [](Module&, KernelBuilder& k) {   // 0 stands for no element
    ExprPtr isLess = binary(Less, convert(Scalar::Float, k.ref(x)), k.ref(total));
    ExprPtr isFirst = binary(Equal, k.ref(total), literal(0.0F));
    return block(ifStmt(binary(LogicalOr, std::move(isFirst), std::move(isLess)),
                        block(assign(k.ref(total), convert(Scalar::Float, k.ref(x))))));
  };
  const auto overload = [](Module& m) {
    addCombination(m, [](ExprPtr a, ExprPtr b) {
      ExprPtr isEmpty = binary(Equal, clone(b), literal(0.0F)),
              nothing = binary(Equal, clone(a), literal(0.0F));
      ExprPtr lower = intrinsic(Intrinsic::Min, exprs(clone(a), clone(b)));
      return select(std::move(isEmpty), std::move(a),
                    select(std::move(nothing), std::move(b), std::move(lower)));
    });
  };
  CHECK(derive(intType, floatType, literal(0.0F), least, overload).error == "");
}

TEST_CASE("the author's overload stays, and an identity must be there or follow") {
  const Body general = [](Module&, KernelBuilder& k) {
    return block(assign(k.ref(total), binary(Sub, k.ref(total), convert(Scalar::Float, k.ref(x)))),
                 assign(k.ref(total), k.ref(total)));
  };
  CHECK(derive(intType, floatType, literal(0.0F), general, addOverload).combine == "{\n  b += a;\n}\n");
  CHECK(derive(intType, floatType, nullptr, general, addOverload).error ==
        "'fold' folds 'int' into 'float', so it needs a value to start from; write 'reduce float total<> = "
        "...'");
}

TEST_CASE("several accumulators combine each with its own part, and uniforms need not come along") {
  const Module module = derived([](Module& m) {
    KernelBuilder k(m, "stats");
    const VarId p = k.uniform("p", floatType);
    const VarId element = k.input("x", floatType);
    const VarId s = k.accumulator("s", floatType);
    const VarId high = k.accumulator("high", floatType);
    k.finish(block(assign(k.ref(s), Add, binary(Mul, k.ref(p), k.ref(element))),
                   assign(k.ref(high), intrinsic(Intrinsic::Max, exprs(k.ref(high), k.ref(element))))));
  });
  const Kernel& kernel = module.kernels[0];
  REQUIRE(*kernel.reduction->combine == 1);
  CHECK(print(module, Function{}, *kernel.params[2].identity) == "0.0");
  CHECK(print(module, Function{}, *kernel.params[3].identity) == "-inf");
  CHECK(module.kernels[1].isSynthesized);
  CHECK(print(module, module.functions[1]) ==
        "  s_part: element float\n  high_part: element float\n  s: inout float\n  high: inout float\n"
        "{\n  s += s_part;\n  high = max(high, high_part);\n}\n");
}

TEST_CASE("elements of the accumulators' types, one by one, are folded like them") {
  const auto crossed = [](bool isCrossed) {
    return derived([&](Module& m) {
      KernelBuilder k(m, "both");
      const VarId a = k.input("a", floatType);
      const VarId b = k.input("b", floatType);
      const VarId s = k.accumulator("s", floatType);
      const VarId t = k.accumulator("t", floatType);
      k.finish(block(assign(k.ref(s), Add, k.ref(isCrossed ? b : a)),
                     assign(k.ref(t), Mul, k.ref(isCrossed ? a : b))));
    });
  };
  CHECK(crossed(false).kernels.size() == 1);
  CHECK(crossed(false).kernels[0].reduction->seeded);
  CHECK(crossed(true).kernels.size() == 2);
}

TEST_CASE("narrow accumulators are computed in their arithmetic types") {
  const Type half = Type::of(Scalar::Half);
  const Outcome outcome = derive(floatType, half, nullptr, [](Module&, KernelBuilder& k) {
    ExprPtr sum = binary(Add, convert(Scalar::Float, k.ref(total)), k.ref(x));
    return block(assign(k.ref(total), convert(Scalar::Half, std::move(sum))));
  });
  CHECK(outcome.combine == "{\n  total = half(float(total) + float(total_part));\n}\n");
  CHECK(outcome.identity == "half(0.0)");
  const Type uchar = Type::of(Scalar::Uchar);
  const Outcome least = derive(intType, uchar, nullptr, [](Module&, KernelBuilder& k) {
    ExprPtr low = intrinsic(Intrinsic::Min, exprs(convert(Scalar::Int, k.ref(total)), k.ref(x)));
    return block(assign(k.ref(total), convert(Scalar::Uchar, std::move(low))));
  });
  CHECK(least.identity == "uchar(255)");
}

TEST_CASE("sums of matrices are known, products are not") {
  const Type matrix = Type::matrix(2);
  const auto with = [&](BinaryOp op) {
    return derive(floatType, matrix, nullptr, [op](Module&, KernelBuilder& k) {
      ExprPtr rows =
          construct(Type::matrix(2), exprs(construct(Type::of(Scalar::Float, 2), exprs(k.ref(x))),
                                           construct(Type::of(Scalar::Float, 2), exprs(k.ref(x)))));
      return block(assign(k.ref(total), binary(op, k.ref(total), std::move(rows))));
    });
  };
  CHECK(with(Add).combine == "{\n  total = total + total_part;\n}\n");
  CHECK(with(Add).identity == "float2x2{float2{0.0}, float2{0.0}}");
  CHECK(with(Mul).error.find("an overload that folds accumulators") != std::string::npos);
}

TEST_CASE("an index belongs to an element, not to a partial result") {
  const Body asks = [](Module&, KernelBuilder& k) {
    ExprPtr at = convert(Scalar::Float, swizzle(indexOf({StreamRef::Space::KernelParameter, x}), "x"));
    return block(ifStmt(binary(Less, k.ref(x), k.ref(total)), block(assign(k.ref(total), std::move(at)))));
  };
  CHECK(derive(asks).error.find("'fold' asks for the index of an element") == 0);
  const Outcome last = derive(floatType, intType, nullptr, [](Module&, KernelBuilder& k) {
    ExprPtr at = swizzle(indexOf({StreamRef::Space::KernelParameter, x}), "x");
    return block(assign(k.ref(total), intrinsic(Intrinsic::Max, exprs(k.ref(total), std::move(at)))));
  });
  CHECK(last.combine == "{\n  total = max(total, total_part);\n}\n");
  CHECK_FALSE(last.seeded);
}

}  // namespace
}  // namespace skc
