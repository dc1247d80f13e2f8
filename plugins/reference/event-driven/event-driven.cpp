#include <fmt/format.h>

#include <ricochet/contract/plugin.hpp>
#include <ricochet/contract/reference.hpp>
#include <ricochet/contract/said_format.hpp>

#include "beam_run.hpp"

// The phases of the beam as a map of x = (a, b), modal displacements and velocities of flight.
namespace ricochet::event_driven {

class BeamMap final : public ReferenceMap {
 public:
  BeamMap(const ReferenceProblem& problem, const Settings& settings)
      : problem_(problem), modes_(settings.modes), run_(problem_, grid_, settings) {
    problem_.discrete = nullptr;
  }

  int size() const override { return 2 * modes_; }
  Eigen::VectorXd start() const override {
    Eigen::ArrayXd a, b;
    run_.project_start(a, b);
    return joined(a, b);
  }
  Eigen::VectorXd weights() const override {
    const Beam& beam = run_.beam();
    const double weight = 1 / std::sqrt(beam.length);
    const double omega = beam.support.pulsation > 0 ? beam.support.pulsation : 1;
    Eigen::VectorXd all = Eigen::VectorXd::Constant(size(), weight);
    all.tail(modes_) /= omega;
    return all;
  }
  std::pair<double, double> tip(const Eigen::VectorXd& x) const override {
    const Beam& beam = run_.beam();
    const Eigen::VectorXd shape = beam.free.end_value.matrix();
    return {shape.dot(x.head(modes_)) + beam.support.at(0), shape.dot(x.tail(modes_)) + beam.support.rate(0)};
  }
  Image march(const Eigen::VectorXd& x, double span, bool derivative) override {
    Image image;
    if (derivative) image.derivative = Eigen::MatrixXd::Identity(size(), size());
    grid_.times = {span};
    Eigen::ArrayXd a = x.head(modes_).array(), b = x.tail(modes_).array();
    const auto motion = run_.motion_from(a, b, derivative ? &image.derivative : nullptr);
    if (const auto* refusal = std::get_if<Refusal>(&motion)) {
      image.stopped = refusal->sentence.text;
      return image;
    }
    for (const ContactEvent& event : std::get<SampledMotion>(motion).events) image.impacts += event.begins;
    image.state = joined(a, b);
    return image;
  }

 private:
  static Eigen::VectorXd joined(const Eigen::ArrayXd& a, const Eigen::ArrayXd& b) {
    Eigen::VectorXd x(a.size() + b.size());
    x << a.matrix(), b.matrix();
    return x;
  }

  ReferenceProblem problem_;
  SampleGrid grid_;
  int modes_;
  BeamRun run_;
};

}  // namespace ricochet::event_driven

namespace {

using namespace ricochet;
using namespace ricochet::event_driven;

/// Modal phases of the continuous beam, exact between impacts and releases of the tip.
class EventDriven final : public ReferenceSolver {
 public:
  explicit EventDriven(Settings settings) : settings_(settings) {}

  ReferenceOrRefusal solve(const ReferenceProblem& problem, const SampleGrid& grid) const override {
    if (auto refusal = does_not_apply(problem)) return *refusal;
    Settings half = settings_;
    half.modes = settings_.modes / 2;
    BeamRun run(problem, grid, settings_);
    auto fine = run.motion();
    if (auto* refusal = std::get_if<Refusal>(&fine)) return *refusal;
    auto coarse = BeamRun(problem, grid, half).motion();
    if (auto* refusal = std::get_if<Refusal>(&coarse)) return *refusal;
    ReferenceMotion result;
    result.motion = std::move(std::get<SampledMotion>(fine));
    result.coarser = std::move(std::get<SampledMotion>(coarse));
    result.how = fmt::format(
        "continuous beam, exact between events: {} clamped–free modes in flight, as many clamped–pinned modes and a "
        "lift in contact. Events are isolated within {:g} of the largest displacement. The coarser run has {} modes",
        settings_.modes, settings_.tolerance, half.modes);
    result.notes = notes(problem, result, run.initial_energy_left_out(), grid.times.empty() ? 0 : grid.times.back());
    return result;
  }

  ReferenceMapOrRefusal map(const ReferenceProblem& problem) const override {
    if (auto refusal = does_not_apply(problem)) return *refusal;
    return std::make_unique<BeamMap>(problem, settings_);
  }

 private:
  std::optional<Refusal> does_not_apply(const ReferenceProblem& problem) const {
    if (problem.structure != "beam")
      return Refusal{
          said("event-driven solves the continuous beam, and the structure is a{} {}: the closed forms of "
               "`exact` are made for it, `self` refines any scheme",
               problem.structure.starts_with('o') ? "n" : "", problem.structure)};
    if (problem.other_beam)
      return Refusal{
          "event-driven knows the uniform beam clamped at x = 0 and free at x = L: this one has other supports, "
          "sections, masses, tension or a foundation. Use `event-driven-semi-discrete` or `self`"};
    if (problem.right_fixed)
      return Refusal{
          "event-driven solves a beam that is clamped at x = 0 and free at x = L; this one is fixed at x = L"};
    const bool touched = stops_act(problem);
    if (touched && !only_the_tip(problem))
      return Refusal{
          "event-driven knows stops at the tip only, where one contact phase has one set of modes. Place the stops at "
          "\"tip\", or use `event-driven-semi-discrete`, which follows any points of a coarse mesh"};
    if (touched && (problem.contact_stiffness > 0 || problem.contact_nonlinear))
      return Refusal{
          "event-driven holds the tip on a rigid stop, and the contact law is compliant: its motion differs by the "
          "penetration. Use a rigid law, or `event-driven-semi-discrete`, which follows a linear spring"};
    if (!problem.load_zero && !problem.load_constant)
      return Refusal{
          "the load depends on time, and event-driven has the exact solution of constant loads only: drop t from "
          "`load`, or use `self`. The support may move"};
    if (!(problem.damping_stiffness >= 0 && problem.damping_mass >= 0))
      return Refusal{"event-driven needs damping coefficients that are not negative"};
    return resonance(problem, touched);
  }

  std::optional<Refusal> resonance(const ReferenceProblem& problem, bool touched) const {
    if (problem.support_amplitude == 0) return {};
    const Beam beam(problem, settings_.modes);
    const double pulsation = problem.support_pulsation;
    for (const BeamModes* modes : {&beam.free, &beam.pinned}) {
      if (modes == &beam.pinned && !touched) break;
      const Oscillators mode = oscillators(beam, *modes);
      for (Eigen::Index m = 0; m < mode.size(); ++m)
        if (std::hypot(mode.stiffness(m) - pulsation * pulsation, mode.damping(m) * pulsation) <
            1e-7 * mode.stiffness(m))
          return Refusal{
              said("the support moves at the pulsation of undamped mode {} {} ({:.9g} rad/s), which grows "
                   "without bound: add damping. Otherwise move the pulsation by more than 1e-7 of it",
                   m + 1, modes == &beam.free ? "of the free beam" : "of the beam held at its tip",
                   std::sqrt(mode.stiffness(m)))};
    }
    return {};
  }

  std::vector<std::string> notes(const ReferenceProblem& problem, const ReferenceMotion& result, double left_out,
                                 double duration) const {
    std::vector<std::string> found;
    const double alpha = problem.damping_stiffness;
    const bool touched = !result.motion.events.empty();
    if (touched && alpha == 0)
      found.push_back(
          "without stiffness-proportional damping the modes converge slowly: an impact loses the energy of those left "
          "out, and breaks into many short contacts. Impulses, energies and the first impact are known to a few "
          "digits. Late trajectories are not known");
    if (left_out > 1e-4 && (alpha == 0 || alpha > 1e-3 * duration))
      found.push_back(fmt::format(
          "the initial state bends the beam at its free end, or moves it at the clamp: the modes hold all but "
          "{:.2g} of its energy, {}",
          left_out,
          alpha == 0 ? "and nothing damps that share"
                     : fmt::format("a share that lasts for a time of the order of α = {:g} s", alpha)));
    if (touched && problem.restitution > 0)
      found.push_back(
          fmt::format("the restitution {:g} has no part in it: the tip of a continuous beam has no mass. Schemes tend "
                      "to this motion as the mesh is refined, whatever their coefficient",
                      problem.restitution));
    if (problem.projected)
      found.push_back(
          "it starts from the formulas of the initial state, the methods from its projection on the mesh. The mesh "
          "decides by how much the two differ");
    const BeamModes modes(BeamModes::End::free, settings_.modes, problem.length);
    const double highest = std::sqrt(problem.stiffness / problem.inertia) * modes.wave_number(settings_.modes - 1) *
                           modes.wave_number(settings_.modes - 1);
    if (problem.support_amplitude != 0 && problem.support_pulsation > 0.3 * highest)
      found.push_back(fmt::format(
          "the support moves at {:g} rad/s, near or above the highest mode kept ({:.4g} rad/s): raise `modes`",
          problem.support_pulsation, highest));
    if (result.motion.events.size() != result.coarser.events.size())
      found.push_back(fmt::format("half the modes find {} impacts and releases instead of {}: the two motions part",
                                  result.coarser.events.size(), result.motion.events.size()));
    return found;
  }

  Settings settings_;
};

void register_event_driven(Registry& registry) {
  registry.add_reference(
      {.name = "event-driven",
       .summary = "the continuous beam between stops at its tip, exact between impacts and releases",
       .text = R"(No mesh and no step. In flight the beam is a sum of clamped–free modes, in contact a cubic lift
          plus clamped–pinned modes; each mode is a damped oscillator in closed form (C = αK + ηM, below, at and
          above critical damping), forced by the support A sin(ωt + ψ) and by a load that is constant in time.
          Displacement and velocity are continuous (L²) at switches. Impacts are roots of the gap, releases are
          changes of sign of the stop's force; both are isolated by readings between which the quantity is its cubic
          interpolant within a bound that the modes give, so that no touch is stepped over. Just after a switch the
          truncated sum leaves the tip a hair beyond the stop: a new touch counts once the gap has opened beyond
          that hair. The restitution of schemes has no counterpart. With α > 0 many digits are known; with α = 0
          convergence is slow.)",
       .source = R"(modes: Young and Felgar (1949); the contact problem: Dumont and Paoli (2006); the switch between
          two modal bases is elementary L² projection)",
       .parameters = {integer_parameter("modes", 80, {.low = 4, .high = 320},
                                        "number of modes of each phase; the coarser motion has half of it"),
                      real_parameter(
                          "tolerance", "1", 1e-12, {.low = 1e-14, .high = 1e-6},
                          "resolution of the gap in the search for events, over the largest displacement of the scene"),
                      integer_parameter(
                          "events", 2000, {.low = 1, .high = 1e9},
                          R"(impacts and releases allowed per period of the first mode before the motion is refused as
          chatter)")},
       .words = "the continuous beam"},
      [](const Parameters& p) {
        return std::make_unique<EventDriven>(Settings{static_cast<int>(p.integer("modes")), p.real("tolerance"),
                                                      static_cast<double>(p.integer("events"))});
      });
}

}  // namespace

RICOCHET_PLUGIN(reference, event_driven, register_event_driven)
