// SPDX-License-Identifier: MIT
//
// Expressions with side effects whose order C++ defines. The text is both a .sk file and C++ (see control_flow.hpp).
// clang-format off: a macro is a list
#define EFFECTS_CASES(CASE)                                                                        \
  CASE(postfixAndPrefix) CASE(postfixInIndex) CASE(assignmentAsValue) CASE(assignmentChain)        \
  CASE(compoundAsValue) CASE(compoundOperators) CASE(compoundRightFirst) CASE(assignRightFirst)    \
  CASE(commaOperator) CASE(commaInFor) CASE(andSkipsRight) CASE(orSkipsRight) CASE(andOrMixed)     \
  CASE(andWithAssignment) CASE(conditionalEffects) CASE(conditionalNested) CASE(conditionalCalls)  \
  CASE(conditionalVoid) CASE(earlierOperandKept) CASE(earlierArgumentKept)                         \
  CASE(earlierElementKept) CASE(callsInOrder) CASE(callInCondition) CASE(callInReturn)             \
  CASE(callResultIndexed) CASE(referenceSwap) CASE(referenceElement) CASE(referenceMember)         \
  CASE(referenceAndResult) CASE(referenceThroughTwo) CASE(resultIntoArgument)                      \
  CASE(elementAndIndexByReference) CASE(indexEvaluatedOnce) CASE(compoundIndexOnce)                \
  CASE(incrementElement) CASE(parameterIsCopy) CASE(constReferenceReads) CASE(discardedValues)     \
  CASE(initialiserOrder) CASE(arrayOrder) CASE(logicalInArithmetic) CASE(negatedEffects)           \
  CASE(copyOutToOldElement) CASE(structRightFirst) CASE(laterArgumentMovesIndex)                   \
  CASE(operatorRightFirst) CASE(targetAsValue) CASE(methodAndElement) CASE(methodMovesIndex)   \
  CASE(harmlessAliases) CASE(elementsOfOneArray) CASE(referenceSeesLaterEffect)                    \
  CASE(choiceByReference) CASE(changedTemporary) CASE(disjointParts) CASE(firstUsedInArgument)     \
  CASE(operatorsOfOwnResults) CASE(membersReadMembers) CASE(referencesToOneObject)                 \
  CASE(referencesToElements) CASE(methodAndOwnMember) CASE(aliasesPassedOn)      \
  CASE(choicesAsTargets) CASE(choicesByReference) CASE(choicesWithEffects) CASE(choicesOfConstants) CASE(manyIndices)
// clang-format on

#ifdef __clang__
#pragma clang diagnostic ignored "-Wunsequenced"  // what C++ leaves open goes from left to right
#endif

namespace effects {

inline int bump(int& i) { return i++; }
inline int add(int& i, int by) { return i += by; }
inline bool isBelow(int& i, int limit) { return ++i < limit; }

inline int postfixAndPrefix(int x, int y) {
  int i = x, j = y;
  int a = i++;
  int b = ++j;
  int c = i-- - --j;
  i++;
  --j;
  return a + 10 * b + 100 * c + 1000 * i + 10000 * j;
}

inline int postfixInIndex(int x, int y) {
  int a[5] = {0, 0, 0, 0, 0};
  int i = 0;
  a[i++] = x;
  a[i++] = y;
  a[++i] = 7;
  int r = a[--i];
  return r + a[0] + 2 * a[1] + 3 * a[3] + 100 * i;
}

inline int assignmentAsValue(int x, int y) {
  int a = 0, b = 0;
  int r = (a = x) + 3;
  if ((b = y) > 2) r += b;
  return r * 100 + a - b;
}

inline int assignmentChain(int x, int y) {
  int a, b, c;
  a = b = c = x + y;
  a += b -= c *= 2;
  return a * 10000 + b * 100 + c;
}

inline int compoundAsValue(int x, int y) {
  int a = x;
  int r = (a += y) * 2;
  (a = y) += 5;
  ++(a += 1);
  return r + 100 * a;
}

inline int compoundOperators(int x, int y) {
  int a = x;
  a += y;
  a -= 3;
  a *= 5;
  a /= 2;
  a %= 7;
  a <<= 3;
  a |= 5;
  a &= 29;
  a ^= y;
  a >>= 1;
  return a;
}

inline int compoundRightFirst(int x, int y) {
  int a = x;
  a += (a = y) + 1;  // C++17: the right side first
  return a;
}

inline int assignRightFirst(int x, int y) {
  int a[3] = {1, 2, 3};
  int i = 0;
  a[i] = (i = 2) + x;  // into a[2]
  a[bump(i) - 2] = i + y;  // the right side sees i before the left side changes it
  return a[0] + 10 * a[1] + 100 * a[2] + 1000 * i;
}

inline int commaOperator(int x, int y) {
  int i = x;
  int r = (i++, i += y, i * 2);
  i = (bump(i), 3);
  return r * 10 + i;
}

inline int commaInFor(int x, int y) {
  int r = 0, j;
  for (int i = (j = x, 0); i++, i < 5; j += y, r += j) r += i;
  return r;
}

inline int andSkipsRight(int x, int y) {
  int i = 0;
  bool both = x > 0 && isBelow(i, y);
  return (both ? 1 : 0) + 10 * i;
}

inline int orSkipsRight(int x, int y) {
  int i = 0;
  bool either = x > 0 || isBelow(i, y);
  return (either ? 1 : 0) + 10 * i;
}

inline int andOrMixed(int x, int y) {
  int i = 0, j = 0;
  int r = (x > 0 && isBelow(i, 5)) || (y > 0 && isBelow(j, y)) ? 1 : 2;
  if (!(isBelow(i, x) && (isBelow(j, y) || isBelow(i, 3)))) r += 4;
  return r + 10 * i + 1000 * j;
}

inline int andWithAssignment(int x, int y) {
  int a = 0, b = 0;
  if ((a = x) > 1 && (b = y) > 1) return a * b;
  return a * 100 + b;
}

inline int conditionalEffects(int x, int y) {
  int i = 0, j = 0;
  int r = x > y ? i++ + 5 : j-- - 5;
  r += y > 0 ? x : add(j, 3);
  return r + 100 * i + 1000 * j;
}

inline int conditionalNested(int x, int y) {
  int i = 0;
  int r = x > 0 ? y > 0 ? bump(i) + 1 : 2 : x < -3 ? add(i, 5) : y < 0 ? 4 : 5;
  return r * 10 + i;
}

inline int conditionalCalls(int x, int y) {
  int a = x, b = y;
  int r = isBelow(a, y) ? add(a, 10) : add(b, 100);
  return r + a * 3 + b * 7;
}

inline int conditionalVoid(int x, int y) {
  int a = 0, b = 0;
  x > y ? (void)++a : (void)(b += 2);
  return a + 10 * b + x;
}

inline int earlierOperandKept(int x, int y) {
  int i = x;
  int r = i;
  bool less = i < y;
  int s = less ? (i = 50) : (i = 60);
  return r * 2 + s + i;
}

inline int three(int a, int b, int c) { return a + 10 * b + 100 * c; }

inline int earlierArgumentKept(int x, int y) {
  int i = x;
  int first = i, second = i += y, third = i *= 2;
  int braces[3] = {i, ++i, i++};  // braces evaluate from left to right
  return three(first, second, third) + 3 * braces[0] + 5 * braces[1] + 7 * braces[2] + i;
}

inline int earlierElementKept(int x, int y) {
  int a[2] = {x, y};
  int list[3] = {a[0], add(a[0], 4), a[0]};
  return list[0] + 10 * list[1] + 100 * list[2];
}

inline int callsInOrder(int x, int y) {
  int i = x;
  int list[4] = {bump(i), add(i, y), bump(i) * 2, i};
  return three(list[0], list[1], list[2]) + list[3];
}

inline int callInCondition(int x, int y) {
  int i = x, turns = 0;
  while (isBelow(i, y)) {
    if (isBelow(turns, 4)) continue;
    if (bump(turns) > 5) break;
  }
  return i * 100 + turns;
}

inline int tail(int& i) { return bump(i) + i * 10; }  // the left operand changes what the right one reads
inline int callInReturn(int x, int y) {
  int i = x;
  int r = add(i, y);
  return r + i;
}

inline int callResultIndexed(int x, int y) {
  int a[4] = {x, y, x + y, x - y};
  int i = 1;
  int r = a[bump(i)];
  r += a[add(i, 1)];
  return r * 10 + i;
}

inline void exchange(int& a, int& b) {
  int t = a;
  a = b;
  b = t;
}
inline int referenceSwap(int x, int y) {
  int a = x, b = y;
  exchange(a, b);
  if (a > b) exchange(a, b);
  return a * 100 + b;
}

inline int referenceElement(int x, int y) {
  int a[3] = {x, y, 1};
  for (int i = 0; i < 3; ++i) add(a[i], i * 5);
  int r = bump(a[1]);
  return r + a[0] + 10 * a[1] + 100 * a[2];
}

struct Pair {
  int first;
  int second;
};
inline int referenceMember(int x, int y) {
  Pair p = {x, y};
  add(p.first, 3);
  bump(p.second);
  int other = y + 1;
  exchange(p.first, other);
  p.second += other;
  return p.first * 100 + p.second;
}

inline int referenceAndResult(int x, int y) {
  int a = x;
  a = add(a, y) * 2;
  a += bump(a);  // the right side first: (a + 1) + a
  return a;
}

inline void addTwice(int& i, int by) {
  add(i, by);
  i += add(i, by);
}
inline int referenceThroughTwo(int x, int y) {
  int a = x;
  addTwice(a, y);
  return a;
}

inline int fill(int& a, int& b) {
  a = 5;
  b = 6;
  return 7;
}
inline int resultIntoArgument(int x, int y) {
  int a = x, b = y;
  a = fill(a, b);  // the result is assigned last
  return a * 100 + b;
}

inline void setBoth(int& element, int& index) {
  element = 40;
  index = 2;
}
inline int elementAndIndexByReference(int x, int y) {
  int a[3] = {x, y, 3};
  int i = 0;
  setBoth(a[i], i);  // a[0], though i changes
  return a[0] + 100 * a[1] + 10000 * a[2] + i;
}

inline int indexEvaluatedOnce(int x, int y) {
  int a[4] = {x, y, 3, 4};
  int i = 0;
  a[i++] += 10;
  a[i++]++;
  a[bump(i)] *= 2;
  return a[0] + 10 * a[1] + 100 * a[2] + 1000 * a[3] + 10000 * i;
}

inline int compoundIndexOnce(int x, int y) {
  int a[3] = {1, 2, 3};
  int i = 0;
  int r = (a[i++] += x) + y;
  r += a[i]-- * 10;
  return r + 100 * a[0] + 1000 * a[1] + i;
}

inline int incrementElement(int x, int y) {
  int a[2] = {x, y};
  ++a[0];
  a[1]--;
  int r = a[0]++ * 2;
  r += --a[1];
  return r + 10 * a[0] + 100 * a[1];
}

inline int change(int a) {
  a += 5;
  a *= 2;
  return a;
}
inline int parameterIsCopy(int x, int y) {
  int a = x;
  int r = change(a) + change(y);
  x += 1;
  y = r;
  return a + r + x - y;
}

inline int read(const int& a, const Pair& p) { return a + p.first * p.second; }
inline int constReferenceReads(int x, int y) {
  Pair p{x, y};
  return read(x, p) + read(x + y, Pair{2, y}) + read(3, p);
}

inline int discardedValues(int x, int y) {
  int i = x;
  (void)(i + y);
  bump(i);
  i == 3 ? bump(i) : add(i, 7);
  (void)(i += 2);
  return i;
}

inline int initialiserOrder(int x, int y) {
  int i = x;
  Pair p = {i++, i++};
  Pair q{add(i, y), i};
  return p.first + 3 * p.second + 7 * q.first + 11 * q.second;
}

inline int arrayOrder(int x, int y) {
  int i = x;
  int a[4] = {i, i += y, bump(i)};
  return a[0] + 3 * a[1] + 7 * a[2] + 11 * a[3];
}

inline int logicalInArithmetic(int x, int y) {
  int i = 0;
  int r = (x > 0 && isBelow(i, y)) + 2 * (y > 0 || isBelow(i, x)) + 4 * !x;
  return r * 10 + i;
}

inline int negatedEffects(int x, int y) {
  int i = x;
  int r = -i++ + y;
  r += ~bump(i);
  r = !isBelow(i, y) ? r : -r;
  return r * 10 + i;
}

}  // namespace effects

#include "lvalues.hpp"
