// SPDX-License-Identifier: MIT
//
// Parses the name of a device.
#include "gl/wanted_device.hpp"

#include <charconv>

#include <fmt/format.h>

#include "sk/error.hpp"

namespace sk::gl {

namespace {

int parseNumber(const std::string& text) {
  constexpr std::size_t prefix = 4;  // "gpu:"
  int number = -1;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data() + prefix, end, number);
  if (error != std::errc{} || rest != end || number < 0) {
    throw Error(fmt::format("'{}' names no device; after 'gpu:' comes a number, from 0", text),
                Error::Kind::Device);
  }
  return number;
}

}  // namespace

WantedDevice WantedDevice::parse(const std::string& text) {
  const std::string name = lowerCase(text);
  if (name.empty() || name == "gl") {
    return {};
  }
  if (name == "gpu") {
    return {Kind::Gpu, 0, {}};
  }
  if (name == "software") {
    return {Kind::Software, 0, {}};
  }
  if (name.starts_with("gpu:")) {
    return {Kind::NumberedGpu, parseNumber(name), {}};
  }
  return {Kind::Renderer, 0, name};
}

std::string WantedDevice::whyNot(const Capabilities& capabilities) const {
  switch (kind) {
    case Kind::Best: return "";
    case Kind::Gpu:
    case Kind::NumberedGpu:
      return capabilities.isSoftware ? fmt::format("'{}' is not a GPU", capabilities.renderer) : "";
    case Kind::Software:
      return capabilities.isSoftware ? "" : fmt::format("'{}' is a GPU", capabilities.renderer);
    case Kind::Renderer:
      return lowerCase(capabilities.renderer).find(renderer) != std::string::npos
                 ? ""
                 : fmt::format("its renderer is '{}'", capabilities.renderer);
  }
  return "";
}

}  // namespace sk::gl
