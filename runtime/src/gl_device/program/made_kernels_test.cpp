// SPDX-License-Identifier: MIT
//
// Promises: of the kernels that a device writes for operations with scalars and for merging texels, it keeps the last ones, with
// their programs. One that a loop holds stays.
#include "gl_device/program/made_kernels.hpp"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include <catch2/catch.hpp>

#include "device/scalar_pass.hpp"
#include "gl_device/gl_device.hpp"
#include "gl_device/gl_stream.hpp"
#include "sk/types.hpp"

using namespace sk;

namespace {

const program::Element& elementOfFloats() { return ElementTraits<float>::element(); }

class Scalars {
 public:
  Scalars() {
    device.programs().scalarKernels().setMost(most);
    const float one = 1;
    x_->write(wholeOf(*x_), reinterpret_cast<const std::byte*>(&one));
  }

  static constexpr std::size_t most = 4;

  /// The pass that adds 1 `times` times: for each number, another kernel.
  std::unique_ptr<RecordedCall> adding(std::uint32_t times) {
    ScalarPass pass;
    pass.reads.push_back(wholeOf(*x_));
    ScalarRef sum{ScalarRef::Kind::Read, 0};
    for (std::uint32_t i = 0; i < times; ++i) {
      pass.steps.push_back(
          {detail::ScalarOp::Add, program::Scalar::Float, &elementOfFloats(), {sum, ScalarRef{}, {}}});
      sum = {ScalarRef::Kind::Step, i};
    }
    pass.outputs.push_back({r_.get(), times - 1});
    return device.prepareScalars(std::move(pass));
  }

  float result() {
    float value = 0;
    r_->read(wholeOf(*r_), reinterpret_cast<std::byte*>(&value));
    return value;
  }

  int programs() {
    const DeviceScope scope(device);  // deletes what is queued
    int count = 0;
    for (GLuint name = 1; name < 500; ++name) count += glIsProgram(name) == GL_TRUE ? 1 : 0;
    return count;
  }

  GlDevice device{gl::openContext({"software", gl::Api::Gl}), {}};

 private:
  static StreamRegion wholeOf(StreamState& stream) { return detail::wholeRegion(&stream); }

  const std::unique_ptr<StreamState> x_ = device.createStream(elementOfFloats(), {1}, Storage::Single);
  const std::unique_ptr<StreamState> r_ = device.createStream(elementOfFloats(), {1}, Storage::Single);
};

}  // namespace

TEST_CASE("of kernels for scalars, those that were not used for longest are deleted with their programs") {
  Scalars scalars;
  int programs = 0;
  for (std::uint32_t times = 1; times <= 12; ++times) {
    scalars.adding(times)->run();
    CHECK(scalars.result() == static_cast<float>(times + 1));
    scalars.adding(1)->run();  // never the least recently used
    CHECK(scalars.result() == 2);
    if (times == Scalars::most) programs = scalars.programs();
  }
  CHECK(scalars.device.programs().scalarKernels().size() == Scalars::most);
  CHECK(scalars.programs() == programs);
  scalars.adding(3)->run();  // anew
  CHECK(scalars.result() == 4);
}

TEST_CASE("a kernel for scalars stays while a loop holds it") {
  Scalars scalars;
  std::vector<std::unique_ptr<RecordedCall>> held;
  for (std::uint32_t times = 1; times <= 6; ++times) held.push_back(scalars.adding(times));
  for (std::uint32_t times = 7; times <= 12; ++times) scalars.adding(times)->run();
  for (std::size_t i = 0; i < held.size(); ++i) {
    held[i]->run();
    CHECK(scalars.result() == static_cast<float>(i + 2));
  }
  held.clear();
  scalars.adding(20)->run();
  CHECK(scalars.result() == 21);
  CHECK(scalars.device.programs().scalarKernels().size() == Scalars::most);
}

TEST_CASE("of kernels that merge texels, those that were not used for longest are deleted") {
  GlDevice device(gl::openContext({"software", gl::Api::Gl}), {});
  device.programs().mergeKernels().setMost(3);
  constexpr std::int64_t width = 64;
  const auto from = device.createStream(elementOfFloats(), {2, 8}, Storage::Single);
  const auto to = device.createStream(elementOfFloats(), {8, width}, Storage::Single);
  const auto writeAll = [](StreamState& stream, const std::vector<float>& values) {
    stream.write(detail::wholeRegion(&stream), reinterpret_cast<const std::byte*>(values.data()));
  };
  std::vector<float> expected(8 * width, 0);
  writeAll(*to, expected);
  std::size_t most = 0;
  for (std::int64_t i = 0; i < 16;
       ++i) {  // the texels' bits differ with the first column, and with the distance of the rows
    const std::int64_t first = i % 4, distance = (i / 4 + 2) * width;
    writeAll(*from, std::vector<float>(16, static_cast<float>(i)));
    CHECK(to->copyFrom(detail::wholeRegion(from.get()),
                       {.stream = to.get(), .shape = {2, 8}, .stride = {distance, 1}, .first = first}));
    for (std::int64_t k = 0; k < 16; ++k) {
      expected[static_cast<std::size_t>(first + k / 8 * distance + k % 8)] = static_cast<float>(i);
    }
    most = std::max(most, device.programs().mergeKernels().size());
  }
  std::vector<float> all(expected.size());
  to->read(detail::wholeRegion(to.get()), reinterpret_cast<std::byte*>(all.data()));
  CHECK(all == expected);
  CHECK(most == 3);
}
