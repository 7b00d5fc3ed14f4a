// SPDX-License-Identifier: MIT
//
// A run that saves its state, and then goes wrong on one rank. Usage: mpi_faults WAY FILE
#include <chrono>
#include <filesystem>
#include <stdexcept>
#include <string_view>
#include <thread>

#include "files.sk.hpp"
#include "sk/mpi.hpp"

namespace {

bool breaksMpi = false;

int simulate(std::string_view way, const std::string& file) {
  sk::Domain domain(MPI_COMM_WORLD, {.shape = {24, 8}, .periodic = {true, true}});
  auto u = domain.stream<float>();
  u.fill(1.0F);
  auto again = domain.stream<Particle>();
  age(again, again);  // compared before
  for (int step = 1; step <= 20; ++step) {
    diffuse(0.2F, u, u);
    if (step % 4 == 0) u.save(file);
    if (step != 10 || domain.rank() != domain.ranks() - 1) continue;
    if (way == "throws") throw std::runtime_error("step 10 went wrong");
    if (way == "loses") throw sk::Error("the device was lost", sk::Error::Kind::Lost);  // as any call does
    if (way == "leaves") throw 10;
    if (way == "parts") age(again, again);  // needs no message
    if (way == "sleeps") std::this_thread::sleep_for(std::chrono::seconds(2));
    if (way == "breaks") breaksMpi = true;
  }
  return way == "fails" ? 3 : 0;
}

}  // namespace

/// As the ranks are compared.
extern "C" int MPI_Iallreduce(const void* from, void* to, int count, MPI_Datatype type, MPI_Op op,
                              MPI_Comm all, MPI_Request* request) {
  return breaksMpi ? MPI_ERR_OTHER : PMPI_Iallreduce(from, to, count, type, op, all, request);
}

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  return sk::mpi::run(argc, argv, [&] { return simulate(argv[1], argv[2]); });
}
