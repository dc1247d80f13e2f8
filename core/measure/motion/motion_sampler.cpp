#include <algorithm>
#include <array>
#include <cmath>
#include <ricochet/contract/unit_mass.hpp>
#include <ricochet/engine/flight/flight.hpp>
#include <ricochet/measure/motion/motion_sampler.hpp>
#include <ricochet/scene/assembly.hpp>
#include <ricochet/scene/observed_rows.hpp>

namespace ricochet {

MomentumLedger::MomentumLedger(const Program& program) : slot_count_(program.plan.slots.size()) {
  for (std::size_t j = 0; j < program.plan.velocity.slots.size(); ++j) reads_[j] = program.plan.velocity.slots[j];
  for (std::size_t k = 0; k < program.start.size(); ++k)
    start_.push_back(describe(program.plan.start[k], program.start[k]));
  for (std::size_t k = 0; k < program.stages.size(); ++k)
    stages_.push_back(describe(program.plan.stages[k], program.stages[k]));
}

MomentumLedger::Stage MomentumLedger::describe(const ricochet::Stage& plan, const StageProgram& program) const {
  Stage stage;
  const double S = plan.matrix.M;
  for (std::size_t j = 0; j < slot_count_; ++j) {
    const Combination& row = plan.update[j];
    for (std::size_t i = 0; i < row.slots.size(); ++i) stage.slots[j][i] = row.slots[i];
    if (S == 0) continue;
    for (std::size_t i = 0; i < plan.history.size(); ++i) stage.slots[j][i] += row.z * plan.history[i].M / S;
    stage.push[j] = row.z / S;
  }
  if (!program.reads_contact) return stage;
  if (const double w = UnitMass::jump(plan, program.impulse.weight); w != 0) {
    stage.jumps = true;
    const double fed = S != 0 ? plan.impulse->feed.M * w / S : 0.0;
    for (std::size_t j = 0; j < slot_count_; ++j) stage.jump[j] = plan.update[j].z * fed + plan.update[j].w * w;
  }
  stage.efforts = program.effort.size();
  std::copy(program.effort.begin(), program.effort.end(), stage.weights.begin());
  return stage;
}

void MomentumLedger::restart() {
  given_ += velocity_;
  velocity_ = largest_change_ = 0;
  state_.fill(0);
  past_.fill(0);
  moving_ = false;
}

void MomentumLedger::move(bool starting, std::size_t k, double force) {
  moving_ = true;
  quiet_ = force == 0 ? quiet_ + 1 : 0;
  // Only as far back as some stage looks.
  std::size_t longest = 1;
  for (const Stage& one : stages_) longest = std::max(longest, one.efforts);
  for (std::size_t i = longest; i-- > 1;) past_[i] = past_[i - 1];
  past_[0] = force;
  const Stage& stage = starting ? start_[k] : stages_[k];
  double effort = 0;
  for (std::size_t i = 0; i < stage.efforts; ++i) effort += stage.weights[i] * past_[i];
  std::array<double, most_slots> next{};
  for (std::size_t j = 0; j < slot_count_; ++j) {
    double sum = stage.push[j] * effort;
    if (stage.jumps) sum += stage.jump[j] * force;
    for (std::size_t i = 0; i < slot_count_; ++i) sum += stage.slots[j][i] * state_[i];
    next[j] = sum;
  }
  state_ = next;
}

void MomentumLedger::settle() {
  double velocity = 0;
  for (std::size_t j = 0; j < slot_count_; ++j) velocity += reads_[j] * state_[j];
  const double change = std::abs(velocity - velocity_);
  velocity_ = velocity;
  largest_change_ = std::max(largest_change_, change);
  // Once every weight has seen only zeros and the velocity stays, a mass that starts again tells the rest.
  if (quiet_ > most_efforts && change <= 1e-16 * largest_change_) restart();
}
namespace {

// The share of motions at the places; none where displacements count from the supports.
Eigen::MatrixXd shown_shapes(const SemiDiscrete& problem, const std::vector<double>& places) {
  const SupportMotions& motions = problem.motions;
  return motions.empty() || motions.from_supports ? Eigen::MatrixXd() : motion_shapes(problem, places);
}

// Weights of the cubic through s = −1, 0, 1, 2, and of its derivative in s, at s in [0, 1].
struct Cubic {
  std::array<double, 4> value, slope;
};
Cubic cubic(double s) {
  const double a = s + 1, b = s, c = s - 1, d = s - 2;
  return {{-b * c * d / 6, a * c * d / 2, -a * b * d / 2, a * b * c / 6},
          {-(c * d + b * d + b * c) / 6, (c * d + a * d + a * c) / 2, -(b * d + a * d + a * b) / 2,
           (b * c + a * c + a * b) / 6}};
}

// A time is a step when it is one up to the rounding of two decimal numbers.
constexpr double rounding_of_steps = 1e-6;

}  // namespace

void sample_places(double length, int cells, SampleGrid& grid) {
  if (length == 0) return;
  const double cell = length / cells, offset = 0.5 / std::sqrt(3.0);
  for (int i = 0; i < cells; ++i)
    for (const double side : {-offset, offset}) {
      grid.places.push_back((i + 0.5 + side) * cell);
      grid.weights.push_back(cell / 2);
    }
}

ContactLog::ContactLog(const Marcher& marcher)
    : model_(*marcher.program().model),
      problem_(*marcher.program().problem),
      T_(marcher.width()),
      h_(marcher.program().h),
      signs_(static_cast<std::size_t>(problem_.points()), 0),
      asked_(signs_),
      position_(static_cast<std::size_t>(model_.rows())),
      velocity_(static_cast<std::size_t>(model_.rows())),
      start_(marcher, 0),
      momentum_(marcher.program()) {
  events_.reserve(64);
  ask(marcher);
}

// When the gap of a point closes, from the state before the stage.
double ContactLog::onset(const Marcher& marcher, const StageView& view, int point, int side) {
  const double t = view.from, dt = view.to != view.from ? view.to - view.from : h_ * view.program->facts.instant;
  if (!state_known_) {
    const Combination& rate = marcher.program().plan.velocity;
    const auto T = static_cast<std::size_t>(T_);
    for (std::size_t i = 0; i < position_.size(); ++i) {
      position_[i] = view.slots[0][i * T];
      velocity_[i] = 0;
      for (std::size_t s = 0; s < rate.slots.size(); ++s) velocity_[i] += rate.slots[s] * view.slots[s][i * T];
    }
    tip_speed_ = marcher.support_rate(0, t) + marcher.motions().tip_rate(t) + model_.tip().times(0, velocity_.data());
    state_known_ = true;
  }
  const LaneSpec& lane = marcher.program().lanes.front();
  const auto place = [&](int j) { return model_.contact().times(j, position_.data()) + marcher.lift(0, j, t); };
  const auto rate = [&](int j) { return model_.contact().times(j, velocity_.data()) + marcher.lift_rate(0, j, t); };
  const double stop = side == 0 ? lane.lower[point] : lane.upper[point];
  double gap = place(point) - stop, speed = rate(point);
  if (model_.problem().circle_axis(point) == 0) {
    const StopCircle circle = marcher.circle(0, point);
    gap = circle.distance(place(point), place(point + 1)) - circle.radius;
    speed = circle.outwards(place(point), place(point + 1), speed, rate(point + 1));
  }
  double time = t;
  if (gap * speed < 0) time += std::min(-gap / speed, 2 * dt);
  if ((side == 0) == (gap < 0)) time = t;  // beyond the stop already: a constraint on other levels let it pass
  return std::clamp(time, t - dt, t + dt);
}

void ContactLog::stage_solved(const Marcher& marcher, const StageView& view) {
  see(marcher, view);
  if (view.starting) ask(marcher);
}

void ContactLog::see(const Marcher& marcher, const StageView& view) {
  if (!view.effort) {
    momentum_.stage(view.starting, static_cast<std::size_t>(view.stage), 0);
    return;
  }
  if (view.program->opens_instant) {
    force_ = 0;
    now_[0] = now_[1] = hit_[0] = hit_[1] = false;
  }
  if (start_.any()) start_.read(marcher, view.slots, view.from);
  if ((view.contact_lanes & 1u) != 0)
    read(marcher, view);
  else
    momentum_.stage(view.starting, static_cast<std::size_t>(view.stage), 0);
  if (view.program->closes_instant && (now_[0] || now_[1] || closed_[0] || closed_[1])) close_instant(view);
}

void ContactLog::read(const Marcher& marcher, const StageView& view) {
  const double* efforts = view.effort[0];
  const SemiDiscrete& problem = model_.problem();
  state_known_ = false;
  double force = 0;
  marcher.each_push(view, 0, [&](int j, double p) {
    force += problem.circle_axis(j) < 0 ? p : efforts[j * T_];
    const int way = p > 0 ? 0 : 1, side = problem.round(j) ? 1 : way;  // a clearance has one side
    asked_[static_cast<std::size_t>(problem.stop_row(j))] = side == 0 ? 1 : -1;
    now_[side] = true;
    if (closed_[side] || start_.holds(j, p > 0 ? 1 : -1)) return;
    const double time = onset(marcher, view, j, way);
    onset_[side] = hit_[side] ? std::min(onset_[side], time) : time;
    hit_[side] = true;
  });
  momentum_.stage(view.starting, static_cast<std::size_t>(view.stage), force);
  force_ += view.program->force_share * force;
}

void ContactLog::step_done(Marcher& marcher) {
  momentum_.step_done();
  ask(marcher);
}

// What efforts of some steps ago still give has to be followed.
void ContactLog::ask(const Marcher& marcher) {
  const bool follows = momentum_.moving() && !closed_[0] && !closed_[1];
  asks_.next_shown = marcher.program().flight && !follows ? never : 0;
}

void ContactLog::interval(Marcher& marcher, const StepInterval& steps) {
  if (steps.closed.empty()) return;
  const std::vector<StageProgram>& stages = marcher.program().stages;
  steps.each_stage([&](int stage, std::span<const double> efforts, std::span<const double>) {
    const auto at = static_cast<std::size_t>(stage);
    double force = 0;
    for (const double p : efforts) force += p;
    momentum_.stage(false, at, force);
    if (at + 1 == stages.size()) momentum_.step_done();
    if (stages[at].opens_instant) force_ = 0;
    force_ += stages[at].force_share * force;
  });
  ask(marcher);
}

void ContactLog::close_instant(const StageView& view) {
  if (asked_ != signs_) ++changes_;
  if (start_.any())
    for (std::size_t j = 0; j < asked_.size(); ++j)
      if (asked_[j] != 0) start_.take(static_cast<int>(j), asked_[j]);
  signs_.swap(asked_);
  std::fill(asked_.begin(), asked_.end(), static_cast<signed char>(0));
  for (const int side : {0, 1}) {
    if (hit_[side] && !closed_[side])
      events_.push_back({onset_[side], side == 0 ? -1 : 1, true, tip_speed_});
    else if (!now_[side] && closed_[side])
      events_.push_back({view.from, side == 0 ? -1 : 1, false, 0});
    closed_[side] = now_[side];
  }
}

MotionSampler::MotionSampler(Marcher& marcher, const SampleGrid& grid, StepObserver* beside)
    : marcher_(marcher),
      grid_(grid),
      log_(marcher),
      observers_{beside, &log_},
      mass_(QuadraticForm::of(marcher.program().problem->inertia)),
      stiffness_(marcher.program().problem->stiffness),
      places_(place_rows(*marcher.program().problem, grid.places)),
      strains_(strain_rows(*marcher.program().problem, grid.places)),
      shares_(shown_shapes(*marcher.program().problem, grid.places)),
      offset_(marcher.program().velocity_offset) {
  const std::size_t times = grid_.times.size(), fields = times * grid_.places.size();
  for (auto* series : {&motion_.tip, &motion_.tip_velocity, &motion_.energy, &motion_.impulse}) series->reserve(times);
  for (auto* field : {&motion_.displacement, &motion_.strain, &motion_.velocity}) field->reserve(fields);
}

void MotionSampler::keep() {
  constexpr std::size_t window = 5;
  states_.push_back({marcher_.step(), marcher_.position(0), log_.impulse()});
  if (states_.size() > window) states_.pop_front();
}

const MotionSampler::State* MotionSampler::at(long long step) {
  for (const State& state : states_)
    if (state.step == step) return &state;
  if (marcher_.step() < step) marcher_.march(step - marcher_.step(), observers_);
  if (!marcher_.status(0).running || marcher_.step() != step) return nullptr;
  keep();
  return &states_.back();
}

std::optional<MotionSampler::Read> MotionSampler::read(double t) {
  const SemiDiscrete& problem = *marcher_.program().problem;
  const double h = marcher_.program().h, ratio = t / h;
  long long n = std::llround(ratio);
  const bool whole = std::abs(ratio - static_cast<double>(n)) <= rounding_of_steps;
  if (!whole) n = static_cast<long long>(std::floor(ratio));
  at_steps_ += whole;
  if (whole && n == 0) return Read{problem.position, problem.velocity, 0};
  if (whole) {
    const std::array<const State*, 3> s = {at(n - 1), at(n), at(n + 1)};
    if (!s[0] || !s[1] || !s[2]) return std::nullopt;
    return Read{s[1]->position, (s[2]->position - s[0]->position) / (2 * h),
                s[1]->impulse - offset_ * (s[2]->impulse - s[1]->impulse)};
  }
  const long long first = std::max(n - 1, 0LL);
  std::array<const State*, 4> s{};
  for (int k = 0; k < 4; ++k)
    if (!(s[static_cast<std::size_t>(k)] = at(first + k))) return std::nullopt;
  // Before the second step the window begins at 0: the same cubic, seen from further left.
  const double local = ratio - static_cast<double>(first + 1);
  const Cubic weights = cubic(local);
  Read out{Eigen::VectorXd::Zero(problem.dofs()), Eigen::VectorXd::Zero(problem.dofs()), 0};
  for (std::size_t k = 0; k < 4; ++k) {
    out.position += weights.value[k] * s[k]->position;
    out.velocity += weights.slope[k] / h * s[k]->position;
  }
  const std::size_t left = static_cast<std::size_t>(n - first);
  const double share = ratio - static_cast<double>(n) - offset_;
  out.impulse = (1 - share) * s[left]->impulse + share * s[left + 1]->impulse;
  return out;
}

bool MotionSampler::next() {
  if (next_ >= grid_.times.size()) return false;
  const SemiDiscrete& problem = *marcher_.program().problem;
  if (!started_) {
    started_ = true;
    states_.push_back({0, problem.position, 0});
    marcher_.start(observers_);
    if (marcher_.step() > 0) keep();
  }
  const double t = grid_.times[next_];
  const std::optional<Read> seen = read(t);
  if (!seen) return false;
  const Eigen::VectorXd &w = seen->position, &v = seen->velocity;
  const double support = marcher_.support(0, t), rate = marcher_.support_rate(0, t);
  double energy = 0.5 * mass_(v.data()) + 0.5 * stiffness_(w.data());
  if (marcher_.program().contact && marcher_.law().reads()) {
    Eigen::VectorXd touched = problem.measured() * w;
    for (int j = 0; j < problem.points(); ++j) touched[j] += support + problem.motions.point(j, t);
    energy += marcher_.stored(0, touched.data());
  }
  motion_.tip.push_back((problem.tip * w)[0] + support + problem.motions.tip(t));
  motion_.tip_velocity.push_back((problem.tip * v)[0] + rate + problem.motions.tip_rate(t));
  motion_.energy.push_back(energy);
  motion_.impulse.push_back(seen->impulse);
  Eigen::VectorXd u = (places_ * w).array() + support, velocity = (places_ * v).array() + rate;
  if (shares_.rows() > 0) {
    u += shares_ * problem.motions.values(t, false);
    velocity += shares_ * problem.motions.values(t, true);
  }
  const Eigen::VectorXd strain = strains_ * w;
  motion_.displacement.insert(motion_.displacement.end(), u.begin(), u.end());
  motion_.strain.insert(motion_.strain.end(), strain.begin(), strain.end());
  motion_.velocity.insert(motion_.velocity.end(), velocity.begin(), velocity.end());
  ++next_;
  return true;
}

SampledMotion MotionSampler::finish() {
  motion_.events = log_.events();
  return std::move(motion_);
}

}  // namespace ricochet
