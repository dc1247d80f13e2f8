#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ricochet/contract/errors.hpp>
#include <ricochet/kernels/band_ldlt.hpp>
#include <ricochet/scene/block_matrices.hpp>
#include <ricochet/scene/bodies.hpp>
#include <ricochet/scene/checks.hpp>
#include <ricochet/scene/named_stops.hpp>
#include <ricochet/scene/semi_discrete.hpp>
#include <ricochet/scene/structure/assembled_structure.hpp>
#include <ricochet/scene/supports.hpp>

namespace ricochet {
namespace {

constexpr const char* one_structure = "/scene/structure";

bool all_alike(const std::vector<Body>& bodies) {
  const Damping first = damping_of(bodies.front().structure);
  return !first.matrix && first.ratios.empty() && std::all_of(bodies.begin(), bodies.end(), [&](const Body& body) {
    return damping_of(body.structure) == first;
  });
}

// Whether K of a body is positive definite.
bool is_held(const Body& body, const SemiDiscrete& problem) {
  const auto* oscillator = std::get_if<OscillatorSpec>(&body.structure);
  return oscillator ? oscillator->stiffness > 0 : problem.held;
}

// What the dofs of a body without given matrices are called, and along what they move.
void name_dofs(const JoinedBody& body, const SemiDiscrete& problem, AssembledStructure& out) {
  const bool bar = std::holds_alternative<BarSpec>(body.alone.structure);
  for (const DofPlace& place : dof_places(problem.space)) {
    DofName name;
    name.dof = static_cast<int>(out.names.size()) + 1;
    name.node = fmt::format("{} at {:.6g} m", body.name, place.x);
    name.component = place.slope ? "rz" : bar ? "ux" : "uy";
    name.place[0] = place.x;
    out.names.push_back(std::move(name));
    out.dofs_known.direction.push_back(place.slope ? 3 : bar ? 0 : 1);
  }
}

void name_dofs(const AssembledStructure& given, const JoinedBody& body, AssembledStructure& out) {
  for (DofName name : given.names) {
    name.dof = static_cast<int>(out.names.size()) + 1;
    name.node = body.name + " " + name.node;
    out.names.push_back(std::move(name));
  }
  const std::vector<int>& direction = given.dofs_known.direction;
  for (int i = 0; i < given.dofs(); ++i)
    out.dofs_known.direction.push_back(direction.empty() ? -1 : direction[static_cast<std::size_t>(i)]);
}

// A support that holds a beam in two planes is one along y, "plate", and one along z, "plate.uz".
void add_supports(const SemiDiscrete& problem, JoinedBody& body, JoinedBodies& joined, AssembledStructure& out) {
  const auto* beam = std::get_if<BeamSpec>(&body.alone.structure);
  for (std::size_t j = 0; j < problem.supports.size(); ++j) {
    const bool across = beam && beam->planes == 2 && j >= problem.supports.size() / 2;
    const std::string name = problem.supports[j] + (across ? ".uz" : "");
    if (const std::size_t next = out.supports.size();
        across && std::find(out.supports.begin(), out.supports.end(), name) == out.supports.end())
      joined.supports_across.push_back(next);
    const auto found = std::find(out.supports.begin(), out.supports.end(), name);
    body.supports.push_back(static_cast<int>(found - out.supports.begin()));
    if (found == out.supports.end()) out.supports.push_back(name);
  }
}

}  // namespace

bool has_mesh(const StructureSpec& structure) {
  return std::holds_alternative<BeamSpec>(structure) || std::holds_alternative<BarSpec>(structure);
}

int Bodies::elements_of(std::size_t body, int mesh) const {
  if (!has_mesh(all[body].structure)) return 1;
  const double share = static_cast<double>(all[body].elements) * mesh / elements;
  return std::max(1, static_cast<int>(std::lround(share)));
}

void in_body(const std::string& name, const std::function<void()>& make) {
  try {
    make();
  } catch (const InputError& error) {
    const std::string pointer = error.pointer();
    if (!pointer.starts_with(one_structure)) throw;
    throw InputError("/scene/bodies/" + name + pointer.substr(std::string(one_structure).size()), error.what());
  }
}

const JoinedBody& JoinedBodies::of(const Place& place, const std::string& pointer) const {
  std::vector<std::string> names;
  for (const JoinedBody& body : all) {
    if (body.name == place.body) return body;
    names.push_back(body.name);
  }
  const std::string known = fmt::format("{}", fmt::join(names, ", "));
  if (place.body.empty()) throw InputError(pointer, "does not say the body; expected \"body\": one of " + known);
  const std::string nearest = nearest_name(place.body, names);
  throw InputError(pointer + "/body",
                   fmt::format("no body \"{}\"{}", shortened(place.body),
                               nearest.empty() ? "; expected one of " + known : "; nearest " + nearest));
}

PlaceRow JoinedBodies::row(const Place& place, const std::string& pointer, const RowOfBody& make) const {
  const JoinedBody& body = of(place, pointer);
  Place own = place;
  own.body.clear();
  PlaceRow row = make(body.alone, body.space, own);
  for (auto& [dof, value] : row.free) dof += body.first;
  for (auto& [support, weight] : row.held) support = body.supports[static_cast<std::size_t>(support)];
  return row;
}

PlaceRow JoinedBodies::row(const Place& place, const std::string& pointer) const {
  return row(place, pointer, [&](const SceneSpec& alone, const FiniteElementSpace& space, const Place& own) {
    // An oscillator has one place.
    const bool anywhere = std::holds_alternative<OscillatorSpec>(alone.structure) && own == Place{};
    Place whole = own;
    if (anywhere) whole.x = 0;
    return place_row(alone, space, whole, pointer);
  });
}

std::shared_ptr<const AssembledStructure> join_bodies(const Bodies& bodies, int mesh) {
  auto out = std::make_shared<AssembledStructure>();
  auto joined = std::make_shared<JoinedBodies>();
  joined->mesh = mesh;
  out->stiffness_name = "K of the bodies";
  out->mass_name = "M of the bodies";
  out->table_name = "the structure";
  std::vector<SemiDiscrete> problems;
  MatrixEntries stiffness, mass;
  int dofs = 0;
  for (std::size_t b = 0; b < bodies.all.size(); ++b) {
    const Body& one = bodies.all[b];
    JoinedBody& body = joined->all.emplace_back();
    body.name = one.name;
    body.alone.structure = one.structure;
    body.elements = bodies.elements_of(b, mesh);
    in_body(one.name, [&] {
      check_structure_alone(body.alone, body.elements);
      SemiDiscrete& problem = problems.emplace_back(structure_alone(one.structure, body.elements));
      body.space = problem.space;
    });
    const SemiDiscrete& problem = problems.back();
    body.first = dofs;
    dofs += body.dofs();
    const std::vector<int> own_dofs = numbered_from(body.first, body.dofs());
    add_block(problem.stiffness, own_dofs, own_dofs, stiffness);
    const SparseMatrix own = consistent_mass(problem.space);
    add_block(own, own_dofs, own_dofs, mass);
    out->half_width = std::max({out->half_width, half_bandwidth(problem.stiffness), half_bandwidth(own)});
    body.held = is_held(one, problem);
    out->definite = out->definite && body.held;
    if (const auto* given = std::get_if<AssembledSpec>(&one.structure)) {
      name_dofs(*given->structure, body, *out);
      out->held_dofs += given->structure->held_dofs;
    } else {
      name_dofs(body, problem, *out);
    }
    for (const std::string& note : problem.notes) out->notes.push_back("body " + one.name + ": " + note);
    add_supports(problem, body, *joined, *out);
  }
  out->stiffness = sparse_matrix(dofs, dofs, stiffness);
  out->mass = sparse_matrix(dofs, dofs, mass);
  const auto supports = static_cast<Eigen::Index>(out->supports.size());
  out->static_modes = out->support_loads = Eigen::MatrixXd::Zero(dofs, supports);
  for (std::size_t b = 0; b < problems.size(); ++b) {
    const JoinedBody& body = joined->all[b];
    for (std::size_t j = 0; j < body.supports.size(); ++j) {
      const auto from = static_cast<Eigen::Index>(j);
      out->static_modes.col(body.supports[j]).segment(body.first, body.dofs()) += problems[b].static_modes.col(from);
      out->support_loads.col(body.supports[j]).segment(body.first, body.dofs()) += problems[b].support_loads.col(from);
    }
  }
  for (int i = 0; i < dofs; ++i) out->where.push_back({.free = i, .support = -1});
  // C is made with the mass that is marched; that it is no αK + ηM is known before.
  if (!all_alike(bodies.all)) out->damping.resize(dofs, dofs);
  out->joined = std::move(joined);
  return out;
}

namespace {

const JoinedBody& body_of(const JoinedBodies& bodies, const InitialSpec& initial) {
  Place place;
  place.body = initial.body;
  return bodies.of(place, "/scene/initial");
}

// A body by itself, from an initial state of its own.
SceneSpec beginning(const JoinedBody& body, const InitialSpec& initial) {
  SceneSpec alone = body.alone;
  alone.initial = initial;
  return alone;
}

}  // namespace

void begin_bodies(const JoinedBodies& bodies, const InitialSpec& initial, SemiDiscrete& problem) {
  for (const InitialSpec& one : initial.of_bodies) {
    const JoinedBody& body = body_of(bodies, one);
    const SceneSpec alone = beginning(body, one);
    SemiDiscrete begun;
    begun.space = body.space;
    interpolate_initial(alone, begun);
    problem.position.segment(body.first, body.dofs()) = begun.position;
    problem.velocity.segment(body.first, body.dofs()) = begun.velocity;
    for (const std::string& note : begun.notes) problem.notes.push_back("body " + body.name + ": " + note);
  }
}

namespace {

// That a structure by itself can begin so.
void check_initial_alone(const SceneSpec& alone, const JoinedBody& body) {
  const InitialSpec& initial = alone.initial;
  if (const auto* given = std::get_if<AssembledSpec>(&alone.structure))
    return check_given_initial(*given->structure, initial,
                               "body " + body.name + " has no x; expected 0, or the file of an initial state");
  if (!initial.dofs.empty())
    throw InputError("/scene/initial/file", fmt::format("the {} begins as formulas in x say; expected displacement and "
                                                        "velocity",
                                                        body.space.structure));
  const auto* beam = std::get_if<BeamSpec>(&alone.structure);
  for (const auto& [formula, key] :
       {std::pair(&initial.displacement_z, "displacement_z"), {&initial.velocity_z, "velocity_z"}})
    if (!formula->is_zero() && !(beam && beam->planes == 2))
      throw InputError(std::string("/scene/initial/") + key, "only a beam of planes 2 moves along uz; expected 0");
  std::vector<double> nodes = mesh_nodes(alone, body.elements);
  if (nodes.empty()) nodes = {0};
  for (const double x : nodes)
    for (const Formula* formula :
         {&initial.displacement, &initial.velocity, &initial.displacement_z, &initial.velocity_z})
      (*formula)(x);
}

}  // namespace

void check_initial_of_bodies(const JoinedBodies& bodies, const InitialSpec& initial) {
  for (const InitialSpec& one : initial.of_bodies) {
    const JoinedBody& body = body_of(bodies, one);
    const SceneSpec alone = beginning(body, one);
    try {
      check_initial_alone(alone, body);
    } catch (const InputError& error) {
      const std::string whole = "/scene/initial";
      throw InputError(whole + "/" + body.name + error.pointer().substr(whole.size()), error.what());
    }
  }
}

const JoinedBodies* bodies_of(const StructureSpec& structure) {
  const auto* spec = std::get_if<AssembledSpec>(&structure);
  return spec && spec->structure ? spec->structure->joined.get() : nullptr;
}

SceneSpec on_mesh(SceneSpec scene, int mesh) {
  auto* spec = std::get_if<AssembledSpec>(&scene.structure);
  if (!spec || !spec->bodies) return scene;
  if (spec->structure && spec->structure->joined->mesh == mesh) return scene;
  spec->structure = join_bodies(*spec->bodies, mesh);
  spec->damping = all_alike(spec->bodies->all) ? damping_of(spec->bodies->all.front().structure) : Damping{};
  return scene;
}

}  // namespace ricochet
