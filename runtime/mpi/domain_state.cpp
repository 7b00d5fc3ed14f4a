// SPDX-License-Identifier: MIT
#include "domain_state.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include <fmt/format.h>

#include "hash.hpp"
#include "open_device.hpp"
#include "sk/error.hpp"
#include "sk/limits.hpp"

namespace sk {

using domain::Depth;

namespace {

/// A launcher that this program's MPI does not understand starts each process as a world of its own.
void checkLauncher(int ranks) {
  if (ranks > 1) return;
  for (const char* variable :
       {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "MPI_LOCALNRANKS", "SLURM_STEP_NUM_TASKS"}) {
    const char* const told = std::getenv(variable);
    if (told == nullptr || std::atoi(told) <= 1) continue;
    throw Error(
        fmt::format(
            "sk::Domain: the launcher has started {} processes ({}), but MPI sees 1 rank: this program was "
            "built with another MPI; start it with the mpirun of that MPI, or with srun --mpi=pmix",
            told, variable),
        Error::Kind::Misuse);
  }
}

MPI_Comm duplicated(MPI_Comm communicator) {
  int isThere = 0;
  MPI_Initialized(&isThere);
  if (isThere == 0)
    throw Error(
        "sk::Domain: MPI has not been initialized; call MPI_Init before, and MPI_Finalize after the domain "
        "ends");
  MPI_Finalized(&isThere);
  if (isThere != 0) throw Error("sk::Domain: MPI_Finalize has been called; create the domain before");
  if (communicator == MPI_COMM_NULL)
    throw Error("sk::Domain: the communicator is MPI_COMM_NULL; give one of this rank's");
  int world = 0;
  MPI_Comm_size(MPI_COMM_WORLD, &world);
  checkLauncher(world);
  MPI_Comm copy = MPI_COMM_NULL;
  mpi::check(MPI_Comm_dup(communicator, &copy), "sk::Domain");
  MPI_Comm_set_errhandler(copy, MPI_ERRORS_RETURN);
  return copy;
}

int rankIn(MPI_Comm communicator) {
  int rank = 0;
  mpi::check(MPI_Comm_rank(communicator, &rank), "sk::Domain");
  return rank;
}

domain::Decomposition decompose(const DomainOptions& options, MPI_Comm communicator) {
  int ranks = 0;
  mpi::check(MPI_Comm_size(communicator, &ranks), "sk::Domain");
  const Shape& shape = options.shape;
  const auto refuse = [&](const std::string& why) {
    throw Error(fmt::format("sk::Domain: {}", why), Error::Kind::Shape);
  };
  if (shape.size() == 0)
    refuse(fmt::format("the shape {} has no element; give extents of at least 1", toString(shape)));
  for (int d = 0; d < shape.rank(); ++d) {
    if (shape[d] > mostExtent)
      refuse(fmt::format("the shape {} has an extent above {}, where indices end; give it more dimensions",
                         toString(shape), mostExtent));
  }
  if (options.exchangeEvery < 1)
    refuse(fmt::format("exchangeEvery is {}; it counts calls, from 1 on", options.exchangeEvery));
  if (options.split.rank() == 0) {
    const std::optional<Index> split = domain::balancedSplit(shape, ranks);
    if (!split)
      refuse(fmt::format(
          "a domain of shape {} cannot be divided over {} ranks so that each has an element; start fewer",
          toString(shape), ranks));
    return {shape, *split, options.periodic};
  }
  const Index& split = options.split;
  if (split.rank() != shape.rank())
    refuse(fmt::format(
        "the split {} has {} dimensions, but the shape {} has {}; give one number of parts for each",
        toString(split), split.rank(), toString(shape), shape.rank()));
  std::int64_t product = 1;
  for (int d = 0; d < split.rank(); ++d) {
    if (split[d] < 1 || split[d] > shape[d])
      refuse(fmt::format(
          "the split {} has {} parts in dimension {}, where the shape {} has {} elements; give 1 to {}",
          toString(split), split[d], d, toString(shape), shape[d], shape[d]));
    product *= split[d];
    if (product > ranks) break;
  }
  if (product != ranks)
    refuse(fmt::format(
        "the split {} has not as many parts as there are ranks, {}; start another number of ranks, or leave "
        "the split out",
        toString(split), ranks));
  return {shape, split, options.periodic};
}

std::uint64_t hashOf(const DomainOptions& options, const domain::Decomposition& parts, const Device& device) {
  mpi::Hash hash;
  hash.add(toString(options.shape));
  hash.add(toString(parts.split()));
  for (const bool periodic : options.periodic) hash.add(periodic ? 1 : 0);
  hash.add(options.exchangeEvery);
  hash.add(device.profile() == "native" ? device.name() : std::string_view("GL"));
  return hash.value();
}

/// The options of a domain beside another one: parts are those of the other one, if the options do not say how to divide.
DomainOptions optionsBeside(const DomainState& other, DomainOptions options) {
  if (options.split.rank() != 0) return options;
  const Index& split = other.parts.split();
  Index same = Index::origin(options.shape.rank());
  for (int d = 0; d < same.rank(); ++d) {
    const int k = split.rank() - same.rank() + d;
    same[d] = k < 0 ? 1 : split[k];
  }
  options.split = same;
  return options;
}

}  // namespace

DomainState::DomainState(MPI_Comm given, const DomainOptions& chosen) : DomainState(given, chosen, nullptr) {}

DomainState::DomainState(const DomainState& beside, const DomainOptions& chosen)
    : DomainState(beside.communicator, optionsBeside(beside, chosen), beside.rankDevice) {}

DomainState::DomainState(MPI_Comm given, const DomainOptions& chosen, std::shared_ptr<RankDevice> shared)
    : communicator(duplicated(given)),
      rank(rankIn(communicator)),
      options(chosen),
      parts(decompose(chosen, communicator)),
      own(parts.boxOf(rank)),
      directions(domain::directionsOf(parts)),
      rankDevice(shared ? std::move(shared)
                        : std::make_shared<RankDevice>(
                              RankDevice{{}, mpi::openDevice(communicator, chosen.device)})),
      device(rankDevice->device),
      sendBuffers(directions.size()),
      receiveBuffers(directions.size()) {
  agree(nullptr, hashOf(options, parts, device),
        fmt::format("a domain of shape {}, split {}, on '{}'", toString(options.shape),
                    toString(parts.split()), device.name()));
}

DomainState::~DomainState() {
  for (DomainStreamState* stream : streams) stream->domain = nullptr;
}

void DomainState::agree(const void* key, std::uint64_t hash, std::string_view what) {
  if (!agreed_.insert(key).second) return;
  const std::uint64_t both[2] = {hash, ~hash};
  std::uint64_t most[2] = {};
  mpi::check(MPI_Allreduce(both, most, 2, MPI_UINT64_T, MPI_MAX, communicator), "a domain");
  if (most[0] == ~most[1]) return;
  agreed_.erase(key);
  constexpr std::size_t length = 128;
  std::string text(what.substr(0, length));
  text.resize(length);
  std::vector<std::uint64_t> hashes(static_cast<std::size_t>(parts.ranks()));
  std::string texts(hashes.size() * length, '\0');
  mpi::check(MPI_Allgather(&hash, 1, MPI_UINT64_T, hashes.data(), 1, MPI_UINT64_T, communicator), "a domain");
  mpi::check(MPI_Allgather(text.data(), length, MPI_CHAR, texts.data(), length, MPI_CHAR, communicator),
             "a domain");
  const auto other = static_cast<std::size_t>(
      std::ranges::find_if(hashes, [&](std::uint64_t one) { return one != hashes[0]; }) - hashes.begin());
  throw Error(fmt::format(
      "the ranks do not make the same call: rank 0 has {}, rank {} has {}; let all ranks run one program, "
      "with the same arguments in the same order",
      texts.c_str(), other, texts.c_str() + other * length));
}

const mpi::Communicator& DomainState::lineOf(int dimension) {
  const auto found = lines_.find(dimension);
  if (found != lines_.end()) return found->second;
  const Index place = parts.placeOf(rank);
  int color = 0;
  for (int d = 0; d < place.rank(); ++d) {
    if (d != dimension) color = color * static_cast<int>(parts.split()[d]) + static_cast<int>(place[d]);
  }
  MPI_Comm line = MPI_COMM_NULL;
  mpi::check(MPI_Comm_split(communicator, color, static_cast<int>(place[dimension]), &line), "a domain");
  MPI_Comm_set_errhandler(line, MPI_ERRORS_RETURN);
  return lines_.try_emplace(dimension, line).first->second;
}

DomainStreamState* domainStream(const StreamRegion& region) {
  auto* const stream = static_cast<DomainStreamState*>(region.distributed);
  if (stream != nullptr && stream->domain == nullptr) {
    throw Error(
        "the sk::Domain of a stream has been destroyed; keep the domain for as long as its streams are used",
        Error::Kind::Lost);
  }
  return stream;
}

DomainStreamState& liveStream(DomainStreamState* stream, std::string_view what) {
  if (stream == nullptr) {
    throw Error(fmt::format("{}: there is no stream: it was default-constructed or moved from; make one by "
                            "domain.stream<T>()",
                            what),
                Error::Kind::Lost);
  }
  domainStream({.distributed = stream});
  return *stream;
}

DomainStreamState::DomainStreamState(DomainState& of, const program::Element& type, Storage storage,
                                     std::string_view name)
    : domain(&of), element(type), storage_(storage), name_(name), local_(create()) {
  domain->streams.push_back(this);
}

DomainStreamState::~DomainStreamState() {
  if (domain != nullptr) std::erase(domain->streams, this);
}

detail::Distribution& DomainStreamState::distribution() {
  domainStream({.distributed = this});
  return *domain;
}

detail::StreamOwner DomainStreamState::create() const {
  const Depth halo = domain->parts.haloOf(domain->rank, allocated);
  return domain->device.createStream(element, domain::shapeOf(domain::grown(domain->own, halo)), storage_,
                                     name_);
}

StreamRegion DomainStreamState::placed(StreamState* state) const {
  const Depth halo = domain->parts.haloOf(domain->rank, allocated);
  return detail::placed(detail::wholeRegion(state),
                        {domain::grown(domain->own, halo).begin, domain->parts.whole()});
}

StreamRegion DomainStreamState::placed() const { return placed(local_.get()); }

StreamRegion DomainStreamState::part(const Box& box) const { return part(local_.get(), box); }

StreamRegion DomainStreamState::part(StreamState* state, const Box& box) const {
  const Box held = domain::grown(domain->own, domain->parts.haloOf(domain->rank, allocated));
  Box local = box;
  for (int d = 0; d < box.begin.rank(); ++d) {
    local.begin[d] -= held.begin[d];
    local.end[d] -= held.begin[d];
  }
  return detail::partOf(detail::wholeRegion(state), local.begin, local.end);
}

void DomainStreamState::deepen(const Depth& depth) {
  if (allocated.covers(depth)) return;
  const Depth before = allocated;
  const StreamRegion from = part(domain->own);
  allocated = allocated.with(depth);
  detail::StreamOwner deeper;
  try {
    deeper = create();
    if (from.stream->isLost()) {
      deeper->markLost();
    } else {
      detail::copy(from, part(deeper.get(), domain->own));
    }
  } catch (...) {
    allocated = before;
    throw;
  }
  local_ = std::move(deeper);
  spare_ = {};
  valid = {};
}

StreamRegion DomainStreamState::spare() {
  if (!spare_) spare_ = create();
  return placed(spare_.get());
}

void DomainStreamState::exchange() { std::swap(local_, spare_); }

}  // namespace sk
