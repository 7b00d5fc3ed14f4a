// SPDX-License-Identifier: MIT
//
// Promises: streams that are sorted by dispatches end with the same bits as those that the host sorts. Runs on a
// software renderer, where by default the host sorts.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <random>
#include <type_traits>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "gl/open_context.hpp"
#include "gl_device/gl_device.hpp"
#include "sk/algorithm.hpp"
#include "sk/types.hpp"

namespace sk {
namespace {

std::unique_ptr<GlDevice> open(bool sorts, int textureLimit = 0) {
  const DeviceChoices choices{
      .textureLimit = textureLimit, .target = Target::Compute, .traits = {.sortsByDispatches = sorts}};
  return std::make_unique<GlDevice>(gl::openContext({"software", gl::Api::Gl}), choices);
}

std::unique_ptr<GlDevice> openEs(bool guaranteedLimits) {
  const DeviceChoices choices{
      .guaranteedLimits = guaranteedLimits, .target = Target::Compute, .traits = {.sortsByDispatches = true}};
  return std::make_unique<GlDevice>(gl::openContext({"software", gl::Api::Es}), choices);
}

struct Devices {
  std::unique_ptr<GlDevice> dispatching = open(true), hosting = open(false);
};

using Bytes = std::vector<std::byte>;

template <class T>
Bytes bytesOf(const std::vector<T>& values) {
  Bytes bytes(values.size() * sizeof(T));
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

/// A stream and its elements in host memory.
struct Data {
  const program::Element& element;
  Bytes bytes;
  Storage storage = Storage::Single;
};

template <class T>
Data dataOf(const std::vector<T>& values) {
  return {ElementTraits<T>::element(), bytesOf(values)};
}

struct Part {
  Index begin;
  Shape shape;
};

std::unique_ptr<StreamState> streamOf(GlDevice& device, const Data& data, const Shape& shape) {
  auto stream = device.createStream(data.element, shape, data.storage);
  stream->write(detail::wholeRegion(stream.get()), data.bytes.data());
  return stream;
}

/// What an algorithm leaves of the keys and the values, and what it returns.
struct Outcome {
  Bytes keys, values;
  std::int64_t result = 0;
  bool operator==(const Outcome&) const = default;
};

enum class Algorithm { Sort, SortDescending, Order, Unique, Partition };

Outcome carryOut(GlDevice& device, Algorithm algorithm, const Data& keys, const Data* values,
                 const Shape& shape, const Part* box) {
  const auto k = streamOf(device, keys, shape);
  const auto v = values != nullptr ? streamOf(device, *values, shape) : nullptr;
  const auto regionOf = [&](StreamState* stream) {
    return box != nullptr ? StreamRegion{stream, box->begin, box->shape} : detail::wholeRegion(stream);
  };
  const StreamRegion region = regionOf(k.get());
  const StreamRegion others = v ? regionOf(v.get()) : StreamRegion{};
  Outcome outcome{Bytes(keys.bytes.size()), Bytes(values != nullptr ? values->bytes.size() : 0)};
  switch (algorithm) {
    case Algorithm::Sort: detail::sort(region, v ? &others : nullptr, {}); break;
    case Algorithm::SortDescending: detail::sort(region, v ? &others : nullptr, {.descending = true}); break;
    case Algorithm::Order: {
      auto order = detail::TypedStreams::of<std::int32_t>(detail::order(region, {}));
      outcome.values = bytesOf(order.read());
      outcome.keys = bytesOf(std::vector<int>{});
      return outcome;
    }
    case Algorithm::Unique: outcome.result = detail::unique(region, v ? &others : nullptr); break;
    case Algorithm::Partition: outcome.result = detail::partition(region, others); break;
  }
  k->read(detail::wholeRegion(k.get()), outcome.keys.data());
  if (v) v->read(detail::wholeRegion(v.get()), outcome.values.data());
  return outcome;
}

void compare(Devices& devices, Algorithm algorithm, const Data& keys, const Data* values, const Shape& shape,
             const Part* box = nullptr) {
  CAPTURE(static_cast<int>(algorithm), shape.size(), shape.rank(), keys.element.name);
  const Outcome expected = carryOut(*devices.hosting, algorithm, keys, values, shape, box);
  PassCount& passes = devices.dispatching->passCount.emplace();
  CHECK((carryOut(*devices.dispatching, algorithm, keys, values, shape, box) == expected));
  CHECK(passes.passes >= 6);  // the host has not sorted
}

template <class T>
std::vector<T> keysOf(std::int64_t count) {
  using Limits = std::numeric_limits<T>;
  std::mt19937_64 random(static_cast<std::uint64_t>(count) + sizeof(T));
  std::vector<T> special{Limits::lowest(), Limits::max(), T{0}, T{1}};
  if constexpr (std::is_floating_point_v<T>) {
    const T nan = Limits::quiet_NaN();
    for (const T x : {-T{0}, nan, std::copysign(nan, T{-1}), Limits::infinity(), -Limits::infinity(),
                      Limits::denorm_min(), -Limits::denorm_min(), Limits::min()})
      special.push_back(x);
  }
  std::vector<T> keys(static_cast<std::size_t>(count));
  for (T& key : keys) {
    const std::uint64_t bits = random();
    if (bits % 16 < 4) {
      key = special[bits / 16 % special.size()];
    } else if constexpr (std::is_floating_point_v<T>) {
      key = std::ldexp(static_cast<T>(static_cast<std::int64_t>(random())),
                       static_cast<int>(bits / 16 % 60) - 90);
    } else {
      key = static_cast<T>(random() >> (bits / 16 % 33));
    }
  }
  return keys;
}

std::vector<int> iota(std::int64_t count) {
  std::vector<int> numbers;
  for (int i = 0; i < count; ++i) numbers.push_back(i);
  return numbers;
}

constexpr Algorithm byKeys[] = {Algorithm::Sort, Algorithm::SortDescending, Algorithm::Order,
                                Algorithm::Unique};

TEST_CASE("keys of each type are sorted by dispatches as by the host") {
  Devices devices;
  // Each algorithm with and without values, for a type of each kind: words that give the keys back, floats, and two words.
  const auto compareAll = [&](const Data& keys, const Shape& shape) {
    const Data values = dataOf(iota(shape.size()));
    for (const Algorithm algorithm : byKeys) {
      compare(devices, algorithm, keys, &values, shape);
      if (algorithm != Algorithm::Order) compare(devices, algorithm, keys, nullptr, shape);
    }
  };
  // What differs between types of a kind is how a key becomes a word, and back.
  const auto compareSome = [&](const Data& keys, const Shape& shape) {
    const Data values = dataOf(iota(shape.size()));
    compare(devices, Algorithm::SortDescending, keys, nullptr, shape);
    compare(devices, Algorithm::Unique, keys, &values, shape);
  };
  // Drivers compile a program once for each kind of texture sizes, so that all but the first have two tiles.
  for (const std::int64_t n : {1, 13, 4096}) compareSome(dataOf(keysOf<float>(n)), {n});
  compareAll(dataOf(keysOf<float>(4097)), {4097});
  compareAll(dataOf(keysOf<std::int32_t>(4099)), {4099});
  compareSome(dataOf(keysOf<std::uint32_t>(4099)), {4099});
  compareAll(dataOf(keysOf<double>(4099)), {4099});
  compareSome(dataOf(keysOf<float>(33 * 128)), {33, 128});  // packed
  compareSome(dataOf(keysOf<double>(7 * 6 * 5)), {7, 6, 5});
  compareSome(dataOf(std::vector<int>(4100, -3)), {4100});
}

TEST_CASE("more tiles than one sum holds are sorted") {
  Devices devices;
  constexpr std::int64_t n = 17 * 4096 + 5;
  const Data keys = dataOf(keysOf<std::int32_t>(n)), values = dataOf(iota(n));
  compare(devices, Algorithm::Sort, keys, &values, {n});
  compare(devices, Algorithm::Partition, keys, &values, {n});
}

TEST_CASE("words that do not fit into a buffer twice, or once, are sorted") {
  constexpr std::int64_t n = 4099;
  const Data keys = dataOf(keysOf<float>(n)), longs = dataOf(keysOf<double>(n)), values = dataOf(iota(n));
  for (const std::int64_t bytes : {8 * n, 4 * n, std::int64_t{0}}) {  // pairs once, keys once, nothing
    gl::OpenedContext opened = gl::openContext({"software", gl::Api::Gl});
    opened.capabilities.storageBytes = bytes;
    Devices devices;
    devices.dispatching = std::make_unique<GlDevice>(
        std::move(opened), DeviceChoices{.target = Target::Compute, .traits = {.sortsByDispatches = true}});
    compare(devices, Algorithm::Sort, keys, nullptr, {n});
    compare(devices, Algorithm::SortDescending, keys, &values, {n});
    compare(devices, Algorithm::Sort, longs, &values, {n});
    compare(devices, Algorithm::Unique, keys, &values, {n});
  }
}

TEST_CASE("the host sorts where the counts of digits need a texture with layers") {
  const std::unique_ptr<GlDevice> device = open(true, 8);
  const Data keys = dataOf(keysOf<std::int32_t>(40));
  const auto stream = streamOf(*device, keys, {40});
  detail::sort(detail::wholeRegion(stream.get()), nullptr, {});
  std::vector<std::int32_t> sorted = keysOf<std::int32_t>(40), read(40);
  std::ranges::sort(sorted);
  stream->read(detail::wholeRegion(stream.get()), reinterpret_cast<std::byte*>(read.data()));
  CHECK(read == sorted);
}

TEST_CASE("flags of each type divide values by dispatches as by the host") {
  Devices devices;
  for (const std::int64_t n : {1, 4097}) {
    std::vector<int> flags = keysOf<std::int32_t>(n);
    std::vector<std::uint8_t> bools;
    for (int& flag : flags) bools.push_back(static_cast<std::uint8_t>((flag &= 1) != 0));
    const Data values = dataOf(iota(n));
    compare(devices, Algorithm::Partition, dataOf(flags), &values, {n});
    compare(devices, Algorithm::Partition, {ElementTraits<bool>::element(), bytesOf(bools)}, &values, {n});
  }
}

TEST_CASE("OpenGL ES sorts by dispatches, too") {
  Devices devices{.dispatching = openEs(false)};
  constexpr std::int64_t n = 4099;
  const Data keys = dataOf(keysOf<float>(n)), longs = dataOf(keysOf<double>(n)), values = dataOf(iota(n));
  compare(devices, Algorithm::Sort, keys, nullptr, {n});
  compare(devices, Algorithm::SortDescending, keys, &values, {n});
  compare(devices, Algorithm::Sort, longs, &values, {n});
  compare(devices, Algorithm::Unique, keys, &values, {n});
}

TEST_CASE("where images of OpenGL ES hold no pairs, keys alone are sorted by dispatches") {
  Devices devices{.dispatching = openEs(true)};
  constexpr std::int64_t n = 4099;
  const Data keys = dataOf(keysOf<float>(n)), values = dataOf(iota(n));
  compare(devices, Algorithm::Sort, keys, nullptr, {n});
  PassCount& passes = devices.dispatching->passCount.emplace();
  const Outcome expected = carryOut(*devices.hosting, Algorithm::Sort, keys, &values, {n}, nullptr);
  CHECK((carryOut(*devices.dispatching, Algorithm::Sort, keys, &values, {n}, nullptr) == expected));
  CHECK(passes.passes == 0);  // the host has sorted
}

TEST_CASE("values of any type and views follow their keys") {
  Devices devices;
  constexpr Shape shape{40, 44};
  const Data keys = dataOf(keysOf<float>(shape.size()));
  Data halves = keys;
  halves.storage = Storage::Half;
  std::vector<float4> fours;
  std::vector<std::uint8_t> bools;
  for (int i = 0; i < shape.size(); ++i) {
    fours.push_back({static_cast<float>(i), 1, 2, std::numeric_limits<float>::quiet_NaN()});
    bools.push_back(static_cast<std::uint8_t>(i % 3 == 0));
  }
  const Data values[] = {dataOf(fours),
                         {ElementTraits<bool>::element(), bytesOf(bools)},
                         dataOf(keysOf<double>(shape.size())),
                         halves};
  const Part whole{{8, 4}, {20, 24}}, odd{{3, 1}, {20, 23}};
  for (const Data& data : values) {
    compare(devices, Algorithm::Sort, keys, &data, shape);
    compare(devices, Algorithm::Sort, keys, &data, shape, &whole);
    compare(devices, Algorithm::Unique, keys, &data, shape, &odd);
  }
  compare(devices, Algorithm::Sort, halves, nullptr, shape);
  compare(devices, Algorithm::SortDescending, halves, &values[0], shape, &odd);
}

}  // namespace
}  // namespace sk
