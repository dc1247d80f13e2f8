#pragma once
#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>
#include <string>
#include <vector>

#include "tests/marching.hpp"

/// \file
/// What the tests of the time schemes have in common. Plans by name, the beam and the bar that they are compared on,
/// and the force that an integration shows.
namespace ricochet::testing {

/// "hht-alpha alpha = -0.3", to be read in a failure.
inline std::string label(const Choice& time) {
  std::ostringstream text;
  text << time.name;
  for (const auto& [key, value] : time.values) {
    text << ' ' << key << " = ";
    std::visit(
        [&](const auto& v) {
          if constexpr (std::is_same_v<std::decay_t<decltype(v)>, ParameterTable>)
            text << v.size() << " rows";
          else
            text << v;
        },
        value);
  }
  return text.str();
}

inline Choice scheme(const std::string& name, std::map<std::string, ParameterValue> values = {}) {
  return {name, std::move(values)};
}
/// The same with one word; a literal would be taken for a boolean.
inline Choice worded(const std::string& name, const std::string& key, const std::string& word) {
  return {name, {{key, word}}};
}

inline StepPlan plan_made(const Choice& time, double h, const ProblemFacts& facts = {}) {
  auto made = plan_of(time, h, facts);
  INFO(label(time));
  REQUIRE(std::holds_alternative<StepPlan>(made));
  return std::get<StepPlan>(made);
}

/// The working set's beam with EI/ρS = 282.84 m⁴/s², stops ±0.1 m at the tip, C = αK.
inline SceneSpec compared_beam(double alpha) {
  SceneSpec scene = working_set();
  beam_of(scene).section.type = Section::Type::given;
  beam_of(scene).section.EI = 282.84;
  beam_of(scene).section.rhoS = 1;
  beam_of(scene).damping.stiffness = alpha;
  return scene;
}

/// An unforced oscillator of mass 1 without stops; k = 0: a free mass.
inline SceneSpec oscillator(double stiffness, double damping, double position, double velocity) {
  SceneSpec scene;
  scene.structure = OscillatorSpec{1, stiffness, damping, {}};
  scene.initial.displacement = Formula(position);
  scene.initial.velocity = Formula(velocity);
  return scene;
}

/// The energy audit, and the contact force of each step: what its efforts give to the momentum, over h (N).
class WatchedMarch final : public StepObserver {
 public:
  explicit WatchedMarch(const Marcher& marcher) : audit(marcher) {}
  EnergyAudit audit;
  std::vector<double> times, forces;

  void stage_solved(const Marcher& marcher, const StageView& view) override {
    audit.stage_solved(marcher, view);
    if (view.effort && view.contact_lanes != 0) given_ += view.program->momentum * view.effort[0][0];
  }
  void step_done(Marcher& marcher) override {
    audit.step_done(marcher);
    times.push_back(marcher.time());
    forces.push_back(given_ / marcher.program().h);
    given_ = 0;
  }

 private:
  double given_ = 0;
};

/// Starts and marches until `duration` under a watch.
inline void watch(Marcher& made, WatchedMarch& observer, double duration) {
  made.start(&observer);
  made.march(std::llround(duration / made.program().h) - made.step(), &observer);
}

inline double mean_of(const std::vector<double>& x) {
  return std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
}
inline double deviation_of(const std::vector<double>& x) {
  const double mean = mean_of(x);
  double sum = 0;
  for (const double value : x) sum += (value - mean) * (value - mean);
  return std::sqrt(sum / static_cast<double>(x.size()));
}
inline double median_of(std::vector<double> x) {
  std::sort(x.begin(), x.end());
  return x[x.size() / 2];
}

}  // namespace ricochet::testing
