// SPDX-License-Identifier: MIT
#include "serve/compilation.hpp"

#include <catch2/catch.hpp>

namespace {

using sk_tool::Message;
using sk_tool::messagesOf;
using Messages = std::vector<Message>;

}  // namespace

TEST_CASE("Messages have their places") {
  const std::string written =
      "/tmp/a b/program.sk:3:7: error: use of undeclared identifier 'y'\n"
      "    3 |   r = y;\n"
      "      |       ^\n"
      "/tmp/a b/program.sk:1:1: note: declared here\n"
      "/tmp/a b/program.sk:9:2: warning: unused: x\n"
      "1 error generated.\n";
  CHECK(messagesOf(written, "/tmp/a b/program.sk") ==
        Messages{{3, 7, "error", "use of undeclared identifier 'y'"},
                 {1, 1, "note", "declared here"},
                 {9, 2, "warning", "unused: x"}});
}

TEST_CASE("Messages about a whole file, and of skc itself, have none") {
  CHECK(messagesOf("p.sk: error: the file is empty\nskc: 'p.sk' cannot be written\n", "p.sk") ==
        Messages{{0, 0, "error", "the file is empty"}, {0, 0, "error", "'p.sk' cannot be written"}});
  CHECK(messagesOf("p.sk:2:9: fatal error: 'x.sk' file not found\n", "p.sk") ==
        Messages{{2, 9, "error", "'x.sk' file not found"}});
}

TEST_CASE("Other lines are no messages") {
  CHECK(messagesOf("", "p.sk").empty());
  CHECK(messagesOf("other.sk:1:1: error: x\np.sk\np.sk:\np.sk:1:1\n", "p.sk").empty());
  CHECK(messagesOf("p.sk:1:1: error: " + std::string(1'000'000, 'x'), "p.sk").size() == 1);
}
