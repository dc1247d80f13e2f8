#include "runners/march/march_pace.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ricochet/engine/flight/flight.hpp>
#include <ricochet/measure/stability/structure_physics.hpp>
#include <variant>
#include <vector>

#include "runners/march/prepare_case.hpp"
#include "runners/march/seconds.hpp"

namespace ricochet {
namespace {

// Without the first ones, which meet cold caches.
constexpr long long few_steps = 400, first_steps = 16, chunk = 32;
// A step that sees less of the motion of the support, or of the slowest mode, meets other contacts.
constexpr double steps_per_period = 200;
constexpr int most_elements = 200;
// Contacts of a coarse step take a larger share of the steps: where there is time for so many times as many, they are
// made. A march that leaves out steps is tried on finer ones, and on its own.
constexpr double worth_refining = 4, refinement = 16;
// How the time of flights grows with the number n of steps, as n^p: measured from 1e4 to 1e9 steps.
constexpr double flight_growth = 0.2;
constexpr double long_parts = 2;  // one that is cut off, and that on the case's own step
// What a step that is left out in contact costs where that is not seen: a share of one that is visited, and no more
// than the works and efforts of so many dofs come to (0.1 to 0.4 µs measured at 100 of them).
constexpr double share_of_visit = 0.2, held_step = 5e-8, held_dof = 1.5e-9;  // –, s, s
// Of so many steps, visiting most is not what any march does that begins: up to 4 √n of n steps are visited.
constexpr long long telling_steps = 4000;
constexpr double telling_time = 3;         // times what another part may take
constexpr long long enough_contact = 500;  // steps

struct Part {
  double seconds = 0, once = 0;     ///< of the steps below; of what came before, beyond that of such steps
  long long steps = 0, of = 0;      ///< marched, and those of the whole
  long long visited = 0, held = 0;  ///< of those marched: not left out; left out in contact
  long long closed = 0;             ///< marched in contact, visited or not
  long long dofs = 0;
  bool standing = false;        ///< no lane stopped on the way
  bool whole = false;           ///< and its end was reached
  bool flies = false;           ///< steps are left out
  bool leaves_contact = false;  ///< in contact too
  bool marginal = false;        ///< see Prepared

  /// Hardly a step is left out: a finer one would leave out more.
  bool visits_most() const { return 2 * visited > steps; }
  /// Of the whole, and long enough for visiting most of it to mean something.
  bool telling() const { return whole && of >= telling_steps; }
  /// Contact changes too often to leave out steps of it.
  bool visits_contact() const { return !visits_most() && closed > enough_contact && 2 * (closed - held) > closed; }
  double step_seconds() const { return seconds / static_cast<double>(steps); }
  double contact_share() const { return static_cast<double>(closed) / static_cast<double>(steps); }
};

// Seconds of a step that is left out in contact: what the two finest marches have in common, of visits and such steps.
// On coarser ones a visit costs less, as flights are shorter. Where such steps are no large part of them, what they
// cost is not seen.
double cost_of_held(const std::vector<Part>& parts) {
  const double unseen = std::min(share_of_visit * parts.front().step_seconds(),
                                 held_step + held_dof * static_cast<double>(parts.front().dofs));
  if (parts.size() < 2) return unseen;
  const Part &fine = parts.back(), &coarse = parts[parts.size() - 2];
  const auto v = static_cast<double>(fine.visited), h = static_cast<double>(fine.held);
  const auto u = static_cast<double>(coarse.visited), g = static_cast<double>(coarse.held);
  const double determinant = u * h - v * g;
  const double found = determinant != 0 ? (u * fine.seconds - v * coarse.seconds) / determinant : 0;
  constexpr double large = 0.3, noise = 1.2;
  if (found * h <= large * fine.seconds || found * h > noise * fine.seconds) return unseen;
  return std::min(found, fine.seconds / h);
}

class Pace {
 public:
  Pace(const StudyCase& study_case, const Registry& registry, const MakeObserver& observe, double seconds)
      : case_(study_case),
        registry_(registry),
        observe_(observe),
        long_enough_(seconds),
        steps_(std::llround(std::min(study_case.duration / study_case.step, 1e15))) {}

  std::optional<double> found() {
    double step = std::max(case_.step, coarsest_step());
    std::optional<Part> part = march(step, long_enough_);
    while (step > case_.step && (!part || !part->standing)) {
      step = std::max(case_.step, step / refinement);
      part = march(step, long_enough_);
    }
    if (!part) return std::nullopt;
    std::vector<Part> parts{*part};
    if (part->flies) long_enough_ /= long_parts;
    while (part->of < steps_ && part->seconds < long_enough_) {
      const double finer = part->flies ? refinement : long_enough_ / part->seconds;
      if (finer < worth_refining) break;
      if (!add(case_.duration / (finer * static_cast<double>(part->of)), parts) || !part->flies) break;
      part = parts.back();
    }
    if (!parts.back().flies) return parts.back().step_seconds();
    // What is disturbed once may be visited from then on: of that the first few hundred steps tell nothing.
    const bool told = std::any_of(parts.begin(), parts.end(), [](const Part& one) { return one.telling(); });
    if (parts.back().marginal && !told && steps_ > telling_steps)
      add(case_.duration / static_cast<double>(telling_steps), parts, telling_time * long_enough_);
    const auto whole = std::find_if(parts.rbegin(), parts.rend(), [](const Part& one) { return one.whole; });
    const bool flown = whole != parts.rend() && !whole->visits_most();
    if (!flown && parts.back().of < steps_) add(case_.step, parts);
    return whole_seconds(parts) / static_cast<double>(steps_);
  }

 private:
  /// The largest step that stands for the case's own, s.
  double coarsest_step() const {
    const double pulsation = case_.scene.support.pulsation > 0 ? case_.scene.support.pulsation : slowest_pulsation();
    const double few = case_.duration / static_cast<double>(few_steps);
    return pulsation > 0 ? std::min(few, 2 * std::numbers::pi / (pulsation * steps_per_period)) : few;
  }

  /// Of the structure, rad/s; 0 where it is not known, or finding it would cost more than it tells.
  double slowest_pulsation() const {
    if (case_.elements > most_elements) return 0;
    const auto mass = registry_.mass(case_.mass.name)->make(case_.mass.parameters);
    const auto found = structure_physics(case_.scene, case_.elements, *mass);
    const auto* physics = std::get_if<StructurePhysics>(&found);
    return physics && !physics->pulsations.empty() ? physics->pulsations.front() : 0;
  }

  /// Marches on a finer step; whether its lanes stand.
  bool add(double step, std::vector<Part>& parts, std::optional<double> long_enough = std::nullopt) const {
    const std::optional<Part> part = march(std::max(case_.step, step), long_enough.value_or(long_enough_));
    if (!part || !part->standing) return false;
    parts.push_back(*part);
    std::stable_sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.of < b.of; });
    return true;
  }

  /// Of the case, where steps are left out: in contact a share of its steps, which a coarser march of the whole
  /// duration tells; between contacts flights, whose time that march tells too, or, where it hardly left out a step,
  /// the beginning of the case itself, which may not have seen the contact that comes later.
  double whole_seconds(const std::vector<Part>& parts) const {
    const Part& finest = parts.back();
    const auto n = static_cast<double>(steps_);
    const auto whole = std::find_if(parts.rbegin(), parts.rend(), [](const Part& part) { return part.whole; });
    if (whole == parts.rend() || whole->of == steps_ || finest.visits_most())
      return finest.once + finest.step_seconds() * n;
    // What is disturbed once is visited from then on.
    if (whole->marginal && whole->telling() && whole->visits_most()) return whole->step_seconds() * n;
    const bool leaves_contact = finest.leaves_contact && !whole->visits_contact();
    const double in_contact = leaves_contact ? cost_of_held(parts) : parts.front().step_seconds();
    const auto between = [&](const Part& part) {
      const auto met = static_cast<double>(leaves_contact ? part.held : part.closed);
      return std::max(0.0, part.seconds - in_contact * met);
    };
    const double share = whole->contact_share();
    const double flights = whole->visits_most()
                               ? between(finest) * (1 - share) * n / static_cast<double>(finest.steps - finest.closed)
                               : between(*whole) * std::pow(n / static_cast<double>(whole->of), flight_growth);
    return whole->once + flights + share * n * in_contact;
  }

  /// As much of the march on this step as is long enough. Its operator is chosen by the steps of the whole case.
  std::optional<Part> march(double step, double long_enough) const {
    StudyCase other = case_;
    other.step = step;
    Prepared prepared = prepare_case(other, registry_, steps_);
    if (!prepared.program) return std::nullopt;
    Marcher marcher(std::move(*prepared.program));
    const std::shared_ptr<const Observers> watched = observe_ ? observe_(other, marcher, prepared.steps) : nullptr;
    const Observers observers = watched ? *watched : Observers{};
    marcher.start(observers);
    Part part;
    part.of = prepared.steps;
    part.dofs = marcher.program().problem->dofs();
    part.marginal = prepared.marginal;
    if (const auto& flight = marcher.program().flight) {
      part.flies = true;
      part.leaves_contact = flight->closed_cause().empty() || flight->steps_cause().empty();
    }
    // Flights end where the case is sampled; the first one makes what all of them need.
    const long long few = part.flies ? std::max(chunk, prepared.steps / std::max(1, case_.samples)) : chunk;
    const double begin = thread_seconds();
    if (prepared.steps > few_steps / 2) marcher.march(part.flies ? few : first_steps, observers);
    const long long before = marcher.step(), visited = marcher.steps_visited(), held = marcher.closed_left_out(),
                    closed = marcher.closed_steps();
    const double start = thread_seconds();
    double now = start;
    while (marcher.step() < prepared.steps && marcher.any_running() && now - start < long_enough) {
      marcher.march(std::min(few, prepared.steps - marcher.step()), observers);
      now = thread_seconds();
    }
    if (marcher.step() <= before) return std::nullopt;
    part.standing = marcher.any_running();
    part.whole = part.standing && marcher.step() == prepared.steps;
    part.steps = marcher.step() - before;
    part.visited = marcher.steps_visited() - visited;
    part.held = marcher.closed_left_out() - held;
    part.closed = marcher.closed_steps() - closed;
    part.seconds = now - start;
    part.once = std::max(0.0, start - begin - part.step_seconds() * static_cast<double>(before));
    return part;
  }

  const StudyCase& case_;
  const Registry& registry_;
  const MakeObserver& observe_;
  double long_enough_;  // s
  const long long steps_;
};

}  // namespace

std::optional<double> march_pace(const StudyCase& study_case, const Registry& registry, const MakeObserver& observe,
                                 double seconds) {
  return Pace(study_case, registry, observe, seconds).found();
}

}  // namespace ricochet
