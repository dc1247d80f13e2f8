#pragma once
#include <cmath>
#include <optional>
#include <ricochet/measure/attractors/diagram.hpp>

#include "runners/kinds/sweep/with_parameter.hpp"
#include "runners/table/number_type.hpp"
#include "runners/table/row_type.hpp"

/// \file
/// The tables of both kinds of sweep, without rows: what their columns mean.
namespace ricochet {

/// "periodic 3", "chaotic": a class and its period, as `values` and `cells` have them, in the words of `bifurcations`.
std::string regime_text(const std::string& regime, std::optional<double> period);

/// The period of a class as its column holds it: nothing where nothing repeats.
inline std::optional<int> period_of(const MotionClass& motion) {
  return motion.period > 0 ? std::optional(motion.period) : std::nullopt;
}

inline constexpr char values_name[] = "values";

/// One row of `values`: what came of one value of the parameter from one start.
struct OrbitRow {
  struct Exponent {
    std::optional<double> value, low, high;  ///< 1/s
  };
  std::string id;  ///< of the case
  double parameter = NAN;
  std::string start, regime;
  std::optional<int> period;  ///< forcing periods
  std::optional<double> impacts_per_period;
  std::optional<bool> symmetric;
  std::vector<Exponent> exponents;  ///< the largest first
  std::string exponent_method;
  std::optional<double> exponent_twin;  ///< 1/s
  std::string marginal;
  std::optional<int> attractor;
  std::optional<double> alpha_equivalent;  ///< s
  std::optional<double> recurrence, contraction, zero_one;
  std::optional<int> transient_periods;
  std::optional<bool> settled, chatter;
  std::optional<double> sticking;
  std::optional<double> open;  ///< m
  std::string evidence, status, reason;
  bool done() const { return status.empty() || status == word(Status::done); }
  /// The motion, or why there is none: "refused".
  std::string motion_text() const { return done() ? regime_text(regime, period) : status; }
  std::optional<double> largest_exponent() const { return exponents.empty() ? std::nullopt : exponents.front().value; }
};
/// With so many exponents.
RowType<OrbitRow> orbit_row_type(int exponents, const SweptColumns& swept = {});
/// The rows of `values`, with as many exponents as it has.
std::vector<OrbitRow> orbits_in(const Table& values);
/// The orbits of a case, in its order; none where it has no such table.
std::vector<OrbitRow> orbits_of(const CaseRecord& record);

/// One row of `bifurcations`.
struct ChangeRow : DiagramChange {
  explicit ChangeRow(DiagramChange change = {{}, {}, {}, {}, NAN, NAN, NAN}, std::optional<int> of_search = {})
      : DiagramChange(std::move(change)), steps(of_search) {}
  std::optional<int> steps;  ///< of the search
};
RowType<ChangeRow> change_row_type(const SweptColumns& swept = {});
/// The changes of a case, in its order; none where it has no such table.
std::vector<ChangeRow> changes_of(const CaseRecord& record);

/// One row of `cells`: a start, or a scene, and where it leads.
struct CellRow {
  std::string id;
  std::optional<double> x, y;
  std::string regime;
  std::optional<int> period = {}, attractor = {};
  std::optional<bool> marched = {};
  std::optional<std::size_t> source = {};
  std::optional<std::string> status = {}, reason = {};
};

/// One row of `attractors`.
struct AttractorRow {
  std::optional<int> attractor;
  std::string label;
  std::optional<int> cases;
  std::optional<double> from, to;
  std::string regime;
  std::optional<int> period;
  std::optional<bool> symmetric;
  std::optional<double> fraction, fraction_low, fraction_high;
  std::string presence, sentence;
};

/// One row of `agreement`: an ordered pair of cases.
struct AgreementRow {
  std::string id, other;
  int compared = 0, same = 0;  ///< of these, in class
  std::optional<double> share;
  int same_attractor = 0;
  std::optional<double> share_attractor;
};

/// One row of `verdicts`: an interval of the parameter.
struct VerdictRow {
  double from = NAN, to = NAN;
  std::string verdict, choice, sentence;
};

/// One row of `distances`: an orbit against that of the reference case.
struct DistanceRow {
  std::string id, reference;
  std::optional<double> parameter;
  std::string start;
  std::optional<double> wasserstein = {}, hausdorff = {}, null_wasserstein = {}, null_hausdorff = {}, ratio = {};
  std::optional<bool> same_class = {};
  std::string formula = {};
};

/// One row of `shifts`: a change of the motion against the same of the reference case.
struct ShiftRow {
  std::string id, reference, start, from, to, kind;
  std::optional<double> reference_value = {}, value = {}, shift = {}, low = {}, high = {};
  std::optional<bool> found = {};
};

/// One row of `basin_fractions`: an attractor in one case.
struct FractionRow {
  std::string id;
  int attractor = 0;
  std::string regime;
  std::optional<int> period;
  int cells = 0;
  std::optional<double> fraction, low, high;
};

/// One row of `basin_differences`: a pair of cases.
struct BasinDifferenceRow {
  std::string id, other;
  int cells = 0, differ = 0, motions = 0;
  std::optional<double> share;
};

/// One row of `basin_uncertainty`: a case.
struct UncertaintyRow {
  std::string id;
  std::optional<double> boundary_share, exponent, low, high;
};

/// The column that names the start of an orbit, in words.
inline constexpr char start_name[] = "start";

/// Points of sections: of the orbits of a diagram (by parameter and start), or of the cells of a grid (by cell).
struct SectionColumns {
  const Series *parameter = nullptr, *start = nullptr, *cell = nullptr, *index = nullptr;
  const Series *displacement = nullptr, *velocity = nullptr;
  const Series *opposite_displacement = nullptr, *opposite_velocity = nullptr;
};
struct ImpactColumns {
  const Series *parameter = nullptr, *start = nullptr, *phase = nullptr, *side = nullptr, *speed = nullptr;
  const Series *x = nullptr, *t = nullptr;
};
struct PortraitColumns {
  const Series *parameter = nullptr, *start = nullptr, *time = nullptr, *displacement = nullptr, *velocity = nullptr;
};
/// States that the kept periods begin with.
struct EntryColumns {
  const Series *parameter = nullptr, *start = nullptr, *index = nullptr, *value = nullptr;
};
struct ContactLawColumns {
  const Series* compliance = nullptr;
};

/// Of a case, kept in the store.
Table values_head(int exponents, const SweptColumns& swept = {});
Table bifurcations_head(const SweptColumns& swept = {});
TableType<CellRow> cells_type(const SweptColumns& swept = {});
NumberType<SectionColumns> points_type(const SweptColumns& swept = {});
NumberType<ImpactColumns> impacts_type(const SweptColumns& swept = {});
/// The last column of impacts, where stops have names.
inline const Column stop_column{"stop", "", "Name of the stop."};
NumberType<PortraitColumns> portraits_type(const SweptColumns& swept = {});
NumberType<EntryColumns> entries_type(const SweptColumns& swept = {});
NumberType<SectionColumns> cell_points_type();
NumberType<ContactLawColumns> contact_law_type();

/// Over all cases, worked out of these.
TableType<AttractorRow> attractors_type(const SweptColumns& swept = {});
TableType<AgreementRow> agreement_type();
TableType<VerdictRow> verdicts_type(const SweptColumns& swept = {});
TableType<BasinDifferenceRow> basin_differences_type();
/// Of single cases, worked out of these: what stands behind `case` and the axes.
TableType<DistanceRow> distances_type(const SweptColumns& swept = {});
TableType<ShiftRow> shifts_type(const SweptColumns& swept = {});
TableType<FractionRow> basin_fractions_type();
TableType<UncertaintyRow> basin_uncertainty_type();

/// The column of `values` and `cells` that comparing the cases fills in.
extern const Column attractor_column;

/// Gives the tables that a case of a sweep left their units and meanings.
void describe_sweep(std::vector<CaseRecord>& cases, const SweptColumns& swept);

// What the orbits of a bifurcation study come to, over values and starts.

/// verdict_shares: for each verdict and deciding choice, how many intervals and which share of the range; robust first,
/// undecided last.
Table verdict_shares_table(const Table& verdicts, const SweptColumns& swept);

/// One row of `class_counts`.
struct ClassCount {
  std::string id, regime;
  std::optional<int> period;
  int orbits = 0;
  double share = 0;
};
TableType<ClassCount> class_counts_type();

/// One row of `grazing_ranges`.
struct GrazingRange {
  std::string start;
  int changes = 0;
  std::optional<double> low, high;
  double bracket = 0;
};
TableType<GrazingRange> grazing_ranges_type(const SweptColumns& swept = {});
/// grazing_ranges: for each start, where contact begins or ends, over the cases.
Table grazing_ranges_table(const StudyResults& results, const SweptColumns& swept);

/// One row of `numerical_viscosity`.
struct NumericalViscosity {
  std::string id;
  std::optional<double> low, high, physical_low, physical_high, share;
  std::optional<bool> small;
};
TableType<NumericalViscosity> numerical_viscosity_type();

}  // namespace ricochet
