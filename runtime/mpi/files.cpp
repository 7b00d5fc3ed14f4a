// SPDX-License-Identifier: MIT
//
// A domain's stream in a .npy file, which all ranks write and read together by MPI-IO. A file under its own name is always
// whole: it is written under another one and renamed at the end.
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include "device/stream_state.hpp"
#include "domain_state.hpp"
#include "npy.hpp"
#include "sk/error.hpp"

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

/// Collective: throws on all ranks what the first rank that has an error says.
void agree(const DomainState& domain, const std::string& error) {
  int mine = error.empty() ? std::numeric_limits<int>::max() : domain.rank, first = 0;
  mpi::check(MPI_Allreduce(&mine, &first, 1, MPI_INT, MPI_MIN, domain.communicator), "a file");
  if (first == std::numeric_limits<int>::max()) return;
  char text[1024] = {};
  error.copy(text, sizeof text - 1);
  mpi::broadcast(domain.communicator, first, text, sizeof text);
  throw Error(domain.parts.ranks() == 1 ? text : fmt::format("{} (rank {})", text, first), Error::Kind::File);
}

/// The place of this rank's elements among all of a file.
class FileView {
 public:
  FileView(const DomainState& domain, std::size_t bytes) {
    const Shape& whole = domain.parts.whole();
    int extents[maxRank], own[maxRank], begin[maxRank];
    for (int d = 0; d < whole.rank(); ++d) {
      extents[d] = static_cast<int>(whole[d]);
      own[d] = static_cast<int>(domain.own.end[d] - domain.own.begin[d]);
      begin[d] = static_cast<int>(domain.own.begin[d]);
    }
    MPI_Type_contiguous(static_cast<int>(bytes), MPI_BYTE, &element_);
    MPI_Type_commit(&element_);
    MPI_Type_create_subarray(whole.rank(), extents, own, begin, MPI_ORDER_C, element_, &part_);
    MPI_Type_commit(&part_);
  }
  ~FileView() {
    MPI_Type_free(&part_);
    MPI_Type_free(&element_);
  }
  FileView(const FileView&) = delete;
  FileView& operator=(const FileView&) = delete;

  MPI_Datatype element() const { return element_; }
  MPI_Datatype part() const { return part_; }

 private:
  MPI_Datatype element_ = MPI_DATATYPE_NULL, part_ = MPI_DATATYPE_NULL;
};

/// A file that all ranks have opened.
class SharedFile {
 public:
  SharedFile(const DomainState& domain, const std::string& name, int mode, const char* what)
      : domain_(domain), name_(name), what_(what) {
    const int status = MPI_File_open(domain.communicator, name.c_str(), mode, MPI_INFO_NULL, &file_);
    check(status);
  }
  ~SharedFile() {
    if (file_ != MPI_FILE_NULL) MPI_File_close(&file_);
  }
  SharedFile(const SharedFile&) = delete;
  SharedFile& operator=(const SharedFile&) = delete;

  /// Collective.
  void writeHeader(const std::string& header) {
    check(MPI_File_set_size(file_, 0));  // of an older attempt
    MPI_Status status;
    int error = MPI_SUCCESS;
    if (domain_.rank == 0) {
      error = MPI_File_write_at(file_, 0, header.data(), static_cast<int>(header.size()), MPI_BYTE, &status);
    }
    check(error);
  }

  /// Writes or reads this rank's elements, behind the header. `transfer` is MPI_File_write_all or MPI_File_read_all.
  template <class Transfer>
  void each(std::size_t offset, std::size_t elementBytes, std::byte* bytes, std::size_t count,
            Transfer transfer) {
    const FileView view(domain_, elementBytes);
    check(MPI_File_set_view(file_, static_cast<MPI_Offset>(offset), view.element(), view.part(), "native",
                            MPI_INFO_NULL));
    const std::size_t most = std::max<std::size_t>(pieceBytes / elementBytes, 1);
    unsigned long long pieces = (count + most - 1) / most, all = 0;
    mpi::check(MPI_Allreduce(&pieces, &all, 1, MPI_UNSIGNED_LONG_LONG, MPI_MAX, domain_.communicator),
               "a file");
    std::string error;
    for (std::size_t piece = 0; piece < all; ++piece) {
      const std::size_t begin = std::min(piece * most, count);
      const int wanted = static_cast<int>(std::min(most, count - begin));
      MPI_Status status;
      const int result = transfer(file_, bytes + begin * elementBytes, wanted, view.element(), &status);
      int done = 0;
      if (result == MPI_SUCCESS) MPI_Get_count(&status, view.element(), &done);
      if (!error.empty()) continue;
      if (result != MPI_SUCCESS) {
        error = message(result);
      } else if (done != wanted) {
        error =
            fmt::format("cannot {} '{}': only a part of the elements went through; {}", what_, name_, hint());
      }
    }
    agree(domain_, error);
  }

  /// Collective. Throws if what was written cannot be stored.
  void close(bool wasWritten) {
    const int stored = wasWritten ? MPI_File_sync(file_) : MPI_SUCCESS;
    const int closed = MPI_File_close(&file_);
    file_ = MPI_FILE_NULL;
    check(stored != MPI_SUCCESS ? stored : closed);
  }

 private:
  std::string hint() const {
    return std::strcmp(what_, "write") == 0 ? "is the disk full?" : "is the file being written?";
  }
  std::string message(int status) const {
    return fmt::format("cannot {} '{}': {}", what_, name_, textOf(status));
  }
  void check(int status) { agree(domain_, status == MPI_SUCCESS ? "" : message(status)); }

  const DomainState& domain_;
  const std::string name_;
  const char* what_;
  MPI_File file_ = MPI_FILE_NULL;
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

/// Gives a file that has been written its name, if it has as many bytes as it should. Returns "" or what went wrong.
std::string finish(const std::string& partial, const std::string& file, std::size_t bytes) {
  std::error_code error;
  const auto held = fs::file_size(partial, error);
  if (error) return fmt::format("cannot write '{}': {}", file, error.message());
  if (held != bytes) {
    return fmt::format("cannot write '{}': {} of its {} bytes are there; is the disk full?", file, held,
                       bytes);
  }
  fs::rename(partial, file, error);
  return error ? fmt::format("cannot write '{}': {}", file, error.message()) : std::string();
}

/// Why the elements of a file cannot be those of the stream; empty if they can.
/// `bytes` are those of all elements; sets the `offset` at which they begin.
std::string mismatch(const std::string& file, const mpi::NpyArray& wanted, std::size_t bytes,
                     std::size_t& offset) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return fmt::format("cannot read '{}': {}", file, std::strerror(errno));
  std::string header(mpi::npyPrefix, '\0');
  in.read(header.data(), static_cast<std::streamsize>(header.size()));
  offset = mpi::npyHeaderLength(header.substr(0, static_cast<std::size_t>(in.gcount())));
  constexpr std::size_t longest = 1 << 20;
  if (offset <= mpi::npyPrefix || offset > longest)
    return fmt::format("'{}' is no .npy file; DomainStream::save writes one", file);
  header.resize(offset);
  in.read(header.data() + mpi::npyPrefix, static_cast<std::streamsize>(offset - mpi::npyPrefix));
  if (!in) return fmt::format("'{}' ends in its header", file);
  mpi::NpyArray array;
  if (const std::string wrong = mpi::parseNpyHeader(header, array); !wrong.empty())
    return fmt::format("'{}': {}", file, wrong);
  if (array.type != wanted.type)
    return fmt::format("'{}' has elements of type {}, but the stream's are {}", file, array.type,
                       wanted.type);
  if (array.extents != wanted.extents) {
    return fmt::format("'{}' has shape {}, but the stream has {}", file, mpi::npyShape(array.extents),
                       mpi::npyShape(wanted.extents));
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
  const StreamRegion own = stream->part(domain.own);
  const std::size_t size = mpi::elementBytes(stream->element, hasDoubles(own));
  const std::string header =
      mpi::npyHeader(mpi::npyArray(stream->element, domain.parts.whole(), hasDoubles(own)));
  std::vector<std::byte> bytes = bytesOfOwn(own, size);
  const std::string partial = file + ".partial";
  try {
    SharedFile shared(domain, partial, MPI_MODE_CREATE | MPI_MODE_WRONLY, "write");
    shared.writeHeader(header);
    shared.each(header.size(), size, bytes.data(), static_cast<std::size_t>(own.shape.size()),
                [](MPI_File to, void* from, int count, MPI_Datatype type, MPI_Status* status) {
                  return MPI_File_write_all(to, from, count, type, status);
                });
    shared.close(true);
    agree(domain,
          domain.rank == 0 ? finish(partial, file, header.size() + sizeOf(domain.parts.whole()) * size) : "");
  } catch (...) {
    std::error_code ignored;
    if (domain.rank == 0) fs::remove(partial, ignored);
    throw;
  }
}

void detail::load(DomainStreamState* stream, const std::string& file) {
  const DomainState& domain = *liveStream(stream, "load").domain;
  const StreamRegion own = stream->part(domain.own);
  const std::size_t size = mpi::elementBytes(stream->element, hasDoubles(own));
  const mpi::NpyArray wanted = mpi::npyArray(stream->element, domain.parts.whole(), hasDoubles(own));
  std::size_t offset = 0;
  agree(domain, domain.rank == 0 ? mismatch(file, wanted, sizeOf(domain.parts.whole()) * size, offset) : "");
  mpi::broadcast(domain.communicator, 0, &offset, sizeof offset);
  const auto count = static_cast<std::size_t>(own.shape.size());
  auto bytes = hostVector<std::byte>(count * size);
  {
    SharedFile shared(domain, file, MPI_MODE_RDONLY, "read");
    shared.each(offset, size, bytes.data(), count,
                [](MPI_File from, void* to, int wantedCount, MPI_Datatype type, MPI_Status* status) {
                  return MPI_File_read_all(from, to, wantedCount, type, status);
                });
    shared.close(false);
  }
  const StreamRegion target = ownRegion(stream, true);
  if (!hasDoubles(target)) return detail::write(target, bytes.data(), count);
  std::vector<double> values(bytes.size() / sizeof(double));
  std::memcpy(values.data(), bytes.data(), bytes.size());
  detail::writeReals(target, values);
}

}  // namespace sk
