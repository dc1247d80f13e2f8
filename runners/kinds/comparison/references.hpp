#pragma once
#include <atomic>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <ricochet/contract/reference.hpp>
#include <ricochet/contract/registry.hpp>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "runners/march/case_context.hpp"
#include "runners/store/record.hpp"
#include "runners/study/study.hpp"

namespace ricochet {

/// A reference as cases are compared with it.
struct KnownReference {
  std::string name;
  Said refusal;              ///< why it does not apply; then nothing else is set
  bool of_the_mesh = false;  ///< it has the case's own mesh: what differs is the time scheme's error alone
  ReferenceMotion found;
};
using ReferencePointer = std::shared_ptr<const KnownReference>;

/// What one case is compared with.
struct ReferenceSet {
  std::vector<ReferencePointer> applicable;  ///< in the study's order; the first is the reference
  std::vector<Said> refusals;                ///< "NAME: sentence" of those that do not apply
  SampleGrid grid;
  double horizon = 0;       ///< s
  std::string horizon_why;  ///< what set it
};

/// The references of a comparing study. Each is computed once, by the thread that asks for it first. It is kept in the
/// checkpoint store by a hash of all that determines it.
///
/// References of the scene (closed forms, the continuous problem) see rigid stops whatever the contact law. A penalty
/// is one more numerical choice there, and its error is measured. Those of the mesh see the law itself: they leave the
/// error of the time scheme alone.
///
/// `self`: the case's own methods at h/4 and h/8, h the smallest step of the study. The mesh is the case's own, or
/// twice the finest when the study has several. It is extrapolated (Richardson) with order 1 where the motion touches a
/// stop, else the declared order. Its own gap (`coarser`) is the extrapolation's correction, or the difference of two
/// meshes or two bases of modes if larger.
class References {
 public:
  References(const Study& study, const Registry& registry, CheckpointStore checkpoints);

  /// Throws Interrupted when `stop` became true.
  ReferenceSet of(const StudyCase& study_case, const std::atomic<bool>& stop);

  /// Steps that marching beside the cases takes: those of `self`, once for all that share it, and of the twins for the
  /// horizon. `study_case` has the methods that make them; `times` is what a step costs in steps of that case (a finer
  /// mesh).
  struct Aside {
    const StudyCase* study_case;
    double steps, times;
  };
  std::vector<Aside> marches(const std::vector<const StudyCase*>& cases) const;
  /// The references that are solved rather than marched, each once for all cases that share it.
  struct Solutions {
    double seconds = 0;              ///< of processor time
    bool may_apply = false;          ///< one applies, or nobody knows before it is solved
    std::set<std::string> refusals;  ///< "NAME: sentence"
    bool none_applies() const { return !may_apply && !refusals.empty(); }
  };
  /// What they take, by the beginnings of some.
  Solutions solutions(const std::vector<const StudyCase*>& cases) const;

 private:
  struct Twin {
    double horizon;
    std::string why;
  };
  ReferencePointer find(const StudyCase& study_case, const MethodChoice& choice, const std::atomic<bool>& stop);
  KnownReference compute(const StudyCase& study_case, const MethodChoice& choice, const std::atomic<bool>& stop) const;
  KnownReference march_finer(const StudyCase& study_case, const std::atomic<bool>& stop) const;
  std::string key(const StudyCase& study_case, const MethodChoice& choice) const;
  Twin twin_horizon(const StudyCase& study_case, const std::atomic<bool>& stop);
  /// Of this case's own methods; nothing where they do not march to the end. Also nothing where they are blind: impacts
  /// at whole steps do not move with the motion.
  std::optional<Twin> twin_of(const StudyCase& chosen, bool& blind, const std::atomic<bool>& stop) const;
  /// What was computed once, or why it could not be.
  template <class Value>
  struct Known {
    std::optional<Value> value;
    std::exception_ptr failure;
  };
  template <class Value>
  static Value once(std::map<std::string, Known<Value>>& known, const std::string& key,
                    const std::function<Value()>& make);

  const Study& study_;
  const Registry& registry_;
  CheckpointStore checkpoints_;
  double smallest_step_ = 0;
  int coarsest_ = 0, finest_ = 0;  // elements
  std::optional<BasisSpec> richer_basis(const SceneSpec& scene, int elements) const;
  std::vector<std::optional<BasisSpec>> bases_;  // the richest first
  std::map<std::string, Known<ReferencePointer>> known_;
  std::map<std::string, Known<Twin>> twins_;
};

/// The grid on which a study's motions are compared: `samples` + 1 times from 0 to `duration`, 128 places.
SampleGrid comparison_grid(const SceneSpec& scene, double duration, int samples);

/// What a reference may read of a case. `discrete` is filled, and `problem.discrete` points to it, when the case has
/// been discretised.
ReferenceProblem reference_problem(const StudyCase& study_case, const Registry& registry);

/// Whether a reference meets the case's own stops: one of the mesh, and any of an oscillator. Of others stops are rigid.
bool meets_own_stops(const StudyCase& study_case, bool of_the_mesh);

/// The same as one of the scene sees it, with rigid stops, or one of the mesh; or why no reference knows the scene.
std::variant<ReferenceProblem, Refusal> seen_by_reference(const StudyCase& study_case, const Registry& registry,
                                                          bool of_the_mesh);

/// A reference motion as bytes, bit for bit.
std::string to_bytes(const ReferenceMotion& motion);

/// The motion that to_bytes() was given; throws std::runtime_error for bytes that are none.
ReferenceMotion motion_from_bytes(const std::string& bytes);

}  // namespace ricochet
