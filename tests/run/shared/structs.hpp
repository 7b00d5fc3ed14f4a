// SPDX-License-Identifier: MIT
//
// Structs and arrays. The text is both a .sk file and C++ (see control_flow.hpp).
// clang-format off: a macro is a list
#define STRUCT_CASES(CASE)                                                                         \
  CASE(membersReadAndWritten) CASE(copies) CASE(nested) CASE(memberFunctions)                      \
  CASE(changingMemberFunctions) CASE(memberOverloads) CASE(operators) CASE(compoundOperators)      \
  CASE(freeOperators) CASE(callAndIndexOperators) CASE(defaultMembers) CASE(designated)            \
  CASE(zeroInitialised) CASE(returned) CASE(chained) CASE(byReference) CASE(memberByReference)     \
  CASE(conditional) CASE(arrayOfStructs) CASE(arrayInStruct) CASE(arrayCopies) CASE(arrayZeroed)   \
  CASE(arrayDynamicIndex) CASE(arrayOfFloats) CASE(constantTable) CASE(structConstant)             \
  CASE(staticMembers) CASE(localStruct) CASE(sameNames) CASE(structInLoop) CASE(selfAssignment)    \
  CASE(arrayByReference) CASE(arrayParameter) CASE(boolMembers) CASE(templateStruct)             \
  CASE(givesItself) CASE(thisObject) CASE(structuredBindings) CASE(overloadedIntrinsics)         \
  CASE(defaultsAtEveryDepth) CASE(defaultsInArrays) CASE(arraysByReference) CASE(fewerInitialisers) \
  CASE(defaultsWithEffects) CASE(narrowEnumerations)
// clang-format on

namespace structs {

struct Point {
  int x;
  int y;
  int sum() const { return x + y; }
  int dot(const Point& o) const { return x * o.x + y * o.y; }
  void add(int d) {
    x += d;
    y += d;
  }
  int addAndGet(int d) {
    add(d);
    return sum();
  }
  int at(int i) const { return i == 0 ? x : y; }
  int at(bool first) const { return first ? 1000 + x : 2000 + y; }
  Point turned() const { return {-y, x}; }
  Point operator+(const Point& o) const { return {x + o.x, y + o.y}; }
  Point operator-() const { return {-x, -y}; }
  void operator+=(const Point& o) {
    x += o.x;
    y += o.y;
  }
  bool operator==(const Point& o) const { return x == o.x && y == o.y; }
  int operator()(int a) const { return a * x + y; }
  int operator[](int i) const { return i == 0 ? x : y; }
};
inline Point operator*(const Point& a, int s) { return {a.x * s, a.y * s}; }
inline Point operator*(int s, const Point& a) { return a * s; }
inline int operator*(const Point& a, const Point& b) { return a.dot(b); }
inline bool operator<(const Point& a, const Point& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); }

struct Segment {
  Point from, to;
  int weight = 3;
  int length2() const {
    int dx = to.x - from.x, dy = to.y - from.y;
    return dx * dx + dy * dy;
  }
};

struct Stack {
  int items[4];
  int count;
  void push(int v) {
    if (count < 4) items[count++] = v;
  }
  int pop() { return count > 0 ? items[--count] : -1; }
};

inline int membersReadAndWritten(int x, int y) {
  Point p;
  p.x = x;
  p.y = p.x * 2;
  p.x += y;
  p.y++;
  --p.x;
  return p.x * 100 + p.y;
}
inline int copies(int x, int y) {
  Point p = {x, y}, q = p;
  q.x = 50;
  Point r(q);
  r.y = 60;
  p = r;
  p.x++;
  return p.x + 2 * p.y + 3 * q.x + 5 * q.y + 7 * r.x;
}
inline int nested(int x, int y) {
  Segment s = {{x, y}, {y, x}, 2};
  s.to.x += 3;
  Segment t = s;
  t.from = s.to;
  t.to.y = s.from.x;
  return s.length2() * t.weight + t.length2() + t.from.x;
}
inline int memberFunctions(int x, int y) {
  Point p{x, y};
  return p.sum() * 10 + p.dot(Point{2, 3}) + p.turned().sum() + Point{y, 1}.sum();
}
inline int changingMemberFunctions(int x, int y) {
  Point p{x, y};
  p.add(4);
  int r = p.addAndGet(y);
  Segment s = {p, p, 1};
  s.to.add(r);
  return r * 3 + s.to.x + s.from.y;
}
inline int memberOverloads(int x, int y) {
  Point p{x, y};
  return p.at(0) + p.at(1) * 10 + p.at(true) + p.at(x > y);
}
inline int operators(int x, int y) {
  Point p{x, y}, q{y, 2};
  Point r = p + q + -p;
  return r.x * 10 + r.y + (p == q) * 100 + (p + q == q + p);
}
inline int compoundOperators(int x, int y) {
  Point p{x, y};
  p += Point{1, 2};
  p += p + p;
  return p.x * 100 + p.y;
}
inline int freeOperators(int x, int y) {
  Point p{x, y}, q{3, x};
  return (p * 2).x + (3 * q).y + p * q + (p < q) * 1000;
}
inline int callAndIndexOperators(int x, int y) {
  Point p{x, y};
  return p(3) + p[0] * 10 + p[x & 1] * 100;
}
struct Defaults {
  int a = 7;
  float b = 0.5f;
  bool c = true;
  int d;
};
inline int defaultMembers(int x, int y) {
  Defaults s{};
  Defaults t = {x};
  Defaults u{x, 2.5f, false, y};
  Segment v{{1, 2}, {3, y}};
  return s.a + int(s.b * 2) + s.c + s.d + t.a * 10 + int(t.b * 2) + t.c + t.d + int(u.b * 2) + u.c + u.d +
         v.weight;
}
inline int designated(int x, int y) {
  Point p = {.x = y, .y = x};
  Point q{.y = 5};
  return p.x * 10 + p.y + q.x * 100 + q.y;
}
inline int zeroInitialised(int x, int y) {
  Segment s = {};
  Point p{};
  int a[3] = {};
  Point list[2] = {{x, y}};
  return s.from.x + s.to.y + s.weight + p.x + a[0] + a[1] + a[2] + list[0].sum() + list[1].sum();
}
inline Point make(int x, int y) { return Point{x * 2, y - 1}; }
inline Segment makeSegment(int x, int y) {
  Segment s;
  s.from = make(x, y);
  s.to = {y, x};
  return s;
}
inline int returned(int x, int y) {
  Point p = make(x, y);
  return p.sum() + make(y, x).x * 10 + makeSegment(x, y).length2() + makeSegment(y, x).from.y;
}
inline int chained(int x, int y) {
  return make(x, y).turned().turned().turned().dot(make(1, 2) + make(y, 3));
}
inline void grow(Segment& s, int by) {
  s.to.x += by;
  s.weight *= 2;
}
inline int byReference(int x, int y) {
  Segment s{{x, y}, {1, 1}};
  grow(s, y);
  grow(s, 2);
  return s.to.x + 10 * s.weight + s.from.x;
}
inline void triple(int& v) { v *= 3; }
inline int memberByReference(int x, int y) {
  Segment s{{x, y}, {x, y}};
  triple(s.to.x);
  triple(s.from.y);
  s.from.add(1);
  return s.to.x + 10 * s.to.y + 100 * s.from.x + 1000 * s.from.y;
}
inline int conditional(int x, int y) {
  Point p{x, y}, q{y, x};
  Point r = x < y ? p : q;
  Point s = y > 0 ? make(x, y) : Point{1, 2};
  return (x > 3 ? p : r).x + r.y * 10 + s.x * 100;
}
inline int arrayOfStructs(int x, int y) {
  Point list[3] = {{x, y}, {1, 2}, make(x, y)};
  list[1].x += list[0].y;
  list[2] = list[1];
  list[2].y--;
  int r = 0;
  for (int i = 0; i < 3; i++) r = r * 5 + list[i].dot(list[(i + 1) % 3]);
  return r;
}
inline int arrayInStruct(int x, int y) {
  Stack s = {{0, 0, 0, 0}, 0};
  s.push(x);
  s.push(y);
  s.push(x - y);
  Stack t = s;
  int r = s.pop() * 10 + s.pop();
  t.items[1] += 5;
  s.push(77);
  return r + t.pop() + t.pop() * 3 + s.count + s.items[1];
}
inline int arrayCopies(int x, int y) {
  struct Three {
    int v[3];
  };
  Three a = {{x, y, 1}};
  Three b = a;
  b.v[0] = 9;
  a.v[2] = b.v[1];
  return a.v[0] + 10 * a.v[2] + 100 * b.v[0] + 1000 * b.v[2];
}
inline int arrayZeroed(int x, int y) {
  int a[8] = {x, y};
  int sum = 0;
  for (int i = 0; i < 8; ++i) sum += a[i] * (i + 1);
  return sum;
}
inline int arrayDynamicIndex(int x, int y) {
  int a[5] = {3, 1, 4, 1, 5};
  int i = (x & 0xff) % 5;
  a[i] += y;
  a[(i + 2) % 5] *= 2;
  return a[0] + 7 * a[1] + 49 * a[2] + 343 * a[3] + 2401 * a[4] + a[a[1] & 3];
}
inline int arrayOfFloats(int x, int y) {
  float a[4] = {0.5f, float(x), 1.5f, y * 0.25f};
  float sum = 0;
  for (int i = 3; i >= 0; --i) sum = sum * 2 + a[i];
  return int(sum * 8);
}
const int table[6] = {1, 4, 9, 16, 25, 36};
constexpr float weights[3] = {0.25f, 0.5f, 0.25f};
inline int constantTable(int x, int y) {
  const int local[3] = {7, 8, 9};
  return table[(x & 0xff) % 6] + 100 * table[2] + local[(y & 0xff) % 3] + int(weights[(x + y) & 1] * 4);
}
constexpr Point origin = {3, 4};
const Segment unit = {{0, 0}, {1, 1}, 5};
inline int structConstant(int x, int y) { return origin.x * x + origin.sum() + unit.to.x * y + unit.weight; }
struct Limits {
  int low;
  static constexpr int most = 12;
  static int clamp(int v) { return v > most ? most : v; }
};
inline int staticMembers(int x, int y) {
  Limits l = {y};
  return Limits::clamp(x * 2) + Limits::most * 100 + l.clamp(l.low);
}
inline int localStruct(int x, int y) {
  struct Range {
    int low, high;
    int width() const { return high - low; }
  };
  Range r = {x, y};
  if (r.low > r.high) r = {r.high, r.low};
  return r.width();
}
namespace inner {
struct Point {
  float v;
  int get() const { return int(v * 2); }
};
inline int use(int x) { return Point{x * 0.5f}.get(); }
}  // namespace inner
inline int sameNames(int x, int y) { return inner::use(x) + Point{x, y}.y + inner::Point{2.5f}.get(); }
inline int structInLoop(int x, int y) {
  Point p = {0, 1};
  for (Point q = {x, 0}; q.x < y; q.x += 2, q.y++) p = {p.y, p.x + q.x};
  return p.x + p.y;
}
inline int selfAssignment(int x, int y) {
  Point p{x, y};
  p = {p.y, p.x};       // the old members
  p = Point{p.sum(), p.x - p.y};
  return p.x * 100 + p.y;
}
struct Four {
  int v[4];
};
inline void sortTwo(Four& f, int i, int j) {
  if (f.v[i] > f.v[j]) {
    int t = f.v[i];
    f.v[i] = f.v[j];
    f.v[j] = t;
  }
}
inline int arrayByReference(int x, int y) {
  Four f = {{x, y, 3, x - y}};
  for (int i = 0; i < 4; ++i)
    for (int j = i + 1; j < 4; ++j) sortTwo(f, i, j);
  return f.v[0] + 7 * f.v[1] + 49 * f.v[2] + 343 * f.v[3];
}
inline int total(Four f) {
  f.v[0] *= 2;
  return f.v[0] + f.v[1] + f.v[2] + f.v[3];
}
inline int arrayParameter(int x, int y) {
  Four f = {{x, y, 1, 2}};
  return total(f) * 10 + f.v[0];
}
struct Flags {
  bool isOdd, isLarge;
  int count;
};
inline int boolMembers(int x, int y) {
  Flags f = {(x & 1) != 0, y > 4, 0};
  f.isOdd = !f.isOdd;
  f.count += f.isLarge ? 2 : 1;
  f.isLarge = f.isLarge && f.isOdd;
  return f.isOdd + 2 * f.isLarge + 4 * f.count;
}
template <class T>
struct Both {
  T a, b;
  T larger() const { return a > b ? a : b; }
};
inline int templateStruct(int x, int y) {
  Both<int> i = {x, y};
  Both<float> f = {x * 0.5f, 1.5f};
  return i.larger() * 10 + int(f.larger() * 2);
}

struct Counter {
  int n, calls;
  Counter& operator+=(int d) {
    n += d;
    ++calls;
    return *this;
  }
  Counter& operator++() { return *this += 1; }
  Counter& limit(int most) {
    if (n <= most) return *this;
    n = most;
    return (*this);
  }
  const Counter& same() const { return *this; }
  Counter twice() const {
    Counter copy = *this;
    copy += n;
    return copy;
  }
  int times(int k) const { return k == 0 ? 0 : same().n * k; }
};
inline int givesItself(int x, int y) {
  Counter a = {x, 0}, list[3] = {{y, 0}, {1, 0}, {2, 0}};
  (a += y) += 2;
  ++(++a);
  a.limit(20).limit(10) += 1;
  list[1] += (a += 3).n;
  int i = x & 1;
  Counter copy = list[i] += 5;
  return a.n + 10 * a.calls + 100 * copy.n + 1000 * list[1].n + (++list[2]).calls + a.same().twice().n;
}
inline int thisObject(int x, int y) {
  Counter a = {x, y};
  return a.twice().n + a.times(y) + a.same().calls;
}

struct Halves {
  int low, high;
};
const auto [eleven, twelve] = Halves{11, 12};
inline Halves halvesOf(int x) { return {x & 3, x >> 2}; }
inline int structuredBindings(int x, int y) {
  Halves given = {x, y};
  auto [a, b] = given;   // a copy
  a += 10;
  b *= 2;
  const auto [low, high] = halvesOf(x + y);
  int list[3] = {x, y, 4};
  auto [first, second, third] = list;
  first += third++;
  int sum = 0;
  for (auto [i, end] = Halves{0, 3}; i < end; ++i) sum += i * second;
  return a * eleven + 10 * b + twelve + 100 * low + 1000 * high + given.low + given.high + first + third +
         list[0] + sum;
}

inline Halves abs(Halves h) { return {h.low < 0 ? -h.low : h.low, h.high < 0 ? -h.high : h.high}; }
inline Halves max(Halves a, Halves b) { return a.low > b.low ? a : b; }
inline int length(Halves h) { return h.low + h.high; }
template <class T>
inline Both<T> sign(Both<T> v) {
  return {v.a > 0 ? T(1) : T(-1), v.b > 0 ? T(1) : T(-1)};
}
inline int overloadedIntrinsics(int x, int y) {
  const Halves h = {x, y}, larger = max(abs(h), halvesOf(y));
  const Both<int> signs = sign(Both<int>{x, y});
  return length(larger) + 10 * larger.low + 100 * signs.a + 1000 * signs.b;
}

struct Inner {
  int a = 1;
  float b;
  int c = 3;
};
struct Middle {
  Inner inner;
  Inner given = {7};
  Inner list[2];
  int n = 2;
};
struct Outer {
  Middle middle[2];
  Middle last = {{4}, {}, {{5}}};
};
inline int weight(const Inner& i) { return i.a + 10 * i.c; }
inline int weight(const Middle& m) {
  return weight(m.inner) + 3 * weight(m.given) + 7 * weight(m.list[0]) + 11 * weight(m.list[1]) + m.n;
}
inline int weight(const Outer& o) {
  return weight(o.middle[0]) + 3 * weight(o.middle[1]) + 5 * weight(o.last);
}
inline int defaultsAtEveryDepth(int x, int y) {
  Middle m;
  Outer o, p = {};
  p.middle[x & 1].n = y;
  Outer q = Outer();
  q.last.inner.a = x;
  return weight(m) + weight(o) + 3 * weight(p) + 7 * weight(q) + weight(Middle{});
}

inline int defaultsInArrays(int x, int y) {
  Inner none[3], empty[4] = {}, some[5] = {{x}, {}, {y, 2, x}};
  some[4].a += none[x & 1].a;
  int r = 0;
  for (int i = 0; i < 5; ++i) r = 3 * r + weight(some[i]);
  for (int i = 0; i < 4; ++i) r = 3 * r + weight(empty[i]);
  return r + weight(none[2]);
}

struct Couple {
  int first, second;
};
struct Grid {
  Couple size = {4, 5};
  int cells[6] = {1, 2};
  bool open = true;
};
inline int fewerInitialisers(int x, int y) {
  Grid g, h = {{x}}, k = {{x, y}, {y}}, list[3] = {{{1}, {x}, false}};
  int flat[7] = {x, y};
  Couple pairs[3] = {{x}, {}};
  return g.size.second + g.cells[1] + 3 * h.size.second + 5 * h.cells[0] + 7 * k.cells[0] + 11 * k.cells[1] +
         13 * k.open + 17 * list[0].open + 19 * list[2].open + 23 * list[1].cells[1] + flat[1] + flat[6] +
         pairs[0].second + pairs[2].first;
}

inline int count(int& n) { return ++n; }
inline int defaultsWithEffects(int x, int y) {
  int n = x;
  Couple p[3] = {{count(n), n}, {n, count(n)}};
  Inner i = {count(n), 0, n};
  Inner list[2] = {{n}, {count(n)}};
  return p[0].first + 3 * p[0].second + 5 * p[1].first + 7 * p[1].second + weight(i) + 3 * weight(list[0]) +
         5 * weight(list[1]) + n * y;
}

enum class Kind : unsigned char { Solid, Fluid, Gas };
enum Signed : signed char { Below = -3, Above = 100 };
enum class Wide : unsigned short { Low = 1, High = 65535 };
enum class Flag : bool { Off, On };
enum Plain { One = 1, Two };
enum class Long : long { Negative = -5, Positive = 2147483647 };
enum class Longer : unsigned long long { Zero, Most = 4294967295 };
struct Tagged {
  Kind kind = Kind::Gas;
  Signed sign = Below;
  Wide wide = Wide::High;
  Flag flag = Flag::On;
};
inline int valueOf(Kind k) {
  switch (k) {
    case Kind::Solid: return 1;
    case Kind::Fluid: return 20;
    default: return 300;
  }
}
inline int narrowEnumerations(int x, int y) {
  Tagged t, list[3] = {{Kind::Solid}, {Kind::Fluid, Above}};
  t.kind = Kind(x & 1);
  int r = valueOf(t.kind) + valueOf(list[2].kind);
  switch (list[y & 1].sign) {
    case Below: r += 1000; break;
    case Above: r += 2000; [[fallthrough]];
    default: r += 4000;
  }
  switch (t.wide) {
    case Wide::Low: r += 1; break;
    case Wide::High: r += 7;
  }
  switch (x > y ? Flag::On : t.flag) {
    case Flag::Off: r += 11; break;
    case Flag::On: r += 13;
  }
  t.flag = Flag(y & 1);
  r += t.flag == Flag::On ? 17 : 19;
  r += int(t.wide) + t.sign * 5 + int(list[0].kind) + (t.kind < list[2].kind ? 23 : 29);
  Plain p = x > 2 ? Two : One;
  Long l = x > y ? Long::Negative : Long::Positive;
  Longer m = x < 0 ? Longer::Zero : Longer::Most;
  switch (l) {
    case Long::Negative: r += 31; break;
    case Long::Positive: r += 37;
  }
  r += (l < Long::Positive ? 41 : 43) + (m > Longer::Zero ? 47 : 53) + int(l) / 2 + int(unsigned(m));
  return r * p + (p << 3);
}

inline void swapEnds(int (&w)[4], int by) {
  int first = w[0] + by;
  w[0] = w[3];
  w[3] = first;
}
template <int n>
int totalOf(const int (&w)[n]) {
  int sum = 0;
  for (int i = 0; i < n; ++i) sum = 3 * sum + w[i];
  return sum;
}
struct Row {
  int cells[4] = {1, 2, 3, 4};
  int total() const { return totalOf(cells); }
};
template <class T, int n>
struct Cells {
  T cells[n];
  int add(const int (&w)[2]) { return cells[0] += w[0] * w[1]; }
};
inline int sumOf(Cells<int, 2> (&w)[2], int d) {
  w[1].cells[d & 1] += d;
  return w[0].cells[0] + w[1].cells[1];
}
inline int arraysByReference(int x, int y) {
  int w[4] = {x, y, 1, 2}, two[2] = {y, x};
  Row rows[2];
  Cells<int, 2> pairs[2] = {{{x, 3}}, {{5, y}}};
  x += sumOf(pairs, y) + pairs[1].add(two);
  swapEnds(w, y);
  swapEnds(rows[x & 1].cells, x);
  return totalOf(w) + 3 * totalOf(two) + 5 * rows[0].total() + 7 * totalOf(rows[1].cells);
}

}  // namespace structs
