// SPDX-License-Identifier: MIT
#include "scene.hpp"

#include <cstring>
#include <stdexcept>

#include "faults.sk.hpp"

namespace faults {

namespace {

using namespace faulty;

/// first, first + 1, ... first + 6, repeated.
template <class T>
std::vector<T> numbers(const sk::Stream<T>& stream, int first) {
  std::vector<T> made(static_cast<std::size_t>(stream.size()));
  for (std::size_t i = 0; i < made.size(); ++i) {
    const auto number = static_cast<int>(i % 7) + first;
    if constexpr (std::is_same_v<T, sk::float4>) {
      made[i] = {static_cast<float>(number), 1, 2, 3};
    } else {
      made[i] = static_cast<T>(number);
    }
  }
  return made;
}

template <class T>
std::optional<std::vector<std::byte>> bytesOf(const sk::Stream<T>& stream) {
  try {
    const std::vector<T> elements = stream.read();
    std::vector<std::byte> bytes(elements.size() * sizeof(T));
    if (!bytes.empty()) std::memcpy(bytes.data(), elements.data(), bytes.size());
    return bytes;
  } catch (const sk::Error& error) {
    if (error.kind() != sk::Error::Kind::Lost) throw;
    return std::nullopt;
  }
}

void expect(bool isRight, const char* what) {
  if (!isRight) throw std::logic_error(what);
}

std::vector<std::int32_t> multiplesOf8(std::size_t count) {
  std::vector<std::int32_t> made(count);
  for (std::size_t i = 0; i < count; ++i) made[i] = static_cast<std::int32_t>(8 * i);
  return made;
}

float sumOfNumbers(std::int64_t count) {
  float total = 0;
  for (std::int64_t i = 0; i < count; ++i) total += static_cast<float>(i % 7);
  return total;
}

}  // namespace

Scene::Scene(sk::Device& on, std::int64_t rows)
    : device(on),
      size(rows),
      fives(static_cast<std::size_t>(rows * 8), 5.0F),
      rowStarts(multiplesOf8(static_cast<std::size_t>(rows) + 1)) {
  x = device.stream<float>({size, 8});
  r = device.stream<float>({size, 8});
  s = device.stream<float>({size, 8});
  box = device.stream<float>({2, size, 6});  // linearised
  part = device.stream<float>({size, 1});
  pushed = device.stream<float>({3});
  indices = device.stream<std::int32_t>({size, 8});
  bins = device.stream<std::int32_t>({size + 7});
  for (auto& stream : halves) stream = device.stream<float>({size, 1}, sk::Storage::Half);
  for (auto& stream : wide) stream = device.stream<sk::float4>({size, 8});
  reset();
}

void Scene::reset() {
  resetInputs();
  r.write(numbers(r, 10));
  s.write(numbers(s, 20));
  part.write(numbers(part, 40));
  pushed = device.stream<float>({3});
  pushed.write(numbers(pushed, 50));
  indices.write(numbers(indices, 0));
  bins.write(numbers(bins, 60));
  for (auto& stream : halves) stream.write(numbers(stream, 65));
  for (auto& stream : wide) stream.write(numbers(stream, 70));
}

void Scene::resetInputs() {
  x.write(numbers(x, 0));
  box.write(numbers(box, 30));
}

Scene::Elements Scene::elements() const {
  Elements all = {bytesOf(x),    bytesOf(r),      bytesOf(s),       bytesOf(box),
                  bytesOf(part), bytesOf(pushed), bytesOf(indices), bytesOf(bins)};
  for (const auto& stream : halves) all.push_back(bytesOf(stream));
  for (const auto& stream : wide) all.push_back(bytesOf(stream));
  return all;
}

const std::vector<Scenario>& scenarios() {
  static const std::vector<Scenario> all = {
      {"make a stream", {"a new stream"}, [](Scene& of) { of.device.stream<sk::float3>({of.size, 5}); }},
      {"write", {"write"}, [](Scene& of) { of.r.write(of.fives); }, false, false, true},
      {"write a view",
       {"write"},
       [](Scene& of) { of.r.domain({1, 1}, {3, 4}).write(std::span(of.fives).first(6)); }},
      {"write a view of a box",
       {"write"},
       [](Scene& of) { of.box.domain({0, 1, 1}, {2, 3, 4}).write(std::span(of.fives).first(12)); }},
      {"write without waiting", {"writeAsync"}, [](Scene& of) { of.r.writeAsync(of.fives); }},
      {"write a view of a box without waiting",
       {"writeAsync"},
       [](Scene& of) { of.box.domain({0, 1, 1}, {2, 3, 4}).writeAsync(std::span(of.fives).first(12)); }},
      {"fill", {"fill"}, [](Scene& of) { of.r.fill(3); }, false, false, true},
      {"fill a view of a box", {"fill"}, [](Scene& of) { of.box.domain({0, 1, 1}, {2, 3, 4}).fill(3); }},
      {"copy", {"copyTo"}, [](Scene& of) { of.x.copyTo(of.r); }, false, false, true},
      {"copy a view of a box",
       {"copyTo"},
       [](Scene& of) { of.box.domain({0, 0, 0}, {2, 2, 3}).copyTo(of.box.domain({0, 1, 2}, {2, 3, 5})); }},
      {"read", {"read"}, [](Scene& of) { expect(of.x.read()[9] == 2, "read"); }},
      {"read a view",
       {"read"},
       [](Scene& of) { expect(of.box.domain({0, 1, 1}, {2, 3, 4}).read()[0] == 30, "box"); }},
      {"read without waiting",
       {"readAsync"},
       [](Scene& of) {
         sk::Future<float> early = of.x.readAsync();
         static_cast<void>(early.ready());
         early.wait();
         expect(early.get()[9] == 2, "readAsync");
       }},
      {"call", {"faulty::scale"}, [](Scene& of) { scale(2.0F, of.x, of.r); }, false, false, true},
      {"call in place", {"faulty::scale"}, [](Scene& of) { scale(3.0F, of.x, of.x); }},
      {"call that reads what it writes",
       {"faulty::shift"},
       [](Scene& of) { shift(of.part.domain({0, 0}, {of.size, 1}), of.part); },
       true},
      {"call on a view",
       {"faulty::scale"},
       [](Scene& of) { scale(2.0F, of.x.domain({0, 1}, {2, 4}), of.r.domain({1, 3}, {3, 6})); }},
      {"call on overlapping views",
       {"faulty::scale"},
       [](Scene& of) { scale(2.0F, of.x.domain({0, 1}, {2, 4}), of.x.domain({1, 2}, {3, 5})); }},
      {"call on overlapping views of a box",
       {"faulty::scale"},
       [](Scene& of) {
         scale(2.0F, of.box.domain({0, 0, 1}, {2, 2, 4}), of.box.domain({0, 1, 2}, {2, 3, 5}));
       }},
      {"call with two outputs",
       {"faulty::two"},
       [](Scene& of) { two(of.x, of.wide[0], of.s); },
       false,
       false,
       true},
      {"call of several passes",
       {"faulty::many"},
       [](Scene& of) { many(of.x, of.wide[0], of.wide[1], of.wide[2], of.wide[3], of.wide[4], of.wide[5]); },
       false,
       false,
       true},
      {"call with a choice",
       {"faulty::scale"},
       [](Scene& of) { scale.with({.precision = sk::Precision::Extended})(2.0F, of.x, of.r); },
       false,
       false,
       true},
      {"reduce to a value",
       {"faulty::sum"},
       [](Scene& of) { expect(sum(of.x) == sumOfNumbers(of.x.size()), "sum"); }},
      {"reduce in a tree",
       {"faulty::sum"},
       [](Scene& of) {
         const float found = sum.with({.accumulate = sk::Accumulate::Tree})(of.x);
         expect(found == sumOfNumbers(of.x.size()), "sum in a tree");
       }},
      {"reduce integers",
       {"faulty::count"},
       [](Scene& of) { expect(count(of.indices) == static_cast<int>(sumOfNumbers(of.x.size())), "count"); }},
      {"reduce to a stream", {"faulty::sum"}, [](Scene& of) { sum(of.x, of.part); }, false, false, true},
      {"reduce to two streams of halves",
       {"faulty::extremes"},
       [](Scene& of) { extremes(of.x, of.halves[0], of.halves[1]); },
       false,
       false,
       true},
      {"reduce exactly to a stream",
       {"faulty::sum"},
       [](Scene& of) { sum.with({.accumulate = sk::Accumulate::Exact})(of.x, of.part); },
       false,
       false,
       true},
      {"scan", {"faulty::running"}, [](Scene& of) { running(of.x, of.r); }, false, true},
      {"scan in place",
       {"faulty::running"},
       [](Scene& of) { running.with({.along = 0})(of.r, of.r); },
       false,
       true},
      {"call on strided views",
       {"faulty::scale"},
       [](Scene& of) { scale(2.0F, sk::stride(of.x, {2, 1}), sk::stride(of.r, {2, 1})); }},
      {"call with a folded output",
       {"a new stream", "faulty::squares", "read", "a scalar"},
       [](Scene& of) {
         auto total = of.device.scalar<float>();
         squares(1.0F, of.x, of.r, total);
         expect(total.read() > sumOfNumbers(of.x.size()), "folded output");
       },
       false,
       false,
       true},
      {"reduce rows",
       {"a new stream", "write", "rows", "faulty::sum"},
       [](Scene& of) {
         auto starts = of.device.stream<std::int32_t>({of.size + 1});
         starts.write(of.rowStarts);
         const sk::Rows rows(starts);
         sum(rows(of.x.reshape({of.size * 8})), of.part.reshape({of.size}));
       },
       false,
       false,
       true},
      {"sort", {"sk::sort"}, [](Scene& of) { sk::sort(of.x, of.r); }, false, true},
      {"order",
       {"sk::order", "read"},
       [](Scene& of) { expect(sk::order(of.x).read().size() == of.fives.size(), "order"); }},
      {"unique", {"sk::unique"}, [](Scene& of) { sk::unique(of.x, of.r); }, false, true},
      {"partition", {"sk::partition"}, [](Scene& of) { sk::partition(of.indices, of.r); }, false, true},
      {"loop",
       {"a new stream", "fill", "a scalar", "record", "faulty::scale", "faulty::sum", "repeat", "until"},
       [](Scene& of) {
         auto total = of.device.scalar<float>(0);
         auto done = of.device.scalar<bool>(false);
         sk::Loop loop = of.device.record([&] {
           scale(1.0F, of.x, of.x);
           sum(of.x, total);
           done = total < -1;
         });
         loop.repeat(4);
         loop.until(done, {.every = 1, .most = 3});
       },
       false,
       true},
      {"push", {"faulty::positive"}, [](Scene& of) { positive(of.x, of.pushed); }, false, false, true},
      {"push any number", {"faulty::repeat"}, [](Scene& of) { repeat(of.x, of.pushed, of.s); }},
      {"scatter", {"faulty::histogram"}, [](Scene& of) { histogram(of.indices, of.bins); }},
      {"scatter and push",
       {"faulty::everything"},
       [](Scene& of) { everything(of.indices, of.r, of.bins, of.pushed, of.r, of.s); }},
      {"texture", {"texture"}, [](Scene& of) { expect(of.x.texture().name != 0, "texture"); }, true, true},
  };
  return all;
}

}  // namespace faults
