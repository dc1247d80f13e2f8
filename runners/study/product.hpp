#pragma once
#include <cstddef>
#include <filesystem>
#include <optional>
#include <ricochet/contract/errors.hpp>
#include <ricochet/loader/catalogue.hpp>
#include <ricochet/scene/scene.hpp>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "runners/study/study.hpp"

namespace ricochet {

/// The most combinations that one study may make.
inline constexpr std::size_t largest_study = 200000;

/// The index tuples of a cross product, the last factor running fastest. No factors: one empty tuple.
class Product {
 public:
  void add(std::size_t size) {
    sizes_.push_back(size);
    index_.push_back(0);
    ended_ = ended_ || size == 0;
  }
  /// Number of tuples, as a real number so that nothing overflows.
  double count() const {
    double count = 1;
    for (const std::size_t size : sizes_) count *= static_cast<double>(size);
    return count;
  }
  /// Throws InputError when there are more than `limit` tuples.
  void refuse_above(std::size_t limit, const std::string& pointer) const;

  bool ended() const { return ended_; }
  std::size_t operator[](std::size_t factor) const { return index_[factor]; }
  void next() {
    for (std::size_t i = sizes_.size(); i-- > 0;) {
      if (++index_[i] < sizes_[i]) return;
      index_[i] = 0;
    }
    ended_ = true;
  }

 private:
  std::vector<std::size_t> sizes_, index_;
  bool ended_ = false;
};

/// Gives cases their ids: 10 hex digits of FNV-1a (64 bits, finalised) over a canonical text, keys sorted and numbers
/// in shortest form. The text holds what determines the case: kind, axes, scene, duration, samples, settings of the
/// kind. The order of keys and of cases has no part in it. Two different cases whose digits coincide are told apart by
/// hashing the later one again.
class CaseIds {
 public:
  std::string next(const StudyCase& study_case, const std::string& kind);

 private:
  std::unordered_map<std::string, std::string> canonical_;  // id → text
};

/// Marks the cases that `exclude` names: a list of objects {axis: value or list of values, …, "why": reason}. A case is
/// left out when every axis named has (one of) the value(s) given. Throws InputError for an unknown axis, a value that
/// no case has, a combination that matches nothing, a missing reason, and when nothing remains.
void apply_excludes(const Json& excludes, Study& study);

/// A study names a method that no plugin provides. Where another name is near it is a slip of the study's writer, else
/// a plugin is missing (exit code 4).
class MissingMethod : public InputError {
 public:
  MissingMethod(std::string pointer, const std::string& message, bool near)
      : InputError(std::move(pointer), message), near_(near) {}
  bool near() const { return near_; }

 private:
  bool near_;
};

/// One method of one role, every list of parameters expanded.
struct MethodOption {
  MethodChoice choice;
  std::vector<std::pair<std::string, Json>> axes;  ///< "time": name, then "time.beta": value, …, in the plugin's order
  std::vector<std::string> places;                 ///< JSON pointers that chose it: the entry, then list elements
  bool starts_beyond = false;                      ///< of a contact law: whether it pushes back what lies beyond a stop
};

struct MethodOptions {
  std::vector<MethodOption> options;  ///< in the study's order
  Json resolved;                      ///< a list of complete objects
};

/// Reads the methods of a role: a name, an object {name, parameters…}, or a list of either. Opens the libraries named,
/// and only these. Throws MissingMethod for an unknown name, InputError for an unknown parameter or value. Throws
/// PluginError when the library that provides the name fails, or the only file meant to provide it cannot serve. Also
/// when the name is near no other, and files were found that tell nothing of themselves. A scheme that the study states
/// itself (plan_file.hpp) is read relative to `folder`; its resolved object holds the plan.
MethodOptions read_methods(Role role, const Json& value, const std::string& pointer, Catalogue& catalogue,
                           Registry& registry, const std::filesystem::path& folder = {});

/// The bases of modes that a study marches in, out of its `mesh`: mesh.modes times mesh.residual. One is empty where
/// all dofs march. `modal`: whether the structure is described by modes, whose residual may be left out alone. Throws
/// InputError at /mesh/residual for a residual of no modes.
std::vector<std::optional<BasisSpec>> bases_of(const Json& mesh, const Json& scene, bool modal);

/// Throws InputError at /mesh/modes for more modes than the structure has dofs on one of the meshes.
void check_bases(const std::vector<std::optional<BasisSpec>>& bases, const Json& mesh, const StructureSpec& structure,
                 int coarsest);

/// Throws InputError at /scene/structure for matrices of more than 20 000 dofs, with the time of a step that the cost
/// model predicts.
void check_size(const StructureSpec& structure);

}  // namespace ricochet
