// SPDX-License-Identifier: MIT
//
// Lvalues and references whose objects change while an expression is evaluated, and members that are initialised by
// others. effects.hpp lists the functions and includes this file. The text is both a .sk file and C++.
namespace effects {

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
#else  // g++ 12 does not follow C++17 here
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

inline int choicesAsTargets(int x, int y) {
  int a = x, b = y, list[3] = {x, y, 2};
  (x > y ? a : b) = 5;
  (a > 2 ? a : list[b & 1]) += 3;
  int after = (a > b ? a : b) *= 2;
  after += (x > 0 ? (y > 0 ? a : b) : list[2])++;
  --(b > a ? b : list[x & 1]);
  Sum s = {x, y}, t = {y, x}, u[2] = {s, t};
  (x > y ? s : t).a = 7;
  (y > 1 ? s : u[x & 1]) = u[y & 1];
  (x > 2 ? u[0] : x > 1 ? s : t).b -= (y > x ? s : t).a++;
  return after + a + 3 * b + 5 * list[0] + 7 * list[1] + 11 * list[2] + 13 * s.a + 17 * s.b + 19 * t.a +
         23 * t.b + 29 * u[0].a + 31 * u[0].b + 37 * u[1].a + 41 * u[1].b;
}

inline void addSum(const Pile& from, int& to) {
  to += from.sum();
  to += 3 * from.sum();
}
inline int choicesByReference(int x, int y) {
  Pile p = {{x, y, 1}, {{1, 2}, {3, y}}}, q = {{y, 2, x}, {{4, x}, {2, 1}}};
  int i = x & 1, k = y, r = bump(x > y ? i : k = 4);
  p.addCrosswise(x > 1 ? p : q);
  (y > 1 ? q : p).addCrosswise(x > y ? p : q);
  sortBoth(x > 2 ? p.list[i & 1] : q.list[0], y > 2 ? p.list[0] : q.list[1]);
  (x > 3 ? p : q).store((y > 3 ? p : q).list[1], 2);
  addFirst(x > 0 ? p.sums[0] : q.sums[1], (y > 0 ? p.sums[0] : q.sums[1]).a);
  r += (x > y ? p : q).store(p.list[2], 3) + 100 * i;
  addSum(x > 1 ? p : q, y > 2 ? i : k);
  addSum(y > 1 ? p : q, (x > 2 ? p : q).list[0]);
  return r + k + p.sum() + 3 * q.sum();
}

inline int choicesWithEffects(int x, int y) {
  Pile p = {{x, y, 1}, {{1, 2}, {3, y}}}, q = {{y, 2, x}, {{4, x}, {2, 1}}};
  int list[4] = {x, y, 3, 4}, i = 0;
  (x > y ? list[i++] : list[++i]) = 9;
  (x > 1 ? ++i : list[i]) += 2;
  p.addCrosswise(y > 1 ? p : (q = p));
  addFirst(p.sums[1], (x > 2 ? p.sums[i++ & 1] : (q.sums[1] = p.sums[1])).b);
  const int r = (x > y ? i += 2 : list[2]) + i++;
  return r + list[0] + 3 * list[1] + 5 * list[2] + 7 * list[3] + 11 * i + 13 * p.sum() + 17 * q.sum();
}

inline void rotate(int& a, int& b, int& c) {
  const int old = a;
  a = b;
  b = c + a;
  c = old;
}
const int fixedThree = 3;
const Pile fixedPile = {{4, 5, 6}, {{1, 2}, {3, 4}}};
inline int choicesOfConstants(int x, int y) {
  Pile p = {{x, y, 1}, {{1, 2}, {3, y}}};
  int i = x & 1;
  p.addCrosswise(x > 1 ? p : fixedPile);
  addFirst(p.sums[1], x > 2 ? p.sums[1].a : fixedThree);
  addFirst(p.sums[i], (x > 0 ? p : fixedPile).sums[y & 1].b);
  sortBoth(p.list[i], p.list[x > y ? 2 : fixedThree - 2]);
  const int r =
      readBoth(y > 0 ? i : fixedThree, i += 3) + readBoth((x > 1 ? p : fixedPile).list[i & 1], p.list[1] = 9);
  return r + p.sum() + 100 * i;
}

struct Grid {
  Pile p[3];
};
inline int manyIndices(int x, int y) {
  Grid g[2] = {
      {{{{1, 2, x}, {{3, 4}, {5, y}}}, {{6, 7, 8}, {{9, x}, {1, 2}}}, {{3, y, 5}, {{6, 7}, {8, 9}}}}}, {}};
  g[1] = g[0];
  const int i = x & 1, j = y & 1, k = (x + y) & 1;
  rotate(g[i].p[j].list[k], g[j].p[k + 1].list[i], g[k].p[i].list[j + 1]);
  rotate(g[1 - i].p[j].sums[k].a, g[j].p[k].sums[i].a, g[0].p[2 - i].sums[1].a);
  rotate(g[i].p[j].list[k], g[j].p[k].list[i], g[1].p[0].list[2]);
  int sum = 0;
  for (int n = 0; n < 6; ++n) sum = sum * 3 + g[n / 3].p[n % 3].sum();
  return sum;
}

}  // namespace effects
