#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <ricochet/engine/cost_model.hpp>
#include <ricochet/engine/lane_groups.hpp>
#include <utility>

namespace ricochet {
namespace {

// For which operators are chosen.
constexpr int full_block = 8;
constexpr long long long_march = 100000000;
// Cost of flights beside blocks of eight: what was measured, over what the two models say. On 18 sweeps of 500 to 2000
// steps per period this ratio was 0.23 to 0.47.
constexpr double flights_beside_blocks = 0.35;

bool same_matrix(const SparseMatrix& a, const SparseMatrix& b) {
  if (a.rows() != b.rows() || a.cols() != b.cols() || a.nonZeros() != b.nonZeros()) return false;
  return a.nonZeros() == 0 || (a - b).cwiseAbs().sum() == 0;
}

constexpr std::array<double, 5> instants{0.0, 0.0137, 0.1973, 0.7719, 3.3391};  // no period hides them, s

// Loads are formulas: they are the same when they give the same forces at these instants.
bool same_load(const SemiDiscrete& a, const SemiDiscrete& b) {
  const bool absent = !a.load || a.load->absent();
  if (absent != (!b.load || b.load->absent())) return false;
  if (absent) return true;
  Eigen::VectorXd left = Eigen::VectorXd::Zero(a.dofs()), right = left;
  for (const double t : instants) {
    a.load->assemble(t, left.data());
    b.load->assemble(t, right.data());
    if (left != right) return false;
  }
  return true;
}

bool alike(const TimeHistory& a, const TimeHistory& b) {
  return std::all_of(instants.begin(), instants.end(), [&](double t) { return a.value(t) == b.value(t); });
}

// Histories as well.
bool same_motions(const SupportMotions& a, const SupportMotions& b) {
  if (a.histories.size() != b.histories.size()) return false;
  if (a.empty()) return true;
  if (a.at_points != b.at_points || a.at_tip != b.at_tip) return false;
  for (std::size_t j = 0; j < a.histories.size(); ++j)
    if (!alike(*a.histories[j], *b.histories[j])) return false;
  return true;
}

bool same_rows(const SparseRows& a, const SparseRows& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() && (a.rows() == 0 || (a - b).squaredNorm() == 0);
}

// Coefficients are those of lanes.
bool same_rubbing(const SemiDiscrete& a, const SemiDiscrete& b) {
  if (a.rubbing.size() != b.rubbing.size() || a.rubbed_speeds != b.rubbed_speeds ||
      a.rubbed_motions.size() != b.rubbed_motions.size())
    return false;
  for (std::size_t i = 0; i < a.rubbing.size(); ++i)
    if (!a.rubbing[i].like(b.rubbing[i])) return false;
  for (std::size_t k = 0; k < a.rubbed_motions.size(); ++k) {
    const SurfaceMotion &one = a.rubbed_motions[k], &other = b.rubbed_motions[k];
    if (one.row != other.row || one.share != other.share || !alike(*one.history, *other.history)) return false;
  }
  return true;
}

bool same_problem(const SemiDiscrete& a, const SemiDiscrete& b) {
  return a.dofs() == b.dofs() && a.points() == b.points() && same_matrix(a.stiffness, b.stiffness) &&
         same_matrix(a.inertia.mass, b.inertia.mass) && same_matrix(a.inertia.coupling, b.inertia.coupling) &&
         same_matrix(a.inertia.velocity_mass, b.inertia.velocity_mass) &&
         same_matrix(a.inertia.inverse, b.inertia.inverse) && a.damping == b.damping &&
         a.support.pulsation == b.support.pulsation && a.contact_x == b.contact_x && a.stops == b.stops &&
         a.own == b.own && same_rubbing(a, b) && same_rows(a.rubbed.rows, b.rubbed.rows) && same_load(a, b) &&
         same_motions(a.motions, b.motions);
}

// A load is a formula, which keeps what it works with inside: every program that may run beside others has its own.
std::shared_ptr<const SemiDiscrete> with_own_load(const std::shared_ptr<const SemiDiscrete>& problem) {
  if (!problem->load || problem->load->absent()) return problem;
  auto own = std::make_shared<SemiDiscrete>(*problem);
  own->load = std::make_shared<const DistributedLoad>(*problem->load);
  return own;
}

double steps_of_period(const LaneCandidate& candidate) {
  return 2 * std::numbers::pi / (candidate.problem->support.pulsation * candidate.h);
}

StepWork work_of(const LaneCandidate& candidate) {
  return {static_cast<int>(candidate.plan.slots.size()), static_cast<int>(candidate.plan.stages.size()), false};
}

CompileOptions options_of(const LaneCandidate& candidate) {
  CompileOptions options;
  options.make_friction = candidate.make_friction;
  options.moving_support = candidate.problem->support.pulsation != 0;
  return options;
}

}  // namespace

struct LaneGroups::Group {
  LaneCandidate scene;  // the first one
  OperatorKind kind = OperatorKind::automatic;
  std::shared_ptr<const MarchModel> model;
  std::vector<LeftOut> left_out;
  bool flies = false;
};

LaneGroups::LaneGroups(MarchWay way) : way_(way) {}
LaneGroups::~LaneGroups() = default;

// A program of one lane that leaves out steps, where one is wanted and expected to cost less than a lane among eight.
bool LaneGroups::try_flights(const LaneCandidate& candidate, Group& group) const {
  CompileOptions options = options_of(candidate);
  options.march = MarchWay::flights;
  options.expected_steps = long_march;
  auto compiled =
      compile(candidate.problem, candidate.plan, candidate.h, candidate.make_law(), {candidate.lane}, options);
  if (const auto* refusal = std::get_if<Refusal>(&compiled)) {
    if (way_ == MarchWay::flights) throw *refusal;
    return false;
  }
  if (way_ == MarchWay::automatic) {
    const double steps = steps_of_period(candidate);
    const StepWork work = work_of(candidate);
    const OperatorKind kind = cheapest_kind(*candidate.problem, work, full_block, long_march);
    const double lane = predict_cost(kind, *candidate.problem, work, full_block).step_seconds / full_block;
    if (flights_beside_blocks * predict_visits(*candidate.problem, work, steps) >= steps * lane) return false;
  }
  const Program& program = std::get<Program>(compiled);
  group.kind = OperatorKind::modal;
  group.model = program.model;
  group.left_out = program.left_out;
  group.flies = true;
  return true;
}

bool LaneGroups::flies() const {
  return !groups_.empty() && groups_.front()->flies;
}

int LaneGroups::add(LaneCandidate candidate) {
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const LaneCandidate& known = groups_[g]->scene;
    if (known.h == candidate.h && known.law == candidate.law && known.friction == candidate.friction &&
        known.scheme == candidate.scheme && same_problem(*known.problem, *candidate.problem))
      return static_cast<int>(g);
  }
  auto group = std::make_unique<Group>();
  // The first group decides for all.
  const bool first = groups_.empty();
  const bool flights = way_ != MarchWay::every_step && (first || flies());
  if (!flights || !try_flights(candidate, *group)) {
    CompileOptions options = options_of(candidate);
    options.kind = first ? OperatorKind::automatic : groups_.front()->kind;
    options.expected_steps = long_march;
    auto compiled = compile(candidate.problem, candidate.plan, candidate.h, candidate.make_law(),
                            std::vector<LaneSpec>(full_block, candidate.lane), options);
    if (const auto* refusal = std::get_if<Refusal>(&compiled)) throw *refusal;
    const Program& program = std::get<Program>(compiled);
    group->kind = program.kind == OperatorKind::diagonal ? OperatorKind::band : program.kind;
    group->model = program.model;
    group->left_out = program.left_out;
  }
  group->scene = std::move(candidate);
  groups_.push_back(std::move(group));
  return count() - 1;
}

std::shared_ptr<const SemiDiscrete> LaneGroups::problem(int group) const {
  return groups_[static_cast<std::size_t>(group)]->scene.problem;
}
const StepPlan& LaneGroups::plan(int group) const {
  return groups_[static_cast<std::size_t>(group)]->scene.plan;
}
double LaneGroups::step(int group) const {
  return groups_[static_cast<std::size_t>(group)]->scene.h;
}
const char* LaneGroups::operator_chosen() const {
  return groups_.empty() ? "" : operator_name(groups_.front()->kind);
}
const std::vector<LeftOut>& LaneGroups::left_out(int group) const {
  return groups_[static_cast<std::size_t>(group)]->left_out;
}

double LaneGroups::predicted_step_seconds(int group, int lanes) const {
  const Group& one = *groups_[static_cast<std::size_t>(group)];
  if (const double steps = steps_of_period(one.scene); one.flies && std::isfinite(steps))
    return lanes * predict_visits(*one.scene.problem, work_of(one.scene), steps) / steps;
  return program(group, std::vector<LaneSpec>(static_cast<std::size_t>(lanes), one.scene.lane)).predicted_step_seconds;
}

Program LaneGroups::program(int group, std::vector<LaneSpec> lanes, int tangents) const {
  const Group& one = *groups_[static_cast<std::size_t>(group)];
  CompileOptions options = options_of(one.scene);
  options.kind = one.kind;
  options.tangents = tangents;
  if (one.flies && lanes.size() == 1) {
    options.march = MarchWay::flights;
    options.expected_steps = long_march;
  }
  auto compiled = compile(with_own_load(one.scene.problem), one.scene.plan, one.scene.h, one.scene.make_law(),
                          std::move(lanes), options);
  if (const auto* refusal = std::get_if<Refusal>(&compiled)) throw *refusal;
  return std::move(std::get<Program>(compiled));
}

LaneState LaneGroups::carry(const LaneState& state, int from, int to) const {
  if (from == to) return state;
  const Group& source = *groups_[static_cast<std::size_t>(from)];
  const Group& target = *groups_[static_cast<std::size_t>(to)];
  const Eigen::Index rows = source.model->rows();
  LaneState carried = state;
  carried.slots.clear();
  for (std::size_t j = 0; j < source.scene.plan.slots.size(); ++j) {
    Eigen::VectorXd slot =
        Eigen::Map<const Eigen::VectorXd>(state.slots.data() + static_cast<Eigen::Index>(j) * rows, rows);
    const double was = source.scene.plan.initial[j][1], is = target.scene.plan.initial[j][1];
    if (source.scene.plan.initial[j][0] == 0 && was != 0) slot *= is / was;
    slot = target.model->to_model(source.model->to_nodal(slot));
    carried.slots.insert(carried.slots.end(), slot.data(), slot.data() + slot.size());
  }
  return carried;
}

}  // namespace ricochet
