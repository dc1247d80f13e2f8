// Shocks: what the rule joins and leaves out, and those of a mass on two springs in closed form.
#include <numbers>
#include <ricochet/measure/contact/impact_recorder.hpp>
#include <ricochet/measure/contact/stop_statistics.hpp>
#include <ricochet/measure/statistics/spectra.hpp>

#include "tests/allocations.hpp"
#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

constexpr double tick = 0.125;

/// Feeds forces of a point at a lower stop, an instant every tick, 0 for none.
ShockRecorder fed(const std::vector<double>& forces, const ShockRule& rule, const WindowParts& window = {0, 1e9},
                  std::size_t most = ShockRecorder::most_shocks) {
  ShockRecorder recorder(1, rule, window, most);
  for (std::size_t i = 0; i < forces.size(); ++i)
    if (forces[i] > 0)
      recorder.instant({.time = static_cast<double>(i) * tick,
                        .lasts = tick,
                        .given = forces[i] * tick,
                        .force = forces[i],
                        .closes = i == 0 || forces[i - 1] == 0,
                        .speed_in = static_cast<double>(i)});
  recorder.finish(static_cast<double>(forces.size()) * tick, tick);
  return recorder;
}

}  // namespace

TEST_CASE("a shock is the time above a force, joined where it is apart by less than a rest") {
  const std::vector<double> forces = {0, 3, 5, 1, 4, 0, 0, 6, 0, 0, 0, 0, 2, 0};
  const auto every = fed(forces, {0, 0}).shocks();
  REQUIRE(every.size() == 3);
  CHECK(every[0].begin == 1 * tick);
  CHECK(every[0].peak_at == 2 * tick);
  CHECK(every[0].peak == 5);
  CHECK(every[0].duration == 4 * tick);
  CHECK(every[0].impulse == 13 * tick);
  CHECK(every[0].rebounds == 1);
  CHECK(every[0].speed_in == 1);
  CHECK(every[1].begin == 7 * tick);
  // Apart by 2 tick and by 4 tick.
  const auto joined = fed(forces, {0, 3 * tick}).shocks();
  REQUIRE(joined.size() == 2);
  CHECK(joined[0].duration == 7 * tick);
  CHECK(joined[0].pushed == 5 * tick);
  CHECK(joined[0].rebounds == 2);
  CHECK(joined[0].peak_at == 7 * tick);
  CHECK(joined[0].impulse == 19 * tick);
  // A rest of as much as they are apart does not join.
  CHECK(fed(forces, {0, 2 * tick}).shocks().size() == 3);
}

TEST_CASE("a list of shocks and a spectrum that are full take no more memory, however long the motion") {
  ShockRecorder recorder(1, {0, 0}, {0, 1e9}, 10);
  WelchSpectrum spectrum(8, 64);
  const auto shock = [&](int i) {
    recorder.instant({.time = 2 * i * tick, .lasts = tick, .given = tick, .force = 1, .closes = true, .speed_in = 1});
    spectrum.add(i % 7);
  };
  for (int i = 0; i < 200; ++i) shock(i);
  const long before = allocations();
  for (int i = 200; i < 20000; ++i) shock(i);
  const long after = allocations();  // the macros below allocate
  CHECK(after == before);
  CHECK(recorder.shocks().size() == 10);
  CHECK(recorder.count() > 19000);
  CHECK(spectrum.segments() == 20000 / 32 - 1);
}

TEST_CASE("force below that of the rule ends a rebound, and counts in the impulse between two of one shock") {
  const std::vector<double> forces = {0, 3, 5, 1, 4, 1, 0};
  const auto apart = fed(forces, {2, 0}).shocks();
  REQUIRE(apart.size() == 2);
  CHECK(apart[0].impulse == 8 * tick);
  CHECK(apart[1].impulse == 4 * tick);
  const auto joined = fed(forces, {2, 2 * tick}).shocks();
  REQUIRE(joined.size() == 1);
  CHECK(joined[0].impulse == 13 * tick);
  CHECK(joined[0].pushed == 3 * tick);
  CHECK(joined[0].rebounds == 2);
  CHECK(fed(forces, {5, 0}).shocks().empty());
}

TEST_CASE("beyond the list totals go on, and are those of shocks that begin in the window") {
  const std::vector<double> forces = {0, 3, 0, 5, 0, 1, 0, 7};
  const ShockRecorder recorder = fed(forces, {0, 0}, {2 * tick, 8 * tick}, 2);
  CHECK(recorder.shocks().size() == 2);
  CHECK(recorder.count() == 4);
  const ShockTotals& totals = recorder.totals(0, StopSide::lower);
  CHECK(totals.shocks == 3);
  CHECK(totals.peaks.mean == Approx(13.0 / 3).epsilon(1e-15));
  CHECK(totals.peaks.largest == 7);
  CHECK(totals.peaks.deviation() == Approx(std::sqrt((25 + 1 + 49) / 3.0 - 169.0 / 9)).epsilon(1e-14));
  CHECK(totals.lasted == 3 * tick);
  CHECK(recorder.totals(0, StopSide::upper).shocks == 0);
  CHECK(recorder.peaks(0).count() == 3);
}

TEST_CASE("classes of more peaks than are kept have all of them, to the peaks that count as one") {
  constexpr int n = 20000, most = 1000, classes = 10;
  CountedValues many(most), few(most);
  for (int i = 0; i < n; ++i) {
    many.add(1 + i * 7919LL % n);  // 1 … n, each once
    few.add(1 + i % 7);
  }
  for (const CountedValues* one : {&many, &few}) {
    CHECK(one->count() == n);
    CHECK(one->counted().size() < 2 * most);
  }
  std::vector<long long> counts(classes, 0);
  double largest = 0;
  long long heaviest = 0;
  for (const auto& [value, times] : many.counted()) {
    counts[static_cast<std::size_t>(std::ceil(value / n * classes)) - 1] += times;
    largest = std::max(largest, value);
    heaviest = std::max(heaviest, times);
  }
  CHECK(largest == n);
  CHECK(heaviest < 10 * n / most);
  for (const long long count : counts) CHECK(std::abs(count - n / classes) < 2 * heaviest);
  // Values that come again are counted exactly.
  for (const int value : {1, 7}) {
    long long found = 0;
    for (const auto& [own, times] : few.counted()) found += own == value ? times : 0;
    CHECK(found == n / 7 + (value <= n % 7 ? 1 : 0));
  }
}

// A mass of 100 kg on k = 1e4 N/m comes back to a stop of κ = 1e6 N/m with the speed with which it left. Contact lasts
// half a period of √((k + κ)/m), free flight half of √(k/m).
TEST_CASE("the second shock of a mass between two springs is that of its closed form") {
  constexpr double mass = 100, stiffness = 1e4, stop = 1e6, pi = std::numbers::pi;
  const double free = std::sqrt(stiffness / mass), closed = std::sqrt((stiffness + stop) / mass);
  SceneSpec scene;
  scene.structure = OscillatorSpec{mass, stiffness, 0, {}};
  scene.stops.upper = Formula(0.0);
  scene.stops.place = StopsSpec::Place::tip;
  scene.initial.velocity = Formula(1.0);
  const auto time =
      GENERATE(Choice{"newmark-dumont-paoli", {{"beta", 0.25}}}, Choice{"newmark"}, Choice{"moreau-jean"});
  const double step = GENERATE(1e-4, 1e-5);
  INFO(time.name << ", h = " << step);
  Marcher made = marcher(
      scene, 1, {{"consistent"}, {"penalty", {{"stiffness", stop}, {"evaluation", std::string("averaged")}}}, time},
      step);
  ImpactRecorder recorder(made);
  ShockRecorder shocks(1, {0, 0}, {0, 0.495});
  recorder.tell(&shocks);
  made.start({&recorder});
  made.march(std::llround(0.495 / step) - made.step(), {&recorder});
  recorder.finish(made);
  shocks.finish(made.time(), step);
  REQUIRE(shocks.shocks().size() == 2);
  const Shock& second = shocks.shocks()[1];
  // Second order in ωh = 0.01 and 0.001; begin and end are found to a step, and forces at steps.
  const double share = step > 5e-5 ? 1e-3 : 1e-4;
  CHECK(second.begin == Approx(pi / closed + pi / free).margin(2 * step));
  CHECK(second.peak_at == Approx(1.5 * pi / closed + pi / free).margin(2 * step));
  CHECK(second.peak == Approx(stop / closed).epsilon(share));
  // The spring of the mass gives none of it: 2 κ/(k + κ) m v.
  CHECK(second.impulse == Approx(2 * stop / closed / closed).epsilon(share));
  CHECK(second.duration == Approx(pi / closed).margin(2 * step));
  CHECK(second.speed_in == Approx(1).epsilon(share));
  CHECK(second.rebounds == 1);
  CHECK_FALSE(second.open_end);
  // As printed to four digits.
  CHECK(second.begin == Approx(0.34542).margin(2 * step + 5e-6));
  CHECK(second.peak == Approx(9950.37).epsilon(share));
  CHECK(second.impulse == Approx(198.0198).epsilon(share));
}

TEST_CASE("what is always in contact is so for all of a window that cuts steps, in each of its parts") {
  constexpr double mass = 100, stiffness = 1e4, stop = 1e6, force = 500;
  SceneSpec scene;
  scene.structure = OscillatorSpec{mass, stiffness, 0, {}};
  scene.stops.upper = Formula(0.0);
  scene.stops.place = StopsSpec::Place::tip;
  scene.load.formula = Formula(force);
  scene.initial.displacement = Formula(0.5 * force / (stiffness + stop));
  const auto time = GENERATE(Choice{"newmark-dumont-paoli", {{"beta", 0.25}}}, Choice{"newmark"},
                             Choice{"moreau-jean", {{"theta", 0.7}}}, Choice{"hht-alpha"});
  INFO(time.name);
  constexpr double step = 1e-3;
  Marcher made = marcher(
      scene, 1, {{"consistent"}, {"penalty", {{"stiffness", stop}, {"evaluation", std::string("implicit")}}}, time},
      step);
  const WindowParts window{0.10037, 0.40012, 7};
  StopStatistics statistics(made, window);
  ImpactRecorder recorder(made);
  recorder.tell(&statistics);
  made.start({&recorder});
  made.march(std::llround(0.5 / step) - made.step(), {&recorder});
  recorder.finish(made);
  double impulse = 0;
  for (int part = 0; part < window.count; ++part) {
    const PushTotals pushed = statistics.pushed(0, StopSide::upper, part);
    CHECK(pushed.contact_time == Approx(window.length()).epsilon(1e-9));
    impulse += pushed.impulse;
  }
  CHECK(impulse == Approx(statistics.pushed(0, StopSide::upper).impulse).epsilon(1e-12));
}
