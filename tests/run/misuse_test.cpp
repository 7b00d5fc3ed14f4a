// SPDX-License-Identifier: MIT
//
// Wrong calls of compiled kernels: each sk::Error names the kernel with its namespace, the parameters as declared and the
// shapes, and the streams keep their elements.
#include <type_traits>

#include "error_of.hpp"
#include "misuse.sk.hpp"
#include "support/devices.hpp"
#include "support/values.hpp"

using namespace run_tests;
using Catch::Matchers::Contains;

namespace {

// The C++ compiler rejects wrong types (for const outputs: misuse_types/calls.cpp).
using Floats = sk::Stream<float>&;
template <class Kernel, class... Arguments>
constexpr bool isCallable = std::is_invocable_v<const Kernel&, Arguments...>;
static_assert(isCallable<misuse::DiffuseKernel, int, const sk::Stream<float>&, Floats>);
static_assert(isCallable<misuse::DiffuseKernel, float, sk::View<const float>, sk::View<float>>);
static_assert(!isCallable<misuse::DiffuseKernel, float, sk::Stream<int>&, Floats>);
static_assert(!isCallable<misuse::DiffuseKernel, float, Floats, sk::View<sk::float2>>);
static_assert(!isCallable<misuse::DiffuseKernel, float, Floats>);
static_assert(!isCallable<misuse::DiffuseKernel, float, Floats, Floats, Floats>);
static_assert(!isCallable<misuse::DiffuseKernel, sk::float2, Floats, Floats>);
static_assert(!isCallable<misuse::SplitKernel, Floats, Floats, Floats>);
static_assert(isCallable<misuse::SumReduce, Floats> && isCallable<misuse::SumReduce, Floats, Floats>);
static_assert(!isCallable<misuse::SumReduce, sk::Stream<misuse::Hit>&>);
static_assert(!isCallable<misuse::SumReduce, Floats, sk::Stream<int>&>);

}  // namespace

TEST_CASE("inputs of another shape") {
  onSomeLayouts([](sk::Device& device) {
    auto v = device.stream<float>({6, 8});
    v.write(std::vector<float>(48, 5.0f));
    const std::string text = "misuse::diffuse: 'u' has shape ";
    const std::string advice =
        ", but the output 'v' has {6, 8}; give them the same shape, or extent 1 where 'u' repeats";
    for (const sk::Shape& shape : {sk::Shape{8, 6}, sk::Shape{6}, sk::Shape{6, 7}, sk::Shape{2, 8},
                                   sk::Shape{6, 8, 1}, sk::Shape{0, 8}}) {
      auto u = device.stream<float>(shape);
      CHECK(errorOf([&] { misuse::diffuse(1, u, v); }) == text + sk::toString(shape) + advice);
    }
    auto larger = device.stream<float>({6, 9});
    CHECK_THAT(errorOf([&] { misuse::diffuse(1, larger.domain({1, 0}, {6, 8}), v); }),
               Contains("'u' has shape {5, 8}"));
    CHECK(v.read() == std::vector<float>(48, 5.0f));
  });
}

TEST_CASE("gathers of another rank, or of nothing") {
  onEveryTarget([](sk::Device& device) {
    auto table = device.stream<float>({4, 4}), weights = device.stream<float>({9});
    auto x = device.stream<float>({5}), r = device.stream<float>({5});
    CHECK(errorOf([&] { misuse::lookup(weights, weights, x, r); }) ==
          "misuse::lookup: 'table' is declared with 2 dimension(s), but its stream has shape {9}");
    CHECK(errorOf([&] { misuse::lookup(table, table, x, r); }) ==
          "misuse::lookup: 'weights' is declared with 1 dimension(s), but its stream has shape {4, 4}");
    auto none = device.stream<float>({0});
    CHECK(errorOf([&] { misuse::lookup(table, none, x, r); }) ==
          "misuse::lookup: 'weights' has shape {0}: there is no element to read");
    auto empty = device.stream<float>({0, 4});
    CHECK_THAT(errorOf([&] { misuse::lookup(empty, weights, x, r); }), Contains("'table' has shape {0, 4}"));
    CHECK(errorOf([&] { misuse::lookup(empty, none, none, none); }) ==
          "no error");  // there is nothing to compute
  });
}

TEST_CASE("outputs that do not fit each other, or the device") {
  onSomeLayouts([](sk::Device& device) {
    auto x = device.stream<float>({4, 6}), low = device.stream<float>({4, 6});
    auto high = device.stream<misuse::Hit>({6, 4});
    CHECK(errorOf([&] { misuse::split(x, low, high); }) ==
          "misuse::split: the outputs 'low' and 'high' have shapes {4, 6} and {6, 4}; give them the same "
          "shape");
    auto a = device.stream<misuse::Five>({4, 6});
    const std::string text = errorOf([&] { misuse::many(x, a, a); });
    CHECK_THAT(text, Contains("misuse::many: the outputs 'a' and 'b' overlap"));
    CHECK_THAT(errorOf([&] { misuse::many(x, a.domain({0, 0}, {4, 6}), a.domain({0, 0}, {4, 6})); }),
               Contains("overlap"));
  });
}

TEST_CASE("streams of two devices, and streams that are gone") {
  auto& glsl = device("glsl330");
  auto& essl = device("essl300");
  auto u = glsl.stream<float>({3}), v = essl.stream<float>({3});
  CHECK(errorOf([&] { misuse::diffuse(1, u, v); }) ==
        "misuse::diffuse: 'v' and 'u' are streams of two devices, two sk::Device of '" + glsl.name() +
            "'; create both by one of them, or copy one stream through host memory");
  CHECK_THAT(errorOf([&] { misuse::sum(u, v); }),
             Contains("misuse::sum: 'x' and 'total' are streams of two devices"));
  const auto moved = std::move(u);
  CHECK(errorOf([&] { misuse::diffuse(1, u, v); }) ==
        "misuse::diffuse: 'u' holds no stream: it was default-constructed or moved from; make one by "
        "device.stream<T>(shape)");
  CHECK_THAT(errorOf([&] { (void)misuse::sum(u); }), Contains("misuse::sum: 'x' holds no stream"));
  for (const char* name : {"gl", "native"}) {
    auto orphan = [&] {
      sk::Device gone(name);
      return gone.stream<float>({3});
    }();
    CHECK_THAT(errorOf([&] { misuse::diffuse(1, orphan, v); }),
               Contains("misuse::diffuse: 'u' is a stream whose device has been destroyed"));
    CHECK_THAT(errorOf([&] { (void)misuse::sum(orphan); }),
               Contains("misuse::sum: 'x' is a stream whose device"));
  }
}

TEST_CASE("reduces that do not fit") {
  onSomeLayouts([](sk::Device& device) {
    auto x = device.stream<float>({6, 8});
    const std::string text = "misuse::sum: 'x' has shape {6, 8}, and the output 'total' has ";
    const std::string advice =
        "; give the output as many dimensions, or fewer, each extent a divisor of the input's";
    for (const sk::Shape& shape :
         {sk::Shape{4, 8}, sk::Shape{5}, sk::Shape{12, 8}, sk::Shape{0, 8}, sk::Shape{6, 8, 1}}) {
      auto total = device.stream<float>(shape);
      CHECK(errorOf([&] { misuse::sum(x, total); }) == text + sk::toString(shape) + advice);
    }
    CHECK(errorOf([&] { (void)misuse::nearest(device.stream<misuse::Hit>({0, 3})); }) ==
          "misuse::nearest: 'h' has shape {0, 3}: there is no element to fold, and 'best' declares no "
          "identity");
    auto square = device.stream<float>({4, 4}), line = device.stream<float>({4});
    CHECK(errorOf([&] { misuse::sum(square, line); }) ==
          "misuse::sum: 'x' has shape {4, 4}, and the output 'total' has {4}, which could mean {4, 1} or {1, "
          "4}; "
          "write the one that you mean");
    auto a = device.stream<misuse::Ten>({4}), r = device.stream<misuse::Ten>({2});
    CHECK(errorOf([&] { misuse::widest(a, r); }) ==
          "no error");  // split into several passes if it writes too many planes
    const int units = device.limits().textureUnits;
    if (units < 40) {
      CHECK(
          errorOf([&] { (void)misuse::widestOfFour(a, a, a, a); }) ==
          "misuse::widestOfFour: the inputs and gathers have 40 planes (one a scalar, vector, or member of a "
          "struct), but this device reads " +
              std::to_string(units) + " in one pass; put scalars together in vectors, or divide the reduce");
      CHECK_THAT(errorOf([&] { misuse::four(device.stream<float>({4})); }),
                 Contains("misuse::four: to combine partial results, 40 planes are read"));
    }
    auto low = device.stream<float>({2, 1}), high = device.stream<float>({2, 2});
    CHECK(errorOf([&] { misuse::range(square, low, high); }) ==
          "misuse::range: the outputs 'low' and 'high' have shapes {2, 1} and {2, 2}; give them the same "
          "shape");
    CHECK_THAT(errorOf([&] { misuse::range(square, high, high); }),
               Contains("misuse::range: the outputs 'low' and 'high' overlap"));
    CHECK_THAT(errorOf([&] { misuse::range(square, high, device.stream<float>({2, 2})); }),
               Contains("no error"));
  });
}

TEST_CASE("transfers of another size, and boxes outside") {
  onSomeLayouts([](sk::Device& device) {
    auto hits = device.stream<misuse::Hit>({3, 4});
    CHECK(errorOf([&] { hits.write(std::vector<misuse::Hit>(11)); }) ==
          "write: 11 element(s) in host memory, but shape {3, 4} has 12; give exactly as many");
    std::vector<misuse::Hit> memory(13);
    CHECK_THAT(errorOf([&] { hits.read(memory); }), Contains("13 element(s)") && Contains("{3, 4}"));
    CHECK_THAT(errorOf([&] { hits.domain({0, 0}, {3, 5}); }),
               Contains("{3, 5} (exclusive) is no box inside shape {3, 4}"));
    CHECK_THAT(errorOf([&] { hits.domain({1}, {2}); }), Contains("is no box inside shape {3, 4}"));
  });
}
