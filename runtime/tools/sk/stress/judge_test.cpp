// SPDX-License-Identifier: MIT
#include "stress/judge.hpp"

#include <csignal>

#include <catch2/catch.hpp>

using namespace sk_tool::stress;
using Kind = Finding::Kind;

namespace {

Run healthy() {
  Run run{.of = {.text = "as it is"}};
  run.process.status = 0;
  run.process.wall = 0.5;
  run.seen = Observation{};
  run.seen->calls = 40;
  run.seen->results = {{"u", 100, 0, 1e-7}};
  run.seen->kernels = {{"a::step", 40}};
  run.seen->loops = {{"done", 0, 12}};
  return run;
}

Run atExtreme(bool mustHold = true) {
  Run run = healthy();
  run.of = {.kind = Case::Kind::Value, .text = "a::step.dt = 1", .mustHold = mustHold};
  return run;
}

Run judged(Run run) {
  run.findings = findingsIn(run, healthy());
  return run;
}

}  // namespace

TEST_CASE("a run like the program as it is has no findings") {
  CHECK(judged(atExtreme()).findings.empty());
  const Run plain = healthy();
  CHECK(findingsIn(plain, plain).empty());
}

TEST_CASE("crashes count everywhere, a status only within ranges") {
  for (const bool mustHold : {true, false}) {
    Run crash = atExtreme(mustHold);
    crash.process.status = SIGSEGV;
    crash.seen.reset();
    crash = judged(crash);
    REQUIRE(crash.findings.size() == 1);
    CHECK(crash.findings[0].kind == Kind::Crash);
    CHECK(crash.isBroken());
    Run status = atExtreme(mustHold);
    status.process.status = 2 << 8;
    status.process.messages = "\n  too large";
    status = judged(status);
    CHECK(status.findings[0].text == "ends with status 2\n  too large");
    CHECK(status.isBroken() == mustHold);
    status.of.kind = Case::Kind::Size;
    CHECK_FALSE(status.isBroken());
  }
}

TEST_CASE("a run that does not end says what it has done") {
  Run run = atExtreme();
  run.process.status.reset();
  run.process.wall = 20;
  run.seen->calls = 9000;
  run = judged(run);
  CHECK(run.findings[0].kind == Kind::Unended);
  CHECK(run.findings[0].text == "has not ended after 20 s, and takes 0.5 s as it is; it had made 9000 calls");
}

TEST_CASE("results that are not finite are named with their origin, and a NaN that was given spreads") {
  Run run = atExtreme();
  run.seen->results[0].withoutValue = 3;
  run.seen->results[0].error = 1;
  run.seen->origin = Origin{false, "a::step", "r", 7, true};
  const Run broken = judged(run);
  REQUIRE(broken.findings.size() == 1);
  CHECK(broken.findings[0].text ==
        "3 of 100 elements of 'u' are NaN or infinite; the first infinity comes from a::step, call 7, output "
        "'r', "
        "in double as well");
  CHECK(broken.isBroken());
  run.of.hasNan = true;
  const Run spread = judged(run);
  CHECK(spread.findings[0].text == "the NaN spreads to 3 of 100 elements of 'u'");
  CHECK_FALSE(spread.isBroken());
}

TEST_CASE("loops that end at their limit, of the device and of the program") {
  Run run = atExtreme();
  run.seen->loops[0] = {"done", 1, 500};
  CHECK(judged(run).findings[0].text ==
        "the loop until 'done' stops at its limit: 500 iterations, 12 as it is");
  run = atExtreme();
  run.seen->kernels[0].calls = 4000;
  CHECK(judged(run).findings[0].text ==
        "calls a::step 4000 times, 40 as it is: what it waits for comes late or never");
  run.of.kind = Case::Kind::Size;  // more elements take more steps
  CHECK(judged(run).findings.empty());
}

TEST_CASE("errors count where the program as it is has none") {
  Run run = atExtreme();
  run.seen->results[0].error = 0.1;
  CHECK(judged(run).findings[0].text == "1.0 digits of 'u' survive, 7.0 as it is");
  run.seen->unstable = "unstable time step";
  CHECK(judged(run).findings[0].kind == Kind::Unstable);
  Run plain = healthy();
  plain.seen->results[0].error = 0.05;
  plain.seen->unstable = "unstable time step";
  run.findings = findingsIn(run, plain);
  CHECK(run.findings.empty());
}
