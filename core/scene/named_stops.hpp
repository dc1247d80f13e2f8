#pragma once
#include <Eigen/Core>
#include <array>
#include <ricochet/contract/contact_law.hpp>
#include <ricochet/contract/mass_strategy.hpp>
#include <ricochet/scene/assembly.hpp>
#include <ricochet/scene/checks.hpp>
#include <ricochet/scene/place.hpp>
#include <ricochet/scene/scene.hpp>
#include <string>
#include <vector>

/// \file
/// Places of a structure as rows, and where its stops act.
namespace ricochet {

struct SemiDiscrete;

/// The displacement at a place, relative to the clamp that moves a beam or a bar. Throws InputError below `pointer` for
/// a place that the structure does not have.
PlaceRow place_row(const SceneSpec& scene, const FiniteElementSpace& space, const Place& place,
                   const std::string& pointer);

/// The same of what else a beam has at a place; pointers as above.
PlaceRow section_row(const SceneSpec& scene, const FiniteElementSpace& space, const Place& place, ShapeOf what,
                     const std::string& pointer);

/// Shares of u_y and u_z in what a stop of a beam bounds: (1, 0) of any other structure.
std::array<double, 2> stop_shares(const SceneSpec& scene, std::size_t stop);

/// Throws InputError at `pointer` for a name that is not 1 to 40 letters, digits, '-' or '_'.
void check_name(const std::string& name, const std::string& pointer);

/// The row of a stop: that of `at` less that of `to`. `number`: of the stop in its list, for pointers.
PlaceRow stop_row(const SceneSpec& scene, const FiniteElementSpace& space, const NamedStop& stop, std::size_t number);

/// Throws InputError for a force on a beam, the term number k of its load, along a component that the beam has not. The
/// same for one along z beyond the beam or where nothing can move. False where it acts along y alone.
bool check_force_across(const SceneSpec& scene, const FiniteElementSpace& space, std::size_t k);

/// The contact points of a scene.
struct ContactPoints {
  std::vector<double> x;            ///< m
  std::vector<std::string> names;   ///< of the stops; empty where they have none
  Eigen::VectorXd lower, upper;     ///< m; ±∞ where absent
  SparseRows rows;                  ///< H, m × n
  Eigen::MatrixXd on_supports;      ///< m × r: weights of the displacements of supports, beside H ψ
  std::vector<StopParameters> own;  ///< of each stop; empty where none has parameters of its own
  std::vector<int> circles;         ///< first rows of clearances met as circles
};
ContactPoints contact_points(const SceneSpec& scene, const FiniteElementSpace& space, int elements);

/// Where the stops of a list stand along a beam or a bar, m; 0 for places without x.
std::vector<double> named_positions(const StopsSpec& stops);

/// The row of the displacement shown to people (1 × n).
SparseRows tip_row(const SceneSpec& scene, const FiniteElementSpace& space);
/// Fills the tip of a problem whose space and static modes are known, and what supports add to it.
void show_tip(const SceneSpec& scene, SemiDiscrete& problem);
/// The same of matrices that are given, with what supports add to it by themselves.
PlaceRow given_tip(const AssembledSpec& spec, const SceneSpec& scene);

/// What the tip of matrices that are given stands for: "stop a", "load 0"; empty for any other structure, and where the
/// study says it.
std::string tip_choice(const SceneSpec& scene);

/// Throws InputError for names that are none or stand twice, and for bounds that are missing. The same for places that
/// are not there, and stops at which nothing can move. The same for a stop between two points of a structure whose
/// clamp moves. Throws BeyondStop for bounds of a stop that cross where no law pushes back.
void check_named_stops(const SceneSpec& scene, const FiniteElementSpace& space, const ForceBeyond& beyond);

/// Throws BeyondStop where the initial displacement of a beam, a bar or an oscillator is beyond a stop of the list and
/// nothing pushes back.
void check_named_start(const SceneSpec& scene, const FiniteElementSpace& space, const ForceBeyond& beyond);

/// Throws InputError for formulas: matrices that are given have no x for them (`no_x` says so and what is expected).
/// The same for a held dof that does not begin at 0, at rest.
void check_given_initial(const AssembledStructure& structure, const InitialSpec& initial, const std::string& no_x);

/// What the study may not say of matrices that are given: positions x, formulas in x, an amplitude without supports in
/// the table. Nor may a force act where nothing can move, a held dof begin elsewhere, or a state begin beyond a stop
/// where nothing pushes back.
void check_assembled(const SceneSpec& scene, const FiniteElementSpace& space, const ForceBeyond& beyond);

/// Displacements or velocities of the free dofs at t = 0 (n).
Eigen::VectorXd initial_dofs(const AssembledStructure& structure, const InitialSpec& initial, double DofState::*value);

}  // namespace ricochet
