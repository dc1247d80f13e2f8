#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ricochet/contract/friction_facts.hpp>
#include <ricochet/contract/momentum_weights.hpp>
#include <ricochet/contract/said_format.hpp>
#include <ricochet/engine/compile.hpp>
#include <ricochet/engine/cost_model.hpp>
#include <ricochet/engine/effort_worth.hpp>
#include <ricochet/engine/indefinite_step.hpp>
#include <ricochet/engine/jamming.hpp>
#include <ricochet/engine/left_out.hpp>
#include <ricochet/scene/stop_parameters.hpp>
#include <stdexcept>
#include <variant>

namespace ricochet {
namespace {

constexpr const char* friction_remedy =
    "Use a scheme that closes velocities at its stops, or more numerical damping: `ricochet describe` says by what "
    "factor a scheme forgets a disturbance of a held effort";

// Lanes share the problem, and a law that changed it with its parameters.
std::optional<Refusal> meet_law(ContactLaw& law, const SemiDiscrete& problem, const std::vector<LaneSpec>& lanes) {
  show_problem(law, problem);
  if (!law.changes_problem()) return std::nullopt;
  for (const LaneSpec& lane : lanes)
    if (lane.law.values() != lanes.front().law.values())
      return Refusal{
          "the contact law changes the stiffness of the structure with its parameters: lanes of one block cannot have "
          "different ones. March them as problems of their own"};
  return std::nullopt;
}

Combination padded(Combination c, std::size_t slots) {
  c.slots.resize(slots, 0.0);
  return c;
}

// What the law reads in this stage, if anything.
std::optional<Refusal> read_contact(StageProgram& program, const Stage& stage, const ContactLaw& law,
                                    std::size_t slots) {
  if (const auto evaluation = law.reads()) {
    const auto& compliance = stage.at(*evaluation);
    if (!compliance) return std::nullopt;
    program.measure = compliance->displacement;
    program.measure_levels = compliance->bound;
    program.effort = compliance->effort;
    program.compliance = compliance;
  } else {
    if (!stage.impact) return std::nullopt;
    program.measure = stage.impact->value;
    program.measure_levels = stage.impact->bound;
    program.effort = stage.impact->effort;
    program.gate = stage.impact->gate;
    program.restores = stage.impact->restores;
  }
  if (stage.matrix.M == 0 && stage.matrix.C == 0 && stage.matrix.K == 0)
    return Refusal{"the scheme measures contact in a stage that solves nothing"};
  program.measure = padded(program.measure, slots);
  program.measure_z = program.measure.z;
  program.reach = program.measure_z * program.effort[0];
  program.rate_reach = program.compliance ? program.compliance->rate.z * program.effort[0] : 0.0;
  program.reads_contact = true;
  return std::nullopt;
}

// What a law reads moves with z and w by one set of columns. They are those of the measure, or of the rate where no
// effort moves the measure.
std::optional<Refusal> read_impulse(StageProgram& program, const Stage& stage, const Program& whole) {
  const double weight = program.compliance ? program.compliance->impulse : stage.impact->impulse;
  if (weight == 0) return std::nullopt;
  const Damping& damping = whole.problem->damping;
  const FoldedStage R = fold(stage.impulse->R, damping), feed = fold(stage.impulse->feed, damping);
  if (R.mass == 0 && feed.mass != 0)
    return Refusal{"the scheme's impulse feeds its step with mass and R has none: let R weigh M, or the feed K alone"};
  if (damping.own() && (R.damping != 0 || feed.damping != 0))
    return Refusal{"the scheme's impulse weighs C, which is not made of K and M here: use α and η"};
  ImpulseProgram& impulse = program.impulse;
  const double mass = R.mass != 0 ? feed.mass / R.mass : 0.0;
  impulse.weight = weight;
  impulse.direct = program.effort[0] + weight * mass;
  impulse.elastic = feed.stiffness - mass * R.stiffness;
  const Combination rate = program.compliance ? program.compliance->rate : Combination{};
  const auto moves = [](const Combination& c) { return c.z != 0 || c.w != 0; };
  const Combination& base = moves(program.measure) ? program.measure : rate;
  impulse.measure_z = base.z;
  impulse.measure_w = base.w;
  program.reach = moves(program.measure) ? 1 : 0;
  const double across = rate.z * base.w - rate.w * base.z;
  if (program.compliance && whole.law->reads_rate() &&
      std::abs(across) > 1e-12 * (std::abs(rate.z * base.w) + std::abs(rate.w * base.z)))
    return Refusal{
        "the time scheme's impulse moves the rate at contact otherwise than the displacement, and the law reads both: "
        "use an undamped law, or another evaluation"};
  program.rate_reach = base.z != 0 ? rate.z / base.z : base.w != 0 ? rate.w / base.w : 0.0;
  auto made = definite_operator(whole, R, 1, "R of an impulse", stage.impulse->R);
  if (const auto* refusal = std::get_if<Refusal>(&made))
    return Refusal{said("the scheme's impulse has no solution ({}): use a regular mass, or a scheme without impulse",
                        refusal->sentence)};
  impulse.op = std::move(std::get<std::unique_ptr<StageOperator>>(made));
  return std::nullopt;
}

// Efforts of friction as those of the law: where w brings them, by the same columns.
std::optional<Refusal> read_friction(StageProgram& program, const StageEffort& normal) {
  const Combination& end = program.facts.end_rate.rate;
  program.friction_weight = friction_weight(normal);
  if (!program.impulse.op) {
    program.friction_reach = end.z;
    return std::nullopt;
  }
  const double y = program.impulse.measure_z, w = program.impulse.measure_w;
  if (std::abs(end.z * w - end.w * y) > 1e-12 * (std::abs(end.z * w) + std::abs(end.w * y)))
    return Refusal{
        "the time scheme's impulse moves the rate at the end of the step otherwise than what contact measures, and "
        "friction reads that rate: use another scheme"};
  program.friction_reach = y != 0 ? end.z / y : end.w / w;
  return std::nullopt;
}

// `near`: a stage that is made, whose operator may serve this one as well.
std::optional<Refusal> fill(StageProgram& program, const Stage& stage, const Program& whole,
                            const StageProgram* near = nullptr) {
  const std::size_t slots = whole.plan.slots.size();
  program.folded = fold(stage, whole.problem->damping, static_cast<int>(slots));
  if (whole.contact)
    if (auto refusal = read_contact(program, stage, *whole.law, slots)) return refusal;
  if (stage.impulse && program.reads_contact)
    if (auto refusal = read_impulse(program, stage, whole)) return refusal;
  if (whole.friction && program.reads_contact)
    if (auto refusal = read_friction(program, {program.effort, program.impulse.weight})) return refusal;
  const auto phase = [&](const Levels& levels) {
    return PhaseWeights(levels, whole.problem->support.pulsation, whole.h);
  };
  program.load_phase = phase(stage.load);
  program.measure_phase = phase(program.measure_levels);
  if (program.compliance) {
    program.rate_phase = phase(program.compliance->rate_bound);
    program.before_phase = phase(program.compliance->before_bound);
  }
  if (program.gate) {
    program.predictor_phase = phase(program.gate->predictor_bound);
    program.approach_phase = phase(program.gate->approach_bound);
  }
  program.driven = program.folded.driven() || !stage.load.empty();
  if (!program.folded.solves() || (!program.driven && !program.reads_contact)) return std::nullopt;
  if (near && near->op && whole.kind == OperatorKind::sparse)
    program.op = make_near_operator(*whole.model, program.folded, whole.width, near->folded, *near->op);
  if (program.op) return std::nullopt;
  auto made = definite_operator(whole, program.folded, whole.width, "S", stage.matrix);
  if (auto* refusal = std::get_if<Refusal>(&made)) return *refusal;
  program.op = std::move(std::get<std::unique_ptr<StageOperator>>(made));
  return std::nullopt;
}

// What a stage that gives work back needs to know of the one whose work it is.
void connect_works(Program& program) {
  for (std::size_t k = 0; k < program.stages.size(); ++k) {
    if (program.stages[k].restores == 0) continue;
    const std::size_t source = k - static_cast<std::size_t>(program.stages[k].restores);
    const WorkForm& work = *program.plan.stages[source].work;
    program.stages[source].motion = padded(work.displacement, program.plan.slots.size());
    program.stages[source].motion_levels = work.support;
    program.stages[source].motion_phase = PhaseWeights(work.support, program.problem->support.pulsation, program.h);
  }
}

}  // namespace

PhaseWeights::PhaseWeights(const Levels& levels, double pulsation, double h) {
  for (const Level& level : levels) {
    along += level.weight * std::cos(pulsation * level.at * h);
    across += level.weight * std::sin(pulsation * level.at * h);
  }
}

LaneSpec scene_lane(const SemiDiscrete& problem, const Parameters& law) {
  LaneSpec lane;
  lane.amplitude = problem.support.amplitude;
  lane.phase = problem.support.phase;
  lane.position = problem.position;
  lane.velocity = problem.velocity;
  lane.lower = problem.lower;
  lane.upper = problem.upper;
  lane.law = law;
  for (const RubbingPoint& one : problem.rubbing) lane.rubbing.push_back(one.given);
  return lane;
}

namespace {

// A damper acts without stops.
bool meets_contact(const SemiDiscrete& problem, const ContactLaw& law) {
  const auto damper = [](const RubbingPoint& one) { return one.given.normal_force.has_value(); };
  return problem.points() > 0 && (!law.absent() || std::any_of(problem.rubbing.begin(), problem.rubbing.end(), damper));
}

// Why the law reads nothing in this scheme, or nothing.
std::optional<Refusal> refuse_unread(const Program& program) {
  if (!program.contact) return std::nullopt;
  const std::optional<Evaluation> evaluation = program.law->reads();
  const StageEfforts efforts = stage_efforts(program.plan.stages, evaluation);
  if (std::any_of(efforts.begin(), efforts.end(), [](const StageEffort& one) { return !one.weights.empty(); }))
    return std::nullopt;
  if (!evaluation) return Refusal{"the time scheme has no impact measure for a rigid law: use a penalty"};
  return Refusal{std::string("the time scheme offers no ") + evaluation_word(*evaluation) +
                 " evaluation of a compliant law" +
                 (*evaluation == Evaluation::conserving ? ", nor the displacement before the step" : "") +
                 ": choose another evaluation"};
}

// The friction law, or why the plan has none.
std::optional<Refusal> meet_friction(Program& program, const DerivedPlan& derived, const CompileOptions& options) {
  if (program.problem->rubbing.empty() || !program.contact) return std::nullopt;
  if (program.tangents > 0) return Refusal{"friction has no tangents here: exponents of what rubs are those of twins"};
  if (!options.make_friction) return Refusal{"friction is not marched here: leave the friction of the stops out"};
  program.friction = options.make_friction();
  const FrictionFacts facts = friction_facts(derived, program.law->reads());
  program.held_root = facts.held_root;
  const std::string why = !facts.why_none.empty() ? facts.why_none : program.friction->must_settle() ? facts.rings : "";
  if (!why.empty()) return Refusal{said("friction does not run under this time scheme: {}. {}", why, friction_remedy)};
  return std::nullopt;
}

}  // namespace

ProblemFacts problem_facts(const SemiDiscrete& problem, const ContactLaw& law) {
  ProblemFacts facts;
  facts.dofs = problem.dofs();
  facts.mass_kernel_dimension = problem.inertia.kernel_dimension;
  facts.damped = problem.damped();
  facts.contact = meets_contact(problem, law);
  return facts;
}

namespace {

// Why a law has no tangents under this plan, or nothing.
std::optional<Refusal> refuse_tangents(const Program& program) {
  if (program.tangents == 0) return std::nullopt;
  const ContactLaw& law = *program.law;
  if (law.reads() && !law.offers_slopes())
    return Refusal{"the contact law offers no slopes, hence no tangents: its exponents are those of twins"};
  const bool turns = law.reads_rate() || law.reads() == Evaluation::conserving;
  if (turns && !program.problem->circles().empty())
    return Refusal{
        "a force in a circle that reads a rate, or the step before, has no tangents here: exponents are those of "
        "twins. Use a force of the depth alone"};
  const auto restores = [](const Stage& stage) { return stage.impact && stage.impact->restores > 0; };
  if (!law.reads() && !law.absent() && std::any_of(program.plan.stages.begin(), program.plan.stages.end(), restores))
    return Refusal{
        "the time scheme gives the work of rigid contact back by a quadratic equation, which has no tangents here: "
        "its exponents are those of twins"};
  return std::nullopt;
}

// Lanes and laws meet the problem and the plan.
std::optional<Refusal> meet_problem(Program& program, std::vector<LaneSpec> lanes, const DerivedPlan& derived,
                                    const CompileOptions& options) {
  const SemiDiscrete& problem = *program.problem;
  if (auto refusal = meet_law(*program.law, problem, lanes)) return refusal;
  check_stiffness_of_law(problem);
  if (auto refusal = refuse_own(*program.law, problem.own, problem.stops)) return refusal;
  if (auto refusal = refuse_restitution(program)) return refusal;
  program.own_sets = sets_per_point(*program.law, problem.own);
  if (auto refusal = refuse_tangents(program)) return refusal;
  program.width = lane_width(static_cast<int>(lanes.size()) * (1 + program.tangents));
  program.support = options.moving_support;
  program.lanes = std::move(lanes);
  for (const LaneSpec& lane : program.lanes) {
    if (lane.rubbing.size() != problem.rubbing.size()) throw std::logic_error("a lane has no friction of its own");
    program.support = program.support || lane.amplitude != 0;
  }
  program.contact = meets_contact(problem, *program.law);
  if (auto refusal = refuse_unread(program)) return refusal;
  if (auto refusal = meet_friction(program, derived, options)) return refusal;
  program.load = problem.load && !problem.load->absent();
  program.load_constant = program.load && problem.load->constant_in_time();
  if (program.load && !program.load_constant && options.march != MarchWay::every_step)
    program.load_pulsation = problem.load->pulsation().value_or(0);
  return std::nullopt;
}

StepWork work_of(const Program& program) {
  const int slots = static_cast<int>(program.plan.slots.size());
  StepWork work{slots, 0, true};
  for (const Stage& stage : program.plan.stages) {
    const FoldedStage folded = fold(stage, program.problem->damping, slots);
    work.solves += folded.solves() ? 1 : 0;
    work.without_stiffness = work.without_stiffness && folded.stiffness == 0;
  }
  return work;
}

// How a program marches: by which operator, and whether it leaves out what no stop sees.
struct Way {
  bool flies = false;
  double by_flights = 0;  // seconds of all steps
};

using WayOrRefusal = std::variant<Way, Refusal>;

WayOrRefusal choose_way(Program& program, const CompileOptions& options) {
  const SemiDiscrete& problem = *program.problem;
  const StepWork work = work_of(program);
  program.kind = options.kind;
  program.every_step_because = options.march == MarchWay::every_step ? "" : why_grounded(program, options);
  const std::string& grounded = program.every_step_because;
  if (options.march == MarchWay::flights && !grounded.empty()) return refuse_flight(grounded);
  Way way{options.march != MarchWay::every_step && grounded.empty()};
  if (way.flies) way.by_flights = predict_flights(problem, work, options.expected_steps);
  if (program.kind == OperatorKind::automatic)
    program.kind = cheapest_kind(problem, work, program.width, options.expected_steps);
  // Both predictions may be wrong by so much. Somebody looks at a step that is marched.
  constexpr double sure = 1.2, looked_at = 1e-7;
  if (way.flies && options.march == MarchWay::automatic) {
    const Cost every_step = predict_cost(program.kind, problem, work, program.width);
    way.flies = sure * way.by_flights < every_step.setup_seconds + static_cast<double>(options.expected_steps) *
                                                                       (every_step.step_seconds + looked_at);
  }
  if (way.flies)
    program.kind = OperatorKind::modal;
  else if (program.kind != OperatorKind::modal && problem.damping.by_modes())
    return Refusal{
        said("damping ratios are those of modes, by which at most {} degrees of freedom march: use mesh.modes, or α "
             "and η",
             most_marched_by_modes)};
  else if (!kind_applies(program.kind, problem))
    return Refusal{std::string("the ") + operator_name(program.kind) + " operator does not apply to this structure"};
  const Cost cost = predict_cost(program.kind, problem, work, program.width);
  program.predicted_step_seconds = cost.step_seconds;
  program.predicted_setup_seconds = cost.setup_seconds;
  program.model = std::make_shared<MarchModel>(program.problem, program.kind == OperatorKind::modal);
  return way;
}

std::optional<Refusal> fill_stages(Program& program, const DerivedPlan& derived) {
  program.start.resize(program.plan.start.size());
  program.stages.resize(program.plan.stages.size());
  for (std::size_t k = 0; k < program.stages.size(); ++k) {
    program.stages[k].facts = derived.stages[k];
    if (auto refusal = fill(program.stages[k], program.plan.stages[k], program)) return refusal;
  }
  for (std::size_t k = 0; k < program.start.size(); ++k) {
    program.start[k].facts = derived.start[k];
    if (auto refusal = fill(program.start[k], program.plan.start[k], program, &program.stages.front())) return refusal;
  }
  connect_works(program);
  if (auto refusal = add_contact_facts(program)) return refusal;
  if (program.friction) add_friction_facts(program);
  return std::nullopt;
}

// Whether each stage solves with a multiple of a diagonal mass.
bool solves_diagonal(const Program& program) {
  if (!program.problem->inertia.assembled()) return false;
  for (const StageProgram& stage : program.stages)
    if (stage.folded.stiffness != 0) return false;
  const SparseMatrix& mass = program.problem->inertia.mass;
  for (int j = 0; j < mass.outerSize(); ++j)
    for (SparseMatrix::InnerIterator it(mass, j); it; ++it)
      if (it.row() != j && it.value() != 0) return false;
  return true;
}

}  // namespace

ProgramOrRefusal compile(std::shared_ptr<const SemiDiscrete> problem, StepPlan plan, double h,
                         std::unique_ptr<ContactLaw> law, std::vector<LaneSpec> lanes, const CompileOptions& options) {
  if (const auto wrong = check_plan(plan, h)) throw std::logic_error("ill-formed plan: " + *wrong);
  if (lanes.empty()) throw std::logic_error("a program needs at least one lane");
  const DerivedPlan derived = derive(std::move(plan));
  Program program;
  program.problem = problem;
  program.plan = derived.plan;
  program.h = h;
  program.velocity_offset = derived.velocity_offset;
  program.increment_slot = derived.increment_slot;
  program.law = std::move(law);
  program.tangents = options.tangents;
  program.eager_delassus = options.eager_delassus;
  program.bounded = options.bounded;
  if (auto refusal = meet_problem(program, std::move(lanes), derived, options)) return *refusal;
  const WayOrRefusal chosen = choose_way(program, options);
  if (const auto* refusal = std::get_if<Refusal>(&chosen)) return *refusal;
  const auto& way = std::get<Way>(chosen);
  if (auto refusal = fill_stages(program, derived)) return *refusal;
  // The band operator of half-bandwidth zero: nothing else changes, but a person wants to read it.
  if (program.kind == OperatorKind::band && solves_diagonal(program)) program.kind = OperatorKind::diagonal;
  if (program.friction)
    if (auto refusal = refuse_jamming(program)) return *refusal;
  say_left_out(program);
  if (!way.flies) {
    program.predicted_step_seconds += predict_loads(program);
    return program;
  }
  if (const std::string cause = let_fly(program, options); !cause.empty()) {
    if (options.march == MarchWay::flights) return refuse_flight(cause);
    // Once more, with the operator that every step is cheapest with.
    CompileOptions marched = options;
    marched.march = MarchWay::every_step;
    ProgramOrRefusal again =
        compile(problem, program.plan, h, std::move(program.law), std::move(program.lanes), marched);
    if (auto* other = std::get_if<Program>(&again)) other->every_step_because = cause;
    return again;
  }
  program.predicted_setup_seconds = 0;
  program.predicted_step_seconds = way.by_flights / static_cast<double>(std::max(1LL, options.expected_steps));
  return program;
}

}  // namespace ricochet
