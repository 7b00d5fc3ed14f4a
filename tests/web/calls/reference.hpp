// SPDX-License-Identifier: MIT
//
// Numbers that are equal in C++ and JavaScript, and lists of them as JSON.
#pragma once

#include <cstdint>
#include <cstdio>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include <sk/sk.hpp>

/// A number of 24 random bits.
inline std::uint32_t random24(std::size_t i, std::uint32_t seed) {
  std::uint32_t x = static_cast<std::uint32_t>(i) * 747796405u + seed * 2891336453u + 1u;
  x = (x >> ((x >> 28) + 4) ^ x) * 277803737u;
  return (x >> 22 ^ x) >> 8;
}
inline std::vector<float> floats(std::size_t n, std::uint32_t seed) {
  std::vector<float> all(n);
  for (std::size_t i = 0; i < n; ++i) all[i] = static_cast<float>(random24(i, seed)) / 8388608.0F - 1.0F;
  return all;
}
template <class T>
std::vector<T> randomIntegers(std::size_t n, std::uint32_t seed, std::uint32_t below) {
  std::vector<T> all(n);
  for (std::size_t i = 0; i < n; ++i) all[i] = static_cast<T>(random24(i, seed) % below);
  return all;
}

inline void number(double value) { std::printf("%.17g", value); }
template <class T>
void number(const sk::Vector2<T>& v) {
  std::printf("%.17g,%.17g", double(v.x), double(v.y));
}
template <class T>
void number(const sk::Vector3<T>& v) {
  std::printf("%.17g,%.17g,%.17g", double(v.x), double(v.y), double(v.z));
}
template <class T>
void number(const sk::Vector4<T>& v) {
  std::printf("%.17g,%.17g,%.17g,%.17g", double(v.x), double(v.y), double(v.z), double(v.w));
}

inline void beginCase(const std::string& name) {
  static bool isFirst = true;
  std::printf("%s\"%s\":[", std::exchange(isFirst, false) ? "" : ",\n", name.c_str());
}
template <class Values>
void print(const std::string& name, const Values& values) {
  beginCase(name);
  bool follows = false;
  for (const auto& value : values) {
    if (std::exchange(follows, true)) std::printf(",");
    number(value);
  }
  std::printf("]");
}
inline void print(const std::string& name, std::initializer_list<double> values) {
  print(name, std::vector<double>(values));
}

/// A device, and streams of given elements.
struct Streams {
  sk::Device device = sk::Device::native();

  template <class T>
  sk::Stream<T> filled(const sk::Shape& shape, const std::vector<T>& values) {
    auto stream = device.stream<T>(shape);
    stream.write(values);
    return stream;
  }
  sk::Stream<float> random(const sk::Shape& shape, std::uint32_t seed) {
    return filled(shape, floats(static_cast<std::size_t>(shape.size()), seed));
  }
};

/// Prints the cases of reductions.sk.
void printReductions();
/// The calls of layouts.mjs.
void callLayouts();
