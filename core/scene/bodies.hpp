#pragma once
#include <algorithm>
#include <functional>
#include <memory>
#include <ricochet/contract/mass_strategy.hpp>
#include <ricochet/scene/assembly.hpp>
#include <ricochet/scene/basis/modal_basis.hpp>
#include <ricochet/scene/place.hpp>
#include <ricochet/scene/scene.hpp>
#include <string>
#include <vector>

/// \file
/// Structures that meet at stops alone: each goes by itself through its builder, its basis and the mass strategy; then
/// matrices are block diagonal, q = (q_1, q_2, …), K = diag(K_1, K_2, …), and rows of stops reach over bodies.
namespace ricochet {

struct SemiDiscrete;

/// One structure of several.
struct Body {
  std::string name;
  StructureSpec structure;
  int elements = 1;  ///< of its mesh, where all bodies together have Bodies::elements
};

/// Structures that meet at stops, as a scene has them.
struct Bodies {
  std::vector<Body> all;
  int elements = 1;  ///< what a mesh of this scene is called by

  /// Elements of a body on a mesh that is called by `mesh`: the nearest whole share, at least 1; 1 where it has no
  /// mesh.
  int elements_of(std::size_t body, int mesh) const;
};

/// A body in its place among the others.
struct JoinedBody {
  std::string name;
  SceneSpec alone;                 ///< a scene of it alone, without stops
  FiniteElementSpace space;        ///< of it alone
  int elements = 1;                ///< of its mesh
  int first = 0;                   ///< its first dof
  bool held = false;               ///< whether its K is positive definite
  std::vector<int> supports = {};  ///< number of each of its supports among those of all bodies

  int dofs() const { return space.dofs; }
  bool has(int dof) const { return dof >= first && dof < first + dofs(); }
};

struct JoinedBodies {
  int mesh = 1;
  std::vector<JoinedBody> all;
  std::vector<std::size_t> supports_across = {};  ///< numbers of those that move along z

  /// Whether a support of these moves along z.
  bool across(std::size_t support) const {
    return std::find(supports_across.begin(), supports_across.end(), support) != supports_across.end();
  }

  /// The body of a place; throws InputError at `pointer` with the nearest name.
  const JoinedBody& of(const Place& place, const std::string& pointer) const;
  /// A row of one body among the dofs and supports of all.
  using RowOfBody =
      std::function<PlaceRow(const SceneSpec& alone, const FiniteElementSpace& space, const Place& place)>;
  PlaceRow row(const Place& place, const std::string& pointer, const RowOfBody& make) const;
  /// The displacement at a place.
  PlaceRow row(const Place& place, const std::string& pointer) const;
};

/// Whether a structure has a mesh of elements.
bool has_mesh(const StructureSpec& structure);

/// What `make` does for one body; pointers of an InputError into /scene/structure become those of the body.
void in_body(const std::string& name, const std::function<void()>& make);

/// The structure of bodies on a mesh; throws InputError for a body that is none.
std::shared_ptr<const AssembledStructure> join_bodies(const Bodies& bodies, int mesh);

/// The scene with its bodies on this mesh; one of a single structure as it is.
SceneSpec on_mesh(SceneSpec scene, int mesh);

/// The bodies of a scene; null where it has one structure.
const JoinedBodies* bodies_of(const StructureSpec& structure);

/// Puts how bodies begin into `position` and `velocity`, absolute; those of which nothing is said stay as they are.
void begin_bodies(const JoinedBodies& bodies, const InitialSpec& initial, SemiDiscrete& problem);
/// Throws InputError for an initial state that its body does not have, below /scene/initial/BODY.
void check_initial_of_bodies(const JoinedBodies& bodies, const InitialSpec& initial);

/// A basis of each body, joined: modes of all bodies first, then the coordinates of stops. `rows`: what efforts push.
ModalBasis join_bases(const JoinedBodies& bodies, const SemiDiscrete& problem, const SparseMatrix& mass,
                      const SparseRows& rows, const BasisSpec& spec);

/// The mass of each body by itself, joined; that of an oscillator is its own. `build`: the mass of a problem of one
/// body.
using MassOfBody = std::function<InertiaOrRefusal(const SemiDiscrete& one)>;
InertiaOrRefusal join_masses(const JoinedBodies& bodies, const SemiDiscrete& problem, const MassOfBody& build);

/// C of bodies that are not damped alike, on the unknowns of the problem: α_b K_b + η_b M_b, or by the modes of the
/// body.
SparseMatrix join_dampings(const JoinedBodies& bodies, const SemiDiscrete& problem);

}  // namespace ricochet
