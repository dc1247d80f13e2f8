#pragma once
#include <cmath>
#include <map>
#include <optional>
#include <ricochet/measure/statistics/refinement.hpp>
#include <string>
#include <utility>
#include <vector>

#include "runners/answers/numbers_in_words.hpp"
#include "runners/asks/ask.hpp"
#include "runners/report/choices.hpp"

namespace ricochet::asks {

/// What is known of a number: value ± u, u = step + mesh + sampling.
struct Estimate {
  double value = 0;                  ///< at the finest step and mesh; of seeds their mean
  std::optional<double> step, mesh;  ///< what each refinement leaves; nothing of a single size
  std::optional<double> sampling;    ///< half the 95 % interval of a mean; nothing where none is drawn
  bool scattered = false;            ///< whether that is told by the scatter between seeds
  bool grows = false;                ///< without bound as it is refined
  bool vanishes = false;             ///< falls to zero with the step
  std::string motion;                ///< "still falls with the step" of what is not settled
  std::string few;                   ///< "is known by two steps alone", where they leave more than u; or by three
  bool two = false;                  ///< whether two sizes alone tell it, and leave more than u
  bool one_mesh = false;             ///< of several that were asked one alone has a value
  bool disproved = false;            ///< whether a scheme with the same limit excludes what the step alone tells
  bool one_instant = false;          ///< each step has its one rigid impact at the same instant: none tells its error
  bool one_draw = false;             ///< of a random load, without an interval of its own: what others say is not known
  double step_doubt = 1;             ///< where the step is not settled: so many times `step` may be left to the limit
  double mesh_doubt = 1;             ///< likewise of the mesh
  std::optional<double> order;       ///< in the step
  std::size_t steps = 1, meshes = 1, seeds = 1;
  bool has_step = true;  ///< whether its study has a step to refine
  bool beyond = false;   ///< all that is known is that it lies above `value`, where the study stopped looking
  /// Why it may be farther than u from its limit; "" where it is not.
  const std::string& unsettled() const { return motion.empty() ? few : motion; }
  /// What is not known at all: "one step"; "" where u holds all.
  std::string unknown() const;
  /// The sum of what is known; nothing where it grows, or where nothing is known.
  std::optional<double> u() const;
  /// All that refinement may leave.
  double left() const { return step_doubt * step.value_or(0) + mesh_doubt * mesh.value_or(0); }
  /// u with that.
  std::optional<double> doubted_u() const;
  bool doubted() const { return step_doubt > 1 || mesh_doubt > 1; }
  /// Whether value ± u holds all that leaves it open.
  bool has_interval() const { return u() && unknown().empty(); }
  double low() const { return beyond ? value : value - u().value_or(0); }
  double high() const { return beyond ? INFINITY : value + u().value_or(0); }
  /// The same by which a yes or a no is told.
  double least() const { return beyond ? value : value - doubted_u().value_or(0); }
  double most() const { return beyond ? INFINITY : value + doubted_u().value_or(0); }
};

/// A size of refinement: the step (1 where none varies), the elements (1 likewise).
using Size = std::pair<double, double>;
/// Whether a has the finer mesh, or the same and the smaller step.
inline bool finer(const Size& a, const Size& b) {
  return a.second != b.second ? a.second > b.second : a.first < b.first;
}

/// Cases that agree in all that is chosen: they differ in step, mesh and seed alone.
struct Point {
  Cases cases;                                           ///< all
  Cases behind;                                          ///< those with a value
  std::map<Size, std::map<std::string, double>> values;  ///< by seed, of the finest mesh where modes vary on several
  std::map<Size, std::map<std::string, double>> halves;  ///< half intervals of these, where known
  std::optional<Size> finest;
  double floor = 0;  ///< what round-off makes of a value
  Errors errors = Errors::smooth;
  std::optional<Estimate> estimate;
  std::string none;                ///< why it has no value
  bool of_untouched_stop = false;  ///< whether that is because nothing ever touches its stop
  bool without_limit = false;      ///< whether that is because its law leaves the measure no limit in the step
  /// Equal for points of a compliant law that differ in the time scheme alone: as the step shrinks their values have
  /// one limit. "" where no limit is known to be shared.
  std::string limit;

  const CaseRecord& first() const { return *cases.front(); }
};

/// Whether none of its cases touched a stop.
bool untouched(const Point& point);
/// Whether it has no value or zeros alone, as nothing is touched, of a stop: as that is not.
bool is_idle(const Point& point, const std::string& stop);
/// Whether each of its cases is doubtful: too short, a load between its steps.
bool doubtful(const Point& point);

/// Why cases are not behind a verdict.
struct LeftOut {
  struct Reason {
    std::size_t count = 0;
    std::string text;   ///< "refused: …"; of cases whose numbers differ with those of the first
    bool alike = true;  ///< whether it is that of each
    std::string said() const { return std::to_string(count) + " " + text; }
  };
  std::size_t count = 0;
  std::vector<Reason> reasons;  ///< in the order of the cases
  /// A sentence each: "Left out: 12 refused: …."; of more than three reasons the two of most cases, and how many more.
  std::vector<std::string> told() const;
};

/// What a value is at least of which a case says no more (its measure `least.NAME`); nothing where it has the value.
std::optional<double> least_of(const CaseRecord& record, const std::string& measure);

/// The results of a study as verbs look at them.
class Evidence {
 public:
  explicit Evidence(const Choices& study) : study_(study) {}

  const Choices& study() const { return study_; }
  const StudyResults& results() const { return study_.results(); }

  /// The cases that an ask speaks of: those of its `where`, without references.
  Cases cases(const Ask& ask) const;
  /// The measures of an ask by name, "peak_force[gap]": of a measure of stops one for each stop that it names, or for
  /// all. The name as it is where one stop alone has it, and where no case has any.
  std::vector<std::string> measures(const Ask& ask, const std::string& name) const;
  /// Columns that vary among these cases, refinements and seeds among them.
  std::vector<std::string> varying(const Cases& cases) const;
  /// The same but seeds, `own`, and what refines this measure.
  std::vector<std::string> choices(const Cases& cases, const std::string& measure,
                                   const std::vector<std::string>& own = {}) const;
  /// The columns of a choice: of a role all that vary, else the one.
  std::vector<std::string> columns_of(const std::string& choice) const;

  /// Cases as points, told apart by these columns. `shares`: values over the scale of their measure, as
  /// has_shares() allows.
  std::vector<Point> points(const std::string& measure, const Cases& cases, const std::vector<std::string>& columns,
                            bool shares) const;
  /// Whether a measure of energy is told as a share of what was brought in: every case with a value has such a share.
  bool has_shares(const std::string& measure, const Cases& cases) const;
  /// What is left out of these points, by reason.
  LeftOut left_out(const std::string& measure, const Cases& cases) const;

  /// Equal for cases of the same levels in these columns.
  std::string key(const CaseRecord& record, const std::vector<std::string>& columns) const {
    return study_.key(record, columns);
  }
  /// The levels of a case in these columns, in words: "hrz, 1e8 N/m". "" of none.
  std::string level(const CaseRecord& record, const std::vector<std::string>& columns) const;
  /// What comes before any number, a sentence each: that nothing moved, or no stop was touched; which
  /// references do not apply; who makes energy.
  std::vector<std::string> warnings() const;

  /// s over which means are taken: the window, else the run.
  double window() const;
  /// Periods of each orbit that exponents are means over; 0 of kinds without orbits.
  double kept_periods() const;
  /// s after which the random loads of the scene say the same again, the soonest; ∞ of none.
  double repeats_after() const;

 private:
  bool is_crossed(const std::string& column, const std::string& role) const;
  /// What a value is off by beside round-off, in the unit of its measure: what its floor says. Of a time that is
  /// counted in whole steps (`by_steps`: of which the points know the size) these steps, of a peak of contact what two
  /// steps may miss between them. 0 of others.
  double resolution(const std::string& measure, const Point& point, bool by_steps) const;
  /// points(), each by its own refinement alone.
  std::vector<Point> alone(const std::string& measure, const Cases& cases, const std::vector<std::string>& columns,
                           bool shares) const;
  /// What tells points apart if the time scheme and its parameters do not, and `told`, if they do as well. Nothing
  /// where no scheme varies, or where the step is chosen.
  struct Schemes {
    Cases all;
    std::vector<std::string> told, others;
  };
  std::optional<Schemes> schemes(const std::string& measure, const std::vector<std::string>& columns) const;
  /// Widens these where another scheme with the same limit excludes them, and narrows them to where one has settled,
  /// whether it is asked or not.
  void test_by_schemes(std::vector<Point>& points, const std::string& measure, const Schemes& schemes,
                       bool shares) const;
  /// Widens what is zero, as nothing is touched, to what another scheme with the same law tells at its finest. Until
  /// something is touched the motion has one limit, whatever the scheme.
  void test_by_contact(std::vector<Point>& points, const std::string& measure, const Schemes& schemes,
                       bool shares) const;

  const Choices& study_;
};

/// Whether a load of a scene is drawn from a spectrum.
bool is_drawn(const Json& scene);

/// Whether the step is among these columns, in s or by period.
bool names_step(const std::vector<std::string>& columns);
/// Whether a level that a study names is the one of a case: 1e6 and 1000000 are.
bool same_level(const Json& asked, const Json& own);

/// Equal for cases that ended alike: by status, and by reasons that differ in numbers at most.
std::string ending_key(const CaseRecord& record);

/// The name of a measure without its stop, and the stop; "" where it has none.
std::pair<std::string, std::string> split_measure(const std::string& name);

/// What a step and a mesh leave, each at the finest of the other.
struct Limits {
  std::optional<Limit> step, mesh;
};
/// Of values by size and seed: means over the seeds that sizes have in common.
Limits limits_at(const std::map<Size, std::map<std::string, double>>& values, const Size& finest, double floor,
                 Errors errors);

/// The estimate at the finest size. `has_step`: whether there is a step to refine.
Estimate estimate_of(const std::map<Size, std::map<std::string, double>>& values,
                     const std::map<Size, std::map<std::string, double>>& halves, const Size& finest,
                     const Limits& limits, bool has_step);

}  // namespace ricochet::asks
