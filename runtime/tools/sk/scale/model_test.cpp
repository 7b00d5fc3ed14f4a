// SPDX-License-Identifier: MIT
//
// Compares the model with sums by hand: what ranks send, the formulas of LogGP, and the choices that follow.
#include "scale/model.hpp"

#include <catch2/catch.hpp>

#include "scale/quantities.hpp"

namespace {

using Catch::Contains;
using sk_tool::Cluster;
using sk_tool::Distribution;
using sk_tool::ExchangedStream;
using sk_tool::Extents;
using sk_tool::Halo;
using sk_tool::Network;
using sk_tool::ScaledStep;
using sk_tool::Sent;
using sk_tool::Split;

constexpr Network network{.latency = 1e-6, .overhead = 0.5e-6, .gap = 0.75e-6, .gapPerByte = 1 / 25e9};

/// One kernel with a five-point stencil of floats, or a seven-point stencil in three dimensions.
ScaledStep stencil(const Extents& grid, double perElement, double perCall = 0) {
  return {.grid = grid,
          .periodic = std::vector<bool>(grid.size(), true),
          .calls = {{.name = "diffuse",
                     .perCall = perCall,
                     .perElement = perElement,
                     .boxes = {.borderTime = perCall},
                     .gathers = {{.name = "u",
                                  .stream = {.bytes = 4, .halo = std::vector<Halo>(grid.size(), {1, 1})}}}}},
          .bytesPerElement = 8};
}

TEST_CASE("ranks send faces, edges and corners to those next to them", "[scale]") {
  const ExchangedStream streams[] = {{.bytes = 4, .halo = {{1, 2}, {3, 0}}}};
  const Split split{.parts = {3, 4}, .periodic = {false, false}};
  const Sent inner = sentBy(split, {10, 20}, {1, 1}, streams);
  CHECK(inner.messages == 5);  // above, below, to the right, and two corners there
  CHECK(inner.bytes == 4 * (1 * 20 + 2 * 20 + 10 * 3 + 1 * 3 + 2 * 3));
  const Sent corner = sentBy(split, {10, 20}, {0, 3}, streams);
  CHECK(corner.messages == 1);  // nobody is above or to the right, and nobody reads to the right
  CHECK(corner.bytes == 4 * 1 * 20);
  const Split wrapped{.parts = {3, 4}, .periodic = {true, true}};
  CHECK(sentBy(wrapped, {10, 20}, {0, 3}, streams).bytes == inner.bytes);
  CHECK(sentBy({.parts = {1, 1}, .periodic = {true, true}}, {10, 20}, {0, 0}, streams).messages ==
        0);  // nothing is split
  const ExchangedStream two[] = {streams[0], {.bytes = 8, .halo = {{0, 0}, {0, 5}}}};
  const Sent both = sentBy(split, {10, 20}, {1, 1}, two);
  CHECK(both.messages == 6);  // and to the left
  CHECK(both.bytes == inner.bytes + 8 * 10 * 5);
  // Each of two parts is on both sides of the other.
  CHECK(sentBy({.parts = {1, 2}, .periodic = {true, true}}, {10, 20}, {0, 0}, streams).bytes ==
        4 * 2 * 10 * 3);
}

TEST_CASE("parts of an extent are equal, or the first ones have one more", "[scale]") {
  std::int64_t sum = 0;
  for (std::int64_t part = 0; part < 6; ++part) sum += sk_tool::partExtent(20, 6, part);
  CHECK(sum == 20);
  CHECK(sk_tool::partExtent(20, 6, 1) == 4);
  CHECK(sk_tool::partExtent(20, 6, 2) == 3);
}

TEST_CASE("every grid of processes is tried once", "[scale]") {
  CHECK(sk_tool::processGrids(6, 2) == std::vector<Extents>{{1, 6}, {2, 3}, {3, 2}, {6, 1}});
  CHECK(sk_tool::processGrids(4096, 3).size() == 91);  // (12 + 2 choose 2)
  CHECK(sk_tool::processGrids(1, 4) == std::vector<Extents>{{1, 1, 1, 1}});
  CHECK(sk_tool::splitDimensions({4, 1, 2}) == 2);
}

TEST_CASE("LogGP's formulas", "[scale]") {
  CHECK(exchangeTime(network, 1, 1001) == Approx(2e-6 + 1000 / 25e9));  // o + (k - 1) G + L + o
  CHECK(exchangeTime(network, 2, 2002) == Approx(2e-6 + 0.75e-6 + 2000 / 25e9));
  CHECK(exchangeTime(network, 0, 0) == 0);
  CHECK(allReduceTime(network, 1, 8) == 0);
  CHECK(allReduceTime(network, 5, 9) == Approx(3 * (2e-6 + 8 / 25e9)));
  const Network parsed = Network::parse("25GB/s,2us");
  CHECK(parsed.latency + 2 * parsed.overhead == Approx(2e-6));
  CHECK(parsed.gapPerByte == Approx(1 / 25e9));
  CHECK(Network::parse("200Gbit/s,2us,600ns,1us").gap == Approx(1e-6));
}

TEST_CASE("an exchange is hidden behind the interior, and what is left over is waited for", "[scale]") {
  const double perElement = 1e-9;
  const ScaledStep step = stencil({1000, 1000}, perElement, 5e-6);
  const double exchange = 2.75e-6 + (2 * 4000 - 2) / 25e9;
  Cluster cluster{.network = network};
  Distribution one = *predict(step, cluster, {4, 1}, 1, timeOfOne(step));
  CHECK(one.messages == 2);
  CHECK(one.bytes == 8000);
  CHECK(one.exchange == Approx(exchange));
  CHECK(one.waiting == 0);
  CHECK(one.time == Approx(250e3 * perElement + 3 * 5e-6));  // and two calls for the borders
  CHECK(one.efficiency == Approx((1e6 * perElement + 5e-6) / (4 * one.time)));
  cluster.hasOverlap = false;
  one = *predict(step, cluster, {4, 1}, 1, timeOfOne(step));
  CHECK(one.time == Approx(250e3 * perElement + 5e-6 + exchange));
  cluster = {.network = network,
             .staging = {.readTime = 1e-3, .readBandwidth = 1e9, .writeTime = 2e-3, .writeBandwidth = 2e9}};
  one = *predict(step, cluster, {4, 1}, 1, timeOfOne(step));
  const double staged = 3e-3 + 8000 / 1e9 + 8000 / 2e9;
  CHECK(one.exchange == Approx(exchange + staged));
  CHECK(one.waiting == Approx(staged));  // the device copies between kernels, and only messages are hidden
}

TEST_CASE("boxes cost more than whole streams, where a grid is split", "[scale]") {
  ScaledStep step = stencil({1000, 1000}, 1e-9, 5e-6);
  step.calls[0].boxes = {.factor = 1.5, .borderTime = 7e-6};
  const Cluster cluster{.network = network};
  CHECK(predict(step, cluster, {1, 1}, 1, timeOfOne(step))->time == Approx(timeOfOne(step)));
  CHECK(predict(step, cluster, {4, 1}, 1, timeOfOne(step))->time == Approx(250e3 * 1.5e-9 + 5e-6 + 2 * 7e-6));
}

TEST_CASE("two GPUs take what two H100 of one host took", "[scale]") {
  // docs/domains.md. Copies of two halos, packed and unpacked by dispatches, took 22 and 23 us for 32 kB, 48 and 55 us for 512 kB.
  const Cluster cluster{
      .network = {.latency = 2e-6, .overhead = 1e-6, .gap = 1e-6, .gapPerByte = 1 / 20e9},
      .staging = {.readTime = 22e-6, .readBandwidth = 18.5e9, .writeTime = 23e-6, .writeBandwidth = 15e9}};
  struct Measured {
    std::int64_t extent, every;
    double plain, time;
  };
  for (const Measured& one : {Measured{4096, 1, 50.8e-6, 114.7e-6}, Measured{4096, 4, 50.8e-6, 70.7e-6},
                              Measured{4096, 8, 50.8e-6, 75.9e-6}, Measured{4096, 16, 50.8e-6, 71.4e-6},
                              Measured{16384, 1, 732e-6, 799.9e-6}, Measured{16384, 4, 732e-6, 757.2e-6}}) {
    const auto elements = static_cast<double>(one.extent * one.extent);
    ScaledStep step = stencil({one.extent, one.extent}, (one.plain - 4e-6) / elements, 4e-6);
    step.isPerDevice = true;
    step.calls[0].boxes = {.factor = 1, .borderTime = 8e-6};
    const Distribution two = *predict(step, cluster, {2, 1}, one.every, timeOfOne(step));
    INFO(one.extent << ", every " << one.every << ": " << two.time);
    CHECK(two.time > 0.8 * one.time);
    CHECK(two.time < 1.05 * one.time);
  }
}

TEST_CASE("halos for several steps cost margins and save messages", "[scale]") {
  const double perElement = 1e-9;
  const ScaledStep step = stencil({1000, 1000}, perElement);
  const Cluster cluster{.network = network};
  const Distribution one = *predict(step, cluster, {4, 1}, 3, timeOfOne(step));
  CHECK(one.messages == Approx(2.0 / 3));
  CHECK(one.bytes == Approx(2 * 3 * 4000 / 3.0));
  CHECK(one.compute == Approx((254 + 252 + 250) * 1e3 * perElement / 3));
  CHECK(one.memory == (250 + 6) * 1e3 * 8);
  CHECK_FALSE(predict(step, cluster, {4, 1}, 251, timeOfOne(step)));  // deeper than a block
}

TEST_CASE("calls of a step exchange what each of them reads", "[scale]") {
  ScaledStep step = stencil({1000, 1000}, 1e-9);
  step.calls.push_back({.name = "sharpen",
                        .perElement = 1e-9,
                        .gathers = {{.name = "v", .stream = {.bytes = 8, .halo = {{2, 0}, {0, 0}}}},
                                    {.name = "w", .stream = {.bytes = 2, .halo = {{0, 1}, {0, 0}}}}}});
  step.calls.push_back({.name = "sum", .perElement = 1e-9, .gathers = {}, .reducedBytes = 4});
  const Distribution one = *predict(step, {.network = network}, {4, 1}, 1, timeOfOne(step));
  CHECK(one.messages == 4);
  CHECK(one.bytes == 8000 + 16000 + 2000);
  // What diffuse exchanges for three calls is enough for sharpen, and then there is nothing left before an element.
  const Distribution third = *predict(step, {.network = network}, {4, 1}, 3, timeOfOne(step));
  CHECK(third.messages == 2);
  CHECK(third.bytes == 2 * 3 * 4000);
  CHECK(third.compute > one.compute);
  CHECK(one.waiting == Approx(allReduceTime(network, 4, 4)));  // halos are hidden, sums are not
}

TEST_CASE("the best split of a cube has three dimensions, of a ribbon one", "[scale]") {
  const Cluster cluster{.network = network};
  const auto cube = bestOf(stencil({4096, 4096, 4096}, 1e-11), cluster, 4096);
  REQUIRE(cube.best);
  CHECK(cube.best->parts == Extents{16, 16, 16});
  const auto ribbon = bestOf(stencil({1 << 20, 64}, 1e-11), cluster, 256);
  REQUIRE(ribbon.best);
  CHECK(ribbon.best->parts == Extents{256, 1});
  CHECK(ribbon.byDimensions[1]->time >= ribbon.best->time);
  CHECK(bestOf(stencil({64, 64}, 1e-6), cluster, 2).best->parts == Extents{2, 1});  // rows are contiguous
  CHECK_FALSE(bestOf(stencil({8, 8}, 1e-11), cluster, 4096).best);  // more devices than elements
}

TEST_CASE("a slow network makes deep halos worthwhile, a fast one does not", "[scale]") {
  const ScaledStep step = stencil({4096, 4096}, 2e-12);
  const Cluster fast{.network = {.gapPerByte = 1e-12}},
      slow{.network = {.latency = 1e-3, .gapPerByte = 1e-10}};
  CHECK(bestOf(step, fast, 16).best->exchangeEvery == 1);
  CHECK(bestOf(step, slow, 16).best->exchangeEvery >= 16);
}

TEST_CASE("blocks that fit the memory are preferred, and it is said if none does", "[scale]") {
  const ScaledStep step = stencil({1000, 1000}, 1e-9);
  Cluster cluster{.network = network, .memory = 8.0 * 260e3};
  CHECK(bestOf(step, cluster, 4).fits);
  CHECK_FALSE(bestOf(step, cluster, 2).fits);
  cluster.memory = 8.0 * 253e3;
  const auto few = bestOf(step, cluster, 4);
  CHECK(few.fits);
  CHECK(few.best->exchangeEvery == 1);
}

TEST_CASE("with a grid for each device, efficiency is the time of one over the time", "[scale]") {
  ScaledStep step = stencil({16384, 16384}, 402e-6 / (16384.0 * 16384));
  step.isPerDevice = true;
  const Cluster cluster{
      .network = Network::parse("25GB/s,2us"),
      .staging = {.readTime = 26e-6, .readBandwidth = 12e9, .writeTime = 22e-6, .writeBandwidth = 5.6e9}};
  const auto many = bestOf(step, cluster, 1024);
  REQUIRE(many.best);
  CHECK(many.best->block == Extents{16384, 16384});
  // copies of two or three rows take 76 us of 402, more often if fewer at a time
  CHECK(many.best->efficiency > 0.8);
  CHECK(predict(step, cluster, many.best->parts, 1, timeOfOne(step))->efficiency < 0.85);
}

TEST_CASE("quantities are parsed, and nonsense is repeated with what is accepted", "[scale]") {
  using namespace sk_tool;
  CHECK(parseGrid("1e4x500x3") == Extents{10000, 500, 3});
  CHECK(parseCounts("1..12") == Extents{1, 2, 4, 8, 12});
  CHECK(parseCounts("6,2,2") == Extents{2, 6});
  CHECK(parseBandwidth("200Gbit/s") == Approx(25e9));
  CHECK(parseBandwidth("1.5GiB/s") == Approx(1.5 * 0x1p30));
  CHECK(parseTime("800ns") == Approx(8e-7));
  CHECK(parseBytes("80GB") == Approx(80e9));
  for (const char* grid :
       {"", "0x5", "-1", "1.5", "4x", "x4", "1e4y3", "nan", "inf", "1e99", "2x2x2x2x2", "1e9x1e9x9"}) {
    CHECK_THROWS_WITH(parseGrid(grid),
                      Contains("grid '") || Contains(std::string("'") + grid + "' is no grid"));
  }
  for (const char* counts : {"", "0", "4..2", "1..", "..4", "1..1e9", "two"})
    CHECK_THROWS(parseCounts(counts));
  for (const char* bandwidth : {"", "25", "25GB", "25us", "0GB/s", "-1GB/s", "nanGB/s", "25 GB/s", "GB/s"}) {
    CHECK_THROWS_WITH(parseBandwidth(bandwidth), Contains("25GB/s"));
  }
  for (const char* time : {"", "2", "2GB/s", "0us", "-2us", "2 us", "us"})
    CHECK_THROWS_WITH(parseTime(time), Contains("2us"));
  CHECK_THROWS_WITH(Network::parse("25GB/s"), Contains("BANDWIDTH,LATENCY"));
  CHECK_THROWS_WITH(Network::parse("25GB/s,2us,3us"), Contains("half of the latency"));
  CHECK_THROWS_WITH(Staging::parse("fast"), Contains("none"));
  CHECK_FALSE(Staging::parse("none").isNeeded());
  CHECK(Boxes::parse("1.25,6us").factor == 1.25);
  for (const char* boxes : {"", "2", "0.5,1us", "nan,1us", "2,1", "2x,1us", "1e9,1us"})
    CHECK_THROWS(Boxes::parse(boxes));
}

}  // namespace
