// SPDX-License-Identifier: MIT
//
// Files of streams: what is saved is loaded with the same bits, by another number of ranks too; a run goes on from a file as if it
// had not stopped; and every fault of a file is an error on all ranks that leaves the older file alone.
#include <catch2/catch.hpp>

#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <sys/resource.h>

#include "error_of.hpp"
#include "files.sk.hpp"
#include "ranks.hpp"
#include "sk/mpi.hpp"

namespace {

namespace fs = std::filesystem;
using Catch::Contains;

/// A folder of this run, the same on all ranks.
class Folder {
 public:
  Folder() : path_(fs::temp_directory_path() / ("sk_mpi_files_" + std::to_string(number()))) {
    if (rankOfWorld() == 0) fs::create_directories(path_);
    MPI_Barrier(MPI_COMM_WORLD);
  }
  ~Folder() {
    MPI_Barrier(MPI_COMM_WORLD);
    std::error_code ignored;
    if (rankOfWorld() == 0) fs::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::string operator/(const char* file) const { return (path_ / file).string(); }

 private:
  static long number() {
    long process = ::getpid();
    MPI_Bcast(&process, 1, MPI_LONG, 0, MPI_COMM_WORLD);
    return process;
  }

  fs::path path_;
};

std::string bytesOf(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Changes a file on one rank, while the others wait.
template <class Change>
void onRank0(Change&& change) {
  MPI_Barrier(MPI_COMM_WORLD);
  if (rankOfWorld() == 0) change();
  MPI_Barrier(MPI_COMM_WORLD);
}

float start(const sk::Index& i) {
  return 0.37F * static_cast<float>(i[0] * i[0] % 11) - static_cast<float>(i[1] % 5);
}

constexpr std::array<bool, sk::maxRank> around = {true, true, true, true};

/// Some ranks of the world, with their own domain; null on the others.
class Some {
 public:
  explicit Some(int count) {
    const bool isIn = rankOfWorld() < count;
    MPI_Comm_split(MPI_COMM_WORLD, isIn ? 0 : MPI_UNDEFINED, rankOfWorld(), &communicator_);
  }
  ~Some() {
    if (communicator_ != MPI_COMM_NULL) MPI_Comm_free(&communicator_);
  }
  Some(const Some&) = delete;
  Some& operator=(const Some&) = delete;
  explicit operator bool() const { return communicator_ != MPI_COMM_NULL; }
  operator MPI_Comm() const { return communicator_; }

 private:
  MPI_Comm communicator_ = MPI_COMM_NULL;
};

}  // namespace

TEST_CASE("a run that goes on from a file, on other ranks, has the bits of one that did not stop") {
  const Folder folder;
  const sk::DomainOptions options{.shape = {13, 9}, .periodic = around};
  const auto steps = [](sk::DomainStream<float>& u, int count) {
    for (int step = 0; step < count; ++step) diffuse(0.21F, u, u);
  };
  sk::Domain domain(MPI_COMM_WORLD, options);
  auto u = domain.stream<float>();
  u.fill(start);
  steps(u, 3);
  u.save(folder / "u.npy");
  steps(u, 4);
  u.save(folder / "end.npy");
  const std::vector<float> end = everywhere(u.gather(0));
  for (int ranks = 1; ranks <= ranksOfWorld(); ++ranks) {
    const Some some(ranks);
    if (!some) continue;
    sk::Domain again(some, options);
    auto v = again.stream<float>();
    v.fill(-1.0F);
    v.load(folder / "u.npy");
    steps(v, 4);
    const std::vector<float> reached = v.gather(0);
    if (again.rank() == 0) CHECK(std::memcmp(reached.data(), end.data(), 4 * end.size()) == 0);
    v.save(folder / "again.npy");
    if (again.rank() == 0) CHECK(bytesOf(folder / "again.npy") == bytesOf(folder / "end.npy"));
  }
}

TEST_CASE("files have the header that NumPy writes, and elements in its order") {
  const Folder folder;
  sk::Domain domain(MPI_COMM_WORLD, {.shape = {7, 6}});
  auto u = domain.stream<float>();
  u.fill(start);
  u.save(folder / "u.npy");
  const std::string file = bytesOf(folder / "u.npy");
  REQUIRE(file.size() == 128 + 7 * 6 * 4);
  CHECK(file.substr(0, 8) == std::string("\x93NUMPY\x01\x00", 8));
  CHECK(file.substr(10, 118) ==
        "{'descr': '<f4', 'fortran_order': False, 'shape': (7, 6), }" + std::string(58, ' ') + "\n");
  float value = 0;
  std::memcpy(&value, file.data() + 128 + 4 * (5 * 6 + 3), 4);
  CHECK(value == start({5, 3}));
  CHECK_FALSE(fs::exists(folder / "u.npy.partial"));
}

TEST_CASE("elements of every kind come back, and say in the header what they are") {
  const Folder folder;
  sk::Domain domain(MPI_COMM_WORLD, {.shape = {8, 3}});
  const auto check = [&]<class T>(const T& value, const char* header) {
    auto a = domain.stream<T>(), b = domain.stream<T>();
    a.fill(value);
    a.save(folder / "a.npy");
    CHECK_THAT(bytesOf(folder / "a.npy").substr(0, 256), Contains(header));
    b.load(folder / "a.npy");
    b.save(folder / "b.npy");
    CHECK(bytesOf(folder / "a.npy") == bytesOf(folder / "b.npy"));
    return b.read().at(0);
  };
  CHECK(check(sk::float2{1.5F, -2}, "'descr': '<f4', 'fortran_order': False, 'shape': (8, 3, 2)").y == -2);
  CHECK(static_cast<float>(check(sk::half(0.5F), "'<f2'")) == 0.5F);
  CHECK(check(true, "'|b1'") != 0);
  CHECK(check(0.1, "'<f8'") == 0.1);
  const Particle particle{.at = {1, 2, 3}, .isHeavy = true, .mass = 0.1};
  const Particle loaded = check(particle, "[('at','<f4',(3,)),('isHeavy','|b1'),('','|V3'),('mass','<f8')]");
  CHECK((loaded.at.z == 3 && loaded.isHeavy && loaded.mass == 0.1));
}

TEST_CASE("floats that are stored in doubles keep all digits") {
  const Folder folder;
  sk::Domain domain(MPI_COMM_WORLD, {.shape = {8, 3}, .periodic = around});
  auto u = domain.stream<float>(sk::Storage::Double), v = domain.stream<float>(sk::Storage::Double);
  u.fill(start);
  for (int step = 0; step < 3; ++step) diffuse.with({.precision = sk::Precision::Double})(0.21F, u, u);
  u.save(folder / "u.npy");
  CHECK_THAT(bytesOf(folder / "u.npy").substr(0, 128), Contains("'<f8'"));
  v.load(folder / "u.npy");
  v.save(folder / "v.npy");
  CHECK(bytesOf(folder / "u.npy") == bytesOf(folder / "v.npy"));
}

TEST_CASE("files that do not fit are refused on all ranks, with the reason") {
  const Folder folder;
  sk::Domain domain(MPI_COMM_WORLD, {.shape = {8, 3}});
  auto u = domain.stream<float>();
  u.fill(start);
  const std::vector<float> before = u.read();
  const std::string file = folder / "u.npy";
  const auto refuses = [&](const char* why) {
    try {
      u.load(file);
      FAIL("it was loaded");
    } catch (const sk::Error& error) {
      CHECK_THAT(error.what(), Contains(why) && Contains(file));
      CHECK(error.kind() == sk::Error::Kind::File);
    }
    CHECK(u.read() == before);
  };
  refuses("cannot read");
  onRank0([&] { std::ofstream(file) << "step,mean\n0,1\n"; });
  refuses("is no .npy file");
  onRank0([&] { std::ofstream(file).close(); });
  refuses("is no .npy file");
  u.save(file);
  onRank0([&] { fs::resize_file(file, 100); });
  refuses("ends in its header");
  u.save(file);
  onRank0([&] { fs::resize_file(file, fs::file_size(file) - 4); });
  refuses("is truncated: it has 220 bytes, but its header says 224");
  auto d = domain.stream<double>();
  d.fill(1.0);
  d.save(file);
  refuses("has elements of type '<f8', but the stream's are '<f4'");
  sk::Domain other(MPI_COMM_WORLD, {.shape = {8, 4}});
  auto w = other.stream<float>();
  w.fill(1.0F);
  w.save(file);
  refuses("has shape (8, 4), but the stream has (8, 3)");
  onRank0([&] {
    std::fstream out(file, std::ios::in | std::ios::out | std::ios::binary);
    out.seekp(10);
    out << "{'descr': '<f4', 'fortran_order': True,  'shape': (8, 3), }";
  });
  refuses("Fortran's order");
}

TEST_CASE("a file that cannot be written leaves the older one whole") {
  const Folder folder;
  sk::Domain domain(MPI_COMM_WORLD, {.shape = {64, 64}});
  auto u = domain.stream<float>();
  u.fill(start);
  const std::string file = folder / "u.npy";
  u.save(file);
  const std::string before = bytesOf(file);
  CHECK_THAT(errorOf([&] { u.save(folder / "none/u.npy"); }),
             Contains("cannot write") && Contains("none/u.npy"));
  // A limit of the operating system in the place of a full disk.
  u.fill(2.0F);
  rlimit limit{};
  ::getrlimit(RLIMIT_FSIZE, &limit);
  const rlimit little{.rlim_cur = 4096, .rlim_max = limit.rlim_max};
  std::signal(SIGXFSZ, SIG_IGN);
  ::setrlimit(RLIMIT_FSIZE, &little);
  const std::string error = errorOf([&] { u.save(file); });
  ::setrlimit(RLIMIT_FSIZE, &limit);
  CHECK_THAT(error, Contains("cannot write") && Contains("u.npy"));
  MPI_Barrier(MPI_COMM_WORLD);
  CHECK(bytesOf(file) == before);
  CHECK_FALSE(fs::exists(file + ".partial"));
  u.save(file);  // and it can be written afterwards
  CHECK(bytesOf(file) != before);
}

TEST_CASE("components are gathered and scattered in the precision in which they are stored") {
  sk::Domain domain(MPI_COMM_WORLD, {.shape = {7, 6}});
  auto u = domain.stream<sk::float2>(sk::Storage::Double);
  std::vector<double> given;
  for (int k = 0; domain.rank() == 0 && k < 2 * 7 * 6; ++k) given.push_back(1.0 / (k + 3));
  u.scatterReals(given);
  CHECK(u.gatherReals() == given);
  CHECK(u.gather().empty() == (domain.rank() != 0));
  const int last = domain.ranks() - 1;
  CHECK(u.gatherReals(last).size() == (domain.rank() == last ? 84U : 0U));
  CHECK_THAT(errorOf([&] { u.scatterReals(std::vector<double>(5)); }),
             Contains("5 component(s) are given on rank 0, but 42 elements of shape {7, 6} have 84"));
  CHECK_THAT(errorOf([&] { (void)u.gatherReals(domain.ranks()); }),
             Contains("gatherReals: there is no rank"));
  auto numbers = domain.stream<int>();
  numbers.fill(3);
  CHECK_THAT(errorOf([&] { (void)numbers.gatherReals(); }), Contains("readReals"));
}

// Some ranks write for others, so that a fault of those alone is one of the file.
TEST_CASE("a file that one rank alone cannot write is refused by all, which go on together") {
  const Folder folder;
  sk::Domain domain(MPI_COMM_WORLD, {.shape = {64, 64}});
  auto u = domain.stream<float>(), v = domain.stream<float>();
  u.fill(start);
  const std::string file = folder / "u.npy";
  rlimit limit{};
  ::getrlimit(RLIMIT_FSIZE, &limit);
  std::signal(SIGXFSZ, SIG_IGN);
  int refusals = 0;
  for (const rlim_t most : {64, 4096}) {  // a part of the header, and of the elements
    for (int victim = 0; victim < domain.ranks(); ++victim) {
      const rlimit little{.rlim_cur = most, .rlim_max = limit.rlim_max};
      if (domain.rank() == victim) ::setrlimit(RLIMIT_FSIZE, &little);
      const std::string error = errorOf([&] { u.save(file); });
      ::setrlimit(RLIMIT_FSIZE, &limit);
      int thrown = error == "no error" ? 0 : 1;
      MPI_Allreduce(MPI_IN_PLACE, &thrown, 1, MPI_INT, MPI_SUM, MPI_COMM_WORLD);
      CHECK((thrown == 0 || thrown == domain.ranks()));
      if (thrown != 0) CHECK_THAT(error, Contains("cannot write") && Contains("u.npy"));
      refusals += thrown != 0 ? 1 : 0;
      u.save(file);
      v.load(file);
      CHECK(v.read() == u.read());
    }
  }
  CHECK(refusals >= 2);
}
