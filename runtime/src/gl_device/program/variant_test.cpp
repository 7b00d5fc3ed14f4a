// SPDX-License-Identifier: MIT
#include "gl_device/program/variant.hpp"

#include <set>
#include <vector>

#include <catch2/catch.hpp>

#include "gl_device/memory/layout.hpp"
#include "sk/types.hpp"

using namespace sk;
using assemble::Addressing;
using assemble::Domain;
using assemble::RegionLayout;
using program::Role;

namespace {

const program::Parameter parameters[] = {
    {.name = "a", .symbol = "a", .role = Role::Uniform, .element = &ElementTraits<float>::element()},
    {.name = "x", .symbol = "x", .role = Role::Input, .element = &ElementTraits<float>::element()},
    {.name = "g",
     .symbol = "g",
     .role = Role::Gather,
     .element = &ElementTraits<float>::element(),
     .rank = 2,
     .usesNear = true,
     .reach = 2},
    {.name = "r", .symbol = "r", .role = Role::Output, .element = &ElementTraits<float>::element()}};

program::Kernel makeKernel() {
  program::Kernel kernel;
  kernel.name = "k";
  kernel.parameters = parameters;
  return kernel;
}
const program::Kernel kernel = makeKernel();

RegionLayout region(const Shape& stream, const Index& begin, const Shape& shape) {
  return regionLayoutOf({nullptr, begin, shape}, layoutOf(stream, {64, 256}));
}
RegionLayout strides(const Shape& stream, const Shape& shape, const Index& stride) {
  return regionLayoutOf({nullptr, {}, shape, stride, 0}, layoutOf(stream, {64, 256}));
}
RegionLayout whole(const Shape& stream) { return region(stream, Index::origin(stream.rank()), stream); }

assemble::Variant choose(const RegionLayout& x, const RegionLayout& g, const RegionLayout& domain) {
  const float a = 0;
  const std::vector<Operand> operands{
      {&a, {}, {}}, {nullptr, x, {}}, {nullptr, g, {}}, {nullptr, domain, {}}};
  return chooseVariant(kernel, operands, domain);
}

}  // namespace

TEST_CASE("whole planes of one shape are aligned") {
  const auto chosen = choose(whole({8, 9}), whole({8, 9}), whole({8, 9}));
  CHECK(chosen.domain == Domain::Plane);
  CHECK_FALSE(chosen.domainView);
  CHECK(chosen.access[1].addressing == Addressing::Aligned);
  CHECK(chosen.access[2].addressing == Addressing::Plane);
  CHECK_FALSE(chosen.access[2].view);
  CHECK(chosen.access[2].nearby);
}

TEST_CASE("views, repeats and linearised streams are told apart") {
  const Shape plane(8, 9);
  const Shape line(8, 90);
  const RegionLayout square = whole({4, 4});
  const RegionLayout by2 = strides(plane, Shape(4, 4), {18, 2}),
                     byNumber = strides(plane, Shape(4, 4), {7, 1});
  const RegionLayout byLine = strides(line, Shape(4, 4), {180, 2}),
                     otherNumber = strides(plane, Shape(4, 4), {7, 2});
  const RegionLayout byRow = strides(plane, Shape(16), {2});
  RegionLayout placedDomain = whole(plane);
  placedDomain.placed = true;
  placedDomain.place = {{100, 200, 0, 0}, {}, {1000, 1000, 1, 1}};
  const RegionLayout placedGather =
      gatherLayout(whole(plane), {{200, 100}, {1000, 1000}}, program::Boundary::Clamp);
  const RegionLayout localGather = localLayout(whole(plane), {{200, 100}, {1000, 1000}}, {200, 100});
  const RegionLayout shiftedGather = localLayout(whole(plane), {{199, 100}, {1000, 1000}}, {200, 100});
  const std::vector<assemble::Variant> all{
      choose(whole(plane), whole(plane), whole(plane)),
      choose(region(plane, {1, 1}, {4, 4}), whole(plane), region(plane, {2, 2}, {4, 4})),
      choose(region(plane, {1, 1}, {4, 4}), whole(plane), region(plane, {1, 1}, {4, 4})),
      choose(whole({8, 1}), whole(plane), whole(plane)),
      choose(whole(line), whole(plane), whole(line)),
      choose(whole(line), whole(line), whole(line)),
      choose(region(line, {0, 0}, {8, 9}), whole(plane), whole(plane)),
      choose(region(line, {1, 1}, {2, 9}), region(line, {1, 1}, {2, 9}), region(plane, {0, 0}, {2, 9})),
      choose(region(line, {1, 1}, {2, 9}), whole(plane), region(line, {1, 1}, {2, 9})),
      choose(whole(plane), whole({2, 9}), whole(plane)),
      choose(by2, whole(plane), square),
      choose(byNumber, whole(plane), square),
      choose(byLine, whole(plane), square),
      choose(square, by2, square),
      choose(square, byNumber, square),
      choose(square, byLine, square),
      choose(square, square, by2),
      choose(square, square, byNumber),
      choose(square, square, byLine),
      choose(by2, square, by2),
      choose(byNumber, square, byNumber),
      choose(otherNumber, square, byNumber),
      choose(byRow, square, byRow),
      choose(whole(plane), whole(plane), placedDomain),
      choose(whole(plane), placedGather, placedDomain),
      choose(whole(plane), placedGather, whole(plane)),
      choose(whole(plane), localGather, placedDomain),
      choose(whole(plane), shiftedGather, placedDomain),
  };
  CHECK(all[10].access[1].strided);
  CHECK(all[11].access[1].addressing == Addressing::Rows);
  CHECK(all[12].access[1].addressing == Addressing::Linear);
  CHECK(all[16].domain == Domain::Strided);
  CHECK(all[17].domain == Domain::StridedRows);
  CHECK(all[18].domain == Domain::StridedLinear);
  CHECK(all[23].domainPlaced);
  CHECK_FALSE(all[23].access[2].placed);
  CHECK_FALSE(all[23].access[2].nearby);
  CHECK(all[24].access[1].addressing == Addressing::Aligned);
  CHECK(all[24].access[2].placed);
  CHECK(all[24].access[2].nearby);
  CHECK_FALSE(all[25].domainPlaced);
  for (const std::size_t number : {std::size_t{26}, std::size_t{27}}) {
    const assemble::StreamAccess& access = all[number].access[2];
    CHECK(access.local);
    CHECK_FALSE(access.placed);
    CHECK_FALSE(access.view);
    CHECK(access.nearby);
    CHECK(access.shifted == (number == 27));
  }
  CHECK(all[1].domainView);
  CHECK(all[1].access[1].addressing == Addressing::Plane);
  CHECK(all[1].access[1].view);
  CHECK(all[2].access[1].addressing == Addressing::Aligned);
  CHECK(all[3].access[1].addressing == Addressing::Plane);
  CHECK(all[4].domain == Domain::Linear);
  CHECK(all[4].access[1].addressing == Addressing::Aligned);
  CHECK(all[5].access[2].addressing == Addressing::Linear);
  CHECK(all[8].domain == Domain::LinearBox);
  CHECK_FALSE(all[9].access[2].nearby);
  const std::set<assemble::Variant> distinct(all.begin(), all.end());
  CHECK(distinct.size() >= 20);
  std::set<std::size_t> hashes;
  for (const assemble::Variant& variant : distinct) hashes.insert(ProgramKeyHash{}({&kernel, variant}));
  CHECK(hashes.size() == distinct.size());
}

TEST_CASE("kernels of many streams have keys of their own for each way that these lie") {
  constexpr std::size_t count = 200;
  std::vector<program::Parameter> many(count, parameters[1]);
  many.push_back(parameters[3]);
  program::Kernel wide = makeKernel();
  wide.parameters = many;
  RegionLayout packed = layoutOf({8, 16}, {64, 256}, true).whole;
  std::vector<Operand> operands(count + 1, Operand{nullptr, packed, {}});
  const auto keyOf = [&](const std::vector<Operand>& all) {
    return ProgramKey{&wide, chooseVariant(wide, all, packed)};
  };
  const ProgramKey same = keyOf(operands);
  CHECK(keyOf(operands) == same);
  std::set<std::size_t> hashes{ProgramKeyHash{}(same)};
  for (std::size_t changed : {std::size_t{0}, count / 2, count - 1}) {
    std::vector<Operand> others = operands;
    others[changed].regionLayout = whole({8, 16});
    const ProgramKey other = keyOf(others);
    CHECK_FALSE(other == same);
    CHECK(other.variant.specs == same.variant.specs);
    CHECK(hashes.insert(ProgramKeyHash{}(other)).second);
  }
}

TEST_CASE("a gather is near only where one step always brings its index back") {
  CHECK(choose(whole({8, 9}), whole({8, 9}), whole({8, 9})).access[2].nearby);
  CHECK(choose(whole({3, 3}), whole({3, 3}), whole({3, 3})).access[2].nearby);
  CHECK_FALSE(choose(whole({2, 9}), whole({2, 9}), whole({2, 9})).access[2].nearby);
  CHECK_FALSE(choose(whole({8, 9}), whole({8, 8}), whole({8, 9})).access[2].nearby);
  RegionLayout part = whole({8, 9});
  part.placed = true;
  part.place.whole = {90, 80, 1, 1};
  const auto isNearby = [&](const Shape& held) {
    return choose(whole({8, 9}), localLayout(whole(held), {{3, 0}, {80, 90}}, {4, 0}), part).access[2].nearby;
  };
  CHECK(isNearby({3, 90}));  // the calls that take a local gather compute elements that it holds
  CHECK_FALSE(isNearby({2, 90}));
}

TEST_CASE("the device's filter reads whole textures of floats that it can filter, at edges that it knows") {
  program::Parameter gather = parameters[2];
  gather.usesSample = gather.filter = true;
  program::Kernel sampling = makeKernel();
  const auto isFiltered = [&](const RegionLayout& regionLayout, bool filtersFloats) {
    const program::Parameter list[] = {gather, parameters[3]};
    sampling.parameters = list;
    const RegionLayout domain = whole({8, 9});
    const Operand operands[] = {{nullptr, regionLayout, {}}, {nullptr, domain, {}}};
    return chooseVariant(sampling, operands, domain, {}, filtersFloats).access[0].filtered;
  };
  const RegionLayout plane = whole({8, 9});
  CHECK(isFiltered(plane, true));
  CHECK_FALSE(isFiltered(plane, false));
  CHECK_FALSE(isFiltered(whole({8, 90}), true));
  CHECK_FALSE(isFiltered(region({8, 9}, {0, 0}, {4, 4}), true));
  gather.boundary = program::Boundary::Border;
  CHECK_FALSE(isFiltered(plane, true));
  gather.boundary = program::Boundary::Mirror;
  CHECK(isFiltered(plane, true));
  gather.element = &ElementTraits<half>::element();
  CHECK(isFiltered(plane, false));
  gather.element = &ElementTraits<unorm8>::element();
  CHECK_FALSE(isFiltered(plane, true));
  gather.element = &ElementTraits<float>::element();
  gather.filter = false;
  CHECK_FALSE(isFiltered(plane, true));
}
