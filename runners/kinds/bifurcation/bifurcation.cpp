#include "runners/kinds/bifurcation/bifurcation.hpp"

#include "runners/kinds/bifurcation/bifurcation_answers.hpp"
#include "runners/kinds/bifurcation/page/page.hpp"
#include "runners/kinds/bifurcation/point.hpp"
#include "runners/kinds/bifurcation/run_bifurcation.hpp"
#include "runners/kinds/sweep/dynamics_tables.hpp"
#include "runners/kinds/sweep/sweep.hpp"
#include "runners/kinds/sweep/sweep_keys.hpp"
#include "runners/study/fields.hpp"

namespace ricochet {
namespace {

std::vector<Field> bifurcation_keys() {
  using namespace keys;
  ObjectForm listed;
  Field values = of_form(Field::Form::numbers, "values", std::nullopt, "The values, all different.");
  values.spec = real_parameter("values", "as the parameter", std::nullopt, any, values.spec.text);
  listed.fields = {std::move(values)};
  ObjectForm parameter;
  parameter.fields = {swept_pointer()};
  parameter.ways = {listed, swept_range("Number of values, evenly spaced.")};

  ObjectForm random;
  random.fields = {integer("random", {1, 10000, false, false}, std::nullopt, "Number of random initial states."),
                   integer("seed", {0, 9007199254740992.0, false, false}, 1, "Seed of the random states.")};
  Field start =
      of_form(Field::Form::starts, "start", Json::array({"rest"}),
              "Where orbits begin: at rest, as the scene says, where the next lower (up) or higher (down) value "
              "ended, or at random.");
  start.spec = word_parameter("start", {"rest", "state", "up", "down"}, std::nullopt, start.spec.text);
  start.nested.push_back(std::move(random));

  std::vector<Field> fields = {
      object("parameter", std::nullopt, "What the diagram is drawn against.", std::move(parameter)), steps_per_period(),
      march("every-step"), std::move(start)};
  for (Field& field : orbit_keys()) fields.push_back(std::move(field));
  fields.push_back(integer("exponents", {0, 100000, false, false}, 0, "Number of Lyapunov exponents, largest first."));
  fields.push_back(optional(real("refine", "as the parameter", positive, std::nullopt,
                                 "Width to which changes of class are located; null: none.")));
  fields.push_back(budget());
  return fields;
}

}  // namespace

Kind bifurcation_kind() {
  Kind kind = sweep_kind(run_bifurcation, derive_dynamics);
  kind.format.name = "bifurcation";
  kind.format.text = "Each case goes through a parameter: sections, classes and exponents of its orbits.";
  kind.format.keys = bifurcation_keys();
  kind.plan = plan_bifurcation;
  kind.measures = orbit_measures();
  kind.answers = bifurcation_answers;
  kind.point = march_orbit_again;
  kind.page = report::bifurcation_page;
  return kind;
}

}  // namespace ricochet
