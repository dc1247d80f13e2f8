#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ricochet/contract/errors.hpp>
#include <ricochet/scene/assembly.hpp>
#include <ricochet/scene/bodies.hpp>
#include <ricochet/scene/checks.hpp>
#include <ricochet/scene/planes.hpp>
#include <ricochet/scene/scene.hpp>
#include <ricochet/scene/semi_discrete.hpp>
#include <ricochet/scene/structure/assembled_structure.hpp>

namespace ricochet {
namespace {

constexpr double pi = std::numbers::pi;

/// Second moment of area I (m⁴) and area S (m²).
struct Moments {
  double inertia = 0, area = 0;
};

Moments disc(double diameter) {
  const double square = diameter * diameter;
  return {pi * square * square / 64, pi * square / 4};
}

Moments tube(const Section& section) {
  require_positive(section.outer_diameter, "section/outer_diameter", "the outer diameter", "m");
  require_positive(section.wall, "section/wall", "the wall", "m");
  if (section.wall > section.outer_diameter / 2)
    throw InputError(
        "/scene/structure/section/wall",
        fmt::format("the wall, {:.6g} m, is thicker than the radius, {:.6g} m; expected at most the radius",
                    section.wall, section.outer_diameter / 2));
  const Moments outer = disc(section.outer_diameter), inner = disc(section.outer_diameter - 2 * section.wall);
  return {outer.inertia - inner.inertia, outer.area - inner.area};
}

Moments circle(const Section& section) {
  require_positive(section.diameter, "section/diameter", "the diameter", "m");
  return disc(section.diameter);
}

Moments rectangle(const Section& section) {
  require_positive(section.width, "section/width", "the width", "m");
  require_positive(section.height, "section/height", "the height", "m");
  return {section.width * std::pow(section.height, 3) / 12, section.width * section.height};
}

}  // namespace

double shear_factor(const Section& section, double poisson) {
  if (section.type == Section::Type::rectangle) return 10 * (1 + poisson) / (12 + 11 * poisson);
  if (section.type == Section::Type::circle) return 6 * (1 + poisson) / (7 + 6 * poisson);
  const double inner = 1 - 2 * section.wall / section.outer_diameter, square = inner * inner,
               thick = (1 + square) * (1 + square);
  return 6 * (1 + poisson) * thick / ((7 + 6 * poisson) * thick + (20 + 12 * poisson) * square);
}

SectionProperties section_properties(const Section& section, double young, double density) {
  if (section.type == Section::Type::given) {
    require_positive(section.EI, "section/EI", "the bending stiffness EI", "N m²");
    require_positive(section.rhoS, "section/rhoS", "the line density ρS", "kg/m");
    return {section.EI, section.rhoS, 0, 0};
  }
  require_positive(young, "young", "Young's modulus", "Pa");
  require_positive(density, "density", "the density", "kg/m³");
  const Moments moments = section.type == Section::Type::tube     ? tube(section)
                          : section.type == Section::Type::circle ? circle(section)
                                                                  : rectangle(section);
  return {young * moments.inertia, density * moments.area, moments.inertia, moments.area};
}

namespace {

bool is_zero(const LoadTerm& term) {
  return term.history.is_zero() || (!term.force && term.shape.is_zero());
}

}  // namespace

bool LoadSpec::is_zero() const {
  return formula.is_zero() &&
         std::all_of(terms.begin(), terms.end(), [](const LoadTerm& term) { return ricochet::is_zero(term); });
}

namespace {

Damping damping(const OscillatorSpec& oscillator) {
  return {.mass = oscillator.damping / oscillator.mass};
}
Damping damping(const AssembledSpec& spec) {
  Damping out = spec.damping;
  if (spec.structure->damping.rows() > 0) out.matrix = {spec.structure, &spec.structure->damping};
  return out;
}
template <class Spec>
Damping damping(const Spec& spec) {
  return spec.damping;
}

}  // namespace

Damping damping_of(const StructureSpec& structure) {
  return std::visit([](const auto& spec) { return damping(spec); }, structure);
}

double Damping::rate(double square, std::size_t k) const {
  return by_modes() ? 2 * ratio(k) * std::sqrt(square) : stiffness * square + mass;
}

bool moves_by_histories(const SceneSpec& scene) {
  return !scene.motions.empty() || std::any_of(scene.stops.named.begin(), scene.stops.named.end(),
                                               [](const NamedStop& stop) { return stop.motion != nullptr; });
}

std::vector<GivenMotion> given_motions(const SceneSpec& scene) {
  std::vector<GivenMotion> out;
  const auto key = [](const MotionSpec& motion) {
    return motion.gives == MotionSpec::Gives::acceleration ? "/acceleration" : "/displacement";
  };
  for (std::size_t i = 0; i < scene.motions.size(); ++i)
    out.push_back({&scene.motions[i], fmt::format("/scene/motions/{}{}", i, key(scene.motions[i])), "a motion"});
  for (std::size_t i = 0; i < scene.stops.named.size(); ++i) {
    const NamedStop& stop = scene.stops.named[i];
    if (i > 0 && scene.stops.named[i - 1].entry == stop.entry) continue;  // another side of a clearance
    const std::string pointer = fmt::format("/scene/stops/{}", stop.entry);
    if (stop.motion)
      out.push_back(
          {stop.motion.get(), pointer + "/moves_with" + key(*stop.motion), "the motion of the stop " + stop.name});
    for (const auto* tangent : {&stop.tangent, &stop.across})
      if (*tangent && (*tangent)->motion)
        out.push_back({(*tangent)->motion.get(),
                       fmt::format("{}/tangent{}/speed", pointer,
                                   !stop.across               ? ""
                                   : tangent == &stop.tangent ? "/0"
                                                              : "/1"),
                       "the surface of the stop " + stop.name});
  }
  return out;
}

bool LoadSpec::uses_t() const {
  return formula.uses_t() || std::any_of(terms.begin(), terms.end(), [](const LoadTerm& term) {
           return !ricochet::is_zero(term) && term.history.uses_t();
         });
}

bool LoadSpec::has_point_forces() const {
  return std::any_of(terms.begin(), terms.end(), [](const LoadTerm& term) { return term.at || term.place; });
}

double LoadSpec::spread(double x, double t) const {
  double sum = formula(x, t);
  for (const LoadTerm& term : terms) sum += (term.force ? 1.0 : term.shape(x)) * term.history(0, t);
  return sum;
}

namespace {

// A shape along one of several bodies.
void add_on_body(const AssembledStructure& structure, const LoadTerm& term, Eigen::VectorXd& out) {
  const JoinedBody& body = structure.joined->of(*term.place, "/scene/load");
  const DistributedLoad own(LoadSpec(term.shape), body.space);
  Eigen::VectorXd shape = Eigen::VectorXd::Zero(body.dofs());
  own.assemble(0, shape.data());
  out.segment(body.first, body.dofs()) += shape;
}

// A term along a component or a direction, made of the same term of each plane.
Eigen::VectorXd plane_load(LoadTerm term, const FiniteElementSpace& space) {
  const std::array<double, 2> shares = plane_shares(term.towards, !space.across.empty(), "/scene/load");
  term.towards = {};
  LoadSpec alone;
  alone.terms.push_back(std::move(term));
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(space.dofs);
  for (const int plane : {0, 1})
    if (const double share = shares[static_cast<std::size_t>(plane)]; share != 0)
      sum += share * DistributedLoad(alone, plane_elements(space, plane)).shape(0);
  return sum;
}

}  // namespace

DistributedLoad::DistributedLoad(const LoadSpec& load, const FiniteElementSpace& space,
                                 const AssembledStructure* assembled)
    : formula_(load.formula), size_(space.dofs) {
  if (load.is_zero()) return;
  const auto& gauss = gauss_points();
  for (const auto& element : space.elements) {
    dofs_.push_back(element.dof);
    auto& weights = weights_.emplace_back();
    for (std::size_t g = 0; g < gauss.size(); ++g) {
      points_.push_back(element.left + gauss[g].xi * element.length);
      const auto phi = shape_values(space.basis, element, gauss[g].xi);
      for (std::size_t a = 0; a < 4; ++a) weights[4 * g + a] = gauss[g].weight * element.length * phi[a];
    }
  }
  if (space.elements.empty()) points_.push_back(0);
  values_.resize(points_.size());
  for (const LoadTerm& term : load.terms) {
    if (is_zero(term)) continue;
    Term& one = terms_.emplace_back();
    one.shape = Eigen::VectorXd::Zero(size_);
    one.history = term.history;
    terms_vary_ = terms_vary_ || term.history.uses_t();
    if (assembled && term.place && !term.force)
      add_on_body(*assembled, term, one.shape);
    else if (assembled && term.place)
      for (const auto& [dof, value] : assembled->row(*term.place, "/scene/load").free) one.shape[dof] = value;
    else if (term.towards != Place{})
      one.shape = plane_load(term, space);
    else if (term.force)
      for (const auto& [dof, value] : displacement_row(space, term.at.value_or(0))) one.shape[dof] = value;
    else
      integrate(term.shape, 0, one.shape.data());
  }
}

void DistributedLoad::add(Eigen::VectorXd shape, Formula history) {
  terms_vary_ = terms_vary_ || history.uses_t();
  terms_.push_back({std::move(shape), std::move(history)});
}

void DistributedLoad::integrate(const Formula& load, double t, double* out) const {
  load.evaluate(points_, t, values_);
  if (dofs_.empty()) out[0] = values_[0];
  for (std::size_t e = 0; e < dofs_.size(); ++e) {
    for (std::size_t a = 0; a < 4; ++a) {
      const int dof = dofs_[e][a];
      if (dof < 0) continue;
      for (std::size_t g = 0; g < 4; ++g) out[dof] += weights_[e][4 * g + a] * values_[4 * e + g];
    }
  }
}

void DistributedLoad::project(std::shared_ptr<const Eigen::MatrixXd> basis) {
  basis_ = std::move(basis);
  nodal_.resize(size_);
  for (Term& term : terms_) term.shape = basis_->transpose() * term.shape;
}

void DistributedLoad::assemble_formula(double t, double* out) const {
  Eigen::Map<Eigen::VectorXd> result(out, unknowns());
  result.setZero();
  if (!has_formula()) return;
  if (!basis_) return integrate(formula_, t, out);
  nodal_.setZero();
  integrate(formula_, t, nodal_.data());
  result.noalias() = basis_->transpose() * nodal_;
}

bool DistributedLoad::assemble_steady(double* out) const {
  Eigen::Map<Eigen::VectorXd> result(out, unknowns());
  const bool formula = has_formula() && !formula_.uses_t();
  if (formula)
    assemble_formula(0, out);
  else
    result.setZero();
  bool any = formula;
  for (const Term& term : terms_) {
    if (term.history.uses_t()) continue;
    result += term.history.value(0, 0) * term.shape;
    any = true;
  }
  return any && !result.isZero(0);
}

LoadWork DistributedLoad::work() const {
  LoadWork work;
  const auto add = [&](const Formula& one, double times, double numbers) {
    work.evaluations += one.uses_t() ? times : 0;
    work.operations += times * one.operations();
    work.numbers += numbers;
  };
  for (const Term& term : terms_) add(term.history, 1, unknowns());
  if (!has_formula()) return work;
  const auto places = static_cast<double>(points_.size());
  add(formula_, formula_.uses_x() ? places : 1, 4 * places);
  if (basis_) work.numbers += static_cast<double>(size_) * unknowns();
  return work;
}

void DistributedLoad::assemble(double t, double* out) const {
  assemble_formula(t, out);
  for (int k = 0; k < terms(); ++k) Eigen::Map<Eigen::VectorXd>(out, unknowns()) += scale(k, t) * shape(k);
}

}  // namespace ricochet
