// SPDX-License-Identifier: MIT
//
// Control flow. The text is both a .sk file and C++: tests compare the results of skc with those of the C++ compiler. It
// uses only scalars, and nothing that C++ leaves undefined.
// clang-format off: a macro is a list
#define CONTROL_FLOW_CASES(CASE)                                                                   \
  CASE(ifElseChain) CASE(ifWithInit) CASE(elseOfWhich) CASE(forSum) CASE(forEmptyParts)            \
  CASE(forTwoVariables) CASE(forTwoSteps) CASE(forBreak) CASE(forContinue) CASE(forStepWithEffect) \
  CASE(forLimitWithEffect) CASE(forContinueWithEffect) CASE(whileLoop) CASE(whilePostfix)          \
  CASE(whilePrefix) CASE(whileAssignment) CASE(whileAndEffect) CASE(whileContinue) CASE(whileTrue) \
  CASE(doWhile) CASE(doWhileEffect) CASE(doWhileContinue) CASE(doOnce) CASE(nestedLoops)           \
  CASE(nestedBreaks) CASE(nestedEffects) CASE(triangle) CASE(returnInLoop)                         \
  CASE(returnInNestedLoop) CASE(returnInSwitch) CASE(earlyReturns) CASE(returnInBothBranches)      \
  CASE(switchPlain) CASE(switchFallthrough) CASE(switchSharedLabels) CASE(switchNoDefault)         \
  CASE(switchDefaultFirst) CASE(switchDefaultInMiddle) CASE(switchDefaultFalls)                    \
  CASE(switchEmptyLast) CASE(switchOnlyDefault) CASE(switchNoCases) CASE(switchUnsigned)           \
  CASE(switchNegative) CASE(switchOnExpression) CASE(switchOnBool) CASE(switchDeclarations)        \
  CASE(switchInLoopBreak) CASE(switchInLoopContinue) CASE(loopInSwitch) CASE(switchInSwitch)       \
  CASE(switchBreakInIf) CASE(shadowing) CASE(scopes) CASE(collatz) CASE(greatestDivisor)           \
  CASE(isPrime) CASE(bubbleSort) CASE(arrayShifted) CASE(arrayAveraged)                 \
  CASE(unreachableTail) CASE(indexByBool) CASE(continueInNestedSwitches)                           \
  CASE(continueForFromNestedSwitches)
// clang-format on

#include "switches.hpp"

namespace control {

inline int ifElseChain(int x, int y) {
  if (x < 0)
    return -1;
  else if (x < y)
    return 1;
  else if (x == y)
    return 2;
  else
    return 3;
}

inline int ifWithInit(int x, int y) {
  if (int d = x - y; d > 2)
    return d;
  else if (int e = d * d; e < 9)
    return 100 + e;
  return -1;
}

inline int elseOfWhich(int x, int y) {
  int r = 0;
  if (x > 0) {
    if (y > 0)
      r = 1;
    else
      r = 2;
  }
  if (x > 3) {
    if (y > 3) r += 10;
  } else
    r += 20;
  return r;
}

inline int forSum(int x, int y) {
  int sum = 0;
  for (int i = x; i < y; ++i) sum += i;
  return sum;
}

inline int forEmptyParts(int x, int y) {
  int i = x;
  for (;;) {
    if (i >= y) break;
    ++i;
  }
  for (; i < 30;) i += 7;
  for (; i > 0; --i) {
  }
  return i;
}

inline int forTwoVariables(int x, int y) {
  int steps = 0;
  for (int low = x, high = y; low < high; low++, high--) steps += high - low;
  return steps;
}

inline int forTwoSteps(int x, int y) {
  int i, j, r = 0;
  for (i = 0, j = x; i < y; ++i, j += 2) r += j;
  return r + i + j;
}

inline int forBreak(int x, int y) {
  int i = 0;
  for (i = 0; i < 20; ++i) {
    if (i * i > x + y) break;
  }
  return i;
}

inline int forContinue(int x, int y) {
  int sum = 0;
  for (int i = 0; i < 12; i++) {
    if (i % 3 == 0) continue;
    if (i == x) continue;
    sum = sum * 2 + (i > y ? 1 : 0);
  }
  return sum;
}

inline int forStepWithEffect(int x, int y) {
  int sum = 0, other = y;
  for (int i = 0; i < 8; i += other++ > 3 ? 2 : 1) sum = sum * 3 + i + x;
  return sum + other;
}

inline int forLimitWithEffect(int x, int y) {
  int sum = 0, budget = 9;
  for (int i = x; i < y && budget-- > 0; ++i) sum += i * budget;
  return sum * 10 + budget;
}

inline int forContinueWithEffect(int x, int y) {
  int sum = 0, limit = 10;
  for (int i = 0; i < limit--; i++) {
    if ((i + x) % 2 == 0) continue;
    sum += limit + y;
  }
  return sum * 100 + limit;
}

inline int whileLoop(int x, int y) {
  int i = x;
  while (i < y) i += 3;
  return i;
}

inline int whilePostfix(int x, int y) {
  int i = x, sum = 0;
  while (i++ < y) sum += i;
  return sum * 50 + i;
}

inline int whilePrefix(int x, int y) {
  int i = x, sum = 0;
  while (++i < y) sum += i;
  return sum * 50 + i;
}

inline int whileAssignment(int x, int y) {
  int n = x * x + 1, last = 0, turns = 0;
  while ((last = n % 5) != 0 && turns < 20) {
    n = n / 2 + last;
    turns++;
  }
  return n * 100 + last * 10 + turns + y;
}

inline int next(int& i) { return ++i; }

inline int whileAndEffect(int x, int y) {
  int i = 0, j = 0;
  while (next(i) < 10 && next(j) < y) {
    if (i == x) break;
  }
  return i * 100 + j;
}

inline int whileContinue(int x, int y) {
  int i = 0, sum = 0;
  while (i++ < 10) {
    if (i == x || i == y) continue;
    sum += i;
  }
  return sum;
}

inline int whileTrue(int x, int y) {
  int i = x;
  while (true) {
    if (i > y) return i;
    if (i == 3) break;
    ++i;
  }
  return -i;
}

inline int doWhile(int x, int y) {
  int i = x, turns = 0;
  do {
    i += 2;
    ++turns;
  } while (i < y);
  return i * 100 + turns;
}

inline int doWhileEffect(int x, int y) {
  int i = x, turns = 0;
  do {
    ++turns;
  } while (i++ < y && turns < 15);
  return i * 100 + turns;
}

inline int doWhileContinue(int x, int y) {
  int i = 0, sum = 0;
  do {
    if (i == x) continue;  // goes to the condition, whose side effect still happens
    sum += i + y;
  } while (++i < 7);
  return sum * 10 + i;
}

inline int doOnce(int x, int y) {
  int r = 0;
  do {
    if (x < 0) break;
    r = 1;
    if (y < 0) break;
    r = 2;
  } while (false);
  return r;
}

inline int nestedLoops(int x, int y) {
  int r = 0;
  for (int i = 0; i < x; ++i) {
    for (int j = i; j < y; ++j) r += i * 3 - j;
    int k = 0;
    while (k < i) {
      r ^= k;
      ++k;
    }
  }
  return r;
}

inline int nestedBreaks(int x, int y) {
  int r = 0;
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) {
      if (j > x) break;
      if (i + j == y) continue;
      r += 10 * i + j;
    }
    if (r > 200) break;
  }
  return r;
}

inline int nestedEffects(int x, int y) {
  int r = 0, i = 0;
  while (i++ < 4) {
    int j = x;
    do {
      for (int k = 0; k++ < 3;) {
        if (k == 2) continue;
        r += i * 100 + j * 10 + k;
      }
    } while (j++ < y - 10);
  }
  return r;
}

inline int triangle(int x, int y) {
  int count = 0;
  for (int a = 1; a <= 12; ++a)
    for (int b = a; b <= 12; ++b)
      for (int c = b; c <= 12; ++c)
        if (a * a + b * b == c * c) count += c + x - y;
  return count;
}

inline int returnInLoop(int x, int y) {
  for (int i = 0; i < 10; ++i) {
    if (i * i >= x) return i * 10 + y;
  }
  return -y;
}

inline int returnInNestedLoop(int x, int y) {
  int seen = 0;
  for (int i = 1; i < 8; ++i) {
    int j = 0;
    while (j < i) {
      ++seen;
      if (i * j == x + y) return 1000 + seen;
      ++j;
    }
  }
  return seen;
}

inline int returnInSwitch(int x, int y) {
  switch (x) {
    case 0: return y;
    case 1:
      if (y > 3) return 77;
      break;
    case 2: return -y;
    default: return 5;
  }
  return 6;
}

inline int earlyReturns(int x, int y) {
  int r = 1;
  if (x < 0) return r;
  r += x;
  if (y < 0) {
    r *= 2;
    if (x > 5) return r;
    r += 1000;
  }
  while (r < 50) {
    r += 7;
    if (r % 5 == 0) return -r;
  }
  return r;
}

inline int returnInBothBranches(int x, int y) {
  if (x > y) {
    if (x > 10)
      return 1;
    else
      return 2;
  } else {
    for (int i = 0;; ++i) {
      if (i > 4) return 3 + i;
    }
  }
}

inline int shadowing(int x, int y) {
  int r = x;
  {
    int x = y;
    r += 10 * x;
    for (int y = 0; y < 2; ++y) {
      int r = y;
      x += r;
    }
    r += x;
  }
  for (int x = 0; x < 3; ++x) r += x;
  if (int y = r; y > 5) r += y;
  return r + x + y;
}

inline int scopes(int x, int y) {
  int r = 0;
  {
    int a = x;
    r += a;
  }
  {
    int a = y;
    r += 10 * a;
  }
  for (int a = 0; a < 2; ++a) r += a;
  for (int a = 5; a > 2; --a) r -= a;
  if (x > 0) {
    int a = 3;
    r += a;
  } else {
    int a = 4;
    r -= a;
  }
  return r;
}

inline int collatz(int x, int y) {
  int n = x * x + y * y + 1, steps = 0;
  while (n != 1 && steps < 200) {
    n = n % 2 == 0 ? n / 2 : 3 * n + 1;
    ++steps;
  }
  return steps;
}

inline int greatestDivisor(int x, int y) {
  int a = x < 0 ? -x : x, b = y < 0 ? -y : y;
  while (b != 0) {
    int t = a % b;
    a = b;
    b = t;
  }
  return a;
}

inline int isPrime(int x, int y) {
  int n = x * 7 + y * y;
  if (n < 2) return 0;
  for (int d = 2; d * d <= n; ++d)
    if (n % d == 0) return 0;
  return n;
}

inline int indexByBool(int x, int y) {
  int a[2] = {x, y};
  a[x > 3] += 100;
  return a[x < y] * 3 + a[true];
}

// The loop is too long to be unrolled, so that the device's program has an array, too.
inline int arrayShifted(int x, int y) {
  int a[40];
  const int n = x < 0 ? 3 : x + 3;
  for (int i = 0; i <= n; ++i) a[i] = x * i + y;
  for (int i = 0; i < n; ++i) a[i] = a[i + 1];
  for (int i = n; i > 1; --i) a[i] = a[i - 1] + i;
  int r = 0;
  for (int i = 0; i <= n; ++i) r = (r & 0xffff) * 3 + a[i];
  return r;
}

inline int arrayAveraged(int x, int y) {
  int a[40];
  const int n = x < 0 ? 3 : x + 3;
  for (int i = 0; i <= n; ++i) a[i] = i * i + y;
  for (int last = n; last > 0; --last) {
    for (int i = 0; i < last; ++i) a[i] = (2 * a[i] + a[i + 1]) & 0xffff;
  }
  return a[0] + 5 * a[1];
}

inline int bubbleSort(int x, int y) {
  int a[6] = {x, y, x - y, 3, y * 2, -x};
  bool swapped;
  do {
    swapped = false;
    for (int i = 0; i + 1 < 6; ++i) {
      if (a[i] <= a[i + 1]) continue;
      int t = a[i];
      a[i] = a[i + 1];
      a[i + 1] = t;
      swapped = true;
    }
  } while (swapped);
  int r = 0;
  for (int i = 0; i < 6; ++i) r = r * 3 + a[i];
  return r;
}

inline int unreachableTail(int x, int y) {
  for (;;) {
    if (x > y) return 1;
    return 2;
  }
}

}  // namespace control
