#pragma once
#include <ricochet/measure/contact/tangent_watch.hpp>

#include "runners/kinds/trajectory/output_watch.hpp"
#include "runners/kinds/trajectory/stop_measures.hpp"
#include "runners/table/number_type.hpp"

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

/// Units and meanings of these tables, for records that come from a store.
void describe_stop_tables(CaseRecord& record);

}  // namespace ricochet
