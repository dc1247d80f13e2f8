#include "runners/kinds/sweep/forced_scenes.hpp"

#include <cmath>
#include <numbers>

#include "runners/kinds/sweep/with_parameter.hpp"
#include "runners/march/prepare_case.hpp"

namespace ricochet {
namespace {

bool same_matrix(const SparseMatrix& a, const SparseMatrix& b) {
  if (a.rows() != b.rows() || a.cols() != b.cols() || a.nonZeros() != b.nonZeros()) return false;
  return a.nonZeros() == 0 || (a - b).cwiseAbs().sum() == 0;
}

// Loads are formulas: they are the same when they give the same forces at times that no period hides.
bool same_load(const SemiDiscrete& a, const SemiDiscrete& b) {
  const bool absent = !a.load || a.load->absent();
  if (absent != (!b.load || b.load->absent())) return false;
  if (absent) return true;
  Eigen::VectorXd left = Eigen::VectorXd::Zero(a.dofs()), right = left;
  for (const double t : {0.0, 0.0137, 0.1973, 0.7719, 3.3391}) {
    a.load->assemble(t, left.data());
    b.load->assemble(t, right.data());
    if (left != right) return false;
  }
  return true;
}

bool same_problem(const SemiDiscrete& a, const SemiDiscrete& b) {
  return a.dofs() == b.dofs() && a.points() == b.points() && same_matrix(a.stiffness, b.stiffness) &&
         same_matrix(a.inertia.mass, b.inertia.mass) && same_matrix(a.inertia.coupling, b.inertia.coupling) &&
         same_matrix(a.inertia.velocity_mass, b.inertia.velocity_mass) && a.damping.stiffness == b.damping.stiffness &&
         a.damping.mass == b.damping.mass && a.support.pulsation == b.support.pulsation && a.contact_x == b.contact_x &&
         same_load(a, b);
}

// A load is a formula, which keeps what it works with inside: every program that may run beside others has its own.
std::shared_ptr<const SemiDiscrete> with_own_load(const std::shared_ptr<const SemiDiscrete>& problem) {
  if (!problem->load || problem->load->absent()) return problem;
  auto own = std::make_shared<SemiDiscrete>(*problem);
  own->load = std::make_shared<const DistributedLoad>(*problem->load);
  return own;
}

// Parameters of the law that need a law of their own: all but those that may differ between lanes.
std::map<std::string, ParameterValue> shared_parameters(const Parameters& all, const PluginManual& manual) {
  std::map<std::string, ParameterValue> shared = all.values();
  for (const ParameterSpec& spec : manual.parameters)
    if (spec.per_lane) shared.erase(spec.key);
  return shared;
}

}  // namespace

struct ForcedScenes::Group {
  std::shared_ptr<const SemiDiscrete> problem;
  MethodChoice contact, time;
  std::map<std::string, ParameterValue> law;  // shared ones
  StepPlan plan;
  double h = 0;
  OperatorKind kind = OperatorKind::automatic;
  std::shared_ptr<const MarchModel> model;
  std::vector<LeftOut> left_out;
  std::vector<std::string> notes;
};

ForcedScenes::ForcedScenes(const StudyCase& study_case, const Registry& registry)
    : case_(study_case), registry_(registry) {}
ForcedScenes::~ForcedScenes() = default;

int ForcedScenes::add(const std::function<StudyCase()>& variant) {
  const int number = count();
  scenes_.emplace_back();
  ForcedScene& scene = scenes_.back();
  try {
    const StudyCase one = variant();
    scene.pulsation = forcing_pulsation(one.scene);
    auto candidate = std::make_unique<Group>();
    candidate->h = 2 * std::numbers::pi / scene.pulsation / one.steps_per_period;
    candidate->contact = one.contact;
    candidate->time = one.time;
    candidate->law = shared_parameters(one.contact.parameters, registry_.contact(one.contact.name)->manual);
    auto made = discretise(one.scene, one.elements, *make_mass(one, registry_));
    if (const auto* refusal = std::get_if<Refusal>(&made)) {
      scene.refusal = refusal->sentence;
      return number;
    }
    candidate->problem = std::make_shared<const SemiDiscrete>(std::move(std::get<SemiDiscrete>(made)));
    scene.lane = scene_lane(*candidate->problem, one.contact.parameters);
    const auto law = make_law(one, registry_);
    const auto plan = make_scheme(one, registry_)->plan(candidate->h, problem_facts(*candidate->problem, *law));
    if (const auto* refusal = std::get_if<Refusal>(&plan)) {
      scene.refusal = refusal->sentence;
      return number;
    }
    candidate->plan = std::get<StepPlan>(plan);
    candidate->notes = candidate->problem->notes;
    scene.group = group_of(std::move(candidate));
  } catch (const InputError& error) {
    scene.refusal = (error.pointer().empty() ? "" : error.pointer() + ": ") + error.what();
  } catch (const Refusal& refusal) {
    scene.refusal = refusal.sentence;
  }
  return number;
}

int ForcedScenes::add(const std::string& pointer, double value, bool own_state) {
  return add([&] {
    const StudyCase one = with_parameter(case_, pointer, value);
    return own_state ? one : at_rest(one);
  });
}

int ForcedScenes::group_of(std::unique_ptr<Group> candidate) {
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const Group& known = *groups_[g];
    if (known.h == candidate->h && known.law == candidate->law &&
        known.time.parameters.values() == candidate->time.parameters.values() &&
        same_problem(*known.problem, *candidate->problem))
      return static_cast<int>(g);
  }
  // The operator is chosen once, for a block of eight lanes and a long march.
  CompileOptions options;
  options.kind = groups_.empty() ? OperatorKind::automatic : groups_.front()->kind;
  options.moving_support = true;
  options.expected_steps = 100000000;
  const auto* entry = registry_.contact(candidate->contact.name);
  const LaneSpec lane = scene_lane(*candidate->problem, candidate->contact.parameters);
  auto compiled = compile(candidate->problem, candidate->plan, candidate->h, entry->make(candidate->contact.parameters),
                          std::vector<LaneSpec>(8, lane), options);
  if (const auto* refusal = std::get_if<Refusal>(&compiled)) throw *refusal;
  const Program& program = std::get<Program>(compiled);
  candidate->kind = program.kind == OperatorKind::diagonal ? OperatorKind::band : program.kind;
  candidate->model = program.model;
  candidate->left_out = program.left_out;
  groups_.push_back(std::move(candidate));
  return groups() - 1;
}

const SemiDiscrete& ForcedScenes::problem(int group) const {
  return *groups_[static_cast<std::size_t>(group)]->problem;
}
std::shared_ptr<const SemiDiscrete> ForcedScenes::shared_problem(int group) const {
  return groups_[static_cast<std::size_t>(group)]->problem;
}
const StepPlan& ForcedScenes::plan(int group) const {
  return groups_[static_cast<std::size_t>(group)]->plan;
}
double ForcedScenes::step(int group) const {
  return groups_[static_cast<std::size_t>(group)]->h;
}
const std::vector<std::string>& ForcedScenes::notes(int group) const {
  return groups_[static_cast<std::size_t>(group)]->notes;
}
const char* ForcedScenes::operator_chosen() const {
  return groups_.empty() ? "" : operator_name(groups_.front()->kind);
}
std::vector<LeftOut> ForcedScenes::left_out(int group) const {
  return groups_[static_cast<std::size_t>(group)]->left_out;
}

double ForcedScenes::predicted_step_seconds(int group, int lanes) const {
  const LaneSpec lane = scene_lane(problem(group), groups_[static_cast<std::size_t>(group)]->contact.parameters);
  return program(group, std::vector<LaneSpec>(static_cast<std::size_t>(lanes), lane)).predicted_step_seconds;
}

Program ForcedScenes::program(int group, std::vector<LaneSpec> lanes, int tangents) const {
  const Group& one = *groups_[static_cast<std::size_t>(group)];
  CompileOptions options;
  options.kind = one.kind;
  options.moving_support = one.problem->support.pulsation != 0;
  options.tangents = tangents;
  auto compiled = compile(with_own_load(one.problem), one.plan, one.h,
                          registry_.contact(one.contact.name)->make(one.contact.parameters), std::move(lanes), options);
  if (const auto* refusal = std::get_if<Refusal>(&compiled)) throw *refusal;
  return std::move(std::get<Program>(compiled));
}

LaneState ForcedScenes::carry(const LaneState& state, int from, int to) const {
  if (from == to) return state;
  const Group& source = *groups_[static_cast<std::size_t>(from)];
  const Group& target = *groups_[static_cast<std::size_t>(to)];
  const Eigen::Index rows = source.model->rows();
  LaneState carried = state;
  carried.slots.clear();
  for (std::size_t j = 0; j < source.plan.slots.size(); ++j) {
    Eigen::VectorXd slot =
        Eigen::Map<const Eigen::VectorXd>(state.slots.data() + static_cast<Eigen::Index>(j) * rows, rows);
    const double was = source.plan.initial[j][1], is = target.plan.initial[j][1];
    if (source.plan.initial[j][0] == 0 && was != 0) slot *= is / was;
    slot = target.model->to_model(source.model->to_nodal(slot));
    carried.slots.insert(carried.slots.end(), slot.data(), slot.data() + slot.size());
  }
  return carried;
}

}  // namespace ricochet
