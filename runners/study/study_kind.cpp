#include "runners/study/study_kind.hpp"

#include "runners/study/fields.hpp"
#include "runners/study/histories.hpp"
#include "runners/study/scene_keys.hpp"

namespace ricochet {

const StudyKind* find_study_kind(const std::string& name) {
  for (const StudyKind* kind : study_kinds())
    if (kind->name == name) return kind;
  return nullptr;
}

Json given_settings(const Json& resolved, const std::vector<std::string>& keys) {
  Json settings = Json::object();
  for (const std::string& key : keys)
    if (const auto found = resolved.find(key); found != resolved.end() && !found->is_null()) settings[key] = *found;
  return settings.empty() ? Json(nullptr) : settings;
}

namespace {

using namespace keys;

Field moves_with() {
  return quiet(
      of_form(Field::Form::text, "moves_with", Json(""), "The support that carries it, or \"all\"; absent: none.")
          .as("moves with"));
}

ObjectForm named_stop() {
  ObjectForm keys;
  keys.fields = {of_form(Field::Form::text, "name", std::nullopt, "Letters, digits, '-' and '_'; each once."),
                 place("at", std::nullopt, "Place whose displacement u(at) − u(to) the stop bounds.").as(""),
                 place("to", Json(nullptr), "The other place; null: the ground.").as("less"),
                 optional(real("lower", "m", any, std::nullopt, "Lower bound; null: none."))
                     .as("lower", "the lower bound of a stop"),
                 optional(real("upper", "m", any, std::nullopt, "Upper bound; null: none."))
                     .as("upper", "the upper bound of a stop"),
                 moves_with()};
  keys.fields[3].axis = keys.fields[4].axis = true;
  keys.fields.back().given.push_back(stop_motion_form());
  keys.fields.back().spec.text = "The support that carries it, \"all\", or a motion of its own; absent: none.";
  for (Field& field : parameters_of_stops()) keys.fields.push_back(std::move(field));
  keys.fields[1].node_alone = true;
  keys.fields[2].node_alone = true;
  for (Field& field : observed_of_stops()) keys.fields.push_back(std::move(field));
  keys.fields.push_back(clearance_key());
  return keys;
}

Field bodies() {
  Field field = of_form(Field::Form::bodies, "bodies", Json::object(),
                        "Structures by name that meet at stops, in the place of `structure`.")
                    .as("body");
  field.nested.push_back(structure_form());
  return quiet(std::move(field));
}

ObjectForm scene() {
  ObjectForm stops;
  stops.fields = {formula("lower", "m", "x", true, Json(nullptr),
                          "Lower stop g1(x) ≤ u; null: absent. Above the upper one under compliant laws only.")
                      .as("lower stop", "the lower stop"),
                  formula("upper", "m", "x", true, Json(nullptr), "Upper stop u ≤ g2(x); null: absent.")
                      .as("upper stop", "the upper stop"),
                  of_form(Field::Form::places, "at", Json("nodes"),
                          "Where stops act: \"nodes\", \"tip\" or a list of positions x in ]0, L].")
                      .as("stops at", "where stops act")};
  stops.fields.back().spec.unit = "m";
  stops.fields.back().axis = true;
  stops.fields.push_back(moves_with());

  ObjectForm support;
  support.fields = {
      real("amplitude", "m", any, std::nullopt, "A0 of the motion of the supports.")
          .as("A₀ (clamp)", "the amplitude of the support"),
      real("pulsation", "rad/s", non_negative, std::nullopt, "ω of the motion of the supports.")
          .as("ω (clamp)", "the pulsation of the support"),
      real("phase", "rad", any, 0.0, "ψ of the motion of the supports.").as("ψ (clamp)", "the phase of the support")};

  support.at_rest = "amplitude";

  ObjectForm point;
  point.fields = {
      place("at", Json(nullptr), "Where the force acts: x in m, or a place; an oscillator needs none."),
      single(formula("force", "N", "t", false, std::nullopt, "Force F(t); or a table, or a spectrum.").as("F(t)"))};
  point.fields.back().given.push_back(load_history("N"));
  point.fields.front().plain = true;
  ObjectForm spread;
  spread.fields = {
      single(formula("shape", "N/m", "x", false, std::nullopt, "f(x) of a load f(x) g(t).").as("f(x)")),
      single(formula("time", "1", "t", false, std::nullopt, "g(t); or a table, or a spectrum.").as("g(t)"))};
  spread.fields.back().given.push_back(load_history("1"));
  spread.fields.push_back(
      quiet(of_form(Field::Form::text, "body", Json(""), "Of several bodies, the one it is along.")));
  spread.fields.push_back(component_key("What it pushes along, of a beam of `planes` 2."));
  Field load = formula("load", "N/m", "xt", false, Json("0"), "Load f(x,t), or a list of forces and of shapes.")
                   .as("load", "the load");
  load.nested.emplace_back();
  load.nested.back().ways = {point, spread};

  Field seed = integer("seed", {0, 9007199254740992.0, false, false}, 0, "Of random loads: another one, other phases.")
                   .as("seed", "the seed of random loads");
  seed.axis = true;

  ObjectForm keys;
  keys.fields = {
      object("structure", std::nullopt, "The structure.", structure_form()),
      bodies(),
      object("stops", Json::object(),
             "Two rigid stops g1(x) ≤ u ≤ g2(x), or a list of stops that have names; absent: none.", stops)
          .as("stop"),
      object("support", Json{{"amplitude", 0.0}, {"pulsation", 0.0}, {"phase", 0.0}},
             "Motion of all supports together, φ(t) = A0 sin(ωt + ψ); absent: at rest.", support),
      std::move(load),
      initial_key(),
      quiet(
          objects("motions", "Motions of supports by tables, in the place of `support`.", motion_form()).as("motion")),
      quiet(word("frame", {"absolute", "supports"}, "absolute",
                 "What the initial state and the displacements shown count from, with `motions`.")),
      quiet(seed),
      points_key()};
  keys.fields[0].unless = "bodies";
  keys.fields[2].listed.push_back(named_stop());
  return keys;
}

std::vector<std::string> kind_names() {
  std::vector<std::string> names;
  for (const StudyKind* kind : study_kinds()) names.push_back(kind->name);
  return names;
}

ObjectForm study() {
  ObjectForm mesh;
  Field modes = integer("modes", {1, 100000, false, false}, std::nullopt,
                        "March the N slowest modes of the structure in the place of its dofs; null: all dofs.")
                    .as("modes", "the number of modes");
  modes.fallback = Json(nullptr);
  modes.axis = modes.nullable = modes.per_body = true;
  Field residual = word("residual", {"stops", "none"}, "stops",
                        "With `modes`: whether the static shapes of the stops stand beside them.")
                       .as("residual", "the residual of the modes");
  residual.axis = true;
  mesh.fields = {integer("elements", {1, 100000, false, false}, 1, "Number of equal elements of a beam or a bar.")
                     .as("elements", "the mesh"),
                 quiet(std::move(modes)), quiet(std::move(residual))};
  mesh.fields.front().axis = mesh.fields.front().per_body = true;

  ObjectForm chosen;
  chosen.fields = {methods("mass", Role::mass, "How velocities are discretised.").as("mass", "the mass matrix"),
                   methods("contact", Role::contact, "The contact law.").as("contact law", "the contact law"),
                   quiet(methods("friction", Role::friction, "How stops rub, where they do; absent: coulomb."))
                       .as("friction law", "the friction law"),
                   methods("time", Role::time, "The time scheme.").as("time scheme", "the time scheme")};
  chosen.fields[2].fallback = Json(nullptr);

  Field outside =
      of_form(Field::Form::scalar, "outside", Json(false), "Whether files may lie outside the study's folder.");
  outside.spec.type = ParameterSpec::Type::boolean;
  ObjectForm ask;
  ask.ways = ask_ways();
  Field required = of_form(Field::Form::scalar, "require", Json(false), "Exit code 6 where its verdict is not yes.");
  required.spec.type = ParameterSpec::Type::boolean;
  ask.fields = {quiet(optional(of_form(Field::Form::words, "stops", Json(nullptr), "Of these stops alone."))),
                quiet(optional(of_form(Field::Form::levels, "where", Json(nullptr), "Of the cases with these levels alone."))),
                quiet(std::move(required))};
  Field asks = quiet(objects("ask", "What the study wants to know, at most eight; each entry has one verb.", std::move(ask)));
  asks.at_most = 8;
  ObjectForm keys;
  keys.fields = {
      of_form(Field::Form::text, "name", std::nullopt,
              "Letters, digits, '-', '_' and '.'; results go to results/NAME."),
      of_form(Field::Form::text, "question", Json(""), "The question that the study answers."),
      of_form(Field::Form::text, "compare", Json(""),
              "What the question compares: a role, an axis that varies, or all; empty: every method."),
      std::move(asks),
      word("kind", kind_names(), std::nullopt, "What is made of each case."),
      object("scene", std::nullopt, "What is simulated, in SI units.", scene()),
      object("mesh", Json{{"elements", 1}}, "The meshes; only an oscillator does without.", mesh),
      object("methods", std::nullopt, "The methods that are combined.", chosen),
      of_form(Field::Form::excludes, "exclude", Json::array(), "Combinations left out, each with its reason."),
      quiet(std::move(outside)),
      of_form(Field::Form::files, "files", Json(nullptr),
              "Written by the program into a stored study: folder and digests of the files that its scene names.")};
  keys.discriminator = "/kind";
  for (const StudyKind* kind : study_kinds()) keys.variants.push_back({{kind->name}, {kind->keys, "", {}}});
  return keys;
}

}  // namespace

const ObjectForm& study_form() {
  static const ObjectForm form = study();
  return form;
}

Json to_json(const ParameterValue& value) {
  if (const auto* table = std::get_if<ParameterTable>(&value); table && table->empty()) return nullptr;
  return std::visit([](const auto& v) { return Json(v); }, value);
}

ParameterValue to_value(const ParameterSpec& spec, const Json& value) {
  switch (spec.type) {
    case ParameterSpec::Type::real:
      return value.get<double>();
    case ParameterSpec::Type::integer:
      return value.get<long long>();
    case ParameterSpec::Type::boolean:
      return value.get<bool>();
    case ParameterSpec::Type::table:
      return value.is_null() ? ParameterTable() : value.get<ParameterTable>();
    case ParameterSpec::Type::word:
      break;
  }
  return value.get<std::string>();
}

ObjectForm method_form(const PluginManual& manual) {
  ObjectForm keys;
  keys.fields = {word("name", {manual.name}, std::nullopt, manual.summary.c_str())};
  for (const ParameterSpec& spec : manual.parameters) {
    Field field;
    field.spec = spec;
    field.axis = true;
    field.nullable = spec.fallback == ParameterValue(ParameterTable());
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
