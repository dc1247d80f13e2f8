#include <limits>

#include "runners/study/field.hpp"

namespace ricochet {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
const Range any{};
const Range positive{0, infinity, true, false};
const Range non_negative{0, infinity, false, false};

Field real(const char* key, const char* unit, const Range& range, std::optional<double> fallback, const char* text) {
  Field field;
  field.spec = real_parameter(key, unit, fallback, range, text);
  if (fallback) field.fallback = *fallback;
  field.axis = true;
  return field;
}

Field single(Field field) {
  field.axis = false;
  return field;
}

Field integer(const char* key, const Range& range, std::optional<long long> fallback, const char* text) {
  Field field;
  field.spec = integer_parameter(key, fallback, range, text);
  if (fallback) field.fallback = *fallback;
  return field;
}

Field word(const char* key, std::vector<std::string> words, std::optional<std::string> fallback, const char* text) {
  Field field;
  field.spec = word_parameter(key, std::move(words), fallback, text);
  if (fallback) field.fallback = *fallback;
  return field;
}

Field named(Field::Form form, const char* key, std::optional<Json> fallback, const char* text) {
  Field field;
  field.form = form;
  field.spec.key = key;
  field.spec.text = text;
  field.fallback = std::move(fallback);
  return field;
}

Field formula(const char* key, const char* unit, const char* variables, bool nullable, std::optional<Json> fallback,
              const char* text) {
  Field field = named(Field::Form::formula, key, std::move(fallback), text);
  field.spec.unit = unit;
  field.variables = variables;
  field.nullable = nullable;
  field.axis = true;
  return field;
}

Field object(const char* key, std::optional<Json> fallback, const char* text, ObjectForm keys) {
  Field field = named(Field::Form::object, key, std::move(fallback), text);
  field.nested.push_back(std::move(keys));
  return field;
}

Field methods(const char* key, Role role, const char* text) {
  Field field = named(Field::Form::methods, key, std::nullopt, text);
  field.role = role;
  return field;
}

ObjectForm section() {
  ObjectForm keys;
  keys.fields = {word("type", {"tube", "circle", "rectangle", "given"}, std::nullopt, "Shape of the cross-section.")};
  keys.discriminator = "/type";
  keys.variants = {
      {{"tube"},
       {{real("outer_diameter", "m", positive, std::nullopt,
              "Outer diameter D; I = π(D⁴ − d⁴)/64 with d = D − 2·wall."),
         real("wall", "m", positive, std::nullopt, "Wall thickness, at most half of the outer diameter.")},
        "",
        {}}},
      {{"circle"}, {{real("diameter", "m", positive, std::nullopt, "Diameter D; I = πD⁴/64.")}, "", {}}},
      {{"rectangle"},
       {{real("width", "m", positive, std::nullopt, "Width b, along the axis of bending; I = b h³/12."),
         real("height", "m", positive, std::nullopt, "Height h, across which the section bends.")},
        "",
        {}}},
      {{"given"},
       {{real("EI", "N m²", positive, std::nullopt, "Bending stiffness, given as a number."),
         real("rhoS", "kg/m", positive, std::nullopt, "Mass per length, given as a number.")},
        "",
        {}}},
  };
  return keys;
}

ObjectForm structure() {
  ObjectForm damping;
  damping.fields = {real("stiffness", "s", non_negative, 0.0, "α of C = αK + ηM."),
                    real("mass", "1/s", non_negative, 0.0, "η of C = αK + ηM.")};
  ObjectForm beam;
  beam.fields = {real("length", "m", positive, std::nullopt, "Length L; clamped at x = 0, free at x = L."),
                 object("section", std::nullopt, "Cross-section: EI and ρS follow from it.", section()),
                 object("damping", Json::object(), "Viscous damping C = αK + ηM.", damping)};
  beam.discriminator = "/section/type";
  beam.variants = {{{"tube", "circle", "rectangle"},
                    {{real("young", "Pa", positive, std::nullopt, "Young's modulus E."),
                      real("density", "kg/m³", positive, std::nullopt, "Density ρ.")},
                     "",
                     {}}},
                   {{"given"}, {}}};
  ObjectForm force;
  force.fields = {real("amplitude", "N", any, 0.0, "F of the force F cos(ωt + ψ)."),
                  real("pulsation", "rad/s", non_negative, 0.0, "ω of the force."),
                  real("phase", "rad", any, 0.0, "ψ of the force.")};
  ObjectForm oscillator;
  oscillator.fields = {real("mass", "kg", positive, std::nullopt, "Mass m."),
                       real("stiffness", "N/m", non_negative, std::nullopt, "Stiffness k; 0: a free mass."),
                       real("damping", "N s/m", non_negative, 0.0, "Damping c."),
                       object("force", Json::object(), "Harmonic force on the mass; absent: none.", force)};
  ObjectForm bar;
  bar.fields = {real("length", "m", positive, std::nullopt, "Length L."),
                real("EA", "N", positive, std::nullopt, "Stiffness EA."),
                real("rhoA", "kg/m", positive, std::nullopt, "Mass per length ρA."),
                word("fixed", {"right", "left", "none"}, std::nullopt,
                     "The end that is held; the tip is the free one (x = 0 where both are free)."),
                object("damping", Json::object(), "Viscous damping C = αK + ηM.", damping)};
  ObjectForm keys;
  keys.fields = {word("type", {"beam", "oscillator", "bar"}, std::nullopt, "What moves.")};
  keys.discriminator = "/type";
  keys.variants = {{{"beam"}, beam}, {{"oscillator"}, oscillator}, {{"bar"}, bar}};
  return keys;
}

ObjectForm scene() {
  ObjectForm stops;
  stops.fields = {formula("lower", "m", "x", true, Json(nullptr), "Lower stop g1(x) ≤ u; null: absent."),
                  formula("upper", "m", "x", true, Json(nullptr), "Upper stop u ≤ g2(x); null: absent."),
                  named(Field::Form::places, "at", Json("nodes"),
                        "Where stops act: \"nodes\", \"tip\" or a list of positions x in ]0, L].")};
  stops.fields.back().axis = true;

  ObjectForm support;
  support.fields = {real("amplitude", "m", any, std::nullopt, "A0 of the clamp's motion φ(t) = A0 sin(ωt + ψ)."),
                    real("pulsation", "rad/s", non_negative, std::nullopt, "ω of the clamp's motion."),
                    real("phase", "rad", any, 0.0, "ψ of the clamp's motion.")};

  ObjectForm initial;
  initial.fields = {
      formula("displacement", "m", "x", false, Json("0"), "Absolute displacement u(x,0)."),
      formula("velocity", "m/s", "x", false, Json("0"), "Absolute velocity u_t(x,0)."),
      word("projection", {"none", "constraint"}, "none",
           "\"constraint\" projects the initial data on Zᵀ(Kq − F) = 0, Z the kernel of a singular mass.")};
  initial.fields.back().axis = true;

  ObjectForm keys;
  keys.fields = {
      object("structure", std::nullopt, "The structure.", structure()),
      object("stops", Json::object(), "Two rigid stops g1(x) ≤ u ≤ g2(x); absent: no stops.", stops),
      object("support", Json{{"amplitude", 0.0}, {"pulsation", 0.0}, {"phase", 0.0}},
             "Motion of the clamp, φ(t) = A0 sin(ωt + ψ); absent: at rest.", support),
      formula("load", "N/m", "xt", false, Json("0"), "Distributed load f(x,t)."),
      object("initial", Json::object(), "Absolute initial state; absent: at rest in the laboratory frame.", initial)};
  return keys;
}

Field step() {
  return real("step", "s", positive, std::nullopt, "Time step h.");
}

Field duration() {
  return single(real("duration", "s", positive, std::nullopt,
                     "Simulated time; the run ends at the last whole step not beyond it."));
}

Field samples() {
  return integer("samples", {2, 1000000, false, false}, 200, "Number of points of each sampled curve.");
}

/// A number that may be null: no such limit.
Field optional(Field field) {
  field = single(std::move(field));
  field.nullable = true;
  field.fallback = Json(nullptr);
  return field;
}

Field budget() {
  return optional(real("budget", "s", positive, std::nullopt,
                       "Processor time after which a case is stopped and counts as failed; null: no limit."));
}

std::vector<Field> comparison() {
  Field reference =
      methods("reference", Role::reference,
              "What each case is compared with: a reference plugin, \"self\" (the method itself on finer "
              "steps and meshes), or a list; the first is the reference, and its gap to the others is part "
              "of the error floor.");
  reference.marched = true;
  Field errors = named(Field::Form::words, "errors", std::nullopt, "The errors to measure.");
  errors.spec = word_parameter("errors", error_names(), std::nullopt, errors.spec.text.c_str());
  errors.fallback = Json(error_names());
  return {
      step(),
      duration(),
      samples(),
      std::move(reference),
      std::move(errors),
      optional(real("horizon", "s", positive, std::nullopt,
                    "Trajectories are compared up to this time; null: up to the end, or up to where two nearby runs "
                    "have drifted apart, whichever comes first (the report says which).")),
      budget()};
}

std::vector<Field> work_precision() {
  std::vector<Field> fields = comparison();
  fields.push_back(integer("repeats", {1, 1000, false, false}, 5,
                           "How often each case is timed, one at a time, in turn with the others."));
  return fields;
}

std::vector<Field> stability() {
  ObjectForm steps;
  steps.fields = {single(real("from", "s", positive, std::nullopt, "Smallest step.")),
                  single(real("to", "s", positive, std::nullopt, "Largest step.")),
                  integer("count", {1, 10000, false, false}, 20, "Number of steps, spaced evenly on a log scale.")};
  Field observe;
  observe.spec.type = ParameterSpec::Type::boolean;
  observe.spec.key = "observe";
  observe.spec.text = "Whether the same cells are marched as well, and the limit found by bisection.";
  observe.fallback = true;
  return {object("steps", std::nullopt, "The range of steps.", steps), observe,
          optional(real("duration", "s", positive, std::nullopt,
                        "Simulated time of each observed cell; null: as long as growth needs to show.")),
          budget()};
}

Field steps_per_period() {
  Field field = integer("steps_per_period", {8, 100000000, false, false}, std::nullopt,
                        "Steps per forcing period: h = 2π/(ω·steps_per_period).");
  field.axis = true;
  return field;
}

// How long an orbit is marched and what is read of it: shared by diagrams and basins.
std::vector<Field> orbit() {
  ObjectForm transient;
  transient.fields = {
      integer("periods", {1, 100000000, false, false}, 300, "Forcing periods before the first reading."),
      integer("at_most", {1, 100000000, false, false}, 2000,
              "Forcing periods after which an orbit that has not settled is read all the same (and "
              "said not to have settled).")};
  return {object("transient", Json::object(), "What is left out until the orbit has settled, in forcing periods.",
                 transient),
          integer("keep", {16, 10000000, false, false}, 300, "Forcing periods that are read."),
          word("section", {"strobe", "impact", "extremum"}, "strobe",
               "When the state is read: once per forcing period, at each impact, or at each extremum of the tip."),
          single(real("phase", "rad", any, 0.0, "Phase of the forcing at which the strobe reads."))};
}

ObjectForm swept_range(const char* what) {
  ObjectForm keys;
  keys.fields = {single(real("from", "as the parameter", any, std::nullopt, "First value.")),
                 single(real("to", "as the parameter", any, std::nullopt, "Last value.")),
                 integer("count", {2, 1000000, false, false}, std::nullopt, what)};
  return keys;
}

Field swept_pointer() {
  return named(Field::Form::text, "pointer", std::nullopt,
               "JSON pointer to a number of the scene (\"/scene/support/amplitude\"; a formula in x or t is multiplied "
               "by the value) or to a real parameter of a method (\"/methods/contact/stiffness\").");
}

std::vector<Field> bifurcation() {
  ObjectForm listed;
  Field values = named(Field::Form::numbers, "values", std::nullopt, "The values, all different.");
  values.spec = real_parameter("values", "as the parameter", std::nullopt, any, values.spec.text);
  listed.fields = {std::move(values)};
  ObjectForm parameter;
  parameter.fields = {swept_pointer()};
  parameter.ways = {listed, swept_range("Number of values, evenly spaced.")};

  ObjectForm random;
  random.fields = {integer("random", {1, 10000, false, false}, std::nullopt, "Number of random initial states."),
                   integer("seed", {0, 9007199254740992.0, false, false}, 1, "Seed of the random states.")};
  Field start = named(Field::Form::starts, "start", Json::array({"rest"}),
                      "Where the orbits of each value begin: at rest in the laboratory frame, in the scene's own "
                      "initial state, where the next lower (up) or higher (down) value ended, or in random states.");
  start.spec = word_parameter("start", {"rest", "state", "up", "down"}, std::nullopt, start.spec.text);
  start.nested.push_back(std::move(random));

  std::vector<Field> fields = {
      object("parameter", std::nullopt, "What the diagram is drawn against.", std::move(parameter)), steps_per_period(),
      std::move(start)};
  for (Field& field : orbit()) fields.push_back(std::move(field));
  fields.push_back(integer("exponents", {0, 100000, false, false}, 0, "Number of Lyapunov exponents, largest first."));
  fields.push_back(optional(real("refine", "as the parameter", positive, std::nullopt,
                                 "Width to which changes of class are located between values; null: not located.")));
  fields.push_back(budget());
  return fields;
}

std::vector<Field> basins() {
  ObjectForm axis = swept_range("Number of cells, evenly spaced, the ends included.");
  axis.fields.insert(axis.fields.begin(), swept_pointer());
  Field axes = named(Field::Form::objects, "axes", std::nullopt, "The two axes of the grid, x and y.");
  axes.nested.push_back(std::move(axis));
  axes.count = 2;
  Field refine;
  refine.spec.type = ParameterSpec::Type::boolean;
  refine.spec.key = "refine";
  refine.spec.text =
      "Whether a coarse grid is marched first and only cells near a boundary of basins at full resolution.";
  refine.fallback = false;
  std::vector<Field> fields = {std::move(axes), steps_per_period()};
  for (Field& field : orbit()) fields.push_back(std::move(field));
  fields.push_back(std::move(refine));
  fields.push_back(budget());
  return fields;
}

// A new kind is one more entry here, with the keys that only it has.
std::vector<Variant> kinds() {
  return {
      {{"trajectory"}, {{step(), duration(), samples(), budget()}, "", {}}},
      {{"convergence"}, {comparison(), "", {}}},
      {{"work-precision"}, {work_precision(), "", {}}},
      {{"stability"}, {stability(), "", {}}},
      {{"bifurcation"}, {bifurcation(), "", {}}},
      {{"basins"}, {basins(), "", {}}},
  };
}

ObjectForm study() {
  ObjectForm mesh;
  mesh.fields = {integer("elements", {1, 100000, false, false}, std::nullopt, "Number of equal elements.")};
  mesh.fields.back().axis = true;

  ObjectForm chosen;
  chosen.fields = {methods("mass", Role::mass, "How velocities are discretised, hence the mass matrix."),
                   methods("contact", Role::contact, "The contact law."),
                   methods("time", Role::time, "The time scheme.")};

  ObjectForm keys;
  keys.fields = {
      named(Field::Form::text, "name", std::nullopt,
            "Name of the study: letters, digits, '-', '_' and '.'; results go to results/NAME."),
      named(Field::Form::text, "question", Json(""), "The question that the study answers."),
      word("kind", study_kinds(), std::nullopt, "What is made of each case."),
      object("scene", std::nullopt, "What is simulated, in SI units.", scene()),
      object("mesh", Json{{"elements", 1}}, "The meshes; only an oscillator does without.", mesh),
      object("methods", std::nullopt, "The methods whose combinations are run.", chosen),
      named(Field::Form::excludes, "exclude", Json::array(), "Combinations that are not run, each with its reason.")};
  keys.discriminator = "/kind";
  keys.variants = kinds();
  return keys;
}

}  // namespace

const std::vector<std::string>& error_names() {
  static const std::vector<std::string> names = {"tip-linf",    "tip-l2", "displacement-l2", "displacement-h2",
                                                 "velocity-l2", "energy", "impact-times",    "impulse"};
  return names;
}

std::vector<std::string> study_kinds() {
  std::vector<std::string> words;
  for (const Variant& kind : kinds()) words.insert(words.end(), kind.words.begin(), kind.words.end());
  return words;
}

const ObjectForm& study_form() {
  static const ObjectForm form = study();
  return form;
}

Json to_json(const ParameterValue& value) {
  return std::visit([](const auto& v) { return Json(v); }, value);
}

ObjectForm method_form(const PluginManual& manual) {
  ObjectForm keys;
  keys.fields = {word("name", {manual.name}, std::nullopt, manual.summary.c_str())};
  for (const ParameterSpec& spec : manual.parameters) {
    Field field;
    field.spec = spec;
    field.axis = true;
    if (spec.fallback) {
      const auto* whole = std::get_if<long long>(&*spec.fallback);
      field.fallback =
          whole && spec.type == ParameterSpec::Type::real ? Json(static_cast<double>(*whole)) : to_json(*spec.fallback);
    }
    keys.fields.push_back(std::move(field));
  }
  return keys;
}

}  // namespace ricochet
