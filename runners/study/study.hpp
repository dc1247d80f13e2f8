#pragma once
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <ricochet/contract/registry.hpp>
#include <ricochet/scene/scene.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "runners/json/json_text.hpp"
#include "runners/table/table.hpp"

namespace ricochet {

class StudyFiles;

/// A method as a case names it, parameters checked and complete.
struct MethodChoice {
  std::string name;
  Parameters parameters;
  std::shared_ptr<const std::string> plan = {};  ///< that states it; null where a library provides it
};

/// How the id of a case begins that a reference solves; those of the axes are hexadecimal.
inline constexpr const char* reference_id = "reference";

/// One combination of the study: everything that one run needs.
struct StudyCase {
  std::string id;  ///< stable across re-orderings: hash of the axes, 10 hex digits
  /// Every axis as a column, in the study's order: mass, mass.velocity, contact, contact.stiffness, time, time.beta,
  /// elements, step, and values of the scene given as lists. The latter go by their JSON pointers without "/scene/" and
  /// '/' → '.'.
  std::vector<std::pair<std::string, Json>> axes;
  SceneSpec scene;
  Json scene_json;  ///< the scene of this case, scalars only
  MethodChoice mass, contact, time;
  MethodChoice friction = {};  ///< without a name where no stop rubs
  int elements = 0;
  double step = 0;           ///< s; 0 for kinds that choose their steps themselves
  int steps_per_period = 0;  ///< of kinds that step by the forcing period, else 0
  double duration = 0;
  int samples = 0;
  std::string march = "every-step";      ///< auto, every-step, flights
  std::vector<MethodChoice> references;  ///< of kinds that compare, in the study's order
  bool of_reference = false;             ///< solved by its one reference; its methods and its mesh have no part in it
  Json settings;  ///< the further keys of the kind, complete; null where it has none or all are at rest
  /// Whether its contact law pushes back what lies beyond a stop: then the scene may begin there.
  bool starts_beyond = false;
  std::shared_ptr<StudyFiles> files = {};  ///< that its scene may name
  std::optional<std::string> excluded;     ///< the reason given in `exclude`
  /// Method parameters that the settings go through: JSON pointer, and how the plugin declares it.
  std::vector<std::pair<std::string, ParameterSpec>> swept;
};

/// The roles of methods that a study crosses, in the order of its axes.
inline constexpr std::array marched_roles = {Role::mass, Role::contact, Role::friction, Role::time};
/// The method of a case by such a role.
MethodChoice& method_of(StudyCase& study_case, Role role);
/// The methods that a case marches, by role.
std::vector<std::pair<Role, const MethodChoice*>> methods_of(const StudyCase& study_case);

/// The column of mesh.residual, whose own name is that of a column of the energy ledger.
inline constexpr const char* residual_axis = "mode_residual";
/// The axis whose levels are draws of one random load: they widen intervals and are no methods.
inline constexpr const char* seed_axis = "seed";

struct Study {
  std::string name, question, kind;
  Json resolved;                     ///< the study with every default written out
  std::vector<std::string> columns;  ///< axis columns over all cases, in order
  std::vector<Column> axes;          ///< what these mean
  /// What sentences call its methods, by role and name ("contact signorini"); those whose name says it are left out.
  std::map<std::string, std::string> method_words = {};
  std::vector<StudyCase> cases;
};

/// The case of this id; null where there is none.
const StudyCase* find_case(const Study& study, const std::string& id);

/// One of the parts into which the cases of a study are dealt, each for a run of its own. 0 of 0: all of the study.
struct StudyPart {
  int number = 0, of = 0;

  bool whole() const { return of == 0; }
  /// "part 3 of 64", "the whole study".
  std::string text() const;
  bool operator==(const StudyPart&) const = default;
};

/// Reads "3/64"; nothing where the text is not K/N with 1 ≤ K ≤ N.
std::optional<StudyPart> part_from(std::string_view text);

}  // namespace ricochet
