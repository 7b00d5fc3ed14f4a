// SPDX-License-Identifier: MIT
#include "native/entries.hpp"

#include <string>

#include <catch2/catch.hpp>

#include "native/object_code_test.hpp"
#include "sk/error.hpp"

using sk::native::Entry;
using sk::native::EntryKind;
using sk::native::Level;

namespace {

void run(const sk::native::Frame*, const sk::native::Chunk*) {}

/// A kernel with code for these levels.
class NativeKernel {
 public:
  explicit NativeKernel(std::initializer_list<Level> levels) {
    for (const Level level : levels) {
      Entry entry = sk::test::entry(EntryKind::Run, &run);
      entry.level = level;
      made_.entries.push_back(entry);
    }
    made_.finish();
  }

  Level chosenOn(Level cpu) { return sk::entryOf(made_.kernel, EntryKind::Run, {}, cpu).level; }
  sk::native::Code& code() { return made_.code; }

 private:
  sk::test::TestKernel made_;
};

}  // namespace

TEST_CASE("the newest code that the CPU runs is chosen") {
  NativeKernel kernel({Level::Base, Level::V3});
  CHECK(kernel.chosenOn(Level::Base) == Level::Base);
  CHECK(kernel.chosenOn(Level::V3) == Level::V3);
  CHECK(kernel.chosenOn(Level::V4) == Level::V3);
}

TEST_CASE("code for newer CPUs alone is refused with the way out") {
  NativeKernel kernel({Level::V4});
  CHECK_THROWS_WITH(kernel.chosenOn(Level::V3),
                    Catch::Contains("x86-64-v4") && Catch::Contains("skc --levels=x86-64"));
}

TEST_CASE("code of another version is refused with the way out") {
  NativeKernel kernel({Level::Base});
  kernel.code().version = sk::native::Code::currentVersion + 1;
  CHECK_THROWS_WITH(kernel.chosenOn(Level::Base),
                    Catch::Contains("version " + std::to_string(sk::native::Code::currentVersion)) &&
                        Catch::Contains("the skc that belongs to the runtime"));
}

TEST_CASE("levels of the CPU have names") {
  CHECK(sk::levelNamed("x86-64") == Level::Base);
  CHECK(sk::levelNamed("x86-64-v4") == Level::V4);
  CHECK_THROWS_WITH(sk::levelNamed("x86-64-v2"),
                    Catch::Contains("choose x86-64, x86-64-v3 or x86-64-v4 (SK_CPU)"));
}
