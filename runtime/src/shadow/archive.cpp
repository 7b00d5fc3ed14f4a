// SPDX-License-Identifier: MIT
#include "shadow/archive.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <type_traits>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <fmt/format.h>

#include "sk/error.hpp"

namespace sk::shadow {

namespace {

/// Appends values to bytes. Ranks of one program have one layout of the types.
class Writer {
 public:
  std::string bytes;

  template <class... Values>
  void operator()(const Values&... values) {
    (put(values), ...);
  }

 private:
  template <class T>
  void put(const T& value) {
    if constexpr (std::is_trivially_copyable_v<T>) {
      bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    } else {
      visit(*this, const_cast<T&>(value));
    }
  }
  void put(const std::string& text) {
    put(text.size());
    bytes += text;
  }
  template <class T>
  void put(const std::vector<T>& list) {
    put(list.size());
    for (const T& each : list) put(each);
  }
  template <class T>
  void put(const std::optional<T>& value) {
    put(value.has_value());
    if (value) put(*value);
  }
};

class Reader {
 public:
  explicit Reader(std::string_view bytes) : rest_(bytes) {}

  bool isAtEnd() const { return rest_.empty(); }
  template <class... Values>
  void operator()(Values&... values) {
    (get(values), ...);
  }

 private:
  std::string_view take(std::size_t count) {
    if (count > rest_.size()) throw Error("the reports of other ranks are cut off", Error::Kind::File);
    const std::string_view taken = rest_.substr(0, count);
    rest_.remove_prefix(count);
    return taken;
  }
  template <class T>
  void get(T& value) {
    if constexpr (std::is_trivially_copyable_v<T>) {
      std::memcpy(static_cast<void*>(&value), take(sizeof value).data(), sizeof value);
    } else {
      visit(*this, value);
    }
  }
  void get(std::string& text) {
    std::size_t size = 0;
    get(size);
    text = take(size);
  }
  template <class T>
  void get(std::vector<T>& list) {
    std::size_t size = 0;
    get(size);
    if (size > rest_.size()) throw Error("the reports of other ranks are damaged", Error::Kind::File);
    list.clear();
    list.resize(size);
    for (T& each : list) get(each);
  }
  template <class T>
  void get(std::optional<T>& value) {
    bool has = false;
    get(has);
    if (has) get(value.emplace());
  }

  std::string_view rest_;
};

template <class Archive>
void visit(Archive& archive, Input& it) {
  archive(it.parameter, it.value, it.isReal, it.at);
}
template <class Archive>
void visit(Archive& archive, ElementRecord& it) {
  archive(it.call, it.output, it.index, it.device, it.reference, it.isReal, it.inputs, it.source);
}
template <class Archive>
void visit(Archive& archive, Series& it) {
  it.visitMembers(archive);
}
template <class Archive>
void visit(Archive& archive, Shares& it) {
  it.visitMembers(archive);
}
template <class Archive>
void visit(Archive& archive, OutputRecord& it) {
  archive(it.name, it.type, it.points, it.unreadCalls, it.unreadSeconds);
}
template <class Archive>
void visit(Archive& archive, KernelRecord& it) {
  archive(it.name, it.calls, it.followed, it.seconds, it.own, it.storage, it.inherited, it.total,
          it.amplification, it.worst, it.worstError, it.nans, it.infinities, it.flushed, it.decisions,
          it.ownSquares, it.storedSquares, it.stored, it.storedBetter, it.readFrom, it.compensates,
          it.choices, it.outputs);
}
template <class Archive>
void visit(Archive& archive, StreamRecord& it) {
  archive(it.name, it.type, it.shape, it.resyncs, it.points, it.unread, it.written, it.unreadSeconds);
}
template <class Archive>
void visit(Archive& archive, ResultRecord& it) {
  archive(it.name, it.isValue, it.reads, it.elements, it.largest, it.last, it.differs, it.numbers,
          it.notFinite, it.withoutValue, it.shares);
}
template <class Archive>
void visit(Archive& archive, GivenRecord& it) {
  archive(it.kernel, it.parameter, it.type, it.scalar, it.isStream, it.stream, it.low, it.high, it.hasRange,
          it.rangeLow, it.rangeHigh, it.elements, it.times);
}
template <class Archive>
void visit(Archive& archive, LoopRecord& it) {
  archive(it.condition, it.runs, it.unfinished, it.longest);
}
template <class Archive>
void visit(Archive& archive, Path& it) {
  archive(it.call, it.kernel, it.output, it.elements);
}
template <class Archive>
void visit(Archive& archive, ExceptionRecord& it) {
  archive(it.kind, it.kernel, it.elements, it.isInReference, it.first, it.path);
}
template <class Archive>
void visit(Archive& archive, DecisionRecord& it) {
  archive(it.kernel, it.elements, it.isInherited, it.first, it.ofKeys);
}
template <class Archive>
void visit(Archive& archive, Report& it) {
  archive(it.program, it.device, it.rank, it.programSeconds, it.deviceSeconds, it.referenceSeconds,
          it.comparisonSeconds, it.calls, it.followed, it.kernels, it.streams, it.results, it.exceptions,
          it.decisions, it.given, it.loops, it.notes);
}

/// A file that no other process uses while this object lives.
class LockedFile {
 public:
  explicit LockedFile(const std::string& name)
      : name_(name), file_(::open(name.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666)) {
    if (file_ < 0 || ::flock(file_, LOCK_EX) != 0) fail();
  }
  ~LockedFile() { ::close(file_); }
  LockedFile(const LockedFile&) = delete;
  LockedFile& operator=(const LockedFile&) = delete;

  std::string read() const {
    std::string bytes;
    char part[65536];
    while (true) {
      const ssize_t count = ::read(file_, part, sizeof part);
      if (count == 0) return bytes;
      if (count < 0 && errno != EINTR) fail();
      if (count > 0) bytes.append(part, static_cast<std::size_t>(count));
    }
  }
  void append(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t count = ::write(file_, bytes.data(), bytes.size());
      if (count < 0 && errno != EINTR) fail();
      if (count > 0) bytes.remove_prefix(static_cast<std::size_t>(count));
    }
  }

 private:
  [[noreturn]] void fail() const {
    throw Error(fmt::format("cannot use '{}': {}", name_, std::strerror(errno)), Error::Kind::File);
  }

  std::string name_;
  int file_;
};

}  // namespace

RankOfProcess rankOfProcess() {
  constexpr const char* variables[][2] = {{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"},
                                          {"PMI_RANK", "PMI_SIZE"},
                                          {"SLURM_PROCID", "SLURM_NTASKS"}};
  for (const auto& [rank, ranks] : variables) {
    const char *const number = std::getenv(rank), *const count = std::getenv(ranks);
    if (number == nullptr || count == nullptr) continue;
    const RankOfProcess found{std::atoi(number), std::atoi(count)};
    if (found.ranks > 1 && found.rank >= 0 && found.rank < found.ranks) return found;
  }
  return {};
}

void addToRanks(const std::string& file, const Report& report,
                const std::function<void(std::vector<Report>)>& use) {
  const LockedFile locked(file);
  Writer writer;
  writer(report);
  const std::string bytes = locked.read() + writer.bytes;
  std::vector<Report> reports;
  Reader reader(bytes);
  while (!reader.isAtEnd()) reader(reports.emplace_back());
  if (reports.size() < static_cast<std::size_t>(report.ranks)) {
    locked.append(writer.bytes);
  } else {
    ::unlink(file.c_str());
  }
  use(std::move(reports));
}

namespace {

/// The record of this name, which exists then.
template <class Record>
Record& recordNamed(std::vector<Record>& records, const Record& like) {
  const auto found = std::ranges::find(records, like.name, &Record::name);
  if (found != records.end()) return *found;
  Record& made = records.emplace_back();
  made.name = like.name;
  return made;
}

void addSeries(Series& to, const Series& from) {
  if (to.points().empty()) {
    to = from;
  } else {
    to.raise(from);
  }
}

void add(KernelRecord& to, const KernelRecord& from) {
  to.calls += from.calls;
  to.followed += from.followed;
  to.seconds += from.seconds;
  for (auto spread : {&KernelRecord::own, &KernelRecord::storage, &KernelRecord::inherited,
                      &KernelRecord::total, &KernelRecord::amplification})
    (to.*spread).add(from.*spread);
  if (from.worstError > to.worstError) {
    to.worstError = from.worstError;
    to.worst = from.worst;
  }
  to.nans += from.nans;
  to.infinities += from.infinities;
  to.flushed += from.flushed;
  to.decisions += from.decisions;
  to.ownSquares += from.ownSquares;
  to.storedSquares += from.storedSquares;
  if (to.stored.empty()) {
    to.stored = from.stored;
    to.storedBetter = from.storedBetter;
  }
  to.readFrom.insert(to.readFrom.end(), from.readFrom.begin(), from.readFrom.end());
  to.compensates = to.compensates || from.compensates;
  if (to.choices.empty()) to.choices = from.choices;
  for (const OutputRecord& output : from.outputs) {
    OutputRecord& record = recordNamed(to.outputs, output);
    record.type = output.type;
    addSeries(record.points, output.points);
    record.unreadCalls += output.unreadCalls;
    record.unreadSeconds += output.unreadSeconds;
  }
}

void add(StreamRecord& to, const StreamRecord& from) {
  to.type = from.type;
  to.shape = from.shape;
  to.resyncs += from.resyncs;
  addSeries(to.points, from.points);
  to.unread += from.unread;
  to.written += from.written;
  to.unreadSeconds += from.unreadSeconds;
}

void add(ResultRecord& to, const ResultRecord& from) {
  to.isValue = from.isValue;
  to.reads += from.reads;
  to.elements += from.elements;
  to.differs += from.differs;
  to.notFinite += from.notFinite;
  to.withoutValue += from.withoutValue;
  to.numbers += from.numbers;
  to.shares.add(from.shares, std::fmin(1, from.last));
  to.largest = std::fmax(to.largest, from.largest);
  to.last = std::fmax(to.last, from.last);
}

void addGiven(Report& to, const GivenRecord& from) {
  const auto found = std::ranges::find_if(to.given, [&](const GivenRecord& each) {
    return each.kernel == from.kernel && each.parameter == from.parameter;
  });
  if (found == to.given.end()) return to.given.push_back(from);
  found->low = std::fmin(found->low, from.low);
  found->high = std::fmax(found->high, from.high);
  found->elements = std::max(found->elements, from.elements);
  found->times = std::max(found->times, from.times);
}

/// Ranks run their loops together.
void addLoop(Report& to, const LoopRecord& from) {
  const auto found = std::ranges::find(to.loops, from.condition, &LoopRecord::condition);
  if (found == to.loops.end()) return to.loops.push_back(from);
  found->runs = std::max(found->runs, from.runs);
  found->unfinished = std::max(found->unfinished, from.unfinished);
  found->longest = std::max(found->longest, from.longest);
}

}  // namespace

Report merged(std::vector<Report> reports) {
  std::ranges::sort(reports, {}, &Report::rank);
  Report all;
  all.program = reports.front().program;
  all.device = reports.front().device;
  all.ranks = static_cast<int>(reports.size());
  for (Report& report : reports) {
    std::vector<int> numbers;  // of its kernels, among all
    for (const KernelRecord& kernel : report.kernels) {
      recordNamed(all.kernels, kernel);
      numbers.push_back(static_cast<int>(std::ranges::find(all.kernels, kernel.name, &KernelRecord::name) -
                                         all.kernels.begin()));
    }
    const auto numberOf = [&](int kernel) {
      return kernel < 0 ? kernel : numbers[static_cast<std::size_t>(kernel)];
    };
    for (KernelRecord& kernel : report.kernels) {
      std::ranges::transform(kernel.readFrom, kernel.readFrom.begin(), numberOf);
      add(recordNamed(all.kernels, kernel), kernel);
    }
    for (ResultRecord& result : report.results) {
      result.shares = result.shares.renumbered(numberOf);
      add(recordNamed(all.results, result), result);
    }
    for (const StreamRecord& stream : report.streams) add(recordNamed(all.streams, stream), stream);
    for (ExceptionRecord& exception : report.exceptions) {
      exception.kernel = numberOf(exception.kernel);
      for (Path& step : exception.path) step.kernel = numberOf(step.kernel);
      all.exceptions.push_back(exception);
    }
    for (DecisionRecord& decision : report.decisions) {
      decision.kernel = numberOf(decision.kernel);
      all.decisions.push_back(decision);
    }
    for (GivenRecord& given : report.given) {
      given.kernel = numberOf(given.kernel);
      addGiven(all, given);
    }
    for (const LoopRecord& loop : report.loops) addLoop(all, loop);
    for (const std::string& note : report.notes) {
      if (std::ranges::find(all.notes, note) == all.notes.end()) all.notes.push_back(note);
    }
    all.programSeconds = std::fmax(all.programSeconds, report.programSeconds);
    all.deviceSeconds += report.deviceSeconds;
    all.referenceSeconds += report.referenceSeconds;
    all.comparisonSeconds += report.comparisonSeconds;
    all.calls += report.calls;
    all.followed += report.followed;
  }
  for (ResultRecord& result : all.results) result.shares.normalize();
  std::ranges::stable_sort(all.exceptions, {}, [](const ExceptionRecord& each) { return each.first.call; });
  std::ranges::stable_sort(all.decisions, {}, [](const DecisionRecord& each) { return each.first.call; });
  return all;
}

}  // namespace sk::shadow
