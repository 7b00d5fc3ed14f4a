// SPDX-License-Identifier: MIT
#include "gl_device/program/shader_log.hpp"

#include <array>

#include <catch2/catch.hpp>

namespace {

const std::array<std::string_view, 2> sources{"heat.sk", "stencil.sk"};

}  // namespace

TEST_CASE("line directives tell the source in the line") {
  CHECK(sk::withEncodedLines("#version 330\n#line 7 1\nx\n#line 1 0\n#line 3\ny") ==
        "#version 330\n#line 1048583\nx\n#line 1\n#line 3\ny");
}

TEST_CASE("places of a log get the names of files") {
  CHECK(sk::withSourceNames("0:1048599(5): error: x\n0:9(1): error: y\n", sources) ==
        "heat.sk:23(5): error: x\nassembled program:9(1): error: y\n");
  CHECK(sk::withSourceNames("0(2097164) : error C1008: z", sources) == "stencil.sk:12 : error C1008: z");
  CHECK(sk::withSourceNames("ERROR: 0:1048577: 'q' : undeclared", sources) ==
        "ERROR: heat.sk:1: 'q' : undeclared");
}

TEST_CASE("other lines of a log stay") {
  for (const char* line : {"", "error: unresolved reference", "0:", "12", "3 warnings", "0:9999999999: far",
                           "0:4194304(1): no such source"}) {
    CHECK(sk::withSourceNames(line, sources) == line);
  }
}
