// SPDX-License-Identifier: MIT
//
// Calls the object code of kernels.sk as sk/native/code.hpp says, without the runtime, and prints the bits of all results,
// which are the same on every CPU. Code for all levels that this CPU runs must agree. SK_CODE(name) names the Code of a kernel.
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <span>
#include <vector>

#include "sk/native/code.hpp"

using namespace sk::native;

#if defined(__x86_64__)
using Quad = __float128;
extern "C" Quad tanhq(Quad x);
Quad tanhOfQuad(Quad x) { return tanhq(x); }
#else
using Quad = long double;  // binary128
Quad tanhOfQuad(Quad x) { return std::tanh(x); }
#endif
static_assert(sizeof(Quad) == 16);

extern "C" {
extern const Code SK_CODE(saxpy), SK_CODE(diffuse), SK_CODE(sum), SK_CODE(escape), SK_CODE(functions),
    SK_CODE(hyperbolic), SK_CODE(integers), SK_CODE(narrow), SK_CODE(leap);
}

namespace {

constexpr std::int64_t count = 1003;  // no multiple of any number of lanes
constexpr std::int64_t room = count + 2 * mostLanes;

[[noreturn]] void fail(const char* name, const char* what) {
  std::fprintf(stderr, "%s: %s\n", name, what);
  std::exit(1);
}

/// An array with room before and behind its `count` elements.
template <class T>
struct Array {
  std::vector<T> all = std::vector<T>(static_cast<std::size_t>(room));
  T* data() { return all.data() + mostLanes; }
  T& operator[](std::int64_t i) { return data()[i]; }
};

template <class T, class Make>
Array<T> filled(Make make) {
  Array<T> array;
  for (std::int64_t i = 0; i < room; ++i)
    array.all[static_cast<std::size_t>(i)] = static_cast<T>(make(i - mostLanes));
  return array;
}

double someReal(std::int64_t i) {
  return std::ldexp(static_cast<double>((i * 7919 + 4000037) % 4093 - 2000), -8);
}

std::vector<const Entry*> entriesOf(const Code& code, EntryKind kind, Real real) {
  std::vector<const Entry*> found;
  for (const Entry& entry : std::span(code.entries, code.entryCount)) {
    const bool runs = entry.level <= levelOfHardware() && entry.isContracted == 0;
    if (entry.kind == kind && entry.real == real && runs) found.push_back(&entry);
  }
  return found;
}

/// A call over `count` elements in one row: arguments in order, and the arrays of all slots.
class Call {
 public:
  void uniform(void* value) { add(value, 1); }
  void gather(void* array) { add(array, count); }
  void none() { arguments_.emplace_back(); }
  void slot(void* array) {
    arrays_.push_back(array);
    rowSteps_.push_back(0);
  }

  Frame frame() const { return {arguments_.data(), {count, 1, 1, 1}, nullptr}; }
  Chunk chunk(std::int64_t elements = count) const {
    return {arrays_.data(), {}, elements, 1, 1, rowSteps_.data()};
  }

  void run(const Entry& entry) const {
    const Frame f = frame();
    const Chunk c = chunk();
    reinterpret_cast<RunFunction*>(entry.function)(&f, &c);
  }

 private:
  void add(void* array, std::int64_t elements) {
    Argument argument{};
    argument.components = &components_.emplace_back(array);
    argument.extent[0] = elements;
    argument.extent[1] = argument.extent[2] = argument.extent[3] = 1;
    for (int d = 0; d < 4; ++d) {
      argument.stride[d] = d == 0 ? 1 : elements;
      argument.multiply[d] = argument.divide[d] = 1;
    }
    argument.isSmall = 1;
    arguments_.push_back(argument);
  }

  std::vector<Argument> arguments_;
  std::deque<void*> components_;
  std::vector<void*> arrays_;
  std::vector<std::int64_t> rowSteps_;
};

template <class T>
void print(const char* name, T* values, std::int64_t number = count) {
  std::printf("%s", name);
  for (std::int64_t i = 0; i < number; ++i) {
    unsigned long long bits = 0;
    if constexpr (sizeof(T) == 8) {
      bits = std::bit_cast<std::uint64_t>(values[i]);
    } else if constexpr (sizeof(T) == 4) {
      bits = std::bit_cast<std::uint32_t>(values[i]);
    } else {
      bits = values[i];
    }
    std::printf(" %llx", bits);
  }
  std::printf("\n");
}

/// Runs each level's code, and prints each output.
template <class T>
void runAndPrint(const char* name, const Code& code, const Call& call, const std::vector<T*>& outputs,
                 Real real = Real::Float) {
  if (code.version != Code::currentVersion) fail(name, "the code is of another version");
  std::vector<std::vector<T>> first;
  const std::vector<const Entry*> entries = entriesOf(code, EntryKind::Run, real);
  if (entries.empty()) fail(name, "there is no code");
  for (const Entry* entry : entries) {
    call.run(*entry);
    for (std::size_t i = 0; i < outputs.size(); ++i) {
      const std::vector<T> values(outputs[i], outputs[i] + count);
      if (entry == entries[0]) {
        print(name, outputs[i]);
        first.push_back(values);
      } else {
        for (std::size_t e = 0; e < values.size(); ++e) {
          if (std::memcmp(&values[e], &first[i][e], sizeof(T)) != 0) fail(name, "levels of the CPU disagree");
        }
      }
    }
  }
}

void runSaxpy() {
  float a = 1.7F;
  Array<float> x = filled<float>(someReal), y = filled<float>([](auto i) { return someReal(3 * i); }), r;
  Call call;
  call.uniform(&a);
  call.none(), call.none(), call.none();
  call.slot(x.data()), call.slot(y.data()), call.slot(r.data());
  runAndPrint<float>("saxpy", SK_CODE(saxpy), call, {r.data()});
}

/// In binary128, which the compiler's own functions compute.
void runQuadSaxpy() {
  Quad a = static_cast<Quad>(1.7);
  Array<Quad> x = filled<Quad>(someReal), y = filled<Quad>([](auto i) { return someReal(3 * i); }), r;
  Call call;
  call.uniform(&a);
  call.none(), call.none(), call.none();
  call.slot(x.data()), call.slot(y.data()), call.slot(r.data());
  for (const Entry* entry : entriesOf(SK_CODE(saxpy), EntryKind::Run, Real::Quad)) call.run(*entry);
  Array<double> rounded;
  for (std::int64_t i = 0; i < count; ++i) rounded[i] = static_cast<double>(r[i]);
  print("quad saxpy", rounded.data());
}

/// The rows of a gather are slots, in the order of Code::slots.
void runDiffuse() {
  float k = 0.2F;
  Array<float> rows[3], v;
  for (int row = 0; row < 3; ++row) rows[row] = filled<float>([&](auto i) { return someReal(5 * i + row); });
  Call call;
  call.uniform(&k);
  call.gather(rows[1].data());
  call.none();
  for (const Slot& slot : std::span(SK_CODE(diffuse).slots, SK_CODE(diffuse).slotCount)) {
    call.slot(slot.isOutput != 0 ? v.data() : rows[slot.row[0] + 1].data());
  }
  runAndPrint<float>("diffuse", SK_CODE(diffuse), call, {v.data()});
}

/// Columns side by side, and then combined.
void runSum() {
  constexpr std::int64_t columns = 64, rounds = 15;
  Array<float> x = filled<float>(someReal);
  Call call;
  call.none(), call.none();
  call.slot(x.data());
  const Frame frame = call.frame();
  const Chunk chunk = call.chunk(columns * rounds);
  Array<float> sums, later;
  void* state[] = {sums.data()};
  void* laterState[] = {later.data()};
  const std::vector<const Entry*> folds = entriesOf(SK_CODE(sum), EntryKind::Fold, Real::Float);
  const std::vector<const Entry*> combines = entriesOf(SK_CODE(sum), EntryKind::Combine, Real::Float);
  if (folds.empty() || folds.size() != combines.size()) fail("sum", "there is no code");
  std::vector<float> first;
  for (std::size_t level = 0; level < folds.size(); ++level) {
    reinterpret_cast<FoldFunction*>(folds[level]->function)(&frame, &chunk, state, columns, rounds, 1, 1);
    for (std::int64_t i = 0; i < columns; ++i) later[i] = sums[columns - 1 - i];
    reinterpret_cast<CombineFunction*>(combines[level]->function)(&frame, state, laterState, columns);
    const std::vector<float> values(sums.data(), sums.data() + columns);
    if (level == 0) {
      print("sum", sums.data(), columns);
      first = values;
    } else if (values != first) {
      fail("sum", "levels of the CPU disagree");
    }
  }
}

void runEscape() {
  Array<float> x = filled<float>([](auto i) { return someReal(i) / 8; });
  Array<float> y = filled<float>([](auto i) { return someReal(11 * i) / 8; });
  Array<int> steps;
  Call call;
  call.none(), call.none(), call.none();
  call.slot(x.data()), call.slot(y.data()), call.slot(steps.data());
  runAndPrint<int>("escape", SK_CODE(escape), call, {steps.data()});
}

void runFunctions() {
  Array<float> x = filled<float>(someReal), y = filled<float>([](auto i) { return someReal(3 * i); }), r[4];
  Call call;
  call.none(), call.none(), call.none();
  call.slot(x.data()), call.slot(y.data());
  for (Array<float>& component : r) call.slot(component.data());
  runAndPrint<float>("functions", SK_CODE(functions), call,
                     {r[0].data(), r[1].data(), r[2].data(), r[3].data()});
}

/// In doubles and binary128, functions are those of the C library, called for each lane: they are compared with its own.
template <class T, class Expected>
void checkFunction(const char* name, Real real, Expected expected) {
  Array<T> x = filled<T>(someReal), r;
  Call call;
  call.none(), call.none();
  call.slot(x.data()), call.slot(r.data());
  const std::vector<const Entry*> entries = entriesOf(SK_CODE(hyperbolic), EntryKind::Run, real);
  if (entries.empty()) fail(name, "there is no code");
  for (const Entry* entry : entries) {
    call.run(*entry);
    for (std::int64_t i = 0; i < count; ++i) {
      if (static_cast<double>(r[i]) != expected(static_cast<double>(x[i])))
        fail(name, "differs from the C library's");
    }
  }
}

void runIntegers() {
  Array<int> a = filled<int>([](auto i) { return i * 1103515245 + 12345; });
  Array<unsigned> b = filled<unsigned>([](auto i) { return i * 22695477; });
  Array<float> x = filled<float>([](auto i) { return someReal(i) * 3; });
  Array<int> r[4];
  Call call;
  for (int i = 0; i < 4; ++i) call.none();
  call.slot(a.data()), call.slot(b.data()), call.slot(x.data());
  for (Array<int>& component : r) call.slot(component.data());
  runAndPrint<int>("integers", SK_CODE(integers), call, {r[0].data(), r[1].data(), r[2].data(), r[3].data()});
}

void runNarrow() {
  Array<std::uint16_t> h = filled<std::uint16_t>([](auto i) { return i * 61; }),
                       r[2];  // NaNs and infinities, too
  Array<std::uint8_t> c = filled<std::uint8_t>([](auto i) { return i; }),
                      n = filled<std::uint8_t>([](auto i) { return i * 7; }), m;
  Call call;
  for (int i = 0; i < 5; ++i) call.none();
  call.slot(h.data()), call.slot(c.data()), call.slot(n.data());
  call.slot(r[0].data()), call.slot(r[1].data()), call.slot(m.data());
  runAndPrint<std::uint16_t>("narrow", SK_CODE(narrow), call, {r[0].data(), r[1].data()});
  runAndPrint<std::uint8_t>("narrow", SK_CODE(narrow), call, {m.data()});
}

void runLeap() {
  int by = 5;
  Array<float> a = filled<float>(someReal), r;
  Call call;
  call.uniform(&by);
  call.gather(a.data());
  call.none();
  for (const Slot& slot : std::span(SK_CODE(leap).slots, SK_CODE(leap).slotCount)) {
    call.slot(slot.isOutput != 0 ? r.data() : a.data());
  }
  runAndPrint<float>("leap", SK_CODE(leap), call, {r.data()});
}

}  // namespace

int main() {
  runSaxpy();
  runQuadSaxpy();
  runDiffuse();
  runSum();
  runEscape();
  runFunctions();
  checkFunction<double>("tanh of doubles", Real::Double, [](double x) { return std::tanh(x); });
  checkFunction<Quad>("tanh of binary128", Real::Quad,
                      [](double x) { return static_cast<double>(tanhOfQuad(x)); });
  runIntegers();
  runNarrow();
  runLeap();
}
