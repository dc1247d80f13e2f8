#pragma once
#include <ricochet/measure/contact/stop_contacts.hpp>

#include "runners/kinds/trajectory/stop_tables.hpp"
#include "runners/store/record.hpp"
#include "runners/table/table.hpp"

namespace ricochet {

/// The contacts of lane 0, as the record keeps them: `impacts`, a row per impact; `stops`, a row per contact point, or
/// clearance, and side that ever closed; the measures impacts, peak_contact_force and contact_time; and a note where
/// the list of impacts ended before the run did. Without contact there are no impacts, and nothing else is said. What
/// else looks at the stops adds columns at their ends, and tables.
void add_contact(CaseRecord& record, const StopContacts& contacts, const Marcher& marcher,
                 const StopWatches& watches = {});

/// Units and meanings of these tables, for records that come from a store.
void describe_contact(std::vector<CaseRecord>& records);

/// `curves`, without rows: the sampled series of one trajectory, curves/ID.csv; those of these points come last,
/// and then their fields ("mid_moment").
Table curves_head(const std::vector<std::string>& points = {}, const std::vector<std::string>& fields = {});

}  // namespace ricochet
