// SPDX-License-Identifier: MIT
//
// fuzz_numbers_ranks: the cases of fuzz_numbers whose calls grids over ranks of MPI take, with the grid divided over all ranks.
// All ranks make the same cases; rank 0 compares and prints. The exit status is 1 after a finding.
#include <algorithm>
#include <iostream>
#include <variant>

#include <fmt/format.h>

#include "numbers/devices.hpp"
#include "numbers/generator.hpp"
#include "numbers/operations.hpp"
#include "numbers/signature.hpp"
#include "numbers/verdict.hpp"
#include "sk/mpi.hpp"

#include <CLI/CLI.hpp>

namespace {

using namespace fuzz::numbers;  // NOLINT(google-build-using-namespace)

struct Options {
  std::uint64_t seed = 1, first = 0, count = 1000;
};

/// Whether a domain takes the call: whole streams, reduces to one element, and scans along a dimension or over rows that are not divided.
bool canRunOnRanks(const Case& one) {
  const Operation& operation = operationNamed(one.operation);
  const bool isOneResult = std::ranges::all_of(one.result, [](std::int64_t extent) { return extent == 1; });
  const bool hasTables =
      std::ranges::any_of(operation.inputs, [](const Parameter& p) { return p.role == Role::Table; });
  return one.view == View::Whole && one.storage == sk::Storage::Single && one.starts.empty() && isOneResult &&
         !hasTables && one.shape.size() <= 3 && operation.name != "foldedNeighbors" && canRun("native", one);
}

template <class T>
std::vector<T> elementsOf(const Values& values) {
  std::vector<T> elements;
  if constexpr (std::is_same_v<T, sk::float3>) {
    for (std::size_t i = 0; i < values.size(); i += 3)
      elements.push_back({static_cast<float>(values[i]), static_cast<float>(values[i + 1]),
                          static_cast<float>(values[i + 2])});
  } else {
    for (const double x : values) elements.push_back(static_cast<T>(x));
  }
  return elements;
}

template <class... T>
using Streams = std::variant<sk::DomainStream<T>..., sk::Stream<T>...>;
using AnyStream = Streams<float, sk::float3, double, std::int32_t, std::uint32_t>;

template <class With>
void withElement(Element element, const With& with) {
  switch (element) {
    case Element::Float: return with(float());
    case Element::Float3: return with(sk::float3());
    case Element::Double: return with(double());
    case Element::Int: return with(std::int32_t());
    case Element::Uint: return with(std::uint32_t());
  }
}

/// The results, on rank 0.
std::vector<Values> runOnRanks(const Case& one, const sk::Index& split) {
  const Operation& operation = operationNamed(one.operation);
  sk::Domain domain(MPI_COMM_WORLD,
                    {.shape = shapeOf(one.shape), .split = split, .device = {.device = "native"}});
  Call call;
  call.options = one.options;
  std::vector<AnyStream> streams;
  streams.reserve(16);
  for (std::size_t k = 0; k < operation.inputs.size(); ++k) {
    call.uniforms.push_back(operation.inputs[k].role == Role::Uniform ? &one.inputs[k] : nullptr);
    if (operation.inputs[k].role == Role::Uniform) {
      call.inputs.emplace_back();
      continue;
    }
    withElement(operation.inputs[k].element, [&]<class T>(T) {
      auto stream = domain.stream<T>();
      const std::vector<T> elements = elementsOf<T>(one.inputs[k]);
      stream.scatter(elements, 0);
      call.inputs.push_back(stream.region());
      streams.emplace_back(std::move(stream));
    });
  }
  std::vector<Values> results;
  if (isToValue(one)) {
    call.values = &results;
    operation.call(call);
    return results;
  }
  const std::size_t elementOutputs = operation.kind == Kind::Scan
                                         ? operation.outputs.size()
                                         : operation.outputs.size() - operation.folds.size();
  const bool isReduce = operation.kind == Kind::Reduce;
  for (std::size_t k = 0; k < operation.outputs.size(); ++k) {
    withElement(operation.outputs[k], [&]<class T>(T) {
      if (!isReduce && k < elementOutputs) {
        auto stream = domain.stream<T>();
        call.outputs.push_back(stream.region());
        streams.emplace_back(std::move(stream));
      } else {
        auto stream = domain.device().stream<T>(shapeOf(std::vector<std::int64_t>(one.shape.size(), 1)));
        call.outputs.push_back(stream.region());
        streams.emplace_back(std::move(stream));
      }
    });
  }
  operation.call(call);
  for (std::size_t k = streams.size() - operation.outputs.size(); k < streams.size(); ++k) {
    std::visit(
        [&](auto& stream) {
          Values& values = results.emplace_back();
          const auto append = [&](const auto& elements) {
            for (const auto& element : elements) appendComponents(element, values);
          };
          if constexpr (requires { stream.gather(0); }) {
            append(stream.gather(0));
          } else {
            append(stream.read());
          }
        },
        streams[k]);
  }
  return results;
}

/// The divisions of a grid over the ranks that a case allows.
std::vector<sk::Index> splitsOf(const Case& one, int ranks) {
  std::vector<sk::Index> splits;
  const int rank = static_cast<int>(one.shape.size());
  for (int d = 0; d < rank; ++d) {
    const bool isAcross = one.options.along.value_or(d) == d;  // a scan goes on from rank to rank
    if (operationNamed(one.operation).kind == Kind::Scan && isAcross && ranks > 1 &&
        one.options.accumulate == sk::Accumulate::Exact)
      continue;
    const bool isWholeScan = operationNamed(one.operation).kind == Kind::Scan && !one.options.along;
    if (one.shape[static_cast<std::size_t>(d)] < ranks || (isWholeScan && d > 0)) continue;
    sk::Index split = sk::Index::origin(rank);
    for (int e = 0; e < rank; ++e) split[e] = e == d ? ranks : 1;
    splits.push_back(split);
  }
  return splits;
}

int runAll(const Options& options, int rank, int ranks) {
  std::uint64_t cases = 0, findings = 0;
  for (std::uint64_t number = options.first; number < options.first + options.count; ++number) {
    const Case one = generate(options.seed, number);
    if (!canRunOnRanks(one)) continue;
    for (const sk::Index& split : splitsOf(one, ranks)) {
      ++cases;
      std::string wrong;
      try {
        const std::vector<Values> results = runOnRanks(one, split);
        if (rank == 0) wrong = mistakeOf(one, results, {{.isNative = true, .ranks = ranks}});
      } catch (const sk::Error& error) {
        wrong = std::string("throws ") + error.what();
      }
      if (wrong.empty() || rank != 0) continue;
      ++findings;
      std::cout << fmt::format("case {} on {} ranks, divided by {}: {}\n  {}\n", number, ranks,
                               sk::toString(split), described(one), wrong)
                << std::flush;
    }
  }
  if (rank == 0) std::cout << cases << " cases on " << ranks << " ranks, " << findings << " findings\n";
  MPI_Bcast(&findings, 1, MPI_UINT64_T, 0, MPI_COMM_WORLD);
  return findings == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  int rank = 0, ranks = 1;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  Options options;
  CLI::App app{"fuzz_numbers_ranks: the cases of fuzz_numbers on grids that are divided over ranks",
               "fuzz_numbers_ranks"};
  app.add_option("--seed", options.seed, "Which cases: each seed has its own");
  app.add_option("--first", options.first, "Number of the first case");
  app.add_option("--count", options.count, "How many");
  int status = 0;
  try {
    app.parse(argc, argv);
    status = runAll(options, rank, ranks);
  } catch (const CLI::ParseError& error) {
    status = app.exit(error);
  } catch (const std::exception& error) {
    std::cerr << "fuzz_numbers_ranks: " << error.what() << "\n";
    MPI_Abort(MPI_COMM_WORLD, 1);
  }
  MPI_Finalize();
  return status;
}
