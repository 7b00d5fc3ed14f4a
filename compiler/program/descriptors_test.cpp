// SPDX-License-Identifier: MIT
//
// Promises: descriptors agree with the body, and element layouts agree with C++.
#include "program/descriptors.hpp"

#include <cstddef>

#include <catch2/catch.hpp>

#include "ir/kernel_builder.hpp"
#include "program/elements.hpp"
#include "program/sample_module.hpp"

namespace skc::emit {
namespace {

using namespace ir;

TEST_CASE("a kernel's descriptor") {
  const Module module = sampleModule();
  const Program program(module);
  REQUIRE(program.units().size() == 4);
  const sk::program::Kernel& diffuse = program.units()[0].kernel;
  CHECK(diffuse.name == "heat::diffuse");
  CHECK(diffuse.entry == "diffuse");
  CHECK(diffuse.usesIndex);
  REQUIRE(diffuse.sources.size() == 1);
  REQUIRE(diffuse.parameters.size() == 3);
  const sk::program::Parameter& u = diffuse.parameters[1];
  CHECK(u.role == sk::program::Role::Gather);
  CHECK(u.boundary == sk::program::Boundary::Wrap);
  CHECK(u.rank == 2);
  CHECK(u.usesAt);
  CHECK(u.usesNear);
  CHECK_FALSE(u.usesExtent);
  CHECK(u.reach == 1);
  CHECK(u.element->glsl == "float");
  CHECK(diffuse.parameters[0].reach == -1);
}

TEST_CASE("a reduce's descriptor") {
  const Module module = sampleModule();
  const Program program(module);
  const sk::program::Reduction& nearest = *program.units()[2].reduction;
  CHECK(nearest.combine.entry == "nearest");
  CHECK(nearest.seeded);
  CHECK(nearest.fold.parameters[1].identity.empty());
  const sk::program::Element& hit = *nearest.fold.parameters[0].element;
  CHECK(hit.glsl == "Hit");
  CHECK(hit.size == 8);
  REQUIRE(hit.fields.size() == 2);
  CHECK(hit.fields[1].path == "id");
  CHECK(hit.fields[1].offset == 4);
  const sk::program::Reduction& power = *program.units()[3].reduction;
  CHECK(power.combine.entry == "power_combine");
  CHECK(power.fold.body.find("power_combine") == std::string_view::npos);
  CHECK(power.fold.parameters[1].identity == "0.0");
  CHECK(power.addition.find("void power_combine(") != std::string_view::npos);
  CHECK(power.addition.find("void power(") == std::string_view::npos);  // it is in the fold's body
  CHECK(nearest.addition.empty());
}

TEST_CASE("descriptors stay valid when the program moves") {
  const Module module = sampleModule();
  Program first(module);
  const Program second(std::move(first));
  CHECK(second.units()[0].kernel.parameters[1].name == "u");
}

TEST_CASE("the reach of neighbours is known only if every offset is constant") {
  const auto reach = [](bool second) {
    Module module = testModule();
    module.constants.push_back({"radius", intType, literal(3), {}});
    KernelBuilder k(module, "f");
    const VarId n = k.uniform("n", intType);
    const VarId u = k.gather("u", floatType, 1);
    const VarId r = k.output("r", floatType);
    const StreamRef stream{StreamRef::Space::KernelParameter, u};
    ExprPtr value = neighborRead(floatType, stream, unary(UnaryOp::Negate, constantRef(module, 0)));
    if (second) value = binary(BinaryOp::Add, std::move(value), neighborRead(floatType, stream, k.ref(n)));
    k.finish(block(assign(k.ref(r), std::move(value))));
    return Program(module).units()[0].kernel.parameters[1].reach;
  };
  CHECK(reach(false) == 3);
  CHECK(reach(true) == -1);
}

struct Inner {
  bool flag;
  float position[3];
  bool pair[2];
};
struct Outer {
  bool first;
  Inner inner;
  unsigned last;
};

TEST_CASE("structs are laid out as C++ lays them out, nested ones flattened") {
  Module module = testModule();
  module.structs.push_back({"Inner",
                            {},
                            {{"flag", Type::of(Scalar::Bool)},
                             {"position", Type::of(Scalar::Float, 3)},
                             {"pair", Type::of(Scalar::Bool, 2)}},
                            {}});
  module.structs.push_back(
      {"Outer",
       {},
       {{"first", Type::of(Scalar::Bool)}, {"input", Type::structType(0)}, {"last", Type::of(Scalar::Uint)}},
       {}});
  const TypeNames types(module);
  const ElementLayout layout = elementLayout(module, types, Type::structType(1));
  CHECK(layout.size == sizeof(Outer));
  REQUIRE(layout.planes.size() == 5);
  CHECK(layout.planes[1].offset == offsetof(Outer, inner) + offsetof(Inner, flag));
  CHECK(layout.planes[2].offset == offsetof(Outer, inner) + offsetof(Inner, position));
  CHECK(layout.planes[3].offset == offsetof(Outer, inner) + offsetof(Inner, pair));
  CHECK(layout.planes[4].offset == offsetof(Outer, last));
  CHECK(layout.planes[2].path == "input_.position");
  CHECK(layout.planes[2].member == "input.position");
}

TEST_CASE("borders and identities are constant expressions, with their constants among the declarations") {
  Module module = testModule();
  module.constants.push_back({"outside", floatType, literal(2.0F), {}});
  KernelBuilder k(module, "f");
  const VarId u = k.gather("u", floatType, 1, Boundary::Border, constantRef(module, 0));
  const VarId r = k.output("r", floatType);
  k.finish(
      block(assign(k.ref(r), gatherRead(floatType, {StreamRef::Space::KernelParameter, u}, literal(0)))));
  const Program program(module);
  const sk::program::Kernel& kernel = program.units()[0].kernel;
  CHECK(kernel.parameters[0].border == "outside");
  CHECK(kernel.declarations == "const float outside = 2.0;\n\n");
  CHECK(kernel.body.find("outside") == std::string::npos);
}

TEST_CASE("a condition names members of bundles by their paths") {
  Module module = testModule();
  KernelBuilder k(module, "f");
  const VarId on = k.spec("g_on", Type::of(Scalar::Bool));
  const VarId u = k.gather("g_u", floatType, 1);
  const VarId r = k.output("r", floatType);
  const StreamRef stream{StreamRef::Space::KernelParameter, u};
  ExprPtr condition = k.ref(on);
  const KernelId id = k.finish(
      block(assign(k.ref(r), select(k.ref(on), gatherRead(floatType, stream, literal(0)), literal(0.0F)))));
  module.kernels[id].params[on].name = "g.on";
  module.kernels[id].params[u].neededIf = std::move(condition);
  const Program program(module);
  CHECK(program.units()[0].kernel.parameters[u].neededIf.text == "g.on");
}

}  // namespace
}  // namespace skc::emit
