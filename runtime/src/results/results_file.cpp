// SPDX-License-Identifier: MIT
#include "results/results_file.hpp"

#include <cstring>
#include <stdexcept>
#include <type_traits>

#include <fmt/format.h>

#include "support/cache_folder.hpp"

namespace sk::results {

namespace {

constexpr std::string_view magic = "StreamKernel results 2\n";

/// Appends members to bytes, in the byte order of this machine: the file is read where it was written.
class Writer {
 public:
  template <class Number>
    requires(std::is_arithmetic_v<Number> || std::is_enum_v<Number>)
  void operator()(const Number& number) {
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
  }
  void operator()(const std::string& text) {
    (*this)(text.size());
    bytes += text;
  }
  template <class T>
  void operator()(const std::vector<T>& list);
  template <class Record>
    requires(std::is_class_v<Record>)
  void operator()(const Record& record);

  std::string bytes{magic};
};

class Reader {
 public:
  Reader(std::string_view bytes, std::string_view file) : left_(bytes), file_(file) {}

  template <class Number>
    requires(std::is_arithmetic_v<Number> || std::is_enum_v<Number>)
  void operator()(Number& number) {
    const std::string_view bytes = take(sizeof number);
    std::memcpy(&number, bytes.data(), sizeof number);
  }
  void operator()(std::string& text) { text = take(size()); }
  template <class T>
  void operator()(std::vector<T>& list);
  template <class Record>
    requires(std::is_class_v<Record>)
  void operator()(Record& record);

  bool isAtEnd() const { return left_.empty(); }
  [[noreturn]] void fail() const {
    throw std::runtime_error(fmt::format("'{}' is incomplete or damaged", file_));
  }

 private:
  std::size_t size() {
    std::size_t count = 0;
    (*this)(count);
    return count;
  }
  std::string_view take(std::size_t count) {
    if (count > left_.size()) fail();
    const std::string_view bytes = left_.substr(0, count);
    left_.remove_prefix(count);
    return bytes;
  }

  std::string_view left_, file_;
};

// The members of each record, once for both directions.
template <class Record, class T>
concept Is = std::is_same_v<std::remove_const_t<Record>, T>;

template <class Visit>
void visit(Visit& v, Is<Values> auto& r) {
  v(r.kind), v(r.bytes);
}
template <class Visit>
void visit(Visit& v, Is<Series> auto& r) {
  v(r.name), v(r.reads), v(r.hash), v(r.first), v(r.last), v(r.droppedBytes);
}
template <class Visit>
void visit(Visit& v, Is<Kernel> auto& r) {
  v(r.name), v(r.device), v(r.isNative), v(r.isOnReference), v(r.isReduce), v(r.calls), v(r.seconds),
      v(r.hasFloats), v(r.whyNotHalf), v(r.whyNotWide);
  v(r.compensates), v(r.sumsExactly), v(r.hasFastFunctions), v(r.mayContract), v(r.tables), v(r.called);
  v(r.used);
}
template <class Visit>
void visit(Visit& v, Is<Stream> auto& r) {
  v(r.name), v(r.storage), v(r.count), v(r.bytes);
}
template <class Visit>
void visit(Visit& v, Is<Device> auto& r) {
  v(r.name), v(r.isReference), v(r.isNative);
}
template <class Visit>
void visit(Visit& v, Is<Process> auto& r) {
  v(r.devices), v(r.series), v(r.kernels), v(r.streams), v(r.linkedKernels), v(r.notes), v(r.span),
      v(r.hasTimes);
}

template <class T>
void Writer::operator()(const std::vector<T>& list) {
  (*this)(list.size());
  for (const T& each : list) (*this)(each);
}
template <class Record>
  requires(std::is_class_v<Record>)
void Writer::operator()(const Record& record) {
  visit(*this, record);
}

template <class T>
void Reader::operator()(std::vector<T>& list) {
  const std::size_t count = size();
  if (count > left_.size()) fail();  // each takes a byte at least
  list.resize(count);
  for (T& each : list) (*this)(each);
}
template <class Record>
  requires(std::is_class_v<Record>)
void Reader::operator()(Record& record) {
  visit(*this, record);
}

}  // namespace

double Values::at(std::size_t i) const {
  if (kind == Kind::Integer) return static_cast<double>(integerAt(i));
  if (kind == Kind::Double) {
    double value = 0;
    std::memcpy(&value, bytes.data() + i * sizeof value, sizeof value);
    return value;
  }
  float value = 0;
  std::memcpy(&value, bytes.data() + i * sizeof value, sizeof value);
  return value;
}

std::int64_t Values::integerAt(std::size_t i) const {
  std::int64_t value = 0;
  std::memcpy(&value, bytes.data() + i * sizeof value, sizeof value);
  return value;
}

std::string toBytes(const Process& process) {
  Writer writer;
  writer(process);
  writer(hashOf(writer.bytes));
  return std::move(writer.bytes);
}

Process fromBytes(std::string_view bytes, std::string_view file) {
  if (!bytes.starts_with(magic)) {
    throw std::runtime_error(fmt::format(
        "'{}' holds no results of this version of StreamKernel; build the program with it", file));
  }
  constexpr std::size_t sumBytes = sizeof(std::uint64_t);
  Reader reader(bytes.substr(magic.size()), file);
  if (bytes.size() < magic.size() + sumBytes) reader.fail();
  std::uint64_t sum = 0;
  std::memcpy(&sum, bytes.data() + bytes.size() - sumBytes, sumBytes);
  if (sum != hashOf(bytes.substr(0, bytes.size() - sumBytes))) reader.fail();
  Process process;
  reader(process);
  reader(sum);
  if (!reader.isAtEnd()) reader.fail();
  return process;
}

}  // namespace sk::results
