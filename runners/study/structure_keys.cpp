#include "runners/study/fields.hpp"
#include "runners/study/scene_keys.hpp"

namespace ricochet {
namespace {

using namespace keys;

ObjectForm section() {
  ObjectForm keys;
  keys.fields = {word("type", {"tube", "circle", "rectangle", "given"}, std::nullopt, "Shape of the cross-section.")
                     .as("section", "the cross-section")};
  keys.discriminator = "/type";
  keys.variants = {
      {{"tube"},
       {{real("outer_diameter", "m", positive, std::nullopt, "Outer diameter D; I = π(D⁴ − d⁴)/64 with d = D − 2·wall.")
             .as("D", "the outer diameter"),
         real("wall", "m", positive, std::nullopt, "Wall thickness, at most half of the outer diameter.")
             .as("wall", "the wall thickness")},
        "",
        {}}},
      {{"circle"},
       {{real("diameter", "m", positive, std::nullopt, "Diameter D; I = πD⁴/64.").as("D", "the diameter")}, "", {}}},
      {{"rectangle"},
       {{real("width", "m", positive, std::nullopt, "Width b, along the axis of bending; I = b h³/12.")
             .as("b", "the width"),
         real("height", "m", positive, std::nullopt, "Height h, across which the section bends.")
             .as("height", "the height")},
        "",
        {}}},
      {{"given"},
       {{real("EI", "N m²", positive, std::nullopt, "Bending stiffness.").as("EI", "the bending stiffness EI"),
         real("rhoS", "kg/m", positive, std::nullopt, "Mass per length.").as("ρS", "the mass per length ρS"),
         EI_z_key()},
        "",
        {}}},
  };
  return keys;
}

ObjectForm with_file(ObjectForm damping) {
  damping.fields.push_back(
      quiet(of_form(Field::Form::text, "file", Json(""), "C, Matrix Market, all dofs of the table, alone.").as("C")));
  return damping;
}

ObjectForm assembled(const ObjectForm& damping) {
  const auto file = [](const char* key, const char* text) {
    return of_form(Field::Form::text, key, std::nullopt, text);
  };
  ObjectForm keys;
  keys.fields = {
      of_form(Field::Form::text, "folder", Json(""), "Folder of the files, in that of the study.")
          .as("folder", "the files of the structure"),
      file("stiffness", "K, Matrix Market, all dofs of the table.").as("K"),
      file("mass", "M, Matrix Market, all dofs of the table.").as("M"),
      file("dofs", "CSV with the columns dof,node,component,x,y,z,held."),
      quiet(
          of_form(Field::Form::named, "influence", Json::object(),
                  "Supports whose dofs the matrices have lost, each with its CSV dof,value: how the dofs follow it.")),
      single(real("length_unit", "m", positive, 1.0, "Unit of length of the files; 0.001: mm, t, s.")
                 .as("unit of length", "the unit of length")),
      object("damping", Json::object(), "Viscous damping C = αK + ηM, ratios, or C itself.", with_file(damping)),
      place("tip", Json(nullptr), "Displacement that is shown; null: the first stop's, else the first load's.")};
  keys.fields.front().axis = true;
  return keys;
}

ObjectForm modal() {
  const auto file = [](const char* key, std::optional<Json> fallback, const char* text) {
    return of_form(Field::Form::text, key, std::move(fallback), text);
  };
  ObjectForm keys;
  keys.fields = {
      file("folder", Json(""), "Folder of the files, in that of the study."),
      file("modes", std::nullopt, "CSV with the columns mode, frequency (Hz), mass (kg), damping (ratio)."),
      file("shapes", std::nullopt, "CSV: point, then a column for each mode by its number."),
      file("residual", Json(""), "CSV: point, then these points: residual flexibility of stops, m/N."),
      file("residual_mass", Json(""), "CSV, points as in `residual`: inertia of its static shapes, kg."),
      file("static_modes", Json(""), "CSV: point, then supports: displacement while one moves by 1."),
      place("tip", Json(nullptr), "Displacement that is shown; null: the first stop's, else the first load's.")};
  keys.fields.front().axis = true;
  return keys;
}

ObjectForm beam_support() {
  ObjectForm keys;
  keys.fields = {
      of_form(Field::Form::text, "name", std::nullopt, "Its name, for motions and tables."),
      real("x", "m", non_negative, std::nullopt, "Where it holds the beam, 0 to L.").as("at", "the place of a support"),
      word("type", {"clamped", "pinned", "sliding", "elastic"}, std::nullopt,
           "What it holds: w and w', w, w', or the ground end of springs.")
          .as(""),
      components_of_support()};
  keys.discriminator = "/type";
  keys.variants = {
      {{"clamped", "pinned", "sliding"}, {}},
      {{"elastic"},
       {{real("stiffness", "N/m", non_negative, 0.0, "Spring against w.").as("stiffness", "the stiffness of a support"),
         real("rotation", "N m/rad", non_negative, 0.0, "Spring against w'.")
             .as("rotation", "the stiffness of a support against rotation")},
        "",
        {}}}};
  return keys;
}

ObjectForm beam_part() {
  ObjectForm keys;
  keys.fields = {real("to", "m", positive, std::nullopt, "Where it ends; it begins where the one before ends.")
                     .as("to", "the end of a section"),
                 object("section", std::nullopt, "Its cross-section.", section())};
  keys.discriminator = "/section/type";
  keys.variants = {{{"tube", "circle", "rectangle"},
                    {{real("young", "Pa", positive, std::nullopt, "Young's modulus E.").as("E", "Young's modulus"),
                      real("density", "kg/m³", positive, std::nullopt, "Density ρ.").as("ρ", "the density")},
                     "",
                     {}}},
                   {{"given"}, {}}};
  return keys;
}

ObjectForm beam_mass() {
  ObjectForm keys;
  keys.fields = {real("x", "m", non_negative, std::nullopt, "Where it sits, 0 to L.").as("at", "the place of a mass"),
                 real("mass", "kg", non_negative, 0.0, "Its mass.").as("", "the point mass"),
                 real("inertia", "kg m²", non_negative, 0.0, "Its inertia against rotation.")
                     .as("inertia", "the inertia of a point mass")};
  return keys;
}

ObjectForm beam_shear() {
  ObjectForm keys;
  keys.fields = {
      real("poisson", "1", {-1, 0.5, true, false}, std::nullopt, "Poisson's ratio ν: G = E/(2(1 + ν)).")
          .as("ν", "Poisson's ratio"),
      keys::optional(real("factor", "1", positive, std::nullopt, "k of kGA; null: Cowper's, from the section and ν.")
                         .as("k of kGA", "the factor of shear")),
      of_form(Field::Form::scalar, "rotary", Json(false), "Whether cross-sections have inertia against rotation.")
          .as("rotary inertia")};
  keys.fields.back().spec.type = ParameterSpec::Type::boolean;
  return keys;
}

/// Absent in studies of a clamped beam of one section, whose text they leave as it is.
std::vector<Field> beam_extras() {
  return {
      quiet(
          objects("supports", "What holds the beam; absent: a clamp at 0. An end without one is free.", beam_support())
              .as("support")),
      quiet(objects("sections", "Sections from 0 upwards, the last one to L, in the place of `section`.", beam_part())
                .as("section")),
      quiet(real("added_mass", "kg/m", non_negative, 0.0, "Mass per length that moves with it, as of a fluid.")
                .as("added mass", "the added mass")),
      quiet(real("tension", "N", any, 0.0, "Axial force T; below 0 it compresses.").as("tension", "the tension")),
      quiet(real("foundation", "N/m²", non_negative, 0.0,
                 "Elastic foundation k_f; it moves with a harmonic support, and rests under motions.")
                .as("foundation", "the foundation")),
      quiet(objects("masses", "Point masses on the beam.", beam_mass()).as("mass")),
      quiet(object("shear", Json(nullptr), "Deformation in shear; absent: Euler–Bernoulli.", beam_shear())),
      planes_key()};
}

/// C = αK + ηM, or ratios of the modes of the matrices that are marched.
ObjectForm damping_form() {
  const Range ratio{-1, 1, true, true};
  Field ratios = of_form(Field::Form::numbers, "ratios", Json(nullptr),
                         "ζ_k of the modes, slowest elastic one first, in the place of α and η.")
                     .as("damping ratios");
  ratios.spec.range = ratio;
  ratios.spec.unit = "1";
  ratios.repeats = true;
  Field all = real("ratio", "1", ratio, std::nullopt, "ζ of every mode, in the place of α and η.")
                  .as("damping ratio", "the damping ratio");
  all.fallback = Json(nullptr);
  ObjectForm damping;
  damping.fields = {
      real("stiffness", "s", non_negative, 0.0, "α of C = αK + ηM.").as("α (damping, of K)", "the viscosity α"),
      real("mass", "1/s", non_negative, 0.0, "η of C = αK + ηM.").as("η (damping, of M)", "the damping η"),
      quiet(std::move(all)), quiet(std::move(ratios)),
      quiet(real("beyond", "1", ratio, 0.0, "ζ of the modes after those of `ratios`.")
                .as("damping ratio beyond these", "the damping ratio of the other modes"))};
  return damping;
}

}  // namespace

ObjectForm structure_form() {
  const ObjectForm damping = damping_form();
  ObjectForm beam;
  beam.fields = {
      real("length", "m", positive, std::nullopt, "Length L; clamped at x = 0, free at x = L, unless `supports` say.")
          .as("L", "the length"),
      object("section", std::nullopt, "Cross-section: EI and ρS follow from it.", section()),
      object("damping", Json::object(), "Viscous damping C = αK + ηM.", damping)};
  beam.fields[1].unless = "sections";
  for (Field& extra : beam_extras()) beam.fields.push_back(std::move(extra));
  beam.discriminator = "/section/type";
  beam.variants = {{{"tube", "circle", "rectangle"},
                    {{real("young", "Pa", positive, std::nullopt, "Young's modulus E.").as("E", "Young's modulus"),
                      real("density", "kg/m³", positive, std::nullopt, "Density ρ.").as("ρ", "the density")},
                     "",
                     {}}},
                   {{"given"}, {}}};
  ObjectForm force;
  force.fields = {
      real("amplitude", "N", any, 0.0, "F of the force F cos(ωt + ψ).").as("F", "the amplitude of the force"),
      real("pulsation", "rad/s", non_negative, 0.0, "ω of the force.").as("ω of F", "the pulsation of the force"),
      real("phase", "rad", any, 0.0, "ψ of the force.").as("ψ", "the phase of the force")};
  force.at_rest = "amplitude";
  ObjectForm oscillator;
  oscillator.fields = {real("mass", "kg", positive, std::nullopt, "Mass m.").as("m", "the mass of the oscillator"),
                       real("stiffness", "N/m", non_negative, std::nullopt, "Stiffness k; 0: a free mass.")
                           .as("k", "the stiffness of the structure"),
                       real("damping", "N s/m", non_negative, 0.0, "Damping c.").as("c", "the damping"),
                       object("force", Json::object(), "Harmonic force on the mass; absent: none.", force)};
  ObjectForm bar;
  bar.fields = {
      real("length", "m", positive, std::nullopt, "Length L.").as("L", "the length"),
      real("EA", "N", positive, std::nullopt, "Stiffness EA.").as("EA", "the axial stiffness EA"),
      real("rhoA", "kg/m", positive, std::nullopt, "Mass per length ρA.").as("ρA", "the mass per length ρA"),
      word("fixed", {"right", "left", "none"}, std::nullopt, "The end that is held; the tip is the free one, or x = 0.")
          .as("held end", "the end that is held"),
      object("damping", Json::object(), "Viscous damping C = αK + ηM.", damping)};
  ObjectForm keys;
  keys.fields = {word("type", {"beam", "oscillator", "bar", "assembled", "modal"}, std::nullopt, "What moves.").as("")};
  keys.discriminator = "/type";
  keys.variants = {{{"beam"}, beam},
                   {{"oscillator"}, oscillator},
                   {{"bar"}, bar},
                   {{"assembled"}, assembled(damping)},
                   {{"modal"}, modal()}};
  return keys;
}

}  // namespace ricochet
