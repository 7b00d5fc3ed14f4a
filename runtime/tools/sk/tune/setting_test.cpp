// SPDX-License-Identifier: MIT
#include "tune/setting.hpp"

#include <fstream>
#include <stdexcept>

#include <catch2/catch.hpp>

#include "accuracy/child_process.hpp"

namespace {

using sk_tool::tune::BaseFile;
using sk_tool::tune::ProgramFacts;

/// The file with this text.
BaseFile baseOf(const std::string& text) {
  const sk_tool::TemporaryFolder folder;
  const std::string file = (folder.path() / "base.toml").string();
  std::ofstream(file) << text;
  return BaseFile(file);
}

}  // namespace

TEST_CASE("a setting is written over the file that a search starts from") {
  const BaseFile base = baseOf(
      "[kernels.\"heat::step\"]\nprecision = 'half'\ncontraction = \"fast\"\n[tables.f]\nintervals = 64\nlow "
      "= -1.5\n");
  CHECK(base.valueOf({"kernels", "heat::step", "precision"}) == "half");
  CHECK(base.namesIn("kernels") == std::vector<std::string>{"heat::step"});
  CHECK(base.text({{{"kernels", "heat::step", "precision"}, "double"}, {{"streams", "u", "storage"}, "half"}},
                  {}) ==
        "[kernels.\"heat::step\"]\ncontraction = \"fast\"\nprecision = \"double\"\n\n"
        "[streams.\"u\"]\nstorage = \"half\"\n\n"
        "[tables.\"f\"]\nintervals = 64\nlow = -1.5\n");
}

TEST_CASE("a kernel whose calls choose by themselves is forced") {
  const BaseFile base = baseOf("[kernels.k]\nintrinsics = \"fast\"\ntables = \"off\"\n");
  const ProgramFacts facts{.called = {{"k", {"precision double", "intrinsics accurate"}}}, .streams = {}};
  // the choice of intrinsics was overridden before, and must stay so
  CHECK(base.text({{{"kernels", "k", "precision"}, "single"}}, facts) ==
        "[kernels.\"k\"]\n"
        "force = true                    # its calls choose by themselves\n"
        "precision = \"single\"\ntables = \"off\"\n");
  CHECK(base.text({{{"kernels", "k", "contraction"}, "fast"}}, facts) ==
        "[kernels.\"k\"]\ncontraction = \"fast\"\nintrinsics = \"fast\"\ntables = \"off\"\n");
}

TEST_CASE("a choice for streams without a name leaves those with a name alone") {
  const ProgramFacts facts{.called = {}, .streams = {{"u", "single"}, {"v", "half"}}};
  CHECK(BaseFile().text({{{"streams", "*", "storage"}, "half"}, {{"streams", "v", "storage"}, "double"}},
                        facts) ==
        "[streams.\"*\"]\nstorage = \"half\"\n\n[streams.\"u\"]\nstorage = \"single\"\n\n"
        "[streams.\"v\"]\nstorage = \"double\"\n");
}

TEST_CASE("a file that is no TOML is refused with its line") {
  std::string message;
  try {
    baseOf("[kernels.k]\nprecision =\n");
  } catch (const std::runtime_error& error) {
    message = error.what();
  }
  CHECK_THAT(message, Catch::Contains("base.toml:2: "));
}
