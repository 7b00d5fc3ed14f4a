// SPDX-License-Identifier: MIT
#include "grid_tracer.hpp"

#include <utility>

#include <fmt/format.h>

#include "support/stopwatch.hpp"

namespace rays {
namespace {

using FloatStream = sk::Stream<sk::float4>;

}  // namespace

void GridTracer::find(bool anyHit, const FloatStream& from, const FloatStream& along,
                      sk::Stream<kernels::Found>& found) {
  if (from.size() == 0) return;
  if (settings_.machine == Machine::Multipass) return findByPasses(anyHit, from, along, found);
  kernels::findInGrid(scene_.scene(), scene_.grid(), anyHit, from, along, found);
}

void GridTracer::findByPasses(bool anyHit, const FloatStream& allFrom, const FloatStream& allAlong,
                              sk::Stream<kernels::Found>& found) {
  GridScene& s = scene_;
  sk::Device& device = s.device;
  const std::int64_t all = allFrom.size();
  auto travel = device.stream<kernels::Travel>(allFrom.shape());
  auto ray = device.stream<int>(allFrom.shape());
  kernels::numberRays(sk::iter(0, static_cast<int>(all)), ray);
  metered(meter_, "begin", all,
          [&] { kernels::beginTravel(s.scene(), s.grid(), anyHit, allFrom, allAlong, travel); });
  FloatStream ownFrom, ownAlong;
  const FloatStream *from = &allFrom, *along = &allAlong;
  const auto deliver = [&] {
    metered(meter_, "deliver", travel.size(),
            [&] { kernels::deliver(s.scene().shapes, anyHit, *from, *along, travel, ray, found); });
  };
  for (;;) {
    sk::int2 goOn;
    metered(meter_, "count", travel.size(), [&] { goOn = kernels::countTravels(travel); });
    const std::int64_t active = std::int64_t{goOn.x} + goOn.y;
    if (active == 0) break;
    if (double(active) <= settings_.compact * double(travel.size())) {
      deliver();
      auto nextFrom = device.stream<sk::float4>({0}), nextAlong = device.stream<sk::float4>({0});
      auto nextTravel = device.stream<kernels::Travel>({0});
      auto nextRay = device.stream<int>({0});
      metered(meter_, "compact", travel.size(),
              [&] { kernels::goOn(*from, *along, travel, ray, nextFrom, nextAlong, nextTravel, nextRay); });
      ownFrom = std::move(nextFrom);
      ownAlong = std::move(nextAlong);
      travel = std::move(nextTravel);
      ray = std::move(nextRay);
      from = &ownFrom;
      along = &ownAlong;
    }
    for (int i = 0; i < settings_.rounds; ++i) round(anyHit, *from, *along, travel);
  }
  deliver();
}

void GridTracer::round(bool anyHit, const FloatStream& from, const FloatStream& along,
                       sk::Stream<kernels::Travel>& travel) {
  GridScene& s = scene_;
  metered(meter_, "intersect", travel.size(), [&] {
    kernels::intersectLists(s.scene().shapes, s.grid(), anyHit, settings_.tests, from, along, travel, travel);
  });
  metered(meter_, "traverse", travel.size(),
          [&] { kernels::traverseCells(s.grid(), from, along, travel, travel); });
}

GridScene::GridScene(sk::Device& onDevice, const Model& ofModel, const GridSettings& settings,
                     HowToIntersect howToIntersect)
    : DeviceShapes(onDevice, ofModel), intersection(howToIntersect) {
  const examples::Stopwatch stopwatch;
  UniformGrid built = buildGrid(model, settings);
  const double milliseconds = stopwatch.milliseconds();
  lattice = {built.bounds.least, built.bounds.most, built.cell, built.size};
  if (hasShapes()) {
    const auto all = double(built.starts.size()),
               number = double(model.triangles.size() + model.spheres.size());
    size = fmt::format(
        "grid: {} triangles, {} spheres in {} x {} x {} cells, {:.0f} % of them empty, {:.1f} entries for "
        "each shape, "
        "{} in the longest list, built in {:.0f} ms",
        model.triangles.size(), model.spheres.size(), built.size.x, built.size.y, built.size.z,
        100.0 * (1.0 - double(built.occupied) / all), double(built.entries) / number, built.longest,
        milliseconds);
  }
  cells = streamOf(device, std::move(built.starts));
  lists = streamOf(device, std::move(built.lists));
}

}  // namespace rays
