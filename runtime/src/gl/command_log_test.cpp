// SPDX-License-Identifier: MIT
//
// Promises: a log goes stale with each object that a command of it names, and with no other.
#include "gl/command_log.hpp"

#include <vector>

#include <catch2/catch.hpp>

#include "gl/bound_state.hpp"

namespace sk::gl {
namespace {

using Kind = Command::Kind;

TEST_CASE("a log is stale once an object that it names is deleted") {
  BoundState bound;
  CommandLog log, dropped;
  for (CommandLog* const one : {&log, &dropped}) {
    one->note({.kind = Kind::Program, .name = 1});
    one->note({.kind = Kind::Texture, .unit = 2, .name = 3});
    one->note({.kind = Kind::Image, .name = 4});
    one->note({.kind = Kind::Framebuffer, .name = 5});
    one->note({.kind = Kind::Storage, .name = 6});
    one->note({.kind = Kind::LoopStorage, .name = 7});
    bound.keep(*one);
  }
  bound.drop(dropped);
  bound.forgetProgram(3);  // names of different kinds of objects have nothing to do with each other
  bound.forgetTexture(1);
  bound.forgetTexture(5);
  bound.forgetFramebuffer(4);
  bound.forgetStorage(5);
  CHECK_FALSE(log.isStale());
  SECTION("a program") { bound.forgetProgram(1); }
  SECTION("a texture") { bound.forgetTexture(3); }
  SECTION("an image") { bound.forgetTexture(4); }
  SECTION("a framebuffer") { bound.forgetFramebuffer(5); }
  SECTION("a buffer") { bound.forgetStorage(6); }
  SECTION("the buffer of reports") { bound.forgetStorage(7); }
  CHECK(log.isStale());
  CHECK_FALSE(dropped.isStale());
}

TEST_CASE("equal dispatches share their counts") {
  CommandLog one, other;
  one.note({.kind = Kind::Dispatch, .numbers = {2, 3}});
  one.note({.kind = Kind::Dispatch, .numbers = {4, 1}});
  other.note({.kind = Kind::Dispatch, .numbers = {4, 1}});
  other.note({.kind = Kind::Dispatch, .numbers = {1, 4}});
  std::vector<CommandLog::Groups> groups;
  one.setGroups(groups);
  other.setGroups(groups);
  CHECK(groups == std::vector<CommandLog::Groups>{{2, 3}, {4, 1}, {1, 4}});
}

TEST_CASE("what a log cannot hold spoils it, unless it is left out") {
  BoundState bound;
  CommandLog log;
  bound.logTo(&log);
  {
    const UnloggedScope unlogged(bound);
    CHECK_FALSE(bound.isLogged());
    bound.spoil();
  }
  CHECK(bound.isLogged());
  CHECK_FALSE(log.isSpoiled());
  bound.spoil();
  CHECK(log.isSpoiled());
  CHECK(bound.logTo(nullptr) == &log);
}

}  // namespace
}  // namespace sk::gl
