// SPDX-License-Identifier: MIT
//
// Extreme floats: infinity, NaN, signed zeros, large and small numbers. The text is both a .sk file and C++ (see
// control_flow.hpp).
#define FLOAT_TO_INT_CASES(CASE) \
  CASE(comparisons)              \
  CASE(negatedComparisons)       \
  CASE(conditions) CASE(selfComparison) CASE(branches) CASE(logic) CASE(orderOfMinimum) CASE(loopsEnd)
#define FLOAT_CASES(CASE) \
  CASE(sums)              \
  CASE(differences)       \
  CASE(products) CASE(quotients) CASE(negation) CASE(absolute) CASE(zeros) CASE(constants) CASE(chosen)

namespace floats {

inline int comparisons(float x, float y) {
  return (x < y) + 2 * (x <= y) + 4 * (x > y) + 8 * (x >= y) + 16 * (x == y) + 32 * (x != y);
}
inline int negatedComparisons(float x, float y) {
  return !(x < y) + 2 * !(x <= y) + 4 * !(x > y) + 8 * !(x >= y) + 16 * !(x == y) + 32 * !(x != y);
}
inline int conditions(float x, float y) { return (x ? 1 : 2) + (!y ? 4 : 8) + (x && y) * 16; }
inline int selfComparison(float x, float y) { return (x == x) + 2 * (y != y) + 4 * (x < x) + 8 * !(y >= y); }
inline int branches(float x, float y) {
  if (x < y)
    return 1;
  else if (x > y)
    return 2;
  else if (x == y)
    return 3;
  return 4;
}
inline int logic(float x, float y) {
  bool inside = x >= -1 && x <= 1, outside = x < -1 || x > 1;
  return inside + 2 * outside + 4 * !inside + 8 * !outside + 16 * (inside != (y < 0));
}
inline int orderOfMinimum(float x, float y) {
  if (x != x || y != y)
    return 0;  // Mesa compiles `x < y ? x : y` to minNum, which ignores NaN, as GLSL allows
  float least = x < y ? x : y, most = x < y ? y : x;
  return (least == x) + 2 * (most == x) + 4 * (least == y) + 8 * (most == y);
}
inline int loopsEnd(float x, float y) {
  int n = 0;
  while (x < y && n < 20) {
    x = x * 2 + 1;
    n++;
  }
  return n;
}

inline float sums(float x, float y) { return x + y; }
inline float differences(float x, float y) { return x - y; }
inline float products(float x, float y) { return x * y; }
inline float quotients(float x, float y) { return x / y; }
inline float negation(float x, float y) { return y < 0 ? -x : +x; }
inline float absolute(float x, float y) { return (x < 0 ? -x : x + 0.0f) * (y < 0 ? -1.0f : 1.0f); }
inline float zeros(float x, float y) { return 1 / x + 1 / -y; }
inline float constants(float x, float y) { return x > y ? 3.4028235e38f : 1.17549435e-38f; }
inline float chosen(float x, float y) { return x > 0 ? x : y > 0 ? y : -0.0f; }

}  // namespace floats
