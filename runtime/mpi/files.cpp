// SPDX-License-Identifier: MIT
//
// A domain's stream in a .npy file, which all ranks write and read together by MPI-IO. A file under its own name is always
// whole: it is written under another one and renamed at the end.
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "agreement.hpp"
#include "call_details.hpp"
#include "device/stream_state.hpp"
#include "domain_state.hpp"
#include "sk/error.hpp"
#include "support/npy_header.hpp"

namespace sk {

namespace {

namespace fs = std::filesystem;

/// The bytes of one collective write or read, at most.
constexpr std::size_t pieceBytes = std::size_t{1} << 30;

std::string textOf(int status) {
  char text[MPI_MAX_ERROR_STRING] = {};
  int length = 0;
  MPI_Error_string(status, text, &length);
  return text;
}

/// A step of saving or loading.
mpi::Call stepOf(std::string_view what) {
  mpi::Hash hash;
  hash.add(what);
  return {what, hash.value()};
}

[[noreturn]] void failForFile(const std::string& text) { throw Error(text, Error::Kind::File); }

/// The place of this rank's elements among all of a file.
class FileView {
 public:
  FileView(const DomainState& domain, std::size_t bytes)
      : element_(
            "a file",
            [&](MPI_Datatype* type) { return MPI_Type_contiguous(static_cast<int>(bytes), MPI_BYTE, type); }),
        part_("a file", [&](MPI_Datatype* type) { return makePart(domain, type); }) {}

  MPI_Datatype element() const { return element_; }
  MPI_Datatype part() const { return part_; }

 private:
  int makePart(const DomainState& domain, MPI_Datatype* type) const {
    const Shape& whole = domain.parts.whole();
    int extents[maxRank], own[maxRank], begin[maxRank];
    for (int d = 0; d < whole.rank(); ++d) {
      extents[d] = static_cast<int>(whole[d]);
      own[d] = static_cast<int>(domain.own.end[d] - domain.own.begin[d]);
      begin[d] = static_cast<int>(domain.own.begin[d]);
    }
    return MPI_Type_create_subarray(whole.rank(), extents, own, begin, MPI_ORDER_C, element_, type);
  }

  mpi::Datatype element_, part_;
};

/// A file of MPI that is closed, which is collective.
class FileHandle {
 public:
  FileHandle() = default;
  ~FileHandle() {
    if (file_ != MPI_FILE_NULL) MPI_File_close(&file_);
  }
  FileHandle(const FileHandle&) = delete;
  FileHandle& operator=(const FileHandle&) = delete;
  operator MPI_File() const { return file_; }

  int open(MPI_Comm communicator, const std::string& name, int mode) {
    return MPI_File_open(communicator, name.c_str(), mode, MPI_INFO_NULL, &file_);
  }
  int close() {
    const int status = MPI_File_close(&file_);
    file_ = MPI_FILE_NULL;
    return status;
  }
  bool isOpen() const { return file_ != MPI_FILE_NULL; }
  /// Some ranks have not opened the file: the others would wait for them in
  /// MPI_File_close.
  void leaveOpen() { file_ = MPI_FILE_NULL; }

 private:
  MPI_File file_ = MPI_FILE_NULL;
};

/// A file that this rank alone has opened.
class OwnFile {
 public:
  OwnFile(const std::string& name, int flags) : file_(::open(name.c_str(), flags | O_CLOEXEC, 0666)) {}
  ~OwnFile() {
    if (file_ >= 0) ::close(file_);
  }
  OwnFile(const OwnFile&) = delete;
  OwnFile& operator=(const OwnFile&) = delete;

  bool isOpen() const { return file_ >= 0; }
  /// Brings to the disk what this host has written of the file. Returns false, and sets errno, if it cannot.
  bool sync() const { return ::fsync(file_) == 0; }

 private:
  int file_;
};

/// A file that all ranks have opened.
class SharedFile {
 public:
  enum class Use : bool { Write, Read };

  /// Collective, as all functions.
  SharedFile(const DomainState& domain, const std::string& name, Use use)
      : domain_(domain), name_(name), what_(use == Use::Write ? "write" : "read") {
    domain_.agreement.together(stepOf("opening a file"), [&] { openAlone(use); });
    const int mode = use == Use::Write ? MPI_MODE_CREATE | MPI_MODE_WRONLY : MPI_MODE_RDONLY;
    const int status = handle_.open(domain.communicator, name, mode);
    if (domain.agreement.most(handle_.isOpen() ? 0 : 1) != 0) handle_.leaveOpen();
    check(status);
  }

  /// Empties the file first: an earlier attempt may have left a part.
  void writeHeader(const std::string& header) {
    check(MPI_File_set_size(handle_, 0));
    MPI_Status status;
    int error = MPI_SUCCESS, wanted = 0, done = 0;
    if (domain_.rank == 0) {
      wanted = static_cast<int>(header.size());
      error = MPI_File_write_at(handle_, 0, header.data(), wanted, MPI_BYTE, &status);
      if (error == MPI_SUCCESS) MPI_Get_count(&status, MPI_BYTE, &done);
    }
    domain_.agreement.together(stepOf(what_), [&] { checkTransfer(error, wanted, done); });
  }

  /// Writes or reads this rank's elements, behind the header. `transfer` is MPI_File_write_all or MPI_File_read_all.
  template <class Transfer>
  void each(std::size_t offset, std::size_t elementBytes, std::byte* bytes, std::size_t count,
            Transfer transfer) {
    std::optional<FileView> view;
    domain_.agreement.together(stepOf("a view of a file"), [&] { view.emplace(domain_, elementBytes); });
    check(MPI_File_set_view(handle_, static_cast<MPI_Offset>(offset), view->element(), view->part(), "native",
                            MPI_INFO_NULL));
    const std::size_t most = std::max<std::size_t>(pieceBytes / elementBytes, 1);
    const std::uint64_t all = domain_.agreement.most((count + most - 1) / most);
    mpi::Refusal refusal;  // of one piece: those after it are transferred with the other ranks
    for (std::size_t piece = 0; piece < all; ++piece) {
      const std::size_t begin = std::min(piece * most, count);
      const int wanted = static_cast<int>(std::min(most, count - begin));
      MPI_Status status;
      const int result =
          transfer(handle_, bytes + begin * elementBytes, wanted, view->element(), &status);
      int done = 0;
      if (result == MPI_SUCCESS) MPI_Get_count(&status, view->element(), &done);
      if (refusal) continue;
      refusal = mpi::caught("a file", [&] { checkTransfer(result, wanted, done); });
    }
    domain_.agreement.agree(stepOf(what_), refusal);
  }

  /// Throws if what was written cannot be stored. Not by MPI_File_sync: where a write has failed on one rank alone, Open MPI's returns
  /// there without waiting for the other ranks, which then wait in MPI_File_close for ever.
  void close(bool wasWritten) {
    const int closed = handle_.close();
    domain_.agreement.together(stepOf(what_), [&] {
      if (closed != MPI_SUCCESS) failForFile(message(closed));
      if (wasWritten && !alone_->sync()) failWithReason();
    });
  }

 private:
  /// Opens the file on this rank alone: MPI may wait for ever where only some
  /// ranks can. It stays open, so that sync() hears of all errors from now on.
  void openAlone(Use use) {
    alone_.emplace(name_, use == Use::Write ? O_WRONLY | O_CREAT : O_RDONLY);
    if (!alone_->isOpen()) failWithReason();
  }
  [[noreturn]] void failWithReason() const {
    failForFile(fmt::format("cannot {} '{}': {}", what_, name_, std::strerror(errno)));
  }
  /// Throws unless MPI has transferred all of `wanted` elements.
  void checkTransfer(int status, int wanted, int done) const {
    if (status != MPI_SUCCESS) failForFile(message(status));
    if (done == wanted) return;
    failForFile(
        fmt::format("cannot {} '{}': only a part of the elements went through; {}", what_, name_, hint()));
  }
  std::string hint() const {
    return std::strcmp(what_, "write") == 0 ? "is the disk full?" : "is the file being written?";
  }
  std::string message(int status) const {
    return fmt::format("cannot {} '{}': {}", what_, name_, textOf(status));
  }
  void check(int status) {
    domain_.agreement.together(stepOf(what_), [&] {
      if (status != MPI_SUCCESS) failForFile(message(status));
    });
  }

  const DomainState& domain_;
  const std::string& name_;
  const char* what_;
  std::optional<OwnFile> alone_;
  FileHandle handle_;
};

/// Whether a file has doubles for floats, because the stream has.
bool hasDoubles(const StreamRegion& region) { return region.stream->storage >= Storage::Extended; }

std::vector<std::byte> bytesOfOwn(const StreamRegion& own, std::size_t elementBytes) {
  const auto count = static_cast<std::size_t>(own.shape.size());
  auto bytes = detail::hostVector<std::byte>(count * elementBytes);
  if (hasDoubles(own)) {
    const std::vector<double> values = detail::readReals(own);
    std::memcpy(bytes.data(), values.data(), bytes.size());
  } else {
    detail::read(own, bytes.data(), count);
  }
  return bytes;
}

std::size_t sizeOf(const Shape& whole) { return static_cast<std::size_t>(whole.size()); }

/// Gives a file that has been written its name, if it has as many bytes as it
/// should.
void finish(const std::string& partial, const std::string& file, std::size_t bytes) {
  std::error_code error;
  const auto held = fs::file_size(partial, error);
  if (!error && held != bytes) {
    failForFile(
        fmt::format("cannot write '{}': {} of its {} bytes are there; is the disk full?", file, held, bytes));
  }
  if (!error) fs::rename(partial, file, error);
  if (error) failForFile(fmt::format("cannot write '{}': {}", file, error.message()));
}

/// Why the elements of a file cannot be those of the stream; empty if they can.
/// `bytes` are those of all elements; sets the `offset` at which they begin.
std::string mismatch(const std::string& file, const npy::NpyArray& wanted, std::size_t bytes,
                     std::size_t& offset) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return fmt::format("cannot read '{}': {}", file, std::strerror(errno));
  std::string header(npy::npyPrefix, '\0');
  in.read(header.data(), static_cast<std::streamsize>(header.size()));
  offset = npy::npyHeaderLength(header.substr(0, static_cast<std::size_t>(in.gcount())));
  constexpr std::size_t longest = 1 << 20;
  if (offset <= npy::npyPrefix || offset > longest)
    return fmt::format("'{}' is no .npy file; DomainStream::save writes one", file);
  header.resize(offset);
  in.read(header.data() + npy::npyPrefix, static_cast<std::streamsize>(offset - npy::npyPrefix));
  if (!in) return fmt::format("'{}' ends in its header", file);
  npy::NpyArray array;
  if (const std::string wrong = npy::parseNpyHeader(header, array); !wrong.empty())
    return fmt::format("'{}': {}", file, wrong);
  if (array.type != wanted.type)
    return fmt::format("'{}' has elements of type {}, but the stream's are {}", file, array.type,
                       wanted.type);
  if (array.extents != wanted.extents) {
    return fmt::format("'{}' has shape {}, but the stream has {}", file, npy::npyShape(array.extents),
                       npy::npyShape(wanted.extents));
  }
  in.seekg(0, std::ios::end);
  const auto held = static_cast<std::uint64_t>(in.tellg());
  if (held < offset + bytes) {
    return fmt::format("'{}' is truncated: it has {} bytes, but its header says {}", file, held,
                       offset + bytes);
  }
  return {};
}

}  // namespace

void detail::save(DomainStreamState* stream, const std::string& file) {
  const DomainState& domain = *liveStream(stream, "save").domain;
  mpi::Agreement& agreement = domain.agreement;
  const StreamRegion own = stream->part(domain.own);
  std::size_t size = 0;
  std::string header, partial;
  std::vector<std::byte> bytes;
  agreement.count();
  agreement.together(mpi::StreamCall("save", *stream).with("file", file).call(), [&] {
    size = npy::elementBytes(stream->element, hasDoubles(own));
    header = npy::npyHeader(npy::npyArray(stream->element, domain.parts.whole(), hasDoubles(own)));
    bytes = bytesOfOwn(own, size);
    partial = file + ".partial";
  });
  try {
    SharedFile shared(domain, partial, SharedFile::Use::Write);
    shared.writeHeader(header);
    shared.each(header.size(), size, bytes.data(), static_cast<std::size_t>(own.shape.size()),
                [](MPI_File to, void* from, int count, MPI_Datatype type, MPI_Status* status) {
                  return MPI_File_write_all(to, from, count, type, status);
                });
    shared.close(true);
    agreement.together(stepOf("save"), [&] {
      if (domain.rank == 0) finish(partial, file, header.size() + sizeOf(domain.parts.whole()) * size);
    });
  } catch (...) {
    std::error_code ignored;
    if (domain.rank == 0) fs::remove(partial, ignored);
    throw;
  }
}

void detail::load(DomainStreamState* stream, const std::string& file) {
  const DomainState& domain = *liveStream(stream, "load").domain;
  mpi::Agreement& agreement = domain.agreement;
  const StreamRegion own = stream->part(domain.own);
  const auto count = static_cast<std::size_t>(own.shape.size());
  std::size_t offset = 0, size = 0;
  std::vector<std::byte> bytes;
  std::vector<double> values;
  agreement.count();
  agreement.together(mpi::StreamCall("load", *stream).with("file", file).call(), [&] {
    size = npy::elementBytes(stream->element, hasDoubles(own));
    const npy::NpyArray wanted = npy::npyArray(stream->element, domain.parts.whole(), hasDoubles(own));
    if (domain.rank == 0) {
      const std::string wrong = mismatch(file, wanted, sizeOf(domain.parts.whole()) * size, offset);
      if (!wrong.empty()) failForFile(wrong);
    }
    bytes = hostVector<std::byte>(count * size);
    if (hasDoubles(own)) values = hostVector<double>(bytes.size() / sizeof(double));
  });
  agreement.act("load", [&] { mpi::broadcast(domain.communicator, 0, &offset, sizeof offset); });
  {
    SharedFile shared(domain, file, SharedFile::Use::Read);
    shared.each(offset, size, bytes.data(), count,
                [](MPI_File from, void* to, int wantedCount, MPI_Datatype type, MPI_Status* status) {
                  return MPI_File_read_all(from, to, wantedCount, type, status);
                });
    shared.close(false);
  }
  agreement.together(stepOf("load"), [&] {
    if (hasDoubles(own)) std::memcpy(values.data(), bytes.data(), bytes.size());
    stream->writeOwn([&](const StreamRegion& target) {
      hasDoubles(own) ? writeReals(target, values) : write(target, bytes.data(), count);
    });
  });
}

}  // namespace sk
