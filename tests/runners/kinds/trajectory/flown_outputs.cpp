// What a trajectory tells of steps that flights leave out: that of every step, up to what the motion makes of
// round-off.
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "runners/store/record_values.hpp"
#include "runners/table/table_reader.hpp"
#include "tests/runners/kinds/trajectory/case_runs.hpp"

using namespace ricochet;
using ricochet::testing::CaseRuns;

namespace {

/// What may differ between two motions of the tube: shocks (each the largest difference of its columns, over the value,
/// of this or an earlier shock), measures of the window over their values, spectra over their largest density.
struct Apart {
  std::vector<double> shocks, measures, spectra;
};

Apart apart(const CaseRecord& a, const CaseRecord& b) {
  const auto share = [](double x, double y) {
    return x == y ? 0 : std::abs(x - y) / std::max(std::abs(x), std::abs(y));
  };
  Apart out;
  const NumberTable &shocks = *find_table(a.numbers, "shocks"), &others = *find_table(b.numbers, "shocks");
  REQUIRE(shocks.rows() > 2);
  REQUIRE(shocks.rows() == others.rows());
  const std::vector<double>& begin = *shocks.numbers("t_begin");
  std::vector<double> own(shocks.rows());
  for (const char* column : {"t_begin", "peak_force", "impulse", "duration", "rebounds"})
    for (std::size_t i = 0; i < own.size(); ++i)
      own[i] = std::max(own[i], share(shocks.numbers(column)->at(i), others.numbers(column)->at(i)));
  for (std::size_t i = 0; i < own.size(); ++i) {
    out.shocks.push_back(0);
    for (std::size_t j = 0; j < own.size(); ++j)
      if (begin[j] <= begin[i]) out.shocks[i] = std::max(out.shocks[i], own[j]);
  }
  for (const char* name : {"window_displacement_rms[end]", "window_force[end]", "window_displacement_max[plate]"})
    out.measures.push_back(share(measure(a, name).value(), measure(b, name).value()));
  const auto &s = *find_table(a.numbers, "spectra")->numbers("density"),
             &t = *find_table(b.numbers, "spectra")->numbers("density");
  REQUIRE(s.size() == t.size());
  const std::size_t one = s.size() / 2;  // of displacement, then of force
  for (std::size_t k = 0; k < s.size(); ++k) {
    const auto first = s.begin() + static_cast<std::ptrdiff_t>(k / one * one);
    out.spectra.push_back(std::abs(s[k] - t[k]) / *std::max_element(first, first + static_cast<std::ptrdiff_t>(one)));
  }
  return out;
}

}  // namespace

TEST_CASE("shocks and spectra of steps that flights leave out are those of every step") {
  Json study = Json::parse(R"json({
    "name": "struck-tube", "kind": "trajectory",
    "scene": {"structure": {"type": "beam", "length": 1.5, "section": {"type": "given", "EI": 40, "rhoS": 0.12}},
              "stops": [{"name": "plate", "at": {"x": 0.75}, "lower": -0.01, "upper": 0.01},
                        {"name": "end", "at": {"x": 1.5}, "lower": -0.01, "upper": 0.01}],
              "initial": {"velocity": "-2*x"}},
    "mesh": {"elements": 10}, "methods": {"mass": "consistent", "contact": "signorini", "time": "newmark-dumont-paoli"},
    "step": 5e-5, "duration": 0.4, "window": {"from": 0.1, "to": 0.3}, "march": ["every-step", "flights"],
    "outputs": {"shocks": {"rest": 1e-3}, "rate": 1000, "segment": 0.1,
                "spectra": [{"of": "end", "quantity": "displacement"}, {"of": "end", "quantity": "force"}]}})json");
  study["methods"]["contact"] = GENERATE(Json("signorini"), Json{{"name", "penalty"}, {"stiffness", 1e5}});
  const std::vector<CaseRecord> both = CaseRuns().of(study);
  REQUIRE(both.size() == 2);
  for (const CaseRecord& record : both) REQUIRE(record.status == Status::done);
  CHECK(measure(both[1], "steps_visited").value() < measure(both[0], "steps_visited").value());
  const Apart flown = apart(both[0], both[1]);
  // Impacts multiply what two motions differ by, a million times from the first to the last between rigid stops. What
  // round-off makes of the last shock differs by compiler and instruction set: 2e-8, 5e-7, 1e-6. Both round each of
  // their steps. Every step itself moves more, from its first shock on, when its initial velocity does by some units in
  // the last place.
  Apart ulp{std::vector<double>(flown.shocks.size()), std::vector<double>(flown.measures.size()),
            std::vector<double>(flown.spectra.size())};
  study["march"] = "every-step";
  constexpr double units = 64;
  for (const double side : {-1, 1}) {
    study["scene"]["initial"]["velocity"] = fmt::format("{:.17g}*x", -2 * (1 + side * units * 0x1p-52));
    const Apart moved = apart(both[0], CaseRuns().first_of(study));
    for (const auto part : {&Apart::shocks, &Apart::measures, &Apart::spectra})
      for (std::size_t i = 0; i < (ulp.*part).size(); ++i) (ulp.*part)[i] = std::max((ulp.*part)[i], (moved.*part)[i]);
  }
  for (std::size_t i = 0; i < flown.shocks.size(); ++i) CHECK(flown.shocks[i] <= ulp.shocks[i]);
  const auto most = [](const std::vector<double>& all) { return *std::max_element(all.begin(), all.end()); };
  CHECK(most(flown.measures) <= most(ulp.measures));
  CHECK(most(flown.spectra) <= most(ulp.spectra));
}
