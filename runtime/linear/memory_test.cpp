// SPDX-License-Identifier: MIT
//
// What a solve needs of a device's memory, and what is said where there is less.
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <catch2/catch.hpp>
#include <sk/sk.hpp>

#include "layout.hpp"
#include "memory.hpp"
#include "operator_matrix.hpp"
#include "stencil.hpp"
#include "text/named.hpp"

namespace sk::linear {
namespace {

MemoryChoices choicesOf(std::string_view solver, std::string_view preconditioner, std::string_view layout,
                        const Arithmetic& arithmetic) {
  return {text::rowNamed(methodKinds(), solver, "solver"),
          text::rowNamed(preconditionerKinds(), preconditioner, "preconditioner"), layout, arithmetic};
}

TEST_CASE("Bytes of layouts are known before anything is copied") {
  sk::Device device = sk::Device::native();
  const SparseMatrix grid = assemble(poisson({9, 13})), empty = assemble(5, 5, {});
  for (const SparseMatrix* a : {&grid, &empty})
    for (const LayoutKind& kind : layoutKinds())
      for (const sk::Storage storage : {sk::Storage::Half, sk::Storage::Single}) {
        CAPTURE(kind.name, a->rows);
        CHECK(kind.bytes(*a, bytesOf(storage)) == kind.make(device, *a, {.matrix = storage})->bytes());
      }
  CHECK(bytesOf(grid, "auto", 4) == bytesOf(grid, "diagonals", 4));
  const Stencil stencil = poisson({9, 13});
  const VaryingStencil blocks = diffusion(stencil, std::vector<double>(117, 2.0));
  const SparseMatrix entries = assemble(blocks);
  Operator varying = operatorOf(entries);
  varying.varying = &blocks;
  for (const Operator& a : {operatorOf(stencil), varying})
    for (const char* layout : {"auto", "stencil", "slices"}) {
      CAPTURE(a.varying, layout);
      CHECK(matrixBytes(a, layout, 4) == makeMatrix(Space(device, shapeOf(a)), a, layout, {})->bytes());
    }
  CHECK_THROWS_WITH(bytesOf(grid, "csr", 4), Catch::StartsWith("no layout is called 'csr'"));
}

TEST_CASE("A solve needs the bytes of its matrix and its vectors") {
  const Operator system = operatorOf(poisson({32, 32}));
  const Arithmetic single, half{.matrix = sk::Storage::Half, .vectors = sk::Storage::Half};
  const MemoryNeed plain = memoryNeed(system, choicesOf("cg", "jacobi", "auto", single), true);
  CHECK(plain.matrix == 0);
  CHECK(plain.method == 5 * 4 * 1024);
  CHECK(plain.preconditioner == 4 * 1024);
  CHECK(plain.residual == 5 * 8 * 1024);
  CHECK(plain.total() == plain.method + plain.preconditioner + plain.residual);
  const MemoryNeed stored = memoryNeed(system, choicesOf("gmres", "none", "diagonals", half), false);
  CHECK(stored.matrix == 5 * 2 * 1024);
  CHECK(stored.method == 37 * 2 * 1024);  // 30 steps before it begins anew
  CHECK(stored.preconditioner == 0);
  CHECK(stored.residual == 0);
  // Entries that floats round are stored once more, in doubles.
  const Operator thirds = operatorOf(poisson({32, 32}, std::array{0.7, 0.3}));
  CHECK(memoryNeed(thirds, choicesOf("cg", "jacobi", "slices", single), true).residual ==
        5 * 8 * 1024 + matrixBytes(thirds, "slices", 8));
}

TEST_CASE("A device with too little memory is told what is needed, what there is, and what needs less") {
  const Operator system = operatorOf(poisson({32, 32}));
  const Arithmetic single;
  const MemoryChoices choices = choicesOf("cg", "none", "points", single);
  for (const bool isNative : {true, false}) {
    const std::string name = isNative ? "native" : "software";
    const std::int64_t need = memoryNeed(system, choices, true).total();  // llvmpipe has doubles, too
    sk::Device small(sk::DeviceOptions{.device = name, .memoryLimit = need - 1});
    sk::Device enough(sk::DeviceOptions{.device = name, .memoryLimit = need});
    CHECK_NOTHROW(checkMemory(enough, system, "poisson:32x32", choices));
    CHECK_THROWS_WITH(checkMemory(small, system, "poisson:32x32", choices),
                      Catch::Contains("poisson:32x32 needs about " + std::to_string(need) + " bytes") &&
                          Catch::Contains("has " + std::to_string(need - 1) +
                                          " available; take the layout 'stencil', "
                                          "storage in halves, a solver"));
  }
}

}  // namespace
}  // namespace sk::linear
