// SPDX-License-Identifier: MIT
//
// What a solve needs of a device's memory, and what is said where there is less.
#include <cstdint>
#include <string>
#include <string_view>

#include <catch2/catch.hpp>
#include <sk/sk.hpp>

#include "layout.hpp"
#include "memory.hpp"
#include "stencil.hpp"
#include "support/named.hpp"

namespace linear {
namespace {

MemoryChoices choicesOf(std::string_view solver, std::string_view preconditioner, std::string_view layout,
                        const Arithmetic& arithmetic) {
  return {examples::rowNamed(methodKinds(), solver, "solver"),
          examples::rowNamed(preconditionerKinds(), preconditioner, "preconditioner"), layout, arithmetic};
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
  for (const char* name : {"poisson:9x13", "poisson:9x13:blocks=10"})
    for (const char* layout : {"auto", "stencil", "slices"}) {
      CAPTURE(name, layout);
      const System system(name, {});
      CHECK(system.matrixBytes(layout, 4) == system.makeMatrix(device, layout, {}, nullptr)->bytes());
    }
  CHECK_THROWS_WITH(bytesOf(grid, "csr", 4), Catch::StartsWith("no layout is called 'csr'"));
}

TEST_CASE("A solve needs the bytes of its matrix and its vectors") {
  const System system("poisson:32x32", {});
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
  const System thirds("poisson:32x32:0.3,0.7", {});
  CHECK(memoryNeed(thirds, choicesOf("cg", "jacobi", "slices", single), true).residual ==
        5 * 8 * 1024 + thirds.matrixBytes("slices", 8));
}

TEST_CASE("A device with too little memory is told what is needed, what there is, and what needs less") {
  const System system("poisson:32x32", {});
  const Arithmetic single;
  const MemoryChoices choices = choicesOf("cg", "none", "points", single);
  for (const bool isNative : {true, false}) {
    const std::string name = isNative ? "native" : "software";
    const std::int64_t need = memoryNeed(system, choices, true).total();  // llvmpipe has doubles, too
    sk::Device small(sk::DeviceOptions{.device = name, .memoryLimit = need - 1});
    sk::Device enough(sk::DeviceOptions{.device = name, .memoryLimit = need});
    CHECK_NOTHROW(checkMemory(enough, system, choices));
    CHECK_THROWS_WITH(checkMemory(small, system, choices),
                      Catch::Contains("poisson:32x32 needs about " + std::to_string(need) + " bytes") &&
                          Catch::Contains("has " + std::to_string(need - 1) +
                                          " available; take --layout stencil, --storage "
                                          "half, a solver"));
  }
}

}  // namespace
}  // namespace linear
