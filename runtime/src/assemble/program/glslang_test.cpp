// SPDX-License-Identifier: MIT
//
// Promises: glslang accepts every kind of program: profiles x domains x addressing x boundaries x ranks x
// types, and every pass of a reduction. The programs stay in SK_TEST_FOLDER for inspection.
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <catch2/catch.hpp>

#include "assemble/append/histo_pyramid.hpp"
#include "assemble/append/scatter_programs.hpp"
#include "assemble/program/sample_kernels.hpp"
#include "assemble/program/several_bodies.hpp"
#include "assemble/program/tile_program.hpp"
#include "assemble/reduce/group_fold.hpp"
#include "assemble/reduce/reduce_program.hpp"
#include "assemble/sort/radix_program.hpp"
#include "assemble/transfer/staging_program.hpp"

using namespace sk::assemble;
using namespace sk::program;

namespace {

/// All but those of browsers, whose programs have the same text as for ES and are shown to Chromium (tests/web).
std::vector<Profile> shownProfiles() {
  std::vector<Profile> shown(profiles().begin(), profiles().end());
  std::erase_if(shown, [](const Profile& profile) { return profile.webgl; });
  return shown;
}

/// A folder of programs that one process checks.
class Programs {
 public:
  explicit Programs(std::string_view name) : folder_(std::filesystem::path(SK_TEST_FOLDER) / name) {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }

  void add(std::string_view text, std::string_view stage = "frag") {
    std::ofstream(folder_ / fmt::format("{:04}.{}", count_++, stage)) << text;
  }

  /// glslang does not know the formats that GL_NV_image_formats adds.
  void add(const Profile& profile, std::string_view text) {
    if (text.find("GL_NV_image_formats") != std::string_view::npos) {
      ++count_;
      ++unknown_;
      return;
    }
    add(text, profile.stage == Stage::Compute ? "comp" : "frag");
  }

  /// The errors that glslang reports.
  std::string complaints() const {
    const std::string command =
        fmt::format("cd '{}' && '{}' *.* > complaints.txt 2>&1", folder_.string(), SK_GLSLANG_VALIDATOR);
    const bool accepted = std::system(command.c_str()) == 0;
    std::ifstream file(folder_ / "complaints.txt");
    std::string line;
    std::string result;
    for (int shown = 0; shown < 20 && std::getline(file, line);) {
      if (!line.starts_with("ERROR") && !line.starts_with("WARNING")) continue;
      result += line + '\n';
      ++shown;
    }
    return accepted && result.empty() ? "" : "glslang: " + result;
  }

  int count() const { return count_; }
  int unknown() const { return unknown_; }

 private:
  std::filesystem::path folder_;
  int count_ = 0;
  int unknown_ = 0;
};

void checkAccepted(const Programs& programs) {
  const std::string complaints = programs.complaints();
  INFO(complaints);
  CHECK(complaints.empty());
  CHECK(4 * programs.unknown() <= programs.count());
}

struct Type {
  const Element* element;
  std::string_view border;
};
const std::array types = {
    Type{&samples::floatElement, "1.0"},
    Type{&samples::float3Element, "vec3(0.0, 1.0, 2.0)"},
    Type{&samples::intElement, "-1"},
    Type{&samples::int3Element, "ivec3(0)"},
    Type{&samples::uint2Element, "uvec2(1u, 2u)"},
    Type{&samples::boolElement, "true"},
    Type{&samples::bool3Element, "bvec3(true, false, true)"},
    Type{&samples::hitElement, "Hit(0.0, Place(vec3(0.0), false), -1)"},
};

struct DomainKind {
  Domain domain;
  bool view;
};
constexpr std::array domains = {DomainKind{Domain::Plane, false}, DomainKind{Domain::Plane, true},
                                DomainKind{Domain::Linear, false}, DomainKind{Domain::LinearBox, false}};

constexpr std::array inputs = {StreamAccess{Addressing::Aligned}, StreamAccess{Addressing::Plane},
                               StreamAccess{Addressing::Plane, true}, StreamAccess{Addressing::Linear},
                               StreamAccess{Addressing::Linear, true}};

constexpr std::array boundaries = {Boundary::Clamp, Boundary::Wrap, Boundary::Mirror, Boundary::Border};

/// Offsets that are not constant, constant offsets that may exceed an extent, and ones that are below every
/// extent.
struct Neighbours {
  int reach;
  bool nearby;
};
constexpr std::array neighbours = {Neighbours{-1, false}, Neighbours{2, false}, Neighbours{2, true}};

StreamAccess with(StreamAccess access, bool nearby) {
  access.nearby = nearby;
  return access;
}

void addBoundaries(Programs& programs, const Type& type, int rank, const DomainKind& domain,
                   const StreamAccess& input, const StreamAccess& gather, bool isPlaced = false,
                   bool isPacked = false) {
  for (const Profile& profile : shownProfiles()) {
    for (const Boundary boundary : boundaries) {
      for (const auto [reach, nearby] : neighbours) {
        const samples::EveryAccess sample(*type.element, type.border, rank, boundary, reach);
        const Variant variant{.domain = domain.domain,
                              .domainView = domain.view,
                              .domainPacked = isPacked,
                              .domainRank = static_cast<std::uint8_t>(rank),
                              .domainPlaced = isPlaced,
                              .access = {{}, input, with(gather, nearby), {}, {}}};
        Profile sampling = profile;
        sampling.samples = nearby;
        programs.add(profile, kernelProgram(sampling, sample.kernel(), variant));
      }
    }
  }
}

}  // namespace

TEST_CASE("glslang finds what is wrong") {
  Programs programs("wrong");
  programs.add("#version 330 core\nvoid main() { int i = 1.0; }\n");
  CHECK_FALSE(programs.complaints().empty());
}

TEST_CASE("glslang accepts every layout with every boundary") {
  Programs programs("layouts");
  for (const DomainKind& domain : domains) {
    for (const StreamAccess& input : inputs) {
      for (const StreamAccess& gather : inputs) {
        if (gather.addressing == Addressing::Aligned) continue;
        addBoundaries(programs, types[0], 2, domain, input, gather);
      }
    }
  }
  REQUIRE(programs.count() == 4 * 5 * 4 * 4 * 4 * 3);
  checkAccepted(programs);
}

TEST_CASE("glslang accepts every type and rank with every boundary") {
  Programs programs("types");
  for (const Type& type : types) {
    for (const int rank : {1, 2, 3, 4}) {
      addBoundaries(programs, type, rank, domains[0], inputs[0], inputs[1]);
      addBoundaries(programs, type, rank, domains[3], inputs[4], inputs[4]);
    }
  }
  REQUIRE(programs.count() == 8 * 4 * 2 * 4 * 4 * 3);
  checkAccepted(programs);
}

TEST_CASE("glslang accepts parts of a whole of every rank with every boundary") {
  Programs programs("parts");
  StreamAccess plane = inputs[2], linear = inputs[4];
  plane.placed = linear.placed = true;
  for (const int rank : {1, 2, 3, 4}) {
    addBoundaries(programs, types[0], rank, domains[1], inputs[0], plane, true);
    addBoundaries(programs, types[0], rank, domains[3], inputs[4], linear, true);
  }
  REQUIRE(programs.count() == 4 * 2 * 4 * 4 * 3);
  checkAccepted(programs);
}

TEST_CASE(
    "glslang accepts local gathers of every rank with every boundary, in texels of one element or four") {
  Programs programs("local");
  StreamAccess plane = inputs[2], linear = inputs[4], texels = inputs[1];
  plane.local = linear.local = texels.local = linear.shifted = texels.shifted = true;
  texels.packed = true;
  for (const int rank : {1, 2, 3, 4}) {
    addBoundaries(programs, types[0], rank, domains[1], inputs[0], plane, true);
    addBoundaries(programs, types[0], rank, domains[3], inputs[4], linear, true);
    if (rank <= 2) addBoundaries(programs, types[0], rank, domains[1], inputs[0], texels, true, true);
  }
  REQUIRE(programs.count() == (4 * 2 + 2) * 4 * 4 * 3);
  checkAccepted(programs);
}

TEST_CASE("glslang accepts layers, of what is drawn and of what is read") {
  Programs programs("layers");
  constexpr std::array layered = {StreamAccess{Addressing::Aligned}, StreamAccess{Addressing::Layered},
                                  StreamAccess{Addressing::Layered, true}};
  for (const Profile& profile : shownProfiles()) {
    for (const Type& type : types) {
      for (const StreamAccess& input : layered) {
        for (const Domain domain : {Domain::Linear, Domain::LinearBox}) {
          const samples::EveryAccess sample(*type.element, type.border, 2, Boundary::Border, -1);
          programs.add(profile, kernelProgram(profile, sample.kernel(),
                                              {.domain = domain,
                                               .domainLayered = true,
                                               .access = {{}, input, {Addressing::Layered, true}, {}, {}}}));
        }
      }
    }
    for (const bool source : {false, true}) {
      for (const bool domain : {false, true}) {
        programs.add(
            profile,
            reduceProgram(profile, samples::firstHit,
                          {.walk = Walk::Partials, .sourceLayered = source, .domainLayered = domain}));
        if (profile.stage == Stage::Compute) continue;
        programs.add(pyramidProgram(profile, {true, source, domain}));
        programs.add(pyramidProgram(profile, {false, source, domain}));
      }
    }
  }
  checkAccepted(programs);
}

TEST_CASE("glslang accepts the points of a scatter output, in layers or not") {
  Programs programs("points");
  const Parameter appendOutput{
      .name = "r", .symbol = "r", .role = Role::Scatter, .element = &samples::int3Element, .rank = 1};
  for (const Profile& profile : shownProfiles()) {
    if (profile.stage == Stage::Compute) continue;
    for (const PointTextures& textures :
         {PointTextures{false, false}, {false, true}, {true, false}, {true, true}}) {
      programs.add(pointVertexProgram(profile, textures), "vert");
      for (int step = 0; step <= static_cast<int>(PointStep::JoinHalves); ++step) {
        programs.add(pointProgram(profile, appendOutput, static_cast<PointStep>(step), textures));
      }
    }
  }
  checkAccepted(programs);
}

TEST_CASE("glslang accepts the programs of sorts, and of scans by runs and tiles") {
  Programs programs("tiles");
  const Profile& profile = *findProfile("glsl430");
  const Profile& es = *findProfile("essl310");
  Profile withSubgroups = profile;
  withSubgroups.subgroups = true;
  constexpr RadixStep steps[] = {RadixStep::Count, RadixStep::CountPairs, RadixStep::Move,
                                 RadixStep::MoveFirst, RadixStep::MovePairs};
  constexpr RadixStorage storages[] = {
      {}, {.writes = true}, {.reads = true}, {.reads = true, .writes = true}};
  for (const Profile& one : {profile, withSubgroups, es}) {
    for (const RadixStep step : steps) {
      for (const RadixKeys keys : {RadixKeys::Words, RadixKeys::Floats}) {
        for (const RadixStorage storage : storages) programs.add(one, radixProgram(one, step, keys, storage));
      }
    }
  }
  for (const Profile& one : {profile, es}) {
    programs.add(one, radixProgram(one, RadixStep::Sum));
    for (const RadixStep step : {RadixStep::Store, RadixStep::StorePairs})
      programs.add(one, radixProgram(one, step, RadixKeys::Words, {.reads = true}));
  }
  for (const std::string_view format :
       {"R32F", "RGBA32F", "RG16F", "R8UI", "RGBA32UI", "R8I", "RG32I", "R8"}) {
    for (const bool writesTexels : {true, false}) {
      for (const bool isLayered : {true, false})
        programs.add(profile, stagingProgram(profile, writesTexels, format, isLayered));
    }
  }
  for (const Profile& one : {profile, withSubgroups, es}) {
    for (const ScanPass scan : {ScanPass::Inclusive, ScanPass::Exclusive}) {
      for (const std::uint8_t run : {1, 4})
        programs.add(one, reduceProgram(one, samples::sum,
                                        {.run = run, .scan = scan, .unit = ScanUnit::Tile, .chained = true}));
    }
    for (const bool inAnyOrder : {false, true}) {
      for (const bool inOneRound : {false, true}) {
        const Task task{.work = Work::Groups, .pushesInAnyOrder = inAnyOrder, .inOneRound = inOneRound};
        const Variant variant{.task = task, .domain = Domain::Linear, .access = {{}, {}}};
        programs.add(one, kernelProgram(one, samples::keepPositive, variant));
      }
    }
  }
  for (const Reduction* reduction : {&samples::sum, &samples::firstHit}) {
    for (const ScanPass scan : {ScanPass::Folds, ScanPass::Inclusive, ScanPass::Exclusive}) {
      if (scan == ScanPass::Exclusive && reduction == &samples::firstHit) continue;  // it has no identity
      for (const auto [domain, isView] : domains) {
        for (const Walk walk : {Walk::Line, Walk::Plane, Walk::Partials}) {
          for (const Runs runs : {Runs::OneBlock, Runs::Split}) {
            const bool isFold = scan == ScanPass::Folds;
            programs.add(profile, reduceProgram(profile, *reduction,
                                                {.walk = walk,
                                                 .runs = runs,
                                                 .domain = isFold ? Domain::Linear : domain,
                                                 .domainView = !isFold && isView,
                                                 .domainRank = 2,
                                                 .run = 4,
                                                 .scan = scan,
                                                 .unit = runs == Runs::OneBlock || isFold ? ScanUnit::Tile
                                                                                          : ScanUnit::Run,
                                                 .carried = !isFold}));
          }
        }
      }
    }
  }
  checkAccepted(programs);
}

// Only device tests cover `precise` of 3.30: glslang does not accept it with GL_ARB_gpu_shader5.
TEST_CASE(
    "glslang accepts doubles and their functions in either form, behind other barriers than `precise`") {
  Programs programs("doubles");
  std::vector<IntrinsicUse> all;
  for (int i = 0; i <= static_cast<int>(Intrinsic::Pow); ++i)
    all.push_back({static_cast<Intrinsic>(i), 1, true});
  Kernel kernel = samples::saxpy;
  kernel.usesDoubles = true;
  for (Profile profile : shownProfiles()) {
    for (const Doubles form : {Doubles::Native, Doubles::Pairs}) {
      if (profile.es && form == Doubles::Native) continue;
      profile.doubles = form;
      for (const sk::Barrier barrier : {sk::Barrier::None, sk::Barrier::Xor}) {
        profile.barrier = barrier;
        for (const std::span<const IntrinsicUse> uses :
             {std::span<const IntrinsicUse>{}, std::span<const IntrinsicUse>(all)}) {
          kernel.intrinsics = uses;
          programs.add(profile,
                       kernelProgram(profile, kernel,
                                     {.access = std::vector<StreamAccess>(kernel.parameters.size())}));
        }
      }
    }
  }
  REQUIRE(programs.count() == 24);
  checkAccepted(programs);
}

TEST_CASE("glslang accepts programs that report loops that have been ended early") {
  Programs programs("loops");
  Kernel kernel = samples::saxpy;
  kernel.usesLoops = true;
  Reduction sum = samples::sum;
  sum.fold.usesLoops = true;
  for (Profile profile : shownProfiles()) {
    profile.checksLoops = true;
    if (profile.es) profile.version = "#version 310 es";
    programs.add(profile, kernelProgram(profile, kernel, {.access = {{}, {}, {}, {}}}));
    programs.add(profile, reduceProgram(profile, sum, {.walk = Walk::Line}));
  }
  REQUIRE(programs.count() == 8);
  checkAccepted(programs);
}

TEST_CASE("glslang accepts kernels that use nothing of the assembler's, and the vertex program") {
  Programs programs("plain");
  for (const Profile& profile : shownProfiles()) {
    programs.add(profile, kernelProgram(profile, samples::saxpy, {.access = {{}, {}, {}, {}}}));
    programs.add(profile,
                 kernelProgram(profile, samples::diffuse, {.access = {{}, {Addressing::Plane}, {}}}));
    if (profile.stage == Stage::Fragment) programs.add(vertexProgram(profile), "vert");
  }
  Kernel exact = samples::saxpy;
  exact.usesExactSums = true;
  Profile es = *findProfile("essl310");
  es.barrier = sk::Barrier::Precise;
  programs.add(es, kernelProgram(es, exact, {.access = {{}, {}, {}, {}}}));
  checkAccepted(programs);
}

TEST_CASE("glslang accepts strided regions") {
  Programs programs("strided");
  for (const Addressing addressing :
       {Addressing::Plane, Addressing::Rows, Addressing::Linear, Addressing::Layered}) {
    for (const Profile& profile : shownProfiles()) {
      for (const Domain domain : {Domain::Strided, Domain::StridedRows, Domain::StridedLinear}) {
        const StreamAccess strided{.addressing = addressing, .view = true, .strided = true};
        programs.add(profile, kernelProgram(
                                  profile, samples::saxpy,
                                  {.domain = domain, .domainRank = 4, .access = {{}, strided, strided, {}}}));
      }
      for (const int rank : {1, 2, 4}) {
        if (rank > 2 && addressing < Addressing::Linear) continue;
        const samples::EveryAccess sample(samples::float3Element, "vec3(0.0, 1.0, 2.0)", rank,
                                          Boundary::Border, -1);
        const StreamAccess strided{.addressing = addressing, .view = true, .strided = true};
        programs.add(profile, kernelProgram(profile, sample.kernel(),
                                            {.domainRank = 2, .access = {{}, strided, strided, {}, {}}}));
      }
    }
  }
  checkAccepted(programs);
}

TEST_CASE("glslang accepts values that the vertex program hands on") {
  Programs programs("relayed");
  for (Profile profile : shownProfiles()) {
    if (profile.stage == Stage::Compute) continue;
    profile.relaysUniforms = true;
    for (const auto [domain, view] : domains) {
      const Variant variant{
          .domain = domain, .domainView = view, .access = {{}, inputs[2], {Addressing::Plane}, {}}};
      const auto [vertex, main] = kernelPrograms(profile, samples::saxpy, variant);
      programs.add(main);
      programs.add(vertex, "vert");
    }
  }
  checkAccepted(programs);
}

TEST_CASE("glslang accepts kernels that fold beside their outputs, or have none") {
  Programs programs("folds");
  Reduction reduction = samples::sum;
  reduction.addition = reduction.combine.body;
  reduction.commutative = true;
  reduction.seeded = false;
  std::vector<Parameter> parameters(reduction.fold.parameters.begin(), reduction.fold.parameters.end());
  for (const bool stores : {false, true}) {
    if (stores)
      parameters.push_back(
          {.name = "r", .symbol = "r", .role = Role::Output, .element = &samples::floatElement});
    reduction.fold.parameters = parameters;
    reduction.fold.entry = "fold";
    reduction.fold.body =
        stores ? "void fold(float x, inout float total, out float r) { r = 2.0 * x; total += r; }\n"
               : "void fold(float x, inout float total) { total += x; }\n";
    CHECK(mayFoldInGroups(reduction));
    for (const auto [domain, view] : domains) {
      for (const bool packed : {false, true}) {
        const Variant variant{.task = {.work = Work::Folds},
                              .domain = domain,
                              .domainView = view,
                              .domainPacked = packed,
                              .domainRank = 4,
                              .access = {{Addressing::Plane}, {}, {}}};
        Variant fitting = variant;
        fitting.access.resize(parameters.size());
        for (const std::string_view name : {"glsl430", "essl310"}) {
          const Profile& profile = *findProfile(name);
          programs.add(profile, kernelProgram(profile, reduction.fold, fitting, &reduction));
        }
      }
    }
  }
  reduction.commutative = false;  // and so order matters
  CHECK_FALSE(mayFoldInGroups(reduction));
  checkAccepted(programs);
}

TEST_CASE("glslang accepts every pass of a reduction") {
  Programs programs("reductions");
  for (const Profile& profile : shownProfiles()) {
    for (const Reduction* reduction : {&samples::sum, &samples::firstHit, &samples::countTrue}) {
      for (const Walk walk : {Walk::Line, Walk::Plane, Walk::Box, Walk::Partials}) {
        for (const Runs runs : {Runs::OneBlock, Runs::WholeBlocks, Runs::Split}) {
          for (const auto [domain, view] : domains) {
            for (const std::uint8_t rank :
                 {std::uint8_t{1}, std::uint8_t{2}, std::uint8_t{3}, std::uint8_t{4}}) {
              programs.add(profile,
                           reduceProgram(profile, *reduction, {walk, runs, domain, view, rank, rank}));
            }
          }
        }
      }
    }
  }
  REQUIRE(programs.count() == 4 * 3 * 4 * 3 * 4 * 4);
  checkAccepted(programs);
}

TEST_CASE("glslang accepts folds of several inputs to several accumulators, by index") {
  Programs programs("weighings");
  constexpr StreamAccess plane{Addressing::Plane, true};
  constexpr StreamAccess linear{Addressing::Linear};
  for (const Profile& profile : shownProfiles()) {
    for (const Walk walk : {Walk::Index, Walk::Partials, Walk::Nothing}) {
      for (const auto& [x, y] : {std::pair(plane, linear), std::pair(linear, plane)}) {
        for (const auto [domain, view] : domains) {
          for (const std::uint8_t first : {std::uint8_t{0}, std::uint8_t{2}}) {
            const auto count = static_cast<std::uint8_t>(first == 0 ? 0 : 3);
            programs.add(profile, reduceProgram(profile, samples::weigh,
                                                {.walk = walk,
                                                 .runs = Runs::Split,
                                                 .domain = domain,
                                                 .domainView = view,
                                                 .domainRank = 4,
                                                 .axes = 4,
                                                 .firstPlane = first,
                                                 .planeCount = count,
                                                 .access = {{}, x, y, {Addressing::Plane}, {}, {}}}));
          }
        }
      }
    }
  }
  checkAccepted(programs);
}

TEST_CASE("glslang accepts passes over rows of different lengths, and blocks by work groups") {
  Programs programs("rows");
  constexpr StreamAccess packed{.addressing = Addressing::Linear, .view = true, .packed = true};
  constexpr StreamAccess plane{Addressing::Plane, true};
  for (const Profile& profile : shownProfiles()) {
    const bool isCompute = profile.stage == Stage::Compute;
    for (const auto [domain, view] : domains) {
      for (const StreamAccess& x : {packed, plane}) {
        const std::vector<StreamAccess> access = {{}, x, plane, {Addressing::Plane}, {}, {}};
        ReduceVariant variant{
            .walk = Walk::Index, .domain = domain, .domainView = view, .domainRank = 4, .access = access};
        for (const RowPass pass : {RowPass::Folds, RowPass::Inclusive, RowPass::Exclusive}) {
          variant.rows = pass;
          variant.carried = pass == RowPass::Inclusive;
          variant.tableLayered = variant.carryLayered = variant.carried && domain == Domain::Linear;
          programs.add(profile, reduceProgram(profile, samples::weigh, variant));
        }
        variant.carried = variant.tableLayered = variant.carryLayered = false;
        if (!isCompute) continue;
        Reduction added = samples::weigh;
        added.addition = added.combine.body;
        for (const bool inOrder : {false, true}) {
          added.commutative = !inOrder;
          variant.rows = RowPass::Groups;
          variant.grouped = false;
          programs.add(profile, reduceProgram(profile, added, variant));
          variant.rows = RowPass::None;
          variant.grouped = true;
          variant.axes = 4;
          programs.add(profile, reduceProgram(profile, added, variant));
        }
      }
      for (const Reduction* reduction : {&samples::sum, &samples::firstHit, &samples::countTrue}) {
        for (const RowPass pass : {RowPass::Folds, RowPass::Inclusive}) {
          programs.add(profile, reduceProgram(profile, *reduction,
                                              {.walk = Walk::Partials,
                                               .domain = domain,
                                               .domainView = view,
                                               .domainRank = 4,
                                               .rows = pass}));
        }
      }
    }
  }
  checkAccepted(programs);
}

TEST_CASE("glslang accepts tiles of several iterations, with gathers of every kind") {
  Programs programs("tiles");
  const Profile& profile = *findProfile("glsl430");
  for (const Element* const element : {&samples::floatElement, &samples::intElement}) {
    for (const Boundary boundary : boundaries) {
      const samples::EveryAccess every(*element, element == &samples::floatElement ? "1.0" : "-1", 2,
                                       boundary, 1);
      constexpr std::array definitions = {sk::program::Definition{.name = "every"}};
      Kernel kernel = every.kernel();
      kernel.definitions = definitions;
      SeveralBodies bodies;
      const std::vector<std::string> symbols = {"", "", "c0_a", "", ""};
      const TileCall call{
          &kernel, *bodies.add(kernel, symbols), {"sk_arg_c", "", "", "", ""}, {-1, 0, 0, 1, 2}, symbols,
          {1, 1}};
      const TilePlan plan{4,
                          {16, 32},
                          128,
                          boundary == Boundary::Wrap,

                          1,
                          {1},
                          {element, element, &samples::intElement},
                          {true, false, false},
                          {call}};
      const std::string body = bodies.text();
      const std::array parameters = {
          Parameter{.name = "s", .symbol = "s0", .role = Role::Gather, .element = element, .rank = 2},
          Parameter{.name = "o", .symbol = "o0", .role = Role::Output, .element = element},
          Parameter{.name = "c", .symbol = "c", .role = Role::Uniform, .element = element}};
      const Kernel whole{.name = "tiles",
                         .entry = {},
                         .declarations = {},
                         .body = body,
                         .parameters = parameters,
                         .sources = {},
                         .usesIndex = true,
                         .usesExtent = true};
      for (const bool packed : {false, true}) {
        const StreamAccess access{.addressing = Addressing::Plane, .packed = packed};
        programs.add(profile,
                     tileProgram(profile, whole, {.domainPacked = true, .access = {access, {}, {}}}, plan));
      }
    }
  }
  CHECK(programs.count() == 16);
  checkAccepted(programs);
}
