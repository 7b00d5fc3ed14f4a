// SPDX-License-Identifier: MIT
#include "native/convert_floats.hpp"

#include <cstring>

#include "native/float_vectors.hpp"
#include "sk/native/code.hpp"

namespace sk {

namespace {

template <class From, class To>
void convertEach(const From* from, std::int64_t count, To* to) {
  for (std::int64_t i = 0; i < count; ++i) to[i] = static_cast<To>(from[i]);
}

SK_FOR_V3 void widenVectors(const float* from, std::int64_t count, double* to) {
  std::int64_t i = 0;
  for (; i + doublesPerVector <= count; i += doublesPerVector) {
    Doubles wide;
    widen(from + i, wide);
    std::memcpy(to + i, &wide, sizeof wide);
  }
  convertEach(from + i, count - i, to + i);
}

SK_FOR_V3 void narrowVectors(const double* from, std::int64_t count, float* to) {
  std::int64_t i = 0;
  for (; i + doublesPerVector <= count; i += doublesPerVector) {
    Doubles wide;
    std::memcpy(&wide, from + i, sizeof wide);
    narrow(wide, to + i);
  }
  convertEach(from + i, count - i, to + i);
}

bool areVectorsWide() { return native::levelOfHardware() >= native::Level::V3; }

}  // namespace

void widenFloats(const float* from, std::int64_t count, double* to) {
  areVectorsWide() ? widenVectors(from, count, to) : convertEach(from, count, to);
}

void narrowDoubles(const double* from, std::int64_t count, float* to) {
  areVectorsWide() ? narrowVectors(from, count, to) : convertEach(from, count, to);
}

}  // namespace sk
