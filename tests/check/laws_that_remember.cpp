// Laws that keep numbers from one solve to the next, and laws of lanes with parameters of their own: each thing that
// goes wrong there is caught by the check that looks at it.
#include <catch2/catch.hpp>
#include <cmath>
#include <ricochet/contact_solvers/pointwise_solver.hpp>
#include <stdexcept>

#include "runners/check/law_checks.hpp"
#include "tests/check/sound_schemes.hpp"
#include "tests/dented_stop.hpp"

using namespace ricochet;
using namespace ricochet::testing;
using Catch::Matchers::Contains;
using checking::CheckResult;
using checking::Finding;

namespace laws_that_remember {
namespace {

enum class Wrong {
  nothing,
  forgets,           // zeroes its memory before each solve
  wipes_others,      // writes the memory of lanes that it was not asked for
  keeps_in_itself,   // a count of solves, in the object
  throws_at_second,  // touch
  overshoots,        // an effort three times too large where it reloads
  negative_energy,
  stores_forever,    // the greatest energy that it ever held
  gives_power,       // −5 W
  rests_with_power,  // 5 W, moving or not
  lane_zero          // the dent of lane 0 in all lanes
};

/// The dented stop, with one thing wrong.
class WrongDent final : public ContactLaw {
 public:
  explicit WrongDent(Wrong wrong) : wrong_(wrong) {}
  std::optional<Evaluation> reads() const override { return inner_.reads(); }
  int memory_per_point() const override { return inner_.memory_per_point(); }
  void prepare(int points, std::span<const Parameters> lanes) override { inner_.prepare(points, lanes); }
  void solve(ReducedProblem& problem) override {
    const auto numbers = static_cast<std::size_t>(2 * problem.points * problem.lanes);
    bool dented = false;
    for (std::size_t k = 0; k < numbers; ++k) dented = dented || problem.memory[k] > 0;
    if (wrong_ == Wrong::forgets) std::fill_n(problem.memory, numbers, 0.0);
    if (wrong_ == Wrong::wipes_others)
      for (int lane = 0; lane < problem.lanes; ++lane) problem.memory_of(lane, 0)[0] = 0;
    if (wrong_ == Wrong::lane_zero)
      for (const int lane : problem.touched)
        for (int i = 0; i < problem.points; ++i) problem.memory_of(lane, 0)[i] = problem.memory_of(0, 0)[i];
    bool comes_again = false;
    for (const int lane : problem.touched) {
      const ricochet::LaneProblem of = problem.lane(lane);
      for (int i = 0; i < of.points; ++i) {
        const bool beyond = of.free[i] < of.lower[i] || of.free[i] > of.upper[i];
        comes_again = comes_again || (dented && beyond && of.effort[i] == 0);
      }
    }
    if (wrong_ == Wrong::throws_at_second && comes_again) throw std::logic_error("touched before");
    inner_.solve(problem);
    ++solves_;
    for (const int lane : problem.touched) {
      double& p = problem.effort[lane];
      if (wrong_ == Wrong::keeps_in_itself) p *= 1 + 1e-9 * solves_;
      if (wrong_ == Wrong::overshoots && dented) p *= 3;
      if (wrong_ == Wrong::gives_power) problem.outcome[lane].dissipation = -5;
      if (wrong_ == Wrong::rests_with_power) problem.outcome[lane].dissipation = 5;
    }
  }
  double potential(const StopState& at) const override {
    const double dent = at.memory[at.side > 0 ? 0 : 1];
    if (wrong_ == Wrong::negative_energy && dent > 0) return -1e-3;
    if (wrong_ == Wrong::stores_forever) return 0.5 * DentedStop::loading * dent * dent;
    return inner_.potential(at);
  }

 private:
  Wrong wrong_;
  DentedStop inner_;
  int solves_ = 0;
};

CheckResult of_dent(Wrong wrong, const std::string& check) {
  Entry<ContactLaw> entry{full_manual("made-here"), {}, ""};
  entry.make = [=](const Parameters&) { return std::make_unique<WrongDent>(wrong); };
  return one_check(checking::law_checks(), entry, check);
}

enum class Misread { nothing, lane_zero, layer, potential, slopes, declared, first_prepare, damping_of_lane_zero };

/// A spring and a dashpot whose stiffness, viscosity and layer are those of the lane.
class LaneSprings final : public PointwiseContact {
 public:
  explicit LaneSprings(Misread wrong)
      : PointwiseContact({Evaluation::implicit_end, StepForce::at_measure}), wrong_(wrong) {}
  bool reads_rate() const override { return true; }
  bool per_point() const override { return false; }
  double layer(int set) const override { return reach_.at(index(Misread::layer, set)); }
  std::optional<ContactSlopes> linear_slopes(int set) const override {
    return ContactSlopes{.stiffness = kappa_.at(index(Misread::declared, set)), .viscosity = 1};
  }

 private:
  std::size_t index(Misread wrong, int set) const { return wrong_ == wrong ? 0 : static_cast<std::size_t>(set); }
  void set_lanes(std::span<const Parameters> lanes) override {
    if (wrong_ == Misread::first_prepare && kappa_.size() == lanes.size()) return;
    kappa_.clear();
    eta_.clear();
    reach_.clear();
    for (const Parameters& lane : lanes) {
      kappa_.push_back(lane.real("kappa"));
      eta_.push_back(lane.real("eta"));
      reach_.push_back(lane.real("reach"));
    }
  }
  PointForce at(const ContactState& state) const override {
    if (state.depth <= 0) return {};
    const double kappa = kappa_.at(index(Misread::lane_zero, state.set));
    const double eta = eta_.at(index(Misread::damping_of_lane_zero, state.set));
    const double push = kappa * state.depth + eta * state.rate;
    if (push <= 0) return {.dissipation = -kappa * state.depth * state.rate};
    return {.value = push,
            .stiffness = kappa_.at(index(Misread::slopes, state.set)),
            .viscosity = eta,
            .dissipation = eta * state.rate * state.rate};
  }
  PointForce gradient(const ContactState& state) const override { return at(state); }
  double stored(double depth, int set) const override {
    return 0.5 * kappa_.at(index(Misread::potential, set)) * depth * depth;
  }

  Misread wrong_;
  std::vector<double> kappa_, eta_, reach_;
};

CheckResult of_lanes(Misread wrong, const std::string& check) {
  Entry<ContactLaw> entry{full_manual("made-here"), {}, ""};
  for (const auto& [key, unit, value] :
       {std::tuple{"kappa", "N/m", 2e4}, {"eta", "N s/m", 3.0}, {"reach", "m", 1e-3}}) {
    ParameterSpec spec = real_parameter(key, unit, value, {.low = 0, .low_open = true}, "of the tests");
    spec.per_lane = true;
    entry.manual.parameters.push_back(spec);
  }
  entry.make = [=](const Parameters&) { return std::make_unique<LaneSprings>(wrong); };
  return one_check(checking::law_checks(), entry, check);
}

void caught(const CheckResult& result, const std::string& words) {
  INFO(text_of({result}));
  CHECK(result.finding == Finding::fails);
  REQUIRE_FALSE(result.sentences.empty());
  CHECK_THAT(result.sentences.front(), Contains(words));
}

}  // namespace

TEST_CASE("check: a law that keeps a dent passes every check") {
  for (const auto& check : checking::law_checks()) {
    const CheckResult result = of_dent(Wrong::nothing, check.name);
    INFO(text_of({result}));
    CHECK(result.finding != Finding::fails);
  }
  CHECK(of_dent(Wrong::nothing, "solution").finding == Finding::ok);
  CHECK(of_dent(Wrong::nothing, "dissipation").finding == Finding::ok);
  CHECK(of_dent(Wrong::nothing, "memory").finding == Finding::ok);
}

TEST_CASE("check: what a law that remembers gets wrong over load, unload and reload is caught") {
  caught(of_dent(Wrong::forgets, "memory"), "forgotten");
  caught(of_dent(Wrong::keeps_in_itself, "memory"), "must stand in `memory`");
  caught(of_dent(Wrong::throws_at_second, "memory"), "touched before");
  caught(of_dent(Wrong::throws_at_second, "potential"), "touched before");
  caught(of_dent(Wrong::overshoots, "solution"), "differ by");
  caught(of_dent(Wrong::negative_energy, "potential"), "stores -0.001 J");
  caught(of_dent(Wrong::stores_forever, "potential"), "where it has let go");
  caught(of_dent(Wrong::gives_power, "dissipation"), "a law may only take energy");
  caught(of_dent(Wrong::rests_with_power, "dissipation"), "what does not move has no power");
  caught(of_dent(Wrong::wipes_others, "untouched lanes"), "writes what is kept of lane");
  caught(of_dent(Wrong::lane_zero, "lanes independent"), "what is kept of lane 1");
}

TEST_CASE("check: parameter values that switch a memory off are no fault where others keep it") {
  for (const bool ever : {true, false}) {
    Entry<ContactLaw> entry{full_manual("made-here"), {}, ""};
    ParameterSpec keeps;
    keeps.key = "keeps";
    keeps.type = ParameterSpec::Type::boolean;
    keeps.unit = "1";
    keeps.fallback = false;
    keeps.text = "of the tests";
    entry.manual.parameters = {keeps};
    entry.make = [=](const Parameters& values) {
      return std::make_unique<WrongDent>(ever && values.flag("keeps") ? Wrong::nothing : Wrong::forgets);
    };
    const CheckResult result = one_check(checking::law_checks(), std::move(entry), "memory");
    INFO(text_of({result}));
    CHECK((result.finding == Finding::fails) != ever);
  }
}

TEST_CASE("check: lanes of unlike parameters are held against each alone") {
  for (const auto& check : checking::law_checks()) {
    const CheckResult result = of_lanes(Misread::nothing, check.name);
    INFO(text_of({result}));
    CHECK(result.finding != Finding::fails);
  }
  for (const auto& [wrong, words] : {std::pair{Misread::lane_zero, "solve() of lane"},
                                     {Misread::layer, "layer() of lane"},
                                     {Misread::potential, "potential() of lane"},
                                     {Misread::slopes, "of lane 1 is not that of its own"},
                                     {Misread::declared, "linear_slopes() of lane"},
                                     {Misread::first_prepare, "of lane"},
                                     {Misread::damping_of_lane_zero, "solve() of lane"}})
    caught(of_lanes(wrong, "unlike lanes"), words);
}

}  // namespace laws_that_remember
