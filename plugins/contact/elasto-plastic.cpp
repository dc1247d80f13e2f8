#include <algorithm>

#include "power_law.hpp"

namespace {

using namespace ricochet;

/// p = k (δ − s)₊ where s, the permanent set, is the largest value that (1 − η)(δ − F/k) has had, at least 0.
///
/// On the way to a new depth the force is F + η k (δ − F/k) from F on, on all other ways it goes by k. The gap has
/// grown by s. The set takes the work F s + ½ H s², H = η k/(1 − η).
struct YieldingSpring {
  PowerLaw spring;       ///< k, exponent 1
  double share = 1;      ///< 1 − η
  double yield = 0;      ///< F, N
  double elastic = 0;    ///< F/k, m
  double hardening = 0;  ///< η k, N/m

  double set(double depth, double kept) const { return std::max(kept, share * (depth - elastic)); }
  /// The depth from which the spring yields further.
  double yields(double kept) const { return elastic + kept / share; }

  /// The force that yields at this depth, known to its own round-off where k (δ − s) would cancel.
  double yielding(double depth) const { return yield + hardening * (depth - elastic); }

  PointForce at(double depth, double rate, double kept) const {
    if (!(set(depth, kept) > kept)) return spring.at(depth - kept);
    const double force = yielding(depth);
    return {.value = force, .stiffness = hardening, .dissipation = share * force * std::max(rate, 0.0)};
  }

  /// The work over the way from δ⁻ to δ by its length. An elastic part ends where the spring yields; from there the
  /// mean of the ends is exact.
  PointForce between(double depth, double before, double rate, double earlier) const {
    const double kept = set(before, earlier), start = std::max(yields(kept), before);
    if (!(depth > start)) return spring.between(depth - kept, before - kept);
    const PointForce way = spring.between(start - kept, before - kept);
    const double part = (depth - start) / (depth - before), rest = 1 - part;
    const double mean = yielding(0.5 * (start + depth));
    return {.value = rest * way.value + part * mean,
            .stiffness = rest * (rest * way.stiffness + part * hardening) + 0.5 * part * part * hardening,
            .before = rest * rest * way.before + part * (rest * (way.stiffness + way.before) + 0.5 * part * hardening),
            .dissipation = part * share * mean * std::max(rate, 0.0)};
  }
};

/// Memory: the permanent sets of the lower and of the upper stop, m.
class ElastoPlastic final : public PointwiseContact {
 public:
  using PointwiseContact::PointwiseContact;
  // The force does not depend on the rate: what is lost per time does.
  bool reads_rate() const override { return true; }
  int memory_per_point() const override { return 2; }
  // The set depends on the state as well, and that derivative is not carried.
  bool offers_slopes() const override { return false; }

  void solve(ReducedProblem& problem) override {
    problem_ = &problem;
    PointwiseContact::solve(problem);
    const bool own = laws_.size() > static_cast<std::size_t>(problem.lanes);
    for (const int lane : problem.touched)
      each_depth(problem, lane, [&](int point, int side, double depth) {
        const YieldingSpring& law = laws_[static_cast<std::size_t>(own ? point * problem.lanes + lane : lane)];
        double& kept = problem.memory_of(lane, memory_of_side(side))[point];
        kept = law.set(depth, kept);
      });
  }
  double potential(const StopState& at) const override {
    const YieldingSpring& law = laws_[static_cast<std::size_t>(at.set)];
    return law.spring.stored(at.depth - law.set(at.depth, at.memory[memory_of_side(at.side)]));
  }

 private:
  void set_lanes(std::span<const Parameters> lanes) override {
    laws_.clear();
    for (const Parameters& lane : lanes) {
      const double k = lane.real("stiffness"), hardening = lane.real("hardening"), yield = lane.real("yield_force");
      laws_.push_back({{k, 1}, 1 - hardening, yield, yield / k, hardening * k});
    }
  }
  double kept(const ContactState& state) const {
    return problem_->memory_of(state.lane, memory_of_side(state.side))[state.point];
  }
  PointForce at(const ContactState& state) const override {
    return laws_[static_cast<std::size_t>(state.set)].at(state.depth, state.rate, kept(state));
  }
  PointForce gradient(const ContactState& state) const override {
    return laws_[static_cast<std::size_t>(state.set)].between(state.depth, state.before, state.rate, kept(state));
  }
  double stored(double, int) const override { return 0; }  // what is kept decides: potential()

  std::vector<YieldingSpring> laws_;
  const ReducedProblem* problem_ = nullptr;  // while it is solved
};

void register_elasto_plastic(Registry& registry) {
  ParameterSpec yield = real_parameter("yield_force", "N", std::nullopt, {.low = 0, .low_open = true},
                                       "F, force from which the stop is first set for good");
  ParameterSpec hardening = real_parameter("hardening", "1", 0.0, {.low = 0, .high = 1, .high_open = true},
                                           "η, share of the stiffness that is left while the stop yields");
  yield.per_lane = hardening.per_lane = true;
  registry.add_contact(
      {.name = "elasto-plastic",
       .summary = "a spring behind each stop that yields, and leaves a larger gap",
       .text =
           R"(A point that passes a stop by δ is pushed back with k (δ − s), never pulled. The permanent set s is the
          largest value that (1−η)(δ − F/k) has had: from the force F on, the stop gives way with the slope η k, and
          lets go with the slope k. The gap is larger by s from then on, at each point and side of its own. A
          round clearance keeps one set for all directions. Penetration
          is measured at the stop as it was. A set s takes F s + ½ η k s²/(1−η). A free mass m that arrives at speed v
          above F/√(k m) leaves a set of (m v² − F²/k)/(2 F) where η = 0, and keeps F/(v √(k m)) of its speed.
          A larger F than any force makes it the penalty. )" +
           std::string(damped_evaluation_text) +
           R"(The set is that of the depth that is measured. The force does not depend on the speed. What yielding
          takes per time does, and is reported as dissipated by the law. As the law remembers s, it offers no tangents:
          exponents are those of twins.)",
       .source = R"(Simo and Hughes (1998), Computational Inelasticity, section 1.2; Muthukumar (2003), A contact
          element approach with hysteresis damping for the analysis and design of pounding in bridges)",
       .parameters = {with_role(stiffness_parameter("N/m", "k, stiffness of the spring at each contact point"),
                                ParameterRole::stiffness),
                      yield, hardening, evaluation_parameter()}},
      [](const Parameters& p) { return std::make_unique<ElastoPlastic>(evaluation_of(p)); });
}

}  // namespace

RICOCHET_PLUGIN(contact, elasto_plastic, register_elasto_plastic)
