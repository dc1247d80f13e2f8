#pragma once
#include <ricochet/measure/contact/friction_watch.hpp>
#include <ricochet/measure/contact/stop_contacts.hpp>
#include <ricochet/measure/contact/tangent_watch.hpp>

#include "runners/kinds/trajectory/outputs.hpp"
#include "runners/kinds/trajectory/stop_measures.hpp"
#include "runners/store/record.hpp"
#include "runners/table/number_type.hpp"
#include "runners/table/table.hpp"

namespace ricochet {

/// Columns of `shocks` and of `spectra` that are read back.
struct ShockColumns {
  const Series *stop = nullptr, *t_peak = nullptr, *peak_force = nullptr, *duration = nullptr, *rebounds = nullptr;
};
const NumberType<ShockColumns>& shocks_type();
struct SpectrumColumns {
  const Series *of = nullptr, *quantity = nullptr, *frequency = nullptr, *density = nullptr;
};
const NumberType<SpectrumColumns>& spectra_type();

/// What looks at the stops of a trajectory beside the recorder of impacts; null: nothing does.
struct StopWatches {
  const OutputWatch* outputs = nullptr;
  const TangentWatch* tangents = nullptr;
  const FrictionWatch* friction = nullptr;
};

/// What is known of a stop, on one side or on both.
StopReading stop_reading(const StopContacts& contacts, const StopWatches& watches, int stop,
                         std::optional<StopSide> side = {});

/// The shock that an impact belongs to, by its row in shocks.csv; NaN where there is none.
double shock_of(const Impact& impact, const std::vector<Shock>& in_order);
/// By time, then by point.
std::vector<Shock> shocks_in_order(const ShockRecorder& recorder);

/// Adds shocks, histogram, stop_parts and spectra, those that are asked for; and, of parts, half of the 95 % interval
/// of the measures of each stop.
void add_stop_tables(CaseRecord& record, const SemiDiscrete& problem, const StopWatches& watches);

/// Those of these tables that are no numbers alone, with all columns that they may have.
std::vector<Table> stop_table_heads();

/// The contacts of lane 0, as the record keeps them. `impacts` has a row per impact. `stops` has a row per contact
/// point, or clearance, and side that ever closed. Beside them are the measures impacts, peak_contact_force and
/// contact_time, and a note where the list of impacts ended before the run did. Counts that no smaller step approaches
/// are left out of answers (no_count); `restitution` is the largest. Without contact there are no impacts, and nothing
/// else is said. What else looks at the stops adds columns at their ends, and tables.
void add_contact(CaseRecord& record, const StopContacts& contacts, const Marcher& marcher,
                 std::optional<double> restitution, const StopWatches& watches = {});

/// Units and meanings of these tables, for records that come from a store.
void describe_contact(std::vector<CaseRecord>& records);

/// `curves`, without rows: the sampled series of one trajectory, curves/ID.csv; those of these points come last,
/// and then their fields ("mid_moment").
Table curves_head(const std::vector<std::string>& points = {}, const std::vector<std::string>& fields = {});

}  // namespace ricochet
