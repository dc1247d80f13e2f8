#pragma once
#include <Eigen/Core>
#include <functional>
#include <ricochet/contract/contact_law.hpp>
#include <ricochet/scene/scene.hpp>
#include <string>
#include <vector>

/// \file
/// Where stops act, and whether displacements stay between them.
namespace ricochet {

/// Length of the structure, m; 0 for an oscillator.
double structure_length(const SceneSpec& scene);

/// Where the displacement shown to people is, m. A beam has it at its free end, at L before at 0; a bar at 0 before at
/// L. A beam held at both has it at the middle of its longest span.
double tip_position(const SceneSpec& scene);
/// Where the displacement shown to people stands: at the first point of the scene, else at the tip.
double shown_position(const SceneSpec& scene);

/// Whether something at x can move a beam, a bar or an oscillator there, and how a sentence says where that is.
bool on_free_part(const SceneSpec& scene, double x);
std::string free_part(const SceneSpec& scene);
/// A place of the structure whose displacement or slope is imposed, x in m; `name` for sentences ("the clamp").
struct HeldPlace {
  double x = 0;
  bool displacement = true, rotation = false;
  std::string name;
};
/// Those of a beam's supports, of a bar's fixed end.
std::vector<HeldPlace> held_places(const SceneSpec& scene);
/// Whether the displacement at x is imposed, to 1e-9 of the length.
bool displacement_held(const SceneSpec& scene, double x);

/// Positions of the nodes, from 0 to exactly L; empty without a mesh.
std::vector<double> mesh_nodes(const SceneSpec& scene, int elements);

/// Positions of the contact points: free nodes, the tip, or the positions given; empty without stops.
std::vector<double> contact_positions(const SceneSpec& scene, int elements);

/// Whether something pushes a point back that lies so far beyond its stop (m): what a contact law says of it. Empty:
/// nothing does, at any depth, as under a rigid law.
using ForceBeyond = std::function<bool(double depth)>;
/// Something does, at any depth.
inline ForceBeyond anywhere_beyond() {
  return [](double) { return true; };
}

/// That of a law with these parameters. A compliant law pushes where it stores a finite energy. Where there is no
/// contact nothing has to push. Sizes the law for one point, and is good for as long as the law is.
ForceBeyond force_beyond(ContactLaw& law, const Parameters& parameters);

/// What is wrong with stops, clamp or initial state is that they lie beyond a stop where nothing pushes them back:
/// another contact law may.
struct BeyondStop : InputError {
  using InputError::InputError;
};

/// Throws BeyondStop at `pointer` when u leaves [lower, upper] at a point (absolute displacements, m) where no law
/// pushes it back. `what` names u in the sentence, `names` the stops where they have names. A passage smaller than
/// 1e-12 of the values compared is rounding. `circles`: the first rows of clearances met as circles, whose two
/// displacements have one distance.
void check_between_stops(const std::vector<double>& x, const Eigen::VectorXd& u, const Eigen::VectorXd& lower,
                         const Eigen::VectorXd& upper, const std::string& pointer, const std::string& what,
                         const ForceBeyond& beyond = {}, const std::vector<std::string>& names = {},
                         const std::vector<int>& circles = {});

/// Throws InputError for a structure that is none, whatever acts on it, and by check_magnitudes().
void check_structure_alone(const SceneSpec& scene, int elements);

/// Throws InputError where numbers that are each in range make coefficients whose squares doubles cannot hold. Such are
/// the stiffness and the mass of an element, their ratio, damping, the motion of the support.
void check_magnitudes(const SceneSpec& scene, int elements);

/// φ and its first three derivatives at t = 0: m, m/s, m/s², m/s³.
struct SupportMotion {
  double position = 0, velocity = 0, acceleration = 0, jerk = 0;
};
SupportMotion support_at_start(const SupportSpec& support);

/// Values of g1 or g2 at the points, ∓∞ for an absent stop.
Eigen::VectorXd stop_values(const std::optional<Formula>& stop, const std::vector<double>& x, double absent);

/// Throws InputError at /scene/structure/`key` unless the value is finite and above 0; `what` names it in the sentence.
void require_positive(double value, const char* key, const char* what, const char* unit);

}  // namespace ricochet
