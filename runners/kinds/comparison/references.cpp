#include "runners/kinds/comparison/references.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <numeric>
#include <optional>
#include <ricochet/contract/reference.hpp>
#include <ricochet/contract/said_format.hpp>
#include <ricochet/measure/motion/motion_errors.hpp>
#include <ricochet/measure/motion/motion_sampler.hpp>
#include <ricochet/measure/orbits/impact_jump.hpp>
#include <ricochet/scene/assembly.hpp>
#include <ricochet/scene/bodies.hpp>
#include <ricochet/scene/checks.hpp>
#include <ricochet/scene/observed_rows.hpp>
#include <ricochet/scene/semi_discrete.hpp>
#include <ricochet/scene/supports.hpp>

#include "runners/march/bytes.hpp"
#include "runners/march/prepare_case.hpp"
#include "runners/store/fingerprint.hpp"
#include "runners/study/fields.hpp"

namespace ricochet {
namespace {

constexpr int cells = 64;
constexpr const char* to_the_end = "the end of the run";
constexpr const char* not_seen =
    "the end of the run. How long two runs nearby stay together is not told: the schemes meet the stops at whole "
    "steps, which runs nearby share";

// A motion marched to the end of the grid, or why there is none.
struct Marched {
  std::optional<SampledMotion> motion;
  Said refusal;
  double order = 1;
  bool at_steps = false;  ///< stops_met_at_steps()
};

Marched march(const StudyCase& study_case, const Registry& registry, const SampleGrid& grid,
              const std::function<void(LaneSpec&)>& change, const std::atomic<bool>& stop) {
  Marched marched;
  Prepared prepared = prepare_case(study_case, registry);
  if (!prepared.program) {
    marched.refusal = prepared.refusal;
    return marched;
  }
  marched.order = prepared.program->plan.facts.order;
  marched.at_steps = stops_met_at_steps(*prepared.program);
  if (change) change(prepared.program->lanes.front());
  Marcher marcher(std::move(*prepared.program));
  MotionSampler sampler(marcher, grid);
  sampler.march([&] {
    if (stop) throw Interrupted{};
    return true;
  });
  if (sampler.sampled() == grid.times.size())
    marched.motion = sampler.finish();
  else
    marched.refusal = said("at h = {:g} s the method itself stops at t = {:.6g} s: {}", study_case.step,
                           marcher.status(0).time, text(marcher.status(0).end));
  return marched;
}

// A case of the same scene and methods at another step and mesh.
StudyCase at(const StudyCase& study_case, double step, int elements, const std::optional<BasisSpec>& basis) {
  StudyCase other = study_case;
  other.step = step;
  other.elements = elements;
  other.scene.basis = basis;
  return other;
}

}  // namespace

SampleGrid comparison_grid(const SceneSpec& scene, double duration, int samples) {
  SampleGrid grid;
  for (int k = 0; k <= samples; ++k) grid.times.push_back(k == samples ? duration : duration * k / samples);
  sample_places(structure_length(scene), cells, grid);
  return grid;
}

References::References(const Study& study, const Registry& registry, CheckpointStore checkpoints)
    : study_(study), registry_(registry), checkpoints_(std::move(checkpoints)) {
  smallest_step_ = study.cases.front().step;
  coarsest_ = finest_ = study.cases.front().elements;
  for (const StudyCase& one : study.cases) {
    smallest_step_ = std::min(smallest_step_, one.step);
    coarsest_ = std::min(coarsest_, one.elements);
    finest_ = std::max(finest_, one.elements);
    if (std::find(bases_.begin(), bases_.end(), one.scene.basis) == bases_.end()) bases_.push_back(one.scene.basis);
  }
  // All dofs first, then by the number of modes.
  std::sort(bases_.begin(), bases_.end(), [](const auto& a, const auto& b) {
    const auto richness = [](const std::optional<BasisSpec>& one) {
      return one ? std::pair(one->modes, one->residual) : std::pair(std::numeric_limits<int>::max(), true);
    };
    return richness(a) > richness(b);
  });
}

template <class Value>
Value References::once(std::map<std::string, Known<Value>>& known, const std::string& key,
                       const std::function<Value()>& make) {
  const auto found = known.find(key);
  if (found != known.end() && found->second.failure) std::rethrow_exception(found->second.failure);
  if (found != known.end()) return *found->second.value;
  try {
    Value value = make();
    known[key].value = value;
    return value;
  } catch (const Interrupted&) {
    throw;
  } catch (...) {
    known[key].failure = std::current_exception();
    throw;
  }
}

std::string References::key(const StudyCase& study_case, const MethodChoice& choice) const {
  Json content = {{"program", program_hash()},
                  {"reference", content_of(choice)},
                  {"scene", study_case.scene_json},
                  {"duration", study_case.duration},
                  {"samples", study_case.samples}};
  const bool marched = choice.name == marched_reference;
  const auto* entry = marched ? nullptr : registry_.reference(choice.name);
  if (entry && !entry->file.empty()) content["library"] = file_hash(entry->file);
  const bool of_the_mesh = marched || entry->make(choice.parameters)->of_the_mesh();
  if (of_the_mesh) {
    content["mass"] = content_of(study_case.mass);
    content["contact"] = content_of(study_case.contact);
    for (const auto& [role, name] :
         {std::pair(Role::mass, study_case.mass.name), {Role::contact, study_case.contact.name}})
      if (const std::string file = registry_.file(role, name); !file.empty())
        content["libraries"].push_back(file_hash(file));
  }
  if (marched && !study_case.friction.name.empty()) content["friction"] = content_of(study_case.friction);
  if (marched) {
    content["time"] = content_of(study_case.time);
    if (const std::string file = registry_.file(Role::time, study_case.time.name);
        !study_case.time.plan && !file.empty())
      content["libraries"].push_back(file_hash(file));
    content["elements"] = study_case.elements;
    content["refined"] = {smallest_step_, coarsest_, finest_};
    if (bases_.size() > 1)
      for (const std::optional<BasisSpec>& basis : {bases_[0], bases_[1]})
        content["bases"].push_back(basis ? Json{basis->modes, basis->residual} : Json(nullptr));
  } else if (of_the_mesh) {
    content["elements"] = study_case.elements;
    content["restitution"] = reference_problem(study_case, registry_).restitution;
  } else {
    const ReferenceProblem problem = reference_problem(study_case, registry_);
    content["absent"] = problem.contact_absent;
    if (problem.structure == "oscillator") {
      content["restitution"] = problem.restitution;
      if (problem.contact_stiffness > 0) content["stiffness"] = problem.contact_stiffness;
      if (problem.contact_nonlinear) content["contact"] = content_of(study_case.contact);
    }
  }
  return content_hash(content.dump(-1, ' ', false, Json::error_handler_t::replace));
}

// Where modes are refined, twice the most of the study, as far as the structure has so many.
std::optional<BasisSpec> References::richer_basis(const SceneSpec& scene, int elements) const {
  std::optional<BasisSpec> basis = bases_.front();
  if (!basis || bases_.size() == 1) return basis;
  const SceneSpec meshed = on_mesh(scene, elements);
  if (const JoinedBodies* bodies = bodies_of(meshed.structure)) {
    std::vector<int> each;
    for (std::size_t b = 0; b < bodies->all.size(); ++b) {
      const int own = basis->of_bodies.empty() ? basis->modes : basis->of_bodies[b];
      each.push_back(std::max(own, std::min(2 * own, semidefinite_rank(consistent_mass(bodies->all[b].space)))));
    }
    basis->modes = std::accumulate(each.begin(), each.end(), 0);
    basis->of_bodies = std::move(each);
    return basis;
  }
  const int with_mass = semidefinite_rank(consistent_mass(make_space(scene.structure, elements)));
  basis->modes = std::max(basis->modes, std::min(2 * basis->modes, with_mass));
  return basis;
}

KnownReference References::march_finer(const StudyCase& study_case, const std::atomic<bool>& stop) const {
  KnownReference known{marched_reference, "", coarsest_ == finest_, {}};
  const double smallest = smallest_step_;
  const int finest = finest_;
  const bool several = finest_ != coarsest_;
  const int elements = several ? 2 * finest : study_case.elements;
  const SampleGrid grid = comparison_grid(study_case.scene, study_case.duration, study_case.samples);
  const std::optional<BasisSpec> richest = richer_basis(study_case.scene, elements);
  const Marched coarse = march(at(study_case, smallest / 4, elements, richest), registry_, grid, nullptr, stop);
  const Marched fine = march(at(study_case, smallest / 8, elements, richest), registry_, grid, nullptr, stop);
  for (const Marched* one : {&coarse, &fine})
    if (!one->motion) {
      known.refusal = one->refusal;
      return known;
    }
  const double order = fine.motion->events.empty() ? fine.order : 1;
  known.found.motion = extrapolated(*fine.motion, *coarse.motion, 2, order);
  known.found.coarser = *fine.motion;
  known.found.how = fmt::format("the method itself at h = {:g} and {:g} s on {} elements, extrapolated with order {:g}",
                                smallest / 4, smallest / 8, elements, order);
  if (richest && bases_.size() > 1) known.found.how += fmt::format(", {} modes", richest->modes);
  const auto widen = [&](const StudyCase& poorer, const std::string& named) {
    const Marched other = march(poorer, registry_, grid, nullptr, stop);
    if (!other.motion) return;
    const auto size = [&](const SampledMotion& motion) {
      return *motion_errors(motion, known.found.motion, grid, grid.times.back(), {"tip-linf"})[0].value;
    };
    if (!(size(*other.motion) > size(known.found.coarser))) return;
    known.found.coarser = *other.motion;
    known.found.how += "; its gap is that to " + named;
  };
  if (several) widen(at(study_case, smallest / 4, finest, richest), fmt::format("{} elements", finest));
  if (bases_.size() > 1) {
    const std::optional<BasisSpec>& poorer = richest == bases_.front() ? bases_[1] : bases_.front();
    widen(at(study_case, smallest / 4, elements, poorer), fmt::format("{} modes", poorer->modes));
  }
  return known;
}

KnownReference References::compute(const StudyCase& study_case, const MethodChoice& choice,
                                   const std::atomic<bool>& stop) const {
  if (choice.name == marched_reference) return march_finer(study_case, stop);
  const auto solver = registry_.reference(choice.name)->make(choice.parameters);
  KnownReference known{choice.name, "", solver->of_the_mesh(), {}};
  const SampleGrid grid = comparison_grid(study_case.scene, study_case.duration, study_case.samples);
  DiscreteProblem discrete;
  auto seen = seen_by_reference(study_case, registry_, solver->of_the_mesh());
  if (const auto* refusal = std::get_if<Refusal>(&seen)) {
    known.refusal = refusal->sentence;
    return known;
  }
  auto& problem = std::get<ReferenceProblem>(seen);
  if (solver->of_the_mesh()) {
    const auto law = make_law(study_case, registry_);
    auto built = discretise(study_case.scene, study_case.elements, *make_mass(study_case, registry_), law.get(),
                            &study_case.contact.parameters);
    if (const auto* refusal = std::get_if<Refusal>(&built)) {
      known.refusal = refusal->sentence;
      return known;
    }
    discrete = discrete_problem(std::get<SemiDiscrete>(built), grid.places);
    problem.discrete = &discrete;
    // The stiffness of a law that changes the problem is known since.
    if (law->changes_problem())
      if (const auto stiffness = constant_stiffness(*law)) {
        problem.contact_nonlinear = false;
        problem.contact_stiffness = *stiffness;
      }
  }
  auto solved = solver->solve(problem, grid);
  if (const auto* refusal = std::get_if<Refusal>(&solved))
    known.refusal = refusal->sentence;
  else
    known.found = std::get<ReferenceMotion>(std::move(solved));
  return known;
}

ReferencePointer References::find(const StudyCase& study_case, const MethodChoice& choice,
                                  const std::atomic<bool>& stop) {
  const std::string name = key(study_case, choice);
  return once<ReferencePointer>(known_, name, [&]() -> ReferencePointer {
    if (auto stored = recall(checkpoints_, name, motion_from_bytes)) {
      const bool marched = choice.name == marched_reference;
      const bool mesh =
          marched ? coarsest_ == finest_ : registry_.reference(choice.name)->make(choice.parameters)->of_the_mesh();
      return std::make_shared<const KnownReference>(KnownReference{choice.name, "", mesh, std::move(*stored)});
    }
    KnownReference known = compute(study_case, choice, stop);
    if (known.refusal.empty() && checkpoints_.keep) checkpoints_.keep(name, to_bytes(known.found));
    return std::make_shared<const KnownReference>(std::move(known));
  });
}

References::Twin References::twin_horizon(const StudyCase& study_case, const std::atomic<bool>& stop) {
  // One pair of nearby runs per scene and mesh, of one case at its own step. It is the first of them that marches to
  // its end and whose impacts move with its motion.
  const Json name = {{"scene", study_case.scene_json}, {"elements", study_case.elements}};
  return once<Twin>(twins_, name.dump(), [&]() -> Twin {
    bool blind = false;
    for (const StudyCase& chosen : study_.cases) {
      if (chosen.excluded || chosen.scene_json != study_case.scene_json || chosen.elements != study_case.elements ||
          (checkpoints_.failed && checkpoints_.failed(chosen.id)))
        continue;
      if (const auto twin = twin_of(chosen, blind, stop)) return *twin;
    }
    return {study_case.duration, blind ? not_seen : to_the_end};
  });
}

std::optional<References::Twin> References::twin_of(const StudyCase& chosen, bool& blind,
                                                    const std::atomic<bool>& stop) const {
  constexpr double offset = 1e-6, share = 1e-2;
  SampleGrid grid = comparison_grid(chosen.scene, chosen.duration, chosen.samples);
  grid.places.clear();
  grid.weights.clear();
  const auto offset_by = [](LaneSpec& lane) {
    lane.position *= 1 + offset;
    lane.velocity *= 1 + offset;
    lane.amplitude *= 1 + offset;
  };
  try {
    const Marched one = march(chosen, registry_, grid, nullptr, stop);
    if (!one.motion) return std::nullopt;
    if (one.at_steps && !one.motion->events.empty()) {
      blind = true;
      return std::nullopt;
    }
    const Marched other = march(chosen, registry_, grid, offset_by, stop);
    if (!other.motion) return std::nullopt;
    const double horizon = common_horizon(*one.motion, *other.motion, grid, share);
    if (horizon >= chosen.duration) return Twin{chosen.duration, to_the_end};
    return Twin{horizon, fmt::format("two runs whose states differ by {:g} at the start (relative) differ by {:g} of "
                                     "the largest tip displacement from then on",
                                     offset, share)};
  } catch (const Interrupted&) {
    throw;
  } catch (...) {
    return std::nullopt;  // the case says in its own row what is wrong with it
  }
}

ReferenceSet References::of(const StudyCase& study_case, const std::atomic<bool>& stop) {
  ReferenceSet set;
  set.grid = comparison_grid(study_case.scene, study_case.duration, study_case.samples);
  for (const MethodChoice& choice : study_case.references) {
    ReferencePointer known = find(study_case, choice, stop);
    if (known->refusal.empty())
      set.applicable.push_back(std::move(known));
    else
      set.refusals.push_back(said("{}: {}", choice.name, known->refusal));
  }
  if (set.applicable.empty()) return set;
  if (study_case.settings.contains("horizon")) {
    set.horizon = study_case.settings["horizon"].get<double>();
    set.horizon_why = "the study's horizon";
    return set;
  }
  const Twin twin = twin_horizon(study_case, stop);
  set.horizon = twin.horizon;
  set.horizon_why = twin.why;
  return set;
}

namespace {

constexpr const char* motion_mark = "motion 2";

}  // namespace

template <class Archive>
void serialize(Archive& archive, ContactEvent& event) {
  archive(event.time, event.side, event.begins, event.velocity);
}

template <class Archive>
void serialize(Archive& archive, SampledMotion& motion) {
  auto& [tip, tip_velocity, energy, impulse, displacement, strain, velocity, events] = motion;
  archive(tip, tip_velocity, energy, impulse, displacement, strain, velocity, events);
}

template <class Archive>
void serialize(Archive& archive, ReferenceMotion& reference) {
  archive(reference.motion, reference.coarser, reference.how, reference.notes);
}

std::string to_bytes(const ReferenceMotion& motion) {
  return to_bytes(motion, motion_mark);
}

ReferenceMotion motion_from_bytes(const std::string& bytes) {
  return from_bytes<ReferenceMotion>(bytes, motion_mark);
}

}  // namespace ricochet
