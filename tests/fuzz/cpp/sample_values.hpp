// SPDX-License-Identifier: MIT
//
// The values that the harness gives to parameters of kernels other than the common ones (samples.hpp). They follow from the path of
// the parameter, such as world.terrain.height, so that C++, devices and browsers get the same without a word between them, and two
// members have different ones. No part of this may need the standard library: the oracle's programs include it.
#pragma once

namespace fuzz::cpp {

constexpr int highestRank = 4;

/// The domain of kernels of each rank, x first: at most sampleCount elements. The last work group or vector is never full.
constexpr int domainExtents[highestRank][highestRank] = {
    {37, 1, 1, 1}, {5, 7, 1, 1}, {3, 4, 3, 1}, {3, 2, 3, 2}};

constexpr int elementsOf(const int (&extents)[highestRank]) {
  return extents[0] * extents[1] * extents[2] * extents[3];
}

/// Random bits (the finaliser of MurmurHash3).
constexpr unsigned mixed(unsigned x) {
  x = (x ^ (x >> 16)) * 0x85ebca6bu;
  x = (x ^ (x >> 13)) * 0xc2b2ae35u;
  return x ^ (x >> 16);
}

/// A path, or the parts of one.
struct Path {
  unsigned hash = 2166136261u;
  constexpr Path() = default;
  constexpr Path(const char* text) { add(text); }
  constexpr Path& add(const char* text) {
    for (; *text != '\0'; ++text) add(*text);
    return *this;
  }
  constexpr Path& add(char c) {
    hash = (hash ^ static_cast<unsigned char>(c)) * 16777619u;
    return *this;
  }
};

/// The bits of a component of an element: of a uniform, of element 0.
constexpr unsigned sampleBits(Path path, int element, int component) {
  return mixed(path.hash + mixed(static_cast<unsigned>(element * highestRank + component)));
}

/// The extent of a gather in a dimension, 0 for x.
constexpr int gatherExtent(Path path, int rank, int dimension) {
  if (dimension >= rank) return 1;
  const unsigned most[highestRank] = {40, 8, 5, 3};
  return 1 + static_cast<int>(sampleBits(path, -1, dimension) % most[rank - 1]);
}
constexpr int mostElements = 128;

/// What bits mean as a number. Integers are small, or of all sizes; floats are multiples of 1/4 up to 16, and doubles of 1/4096.
constexpr int sampleInt(unsigned bits) {
  return bits % 4 == 0 ? static_cast<int>(mixed(bits)) : static_cast<int>(bits / 4 % 64) - 16;
}
constexpr unsigned sampleUint(unsigned bits) { return bits % 4 == 0 ? mixed(bits) : bits / 4 % 64; }
constexpr float sampleFloat(unsigned bits) {
  return static_cast<float>(static_cast<int>(bits % 129) - 64) * 0.25f;
}
constexpr double sampleDouble(unsigned bits) {
  return static_cast<double>(static_cast<int>(bits % 131073) - 65536) / 4096;
}
constexpr bool sampleBool(unsigned bits) { return bits % 2 != 0; }

}  // namespace fuzz::cpp
