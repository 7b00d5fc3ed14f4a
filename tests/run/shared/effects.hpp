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
  CASE(referencesToElements) CASE(methodAndOwnMember) CASE(aliasesPassedOn)
// clang-format on

#ifdef __clang__
#pragma clang diagnostic ignored "-Wunsequenced"   // what C++ leaves open goes from left to right
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

// ---- lvalues that are written after something else has changed -----------------------------------

inline void next(int& i, int& element) {
  element = 5;
  i = i + 1;
}
inline int copyOutToOldElement(int x, int y) {
  int a[3] = {x, y, 1};
  int i = x & 1;
  next(i, a[i]);
  return a[0] + 10 * a[1] + 100 * a[2] + 1000 * i;
}

struct Numbered {
  int id;
  int values[2];
  int sum() const { return id + values[0] + 3 * values[1]; }
  void take(int& from) {
    id += from;
    from = 7;
  }
  void moveTo(int& element, int to) {
    id = to;
    element += 100;
  }
};
inline int structRightFirst(int x, int y) {
  Pair s[4] = {};
  int i = x & 1;
#ifdef __clang__
  s[i++] = Pair{i, x};
  s[++i] = Pair{i += 0, y};
#else   // g++ 12 does not follow C++17 here
  s[i] = Pair{i, x};
  i += 2;
  s[i] = Pair{i - 1, y};
#endif
  return s[0].first + 3 * s[1].first + 7 * s[2].first + 11 * s[3].first + 13 * s[i].second;
}

// In C++ the order of arguments is the compiler's choice; here it is from left to right, as Clang's.
inline int laterArgumentMovesIndex(int x, int y) {
  int a[4] = {x, y, 1, 2};
  int i = x & 1;
#ifdef __clang__
  int r = add(a[i], ++i) + add(a[i], bump(i));
#else
  const int first = i++;
  int r = add(a[first], i);
  const int second = i++;
  r += add(a[second], second);
#endif
  return r + 10 * a[0] + 100 * a[1] + 1000 * a[2] + a[3];
}

struct Sum {
  int a, b;
  Sum& operator+=(const Sum& o) {
    a += o.a;
    b += o.b;
    return *this;
  }
  Sum operator*(Sum o) const { return Sum{a * o.a - b * o.b, a * o.b + b * o.a}; }
  Sum operator+(Sum o) const { return Sum{a + o.a, b + o.b}; }
  void addAll(const Sum& o, const int& k) {
    a += o.a * k;
    b += o.b;
  }
};
inline int operatorRightFirst(int x, int y) {
  Sum s[4] = {{x, 1}, {y, 2}, {3, 4}, {5, 6}};
  int i = 0;
#ifdef __clang__
  s[i++] += s[++i];
#else
  const int right = ++i;
  s[i++] += s[right];
#endif
  return s[0].a + 3 * s[1].a + 7 * s[2].a + 11 * s[3].b + i;
}

inline int targetAsValue(int x, int y) {
  int a[3] = {x & 1, y & 1, 2};
  int r = (a[a[0]] = 2);
  r += 10 * (a[a[1] & 1] += 1);
  r += 100 * ++a[a[0] & 1];
  return r + 1000 * (a[0] + 3 * a[1] + 9 * a[2]);
}

inline int methodAndElement(int x, int y) {
  Numbered n[2] = {{x, {y, 2}}, {1, {3, 4}}};
  n[0].take(n[1].values[1]);
  n[1].take(n[0].id);
  n[1].take(n[0].values[x & 1]);
  return n[0].sum() + 100 * n[1].sum();
}
inline int methodMovesIndex(int x, int y) {
  Numbered n = {x & 1, {y, 2}};
  int a[2] = {y, x};
  n.moveTo(a[n.id], 1 - n.id);
  n.moveTo(a[n.id], n.id + 3);
  return n.sum() + 7 * a[0] + 11 * a[1];
}

// Two references to one object, where only the order of reads and writes of the same number would matter.
inline int harmlessAliases(int x, int y) {
  Sum s = {x, y};
  s += s;
  s.addAll(s, y);
  (s += s) += s;
  return s.a + 10 * s.b;
}
inline int elementsOfOneArray(int x, int y) {
  Sum s[3] = {{x, 1}, {y, 2}, {3, 4}};
  int i = x & 1, j = y & 1;
  s[i] += s[j];
  s[j] += s[2];
  return s[0].a + 3 * s[1].a + 7 * s[0].b + 11 * s[1].b;
}

inline int readBoth(const int& a, int b) { return a * 10 + b; }
inline int referenceSeesLaterEffect(int x, int y) {
  int i = x, a[2] = {x, y};
#ifdef __clang__
  return readBoth(i, ++i) + readBoth(a[i & 1], a[i & 1] += 3);
#else
  const int changed = ++i;
  const int r = readBoth(i, changed);
  const int element = a[i & 1] += 3;
  return r + readBoth(a[i & 1], element);
#endif
}

inline int choiceByReference(int x, int y) {
  int i = x, j = y;
#ifdef __clang__
  return readBoth(x > y ? i : j, i += 5) + i;
#else
  const int changed = i += 5;
  return readBoth(x > y ? i : j, changed) + i;
#endif
}

inline int changedTemporary(int x, int y) {
  int from = y;
  Numbered{x, {1, 2}}.take(from);
  Sum s = Sum{x, y} += Sum{1, 2};
  return (Sum{s} += s).a + s.b + from;
}

inline void setOneByOther(int& a, int& b) {
  a = b + 1;
  b = a + 2;
}
inline int disjointParts(int x, int y) {
  Numbered n = {x, {y, 1}};
  setOneByOther(n.id, n.values[0]);
  setOneByOther(n.values[1], n.values[0]);
  setOneByOther(n.values[0], n.id);
  return n.sum();
}

// Functions that are lowered when an argument needs them.
inline int later(int x);
template <class T>
T twice(T x) {
  return 2 * x;
}
inline int firstUsedInArgument(int x, int y) {
  int i = x;
  return readBoth(twice(x), later(y)) + add(i, twice(later(x)));
}
inline int later(int x) { return x - 1; }

inline int operatorsOfOwnResults(int x, int y) {
  Sum z = {x, y}, c = {1, 2};
  z = z * z + c;
  z = z + z * (z + c);
  return z.a + 3 * z.b;
}

struct Chain {
  int first = 3;
  int second = first + 1;
  int third = twice(second) + first;
};
inline int membersReadMembers(int x, int y) {
  Chain a, b = {x}, c = {x, y}, d[2] = {{1, y}};
  return a.third + 3 * b.third + 7 * c.third + 11 * d[0].third + 13 * d[1].third;
}

// ---- references to parts of one object -------------------------------------------------------------

struct Pile {
  int list[3];
  Sum sums[2];
  void addCrosswise(const Pile& o) {
    sums[0].a += o.sums[1].b;
    sums[1].b += o.sums[0].a;
    list[1] = o.list[0] + list[1];
    list[0] = o.list[1];
  }
  int store(int& to, int by) {
    to += list[0] * by;
    list[0] = 1;
    list[1] += to;
    return to;
  }
  int sum() const { return list[0] + 3 * list[1] + 7 * list[2] + 11 * sums[0].a + 13 * sums[1].b; }
};
inline void sortBoth(int& low, int& high) {
  const int smaller = low < high ? low : high;
  high = low < high ? high : low;
  low = smaller;
  high += low;
}
inline void addFirst(Sum& s, const int& k) {
  s.a += k;
  s.b += k;
}
inline int referencesToOneObject(int x, int y) {
  int a = x;
  sortBoth(a, a);
  Sum s = {x, y};
  addFirst(s, s.a);
  addFirst(s, s.b);
  s.addAll(s, s.a);
  Pile p = {{x, y, 1}, {s, {2, 3}}};
  p.addCrosswise(p);
  return a + 10 * s.a + 100 * s.b + p.sum();
}

inline int referencesToElements(int x, int y) {
  int a[4] = {x, y, 3, 4}, i = x & 3, j = y & 3;
  sortBoth(a[i], a[j]);
  sortBoth(a[3], a[j]);
  Pile p[2] = {{{x, y, 1}, {{1, 2}, {3, 4}}}, {{5, 6, x}, {{y, 2}, {3, y}}}};
  sortBoth(p[i & 1].list[j & 1], p[j & 1].list[i & 1]);
  sortBoth(p[1].sums[i & 1].a, p[j & 1].sums[1].b);
  p[i & 1].addCrosswise(p[j & 1]);
  const unsigned k = static_cast<unsigned>(i);
  sortBoth(p[0].list[k % 3], p[0].list[0]);
  return a[0] + 3 * a[1] + 7 * a[2] + 11 * a[3] + 13 * p[0].sum() + 17 * p[1].sum();
}

inline int methodAndOwnMember(int x, int y) {
  Pile p = {{x, y, 1}, {{1, 2}, {3, 4}}}, q[2] = {p, {{y, x, 2}, {{4, 3}, {2, 1}}}};
  int i = x & 1, r = p.store(p.list[2], 2) + p.store(p.list[0], 3);
  r += p.store(p.list[i], y) + q[i].store(q[1].list[y & 1], x);
  q[i].store(p.list[1], 2);
  return r + p.sum() + 3 * q[0].sum() + 5 * q[1].sum();
}

inline int combine(Pile& p, const Pile& q, int& element) {
  p.addCrosswise(q);
  element += q.list[0];
  sortBoth(p.list[2], element);
  return q.sum() + p.store(element, 2);
}
inline int aliasesPassedOn(int x, int y) {
  Pile p = {{x, y, 1}, {{1, 2}, {3, y}}}, q[2] = {p, p};
  int r = combine(p, p, p.list[x & 1]);
  r += combine(q[x & 1], q[y & 1], q[0].list[y & 1]);
  r += combine(p, q[1], q[0].list[1]);
  return r + p.sum() + q[0].sum() * 3 + q[1].sum() * 5;
}

}  // namespace effects
