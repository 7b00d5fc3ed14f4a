// SPDX-License-Identifier: MIT
#include "gl/open_context.hpp"

#include <catch2/catch.hpp>

#include "gl/format.hpp"

using sk::gl::Capabilities;
using sk::gl::WantedDevice;

namespace {

Capabilities renderer(const char* name, bool isSoftware) {
  Capabilities capabilities;
  capabilities.renderer = name;
  capabilities.isSoftware = isSoftware;
  return capabilities;
}

}  // namespace

TEST_CASE("what a device's name asks for") {
  const Capabilities gpu = renderer("NVIDIA H200/PCIe/SSE2", false);
  const Capabilities software = renderer("llvmpipe (LLVM 15.0.6, 256 bits)", true);
  CHECK(WantedDevice::parse("").whyNot(gpu).empty());
  CHECK(WantedDevice::parse("").whyNot(software).empty());
  CHECK(WantedDevice::parse("gl").kind == WantedDevice::Kind::Best);
  CHECK(WantedDevice::parse("GPU").whyNot(gpu).empty());
  CHECK(WantedDevice::parse("gpu:12").number == 12);
  CHECK(WantedDevice::parse("gpu").whyNot(software) == "'llvmpipe (LLVM 15.0.6, 256 bits)' is not a GPU");
  CHECK(WantedDevice::parse("software").whyNot(gpu) == "'NVIDIA H200/PCIe/SSE2' is a GPU");
  CHECK(WantedDevice::parse("Nvidia").whyNot(gpu).empty());
  CHECK(WantedDevice::parse("nvidia").whyNot(software) ==
        "its renderer is 'llvmpipe (LLVM 15.0.6, 256 bits)'");
  for (const char* name : {"gpu:", "gpu:-1", "gpu:1x", "gpu:99999999999"}) {
    CHECK_THROWS_WITH(WantedDevice::parse(name), Catch::Contains("after 'gpu:' comes a number"));
  }
}

TEST_CASE("extensions are whole words of a list") {
  CHECK(sk::gl::hasExtension("EGL_A EGL_B EGL_C", "EGL_B"));
  CHECK(sk::gl::hasExtension("EGL_A", "EGL_A"));
  CHECK_FALSE(sk::gl::hasExtension("EGL_AB", "EGL_A"));
  CHECK_FALSE(sk::gl::hasExtension("", "EGL_A"));
  CHECK_FALSE(sk::gl::hasExtension(nullptr, "EGL_A"));
}

TEST_CASE("each scalar type and width has its format") {
  using sk::program::Scalar;
  for (const Scalar scalar : {Scalar::Bool, Scalar::Int, Scalar::Uint, Scalar::Float}) {
    for (const int width : {1, 2, 3, 4}) {
      const sk::gl::Format& format = sk::gl::formatOf(scalar, width);
      CHECK(format.tight.channels == (width == 3 ? 4 : width));
      CHECK(format.tight.channelBytes == (scalar == Scalar::Bool ? 1 : 4));
      CHECK(&format == &sk::gl::formats()[format.index]);
    }
  }
}
