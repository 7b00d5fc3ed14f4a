// SPDX-License-Identifier: MIT
#include "native/coalesce.hpp"

#include <array>
#include <vector>

#include <catch2/catch.hpp>

namespace sk {
namespace {

using native::Extents;
using native::Operand;
using program::Parameter;
using program::Role;

void* const noArray = nullptr;

/// A stream of {height, width}, or a view of one of {height, pitch}.
Operand stream(std::int64_t width, std::int64_t height, std::int64_t pitch) {
  return {.components = {&noArray, 1}, .stride = {1, pitch, 0, 0}, .extent = {width, height, 1, 1}};
}

struct Case {
  std::array<Parameter, 2> parameters{Parameter{"x", "x", Role::Input, nullptr},
                                      Parameter{"r", "r", Role::Output, nullptr}};
  std::vector<Operand> operands;
  Extents domain{};
  Extents block{};
  program::Kernel kernel{};

  Case(const Operand& in, const Operand& out) : operands{in, out}, domain(in.extent), block(in.extent) {}
  void coalesce() {
    kernel.parameters = parameters;
    sk::coalesce(kernel, operands, domain, block);
  }
};

TEST_CASE("rows that follow each other become one") {
  Case whole(stream(3, 1000, 3), stream(3, 1000, 3));
  whole.coalesce();
  CHECK(whole.domain == Extents{3000, 1, 1, 1});
  CHECK(whole.operands[0].extent == Extents{3000, 1, 1, 1});
}

TEST_CASE("rows stay apart where one stream is a view, or repeats along one dimension alone") {
  Case view(stream(3, 1000, 3), stream(3, 1000, 5));
  view.coalesce();
  CHECK(view.domain == Extents{3, 1000, 1, 1});
  Case row(stream(3, 1000, 3), stream(3, 1000, 3));
  row.operands[0].multiply = {1, 0, 1, 1};
  row.coalesce();
  CHECK(row.domain == Extents{3, 1000, 1, 1});
  row.operands[0].multiply = {0, 0, 1, 1};
  row.coalesce();
  CHECK(row.domain == Extents{3000, 1, 1, 1});
  CHECK(row.operands[0].multiply[0] == 0);
}

TEST_CASE("a column is read as a row, and written so where it is dense") {
  Case read(stream(1, 1000, 5), stream(1, 1000, 1));
  read.coalesce();
  CHECK(read.domain == Extents{1000, 1, 1, 1});
  CHECK(read.operands[0].stride[0] == 5);
  Case written(stream(1, 1000, 1), stream(1, 1000, 5));
  written.coalesce();
  CHECK(written.domain == Extents{1, 1000, 1, 1});
}

TEST_CASE("a kernel that asks where it is keeps its dimensions") {
  for (int way = 0; way < 4; ++way) {
    Case asks(stream(3, 1000, 3), stream(3, 1000, 3));
    asks.kernel.usesIndex = way == 0;
    asks.kernel.usesExtent = way == 1;
    asks.parameters[0].usesIndex = way == 2;
    asks.parameters[0].usesExtent = way == 3;
    asks.coalesce();
    CHECK(asks.domain == Extents{3, 1000, 1, 1});
  }
}

TEST_CASE("of a reduction, whole rows of a block become one, and results move along") {
  Case rows(stream(4, 6, 4), stream(1, 2, 1));
  rows.parameters[1].role = Role::Accumulator;
  rows.block = {4, 3, 1, 1};
  rows.coalesce();
  CHECK(rows.domain == Extents{24, 1, 1, 1});
  CHECK(rows.block == Extents{12, 1, 1, 1});
  CHECK(rows.operands[1].stride[0] == 1);
  Case tiles(stream(4, 6, 4), stream(2, 2, 2));
  tiles.parameters[1].role = Role::Accumulator;
  tiles.block = {2, 3, 1, 1};
  tiles.coalesce();
  CHECK(tiles.domain == Extents{4, 6, 1, 1});
}

TEST_CASE("of a reduction, few long lines across rows become rows") {
  const auto lines = [](std::int64_t width, std::int64_t height) {
    Case made(stream(width, height, width), stream(width, 1, width));
    made.parameters[1].role = Role::Accumulator;
    made.block = {1, height, 1, 1};
    return made;
  };
  Case few = lines(3, 1000);
  few.coalesce();
  CHECK(few.domain == Extents{1000, 3, 1, 1});
  CHECK(few.block == Extents{1000, 1, 1, 1});
  CHECK(few.operands[0].stride[0] == 3);
  CHECK(few.operands[0].stride[1] == 1);
  CHECK(few.operands[1].stride[1] == 1);
  Case many = lines(9, 1000);
  many.coalesce();
  CHECK(many.domain == Extents{9, 1000, 1, 1});
  Case two = lines(3, 1000);
  two.block[1] = 500;
  two.coalesce();
  CHECK(two.domain == Extents{3, 1000, 1, 1});
  Case asks = lines(3, 1000);
  asks.parameters[0].usesIndex = true;
  asks.coalesce();
  CHECK(asks.domain == Extents{3, 1000, 1, 1});
}

}  // namespace
}  // namespace sk
