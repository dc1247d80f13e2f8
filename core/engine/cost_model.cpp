#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <fstream>
#include <mutex>
#include <optional>
#include <ricochet/contact_solvers/box_problem.hpp>
#include <ricochet/contract/fingerprint.hpp>
#include <ricochet/engine/compile.hpp>
#include <ricochet/engine/cost_model.hpp>
#include <ricochet/engine/left_out.hpp>
#include <ricochet/engine/march_model.hpp>
#include <ricochet/kernels/band_ldlt.hpp>
#include <ricochet/kernels/floating_point.hpp>
#include <ricochet/kernels/sparse_factor.hpp>
#include <ricochet/kernels/sparse_ldlt.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace ricochet {

namespace {

constexpr double kilobyte = 1024;

// A number that stands alone in a file, or behind a word in it.
std::optional<double> number_in(const char* file, const std::string& word = "") {
  std::ifstream in(file);
  std::string found;
  double number = 0;
  while (!word.empty() && in >> found)
    if (found == word) break;
  if (in >> number) return number;
  return std::nullopt;
}

}  // namespace

double available_memory() {
  double least = infinity;
  if (const auto free = number_in("/proc/meminfo", "MemAvailable:")) least = *free * kilobyte;
  const auto group = number_in("/sys/fs/cgroup/memory.max"), used = number_in("/sys/fs/cgroup/memory.current");
  if (group && used) least = std::min(least, std::max(0.0, *group - *used));
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
    if (const auto taken = number_in("/proc/self/status", "VmSize:"))
      least = std::min(least, std::max(0.0, static_cast<double>(limit.rlim_cur) - *taken * kilobyte));
  return least;
}

namespace {

// Nanoseconds per multiply-add, by block width 1, 2, 4, 8, 16, 32, as measured by `bench_march --calibrate` (AVX-512,
// AMD EPYC, 2.4 GHz). Substitution at one lane is bound by latency, not by throughput. The rate of a substitution
// through CHOLMOD's factor is from the benchmark's own rows, over 700 multiply-adds. It is the sparse row less the
// band, plus the substitution that the band has in its place.
struct Rates {
  double product, substitution, sparse, elementwise, diagonal, measure;
};

// Wider bands than narrow ones are substituted one multiply-add after the other: ns each, one lane.
constexpr double wide = 1.3;

// What SparseOperator takes, ns: of a product by rows per entry, of a substitution per entry each time it is read.
double by_rows(double lanes) {
  return lanes == 1 ? 0.4 : 0.2;
}
double by_blocks(double lanes, double entries) {
  constexpr double second_cache = 1e6, third_cache = 16e6, bytes = sizeof(double);
  const double size = bytes * entries, near = lanes == 1 ? 0.25 : 0.15;
  const double fetched = size < second_cache ? 0 : size < third_cache ? 0.4 : 0.9;
  return std::max(near, fetched / lanes);
}

// Of K + M, or of both with their border. Those of the patterns that were counted last are kept.
SparseFill counted_fill(const SemiDiscrete& problem) {
  static std::mutex mutex;
  static std::deque<std::pair<Fingerprint, SparseFill>> kept;
  constexpr std::size_t most = 32;
  std::vector<int> order;
  SparseMatrix system = weighted_system(1, problem.stiffness, 1, problem.inertia).assemble(order);
  system.makeCompressed();
  const Fingerprint pattern = pattern_fingerprint(system);
  const std::lock_guard lock(mutex);
  for (const auto& [known, fill] : kept)
    if (known == pattern) return fill;
  if (kept.size() == most) kept.pop_front();
  kept.emplace_back(pattern, sparse_fill(system));
  return kept.back().second;
}

// What a stage costs besides, whatever its size: calls and the motion of the support. Per step and per lane there is
// the check of contact, closed now and then. What `bench_march` and `bench_decay` measure over their products and sums.
constexpr double per_stage = 25, per_contact = 20, per_contact_lane = 12;
// Of the rate of a measure by index, rows that are full, as those of modes are; of passes apart, those made as one.
constexpr double full_rows = 0.6, joined = 0.6;

Rates rates(int width) {
  if (width == 1) return {0.117, 0.35, 1.77, 0.045, 0.172, 0.252};
  if (width == 2) return {0.161, 0.130, 0.90, 0.041, 0.145, 0.131};
  if (width == 4) return {0.083, 0.066, 0.50, 0.039, 0.074, 0.065};
  if (width == 8) return {0.042, 0.034, 0.32, 0.039, 0.035, 0.035};
  if (width == 16) return {0.030, 0.022, 0.21, 0.039, 0.039, 0.030};
  return {0.028, 0.017, 0.22, 0.039, 0.061, 0.046};
}

// ns of a stage in modes and one lane. Update, step and the measure of one point are one pass; more points are measured
// apart.
double in_modes(double n, double slots, double points, const Rates& rate) {
  const double updated = n * (slots + 1) * slots, stepped = n * (slots + 1), measured = points * n * (slots + 2);
  if (points <= 1) return (updated + stepped + measured) * joined * rate.elementwise;
  return updated * rate.elementwise + stepped * rate.diagonal + measured * full_rows * rate.measure;
}

// A step in modes, and a search of a flight, as `bench_flight --auto` measures them. A flight tells in which steps no
// point has to be measured.
double visit_seconds(const SemiDiscrete& problem, const StepWork& work) {
  const double n = problem.dofs(), step = in_modes(n, work.slots, 1, rates(1)) + per_stage + per_contact;
  return std::max(1, work.solves) * step * 1e-9 + 5e-7 + 4e-10 * n * problem.points();
}

}  // namespace

bool kind_applies(OperatorKind kind, const SemiDiscrete& problem) {
  // The modal form divides by φᵀKφ; the dense eigenproblem is cubic.
  if (kind == OperatorKind::modal)
    return problem.dofs() <= most_marched_by_modes && !problem.damping.matrix &&
           (problem.held || problem.asks_for_modes());
  return !problem.damping.by_modes();
}

Cost predict_cost(OperatorKind kind, const SemiDiscrete& problem, const StepWork& work, int width) {
  const double n = problem.dofs(), lanes = width, slots = work.slots;
  const Rates rate = rates(width);
  const Inertia& inertia = problem.inertia;
  const double border = inertia.factored() ? static_cast<double>(inertia.coupling.rows()) : 0;
  const double nano = 1e-9, stages = std::max(1, work.solves);
  Cost cost;
  double nanoseconds = 0;
  if (kind == OperatorKind::modal) {
    nanoseconds = in_modes(n, slots, problem.points(), rate);
    cost.setup_seconds = 2 * n * n * n * nano;
    const bool assembled = problem.load && problem.load->has_formula() && !problem.load->constant_in_time();
    if (assembled) nanoseconds += n * n / lanes;
  } else {
    const auto entries = static_cast<double>(problem.measured().nonZeros());
    nanoseconds = n * (slots + 1) * slots * rate.elementwise + entries * (slots + 2) * rate.measure;
    double w = half_bandwidth(problem.stiffness);
    if (problem.space.given || problem.basis) w = std::max<double>(w, half_bandwidth(inertia.mass));
    const double v = border > 0 ? w + 2 : w, r = inertia.inverted() ? half_bandwidth(inertia.inverse) : 0;
    cost.setup_seconds = stages * n * 200 * nano;
    if (inertia.inverted() && work.without_stiffness) {
      nanoseconds += n * (2 * w + 1) * rate.product + n * (2 * r + 1) * rate.product;
    } else if (kind == OperatorKind::sparse && w > narrow_band) {
      const SparseFill fill = counted_fill(problem);
      nanoseconds += static_cast<double>(problem.stiffness.nonZeros()) * by_rows(lanes) +
                     2 * fill.entries * by_blocks(lanes, fill.entries);
      cost.setup_seconds += stages * 0.5 * fill.operations * nano;
    } else {
      const double solve = kind == OperatorKind::sparse    ? rate.sparse
                           : w > narrow_band && lanes == 1 ? wide
                                                           : rate.substitution;
      const double terms = inertia.inverted() ? 2 * n * (4 * std::max(w, r) + 1) : (n + border) * (2 * v + 1);
      nanoseconds += n * (2 * w + 1) * rate.product + terms * solve;
      if (w > narrow_band) cost.setup_seconds += stages * (n + border) * v * v * nano;
    }
  }
  const double fixed = per_stage + (problem.points() > 0 ? per_contact + per_contact_lane * lanes : 0);
  cost.step_seconds = stages * (nanoseconds * lanes + fixed) * nano;
  return cost;
}

double predict_flights(const SemiDiscrete& problem, const StepWork& work, long long steps) {
  const double n = problem.dofs(),
               visited = std::min(static_cast<double>(steps), 4 * std::sqrt(static_cast<double>(steps)));
  return 3e-8 * std::pow(n, 2.5) + 5e-6 * n + visited * visit_seconds(problem, work);
}

double predict_visits(const SemiDiscrete& problem, const StepWork& work, double steps) {
  return std::min(steps, 60 * std::pow(steps, 0.17)) * visit_seconds(problem, work);
}

namespace {

// Nanoseconds of what a step costs beside its solves, at one lane. Fitted by least squares of relative errors, none
// negative, to 760 trajectories of beams: 13 schemes, 12 to 192 dofs, up to 8 stops, 64 sides, 4 points that rub. With
// its own share of contact, the fit is within 0.32 and 1.6 of all of them; its numbers are then rounded.
namespace watched {
constexpr double free_step = 100;         // told to observers, not shown
constexpr double step = 150, stage = 35;  // shown
constexpr double number = 1;              // of a dof and stage that is shown
constexpr double entry = 0.45;            // of a matrix or row that a form or an observer reads
constexpr double observer = 200;          // that is shown every step
constexpr double load = 220;              // of a stage: its weighted sum, and that of its work
constexpr double evaluation = 10, operation = 1.6, load_number = 0.7;
constexpr double contact = 430;  // of a stage that looks at contact while a stop is touched
constexpr double contact_point = 40, contact_number = 2.5;
// Of points that push together, each and in pairs, where the law finds all efforts at once; of more iterations than
// one. Measured on beams pressed onto 10 to 100 nodes.
constexpr double pushing = 200, pushing_cubed = 0.05, pushing_banded = 300;
constexpr double iteration = 400, iteration_pair = 2.5;
constexpr double friction = 110;  // then, of a pair of rows that rub: its share of all turns
constexpr double motion = 60;     // of a history that a place or a load asks for; not fitted, set beside shaken tubes
}  // namespace watched

// Shares of time in which a stop is touched. Of shaken and loaded scenes 0.03 to 0.8 are measured, of others 0 to 1.
constexpr double touched_driven = 0.5, touched_free = 0.2;

// Entries that a quadratic form of M or K reads.
double entries_of(const MarchModel& model, EnergyMatrix matrix) {
  const Inertia& inertia = model.inertia();
  if (matrix == EnergyMatrix::K) return static_cast<double>(model.stiffness().nonZeros());
  if (inertia.factored()) return static_cast<double>(inertia.coupling.nonZeros() + 3 * inertia.coupling.rows());
  if (inertia.inverted()) return 4.0 * model.rows();
  return static_cast<double>(inertia.mass.nonZeros());
}

// What the stages of a step ask for: of contact, of works, and instants at which the load is assembled.
struct StagesAsk {
  double stages = 0, of_contact = 0, entries = 0, levels = 0;
  bool balanced = true, losses = false;
};

// Entries that the work of a stage reads (StageWorks), the combination of its slots among them.
double work_entries(const Program& program) {
  const MarchModel& model = *program.model;
  const Damping& damping = program.problem->damping;
  const double K = entries_of(model, EnergyMatrix::K), M = entries_of(model, EnergyMatrix::M), n = model.rows();
  double entries = program.load ? n : 0;
  if (program.support || damping.stiffness != 0 || damping.mass != 0)
    entries += (damping.stiffness != 0 ? K : M) + 2 * n;
  if (damping.stiffness != 0 && damping.mass != 0) entries += M + 2 * n;
  if (damping.own()) entries += (damping.matrix ? K : n) + 2 * n;
  return entries;
}

StagesAsk stages_ask(const Program& program) {
  StagesAsk ask;
  std::set<long long> levels;
  const auto add = [&](const Levels& list) {
    for (const Level& level : list) levels.insert(std::llround(level.at * 1e6));
  };
  for (std::size_t k = 0; k < program.stages.size(); ++k) {
    const Stage& stage = program.plan.stages[k];
    ++ask.stages;
    ask.of_contact += program.contact && program.stages[k].reads_contact;
    ask.balanced = ask.balanced && stage.work.has_value();
    ask.losses = ask.losses || !stage.loss.empty();
    for (const LossTerm& term : stage.loss) ask.entries += entries_of(*program.model, term.matrix);
    if (stage.work) ask.entries += work_entries(program);
    add(stage.load);
    if (stage.work) add(stage.work->load);
  }
  // What the step before it asked for at its end is kept.
  const bool kept = levels.size() > 1 && levels.contains(0) && levels.contains(1000000);
  ask.levels = static_cast<double>(levels.size()) - (kept ? 1 : 0);
  return ask;
}

// While a stop is touched: the law, what its efforts move, and friction, which finds both again in each of its turns.
double touched_nanoseconds(const Program& program, const StagesAsk& ask, const ContactWork& contact) {
  const double rows = program.friction ? program.model->rubbed().rows() : 0, k = contact.points;
  // The first of both is in the share of each stage.
  const double others = std::max(0.0, k - 1), again = std::max(0.0, contact.iterations - 1);
  constexpr double most = BoxSolver::many;
  const double together = k <= most ? watched::pushing_cubed * others * k * k : watched::pushing_banded * k;
  return ask.of_contact * (watched::contact + watched::contact_point * program.problem->points() +
                           watched::contact_number * program.model->rows() + watched::friction * rows * rows +
                           watched::pushing * others + together +
                           again * (watched::iteration + watched::iteration_pair * k * std::min(k, most)));
}

// Entries that the audit reads of the state after each step: energies where it reads them, points beyond their stops.
double state_entries(const Program& program, bool samples) {
  const MarchModel& model = *program.model;
  double entries = program.contact ? static_cast<double>(model.contact().value.size()) : 0;
  if (!samples) return entries;
  entries += entries_of(model, EnergyMatrix::K) + entries_of(model, EnergyMatrix::M) +
             2.0 * static_cast<double>(program.plan.slots.size()) * model.rows();
  for (const QuadraticTerm& term : program.plan.energy) entries += entries_of(model, term.matrix);
  return entries;
}

}  // namespace

double predict_loads(const Program& program) {
  if (!program.load) return 0;
  const StagesAsk ask = stages_ask(program);
  const LoadWork work = program.problem->load->work();
  const double assembly = work.evaluations * watched::evaluation + work.operations * watched::operation +
                          work.numbers * watched::load_number;
  const double sums = ask.stages * (watched::load + 2 * watched::load_number * program.model->rows());
  return 1e-9 * (sums + (program.load_constant ? 0 : ask.levels * assembly));
}

double predict_watch(const Program& program, const WatchWork& watch) {
  const SemiDiscrete& problem = *program.problem;
  const StagesAsk ask = stages_ask(program);
  const bool driven = program.support || (program.load && !program.load_constant) || !problem.motions.empty();
  ContactWork contact = watch.contact.value_or(ContactWork{driven ? touched_driven : touched_free});
  if (!program.contact) contact.touched = 0;
  const double touched = contact.touched;
  // As the audit asks (EnergyAudit): free steps that one stage tells need not be shown.
  const bool balanced = ask.balanced && !program.plan.energy.empty(),
             told = balanced && ask.stages == 1 && !ask.losses && program.width == 1 && !program.load &&
                    !problem.damping.own(),
             ends = !program.contact || (measures_the_end(program) && program.increment_slot >= 0);
  const double shown = told && ends && watch.observers == 0 && !watch.samples ? touched : 1;
  const double entries = ask.entries + state_entries(program, watch.samples || !balanced) + watch.numbers;
  const double looked = watched::step + watched::observer * watch.observers + watched::entry * entries +
                        ask.stages * (watched::stage + watched::number * program.model->rows());
  const double histories =
      static_cast<double>(problem.motions.histories.size()) * ((ask.of_contact + 1) * problem.points() + ask.levels);
  const double nanoseconds = (1 - shown) * watched::free_step + shown * looked +
                             touched * touched_nanoseconds(program, ask, contact) + watched::motion * histories;
  return 1e-9 * nanoseconds;
}

double predict_touched_step(const Program& program, const ContactWork& contact) {
  return 1e-9 * touched_nanoseconds(program, stages_ask(program), contact);
}

OperatorKind cheapest_kind(const SemiDiscrete& problem, const StepWork& work, int width, long long steps) {
  if (problem.asks_for_modes() && kind_applies(OperatorKind::modal, problem)) return OperatorKind::modal;
  OperatorKind best = OperatorKind::band;
  double best_cost = 0;
  for (const OperatorKind kind : {OperatorKind::band, OperatorKind::modal, OperatorKind::sparse}) {
    if (!kind_applies(kind, problem)) continue;
    const Cost cost = predict_cost(kind, problem, work, width);
    const double total = cost.setup_seconds + static_cast<double>(steps) * cost.step_seconds;
    if (best_cost == 0 || total < best_cost) {
      best = kind;
      best_cost = total;
    }
  }
  return best;
}

}  // namespace ricochet
