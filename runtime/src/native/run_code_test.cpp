// SPDX-License-Identifier: MIT
//
// Tests kernels with hand-written object code against plain loops.
#include "native/run_code.hpp"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <string>

#include <catch2/catch.hpp>

#include "native/object_code_test.hpp"
#include "sk/error.hpp"

namespace sk::test {
namespace {

using native::Chunk;
using native::EntryKind;
using native::Extents;
using native::Frame;
using native::Operand;
using program::Boundary;
using program::Role;

// ---- elements --------------------------------------------------------------------------------------

void saxpy(const Frame* frame, const Chunk* chunk) {
  const auto a = valueOf<float>(frame, 0);
  const auto* x = arrayOf<float>(chunk, 0);
  const auto* y = arrayOf<float>(chunk, 1);
  auto* r = arrayOf<float>(chunk, 2);
  for (std::int64_t i = 0; i < inGroups(chunk->count); ++i) r[i] = a * x[i] + y[i];
}

struct Saxpy : TestKernel {
  Saxpy() {
    add(Role::Uniform);
    add(Role::Input);
    add(Role::Input);
    add(Role::Output);
    for (const std::uint8_t parameter : {1, 2, 3}) slot(parameter);
    entries = {entry(EntryKind::Run, &saxpy)};
    finish();
  }
};

TEST_CASE("rows of every length are computed, and nothing beyond them") {
  const Saxpy f;
  std::vector<float> a{3};
  for (const std::int64_t n : {1, 7, 8, 9, 511, 512, 513, 8192, 8201, 100003}) {
    std::vector<float> x = someFloats(n, 1);
    std::vector<float> y = someFloats(n, 2);
    std::vector<float> r(static_cast<std::size_t>(n + 20), -7);
    TestOperands operands;
    operands.add(a, {1, 1, 1, 1});
    operands.add(x, {n, 1, 1, 1});
    operands.add(y, {n, 1, 1, 1});
    operands.add(r, {n, 1, 1, 1}).first = 10;
    runCode(f.kernel, operands.call({n, 1, 1, 1}), {});
    std::vector<float> expected(r.size(), -7);
    for (std::size_t i = 0; i < x.size(); ++i) expected[i + 10] = 3 * x[i] + y[i];
    CAPTURE(n);
    CHECK(r == expected);
  }
}

TEST_CASE("a stream may be read and written in one call, and views have rows of their own") {
  const Saxpy f;
  std::vector<float> a{2};
  const std::int64_t width = 37, height = 21, pitch = 50;
  std::vector<float> x = someFloats(pitch * height);
  const std::vector<float> before = x;
  TestOperands operands;
  operands.add(a, {1, 1, 1, 1});
  for (int k = 0; k < 3; ++k) {
    Operand& view = operands.add(x, {width, height, 1, 1});
    view.first = 5;
    view.stride[1] = pitch;
  }
  runCode(f.kernel, operands.call({width, height, 1, 1}), {});
  std::vector<float> expected = before;
  for (std::int64_t row = 0; row < height; ++row) {
    for (std::int64_t i = 0; i < width; ++i) expected[static_cast<std::size_t>(5 + row * pitch + i)] *= 3;
  }
  CHECK(x == expected);
}

TEST_CASE("inputs repeat, are stretched or strode through, and those left out are zeros") {
  const Saxpy f;
  std::vector<float> a{3};
  const std::int64_t n = 1200;
  std::vector<float> x = someFloats(4 * n, 1);
  std::vector<float> y = someFloats(n, 2);
  const auto computed = [&](std::int64_t multiply, std::int64_t divide, std::int64_t stride, bool isGiven) {
    std::vector<float> r(static_cast<std::size_t>(n));
    TestOperands operands;
    operands.add(a, {1, 1, 1, 1});
    if (isGiven) {
      Operand& input = operands.add(x, {n * multiply / divide, 1, 1, 1});
      input.multiply[0] = multiply;
      input.divide[0] = divide;
      input.stride[0] = stride;
    } else {
      operands.addNone();
    }
    operands.add(y, {n, 1, 1, 1});
    operands.add(r, {n, 1, 1, 1});
    runCode(f.kernel, operands.call({n, 1, 1, 1}), {});
    return r;
  };
  const auto expected = [&](auto&& number) {
    std::vector<float> r;
    for (std::int64_t i = 0; i < n; ++i) {
      r.push_back(3 * number(i) + y[static_cast<std::size_t>(i)]);
    }
    return r;
  };
  const auto at = [&](std::int64_t i) { return x[static_cast<std::size_t>(i)]; };
  CHECK(computed(0, 1, 1, true) == expected([&](std::int64_t) { return at(0); }));
  CHECK(computed(1, 3, 1, true) == expected([&](std::int64_t i) { return at(i / 3); }));
  CHECK(computed(4, 1, 1, true) == expected([&](std::int64_t i) { return at(4 * i); }));
  CHECK(computed(1, 1, 2, true) == expected([&](std::int64_t i) { return at(2 * i); }));
  CHECK(computed(1, 1, 1, false) == expected([&](std::int64_t) { return 0.0F; }));
}

TEST_CASE("what is stored to an output that is left out is lost") {
  const Saxpy f;
  std::vector<float> a{3};
  std::vector<float> x = someFloats(3000);
  TestOperands operands;
  operands.add(a, {1, 1, 1, 1});
  operands.add(x, {3000, 1, 1, 1});
  operands.add(x, {3000, 1, 1, 1});
  operands.addNone();
  CHECK_NOTHROW(runCode(f.kernel, operands.call({3000, 1, 1, 1}), {}));
}

void addWide(const Frame*, const Chunk* chunk) {
  const auto* x = arrayOf<double>(chunk, 0);
  auto* r = arrayOf<double>(chunk, 1);
  for (std::int64_t i = 0; i < inGroups(chunk->count); ++i) r[i] = x[i] + 0x1p-40;
}

TEST_CASE("code that computes in doubles reads streams of floats") {
  TestKernel f;
  f.add(Role::Input);
  f.add(Role::Output);
  f.slot(0);
  f.slot(1);
  f.entries = {entry(EntryKind::Run, &addWide, native::Real::Double)};
  f.finish();
  std::vector<float> x = someFloats(1003);
  std::vector<double> r(1003);
  TestOperands operands;
  operands.add(x, {1003, 1, 1, 1}).holdsFloats = true;
  operands.add(r, {1003, 1, 1, 1});
  runCode(f.kernel, operands.call({1003, 1, 1, 1}), {.real = RealType::Double});
  for (std::size_t i = 0; i < x.size(); ++i) REQUIRE(r[i] == double{x[i]} + 0x1p-40);
}

void ownIndex(const Frame* frame, const Chunk* chunk) {
  const native::Argument& input = frame->arguments[0];
  auto* r = arrayOf<std::int32_t>(chunk, 1);
  const std::int64_t first = chunk->first[0] * input.multiply[0] / input.divide[0];
  for (std::int64_t i = 0; i < inGroups(chunk->count); ++i) r[i] = static_cast<std::int32_t>(first + i);
}

TEST_CASE("the index in an input that is stretched is right for every element") {
  TestKernel f;
  f.add(Role::Input).usesIndex = true;
  f.add(Role::Output, intElement);
  f.slot(0);
  f.slot(1);
  f.entries = {entry(EntryKind::Run, &ownIndex)};
  f.finish();
  std::vector<float> x(10);
  std::vector<std::int32_t> r(30);
  TestOperands operands;
  operands.add(x, {10, 1, 1, 1}).divide[0] = 3;
  operands.add(r, {30, 1, 1, 1});
  runCode(f.kernel, operands.call({30, 1, 1, 1}), {});
  for (std::int32_t i = 0; i < 30; ++i) CHECK(r[static_cast<std::size_t>(i)] == i / 3);
}

// ---- rows together ---------------------------------------------------------------------------------

constexpr std::uint8_t rowsTogether = 4;
std::int64_t pitchSeen;  ///< of the gather that `gatherRows` reads

std::int64_t rowOf(std::int64_t x, std::int64_t y, std::int64_t rows) { return (5 * x + y) % rows; }

void gatherRows(const Frame* frame, const Chunk* chunks) {
  const native::Argument& from = frame->arguments[0];
  const auto* const b = static_cast<const float*>(from.components[0]) + from.first;
  pitchSeen = from.stride[1];
  for (std::size_t k = 0; k < rowsTogether; ++k) {
    const std::int64_t x = chunks[k].first[0], y = chunks[k].first[1];
    for (std::int64_t i = 0; i < inGroups(chunks[k].count); ++i) {
      const std::int64_t column = std::min(x + i, from.extent[0] - 1);
      arrayOf<float>(&chunks[k], 0)[i] = b[rowOf(column, y, from.extent[1]) * from.stride[1] + column];
    }
  }
}

void gatherNothing(const Frame*, const Chunk*) {}

TEST_CASE("gathers that all rows share are copied where their rows share sets of the caches") {
  TestKernel f;
  program::Parameter& gather = f.add(Role::Gather);
  gather.rank = 2;
  gather.usesAt = true;
  f.add(Role::Output);
  f.slot(1);
  f.entries = {entry(EntryKind::Run, &gatherNothing), entry(EntryKind::RunRows, &gatherRows)};
  f.entries[1].rows = rowsTogether;
  f.finish();
  const std::int64_t rows = 256, width = 1000;  // a view of rows that are a page long, or a little longer
  for (const std::int64_t pitch : {1024, 1040}) {
    for (const std::uint64_t shared : {0, 1}) {
      for (const std::int64_t height : {63, 257}) {
        f.code.sharedGathers = shared;
        std::vector<float> b = someFloats(pitch * rows + 7);
        std::vector<float> r(static_cast<std::size_t>(width * height));
        TestOperands operands;
        Operand& view = operands.add(b, {width, rows, 1, 1});
        view.first = 7;
        view.stride[1] = pitch;
        operands.add(r, {width, height, 1, 1});
        runCode(f.kernel, operands.call({width, height, 1, 1}), {});
        std::vector<float> expected;
        for (std::int64_t y = 0; y < height; ++y)
          for (std::int64_t x = 0; x < width; ++x)
            expected.push_back(b[static_cast<std::size_t>(7 + rowOf(x, y, rows) * pitch + x)]);
        CAPTURE(pitch, shared, height);
        CHECK(r == expected);
        const bool isCopied = pitch == 1024 && shared == 1 && height == 257;
        CHECK((pitchSeen != pitch) == isCopied);
        CHECK((isCopied ? pitchSeen * 4 % 2048 != 0 : true));
      }
    }
  }
}

// ---- neighbours ------------------------------------------------------------------------------------

constexpr std::uint8_t stencilReach = 2;

/// Where the gather's stream lies in an array that has `margin` more elements on either side.
constexpr std::int64_t margin = 100;
struct Held {
  const float* first = nullptr;
  std::int64_t count = 0;
  bool isLeft = false;  ///< code has read the margins

  void read(const float* begin, std::int64_t length) {
    const std::int64_t at = begin - first;
    const bool isInArray = at > -margin && at < count + margin;
    isLeft = isLeft || (isInArray && (at < 0 || at + length > count));
  }
};
Held held;
std::int64_t rowsOfChunk, firstOfRows;  ///< of the chunk with most rows

/// A RunFunction that computes the rows of a chunk of `count` arrays one by one.
template <auto* computeRow, std::size_t count>
void eachRow(const Frame* frame, const Chunk* chunk) {
  if (chunk->rows > rowsOfChunk) firstOfRows = chunk->first[0];
  rowsOfChunk = std::max(rowsOfChunk, chunk->rows);
  void* arrays[count];
  Chunk row = *chunk;
  row.arrays = arrays;
  for (std::int64_t r = row.rows = 0; r < chunk->rows; ++r, ++row.first[1]) {
    for (std::size_t a = 0; a < count; ++a)
      arrays[a] = static_cast<std::byte*>(chunk->arrays[a]) + r * chunk->rowSteps[a];
    computeRow(frame, &row);
  }
}

/// Neighbours at -2, 0 and 2 along x, the upper left and the lower right one, one row to either side in z, and
/// an element of another stream.
void stencil(const Frame*, const Chunk* chunk) {
  const auto* u = arrayOf<float>(chunk, 0);
  const float* rows[4];
  for (std::size_t k = 0; k < 4; ++k) rows[k] = arrayOf<float>(chunk, k + 1);
  const auto* own = arrayOf<float>(chunk, 5);
  auto* r = arrayOf<float>(chunk, 6);
  const std::int64_t count = inGroups(chunk->count);
  held.read(u - stencilReach, count + 2 * stencilReach);
  for (const std::size_t k : {0, 1}) held.read(rows[k] - 1, count + 2);
  for (const std::size_t k : {2, 3}) held.read(rows[k], count);
  for (std::int64_t i = 0; i < count; ++i) {
    r[i] = own[i] + u[i] + 2 * u[i - stencilReach] + 3 * u[i + stencilReach];
    r[i] += 4 * rows[0][i - 1] + 5 * rows[1][i + 1] + 6 * rows[2][i] + 7 * rows[3][i];
  }
}

constexpr float borderValue = 1000;

void borders(const Frame*, void* const* values) { *static_cast<float*>(values[0]) = borderValue; }

struct Stencil : TestKernel {
  Stencil(Boundary boundary, std::uint8_t rank) {
    program::Parameter& u = add(Role::Gather);
    u.boundary = boundary;
    u.rank = rank;
    u.usesNear = true;
    u.reach = stencilReach;
    add(Role::Input);
    add(Role::Output);
    slot(0, stencilReach);
    slot(0, 1, -1);
    slot(0, 1, 1);
    slot(0, 0, 0, -1);
    slot(0, 0, 0, 1);
    slot(1);
    slot(2);
    entries = {entry(EntryKind::Run, &eachRow<stencil, 7>), entry(EntryKind::Borders, &borders)};
    finish();
  }
};

std::int64_t bringInside(Boundary boundary, std::int64_t i, std::int64_t n) {
  switch (boundary) {
    case Boundary::Clamp: return i < 0 ? 0 : i >= n ? n - 1 : i;
    case Boundary::Wrap:
      while (i < 0) i += n;
      return i % n;
    case Boundary::Mirror:
      while (i < 0 || i >= n) i = i < 0 ? -1 - i : 2 * n - 1 - i;
      return i;
    case Boundary::Border: break;
  }
  return i < 0 || i >= n ? -1 : i;
}

float gathered(const std::vector<float>& u, const Extents& extent, Boundary boundary, int rank, Extents at) {
  std::int64_t number = 0, stride = 1;
  for (std::size_t d = 0; d < static_cast<std::size_t>(rank); stride *= extent[d++]) {
    const std::int64_t i = bringInside(boundary, at[d], extent[d]);
    if (i < 0) return borderValue;
    number += i * stride;
  }
  return u[static_cast<std::size_t>(margin + number)];
}

void checkStencil(Boundary boundary, int rank, const Extents& extent, const Extents& domain) {
  const Stencil f(boundary, static_cast<std::uint8_t>(rank));
  const std::int64_t count = extent[0] * extent[1] * extent[2];
  std::vector<float> u = someFloats(count + 2 * margin);
  held = {u.data() + margin, count};
  std::vector<float> own = someFloats(domain[0] * domain[1] * domain[2]);
  std::vector<float> r(own.size());
  TestOperands operands;
  operands.add(u, extent).first = margin;
  operands.add(own, domain);
  operands.add(r, domain);
  runCode(f.kernel, operands.call(domain), {});
  std::vector<float> expected;
  for (std::int64_t z = 0; z < domain[2]; ++z) {
    for (std::int64_t y = 0; y < domain[1]; ++y) {
      for (std::int64_t x = 0; x < domain[0]; ++x) {
        const auto at = [&](std::int64_t dx, std::int64_t dy, std::int64_t dz) {
          return gathered(u, extent, boundary, rank, {x + dx, y + dy, z + dz, 0});
        };
        expected.push_back(own[expected.size()] + at(0, 0, 0) + 2 * at(-stencilReach, 0, 0) +
                           3 * at(stencilReach, 0, 0) + 4 * at(-1, -1, 0) + 5 * at(1, 1, 0) +
                           6 * at(0, 0, -1) + 7 * at(0, 0, 1));
      }
    }
  }
  CAPTURE(static_cast<int>(boundary), rank, extent[0], extent[1], extent[2], domain[0]);
  CHECK(r == expected);
  CHECK_FALSE(held.isLeft);
}

TEST_CASE("neighbours outside are what the boundary says, in rows of every length") {
  for (const Boundary boundary : {Boundary::Clamp, Boundary::Wrap, Boundary::Mirror, Boundary::Border}) {
    for (const std::int64_t width : {1, 2, 3, 7, 8, 9, 12, 16, 17, 30, 512, 517, 9000}) {
      checkStencil(boundary, 1, {width, 1, 1, 1}, {width, 1, 1, 1});
      if (width > 600) continue;
      checkStencil(boundary, 2, {width, 4, 1, 1}, {width, 4, 1, 1});
      checkStencil(boundary, 3, {width, 3, 2, 1}, {width, 3, 2, 1});
    }
    for (const std::int64_t height : {7, 8, 9, 16, 25}) {  // several rows are run at once
      checkStencil(boundary, 2, {70, height, 1, 1}, {70, height, 1, 1});
      for (const std::int64_t width : {96, 97, 200, 301})  // and their ends together
        checkStencil(boundary, 2, {width, height, 1, 1}, {width, height, 1, 1});
      checkStencil(boundary, 3, {33, height, 3, 1}, {33, height, 3, 1});
    }
  }
}

TEST_CASE("rows away from the borders are computed in one call, each from its first element on") {
  for (const Boundary boundary : {Boundary::Clamp, Boundary::Wrap, Boundary::Mirror, Boundary::Border}) {
    rowsOfChunk = 0;
    checkStencil(boundary, 2, {128, 24, 1, 1}, {128, 24, 1, 1});
    CHECK(rowsOfChunk == 20);  // but for two rows at either border
    CHECK(firstOfRows == 0);
  }
}

TEST_CASE("a gather may be smaller or larger than the domain") {
  for (const Boundary boundary : {Boundary::Clamp, Boundary::Wrap, Boundary::Mirror, Boundary::Border}) {
    checkStencil(boundary, 2, {5, 3, 1, 1}, {1100, 6, 1, 1});
    checkStencil(boundary, 2, {1100, 6, 1, 1}, {33, 3, 1, 1});
    checkStencil(boundary, 2, {20, 4, 1, 1}, {300, 30, 1, 1});
    checkStencil(boundary, 2, {200, 40, 1, 1}, {90, 20, 1, 1});
    checkStencil(boundary, 2, {200, 40, 1, 1}, {199, 20, 1, 1});
    checkStencil(boundary, 2, {200, 10, 1, 1}, {205, 20, 1, 1});
    checkStencil(boundary, 1, {40, 1, 1, 1}, {40, 3, 1, 1});
  }
}

TEST_CASE("a gather that is left out is zeros") {
  const Stencil f(Boundary::Clamp, 2);
  std::vector<float> r(300, -1);
  TestOperands operands;
  std::vector<float> own(300);
  operands.addNone();
  operands.add(own, {100, 3, 1, 1});
  operands.add(r, {100, 3, 1, 1});
  runCode(f.kernel, operands.call({100, 3, 1, 1}), {});
  CHECK(r == std::vector<float>(300, 0));
}

// ---- pushes ----------------------------------------------------------------------------------------

/// Pushes odd numbers and multiples of 5; numbers that are both, twice.
void pushSome(const Frame* frame, const Chunk* chunk) {
  native::AppendBuffer* appendBuffer = frame->arguments[1].appendBuffer;
  const auto* x = arrayOf<float>(chunk, 0);
  const auto push = [&](float value) {
    if (appendBuffer->count >= appendBuffer->capacity) appendBuffer->grow(appendBuffer);
    reinterpret_cast<float*>(appendBuffer->arrays[0])[appendBuffer->count++] = value;
  };
  for (std::int64_t i = 0; i < chunk->count; ++i) {
    if (static_cast<int>(x[i]) % 2 == 1) push(x[i]);
    if (static_cast<int>(x[i]) % 5 == 0) push(x[i]);
  }
}

/// Likewise group by group: first all odd numbers of a group, then its multiples of 5.
void pushInGroups(const Frame* frame, const Chunk* chunk) {
  native::AppendBuffer* appendBuffer = frame->arguments[1].appendBuffer;
  const auto* x = arrayOf<float>(chunk, 0);
  for (std::int64_t group = 0; group < chunk->count; group += testLanes) {
    const std::int64_t end = std::min<std::int64_t>(group + testLanes, chunk->count);
    for (const bool isSecond : {false, true}) {
      for (std::int64_t i = group; i < end; ++i) {
        const int value = static_cast<int>(x[i]);
        if (isSecond ? value % 5 != 0 : value % 2 != 1) continue;
        if (appendBuffer->count >= appendBuffer->capacity) appendBuffer->grow(appendBuffer);
        appendBuffer->elements[appendBuffer->count] = static_cast<std::uint32_t>(i);
        reinterpret_cast<float*>(appendBuffer->arrays[0])[appendBuffer->count++] = x[i];
      }
    }
  }
}

void checkPushes(TestKernel& f) {
  std::vector<float> x(100001);
  std::iota(x.begin(), x.end(), 0.0F);
  std::vector<float> expected;
  for (const float value : x) {
    if (static_cast<int>(value) % 2 == 1) expected.push_back(value);
    if (static_cast<int>(value) % 5 == 0) expected.push_back(value);
  }
  for (const std::uint8_t isUneven : {0, 1}) {
    f.code.isUneven = isUneven;
    f.finish();
    native::Pushed pushed;
    TestOperands operands;
    operands.add(x, {100001, 1, 1, 1});
    operands.addNone().pushed = &pushed;
    runCode(f.kernel, operands.call({100001, 1, 1, 1}), {});
    REQUIRE(pushed.count == static_cast<std::int64_t>(expected.size()));
    CHECK(std::memcmp(pushed.arrays[0].get(), expected.data(), expected.size() * sizeof(float)) == 0);
  }
}

TEST_CASE("pushes of all threads come in the order of elements") {
  TestKernel f;
  f.add(Role::Input);
  f.add(Role::VariableOutput);
  f.slot(0);
  f.entries = {entry(EntryKind::Run, &pushSome)};
  checkPushes(f);
}

TEST_CASE("pushes of lanes are brought into the order of elements") {
  TestKernel f;
  f.add(Role::Input);
  f.add(Role::VariableOutput);
  f.slot(0);
  f.entries = {entry(EntryKind::Run, &pushInGroups)};
  f.code.isReordered = 1;
  checkPushes(f);
}

// ---- scatters --------------------------------------------------------------------------------------

/// Records a store of each element.
void recordStores(const Frame* frame, const Chunk* chunk) {
  native::AppendBuffer* appendBuffer = frame->arguments[1].appendBuffer;
  const auto* x = arrayOf<std::int32_t>(chunk, 0);
  for (std::int64_t i = 0; i < chunk->count; ++i) {
    if (appendBuffer->count >= appendBuffer->capacity) appendBuffer->grow(appendBuffer);
    appendBuffer->targets[appendBuffer->count] =
        frame->arguments[1].first + x[i] % frame->arguments[1].extent[0];
    reinterpret_cast<std::int32_t*>(appendBuffer->arrays[0])[appendBuffer->count++] = x[i];
  }
}
/// Multiplies an element by 3 and adds the value, modulo 2^32: the order matters.
void multiplyAndAdd(const Frame* frame, const native::AppendBuffer* appendBuffer, std::int64_t parameter) {
  auto* r = static_cast<std::uint32_t*>(frame->arguments[parameter].components[0]);
  for (std::int64_t i = 0; i < appendBuffer->count; ++i) {
    std::uint32_t& to = r[appendBuffer->targets[i]];
    to = to * 3 + reinterpret_cast<const std::uint32_t*>(appendBuffer->arrays[0])[i];
  }
}

TEST_CASE("scatters are carried out in the order of elements, on any number of threads") {
  TestKernel f;
  f.add(Role::Input, intElement);
  f.add(Role::Scatter, intElement);
  f.slot(0);
  f.entries = {entry(EntryKind::Run, &recordStores), entry(EntryKind::Apply, &multiplyAndAdd)};
  for (const std::uint8_t isUneven : {0, 1}) {
    for (const std::int64_t targets : {1, 17, 1024, 70001}) {
      f.code.isUneven = isUneven;
      f.finish();
      const std::int64_t count = 400009;
      std::vector<std::int32_t> x(static_cast<std::size_t>(count));
      std::uint32_t state = 1;
      for (std::int32_t& value : x)
        value = static_cast<std::int32_t>((state = state * 1664525U + 1013904223U) >> 8);
      std::vector<std::uint32_t> r(static_cast<std::size_t>(targets + 20), 1);
      std::vector<std::uint32_t> expected = r;
      for (const std::int32_t value : x) {
        std::uint32_t& to = expected[static_cast<std::size_t>(10 + value % targets)];
        to = to * 3 + static_cast<std::uint32_t>(value);
      }
      TestOperands operands;
      operands.add(x, {count, 1, 1, 1});
      operands.add(r, {targets, 1, 1, 1}).first = 10;
      runCode(f.kernel, operands.call({count, 1, 1, 1}), {});
      CAPTURE(static_cast<int>(isUneven), targets);
      CHECK(r == expected);
    }
  }
}

// ---- entries ---------------------------------------------------------------------------------------

TEST_CASE("the newest entry that the CPU runs is taken, and fused ones only where that is allowed") {
  using native::Level;
  TestKernel f;
  f.add(Role::Output);
  for (const Level level : {Level::Base, Level::V3, Level::V4}) {
    for (const std::uint8_t isContracted : {0, 1}) {
      native::Entry& made = f.entries.emplace_back(entry(EntryKind::Run, &saxpy));
      made.level = level;
      made.isContracted = isContracted;
    }
  }
  f.finish();
  for (const Level level : {Level::Base, Level::V3, Level::V4}) {
    for (const bool mayContract : {false, true}) {
      const native::Entry* found = findEntry(f.code, EntryKind::Run, {.mayContract = mayContract}, level);
      REQUIRE(found != nullptr);
      CHECK(found->level == level);
      CHECK((found->isContracted != 0) == mayContract);
    }
  }
  CHECK(findEntry(f.code, EntryKind::Fold, {}) == nullptr);
  f.entries.pop_back();  // the contracted entry for V4: one for an earlier level precedes a plain one
  f.finish();
  const native::Entry* fused = findEntry(f.code, EntryKind::Run, {.mayContract = true}, Level::V4);
  REQUIRE(fused != nullptr);
  CHECK(fused->level == Level::V3);
  CHECK(fused->isContracted == 1);
  CHECK(findEntry(f.code, EntryKind::Run, {.real = RealType::Double}) == nullptr);
}

TEST_CASE("code of another version, and code for newer CPUs alone, is rejected") {
  TestKernel f;
  f.add(Role::Output);
  f.entries = {entry(EntryKind::Run, &saxpy)};
  f.entries[0].level = native::Level::V4;
  f.finish();
  CHECK_THROWS_WITH(entryOf(f.kernel, EntryKind::Run, {}, native::Level::V3),
                    Catch::Contains("x86-64-v4") && Catch::Contains("--levels"));
  f.code.version = 99;
  CHECK_THROWS_WITH(entryOf(f.kernel, EntryKind::Run, {}), Catch::Contains("version 99"));
}

}  // namespace
}  // namespace sk::test
