// A reference in one file: the closed form of an oscillator that nothing drives. Put your solution in its place.
#include <cmath>
#include <ricochet/contract/plugin.hpp>

namespace {

using namespace ricochet;

/// m q'' + c q' + k q = 0. With δ = c/(2m) and ω² = k/m − δ²,
///
///     q  = e^{−δt} (q₀ C + (v₀ + δ q₀) S),     C = cos ωt, S = sin(ωt)/ω
///     q' = e^{−δt} (v₀ C − (δ v₀ + k/m q₀) S)
///
/// C and S are hyperbolic where ω² < 0, and 1 and t where ω² = 0.
class Reference final : public ReferenceSolver {
 public:
  // of_the_mesh() is not overridden: this reference is of the scene, and is asked once for all meshes.

  ReferenceOrRefusal solve(const ReferenceProblem& problem, const SampleGrid& grid) const override {
    // A reference knows some scenes and refuses the others, with what to take instead.
    if (problem.structure != "oscillator")
      return Refusal{"this closed form is that of the oscillator, not of a " + problem.structure +
                     ": use the reference exact, event-driven or self"};
    if (!problem.load_zero || problem.force_amplitude != 0 || problem.support_amplitude != 0)
      return Refusal{"a load, a force or a moving support drives the oscillator: use the reference exact, or self"};
    const double m = problem.inertia, k = problem.stiffness;
    const double c = problem.damping_mass * m + problem.damping_stiffness * k;
    const double q0 = problem.displacement ? problem.displacement(0) : 0;
    const double v0 = problem.velocity ? problem.velocity(0) : 0;
    // Its energy never grows, so it never passes ±√(q₀² + m v₀²/k).
    if (meets_stop(problem, k > 0 ? std::sqrt(q0 * q0 + m / k * v0 * v0) : INFINITY))
      return Refusal{"the oscillator reaches a stop, and only its free motion is known: use the reference exact"};

    ReferenceMotion found;
    SampledMotion& motion = found.motion;
    const double delta = c / (2 * m), square = k / m - delta * delta;
    for (const double t : grid.times) {
      const auto [C, S] = fundamental(delta, square, t);
      const double q = q0 * C + (v0 + delta * q0) * S, v = v0 * C - (delta * v0 + k / m * q0) * S;
      // Each vector over times has one entry per time: absolute displacement and velocity of the tip, energy, …
      motion.tip.push_back(q);
      motion.tip_velocity.push_back(v);
      motion.energy.push_back(0.5 * m * v * v + 0.5 * k * q * q);
      motion.impulse.push_back(0);  // … ∫Σp dt.
      // Fields are times × places, one time after another; an oscillator has no places.
      for (std::size_t i = 0; i < grid.places.size(); ++i) {
        motion.displacement.push_back(q);
        motion.velocity.push_back(v);
        motion.strain.push_back(0);
      }
    }
    // The impacts and releases of a motion go into motion.events, in order; this motion has none.
    // The same motion at a coarser setting goes into found.coarser. The gap of both is how well it is known. A closed
    // form has none.
    found.how = "closed form of the free oscillator";
    return found;
  }

 private:
  static bool meets_stop(const ReferenceProblem& problem, double reach) {
    if (problem.contact_absent) return false;
    for (const double x : problem.stop_places)
      if ((problem.lower && problem.lower(x) > -reach) || (problem.upper && problem.upper(x) < reach)) return true;
    return false;
  }

  struct Fundamental {
    double C = 0, S = 0;
  };
  /// Both with the factor e^{−δt}, so that nothing overflows.
  static Fundamental fundamental(double delta, double square, double t) {
    const double root = std::sqrt(std::abs(square));
    if (square > 0)
      return {std::exp(-delta * t) * std::cos(root * t), std::exp(-delta * t) * std::sin(root * t) / root};
    const double slow = std::exp((root - delta) * t);
    if (square < 0) return {0.5 * slow * (1 + std::exp(-2 * root * t)), -0.5 * slow * std::expm1(-2 * root * t) / root};
    return {slow, slow * t};
  }
};

void register_all(Registry& registry) {
  registry.add_reference({.name = "free-oscillator",
                          .summary = "closed form of the oscillator that nothing drives and that touches nothing",
                          .text = R"(The linear oscillator in every regime of damping, without load, force, moving
          support or contact. Everything else is refused.)",
                          .source = "—",
                          .parameters = {}},
                         [](const Parameters&) { return std::make_unique<Reference>(); });
}

}  // namespace

// Role, name ('-' written '_'), and the function above.
RICOCHET_PLUGIN(reference, free_oscillator, register_all)
