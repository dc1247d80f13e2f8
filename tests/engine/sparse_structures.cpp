// Structures whose matrices are sparse and of no narrow band march by a sparse factor, as a band would march them.
#include <fmt/format.h>

#include <ricochet/engine/cost_model.hpp>
#include <ricochet/scene/structure/assembled_structure.hpp>

#include "tests/allocations.hpp"
#include "tests/marching.hpp"
#include "tests/scene/structure/beam_files.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

const Methods methods{{"consistent"}, {"signorini"}, {"newmark-dumont-paoli", {{"beta", 0.5}}}};

// Masses on springs in a rectangle, held along its edge, pushed in its middle onto two stops.
SceneSpec net(int along, int across) {
  const auto dof = [&](int i, int j) { return across * i + j; };
  AssembledFiles files;
  files.stiffness_name = "K.mtx";
  files.mass_name = "M.mtx";
  std::string table = "dof,node,component,x,y,z,held\n";
  std::vector<Eigen::Triplet<double>> K, M;
  for (int i = 0; i < along; ++i)
    for (int j = 0; j < across; ++j) {
      table += fmt::format("{},{}-{},uz,{},{},0,\n", dof(i, j) + 1, i, j, i, j);
      K.emplace_back(dof(i, j), dof(i, j), 4e4);
      M.emplace_back(dof(i, j), dof(i, j), 1);
      for (const auto& [a, b] : {std::pair(i + 1, j), {i, j + 1}})
        if (a < along && b < across)
          for (const auto& [one, other] : {std::pair(dof(i, j), dof(a, b)), {dof(a, b), dof(i, j)}}) {
            K.emplace_back(one, other, -1e4);
            M.emplace_back(one, other, 0.1);
          }
    }
  files.table = read_dof_table(table, "dofs.csv");
  for (const auto& [matrix, entries] : {std::pair(&files.stiffness.matrix, &K), {&files.mass.matrix, &M}}) {
    matrix->resize(along * across, along * across);
    matrix->setFromTriplets(entries->begin(), entries->end());
  }
  SceneSpec scene = assembled_scene(assemble_structure(files), {1e-4, 0});
  const auto node = [](int i, int j) { return at_node(fmt::format("{}-{}", i, j), "uz"); };
  const int i = along / 2, j = across / 2;
  scene.stops.named = {{"first", node(i, j), {}, -1e-3, 1e-3}, {"second", node(i - 1, j), {}, -2e-3, 5e-4}};
  scene.load.terms = {{true, {}, {}, Formula("400*sin(60*t)", "", "t"), node(i, j - 1)}};
  return scene;
}

Marcher marcher_of(const SceneSpec& scene, OperatorKind kind) {
  CompileOptions options;
  options.kind = kind;
  return marcher(scene, 1, methods, 1e-3, options);
}

}  // namespace

TEST_CASE("the fill of a factor decides between a band and a sparse operator") {
  const auto square = problem_of(net(24, 24), 1, methods.mass), strip = problem_of(net(150, 3), 1, methods.mass);
  const StepWork work{2, 1, false};
  for (const int lanes : {1, 8}) {
    INFO(lanes << " lanes");
    CHECK(cheapest_kind(*square, work, lanes, 100) == OperatorKind::sparse);
    CHECK(cheapest_kind(*strip, work, lanes, 100) == OperatorKind::band);
  }
  // Four times the dofs and twice the bandwidth: a band has eight times the entries. The fill of a net grows as n log
  // n.
  const auto wide = problem_of(net(48, 48), 1, methods.mass);
  const auto ratio = [&](OperatorKind kind) {
    return predict_cost(kind, *wide, work, 1).step_seconds / predict_cost(kind, *square, work, 1).step_seconds;
  };
  CHECK(ratio(OperatorKind::band) > 7);
  CHECK(ratio(OperatorKind::sparse) < 6.5);
}

TEST_CASE("a sparse operator marches as a band does, and its energies are the same") {
  const SceneSpec scene = net(12, 11);
  Marcher band = marcher_of(scene, OperatorKind::band), sparse = marcher_of(scene, OperatorKind::sparse);
  const EnergyAudit expected = audited(band, 0.3), found = audited(sparse, 0.3);
  REQUIRE(expected.contact(0).impacts > 3);
  // Round-off that impacts multiply: some ten of them, by the ratio of a spring to the step's stiffness each.
  constexpr double round_off = 1e-10;
  CHECK(found.contact(0).impacts == expected.contact(0).impacts);
  CHECK((band.position(0) - sparse.position(0)).norm() <= round_off * band.position(0).norm());
  const EnergySample &a = expected.energy(0), &b = found.energy(0);
  const EnergyTotals &all = expected.totals(0), &other = found.totals(0);
  const double scale = all.work_of_loads;
  for (const auto& [one, two] : {std::pair(a.kinetic, b.kinetic),
                                 {a.elastic, b.elastic},
                                 {a.scheme, b.scheme},
                                 {all.work_of_loads, other.work_of_loads},
                                 {all.work_of_damping, other.work_of_damping},
                                 {all.work_of_contact, other.work_of_contact}})
    CHECK(std::abs(one - two) <= round_off * scale);
}

TEST_CASE("the marching loop of a sparse operator allocates nothing under the audit") {
  Marcher made = marcher_of(net(12, 11), OperatorKind::sparse);
  EnergyAudit audit(made, SamplingMode::seldom);
  made.start(&audit);
  made.march(100, &audit);
  REQUIRE(audit.contact(0).contact_steps > 0);
  const long before = allocations();
  made.march(64, &audit);
  CHECK(allocations() == before);
}

TEST_CASE("lanes of a sparse operator are bitwise those that march alone") {
  const SceneSpec scene = net(12, 11);
  const auto lanes = [](const LaneSpec& lane) {
    std::vector<LaneSpec> all(5, lane);
    for (std::size_t k = 0; k < all.size(); ++k) {
      all[k].upper *= 1 + 0.1 * static_cast<double>(k);
      all[k].position.setLinSpaced(0, 1e-4 * static_cast<double>(k));
    }
    return all;
  };
  CompileOptions options;
  options.kind = OperatorKind::sparse;
  Marcher block = marcher(scene, 1, methods, 1e-3, options, lanes);
  run(block, 0.2);
  for (int k = 0; k < block.lanes(); ++k) {
    Marcher alone = marcher(scene, 1, methods, 1e-3, options, [&](const LaneSpec& lane) {
      return std::vector<LaneSpec>{lanes(lane)[static_cast<std::size_t>(k)]};
    });
    run(alone, 0.2);
    CHECK(alone.position(0) == block.position(k));
  }
}

TEST_CASE("a start rule near to the step is solved through the factor of the step, one that is far has its own") {
  const auto problem = problem_of(net(12, 11), 1, methods.mass);
  const MarchModel model(problem, false);
  const auto weighs = [](double mass, double stiffness) {
    FoldedStage stage;
    stage.mass = mass;
    stage.stiffness = stiffness;
    stage.stiffness_history = {1};
    stage.mass_history = stage.damping_history = {0};
    return stage;
  };
  const auto factored = [&](const FoldedStage& stage) {
    return std::move(std::get<std::unique_ptr<StageOperator>>(make_operator(OperatorKind::sparse, model, stage, 1)));
  };
  const FoldedStage step = weighs(1e6, 0.6);
  const auto of_step = factored(step);
  Eigen::VectorXd slot = Eigen::VectorXd::LinSpaced(model.rows(), -1, 2);
  slot[7] = 30;
  FreeStepInput input;
  const double* slots[] = {slot.data()};
  input.slots = slots;
  input.k = slot.data();
  for (const auto& [mass, stiffness] : {std::pair(2e6, 1.2), {2e6, 1.0}, {2e6, 0.4}}) {
    INFO(mass << " M + " << stiffness << " K");
    const FoldedStage start = weighs(mass, stiffness);
    const auto near = make_near_operator(model, start, 1, step, *of_step);
    REQUIRE(near);
    const auto own = factored(start);
    near->free_step(input);
    own->free_step(input);
    const Eigen::Map<const Eigen::VectorXd> found(near->unknown(), model.rows()),
        expected(own->unknown(), model.rows());
    // Of matrices whose condition is below 3.
    CHECK((found - expected).norm() <= 1e-14 * expected.norm());
    Eigen::VectorXd column(model.rows()), of_own(model.rows());
    near->solve_column(slot.data(), column.data());
    own->solve_column(slot.data(), of_own.data());
    CHECK(column == of_own);
  }
  // Without stiffness, with less mass than a multiple of the step has, or too far from it.
  for (const auto& [mass, stiffness] : {std::pair(1e6, 0.0), {1e6, 1.2}, {2e6, 0.3}})
    CHECK_FALSE(make_near_operator(model, weighs(mass, stiffness), 1, step, *of_step));
}
